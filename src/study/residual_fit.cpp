#include "study/residual_fit.hpp"

// g++ 12 takes Eigen's resizing for a use of freed memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "study/fit_covariance.hpp"
#include "study/least_squares.hpp"
#include "wingbeat/core/math.hpp"

namespace wingbeat {
namespace {

/// In units of the bounds' distance, from 0 to 1.
class DifferencedResiduals : public ceres::CostFunction {
 public:
  DifferencedResiduals(const Computed& computed, const std::vector<double>& measured,
                       const std::vector<FreeParameter>& parameters)
      : computed_(computed), measured_(measured), parameters_(parameters) {
    set_num_residuals(int(measured.size()));
    mutable_parameter_block_sizes()->push_back(int(parameters.size()));
  }
  std::vector<double> natural(const double* scaled) const {
    std::vector<double> x;
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
      const FreeParameter& p = parameters_[k];
      x.push_back(std::clamp(p.lower + scaled[k] * (p.upper - p.lower), p.lower, p.upper));
    }
    return x;
  }
  bool Evaluate(double const* const* scaled, double* residuals, double** jacobians) const override {
    if (!set(scaled[0], residuals)) return false;
    if (!jacobians || !jacobians[0]) return true;
    const std::size_t n = measured_.size(), count = parameters_.size();
    std::vector<double> moved(scaled[0], scaled[0] + count), low(n), high(n);
    constexpr double step = 1e-4;
    for (std::size_t k = 0; k < count; ++k) {
      // One-sided at a bound.
      const double above = std::min(scaled[0][k] + step, 1.0), below = std::max(scaled[0][k] - step, 0.0);
      moved[k] = above;
      if (!set(moved.data(), high.data())) return false;
      moved[k] = below;
      if (!set(moved.data(), low.data())) return false;
      moved[k] = scaled[0][k];
      for (std::size_t row = 0; row < n; ++row) {
        jacobians[0][row * count + k] = (high[row] - low[row]) / (above - below);
      }
    }
    return true;
  }

 private:
  bool set(const double* scaled, double* residuals) const {
    const std::vector<double> found = computed_(natural(scaled));
    for (std::size_t n = 0; n < measured_.size(); ++n) {
      residuals[n] = found[n] - measured_[n];
      if (!std::isfinite(residuals[n])) return false;
    }
    return true;
  }

  const Computed& computed_;
  const std::vector<double>& measured_;
  const std::vector<FreeParameter>& parameters_;
};

/// The best of the parameters' own starts and of a grid within their bounds, geometric where a lower bound is > 0:
/// passive pitch has several minima over a hinge's stiffness.
std::vector<double> best_start(const DifferencedResiduals& residuals, std::size_t count,
                               const std::vector<FreeParameter>& parameters) {
  constexpr int steps[] = {8, 3};
  std::vector<std::vector<double>> starts(1);
  for (const FreeParameter& p : parameters) {
    starts[0].push_back(std::clamp((p.start - p.lower) / (p.upper - p.lower), 0.0, 1.0));
  }
  std::vector<std::vector<double>> grid(1);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const FreeParameter& p = parameters[k];
    const int parts = steps[std::min<std::size_t>(k, 1)];
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& begun : grid) {
      for (int n = 0; n < parts; ++n) {
        const double part = (n + 0.5) / parts;
        longer.push_back(begun);
        longer.back().push_back(
            p.lower > 0.0 ? p.lower * (std::pow(p.upper / p.lower, part) - 1.0) / (p.upper - p.lower) : part);
      }
    }
    grid = std::move(longer);
  }
  starts.insert(starts.end(), grid.begin(), grid.end());
  std::vector<double> best = starts[0], left(count);
  double least = infinity;
  for (const std::vector<double>& start : starts) {
    const double* at[] = {start.data()};
    if (!residuals.Evaluate(at, left.data(), nullptr)) continue;
    double squares = 0.0;
    for (const double r : left) squares += r * r;
    if (squares < least) least = squares, best = start;
  }
  return best;
}

}  // namespace

ResidualFit fit_residuals(const Computed& computed, const std::vector<double>& measured,
                          const std::vector<FreeParameter>& parameters) {
  const std::size_t n = measured.size(), count = parameters.size();
  DifferencedResiduals residuals(computed, measured, parameters);
  std::vector<double> scaled = best_start(residuals, n, parameters);
  ceres::Problem::Options own;
  own.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(own);
  problem.AddResidualBlock(&residuals, nullptr, scaled.data());
  for (std::size_t k = 0; k < count; ++k) {
    problem.SetParameterLowerBound(scaled.data(), int(k), 0.0);
    problem.SetParameterUpperBound(scaled.data(), int(k), 1.0);
  }
  ceres::Solver::Summary summary;
  ceres::Solve(least_squares(100, 1e-12, 1e-9), &problem, &summary);
  ResidualFit fit;
  fit.converged = summary.termination_type == ceres::CONVERGENCE;
  fit.x = residuals.natural(scaled.data());

  const Eigen::Index rows = Eigen::Index(n), columns = Eigen::Index(count);
  Eigen::VectorXd left(rows);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> slopes(rows, columns);
  const double* at[] = {scaled.data()};
  double* into[] = {slopes.data()};
  const bool known = residuals.Evaluate(at, left.data(), into);
  std::vector<Eigen::Index> free;
  for (std::size_t k = 0; k < count; ++k) {
    if (scaled[k] > 1e-6 && scaled[k] < 1.0 - 1e-6) free.push_back(Eigen::Index(k));
  }
  const double freedom = double(n) - double(free.size());
  Eigen::MatrixXd covariance;
  if (known && freedom > 0.5 && !free.empty()) {
    const Eigen::MatrixXd moved = slopes(Eigen::all, free);
    covariance = (moved.transpose() * moved).inverse() * left.squaredNorm() / freedom;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const FreeParameter& p = parameters[k];
    FittedParameter found;
    found.key = p.parameter.key;
    found.unit = p.parameter.unit;
    found.value = found.kept = fit.x[k];
    const auto among = std::find(free.begin(), free.end(), Eigen::Index(k));
    found.at_bound = among == free.end();
    if (!found.at_bound && covariance.size() > 0) {
      const Eigen::Index i = among - free.begin();
      found.standard_error = std::sqrt(covariance(i, i)) * (p.upper - p.lower);
      found.quantile_95 = quantile_95(freedom);
      found.lower_95 = std::max(p.lower, fit.x[k] - found.quantile_95 * found.standard_error);
      found.upper_95 = std::min(p.upper, fit.x[k] + found.quantile_95 * found.standard_error);
      if (found.lower_95 == p.lower && found.upper_95 == p.upper) {
        found.undetermined = Undetermined::free_with_others;
        found.lower_95 = found.upper_95 = absent;
      }
    }
    fit.parameters.push_back(std::move(found));
  }
  return fit;
}

}  // namespace wingbeat

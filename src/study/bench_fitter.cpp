#include "study/bench_fitter.hpp"

// g++ 12 takes Eigen's resizing for a use of freed memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "study/least_squares.hpp"

namespace wingbeat {

/// Computes the whole bench once for all residuals.
struct BenchFitter::Callback : ceres::EvaluationCallback {
  Callback(BenchFitter& f, std::vector<double> start, const std::vector<std::size_t>& which, std::vector<double>& s)
      : fitter(f), x(std::move(start)), free(which), scaled(s) {}
  void PrepareForEvaluation(bool jacobians, bool) override { fitter.bench_.evaluate(natural(), jacobians); }
  std::vector<double> natural() const {
    std::vector<double> all = x;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const FreeParameter& p = fitter.fit_.parameters[free[k]];
      all[free[k]] = std::clamp(p.lower + scaled[k] * (p.upper - p.lower), p.lower, p.upper);
    }
    return all;
  }
  BenchFitter& fitter;
  std::vector<double> x;
  const std::vector<std::size_t>& free;
  std::vector<double>& scaled;
};

class BenchFitter::Residual : public ceres::CostFunction {
 public:
  Residual(const BenchFitter& fitter, const std::vector<std::size_t>& free, std::size_t o)
      : fitter_(fitter), free_(free), o_(o) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(int(free.size()));
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    residuals[0] = fitter_.residual(o_);
    if (!std::isfinite(residuals[0])) return false;
    if (jacobians && jacobians[0]) {
      for (std::size_t k = 0; k < free_.size(); ++k) {
        const FreeParameter& p = fitter_.fit_.parameters[free_[k]];
        jacobians[0][k] = fitter_.bench_.jacobian()(Eigen::Index(o_), Eigen::Index(free_[k])) * (p.upper - p.lower) /
                          fitter_.deviations_[o_];
      }
    }
    return true;
  }

 private:
  const BenchFitter& fitter_;
  const std::vector<std::size_t>& free_;
  std::size_t o_;
};

BenchFitter::BenchFitter(const BenchFit& fit, const ForEach& for_each)
    : fit_(fit), bench_(fit, for_each), deviations_(bench_.observations().size()) {
  for (std::size_t o = 0; o < deviations_.size(); ++o) estimated_[bench_.observations()[o].quantity] = 0.0;
  first_deviations();
}

BenchFitter::Outcome BenchFitter::solve(std::vector<double> x, const std::vector<std::size_t>& free, int iterations) {
  Outcome outcome;
  if (free.empty()) {
    outcome.converged = true;
    outcome.message = "nothing to fit";
    outcome.x = x;
    bench_.evaluate(x, false);
    outcome.cost = cost();
    return outcome;
  }
  // From 0 at the lower bound to 1 at the upper one.
  std::vector<double> scaled(free.size());
  for (std::size_t k = 0; k < free.size(); ++k) {
    const FreeParameter& p = fit_.parameters[free[k]];
    scaled[k] = std::clamp((x[free[k]] - p.lower) / (p.upper - p.lower), 0.0, 1.0);
  }
  Callback callback{*this, x, free, scaled};
  ceres::Problem::Options problem_options;
  problem_options.evaluation_callback = &callback;
  ceres::Problem problem(problem_options);
  for (std::size_t o = 0; o < deviations_.size(); ++o) {
    problem.AddResidualBlock(new Residual(*this, free, o), loss(), scaled.data());
  }
  for (std::size_t k = 0; k < free.size(); ++k) {
    problem.SetParameterLowerBound(scaled.data(), int(k), 0.0);
    problem.SetParameterUpperBound(scaled.data(), int(k), 1.0);
  }
  const ceres::Solver::Options options = least_squares(iterations, 1e-9, 1e-9);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  outcome.x = callback.natural();
  bench_.evaluate(outcome.x, false);
  outcome.cost = cost();
  outcome.converged = summary.termination_type == ceres::CONVERGENCE;
  outcome.message = summary.message;
  return outcome;
}

double BenchFitter::cost() const {
  double sum = 0.0;
  const std::unique_ptr<ceres::LossFunction> rho(loss());
  for (std::size_t o = 0; o < deviations_.size(); ++o) {
    const double r = residual(o);
    double value[3] = {r * r, 1.0, 0.0};
    if (rho) rho->Evaluate(r * r, value);
    sum += value[0];
  }
  return sum;
}

double BenchFitter::weight(std::size_t o) const {
  const std::unique_ptr<ceres::LossFunction> rho(loss());
  if (!rho) return 1.0;
  double value[3];
  rho->Evaluate(residual(o) * residual(o), value);
  return value[1];
}

bool BenchFitter::has_estimates() const {
  return std::any_of(fit_.deviations.begin(), fit_.deviations.end(),
                     [](const auto& d) { return d.second.kind == Deviation::Kind::estimated; });
}

double BenchFitter::renew_deviations(std::size_t free_count) {
  const auto& observations = bench_.observations();
  std::map<MeasuredQuantity, std::pair<double, int>> sums;
  int reached = 0;
  for (std::size_t o = 0; o < observations.size(); ++o) {
    if (!bench_.predictions()[observations[o].point].reached) continue;
    ++reached;
    const double error = bench_.fitted()[o] - observations[o].measured;
    auto& [sum, count] = sums[observations[o].quantity];
    // A robust fit's outliers must not widen the rest.
    sum += weight(o) * error * error;
    ++count;
  }
  double change = 0.0;
  for (std::size_t o = 0; o < observations.size(); ++o) {
    const Deviation& d = deviation_of(observations[o].quantity);
    double next = deviations_[o];
    if (d.kind == Deviation::Kind::relative && bench_.predictions()[observations[o].point].reached) {
      next = d.value * std::abs(bench_.fitted()[o]);
    } else if (d.kind == Deviation::Kind::estimated) {
      const auto [sum, count] = sums[observations[o].quantity];
      // Each quantity pays its part of the parameters.
      const double freedom = count * (1.0 - double(free_count) / std::max(reached, 1));
      if (freedom > 0.5) next = std::sqrt(sum / freedom);
      estimated_[observations[o].quantity] = next;
    }
    next = std::max(next, 1e-12 * std::abs(observations[o].measured) + 1e-300);
    change = std::max(change, std::abs(next / deviations_[o] - 1.0));
    deviations_[o] = next;
  }
  return change;
}

void BenchFitter::first_deviations() {
  const auto& observations = bench_.observations();
  std::map<MeasuredQuantity, std::pair<double, int>> squares;
  for (const Observation& o : observations) {
    squares[o.quantity].first += o.measured * o.measured;
    ++squares[o.quantity].second;
  }
  for (std::size_t o = 0; o < observations.size(); ++o) {
    const Deviation& d = deviation_of(observations[o].quantity);
    const auto [sum, count] = squares[observations[o].quantity];
    const double typical = std::sqrt(sum / count);
    switch (d.kind) {
      case Deviation::Kind::absolute: deviations_[o] = d.value; break;
      case Deviation::Kind::relative: deviations_[o] = d.value * std::abs(observations[o].measured); break;
      case Deviation::Kind::estimated: deviations_[o] = 0.02 * (typical > 0.0 ? typical : 1.0); break;
    }
  }
}

ceres::LossFunction* BenchFitter::loss() const {
  switch (fit_.loss) {
    case Loss::none: return nullptr;
    case Loss::huber: return new ceres::HuberLoss(fit_.loss_scale);
    case Loss::soft_l1: return new ceres::SoftLOneLoss(fit_.loss_scale);
    case Loss::cauchy: return new ceres::CauchyLoss(fit_.loss_scale);
  }
  return nullptr;
}

}  // namespace wingbeat

#include "study/bench_fitter.hpp"

// g++ 12 takes Eigen's resizing for a use of freed memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wuse-after-free"
#endif
#include <ceres/ceres.h>

#include <Eigen/Cholesky>
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
    : fit_(fit), loss_(fit.loss), bench_(fit, for_each), deviations_(bench_.observations().size()) {
  for (std::size_t o = 0; o < deviations_.size(); ++o) estimated_[bench_.observations()[o].quantity] = 0.0;
  first_deviations();
}

BenchFitter::Outcome BenchFitter::solve(std::vector<double> x, const std::vector<std::size_t>& free, int iterations,
                                        double tolerance) {
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
    problem.AddResidualBlock(new Residual(*this, free, o), ceres_loss(loss_, fit_.loss_scale).release(), scaled.data());
  }
  for (std::size_t k = 0; k < free.size(); ++k) {
    problem.SetParameterLowerBound(scaled.data(), int(k), 0.0);
    problem.SetParameterUpperBound(scaled.data(), int(k), 1.0);
  }
  const ceres::Solver::Options options = least_squares(iterations, tolerance, 1e-9);
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
  for (std::size_t o = 0; o < deviations_.size(); ++o) sum += loss_at(o).rho;
  return sum;
}

bool BenchFitter::has_estimates() const {
  return std::any_of(fit_.deviations.begin(), fit_.deviations.end(),
                     [](const auto& d) { return d.second.kind == Deviation::Kind::estimated; });
}

std::map<MeasuredQuantity, double> BenchFitter::freedom(const std::vector<std::size_t>& free) {
  bench_.evaluate(bench_.x(), true);
  std::vector<std::size_t> moved;
  for (const std::size_t k : free) {
    const FreeParameter& p = fit_.parameters[k];
    const double range = p.upper - p.lower, x = bench_.x()[k];
    if (x - p.lower > 1e-6 * range && p.upper - x > 1e-6 * range) moved.push_back(k);
  }
  const Eigen::Index n = Eigen::Index(moved.size());
  std::map<MeasuredQuantity, double> left;
  std::map<MeasuredQuantity, Eigen::MatrixXd> information;
  // In units of half the bounds' distance, within which every parameter is known.
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n, n);
  for (std::size_t o = 0; o < deviations_.size(); ++o) {
    const Observation& observation = bench_.observations()[o];
    if (!bench_.predictions()[observation.point].reached) continue;
    Eigen::VectorXd row(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const FreeParameter& p = fit_.parameters[moved[std::size_t(k)]];
      row[k] = bench_.jacobian()(Eigen::Index(o), Eigen::Index(moved[std::size_t(k)])) * 0.5 * (p.upper - p.lower) /
               deviations_[o];
    }
    Eigen::MatrixXd& own = information.try_emplace(observation.quantity, Eigen::MatrixXd::Zero(n, n)).first->second;
    own += row * row.transpose();
    all += row * row.transpose();
    left[observation.quantity] += 1.0;
  }
  const Eigen::LDLT<Eigen::MatrixXd> factored(all);
  for (auto& [quantity, count] : left) {
    if (n > 0) count -= factored.solve(information[quantity]).trace();
  }
  return left;
}

double BenchFitter::estimated_deviation(const std::vector<double>& errors, double freedom) const {
  double squares = 0.0;
  for (const double e : errors) squares += e * e;
  double deviation = std::sqrt(squares / freedom);
  for (int step = 0; fit_.loss != Loss::none && deviation > 0.0 && step < 200; ++step) {
    double sum = 0.0;
    for (const double e : errors) sum += counted_square(fit_.loss, e / deviation);
    const double change = std::sqrt(sum / freedom);
    deviation *= change;
    if (std::abs(change - 1.0) < 1e-6) break;
  }
  return deviation;
}

double BenchFitter::renew_deviations(const std::vector<std::size_t>& free) {
  const auto& observations = bench_.observations();
  std::map<MeasuredQuantity, std::vector<double>> errors;
  for (std::size_t o = 0; o < observations.size(); ++o) {
    if (!bench_.predictions()[observations[o].point].reached || std::isfinite(observations[o].deviation)) continue;
    errors[observations[o].quantity].push_back(bench_.fitted()[o] - observations[o].measured);
  }
  std::map<MeasuredQuantity, double> next_estimates;
  if (has_estimates()) {
    // Each quantity pays for the parameters what they draw from it.
    for (const auto& [quantity, left] : freedom(free)) {
      if (deviation_of(quantity).kind != Deviation::Kind::estimated || !(left > 0.5)) continue;
      next_estimates[quantity] = estimated_deviation(errors[quantity], left);
    }
  }
  double change = 0.0;
  for (std::size_t o = 0; o < observations.size(); ++o) {
    if (std::isfinite(observations[o].deviation)) continue;  // as its log shows it
    const Deviation& d = deviation_of(observations[o].quantity);
    double next = deviations_[o];
    if (d.kind == Deviation::Kind::relative && bench_.predictions()[observations[o].point].reached) {
      next = d.value * std::abs(bench_.fitted()[o]);
    } else if (d.kind == Deviation::Kind::estimated) {
      const auto found = next_estimates.find(observations[o].quantity);
      if (found != next_estimates.end()) next = found->second;
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
    if (std::isfinite(observations[o].deviation)) {
      deviations_[o] = observations[o].deviation;
      continue;
    }
    switch (d.kind) {
      case Deviation::Kind::absolute: deviations_[o] = d.value; break;
      case Deviation::Kind::relative: deviations_[o] = d.value * std::abs(observations[o].measured); break;
      case Deviation::Kind::estimated: deviations_[o] = 0.02 * (typical > 0.0 ? typical : 1.0); break;
      case Deviation::Kind::scatter: break;
    }
  }
}

}  // namespace wingbeat

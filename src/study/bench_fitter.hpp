// Weighted, robust least squares on a bench with some of the parameters free, by Ceres.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "study/bench_model.hpp"
#include "study/fit_loss.hpp"

namespace wingbeat {

class BenchFitter {
 public:
  /// Keeps a reference to the fit. Rows are solved by `for_each`. A copy goes on by itself from where this one stands.
  explicit BenchFitter(const BenchFit& fit, const ForEach& for_each = {});

  BenchModel& bench() { return bench_; }
  const BenchModel& bench() const { return bench_; }
  /// Standard deviations by observation [SI].
  const std::vector<double>& deviations() const { return deviations_; }
  const std::map<MeasuredQuantity, double>& estimated() const { return estimated_; }
  /// Far from the least a redescending loss knows no way to it: a convex one leads there.
  void use_convex_loss() { loss_ = fit_.loss == Loss::cauchy ? Loss::huber : fit_.loss; }
  void use_own_loss() { loss_ = fit_.loss; }

  struct Outcome {
    bool converged = false;
    std::string message;
    double cost = std::numeric_limits<double>::infinity();  ///< sum of rho(r^2)
    std::vector<double> x;
  };

  /// Minimises over the parameters in `free` from x, at the present deviations, to a relative `tolerance` of the loss.
  Outcome solve(std::vector<double> x, const std::vector<std::size_t>& free, int iterations = 100,
                double tolerance = 1e-9);

  /// Sum of rho(r^2) at the bench's present state.
  double cost() const;
  /// The loss at a residual.
  LossAt loss_at(std::size_t o) const { return wingbeat::loss_at(loss_, fit_.loss_scale, residual(o)); }
  /// In standard deviations.
  double residual(std::size_t o) const {
    return (bench_.fitted()[o] - bench_.observations()[o].measured) / deviations_[o];
  }

  bool has_estimates() const;
  /// Degrees of freedom that the parameters in `free` leave to each quantity's values, by what they draw from them.
  std::map<MeasuredQuantity, double> freedom(const std::vector<std::size_t>& free);
  /// Deviations from the present predictions; largest relative change of one.
  double renew_deviations(const std::vector<std::size_t>& free);

 private:
  struct Callback;
  class Residual;

  const Deviation& deviation_of(const MeasuredQuantity& q) const { return fit_.deviations.at(q); }
  void first_deviations();
  /// The deviation that `errors` show of which the parameters leave so many degrees of freedom.
  double estimated_deviation(const std::vector<double>& errors, double freedom) const;

  const BenchFit& fit_;
  Loss loss_;
  BenchModel bench_;
  std::vector<double> deviations_;
  std::map<MeasuredQuantity, double> estimated_;
};

}  // namespace wingbeat

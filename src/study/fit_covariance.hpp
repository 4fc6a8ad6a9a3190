// How uncertain fitted parameters are: covariance, degrees of freedom, and what the loss's profile is measured in.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "study/bench_fitter.hpp"

namespace wingbeat {

/// Values whose residuals scatter alike: those of a column, or of all columns of which there are too few values each.
struct NoiseGroup {
  double slope = 1.0;         ///< mean of psi' over the residuals, A
  double square = 1.0;        ///< mean of psi^2, B
  double freedom = infinity;  ///< degrees of freedom from which its variance is known
  bool estimated = false;     ///< its standard deviation, too, comes from the residuals
  /// Of a value's information on the parameters, what its loss leaves.
  double efficiency() const { return slope * slope / square; }
};

/// The residuals at the fitter's present state by group. Under a robust loss A and B are those of the residuals (the
/// sandwich of Huber and Godambe), so that they hold for normal noise with outliers, too.
class FitNoise {
 public:
  FitNoise(const BenchFit& fit, BenchFitter& fitter, const std::vector<std::size_t>& free);

  const std::vector<NoiseGroup>& groups() const { return groups_; }
  /// Of an observation.
  std::size_t group_of(std::size_t o) const { return group_of_[o]; }
  double efficiency(std::size_t o) const { return groups_[group_of_[o]].efficiency(); }

 private:
  std::vector<NoiseGroup> groups_;
  std::vector<std::size_t> group_of_;
};

/// In the parameters' units times 1/scales.
struct FitCovariance {
  Eigen::MatrixXd covariance;
  std::vector<double> freedom;  ///< of each parameter's error; infinite where no deviation is estimated
  std::vector<double> rise;     ///< of the profiled loss, a standard error away from its least
};

/// Of the parameters with `scales`. Those `loose` are known from their bounds as well. Where deviations are estimated,
/// what their own errors add (M. G. Kenward and J. H. Roger, Biometrics 53, 983 (1997)), and Satterthwaite's degrees of
/// freedom.
FitCovariance fit_covariance(const BenchFit& fit, const BenchFitter& fitter, const FitNoise& noise,
                             const std::vector<double>& scales, const std::vector<bool>& loose);

/// Two-sided 95 % quantile of Student's distribution; the normal one for infinite freedom.
double quantile_95(double freedom);

/// Degrees of freedom that the values of a column whose deviation is estimated must have left where other columns are
/// fitted beside it, and under a robust loss, which needs them for any residuals.
inline constexpr double least_freedom = 6.0, least_robust_freedom = 8.0;

/// Throws ParameterError where intervals cannot hold what they say: too few values of a column whose deviation is
/// estimated, or under a robust loss.
void refuse_few_values(const BenchFit& fit, BenchFitter& fitter, const std::vector<std::size_t>& free);

}  // namespace wingbeat

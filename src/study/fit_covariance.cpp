#include "study/fit_covariance.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>

#include "study/fit_loss.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/study/distribution.hpp"

namespace wingbeat {
namespace {

/// Degrees of freedom from which the residuals of a column with a stated deviation are taken by themselves.
constexpr double own_freedom = 5.0;
/// Least share of values on the steep part of the loss: below there are more outliers than a loss can stand.
constexpr double least_slope = 0.1;

Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& information) {
  // In units of its diagonal: parameters differ by many powers of ten in what is known of them.
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd unit = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(unit.rows(), unit.cols());
  return scale.asDiagonal() * unit.ldlt().solve(identity) * scale.asDiagonal();
}

}  // namespace

FitNoise::FitNoise(const BenchFit& fit, BenchFitter& fitter, const std::vector<std::size_t>& free)
    : group_of_(fitter.bench().observations().size(), 0) {
  const std::map<MeasuredQuantity, double> freedom = fitter.freedom(free);
  const bool robust = fit.loss != Loss::none;
  // Group 0 has what is not a group of its own.
  groups_.emplace_back();
  std::map<MeasuredQuantity, std::size_t> own;
  double shared = 0.0;
  for (const auto& [quantity, left] : freedom) {
    const bool estimated = fit.deviations.at(quantity).kind == Deviation::Kind::estimated;
    if (estimated || (robust && left >= own_freedom)) {
      own[quantity] = groups_.size();
      groups_.push_back({.freedom = left, .estimated = estimated});
    } else {
      shared += left;
    }
  }
  if (robust) groups_[0].freedom = shared;
  std::vector<double> counts(groups_.size(), 0.0), slopes(counts), slope_squares(counts), squares(counts);
  const BenchModel& bench = fitter.bench();
  for (std::size_t o = 0; o < group_of_.size(); ++o) {
    const Observation& observation = bench.observations()[o];
    const auto found = own.find(observation.quantity);
    const std::size_t g = group_of_[o] = found == own.end() ? 0 : found->second;
    if (!bench.predictions()[observation.point].reached) continue;
    const LossAt loss = fitter.loss_at(o);
    counts[g] += 1.0;
    slopes[g] += loss.slope;
    slope_squares[g] += square(loss.slope);
    squares[g] += square(loss.psi);
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    NoiseGroup& group = groups_[g];
    if (std::isfinite(group.freedom)) group.freedom = std::max(group.freedom, 0.5);
    if (!robust || counts[g] == 0.0) continue;
    group.slope = std::max(slopes[g] / counts[g], least_slope);
    // P. J. Huber and E. M. Ronchetti, Robust Statistics, 2nd ed., Wiley 2009, eq. 7.81 to 7.83.
    const double variance = std::max(slope_squares[g] / counts[g] - square(slopes[g] / counts[g]), 0.0);
    const double left = std::min(group.freedom, counts[g]);
    const double correction = 1.0 + (counts[g] - left) / counts[g] * variance / square(group.slope);
    group.square = std::max(squares[g] / left, 1e-12) * square(correction);
  }
}

FitCovariance fit_covariance(const BenchFit& fit, const BenchFitter& fitter, const FitNoise& noise,
                             const std::vector<double>& scales, const std::vector<bool>& loose) {
  const BenchModel& bench = fitter.bench();
  const Eigen::Index n = Eigen::Index(scales.size());
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
  std::vector<Eigen::MatrixXd> of_group(noise.groups().size(), zero);
  for (std::size_t o = 0; o < bench.observations().size(); ++o) {
    if (!bench.predictions()[bench.observations()[o].point].reached) continue;
    Eigen::VectorXd row(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      row[k] = bench.jacobian()(Eigen::Index(o), k) * scales[std::size_t(k)] / fitter.deviations()[o];
    }
    of_group[noise.group_of(o)] += row * row.transpose();
  }
  // What bounds tell of a parameter that the data leave loose: it lies within half their distance of their middle.
  Eigen::MatrixXd bounds = zero;
  for (Eigen::Index k = 0; k < n; ++k) {
    const FreeParameter& p = fit.parameters[std::size_t(k)];
    if (loose[std::size_t(k)]) bounds(k, k) = 4.0 * square(scales[std::size_t(k)] / (p.upper - p.lower));
  }
  Eigen::MatrixXd slopes = bounds, squares = bounds, effective = bounds;
  for (std::size_t g = 0; g < of_group.size(); ++g) {
    const NoiseGroup& group = noise.groups()[g];
    slopes += group.slope * of_group[g];
    squares += group.square * of_group[g];
    effective += group.efficiency() * of_group[g];
  }
  const Eigen::MatrixXd inverse = inverse_of(slopes), best = inverse_of(effective);
  const Eigen::MatrixXd plain = inverse * squares * inverse;

  FitCovariance result;
  Eigen::MatrixXd added = zero;
  std::vector<double> unsure(std::size_t(n), 0.0);
  for (std::size_t g = 0; g < of_group.size(); ++g) {
    const NoiseGroup& group = noise.groups()[g];
    if (!std::isfinite(group.freedom)) continue;
    const Eigen::MatrixXd part = inverse * (group.square * of_group[g]) * inverse;
    for (Eigen::Index k = 0; k < n; ++k) unsure[std::size_t(k)] += square(part(k, k)) / group.freedom;
    if (!group.estimated) continue;
    // Of a weight, the inverse of a variance with this freedom: its relative variance.
    const double freedom = std::max(scale_efficiency(fit.loss) * group.freedom - 2.0, 0.5);
    const Eigen::MatrixXd own = group.efficiency() * of_group[g];
    added += 2.0 / freedom * (own - own * best * own);
  }
  result.covariance = plain + 2.0 * plain * added * plain;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double doubt = unsure[std::size_t(k)];
    result.freedom.push_back(doubt > 0.0 ? square(plain(k, k)) / doubt : infinity);
    result.rise.push_back(result.covariance(k, k) / inverse(k, k));
  }
  return result;
}

double quantile_95(double freedom) {
  if (!(freedom < 1e9)) return normal_quantile(0.975);
  return boost::math::quantile(boost::math::students_t(std::max(freedom, 0.5)), 0.975);
}

void refuse_few_values(const BenchFit& fit, BenchFitter& fitter, const std::vector<std::size_t>& free) {
  const std::map<MeasuredQuantity, double> freedom = fitter.freedom(free);
  const bool robust = fit.loss != Loss::none;
  // One column alone has one deviation for all: Student's distribution is exact then.
  const double needed = robust ? least_robust_freedom : freedom.size() > 1 ? least_freedom : 1.0;
  double all = 0.0;
  for (const auto& [quantity, left] : freedom) {
    all += left;
    if (fit.deviations.at(quantity).kind != Deviation::Kind::estimated || left >= needed) continue;
    throw ParameterError(
        "deviation." + name_of(quantity),
        detail::format(
            "cannot be \"estimated\": beside the fitted parameters its values leave %.1f degrees of freedom, "
            "and intervals hold from %.0f on; state it, or measure more",
            left, needed));
  }
  if (robust && all < least_robust_freedom) {
    throw ParameterError("fit.loss",
                         detail::format("%s takes the scatter from the residuals, and beside the fitted parameters the "
                                        "values leave %.1f degrees of freedom where intervals hold from %.0f on; use "
                                        "loss = \"none\" with stated deviations, or measure more",
                                        name_of(fit.loss), all, least_robust_freedom));
  }
}

}  // namespace wingbeat

// Distributions of an uncertain number, sampled by their quantile functions.
#pragma once

#include <limits>
#include <vector>

#include "wingbeat/core/names.hpp"

namespace wingbeat {

enum class DistributionKind { normal, uniform, lognormal };
template <>
inline constexpr std::pair<const char*, DistributionKind> names_of<DistributionKind>[] = {
    {"normal", DistributionKind::normal},
    {"uniform", DistributionKind::uniform},
    {"lognormal", DistributionKind::lognormal}};

/// What an uncertain number may be. A finite `lower` or `upper` truncates a normal or lognormal distribution: what lies
/// beyond is cut off, the rest scaled up.
struct Distribution {
  DistributionKind kind = DistributionKind::normal;
  double centre = 0.0;  ///< normal: mean, lognormal: median, both before truncation; uniform: not used
  double spread = 1.0;  ///< normal: standard deviation, > 0; lognormal: that of the natural logarithm, > 0
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();  ///< > lower

  /// The value below which the share u of the distribution lies, 0 < u < 1.
  double quantile(double u) const;
  /// Of the distribution as truncated, in closed form.
  double mean() const;
  double variance() const;
  /// Share of the untruncated distribution that lies between the bounds; 1 for a uniform one.
  double share_kept() const;
};

/// Distribution function of the standard normal distribution, and its inverse.
double normal_probability(double z);
double normal_quantile(double u);

/// The value below which the share `p` of a sorted sample lies, interpolated; the sample holds one value at least.
double percentile(const std::vector<double>& sorted, double p);

}  // namespace wingbeat

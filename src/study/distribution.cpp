#include "wingbeat/study/distribution.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

namespace wingbeat {
namespace {

double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi); }
/// z density(z), 0 at infinity.
double density_moment(double z) { return std::isinf(z) ? 0.0 : z * density(z); }

/// Probability between two standardised bounds, taken in the tail where both lie.
double between(double a, double b) {
  return a > 0.0 ? normal_probability(-a) - normal_probability(-b) : normal_probability(b) - normal_probability(a);
}

}  // namespace

double percentile(const std::vector<double>& sorted, double p) {
  const double rank = p * double(sorted.size() - 1);
  const std::size_t k = std::min(std::size_t(rank), sorted.size() - 1);
  const std::size_t above = std::min(k + 1, sorted.size() - 1);
  return sorted[k] + (rank - double(k)) * (sorted[above] - sorted[k]);
}

double normal_probability(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_quantile(double u) { return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * u); }

namespace {

/// The bounds of a normal or lognormal distribution in standard deviations.
struct Standardised {
  double a, b;
  explicit Standardised(const Distribution& d) {
    const bool logarithmic = d.kind == DistributionKind::lognormal;
    const auto standard = [&](double x) {
      if (!logarithmic) return (x - d.centre) / d.spread;
      return x > 0.0 ? std::log(x / d.centre) / d.spread : -std::numeric_limits<double>::infinity();
    };
    a = standard(d.lower);
    b = standard(d.upper);
  }
};

}  // namespace

double Distribution::share_kept() const {
  if (kind == DistributionKind::uniform) return 1.0;
  const Standardised z(*this);
  return between(z.a, z.b);
}

double Distribution::quantile(double u) const {
  if (kind == DistributionKind::uniform) return lower + u * (upper - lower);
  const Standardised s(*this);
  // Counted from the end in whose tail the bounds lie, where probabilities keep their digits.
  const double z = s.a > 0.0 ? -normal_quantile((1.0 - u) * normal_probability(-s.a) + u * normal_probability(-s.b))
                             : normal_quantile((1.0 - u) * normal_probability(s.a) + u * normal_probability(s.b));
  const double x = kind == DistributionKind::normal ? centre + spread * z : centre * std::exp(spread * z);
  return std::clamp(x, lower, upper);
}

double Distribution::mean() const {
  if (kind == DistributionKind::uniform) return 0.5 * (lower + upper);
  const Standardised z(*this);
  const double kept = between(z.a, z.b);
  if (kind == DistributionKind::normal) return centre + spread * (density(z.a) - density(z.b)) / kept;
  return centre * std::exp(0.5 * spread * spread) * between(z.a - spread, z.b - spread) / kept;
}

double Distribution::variance() const {
  if (kind == DistributionKind::uniform) return (upper - lower) * (upper - lower) / 12.0;
  const Standardised z(*this);
  const double kept = between(z.a, z.b);
  if (kind == DistributionKind::normal) {
    const double shift = (density(z.a) - density(z.b)) / kept;
    return spread * spread * (1.0 + (density_moment(z.a) - density_moment(z.b)) / kept - shift * shift);
  }
  const double second = std::exp(2.0 * spread * spread) * between(z.a - 2.0 * spread, z.b - 2.0 * spread) / kept;
  const double first = mean() / centre;
  return centre * centre * (second - first * first);
}

}  // namespace wingbeat

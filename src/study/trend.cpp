#include "wingbeat/study/trend.hpp"

#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace wingbeat {
namespace {

double place(double from, double to, int n, int samples) { return from + (to - from) * n / (samples - 1); }

/// Place and least value; what is not finite counts as larger than all that is.
std::pair<double, double> min_between(const AlongTheWay& value, double low, double high) {
  std::uintmax_t evaluations = 40;
  // 13 bits: a minimum is flat, its place is known to the square root of the values' accuracy.
  return boost::math::tools::brent_find_minima(
      [&](double x) {
        const double y = value(x);
        return std::isfinite(y) ? y : std::numeric_limits<double>::max();
      },
      low, high, 13, evaluations);
}

}  // namespace

TrendPeak highest_along(const AlongTheWay& value, double from, double to, int samples) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values;
  int best = -1;
  for (int n = 0; n < samples; ++n) {
    values.push_back(value(place(from, to, n, samples)));
    if (std::isfinite(values.back()) && (best < 0 || values.back() > values[std::size_t(best)])) best = n;
  }
  if (best < 0) return {none, none, false};
  TrendPeak peak{place(from, to, best, samples), values[std::size_t(best)], false};
  const bool left = best > 0 && std::isfinite(values[std::size_t(best - 1)]);
  const bool right = best + 1 < samples && std::isfinite(values[std::size_t(best) + 1]);
  const double low = left ? place(from, to, best - 1, samples) : peak.argument;
  const double high = right ? place(from, to, best + 1, samples) : peak.argument;
  const auto [argument, negative] = min_between([&](double x) { return -value(x); }, low, high);
  if (-negative > peak.value) {
    peak.argument = argument;
    peak.value = -negative;
  }
  const double margin = 2e-4 * std::abs(peak.argument);
  peak.inside = left && right && peak.argument > low + margin && peak.argument < high - margin;
  return peak;
}

TrendPeak dip_along(const AlongTheWay& value, double from, double to, int samples) {
  std::vector<double> values;
  for (int n = 0; n < samples; ++n) values.push_back(value(place(from, to, n, samples)));
  int best = -1;
  for (int n = 1; n + 1 < samples; ++n) {
    const auto value_of = [&](int k) { return values[std::size_t(k)]; };
    if (value_of(n) <= value_of(n - 1) && value_of(n) < value_of(n + 1) && (best < 0 || value_of(n) < value_of(best)))
      best = n;
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (best < 0) return {none, none, false};
  const auto [argument, least] =
      min_between(value, place(from, to, best - 1, samples), place(from, to, best + 1, samples));
  if (values[std::size_t(best)] < least) return {place(from, to, best, samples), values[std::size_t(best)], true};
  return {argument, least, true};
}

double crossing_along(const AlongTheWay& value, double level, double from, double to, int samples) {
  double above = to, at_above = value(to);
  for (int n = samples - 2; n >= 0; --n) {
    double below = place(from, to, n, samples), at_below = value(below);
    if (std::isfinite(at_above) && std::isfinite(at_below) && (at_above < level) != (at_below < level)) {
      while (above - below > 1e-6 * (to - from)) {
        // Regula falsi with a bisection in turn: the curves are smooth, but no end may stay for ever.
        for (const double share : {(level - at_below) / (at_above - at_below), 0.5}) {
          const double x = below + share * (above - below);
          const double y = value(x);
          if (!std::isfinite(y)) return std::numeric_limits<double>::quiet_NaN();
          if ((y < level) == (at_below < level)) {
            below = x;
            at_below = y;
          } else {
            above = x;
            at_above = y;
          }
        }
      }
      return 0.5 * (below + above);
    }
    above = below;
    at_above = at_below;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace wingbeat

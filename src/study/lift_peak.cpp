#include "study/lift_peak.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/domain.hpp"

namespace wingbeat::detail {

double fastest_stroke(const BladeElement<double>& w) {
  return std::min(stroke_speed_at(w, 0.0), flow_speed_max * w.s2 / w.s3);
}

double sinusoidal_lift(const BladeElement<double>& w, double peak) {
  constexpr int instants = 12;
  static const std::array<double, instants> shares = [] {
    std::array<double, instants> of_peak;
    for (int n = 0; n < instants; ++n) of_peak[std::size_t(n)] = std::sin(0.5 * pi * (n + 0.5) / instants);
    return of_peak;
  }();
  double sum = 0.0;
  for (const double share : shares) sum += aero_loads(w, peak * share).lift;
  return sum / instants;
}

bool lift_has_risen(const BladeElement<double>& w, double peak, bool rises) {
  constexpr int slower_strokes = 12;
  constexpr double near = 0.8;
  const double lift = sinusoidal_lift(w, peak);
  if (!(lift > 0.0)) return false;
  double before = 0.0;
  for (int n = 1; n < slower_strokes; ++n) {
    const double share = double(n) / slower_strokes, slower = sinusoidal_lift(w, share * peak);
    const bool goes_on_rising = rises && share > near && slower > before && slower < lift;
    before = slower;
    if (!goes_on_rising && !(slower < (1.0 - 0.25 * (1.0 - share)) * lift)) return false;
  }
  return true;
}

bool peak_is_too_low(std::vector<Trial> lifts) {
  if (lifts.size() < 3) return false;
  if (std::any_of(lifts.begin(), lifts.end(), [](const Trial& t) { return t.gap >= 0.0; })) return false;
  std::partial_sort(lifts.begin(), lifts.begin() + 3, lifts.end(),
                    [](const Trial& x, const Trial& y) { return x.gap > y.gap; });
  const Parabola p({lifts[0], lifts[1], lifts[2]});
  if (!(p.bend < 0.0)) return false;
  const double ln_peak = lifts[0].ln_voltage + p.top();
  const auto [lowest, highest] = std::minmax({lifts[0].ln_voltage, lifts[1].ln_voltage, lifts[2].ln_voltage});
  constexpr double margin = 3e-4;  // of rough trials
  const double may_miss = std::max(0.5 * (lifts[0].gap - lifts[2].gap), margin);
  return ln_peak > lowest && ln_peak < highest && p.value_at_top() + may_miss < 0.0;
}

double towards_peak(const std::vector<Trial>& lifts, double too_fast) {
  constexpr double beyond = 1.04, nearest = 1e-3;
  const auto best =
      std::max_element(lifts.begin(), lifts.end(), [](const Trial& x, const Trial& y) { return x.gap < y.gap; });
  if (best == lifts.end()) return 0.0;
  const double largest = std::exp(best->ln_voltage);
  if (best == lifts.begin()) return largest / beyond;
  if (best + 1 == lifts.end()) {
    if (!(too_fast < beyond * beyond * largest)) return beyond * largest;
    return too_fast > (1.0 + nearest) * largest ? std::sqrt(too_fast * largest) : 0.0;
  }
  const double left = (best - 1)->ln_voltage, right = (best + 1)->ln_voltage;
  const Parabola p({*best, *(best - 1), *(best + 1)});
  const double zero = p.zero();
  if (zero > left - best->ln_voltage && zero < right - best->ln_voltage) {
    return std::exp(best->ln_voltage + zero);
  }
  double ln_top = best->ln_voltage + p.top();
  if (right - left < 2.0 * nearest) return 0.0;
  if (std::abs(ln_top - best->ln_voltage) < nearest) {
    const bool below = best->ln_voltage - left > right - best->ln_voltage;  // the wider side
    ln_top = best->ln_voltage + (below ? -nearest : nearest);
  }
  return std::exp(ln_top);
}

}  // namespace wingbeat::detail

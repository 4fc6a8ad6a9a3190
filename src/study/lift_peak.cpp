#include "study/lift_peak.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"

namespace wingbeat::detail {

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
  std::sort(lifts.begin(), lifts.begin() + 3,
            [](const Trial& x, const Trial& y) { return x.ln_voltage < y.ln_voltage; });
  const Trial &a = lifts[0], &b = lifts[1], &c = lifts[2];
  const double left = (b.gap - a.gap) / (b.ln_voltage - a.ln_voltage);
  const double right = (c.gap - b.gap) / (c.ln_voltage - b.ln_voltage);
  const double bend = (right - left) / (c.ln_voltage - a.ln_voltage);
  if (!(bend < 0.0)) return false;
  const double ln_peak = 0.5 * (a.ln_voltage + b.ln_voltage) - 0.5 * left / bend;
  const double peak = a.gap + (ln_peak - a.ln_voltage) * (left + bend * (ln_peak - b.ln_voltage));
  const double highest = std::max({a.gap, b.gap, c.gap}), lowest = std::min({a.gap, b.gap, c.gap});
  constexpr double margin = 3e-4;  // of rough trials
  const bool between = ln_peak > a.ln_voltage && ln_peak < c.ln_voltage;
  return between && peak + std::max(0.5 * (highest - lowest), margin) < 0.0;
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

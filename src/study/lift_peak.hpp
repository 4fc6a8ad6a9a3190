// How the mean lift of a vehicle depends on its voltage: by the shape of a sinusoidal stroke, and by trials near its
// peak.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "wingbeat/parts/blade_element.hpp"

namespace wingbeat::detail {

/// What one trial gave, in logarithms: of the voltage, and of the value over the one sought.
struct Trial {
  double ln_voltage, gap;
};

/// A parabola through three trials, by the voltage [ln] beyond that of the first.
struct Parabola {
  double value, slope, bend;

  explicit Parabola(const std::array<Trial, 3>& trials) {
    const auto& [a, b, c] = trials;
    const double first = (a.gap - b.gap) / (a.ln_voltage - b.ln_voltage);
    const double second = (b.gap - c.gap) / (b.ln_voltage - c.ln_voltage);
    bend = (first - second) / (a.ln_voltage - c.ln_voltage);
    value = a.gap;
    slope = first + bend * (a.ln_voltage - b.ln_voltage);
  }
  /// Of the side on which it rises; NaN where it has none.
  double zero() const {
    const double root = std::sqrt(slope * slope - 4.0 * bend * value);
    return slope > 0.0 ? -2.0 * value / (slope + root) : 0.5 * (root - slope) / bend;
  }
  double top() const { return -0.5 * slope / bend; }
  double value_at_top() const { return value + 0.5 * slope * top(); }
};

/// The fastest stroke for which the coefficients hold, by the shape of the wings [rad/s].
double fastest_stroke(const BladeElement<double>& wings);

/// Mean lift of a sinusoidal stroke of that peak velocity [rad/s].
double sinusoidal_lift(const BladeElement<double>& wings, double peak);

/// Whether the lift is certainly larger than at any lower voltage, by a sinusoidal stroke of any smaller peak velocity.
/// Where trials have shown that it rises (`rises`), the little slower strokes near a peak need not show it as well.
bool lift_has_risen(const BladeElement<double>& wings, double peak, bool rises);

/// Whether the lifts are all too small, and a parabola through the three largest has its peak between them and too
/// small by more than the fit may miss.
bool peak_is_too_low(std::vector<Trial> lifts);

/// The voltage at which lifts that are all too small may be enough, or have their peak: where the parabola through the
/// largest one and its neighbours has the lift sought or its top, beside a trial that is there already; beside the
/// largest where that is the first or last of them, below a voltage `too_fast` for the coefficients. 0 where nothing
/// more would show it.
double towards_peak(const std::vector<Trial>& lifts, double too_fast);

}  // namespace wingbeat::detail

// Where a quantity that is computed point by point is highest, or crosses a level, along another one.
#pragma once

#include <functional>

namespace wingbeat {

/// Value at a place along the way; absent (NaN) where there is none, as where a vehicle does not flap.
using AlongTheWay = std::function<double(double)>;

struct TrendPeak {
  double argument = 0.0;  ///< place of the highest value; NaN where there is no value anywhere
  double value = 0.0;     ///< the highest value
  bool inside = false;    ///< a maximum between its neighbours; false: at an end of the range, or beside places without
};

/// The highest value between `from` and `to`: the best of `samples` places evenly apart, then refined to a relative
/// width of 1e-4 of the place (Brent). A peak narrower than the samples' distance can be missed.
TrendPeak highest_along(const AlongTheWay& value, double from, double to, int samples = 25);

/// The deepest minimum between two higher neighbours among `samples` places evenly apart, refined in the same way:
/// where a curve dips, not where an end of the range happens to be low. NaN, and not inside, where the curve does not
/// dip.
TrendPeak dip_along(const AlongTheWay& value, double from, double to, int samples = 49);

/// The first place from `to` downwards at which the value passes `level` [1e-6 of the range], NaN where it never does.
double crossing_along(const AlongTheWay& value, double level, double from, double to, int samples = 25);

}  // namespace wingbeat

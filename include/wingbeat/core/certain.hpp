// Signs and least values of a function of one number, found from bounds of it and of its slope over ranges of the
// argument instead of from samples: nothing that is wider than `resolved` stays unseen.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "wingbeat/core/enclosure.hpp"
#include "wingbeat/core/minimise.hpp"
#include "wingbeat/core/root.hpp"

namespace wingbeat {

/// How ranges are divided.
struct Subdivision {
  int first = 16;          ///< parts that the whole is divided into
  double resolved = 1e-8;  ///< narrowest range that is divided no further
  int max_ranges = 20000;  ///< after which the ends of a range decide about it
};

namespace detail {

/// Bounds of f over a range from its value in the middle, too.
inline Interval bounds(const Enclosure& f, double in_middle, double width) {
  return common(f.value, Interval(in_middle) + f.slope * Interval(-0.5 * width, 0.5 * width));
}

template <class Visit>
void for_each_part(double from, double to, int parts, const Visit& visit) {
  for (int n = 0; n < parts; ++n) visit(from + (to - from) * n / parts, from + (to - from) * (n + 1) / parts);
}

}  // namespace detail

/// Arguments, in order, that cut the range into pieces within each of which f keeps its sign: all where f changes it,
/// continuous or not, and any where f comes so near to zero that nothing tells whether it touches it.
/// `enclose(a, b)` is an Enclosure of f over [a, b].
template <class F, class Enclose>
std::vector<double> sign_cuts(const F& f, const Enclose& enclose, double from, double to,
                              const Subdivision& subdivision = {}) {
  std::vector<std::pair<double, double>> open;
  std::vector<double> cuts;
  detail::for_each_part(from, to, subdivision.first, [&](double a, double b) { open.emplace_back(a, b); });
  for (int asked = 0; !open.empty(); ++asked) {
    const auto [a, b] = open.back();
    open.pop_back();
    const double middle = 0.5 * (a + b);
    const Enclosure over = enclose(a, b);
    const double in_middle = f(middle);
    const Interval bounds = detail::bounds(over, in_middle, b - a);
    if (bounds.low > 0.0 || bounds.high < 0.0) continue;
    const bool monotone = over.slope.low > 0.0 || over.slope.high < 0.0;
    const bool narrow = b - a <= subdivision.resolved || asked >= subdivision.max_ranges;
    if (monotone || narrow) {
      if ((f(a) > 0.0) != (f(b) > 0.0)) {
        cuts.push_back(sign_change(f, a, b));
      } else if (!monotone) {
        cuts.push_back(middle);
      }
      continue;
    }
    open.emplace_back(a, middle);
    open.emplace_back(middle, b);
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// The least value of f over the range where it is below `exact_below`, to `accuracy` > 0 or what a range as narrow as
/// `resolved` leaves open; else any value of f, which
/// is then certain not to be less than `exact_below` anywhere. Begins with the value `known`.
template <class F, class Enclose>
Minimum least_value(const F& f, const Enclose& enclose, double from, double to, double exact_below, double accuracy,
                    Minimum known, const Subdivision& subdivision = {}) {
  std::vector<std::pair<double, double>> open;
  const auto note = [&](double argument, double value) {
    if (value < known.value) known = {argument, value};
  };
  const auto may_hold_less = [&](double low) { return low < std::min(exact_below, known.value - accuracy); };
  detail::for_each_part(from, to, subdivision.first, [&](double a, double b) {
    open.emplace_back(a, b);
    note(0.5 * (a + b), f(0.5 * (a + b)));
  });
  for (int asked = 0; !open.empty(); ++asked) {
    const auto [a, b] = open.back();
    open.pop_back();
    const double middle = 0.5 * (a + b), in_middle = f(middle);
    note(middle, in_middle);
    const Enclosure over = enclose(a, b);
    if (!may_hold_less(detail::bounds(over, in_middle, b - a).low)) continue;
    const bool monotone = over.slope.low > 0.0 || over.slope.high < 0.0;
    if (monotone || b - a <= subdivision.resolved || asked >= subdivision.max_ranges) {
      note(a, f(a));
      note(b, f(b));
      continue;
    }
    constexpr double smooth = 1e-2;  // over such a range a parabola finds the least value
    if (b - a > smooth && 0.5 * (b - a) <= smooth) {
      const Minimum here = minimise(f, a, b, subdivision.resolved);
      note(here.argument, here.value);
    }
    open.emplace_back(a, middle);
    open.emplace_back(middle, b);
  }
  return known;
}

}  // namespace wingbeat

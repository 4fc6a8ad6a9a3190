// Bounds of a function and of its derivative over a range of its argument: a scalar that computes with intervals, so
// that what holds of the bounds holds of every argument in the range, to rounding.
#pragma once

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

/// All numbers from `low` to `high`, either of which may be infinite.
struct Interval {
  double low = 0.0, high = 0.0;

  constexpr Interval() = default;
  constexpr Interval(double x) : low(x), high(x) {}
  constexpr Interval(double from, double to) : low(from), high(to) {}

  bool contains(double x) const { return low <= x && x <= high; }
  double width() const { return high - low; }
};

namespace detail {

/// What is not a number, as 0 times infinity is not, may be any.
inline Interval known(double low, double high) {
  return {low == low ? low : -infinity, high == high ? high : infinity};
}

}  // namespace detail

inline Interval operator-(const Interval& a) { return {-a.high, -a.low}; }
inline Interval operator+(const Interval& a, const Interval& b) {
  return detail::known(a.low + b.low, a.high + b.high);
}
inline Interval operator-(const Interval& a, const Interval& b) {
  return detail::known(a.low - b.high, a.high - b.low);
}
inline Interval operator*(const Interval& a, const Interval& b) {
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  if (!(std::abs(p) + std::abs(q) + std::abs(r) + std::abs(s) < infinity)) return {-infinity, infinity};
  return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}
/// Everything where b holds zero.
inline Interval inverse_of(const Interval& b) {
  if (!(b.low > 0.0 || b.high < 0.0)) return {-infinity, infinity};
  return {1.0 / b.high, 1.0 / b.low};
}
inline Interval square(const Interval& a) {
  const double l = a.low * a.low, h = a.high * a.high;
  return {a.contains(0.0) ? 0.0 : std::min(l, h), std::max(l, h)};
}
/// Of what is not negative.
inline Interval sqrt(const Interval& a) { return {std::sqrt(std::max(a.low, 0.0)), std::sqrt(std::max(a.high, 0.0))}; }
inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}
/// What lies in both; of intervals that share nothing but for rounding, a.
inline Interval common(const Interval& a, const Interval& b) {
  const Interval both{std::max(a.low, b.low), std::min(a.high, b.high)};
  return both.low <= both.high ? both : a;
}

/// Of a function over a range of its argument.
struct Enclosure {
  Interval value;
  Interval slope;  ///< of the function by the argument

  Enclosure() = default;
  Enclosure(double constant) : value(constant) {}
  Enclosure(const Interval& values, const Interval& slopes) : value(values), slope(slopes) {}
};

template <>
struct ScalarTraits<Enclosure> {
  using Mask = bool;
  static constexpr int lanes = 1;
  static constexpr bool differentiates = true;
  static constexpr bool reads_tables = false;
  static double value_of(const Enclosure& x) { return 0.5 * (x.value.low + x.value.high); }
};

inline Enclosure operator-(const Enclosure& a) { return {-a.value, -a.slope}; }
inline Enclosure operator+(const Enclosure& a, const Enclosure& b) { return {a.value + b.value, a.slope + b.slope}; }
inline Enclosure operator-(const Enclosure& a, const Enclosure& b) { return {a.value - b.value, a.slope - b.slope}; }
inline Enclosure operator*(const Enclosure& a, const Enclosure& b) {
  return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}
inline Enclosure inverse_of(const Enclosure& a) {
  const Interval inverse = inverse_of(a.value);
  return {inverse, -(a.slope * square(inverse))};
}
inline Enclosure operator/(const Enclosure& a, const Enclosure& b) { return a * inverse_of(b); }
inline Enclosure square(const Enclosure& a) { return {square(a.value), Interval(2.0) * a.value * a.slope}; }
inline Enclosure sqrt(const Enclosure& a) {
  const Interval root = sqrt(a.value);
  return {root, Interval(0.5) * a.slope * inverse_of(root)};
}
inline Enclosure atan(const Enclosure& a) {
  return {{std::atan(a.value.low), std::atan(a.value.high)}, a.slope * inverse_of(Interval(1.0) + square(a.value))};
}
inline Enclosure max(const Enclosure& a, const Enclosure& b) {
  if (a.value.low > b.value.high) return a;
  if (b.value.low > a.value.high) return b;
  return {{std::max(a.value.low, b.value.low), std::max(a.value.high, b.value.high)}, hull(a.slope, b.slope)};
}
inline Enclosure min(const Enclosure& a, const Enclosure& b) { return -max(-a, -b); }
inline Enclosure abs(const Enclosure& a) {
  const Enclosure both = max(a, -a);
  return {{std::max(both.value.low, 0.0), both.value.high}, both.slope};
}

/// Sine and cosine of the argument itself over a range, at most a turn wide.
struct CircleArc {
  Enclosure sine, cosine;
};
inline CircleArc circle_arc(double from, double to) {
  const auto holds = [&](double phase) {  // an angle of that phase
    return std::ceil((from - phase) / two_pi) * two_pi + phase <= to;
  };
  const double s0 = std::sin(from), s1 = std::sin(to), c0 = std::cos(from), c1 = std::cos(to);
  const Interval sine{holds(1.5 * pi) ? -1.0 : std::min(s0, s1), holds(0.5 * pi) ? 1.0 : std::max(s0, s1)};
  const Interval cosine{holds(pi) ? -1.0 : std::min(c0, c1), holds(0.0) ? 1.0 : std::max(c0, c1)};
  return {{sine, cosine}, {cosine, -sine}};
}

}  // namespace wingbeat

// Where a condition on one number changes, and where a function of one number is zero: between two arguments that are
// known to hold the place.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace wingbeat {

/// Two arguments with a change in between.
template <std::floating_point T>
struct Bracket {
  T before;  ///< here the condition holds, or the function is > 0
  T after;   ///< here it fails, or the function is < 0
};

/// Where `holds`, true at `before` and false at `after` (on either side of it, neither is asked), becomes false: the
/// bracket is halved until `narrow` of it is true, or until no number lies inside.
template <std::floating_point T, std::predicate<T> Holds, std::predicate<Bracket<T>> Narrow>
Bracket<T> bisect(const Holds& holds, T before, T after, const Narrow& narrow) {
  Bracket<T> b{before, after};
  while (!narrow(b)) {
    const T middle = T(0.5) * (b.before + b.after);
    if (!(std::min(b.before, b.after) < middle && middle < std::max(b.before, b.after))) break;
    (holds(middle) ? b.before : b.after) = middle;
  }
  return b;
}

/// Bisection on a condition to the last bit.
template <std::floating_point T, std::predicate<T> Holds>
Bracket<T> bisect(const Holds& holds, T before, T after) {
  return bisect(holds, before, after, [](const Bracket<T>&) { return false; });
}

/// Where f, continuous or not, changes its sign between a and b, to an error of `width` (0: to the last bit), by
/// bisection: takes no harm from jumps, poles and zeros of higher order.
template <std::floating_point T, std::invocable<T> F>
T sign_change(const F& f, T a, T b, T width = T(0)) {
  const bool positive = f(a) > T(0);
  const auto [before, after] = bisect([&](T x) { return (f(x) > T(0)) == positive; }, a, b,
                                      [&](const Bracket<T>& x) { return std::abs(x.after - x.before) <= width; });
  return T(0.5) * (before + after);
}

/// The zero of a smooth f that is fa >= 0 at a and fb < 0 at b > a, to a bracket of `resolved` > 0: secants, halved
/// where one end stays (Illinois), and a bisection now and then.
template <std::floating_point T, std::invocable<T> F>
Bracket<T> find_zero(const F& f, T a, T fa, T b, T fb, T resolved) {
  constexpr T least = std::numeric_limits<T>::min();
  bool was_after = false;
  for (int iteration = 0; iteration < 100 && b - a > resolved; ++iteration) {
    T x = b - fb * (b - a) / (fb - fa);
    // Off the ends, so that the far one is kept beyond the zero.
    if (!(x > a + T(0.5) * resolved)) x = a + T(0.5) * resolved;
    if (!(x < b - T(0.5) * resolved)) x = b - T(0.5) * resolved;
    if (iteration % 8 == 7) x = T(0.5) * (a + b);
    const T fx = f(x);
    const bool after = fx < T(0);
    (after ? b : a) = x;
    (after ? fb : fa) = fx == T(0) ? least : fx;
    if (iteration > 0 && after == was_after) (after ? fa : fb) *= T(0.5);
    was_after = after;
  }
  return {a, b};
}

}  // namespace wingbeat

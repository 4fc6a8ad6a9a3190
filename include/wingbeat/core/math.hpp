// Small functions that must be the same for every scalar.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

inline constexpr double pi = std::numbers::pi;
inline constexpr double two_pi = 2.0 * std::numbers::pi;
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double degrees_per_radian = 180.0 / std::numbers::pi;

/// +1 for x >= 0, else -1: a sign that is never zero, so that a branch is always chosen.
template <Scalar S>
S sign_of(const S& x) {
  return select(x >= S(0.0), S(1.0), S(-1.0));
}

template <Scalar S>
S square(const S& x) {
  return x * x;
}

/// 1 / x; batches have a faster one of their own.
template <Scalar S>
S inverse_of(const S& x) {
  return S(1.0) / x;
}

template <Scalar S>
struct Root {
  S value;    ///< sqrt(x)
  S inverse;  ///< 1 / sqrt(x)
};

/// Square root of x > 0 together with its inverse.
template <Scalar S>
Root<S> root_of(const S& x) {
  using std::sqrt;
  const S value = sqrt(x);
  return {value, S(1.0) / value};
}

/// The crank angle (or any angle) brought to [0, 2 pi).
inline double wrap_angle(double angle) {
  const double wrapped = std::fmod(angle, two_pi);
  return wrapped < 0.0 ? wrapped + two_pi : wrapped;
}

}  // namespace wingbeat

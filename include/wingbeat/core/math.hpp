// Small functions that must be the same for every scalar.
#pragma once

#include <cmath>
#include <numbers>

#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

inline constexpr double pi = std::numbers::pi;
inline constexpr double two_pi = 2.0 * std::numbers::pi;
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

/// The crank angle (or any angle) brought to [0, 2 pi).
inline double wrap_angle(double angle) {
  const double wrapped = std::fmod(angle, two_pi);
  return wrapped < 0.0 ? wrapped + two_pi : wrapped;
}

}  // namespace wingbeat

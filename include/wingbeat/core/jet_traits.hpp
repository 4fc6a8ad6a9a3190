// ceres::Jet as a scalar, known by name alone: for declarations that mention dual numbers without computing with them.
// The arithmetic is core/jet.hpp.
#pragma once

#include "wingbeat/core/scalar.hpp"

namespace ceres {

template <typename T, int N>
struct Jet;

}  // namespace ceres

namespace wingbeat {

template <int N>
using Jet = ceres::Jet<double, N>;

template <int N>
struct ScalarTraits<ceres::Jet<double, N>> {
  using Mask = bool;
  static constexpr int lanes = 1;
  static constexpr bool differentiates = true;
  static constexpr bool reads_tables = true;
  static Jet<N> select(bool mask, const Jet<N>& a, const Jet<N>& b) { return mask ? a : b; }
  static bool any(bool mask) { return mask; }
  static bool all(bool mask) { return mask; }
  static double value_of(const Jet<N>& x) { return x.a; }
  static bool has_derivative(const Jet<N>& x) { return (x.v.array() != 0.0).any(); }
};

}  // namespace wingbeat

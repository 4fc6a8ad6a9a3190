// ceres::Jet as a scalar: exact first derivatives. Comparisons look at the value alone.
#pragma once

#include <ceres/jet.h>

#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

template <int N>
using Jet = ceres::Jet<double, N>;

template <int N>
struct ScalarTraits<ceres::Jet<double, N>> {
  using Mask = bool;
  static constexpr int lanes = 1;
};

template <int N>
ceres::Jet<double, N> select(bool mask, const ceres::Jet<double, N>& a, const ceres::Jet<double, N>& b) {
  return mask ? a : b;
}

template <int N>
double value_of(const ceres::Jet<double, N>& x) {
  return x.a;
}

}  // namespace wingbeat

// An xsimd batch as a scalar: one design per lane.
//
// xsimd 8.1 lets the ternary operator and `if` compile on an AVX-512 mask and takes wrong lanes, so kernels use
// select(), any() and all() only.
#pragma once

#include <xsimd/xsimd.hpp>

#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

template <class Arch>
using Batch = xsimd::batch<double, Arch>;

template <class Arch>
struct ScalarTraits<xsimd::batch<double, Arch>> {
  using Mask = xsimd::batch_bool<double, Arch>;
  static constexpr int lanes = int(xsimd::batch<double, Arch>::size);
  static constexpr bool differentiates = false;
  static Batch<Arch> select(const Mask& mask, const Batch<Arch>& a, const Batch<Arch>& b) {
    return xsimd::select(mask, a, b);
  }
  static bool any(const Mask& mask) { return xsimd::any(mask); }
  static bool all(const Mask& mask) { return xsimd::all(mask); }
  static double value_of(const Batch<Arch>& x) { return x.get(0); }
};

}  // namespace wingbeat

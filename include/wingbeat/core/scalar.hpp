// The three scalars the physics runs on: double, ceres::Jet (core/jet.hpp) and a SIMD batch (core/batch.hpp).
//
// Code templated on a scalar S never branches on a comparison of S: it writes select(mask, a, b), which blends lanes
// where a double would branch.
#pragma once

#include <type_traits>

namespace wingbeat {

/// What the library needs to know of a scalar type: `Mask`, the result of comparing two scalars, and `lanes`.
/// Specialised for each scalar; a type without a specialisation is not a Scalar.
template <class S>
struct ScalarTraits {};

template <>
struct ScalarTraits<double> {
  using Mask = bool;
  static constexpr int lanes = 1;
};

template <class S>
concept Scalar = requires { typename ScalarTraits<S>::Mask; };

template <Scalar S>
using Mask = typename ScalarTraits<S>::Mask;

/// `a` where the mask holds, else `b`.
inline double select(bool mask, double a, double b) { return mask ? a : b; }

/// True if the mask holds in any (in every) lane.
inline bool any(bool mask) { return mask; }
inline bool all(bool mask) { return mask; }

/// The plain number inside a scalar, derivatives dropped; of a batch, lane 0.
inline double value_of(double x) { return x; }

}  // namespace wingbeat

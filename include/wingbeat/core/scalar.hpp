// The three scalars the physics runs on: double, ceres::Jet (core/jet.hpp) and SIMD lanes (core/pack.hpp).
//
// Code templated on a scalar S never branches on a comparison of S: it writes select(mask, a, b), which blends lanes
// where a double would branch.
#pragma once

#include <type_traits>

/// Inlined wherever it is called, for speed; where size counts, as in a page, as the compiler decides (core/jet.hpp has
/// the like for dual numbers).
#ifdef __OPTIMIZE_SIZE__
#define WINGBEAT_INLINE_FOR_SPEED inline
#else
#define WINGBEAT_INLINE_FOR_SPEED [[gnu::always_inline]] inline
#endif

namespace wingbeat {

/// What the library needs to know of a scalar type; specialised for each, a type without a specialisation is not a
/// Scalar. `Mask` is the result of comparing two scalars, `lanes` the number of designs side by side,
/// `differentiates` whether derivatives come along, `reads_tables` whether force coefficients may come from a table.
template <class S>
struct ScalarTraits {};

template <>
struct ScalarTraits<double> {
  using Mask = bool;
  static constexpr int lanes = 1;
  static constexpr bool differentiates = false;
  static constexpr bool reads_tables = true;
  static double select(bool mask, double a, double b) { return mask ? a : b; }
  static bool any(bool mask) { return mask; }
  static bool all(bool mask) { return mask; }
  static double value_of(double x) { return x; }
};

template <class S>
concept Scalar = requires { typename ScalarTraits<S>::Mask; };

template <Scalar S>
using Mask = typename ScalarTraits<S>::Mask;

/// `a` where the mask holds, else `b`.
template <Scalar S>
S select(const Mask<S>& mask, const S& a, const S& b) {
  return ScalarTraits<S>::select(mask, a, b);
}

/// True if the mask of an S holds in any (in every) lane.
template <Scalar S>
bool any(const Mask<S>& mask) {
  return ScalarTraits<S>::any(mask);
}
template <Scalar S>
bool all(const Mask<S>& mask) {
  return ScalarTraits<S>::all(mask);
}

/// The plain number inside a scalar, derivatives dropped; of a batch, lane 0.
template <Scalar S>
double value_of(const S& x) {
  return ScalarTraits<S>::value_of(x);
}

/// Whether a number that may be missing, 0 then, has an effect: above 0, or differentiated by; on lanes, in any.
template <Scalar S>
bool acts(const S& x) {
  if constexpr (ScalarTraits<S>::differentiates) return value_of(x) > 0.0 || ScalarTraits<S>::has_derivative(x);
  else return any<S>(x > S(0.0));
}

}  // namespace wingbeat

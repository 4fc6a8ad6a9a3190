// ceres::Jet as a scalar: exact first derivatives. Comparisons look at the value alone. The operations on doubles stand
// here once more: g++ does not inline the expressions of Eigen that are in Ceres' own, with which an orbit of eight
// states took 1.7 times as long.
#pragma once

#include <ceres/jet.h>

#include <cstddef>
#include <utility>

#include "wingbeat/core/jet_traits.hpp"

// Where size counts, as in a page, an operation is a function of its own unless the compiler decides otherwise.
#ifdef __OPTIMIZE_SIZE__
#define WINGBEAT_JET_INLINE [[gnu::flatten]] inline
#define WINGBEAT_JET_PARTIALS_MAX 1000
#else
#define WINGBEAT_JET_INLINE [[gnu::always_inline]] inline
#define WINGBEAT_JET_PARTIALS_MAX 8
#endif

namespace wingbeat::detail {

/// More partials, as gradients have, take longer where they are inlined; one or two are inlined as they are.
template <int N>
constexpr bool inlines_partials = N > 2 && N <= WINGBEAT_JET_PARTIALS_MAX;
using PartialPair [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;

/// The dual number of a value and of the partials that `partial` makes, two by two, of those of other numbers.
template <int N, class Partial>
[[gnu::always_inline]] inline Jet<N> jet_of(double value, const Partial& partial) {
  Jet<N> result;
  result.a = value;
  double* const partials = result.v.data();
  [&]<std::size_t... pair>(std::index_sequence<pair...>) __attribute__((always_inline)) {
    ((*reinterpret_cast<PartialPair*>(partials + 2 * pair) =
          partial([](const Jet<N>& x) __attribute__((always_inline)) {
            return *reinterpret_cast<const PartialPair*>(x.v.data() + 2 * pair);
          })),
     ...);
  }(std::make_index_sequence<std::size_t(N / 2)>());
  if constexpr (N % 2 == 1) {
    partials[N - 1] = partial([](const Jet<N>& x) __attribute__((always_inline)) { return x.v.data()[N - 1]; });
  }
  return result;
}

}  // namespace wingbeat::detail

namespace ceres {

template <int N>
  requires(wingbeat::detail::inlines_partials<N>)
WINGBEAT_JET_INLINE Jet<double, N> operator+(const Jet<double, N>& f, const Jet<double, N>& g) {
  return wingbeat::detail::jet_of<N>(f.a + g.a, [&](auto d) { return d(f) + d(g); });
}

template <int N>
  requires(wingbeat::detail::inlines_partials<N>)
WINGBEAT_JET_INLINE Jet<double, N> operator-(const Jet<double, N>& f, const Jet<double, N>& g) {
  return wingbeat::detail::jet_of<N>(f.a - g.a, [&](auto d) { return d(f) - d(g); });
}

template <int N>
  requires(wingbeat::detail::inlines_partials<N>)
WINGBEAT_JET_INLINE Jet<double, N> operator-(const Jet<double, N>& f) {
  return wingbeat::detail::jet_of<N>(-f.a, [&](auto d) { return -d(f); });
}

template <int N>
  requires(wingbeat::detail::inlines_partials<N>)
WINGBEAT_JET_INLINE Jet<double, N> operator*(const Jet<double, N>& f, const Jet<double, N>& g) {
  return wingbeat::detail::jet_of<N>(f.a * g.a, [&](auto d) { return f.a * d(g) + d(f) * g.a; });
}

template <int N>
  requires(wingbeat::detail::inlines_partials<N>)
WINGBEAT_JET_INLINE Jet<double, N> operator*(const Jet<double, N>& f, double s) {
  return wingbeat::detail::jet_of<N>(f.a * s, [&](auto d) { return d(f) * s; });
}

template <int N>
  requires(wingbeat::detail::inlines_partials<N>)
WINGBEAT_JET_INLINE Jet<double, N> operator*(double s, const Jet<double, N>& f) {
  return f * s;
}

template <int N>
  requires(wingbeat::detail::inlines_partials<N>)
WINGBEAT_JET_INLINE Jet<double, N> operator/(const Jet<double, N>& f, const Jet<double, N>& g) {
  const double inverse = 1.0 / g.a, quotient = f.a * inverse;
  return wingbeat::detail::jet_of<N>(quotient, [&](auto d) { return (d(f) - quotient * d(g)) * inverse; });
}

template <int N>
  requires(wingbeat::detail::inlines_partials<N>)
WINGBEAT_JET_INLINE Jet<double, N> operator/(const Jet<double, N>& f, double s) {
  return f * (1.0 / s);
}

}  // namespace ceres

#undef WINGBEAT_JET_INLINE
#undef WINGBEAT_JET_PARTIALS_MAX

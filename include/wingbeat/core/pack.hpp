// K xsimd batches side by side as one scalar: one design per lane, and K independent chains of operations that hide
// each other's latency.
//
// Elementary functions are this file's own: their arguments are bounded in practice, so that short minimax polynomials
// do (errors measured in tests/scalars). Nothing here is defined for plain doubles beyond inlined operators: code built
// for a wide instruction set must not leave functions behind that others could link to.
#pragma once

#include <cstdint>
#include <utility>

#include <xsimd/xsimd.hpp>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

template <class Arch, int K>
struct PackMask {
  using Part = xsimd::batch_bool<double, Arch>;
  Part part[K];

  friend PackMask operator&&(const PackMask& a, const PackMask& b) {
    PackMask r;
    for (int n = 0; n < K; ++n) r.part[n] = a.part[n] & b.part[n];
    return r;
  }
  friend PackMask operator||(const PackMask& a, const PackMask& b) {
    PackMask r;
    for (int n = 0; n < K; ++n) r.part[n] = a.part[n] | b.part[n];
    return r;
  }
  friend PackMask operator!(const PackMask& a) {
    PackMask r;
    for (int n = 0; n < K; ++n) r.part[n] = ~a.part[n];
    return r;
  }
};

template <class Arch, int K>
struct Pack {
  using Part = xsimd::batch<double, Arch>;
  static constexpr int part_lanes = int(Part::size);
  static constexpr int lanes = K * part_lanes;
  Part part[K];

  Pack() = default;
  // Spelt out, or arrays of lanes are copied by calls of memmove.
  Pack(const Pack& x) {
    for (int n = 0; n < K; ++n) part[n] = x.part[n];
  }
  Pack& operator=(const Pack& x) {  // NOLINT(bugprone-unhandled-self-assignment): numbers
    for (int n = 0; n < K; ++n) part[n] = x.part[n];
    return *this;
  }
  Pack(double x) {  // NOLINT: numbers mix freely with lanes
    for (int n = 0; n < K; ++n) part[n] = Part(x);
  }

  static Pack load(const double* aligned) {
    Pack r;
    for (int n = 0; n < K; ++n) r.part[n] = Part::load_aligned(aligned + n * part_lanes);
    return r;
  }
  void store(double* aligned) const {
    for (int n = 0; n < K; ++n) part[n].store_aligned(aligned + n * part_lanes);
  }

#define WINGBEAT_LANES_OPERATOR(op)                                 \
  friend Pack operator op(const Pack& a, const Pack& b) {           \
    Pack r;                                                         \
    for (int n = 0; n < K; ++n) r.part[n] = a.part[n] op b.part[n]; \
    return r;                                                       \
  }
  WINGBEAT_LANES_OPERATOR(+)
  WINGBEAT_LANES_OPERATOR(-)
  WINGBEAT_LANES_OPERATOR(*)
  WINGBEAT_LANES_OPERATOR(/)
#undef WINGBEAT_LANES_OPERATOR
#define WINGBEAT_LANES_COMPARISON(op)                                    \
  friend PackMask<Arch, K> operator op(const Pack & a, const Pack & b) { \
    PackMask<Arch, K> r;                                                 \
    for (int n = 0; n < K; ++n) r.part[n] = a.part[n] op b.part[n];      \
    return r;                                                            \
  }
  WINGBEAT_LANES_COMPARISON(<)
  WINGBEAT_LANES_COMPARISON(<=)
  WINGBEAT_LANES_COMPARISON(>)
  WINGBEAT_LANES_COMPARISON(>=)
  WINGBEAT_LANES_COMPARISON(==)
#undef WINGBEAT_LANES_COMPARISON
  friend Pack operator-(const Pack& a) {
    Pack r;
    for (int n = 0; n < K; ++n) r.part[n] = -a.part[n];
    return r;
  }
};

template <class Arch, int K>
struct ScalarTraits<Pack<Arch, K>> {
  using S = Pack<Arch, K>;
  using Mask = PackMask<Arch, K>;
  static constexpr int lanes = S::lanes;
  static constexpr bool differentiates = false;
  static constexpr bool reads_tables = false;
  static S select(const Mask& mask, const S& a, const S& b) {
    S r;
    for (int n = 0; n < K; ++n) r.part[n] = xsimd::select(mask.part[n], a.part[n], b.part[n]);
    return r;
  }
  static bool any(const Mask& mask) {
    auto together = mask.part[0];
    for (int n = 1; n < K; ++n) together = together | mask.part[n];
    return xsimd::any(together);
  }
  static bool all(const Mask& mask) {
    auto together = mask.part[0];
    for (int n = 1; n < K; ++n) together = together & mask.part[n];
    return xsimd::all(together);
  }
  static double value_of(const S& x) { return x.part[0].get(0); }
};

/// A part whose numbers are those of part_of(lane) in each lane. Choices are those of lane 0.
template <class L, template <Scalar> class Part, class PartOf>
Part<L> in_packs(const PartOf& part_of) {
  // Not Part<double>, on which clang 14 crashes.
  constexpr int count = number_count<Part<L>>;
  alignas(64) double numbers[count][std::size_t(L::lanes)];
  Part<L> part = cast<L>(part_of(0));
  for (int lane = 0; lane < L::lanes; ++lane) {
    int n = 0;
    for_each_number_in_both(part_of(lane), part, [&](double x) { numbers[n++][lane] = x; });
  }
  int n = 0;
  for_each_number(part, [&](L& x) { x = L::load(numbers[n++]); });
  return part;
}

template <class Arch, int K>
Pack<Arch, K> abs(const Pack<Arch, K>& x) {
  Pack<Arch, K> r;
  for (int n = 0; n < K; ++n) r.part[n] = xsimd::abs(x.part[n]);
  return r;
}
template <class Arch, int K>
Pack<Arch, K> min(const Pack<Arch, K>& a, const Pack<Arch, K>& b) {
  Pack<Arch, K> r;
  for (int n = 0; n < K; ++n) r.part[n] = xsimd::min(a.part[n], b.part[n]);
  return r;
}
template <class Arch, int K>
Pack<Arch, K> max(const Pack<Arch, K>& a, const Pack<Arch, K>& b) {
  Pack<Arch, K> r;
  for (int n = 0; n < K; ++n) r.part[n] = xsimd::max(a.part[n], b.part[n]);
  return r;
}
template <class Arch, int K>
Pack<Arch, K> sqrt(const Pack<Arch, K>& x) {
  Pack<Arch, K> r;
  for (int n = 0; n < K; ++n) r.part[n] = xsimd::sqrt(x.part[n]);
  return r;
}
template <class Arch, int K>
Pack<Arch, K> exp(const Pack<Arch, K>& x) {
  Pack<Arch, K> r;
  for (int n = 0; n < K; ++n) r.part[n] = xsimd::exp(x.part[n]);
  return r;
}

namespace detail {

// Estimates of 14 bits where the instruction set has them, else the exact value. Dividing 8 lanes takes as long as 16
// multiplications.
template <class Arch>
xsimd::batch<double, Arch> inverse_of(const xsimd::batch<double, Arch>& x) {
#ifdef __AVX512F__
  if constexpr (Arch::alignment() == 64) {
    const xsimd::batch<double, Arch> one(1.0);
    xsimd::batch<double, Arch> r(_mm512_rcp14_pd(x));
    r = xsimd::fma(r, xsimd::fnma(x, r, one), r);
    return xsimd::fma(r, xsimd::fnma(x, r, one), r);
  } else
#endif
  {
    return xsimd::batch<double, Arch>(1.0) / x;
  }
}

template <class Arch>
xsimd::batch<double, Arch> inverse_sqrt(const xsimd::batch<double, Arch>& x) {
#ifdef __AVX512F__
  if constexpr (Arch::alignment() == 64) {
    using B = xsimd::batch<double, Arch>;
    const B half(0.5), half_x = half * x;
    B r(_mm512_rsqrt14_pd(x));
    for (int n = 0; n < 2; ++n) r = xsimd::fma(r, xsimd::fnma(half_x * r, r, half), r);
    return r;
  } else
#endif
  {
    return xsimd::batch<double, Arch>(1.0) / xsimd::sqrt(x);
  }
}

/// Rounds to the nearest whole number by adding 1.5 2^52; `magic` is the sum, whose last bits count.
template <class B>
B round_to(const B& x, B& magic) {
  const B shift(6755399441055744.0);
  magic = x + shift;
  return magic - shift;
}

/// x with its sign turned where the count is odd.
template <class B>
B flip_sign(const B& x, const B& magic) {
  using Integers = xsimd::batch<std::int64_t, typename B::arch_type>;
  const Integers flip = xsimd::bitwise_cast<Integers>(magic) << 63;
  return xsimd::bitwise_cast<B>(xsimd::bitwise_cast<Integers>(x) ^ flip);
}

template <class B>
B polynomial(const B&, double last) {
  return B(last);
}
template <class B, class... Rest>
B polynomial(const B& z, double first, Rest... rest) {
  return xsimd::fma(polynomial(z, rest...), z, B(first));
}

/// sin r, |r| <= pi/2, relative error 8e-16 before rounding.
template <class B>
B sine_of_reduced(const B& r) {
  const B z = r * r;
  return xsimd::fma(
      r * z,
      polynomial(z, -0.16666666666666649, 0.0083333333333259329, -0.00019841269836469024, 2.7557318055685783e-6,
                 -2.5051972921545551e-8, 1.6050972244135636e-10, -7.4080548895426104e-13),
      r);
}

/// cos r, |r| <= pi/2, error 7e-17 before rounding.
template <class B>
B cosine_of_reduced(const B& r) {
  const B z = r * r;
  return xsimd::fma(
      z * z,
      polynomial(z, 0.041666666666666657, -0.0013888888888884767, 2.4801587298913551e-5, -2.7557318573366175e-7,
                 2.0876681558867395e-9, -1.1466252259718479e-11, 4.6464359591124806e-14),
      xsimd::fnma(B(0.5), z, B(1.0)));
}

/// x - n pi in [-pi/2, pi/2], n counted by `magic`. pi is off by 1.2e-16, which is nothing where n is small.
template <class B>
B reduce_by_pi(const B& x, B& magic) {
  const B n = round_to(x * B(1.0 / pi), magic);
  return xsimd::fnma(n, B(pi), x);
}

}  // namespace detail

/// 1 / x to within rounding, x normal.
template <class Arch, int K>
Pack<Arch, K> inverse_of(const Pack<Arch, K>& x) {
  Pack<Arch, K> r;
  for (int n = 0; n < K; ++n) r.part[n] = detail::inverse_of(x.part[n]);
  return r;
}

/// 1 / sqrt(x) to within rounding, x > 0 and normal.
template <class Arch, int K>
Pack<Arch, K> inverse_sqrt(const Pack<Arch, K>& x) {
  Pack<Arch, K> r;
  for (int n = 0; n < K; ++n) r.part[n] = detail::inverse_sqrt(x.part[n]);
  return r;
}

template <class Arch, int K>
Root<Pack<Arch, K>> root_of(const Pack<Arch, K>& x) {
  const Pack<Arch, K> inverse = inverse_sqrt(x);
  return {x * inverse, inverse};
}

/// Absolute error 4e-16 for |x| <= 30, growing with |x|.
template <class Arch, int K>
Pack<Arch, K> sin(const Pack<Arch, K>& x) {
  Pack<Arch, K> result;
  for (int n = 0; n < K; ++n) {
    typename Pack<Arch, K>::Part magic;
    const auto r = detail::reduce_by_pi(x.part[n], magic);
    result.part[n] = detail::flip_sign(detail::sine_of_reduced(r), magic);
  }
  return result;
}

template <class Arch, int K>
Pack<Arch, K> cos(const Pack<Arch, K>& x) {
  Pack<Arch, K> result;
  for (int n = 0; n < K; ++n) {
    typename Pack<Arch, K>::Part magic;
    const auto r = detail::reduce_by_pi(x.part[n], magic);
    result.part[n] = detail::flip_sign(detail::cosine_of_reduced(r), magic);
  }
  return result;
}

template <Scalar S>
struct SineCosine {
  S sine, cosine;
};

/// Sine and cosine of |x| <= pi/2, without reduction.
template <class Arch, int K>
SineCosine<Pack<Arch, K>> sine_cosine_of_reduced(const Pack<Arch, K>& x) {
  SineCosine<Pack<Arch, K>> r;
  for (int n = 0; n < K; ++n) {
    r.sine.part[n] = detail::sine_of_reduced(x.part[n]);
    r.cosine.part[n] = detail::cosine_of_reduced(x.part[n]);
  }
  return r;
}

/// Nearest whole number.
template <class Arch, int K>
Pack<Arch, K> nearest_whole(const Pack<Arch, K>& x) {
  Pack<Arch, K> r;
  for (int n = 0; n < K; ++n) {
    typename Pack<Arch, K>::Part magic;
    r.part[n] = detail::round_to(x.part[n], magic);
  }
  return r;
}

/// Arc tangent, relative error 2e-16 before rounding.
template <class Arch, int K>
Pack<Arch, K> atan(const Pack<Arch, K>& x) {
  using B = typename Pack<Arch, K>::Part;
  Pack<Arch, K> result;
  for (int n = 0; n < K; ++n) {
    const B y = xsimd::abs(x.part[n]), one(1.0);
    // atan y = pi/4 + atan((y - 1) / (y + 1)) and pi/2 - atan(1 / y) leave |t| <= tan(pi/8).
    const auto above_eighth = y > B(0.41421356237309503), above_three_eighths = y > B(2.4142135623730949);
    const B divided = xsimd::select(above_three_eighths, -one, xsimd::select(above_eighth, y - one, y));
    const B divisor = xsimd::select(above_three_eighths, y, xsimd::select(above_eighth, y + one, one));
    const B offset = xsimd::select(above_three_eighths, B(0.5 * pi), xsimd::select(above_eighth, B(0.25 * pi), B(0.0)));
    const B t = divided * detail::inverse_of(divisor);
    const B z = t * t;
    const B value = xsimd::fma(t * z,
                               detail::polynomial(z, -0.33333333333333248, 0.19999999999898407, -0.14285714266096619,
                                                  0.11111109636534361, -0.09090852557176049, 0.076910551583931494,
                                                  -0.066496136952916687, 0.057363321659076427, -0.044833346222728859,
                                                  0.022750526993361671),
                               t) +
                    offset;
    result.part[n] = xsimd::copysign(value, x.part[n]);
  }
  return result;
}

}  // namespace wingbeat

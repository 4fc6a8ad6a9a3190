// Translational force coefficients over the angle of attack: waves, a force along the chord, or a table; model.md
// section 3, eqs (12, 13).
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <type_traits>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/coefficient_table.hpp"

namespace wingbeat {

/// A force coefficient as a wave over the angle of attack: sine for lift, cosine for drag. With offset a, amplitude b,
/// rate m and phase \f$\alpha_0\f$:
/// \f[
/// C_\mathrm{L}(\alpha) = a + b \sin(m \alpha + \alpha_0), \qquad
/// C_\mathrm{D}(\alpha) = a + b \cos(m \alpha + \alpha_0)
/// \f]
template <Scalar S>
struct CoefficientWave {
  S offset;     ///< [1]
  S amplitude;  ///< [1]
  S rate;       ///< multiplies the angle of attack [1]
  S phase;      ///< [rad]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.offset, self.amplitude, self.rate, self.phase);
  }
};

/// What SIMD lanes, which read no tables by themselves, know of their designs' tables and of where the coefficients
/// have a kink: at a stop of the pitching, or where a table begins, below which its end value holds. Either all lanes
/// have a table or none, and either all have a kink or none.
template <Scalar S>
struct LaneTables {
  CoefficientLookup lookup[std::size_t(ScalarTraits<S>::lanes)];
  S front, steps_per_angle, last_step;  ///< of them, where they have steps
  S kink;                               ///< angle of attack below which the coefficients are those there [rad]
  bool from_tables = false, kinks = false;

  LaneTables(std::nullptr_t = nullptr) {}  // NOLINT: of lanes without
};

/// Translational force coefficients: two waves, with a force along the chord beside them or not, or a table.
template <Scalar S>
struct ForceCoefficients {
  using Table =
      std::conditional_t<ScalarTraits<S>::reads_tables, std::shared_ptr<const CoefficientTable>, LaneTables<S>>;

  CoefficientWave<S> lift;
  CoefficientWave<S> drag;
  Table table = nullptr;
  S tangential = S(0);  ///< \f$C_\mathrm{T,0}\f$ of tangential_coefficient() [1], >= 0; not with a table

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.lift, self.drag, self.table, self.tangential);
  }
};

/// "translational-2022": eqs (12, 13) of the 2022 friction paper, fitted for angles of attack from 0 to 90 degrees.
/// \f[
/// C_\mathrm{L} = 0.225 + 1.58 \sin(2.13\, \alpha - 7.2^\circ), \qquad
/// C_\mathrm{D} = 1.92 - 1.55 \cos(2.04\, \alpha - 9.82^\circ)
/// \f]
inline ForceCoefficients<double> translational_2022() {
  return {{0.225, 1.58, 2.13, -7.2 / degrees_per_radian}, {1.92, -1.55, 2.04, -9.82 / degrees_per_radian}, nullptr};
}

/// C_L and C_D [1].
template <Scalar S>
struct LiftAndDrag {
  S lift, drag;
};

namespace detail {

/// A table piece at alpha: the piece is chosen by value, the polynomial carries the derivatives.
template <Scalar S, class Choose>
S evaluate_table(const Choose& choose, const S& alpha) {
  const CoefficientTable::Cubic p = choose(value_of(alpha));
  const S t = alpha - S(p.x0);
  return S(p.a) + t * (S(p.b) + t * (S(p.c) + t * S(p.d)));
}

/// The coefficients of the lanes' tables, each on its own piece; above the first knot's piece none is a constant, so
/// that it goes on smoothly below the table.
template <Scalar S>
[[gnu::always_inline]] inline LiftAndDrag<S> read_tables(const LaneTables<S>& tables, const S& alpha) {
  constexpr int lanes = ScalarTraits<S>::lanes;
  alignas(64) double step_position[std::size_t(lanes)], step[std::size_t(lanes)], along[std::size_t(lanes)],
      lift[std::size_t(lanes)], drag[std::size_t(lanes)];
  alpha.store(step_position);
  const S place = (alpha - tables.front) * tables.steps_per_angle;
  const S in_order = min(select<S>(place > S(0.5), nearest_whole(S(place - S(0.5))), S(0.0)), tables.last_step);
  in_order.store(step);
  S(place - in_order).store(along);
  for (int lane = 0; lane < lanes; ++lane) {
    const CoefficientLookup& table = tables.lookup[lane];
    if (table.step) {
      const CoefficientLookup::Step& s = table.step[int(step[lane])];
      const double t = along[lane];
      lift[lane] = s.lift[0] + t * (s.lift[1] + t * (s.lift[2] + t * s.lift[3]));
      drag[lane] = s.drag[0] + t * (s.drag[1] + t * (s.drag[2] + t * s.drag[3]));
      continue;
    }
    const int k = table.knots_up_to(step_position[lane]);
    const CoefficientLookup::Row& r = table.row[k > 1 ? k : 1];
    const double t = step_position[lane] - r.x0;
    lift[lane] = r.lift[0] + t * (r.lift[1] + t * (r.lift[2] + t * r.lift[3]));
    drag[lane] = r.drag[0] + t * (r.drag[1] + t * (r.drag[2] + t * r.drag[3]));
  }
  return {S::load(lift), S::load(drag)};
}

}  // namespace detail

/// C_T [1] along the chord towards the trailing edge, over the amplitude \f$C_\mathrm{T,0}\f$, at the angle of attack
/// alpha [rad], below 45 degrees alone (Dickinson, Lehmann and Sane, Science 284, 1999).
/// \f[
/// \frac{C_\mathrm{T}}{C_\mathrm{T,0}} = \cos^2 2\alpha \quad \text{where } |\alpha| < \frac{\pi}{4},
/// \text{ else } 0
/// \f]
template <Scalar S>
S tangential_coefficient(const S& alpha) {
  using std::abs;
  using std::cos;
  return select<S>(abs(alpha) < S(0.25 * pi), square(S(cos(S(S(2.0) * alpha)))), S(0.0));
}

/// The wave of eq 12 [1], \f$a_\mathrm{L} + b_\mathrm{L} \sin(m_\mathrm{L} \alpha + \alpha_\mathrm{0,L})\f$.
template <Scalar S>
WINGBEAT_INLINE_FOR_SPEED S lift_wave(const ForceCoefficients<S>& c, const S& alpha) {
  using std::sin;
  return c.lift.offset + c.lift.amplitude * sin(c.lift.rate * alpha + c.lift.phase);
}

/// The wave of eq 13 [1], \f$a_\mathrm{D} + b_\mathrm{D} \cos(m_\mathrm{D} \alpha + \alpha_\mathrm{0,D})\f$.
template <Scalar S>
WINGBEAT_INLINE_FOR_SPEED S drag_wave(const ForceCoefficients<S>& c, const S& alpha) {
  using std::cos;
  return c.drag.offset + c.drag.amplitude * cos(c.drag.rate * alpha + c.drag.phase);
}

/// C_L [1] (eq 12) at angle of attack alpha [rad]: a sine of CoefficientWave, less the share of a force along the
/// chord, or the table's spline.
/// \f[
/// C_\mathrm{L}(\alpha) = a_\mathrm{L} + b_\mathrm{L} \sin(m_\mathrm{L} \alpha + \alpha_\mathrm{0,L})
/// - C_\mathrm{T} \sin\alpha
/// \f]
template <Scalar S>
S lift_coefficient(const ForceCoefficients<S>& c, const S& alpha) {
  using std::sin;
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (c.table) return detail::evaluate_table([&](double x) { return c.table->lift_piece(x); }, alpha);
  }
  const S wave = lift_wave(c, alpha);
  if (!acts(c.tangential)) return wave;
  return wave - c.tangential * tangential_coefficient(alpha) * sin(alpha);
}

/// C_D [1] (eq 13) at angle of attack alpha [rad]: a cosine of CoefficientWave and the share of a force along the
/// chord, or the table's spline.
/// \f[
/// C_\mathrm{D}(\alpha) = a_\mathrm{D} + b_\mathrm{D} \cos(m_\mathrm{D} \alpha + \alpha_\mathrm{0,D})
/// + C_\mathrm{T} \cos\alpha
/// \f]
template <Scalar S>
S drag_coefficient(const ForceCoefficients<S>& c, const S& alpha) {
  using std::cos;
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (c.table) return detail::evaluate_table([&](double x) { return c.table->drag_piece(x); }, alpha);
  }
  const S wave = drag_wave(c, alpha);
  if (!acts(c.tangential)) return wave;
  return wave + c.tangential * tangential_coefficient(alpha) * cos(alpha);
}

namespace detail {

// Out of the way of vehicles with waves alone.
template <Scalar S>
[[gnu::noinline]] LiftAndDrag<S> coefficients_by_every_law(const ForceCoefficients<S>& c, const S& alpha) {
  return {lift_coefficient(c, alpha), drag_coefficient(c, alpha)};
}

}  // namespace detail

/// Both at once. Without `every_law` lanes have neither tables nor forces along the chord.
template <bool every_law, Scalar S>
WINGBEAT_INLINE_FOR_SPEED LiftAndDrag<S> force_coefficients(const ForceCoefficients<S>& c, const S& alpha) {
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (c.table || acts(c.tangential)) return detail::coefficients_by_every_law(c, alpha);
  } else if constexpr (every_law) {
    if (c.table.from_tables) return detail::read_tables(c.table, alpha);
    if (acts(c.tangential)) return detail::coefficients_by_every_law(c, alpha);
  }
  return {lift_wave(c, alpha), drag_wave(c, alpha)};
}

}  // namespace wingbeat

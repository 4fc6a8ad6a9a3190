// Quasi-steady blade-element aerodynamics of all wings together; model.md section 3, eqs (2-4, 12-14).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/clap_and_fling.hpp"
#include "wingbeat/parts/flow_strips.hpp"
#include "wingbeat/parts/force_coefficients.hpp"
#include "wingbeat/parts/induced_velocity.hpp"
#include "wingbeat/parts/load_table.hpp"
#include "wingbeat/parts/tip_loss.hpp"

namespace wingbeat {

inline constexpr double air_kinematic_viscosity = 1.5e-5;  ///< nu of air at 20 degC and 1 atm [m2/s], rounded

/// J_a of all wings [kg m2] by strip theory (model.md section 10).
/// \f[
/// J_\mathrm{a} = \frac{\pi}{4} \rho\, S_{22}
/// \f]
template <Scalar S>
S added_inertia_of(const S& air_density, const S& s22) {
  return S(0.25 * pi) * air_density * s22;
}

/// Aerodynamics of all wings. Positive stroke velocity beta' meets a positive moment that opposes it. Passive pitching
/// (eq 14), lift normal to the stroke plane [N] (eq 2) and moment about the hinges [N m] (eq 3):
/// \f[
/// \alpha = \frac{\pi}{2} - C_\alpha |\dot\beta|, \qquad
/// L = \tfrac12 \rho\, C_\mathrm{L}(\alpha)\, \dot\beta^2 S_2, \qquad
/// M_\mathrm{aero} = \tfrac12 \rho\, C_\mathrm{D}(\alpha)\, \dot\beta |\dot\beta|\, S_3
/// \f]
template <Scalar S>
struct BladeElement {
  S air_density;        ///< rho [kg/m3], >= 0
  S pitch_coefficient;  ///< \f$C_\alpha\f$ [s], >= 0 (eq 14)
  S s2;                 ///< S_2 of all wings [m4], >= 0
  S s3;                 ///< S_3 of all wings [m5], >= 0
  ForceCoefficients<S> coefficients;
  /// Stop of the passive pitching: alpha never falls below it [rad], 0 to pi/2; minus infinity where there is none.
  S angle_of_attack_min = S(-std::numeric_limits<double>::infinity());
  S added_inertia = S(0);  ///< J_a of all wings, of the air that moves normal to the chord [kg m2], >= 0; 0 without
  TipLoss<S> tip = {};
  ClapAndFling<S> clap = {};
  InducedVelocity<S> wake = {};
  TabulatedLoads<S> tabulated = {};  ///< in place of the formulas above, where there is a table
  OnsetFlowOf<S> flow = nullptr;     ///< how the body moves through the air, where it does; needs `wake.strips`

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.air_density, self.pitch_coefficient, self.s2, self.s3, self.coefficients, self.angle_of_attack_min,
               self.added_inertia, self.tip, self.clap, self.wake, self.tabulated, self.flow);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace aerodynamics_key {
inline constexpr ParameterKey air_density{"aerodynamics.air_density", "kg/m3", range::not_negative};
inline constexpr ParameterKey pitch_coefficient{"aerodynamics.pitch_coefficient", "s", range::not_negative};
inline constexpr ParameterKey angle_of_attack{"aerodynamics.angle_of_attack", "rad", range::acute};
inline constexpr ParameterKey angle_of_attack_min{"aerodynamics.angle_of_attack_min", "rad", range::zero_to_acute};
}  // namespace aerodynamics_key

void validate(const BladeElement<double>& wings);

template <Scalar S>
bool has_pitch_stop(const BladeElement<S>& w) {
  return std::isfinite(value_of(w.angle_of_attack_min));
}

/// How far the passive pitching is from its stop at stroke speed |beta'| [rad/s], in the angle of attack [rad]; 1 where
/// there is no stop. Its sign says which branch of aero_loads() holds. On lanes the start of a table counts as well.
/// \f[
/// \frac{\pi}{2} - C_\alpha |\dot\beta| - \alpha_\mathrm{min}
/// \f]
template <Scalar S>
S pitch_margin(const BladeElement<S>& w, const S& stroke_speed) {
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (has_pitch_stop(w)) return S(pi / 2.0) - w.pitch_coefficient * stroke_speed - w.angle_of_attack_min;
  } else {
    if (w.coefficients.table.kinks) return S(pi / 2.0) - w.pitch_coefficient * stroke_speed - w.coefficients.table.kink;
  }
  return S(1.0);
}

/// What the air does to all wings at one instant. Everything that needs one of these reads it here.
template <Scalar S>
struct AeroLoads {
  S angle_of_attack;  ///< alpha, geometric [rad] (eq 14)
  S pitch_margin;     ///< as pitch_margin() [rad]
  S lift;             ///< normal to the stroke plane [N] (eq 2)
  S moment;           ///< \f$M_\mathrm{aero}\f$ about the hinges [N m] (eq 3); a positive one opposes a positive beta'
  S power;            ///< \f$M_\mathrm{aero} \dot\beta\f$, what the air takes from the wings [W] (eq 19)
  /// Of the added mass: its moment is this times beta'', the slope of its momentum J_a sin^2(alpha) beta' by beta'
  /// [kg m2] (model.md section 10). It takes no mean power and is not in `moment` and `power`.
  S added_inertia;
};

/// Whether lanes have to know on which side of a kink their coefficients are.
template <Scalar S>
bool kinks_on_lanes(const BladeElement<S>& w) {
  if constexpr (ScalarTraits<S>::reads_tables) return false;
  else return w.coefficients.table.kinks;
}

/// added_inertia() where there is some, out of the way of vehicles without.
template <Scalar S>
[[gnu::noinline]] S added_inertia_at(const BladeElement<S>& w, const S& alpha, const S& pitching) {
  using std::cos;
  using std::sin;
  const S s = sin(alpha), c = cos(alpha);
  S share = s * s - (S(0.5 * pi) - alpha) * s * c;
  if (ScalarTraits<S>::reads_tables || kinks_on_lanes(w)) share = select<S>(pitching >= S(0.0), share, s * s);
  return w.added_inertia * share;
}

/// Inertia of the air that moves with the wings [kg m2], by which beta'' is multiplied in their moment (model.md
/// section 10), at the angle of attack \f$\alpha = \pi/2 - C_\alpha |\dot\beta|\f$ [rad];
/// \f$J_\mathrm{a} \sin^2\alpha\f$ where the pitching is at its stop. Even and smooth in beta'.
/// \f[
/// J_\mathrm{a} \left( \sin^2\alpha - C_\alpha |\dot\beta| \sin\alpha \cos\alpha \right)
/// \f]
template <Scalar S>
S added_inertia(const BladeElement<S>& w, const S& alpha, const S& pitching) {
  return any<S>(w.added_inertia > S(0.0)) ? added_inertia_at(w, alpha, pitching) : S(0.0);
}

/// Kinetic energy of the air that moves with the wings [J], \f$\tfrac12 J_\mathrm{a} \sin^2\alpha\, \dot\beta^2\f$.
template <Scalar S>
S added_energy(const BladeElement<S>& w, const S& alpha, const S& stroke_velocity) {
  using std::sin;
  if (!any<S>(w.added_inertia > S(0.0))) return S(0.0);
  return S(0.5) * w.added_inertia * square(S(sin(alpha) * stroke_velocity));
}

/// Moment of the profile drag of the tips that do not lift, against the stroke [N m].
/// \f[
/// \tfrac12 \rho\, C_\mathrm{D}(0)\, \dot\beta^2 S_{3,\mathrm{tip}}
/// \f]
template <Scalar S>
S tip_drag_moment(const BladeElement<S>& w, const S& stroke_speed) {
  return S(0.5) * w.air_density * w.tip.profile_drag * square(stroke_speed) * w.tip.s3;
}

/// True where an induced velocity acts; on lanes, of any.
template <Scalar S>
bool has_wake(const BladeElement<S>& w) {
  return any<S>(w.wake.velocity > S(0.0));
}

/// True of wings on a body that moves, or in wind.
template <Scalar S>
bool has_flow(const BladeElement<S>& w) {
  return w.flow != nullptr;
}

/// True where forces are not all of lift_coefficient() and drag_coefficient() of waves, times S_2 and S_3.
inline bool acts_by_strips(const BladeElement<double>& w) {
  return has_wake(w) || w.tip.s3 > 0.0 || w.coefficients.tangential > 0.0;
}

/// Adds lift [N] and, in the place of a drag, moment [N m] of a strip of loads_in_wake(). `half_density`: half of rho;
/// `along_the_flow`: C_L(0).
template <Scalar S>
WINGBEAT_INLINE_FOR_SPEED void add_strip_in_wake(const ForceCoefficients<S>& coefficients, const S& half_density,
                                                 const WakeStrip<S>& strip, const StripFlow<S>& flow, const S& alpha,
                                                 const S& along_the_flow, const S& clap, LiftAndDrag<S>& sum) {
  const LiftAndDrag<S> of_set = force_coefficients<true>(coefficients, S(alpha - flow.inflow_angle));
  const S C_L = of_set.lift - along_the_flow * square(flow.sine), C_D = of_set.drag;
  const S closeness = S(1.0) + (clap - S(1.0)) * square(flow.cosine);
  const S pressure = half_density * flow.square_of_speed * strip.area * closeness;
  sum.lift = sum.lift + pressure * (C_L * flow.cosine - C_D * flow.sine);
  sum.drag = sum.drag + pressure * strip.radius * (C_D * flow.cosine + C_L * flow.sine);
}

namespace detail {

/// The strips of loads_in_wake() of coefficients without a table, several at a time.
LiftAndDrag<double> strips_in_wake(const BladeElement<double>& w, double alpha, double stroke_speed, double clap);

}  // namespace detail

/// Lift [N] and, in the place of a drag, the moment against the stroke [N m] of wings in their wake, at the geometric
/// angle of attack alpha [rad] and the stroke speed |beta'| [rad/s]. With U and phi of strip_flow() at each strip, and
/// with \f$C_\mathrm{L}(\alpha - \varphi) - C_\mathrm{L}(0) \sin^2\varphi\f$ in the place of C_L: a chord along the
/// flow has no side to which to lift, and a set that says otherwise would make the moment jump where the stroke
/// reverses.
/// \f[
/// \begin{aligned}
/// L &= \tfrac12 \rho \sum U^2 \left( C_\mathrm{L}(\alpha - \varphi) \cos\varphi
/// - C_\mathrm{D}(\alpha - \varphi) \sin\varphi \right) c\,\mathrm{d}r \cr
/// M &= \tfrac12 \rho \sum U^2 \left( C_\mathrm{D}(\alpha - \varphi) \cos\varphi
/// + C_\mathrm{L}(\alpha - \varphi) \sin\varphi \right) r\, c\,\mathrm{d}r
/// \end{aligned}
/// \f]
///
/// The factor `clap` of clap and fling multiplies what flapping makes of a strip, so that nothing jumps at a reversal:
/// the share \f$\cos^2\varphi\f$.
template <Scalar S>
[[gnu::noinline]] LiftAndDrag<S> loads_in_wake(const BladeElement<S>& w, const S& alpha, const S& stroke_speed,
                                               const S& clap) {
  LiftAndDrag<S> sum{S(0.0), clap * tip_drag_moment(w, stroke_speed)};
  if constexpr (std::is_same_v<S, double>) {
    if (!w.coefficients.table) {
      const LiftAndDrag<double> strips = detail::strips_in_wake(w, alpha, stroke_speed, clap);
      return {strips.lift, sum.drag + strips.drag};
    }
  }
  const S along_the_flow = force_coefficients<true>(w.coefficients, S(0.0)).lift;
  for (const WakeStrip<S>& strip : strips_of(w.wake).at) {
    add_strip_in_wake(w.coefficients, S(S(0.5) * w.air_density), strip,
                      strip_flow(w.wake.velocity, strip, stroke_speed), alpha, along_the_flow, clap, sum);
  }
  return sum;
}

/// Whether loads depend on where the stroke is.
template <Scalar S>
bool needs_stroke_angle(const BladeElement<S>& w) {
  return claps(w.clap) || knows_stroke_angle(w.tabulated) || has_flow(w);
}

/// The loads at stroke velocity beta' [rad/s] of the sign `stroke`. `pitching` is the branch of the passive pitching:
/// +1 free, -1 at the stop. Without `every_law` lanes know waves alone: no table, no stop, no added
/// mass, no wake, no loss at tips. Always
/// inlined, with all that returns it (motion_at and below): a right-hand side that reads the moment alone pays for
/// nothing else. Eqs (14, 2, 3, 19), with \f$\alpha_\mathrm{min}\f$ in place of a smaller \f$\alpha\f$:
/// \f[
/// \begin{aligned}
/// \alpha &= \frac{\pi}{2} - C_\alpha |\dot\beta|, & L &= \tfrac12 \rho\, C_\mathrm{L}(\alpha)\, \dot\beta^2 S_2, \cr
/// M_\mathrm{aero} &= \tfrac12 \rho\, C_\mathrm{D}(\alpha)\, \dot\beta |\dot\beta|\, S_3, \qquad
/// & P_\mathrm{aero} &= M_\mathrm{aero} \dot\beta
/// \end{aligned}
/// \f]
///
/// all of it times the factor `clap` of clap and fling. Where there is a table of loads, lift and moment are its own,
/// which may depend on the stroke angle beta [rad] as well.
template <bool every_law = true, Scalar S>
WINGBEAT_INLINE_FOR_SPEED AeroLoads<S> aero_loads(const BladeElement<S>& w, const S& stroke_velocity, const S& stroke,
                                                  const S& pitching, [[maybe_unused]] const S& clap = S(1.0),
                                                  [[maybe_unused]] const S& stroke_angle = S(0.0)) {
  const S speed = stroke * stroke_velocity;
  AeroLoads<S> loads;
  S alpha = S(pi / 2.0) - w.pitch_coefficient * speed;
  S at_stop = S(pitching);
  if constexpr (ScalarTraits<S>::reads_tables) alpha = select(pitching >= S(0.0), alpha, w.angle_of_attack_min);
  S read_at = alpha;
  if constexpr (!ScalarTraits<S>::reads_tables && every_law) {
    if (kinks_on_lanes(w)) {
      // Below the start of a table the wing pitches on, up to its stop.
      const S &kink = w.coefficients.table.kink, &stop = w.angle_of_attack_min;
      using std::max;
      const auto held = pitching < S(0.0), stops = kink == stop;
      read_at = select<S>(held, kink, alpha);
      alpha = select<S>(held, select<S>(stops, stop, max(alpha, stop)), alpha);
      at_stop = select<S>(stops, pitching, S(1.0));
    }
  }
  loads.angle_of_attack = alpha;
  loads.pitch_margin = S(1.0);
  if constexpr (ScalarTraits<S>::reads_tables || every_law) loads.pitch_margin = pitch_margin(w, speed);
  loads.added_inertia = S(0.0);
  if constexpr (every_law) loads.added_inertia = added_inertia(w, alpha, at_stop);
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (is_given(w.tabulated)) {
      const TableLoads<S> of_table = table_loads<S>(w.tabulated, {stroke_angle, stroke_velocity, S(0.0), S(0.0)});
      loads.lift = of_table.lift;
      loads.moment = of_table.stroke_moment;
      loads.power = loads.moment * stroke_velocity;
      return loads;
    }
    if (has_flow(w)) {
      const FlowTotals<S> strips = loads_in_flow<S>(w.coefficients, S(S(0.5) * w.air_density), w.wake, *w.flow, read_at,
                                                    stroke_angle, stroke_velocity, stroke, clap);
      loads.lift = strips.lift;
      loads.moment = strips.moment + stroke * clap * tip_drag_moment(w, speed);
      loads.power = loads.moment * stroke_velocity;
      return loads;
    }
  }
  if constexpr (every_law) {
    if (has_wake(w)) {
      const LiftAndDrag<S> strips = loads_in_wake(w, read_at, speed, clap);
      loads.lift = strips.lift;
      loads.moment = stroke * strips.drag;
      loads.power = loads.moment * stroke_velocity;
      return loads;
    }
  }
  const auto [C_L, C_D] = force_coefficients<every_law>(w.coefficients, read_at);
  S s2 = w.s2, s3 = w.s3;
  if constexpr (every_law) s2 = s2 - w.tip.s2, s3 = s3 - w.tip.s3;
  loads.lift = S(0.5) * w.air_density * C_L * square(speed) * s2;
  loads.moment = stroke * (S(0.5) * w.air_density * C_D * square(speed) * s3);
  if constexpr (every_law) loads.moment = loads.moment + stroke * tip_drag_moment(w, speed);
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (claps(w.clap)) loads.lift = clap * loads.lift, loads.moment = clap * loads.moment;
  }
  loads.power = loads.moment * stroke_velocity;
  return loads;
}

/// The loads at stroke speed |beta'| [rad/s], on the branch of the pitching that holds.
template <Scalar S>
WINGBEAT_INLINE_FOR_SPEED AeroLoads<S> aero_loads(const BladeElement<S>& w, const S& stroke_speed) {
  return aero_loads(w, stroke_speed, S(1.0), pitch_margin(w, stroke_speed));
}

/// Whether more than waves of coefficients acts, so that lanes need `every_law` of aero_loads(); of scalars always.
template <Scalar S>
bool has_further_laws(const BladeElement<S>& w) {
  if constexpr (ScalarTraits<S>::reads_tables) return true;
  return kinks_on_lanes(w) || acts(w.added_inertia) || has_wake(w) || acts(w.tip.s3) || acts(w.coefficients.tangential);
}

/// The moment of these loads [N m], out of the way of wings without further laws.
template <Scalar S>
[[gnu::noinline]] S moment_by_every_law(const BladeElement<S>& w, const S& stroke_speed) {
  return aero_loads(w, stroke_speed).moment;
}

/// The stroke speed |beta'| [rad/s] at which passive pitching without a stop brings the angle of attack down to alpha
/// [rad]: eq (14) solved for it.
/// \f[
/// |\dot\beta| = \frac{\pi/2 - \alpha}{C_\alpha}
/// \f]
template <Scalar S>
S stroke_speed_at(const BladeElement<S>& w, const S& alpha) {
  return (S(0.5 * pi) - alpha) / w.pitch_coefficient;
}

}  // namespace wingbeat

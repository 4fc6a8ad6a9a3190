// Wings that pitch about an elastic hinge, pitch being a degree of freedom beside the stroke: inertia with the air that
// moves along, loads of blade elements, and what of it the stroke sees; model.md section 12.
//
// Everything is of all wings together. The kinetic energy of wings and added mass is
//   T = 1/2 M_bb beta'^2 + M_bp beta' psi' + 1/2 M_pp psi'^2,
// the equations of motion are M (beta'', psi'') + (h_b, h_p) = loads. Neither of them knows what drives the stroke: a
// crank and a direct drive take the same parts, by the condensed inertia and moment of wings_at_pitch().
#pragma once

#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/blade_element.hpp"
#include "wingbeat/parts/pitch_hinge.hpp"
#include "wingbeat/parts/pitching_translation.hpp"

namespace wingbeat {

/// Inertia of wings and added mass in stroke and pitch [kg m2], all of all wings together (model.md section 12).
/// \f[
/// M_{bb} = N_\mathrm{w} J_\mathrm{w} + I_\psi \sin^2\psi + m_{rr} \cos^2\psi, \qquad
/// M_{bp} = (P + m_{rp}) \cos\psi, \qquad M_{pp} = I_\psi + m_{pp}
/// \f]
template <Scalar S>
struct PitchInertia {
  S bb;  ///< \f$M_{bb}\f$
  S bp;  ///< \f$M_{bp}\f$
  S pp;  ///< \f$M_{pp}\f$
};

/// `stroke_inertia`: N_w J_w [kg m2], of what else turns with the stroke as the caller likes.
template <Scalar S>
PitchInertia<S> pitch_inertia(const PitchingWings<S>& w, const S& stroke_inertia, const PitchState<S>& state) {
  return {stroke_inertia + w.pitch_inertia * square(state.sin_psi) + w.air.rr * square(state.cos_psi),
          (w.mass_product + w.air.rp) * state.cos_psi, w.pitch_inertia + w.air.pp};
}

/// Kinetic energy [J] of an inertia at pitch and stroke velocity.
/// \f[
/// T = \tfrac12 M_{bb} \dot\beta^2 + M_{bp} \dot\beta \dot\psi + \tfrac12 M_{pp} \dot\psi^2
/// \f]
template <Scalar S>
S kinetic_energy(const PitchInertia<S>& m, const PitchState<S>& state) {
  return S(0.5) * (m.bb * square(state.stroke_velocity) + m.pp * square(state.velocity)) +
         m.bp * state.stroke_velocity * state.velocity;
}

/// What the air does to wings that pitch, without added mass. Moments oppose positive velocities.
template <Scalar S>
struct PitchAeroLoads {
  S angle_of_attack;  ///< \f$\alpha\f$ [rad], over 90 degrees where the wing over-rotates
  S normal_force;     ///< \f$F_\mathrm{N} + F_\mathrm{rot}\f$, normal to the chord, against a positive velocity [N]
  S stroke_moment;    ///< \f$M_\mathrm{aero}\f$ about the stroke hinges [N m]
  S pitch_moment;     ///< \f$M_\mathrm{pitch}\f$ about the pitch hinges [N m]
  S power;            ///< \f$M_\mathrm{aero} \dot\beta + M_\mathrm{pitch} \dot\psi\f$ [W]
  S tangential_lift = S(0.0);  ///< of the force along the chord, and all lift of a table [N]
};

/// What pitching adds to translation, of all wings.
template <Scalar S>
struct PitchRotation {
  S circulation;  ///< q_rot of aero_loads_of(): times a chord moment, a force normal to the chord at mid-chord [kg/(m
                  ///< s2)]
  S damping;      ///< moment about the pitch axis [N m]
};

/// `s40` is the chord moment of the damping; the signs as in aero_loads_of().
template <Scalar S>
PitchRotation<S> pitch_rotation(const BladeElement<S>& w, const PitchingWings<S>& p, const S& s40,
                                const PitchState<S>& state, const S& stroke, const S& turn) {
  const S rho = w.air_density * state.clap;
  const S speed = stroke * state.stroke_velocity;
  const S ahead = p.axis, behind = S(1.0) - p.axis;
  const S breadth = square(square(behind)) + square(square(ahead));
  return {p.rotational_coefficient * rho * speed * state.velocity,
          S(0.125) * rho * p.damping_coefficient * turn * square(state.velocity) * s40 * breadth};
}

/// What the air does at a pitch state; `stroke` and `turn` are the signs of beta' and psi'. With TranslationLoads and
/// the chord moments of all wings (model.md section 12):
/// \f[
/// \begin{aligned}
/// \alpha &= \frac{\pi}{2} + \psi \operatorname{sign}\dot\beta, \qquad
/// q_\mathrm{rot} = C_\mathrm{rot}\, \rho\, |\dot\beta| \dot\psi \cr
/// F_\mathrm{N} + F_\mathrm{rot} &= F_\mathrm{N} + q_\mathrm{rot} S_{21} \cr
/// M_\mathrm{aero} &= M + M_\mathrm{T} + q_\mathrm{rot} S_{22} \cos\psi \cr
/// M_\mathrm{pitch} &= M_\psi + q_\mathrm{rot} \left( \tfrac12 - \hat x_0 \right) S_{31}
/// + \tfrac18 \rho\, C_\mathrm{rd} \left( (1 - \hat x_0)^4 + \hat x_0^4 \right) |\dot\psi| \dot\psi\, S_{40}
/// \end{aligned}
/// \f]
///
/// all of it times the factor of clap and fling. Of a strip the moments are its own, in `s2`, `s3` and `moments`, and
/// so is `in_wake`, which adds its loads to the sum that it is given.
template <Scalar S, class InWake>
PitchAeroLoads<S> aero_loads_of(const BladeElement<S>& w, const PitchingWings<S>& p, const S& s2, const S& s3,
                                const PitchChordMoments<S>& moments, const PitchState<S>& state, const S& stroke,
                                const S& turn, const InWake& in_wake) {
  const AngleOfAttack<S> alpha = angle_of_attack(state, stroke);
  TranslationLoads<S> translation;
  if (has_wake(w) || has_flow(w)) in_wake(alpha, translation);
  else translation = translation_loads(w, p, s2, s3, moments.s22, state, stroke, alpha);
  const auto [rotation, damping] = pitch_rotation(w, p, moments.s40, state, stroke, turn);
  PitchAeroLoads<S> loads;
  loads.angle_of_attack = alpha.angle;
  loads.normal_force = translation.normal + rotation * moments.s21;
  loads.stroke_moment =
      (translation.stroke_moment + rotation * moments.s22) * state.cos_psi + translation.tangential_moment;
  // The force of translation acts at the centre of pressure, that of rotation at mid-chord.
  loads.pitch_moment = translation.pitch_moment + (S(0.5) - p.axis) * rotation * moments.s31 + damping;
  loads.power = loads.stroke_moment * state.stroke_velocity + loads.pitch_moment * state.velocity;
  loads.tangential_lift = translation.tangential_lift;
  return loads;
}

/// aero_loads_of() all wings, or those of a table.
template <Scalar S>
PitchAeroLoads<S> aero_loads(const BladeElement<S>& w, const PitchingWings<S>& p, const PitchState<S>& state,
                             const S& stroke, const S& turn) {
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (is_given(w.tabulated)) {
      const TableLoads<S> loads =
          table_loads<S>(w.tabulated, {state.stroke_angle, state.stroke_velocity, state.psi, state.velocity});
      return {S(0.5 * pi) + stroke * state.psi,
              S(0.0),
              loads.stroke_moment,
              loads.pitch_moment,
              loads.stroke_moment * state.stroke_velocity + loads.pitch_moment * state.velocity,
              loads.lift};
    }
  }
  const auto in_wake = [&](const AngleOfAttack<S>& alpha, TranslationLoads<S>& sum) {
    const S even = even_normal_force(w, p, state.psi);
    if constexpr (ScalarTraits<S>::reads_tables) {
      if (has_flow(w)) {
        for (std::size_t n = 0; n < w.flow->count; ++n) {
          const WingMount& mount = w.flow->mounts[n];
          const StripDrift<S> drift = strip_drift(*w.flow, mount, wing_axes(mount, state.stroke_angle));
          add_strips_in_flow(w, p, mount, drift, state, stroke, even, sum);
        }
        sum.tangential_moment = sum.tangential_moment + S(w.flow->reaction_moment);
        if (acts(w.tip.s3)) add_tip_drag(w, state, stroke, S(centre_of_pressure(p, alpha) - p.axis), sum);
        return;
      }
    }
    for (const WakeStrip<S>& strip : w.wake.strips.at) {
      add_strip_in_wake(w, p, strip, state, stroke, alpha, even, sum);
    }
    if (acts(w.tip.s3)) {
      add_tip_drag(w, state, stroke, S(centre_of_pressure(p, alpha) - p.axis), sum);
    }
  };
  return aero_loads_of(w, p, w.s2, w.s3, p.moments, state, stroke, turn, in_wake);
}

/// Wings that pitch, as the stroke sees them. The moment M of the drive and of the stroke's springs turns them with the
/// inertia \f$I\f$ and the moment \f$M_0\f$, and the pitch follows with the coupling \f$\kappa\f$:
/// \f[
/// M = I \ddot\beta + M_0, \qquad \ddot\psi = \ddot\psi_0 + \kappa\, \ddot\beta
/// \f]
template <Scalar S>
struct WingsAtPitch {
  PitchAeroLoads<S> aero;
  PitchHingeLoads<S> hinge;
  S inertia;            ///< \f$I\f$; \f$M_{bb}\f$ where the wings are held at a stop [kg m2]
  S moment;             ///< \f$M_0\f$ of all that acts on the wings but the springs of the stroke [N m]
  S free_acceleration;  ///< \f$\ddot\psi_0\f$ of a stroke at constant velocity [rad/s2]
  S coupling;           ///< \f$\kappa\f$ of psi'' to beta'' [1]
  /// Of wings that are held at a stop: with coupling_moment beta'' it is the moment that presses towards a positive psi
  /// [N m], and the stop's reaction its negative.
  S pitching_moment;
  S coupling_moment;  ///< \f$-M_{bp}\f$ [kg m2]
};

/// The wings with `stroke_inertia` N_w J_w [kg m2]. `stroke` and `turn` as in aero_loads(); `held` is -1 where a stop
/// holds them (psi' is 0 then), else +1. The equation of motion of the pitch, solved for psi'', leaves of that of the
/// stroke (model.md section 12):
/// \f[
/// \begin{aligned}
/// h_b &= 2 (I_\psi - m_{rr}) \sin\psi \cos\psi\, \dot\beta \dot\psi - (P + m_{rp}) \sin\psi\, \dot\psi^2, \qquad
/// h_p = -(I_\psi - m_{rr}) \sin\psi \cos\psi\, \dot\beta^2 \cr
/// \ddot\psi_0 &= -\frac{h_p + k_\psi \psi + c_\psi \dot\psi + M_\mathrm{pitch}}{M_{pp}}, \qquad
/// \kappa = -\frac{M_{bp}}{M_{pp}} \cr
/// I &= M_{bb} - \frac{M_{bp}^2}{M_{pp}}, \qquad M_0 = h_b + M_\mathrm{aero} + M_{bp} \ddot\psi_0
/// \end{aligned}
/// \f]
template <Scalar S>
WingsAtPitch<S> wings_at_pitch(const BladeElement<S>& w, const PitchingWings<S>& p, const S& stroke_inertia,
                               const PitchState<S>& state, const S& stroke, const S& turn, const S& held) {
  const PitchInertia<S> m = pitch_inertia(p, stroke_inertia, state);
  WingsAtPitch<S> wings;
  wings.aero = aero_loads(w, p, state, stroke, turn);
  wings.hinge = hinge_loads(p.hinge, state.psi, state.velocity, select(held >= S(0.0), turn, S(0.0)));
  const S sc = (p.pitch_inertia - p.air.rr) * state.sin_psi * state.cos_psi;
  const S h_b = S(2.0) * sc * state.stroke_velocity * state.velocity -
                (p.mass_product + p.air.rp) * state.sin_psi * square(state.velocity);
  const S h_p = -sc * square(state.stroke_velocity);
  wings.pitching_moment = -(h_p + wings.hinge.moment + wings.aero.pitch_moment);
  wings.coupling_moment = -m.bp;
  const S per_inertia = select(held >= S(0.0), inverse_of(m.pp), S(0.0));
  wings.free_acceleration = wings.pitching_moment * per_inertia;
  wings.coupling = wings.coupling_moment * per_inertia;
  wings.inertia = m.bb + m.bp * wings.coupling;
  wings.moment = h_b + wings.aero.stroke_moment + m.bp * wings.free_acceleration;
  return wings;
}

/// Momentum of the air that moves with the wings, normal to the chord [N s], with \f$m_r\f$ and \f$m_p\f$ of
/// PitchAddedMass.
/// \f[
/// p_\mathrm{n} = m_r \dot\beta \cos\psi + m_p \dot\psi
/// \f]
template <Scalar S>
S air_momentum(const PitchingWings<S>& p, const PitchState<S>& state) {
  return p.air.r * state.stroke_velocity * state.cos_psi + p.air.p * state.velocity;
}

/// Lift that the added mass's force along the chord takes away where it counts in full [N]: its momentum turns with the
/// wings. Over a closed cycle its mean is that of the force normal to the chord (model.md section 12).
/// \f[
/// p_\mathrm{n} \dot\psi \cos\psi
/// \f]
template <Scalar S>
S chordwise_lift(const PitchingWings<S>& p, const PitchState<S>& state) {
  return air_momentum(p, state) * state.velocity * state.cos_psi;
}

/// Lift of all wings normal to the stroke plane [N] at the accelerations beta'' and psi'' [rad/s2]: that of the forces
/// normal to the chord, of which the air's inertia is one, and of the share \f$s_\mathrm{L}\f$ of its force along the
/// chord that counts.
/// \f[
/// \begin{aligned}
/// F_\mathrm{am} &= \dot p_\mathrm{n} = m_r (\ddot\beta \cos\psi - \dot\beta \dot\psi \sin\psi) + m_p \ddot\psi \cr
/// L &= -(F_\mathrm{N} + F_\mathrm{rot} + F_\mathrm{am}) \sin\psi - s_\mathrm{L}\, p_\mathrm{n} \dot\psi \cos\psi
/// + L_\mathrm{T}
/// \end{aligned}
/// \f]
template <Scalar S>
S lift_at_pitch(const PitchingWings<S>& p, const WingsAtPitch<S>& wings, const PitchState<S>& state,
                const S& stroke_acceleration, const S& pitch_acceleration) {
  const S F_am =
      p.air.r * (stroke_acceleration * state.cos_psi - state.stroke_velocity * state.velocity * state.sin_psi) +
      p.air.p * pitch_acceleration;
  return -(wings.aero.normal_force + F_am) * state.sin_psi - p.edge_suction * chordwise_lift(p, state) +
         wings.aero.tangential_lift;
}

}  // namespace wingbeat

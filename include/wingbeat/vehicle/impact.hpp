// Impacts of wings on the stops of their pitch hinges: what they change at once, and what each part loses; model.md
// section 12.
#pragma once

#include <cmath>

#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat {

/// What an impact on a stop does. Works are those of the impulses at the mean of the velocities before and after:
/// exact, since all velocities change in proportion while the stop takes psi'.
template <Scalar S>
struct StopImpact {
  S shaft_speed;              ///< gained by the crank, or the shaft of a direct drive [rad/s]
  S rod_impulse;              ///< F^, of the rod force [N s]
  S motor_work;               ///< that the rotor passes on behind the gearbox, T_m^ omega [J]
  S gear_work;                ///< lost in the gearbox [J]
  S friction_work;            ///< lost in the friction that the blow on the rod causes [J]
  S residual_work;            ///< what the formulation of the transmission fails to conserve [J]
  S stored_work;              ///< magnitude of the change of N_w J_w beta'^2 / 2 [J]
  S stop_work;                ///< lost at the stop, >= 0 [J]
  S lift;                     ///< impulse of the lift [N s]
  S twist_velocity = S(0.0);  ///< gained by the tip against the root [rad/s]
};

/// Inertia against an impact on the stop, and how the impulse of the lift follows what the velocities of stroke and
/// pitch gain. A twist follows freely: it is eliminated, \f$M_{bb} - M_{b\tau}^2 / M_{\tau\tau}\f$ and so on.
template <Scalar S>
struct ImpactInertia : PitchInertia<S> {
  S lift_by_stroke, lift_by_pitch;    ///< [N s2/rad]
  S twist_by_stroke, twist_by_pitch;  ///< [1]
};
template <template <Scalar> class V, Scalar S, class State>
ImpactInertia<S> impact_inertia(const V<S>& v, const State& instant, const S& stroke_velocity) {
  const PitchingWings<S>& p = v.pitch;
  const S N_J = v.wing_count * v.wing_inertia;
  const PitchState<S> state = pitch_state<S>(instant.pitch_angle, instant.pitch_velocity, stroke_velocity);
  if constexpr (requires { instant.twist; }) {
    if (twists(p.torsion)) {
      const StripSums<S> sum = strip_sums(v.wings, p, N_J, state, instant.twist, S(1.0));
      const TwistInertia<S>& m = sum.inertia;
      const S by_stroke = -m.bt / m.tt, by_pitch = -m.pt / m.tt;
      return {{m.bb + m.bt * by_stroke, m.bp + m.bt * by_pitch, m.pp + m.pt * by_pitch},
              sum.lift.stroke + sum.lift.twist * by_stroke,
              sum.lift.pitch + sum.lift.twist * by_pitch,
              by_stroke,
              by_pitch};
    }
  }
  return {pitch_inertia<S>(p, N_J, state), -p.air.r * state.cos_psi * state.sin_psi, -p.air.p * state.sin_psi, S(0.0),
          S(0.0)};
}

/// The impact of a vehicle at an instant at which its wings are at a stop and move on to it; the shaft moves on in
/// `direction` (the sign of omega), and the pitch velocity falls to `left` [rad/s]. The impulse on the rod, F^ = -e J d
/// omega / (h + s mu r_e), has the sign of -M_bp (psi' - left); e as in IntermediateTerms. With \f$\Delta\f$ for what a
/// velocity gains and \f$\bar\omega = \omega + \tfrac12 \Delta\omega\f$ (model.md section 12):
/// \f[
/// \begin{aligned}
/// e J \Delta\omega &= -\hat F (h + s \mu r_\mathrm{e}), \qquad
/// M_{bb} \Delta\dot\beta + M_{bp} \Delta\dot\psi = \hat F g, \qquad \Delta\dot\beta = B_1 \Delta\omega \cr
/// W_\mathrm{motor} &= -e J \Delta\omega\, \bar\omega, \qquad W_\mathrm{gear} = -(1 - e) J \Delta\omega\, \bar\omega
/// \cr W_\mathrm{friction} &= \mu r_\mathrm{e} |\hat F \bar\omega|, \qquad W_\mathrm{residual} = \hat F (h - g B_1)\,
/// \bar\omega
/// \end{aligned}
/// \f]
template <template <Scalar> class V, Scalar S, class State>
StopImpact<S> stop_impact(const V<S>& v, const State& instant, const S& direction, const S& left = S(0.0)) {
  const CrankKinematics<S>& k = instant.configuration.kinematics;
  const S &omega = instant.omega, &velocity = instant.pitch_velocity;
  const ImpactInertia<S> m = impact_inertia(v, instant, S(k.stroke_slope * omega));
  const S taken = velocity - left;
  const S blow = m.bp * taken;
  const S friction = -sign_of(blow) * direction * v.friction.radius, lever = k.crank_jacobian + friction;
  S J = v.motor.inertia;
  if constexpr (requires { instant.load; }) J = J + instant.inertia;
  S ratio(1.0);
  if (has_gear_loss(v.motor)) ratio = gear_torque_ratio(v.motor, S(-sign_of(S(blow * lever)) * direction));
  const S eJ = ratio * J;
  StopImpact<S> impact;
  impact.shaft_speed = blow * lever / (eJ * k.wing_jacobian + m.bb * k.stroke_slope * lever);
  const S stroke_gain = k.stroke_slope * impact.shaft_speed, mean_speed = omega + S(0.5) * impact.shaft_speed;
  impact.rod_impulse = (m.bb * stroke_gain - blow) / k.wing_jacobian;
  const S rotor_work = -J * impact.shaft_speed * mean_speed;
  impact.motor_work = ratio * rotor_work;
  impact.gear_work = (S(1.0) - ratio) * rotor_work;
  impact.friction_work = impact.rod_impulse * friction * mean_speed;
  impact.residual_work = impact.rod_impulse * (k.crank_jacobian - k.wing_jacobian * k.stroke_slope) * mean_speed;
  const S stored = v.wing_count * v.wing_inertia * stroke_gain * k.stroke_slope * mean_speed;
  impact.stored_work = sign_of(stored) * stored;
  impact.stop_work = S(0.5) * (velocity + left) * (m.pp * taken - m.bp * stroke_gain);
  impact.lift = m.lift_by_stroke * stroke_gain - m.lift_by_pitch * taken;
  impact.twist_velocity = m.twist_by_stroke * stroke_gain - m.twist_by_pitch * taken;
  return impact;
}

/// The impact where friction holds crank or shaft, and the stroke with it, against the blow.
template <template <Scalar> class V, Scalar S, class State>
StopImpact<S> stop_impact_standing(const V<S>& v, const State& instant) {
  const S& velocity = instant.pitch_velocity;
  const ImpactInertia<S> m = impact_inertia(v, instant, S(0.0));
  const S none(0.0);
  return {none,
          -m.bp * velocity / instant.configuration.kinematics.wing_jacobian,
          none,
          none,
          none,
          none,
          none,
          S(0.5) * m.pp * square(velocity),
          -m.lift_by_pitch * velocity,
          -m.twist_by_pitch * velocity};
}

/// The wings meet the stop that they are at: `*instant` becomes the instant after it, and of `*mode` the direction and
/// whether friction still holds the shaft. A shaft that the blow brings to rest turns back where the lever of the rod
/// exceeds that of friction, as does one that friction holds; else the stop takes what is left. use(impact) is called
/// for each part of it.
template <Scalar S, class State, class Use>
void meet_stop(const Vehicle<S>& v, State* instant, Mode<S>* mode, const Use& use) {
  const auto pass = [&](const StopImpact<S>& impact, const S& left) {
    instant->omega = instant->omega + impact.shaft_speed;
    if constexpr (requires { instant->twist; }) {
      instant->twist.velocity = instant->twist.velocity + impact.twist_velocity;
    }
    instant->pitch_velocity = left;
    if (value_of(impact.shaft_speed) != 0.0) mode->slip = S(1.0);
    use(impact);
  };
  if (value_of(instant->omega) != 0.0) {
    const S direction = sign_of(instant->omega);
    const StopImpact<S> whole = stop_impact(v, *instant, direction);
    if (jumps_at_rest(v) && value_of(direction) * value_of(S(instant->omega + whole.shaft_speed)) < 0.0) {
      const S left = (S(1.0) + instant->omega / whole.shaft_speed) * instant->pitch_velocity;
      pass(stop_impact(v, *instant, direction, left), left);
      instant->omega = S(0.0);
    } else {
      pass(whole, S(0.0));
    }
  }
  if (value_of(instant->omega) == 0.0 && value_of(instant->pitch_velocity) != 0.0) {
    const S coupling = impact_inertia(v, *instant, S(0.0)).bp;
    const S direction =
        sign_of(S(coupling * instant->pitch_velocity * instant->configuration.kinematics.crank_jacobian));
    const StopImpact<S> turning = stop_impact(v, *instant, direction);
    pass(value_of(direction) * value_of(turning.shaft_speed) > 0.0 ? turning : stop_impact_standing(v, *instant),
         S(0.0));
  }
  if (value_of(instant->omega) != 0.0) mode->direction = sign_of(instant->omega);
}

}  // namespace wingbeat

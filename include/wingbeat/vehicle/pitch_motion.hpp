// Everything that acts at one instant on a vehicle whose wings pitch; model.md section 12. Any drive: the levers that
// it hands in say which.
#pragma once

#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Which smooth branch of the pitching holds, each +-1, beside those of the stroke (Branch).
template <Scalar S>
struct PitchBranch {
  S turn;  ///< sign of psi'
  S held;  ///< -1 where a stop holds the wings
};

template <Scalar S>
struct PitchMotion {
  Motion<S> stroke;  ///< its `aero` holds what the air does to stroke and pitch, lift with the air's inertia
  S acceleration;    ///< psi'' [rad/s2]
  S hinge_loss;      ///< in the damping of all hinges [W]
  S chordwise_lift;  ///< chordwise_lift() [N]
  S stop_moment;     ///< with which the wings press on a stop that holds them, towards a positive psi [N m]; else 0
};

/// The motion at pitch angle psi [rad] and velocity psi' [rad/s]; all else as of terms_at() and motion_on(). Of the
/// loads of the air the pitch margin means nothing.
template <template <Scalar> class V, Scalar S>
PitchMotion<S> pitch_motion_on(const V<S>& v, const PitchingWings<S>& p, const CrankKinematics<S>& k, const S& N_k_beta,
                               const S& omega, const S& i, const S& v_t, const S& psi, const S& velocity,
                               const Branch<S>& branch, const PitchBranch<S>& pitch) {
  const PitchState<S> state = pitch_state<S>(psi, velocity, k.stroke_slope * omega);
  const S N_J = v.wing_count * v.wing_inertia;
  const WingsAtPitch<S> wings = wings_at_pitch(v.wings, p, N_J, state, branch.stroke, pitch.turn, pitch.held);
  const AeroLoads<S> aero{wings.aero.angle_of_attack, S(1.0),           S(0.0),
                          wings.aero.stroke_moment,   wings.aero.power, wings.inertia - N_J};
  const IntermediateTerms<S> terms =
      terms_under(v, k, N_k_beta, omega, i, v_t, branch.direction, branch.gear, aero, wings.inertia, wings.moment);
  PitchMotion<S> m;
  m.stroke = motion_on(v, terms, i, v_t, branch);
  m.acceleration = wings.free_acceleration + wings.coupling * m.stroke.stroke_acceleration;
  m.stroke.aero.lift = lift_at_pitch(p, wings, state, m.stroke.stroke_acceleration, m.acceleration);
  m.hinge_loss = wings.hinge.loss;
  m.chordwise_lift = chordwise_lift(p, state);
  m.stop_moment = select(pitch.held >= S(0.0), S(0.0),
                         S(wings.pitching_moment + wings.coupling_moment * m.stroke.stroke_acceleration));
  return m;
}

/// What an impact on a stop does. Works are those of the impulses at the mean of the velocities before and after:
/// exact, since all velocities change in proportion while the stop takes psi'.
template <Scalar S>
struct StopImpact {
  S shaft_speed;    ///< gained by the crank, or the shaft of a direct drive [rad/s]
  S rod_impulse;    ///< F^, of the rod force [N s]
  S motor_work;     ///< that the rotor passes on behind the gearbox, T_m^ omega [J]
  S gear_work;      ///< lost in the gearbox [J]
  S friction_work;  ///< lost in the friction that the blow on the rod causes [J]
  S residual_work;  ///< what the formulation of the transmission fails to conserve [J]
  S stored_work;    ///< magnitude of the change of N_w J_w beta'^2 / 2 [J]
  S stop_work;      ///< lost at the stop, >= 0 [J]
  S lift;           ///< impulse of the lift [N s]
};

/// The impact at pitch angle psi [rad] of a vehicle at shaft speed omega [rad/s], which moves on in `direction` (its
/// sign), from the pitch velocity psi' to the one `left` [rad/s]. The impulse on the rod, F^ = -e J d omega /
/// (h + s mu r_e), has the sign of -M_bp (psi' - left); e as in IntermediateTerms. With \f$\Delta\f$ for what a
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
template <template <Scalar> class V, Scalar S>
StopImpact<S> stop_impact(const V<S>& v, const PitchingWings<S>& p, const CrankKinematics<S>& k, const S& omega,
                          const S& psi, const S& velocity, const S& direction, const S& left = S(0.0)) {
  const PitchState<S> state = pitch_state<S>(psi, velocity, k.stroke_slope * omega);
  const PitchInertia<S> m = pitch_inertia<S>(p, v.wing_count * v.wing_inertia, state);
  const S taken = velocity - left;
  const S blow = m.bp * taken;
  const S friction = -sign_of(blow) * direction * v.friction.radius, lever = k.crank_jacobian + friction;
  const S& J = v.motor.inertia;
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
  impact.lift = (p.air.p * taken - p.air.r * stroke_gain * state.cos_psi) * state.sin_psi;
  return impact;
}

/// The impact where friction holds crank or shaft, and the stroke with it, against the blow.
template <template <Scalar> class V, Scalar S>
StopImpact<S> stop_impact_standing(const V<S>& v, const PitchingWings<S>& p, const CrankKinematics<S>& k, const S& psi,
                                   const S& velocity) {
  const PitchState<S> state = pitch_state<S>(psi, velocity, S(0.0));
  const PitchInertia<S> m = pitch_inertia<S>(p, v.wing_count * v.wing_inertia, state);
  const S none(0.0);
  return {none,
          -m.bp * velocity / k.wing_jacobian,
          none,
          none,
          none,
          none,
          none,
          S(0.5) * m.pp * square(velocity),
          p.air.p * velocity * state.sin_psi};
}

}  // namespace wingbeat

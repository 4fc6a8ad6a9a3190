// Everything that acts at one instant on a vehicle whose wings pitch; model.md section 12. Any drive: the levers that
// it hands in say which.
#pragma once

#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

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
  S stop_moment;     ///< with which the wings press on a stop that holds them, towards a positive psi [N m]; else 0
};

/// The motion at pitch angle psi [rad] and velocity psi' [rad/s]; all else as of instant_at() and motion_on(). Of the
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
  const Instant<S> at =
      instant_under(v, k, N_k_beta, omega, i, v_t, branch.direction, branch.gear, aero, wings.inertia, wings.moment);
  PitchMotion<S> m;
  m.stroke = motion_on(v, at, i, v_t, branch);
  m.acceleration = wings.free_acceleration + wings.coupling * m.stroke.stroke_acceleration;
  m.stroke.aero.lift = lift_at_pitch(p, wings, state, m.stroke.stroke_acceleration, m.acceleration);
  m.hinge_loss = wings.hinge.loss;
  m.stop_moment = select(pitch.held >= S(0.0), S(0.0),
                         S(wings.pitching_moment + wings.coupling_moment * m.stroke.stroke_acceleration));
  return m;
}

/// What an impact on a stop does, which takes all of psi' (inelastic).
template <Scalar S>
struct StopImpact {
  S shaft_speed;  ///< gained by the crank, or the shaft of a direct drive [rad/s]
  S energy;       ///< lost, in the stop, in the friction that the blow on the rod causes and in the gearbox [J]
};

/// The impact at pitch angle psi [rad] and velocity psi' [rad/s] of a vehicle at shaft speed omega [rad/s]. The impulse
/// on the rod, F^ = -e J d omega / (h + s mu r_e), has the sign of -M_bp psi'; e as in Instant.
template <template <Scalar> class V, Scalar S>
StopImpact<S> stop_impact(const V<S>& v, const PitchingWings<S>& p, const CrankKinematics<S>& k, const S& omega,
                          const S& psi, const S& velocity) {
  const PitchState<S> before = pitch_state<S>(psi, velocity, k.stroke_slope * omega);
  const PitchInertia<S> m = pitch_inertia<S>(p, v.wing_count * v.wing_inertia, before);
  const S blow = m.bp * velocity;
  const S direction = sign_of(omega);
  const S lever = k.crank_lever - sign_of(blow) * direction * v.friction.radius;
  const S& J = v.motor.inertia;
  S eJ = J;
  if (has_gear_loss(v.motor)) eJ = gear_torque_ratio(v.motor, S(-sign_of(S(blow * lever)) * direction)) * J;
  const S gained = blow * lever / (eJ * k.wing_lever + m.bb * k.stroke_slope * lever);
  const PitchState<S> after = pitch_state<S>(psi, S(0.0), k.stroke_slope * (omega + gained));
  const S energy = kinetic_energy(m, before) - kinetic_energy(m, after) - J * gained * (omega + S(0.5) * gained);
  return {gained, energy};
}

}  // namespace wingbeat

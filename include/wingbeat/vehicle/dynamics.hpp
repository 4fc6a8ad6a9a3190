// The dynamic model of a vehicle: what acts in a state, whatever of the vehicle moves, and which mode holds there. All
// that integrates a vehicle, in time, crank angle or phase of the supply, evaluates these. model.md sections 2, 6, 9
// and 12.
#pragma once

#include <cmath>
#include <cstddef>

#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/parts/twisting_wings.hpp"
#include "wingbeat/vehicle/actuator.hpp"
#include "wingbeat/vehicle/motion.hpp"
#include "wingbeat/vehicle/unknowns.hpp"

namespace wingbeat {

/// Geometry and springs at a shaft angle [rad], of any drive.
template <Scalar S>
Configuration<S> configuration_at_angle(const Vehicle<S>& v, const S& angle) {
  using std::cos;
  using std::sin;
  if (drive_of(v).rotates) return configuration_at(v, S(sin(angle)), S(cos(angle)));
  return {direct_kinematics(v.transmission.direct), v.wing_count * v.spring.stiffness * (angle - v.spring.rest_angle),
          angle};
}

/// The instant at these coordinates under the supply, in a mode of which `held`, `slip` and the electronics' branch
/// matter: what stands still has no speed.
template <Scalar S>
FullState<S> instant_at(const Vehicle<S>& v, const Coordinates<S>& place, const SupplyMoment<S>& supply,
                        const Mode<S>& mode) {
  const S omega = value_of(mode.slip) < 0.0 ? S(0.0) : place.speed;
  const ActuatorAction<S> actuator = actuator_action(v, place, omega, supply, mode);
  return {{configuration_at_angle(v, place.angle), omega, actuator.current, actuator.voltage, place.pitch_angle,
           value_of(mode.held) < 0.0 ? S(0.0) : place.pitch_velocity},
          actuator.load,
          actuator.inertia,
          actuator.damped_speed,
          actuator.tip_acceleration,
          {place.twist_angle, place.twist_velocity}};
}

/// What acts, with what belongs to wings that pitch on hinges; 0 under the pitch law. `aero` holds what the air does to
/// stroke and pitch then, the lift with the air's inertia.
template <Scalar S>
struct PitchMotion : Motion<S> {
  S pitch_acceleration = S(0.0);  ///< psi'' [rad/s2]
  S hinge_loss = S(0.0);          ///< in the damping of all hinges [W]
  S chordwise_lift = S(0.0);      ///< chordwise_lift() [N]
  S stop_moment = S(0.0);         ///< with which the wings press on what holds them, towards a positive psi [N m]
  S twist_acceleration = S(0.0);  ///< tau'' [rad/s2]
  S damped_speed = S(0.0);        ///< of which the actuator's damping takes the square [rad/s]
};

namespace detail {

/// Of crank or shaft that friction holds, under the moment of the wings: no more than the springs' gets through.
/// `actuator_load`: torque that the actuator takes beside K i [N m].
template <template <Scalar> class V, Scalar S>
void stand_still(const V<S>& v, const S& wing_moment, Motion<S>& m, const S& spring_moment,
                 const S& actuator_load = S(0.0)) {
  m.crank_acceleration = m.stroke_acceleration = S(0.0);
  m.stored_moment = spring_moment;
  m.rod_force = (spring_moment + wing_moment) / m.kinematics.wing_jacobian;
  m.motor_torque = v.motor.torque_constant * m.current - actuator_load;
  m.friction_torque = m.motor_torque - m.rod_force * m.kinematics.crank_jacobian;
  if constexpr (ScalarTraits<S>::reads_tables) m.friction_torque = m.friction_torque - v.load_torque;
}

}  // namespace detail

/// What acts at an instant on wings that pitch on hinges or twist, in a given mode. Of the loads of the air the pitch
/// margin means nothing. State: MotionState of wings that do not twist, or FullState.
template <template <Scalar> class V, Scalar S, class State>
PitchMotion<S> pitch_motion_at(const V<S>& v, const State& instant, const Mode<S>& mode) {
  const PitchingWings<S>& p = v.pitch;
  const CrankKinematics<S>& k = instant.configuration.kinematics;
  const PitchState<S> state =
      pitch_state<S>(instant.pitch_angle, instant.pitch_velocity, k.stroke_slope * instant.omega,
                     clap_factor(v, instant.configuration, mode), instant.configuration.stroke_angle);
  const S N_J = v.wing_count * v.wing_inertia;
  PitchMotion<S> m;
  const auto take = [&](const WingsAtPitch<S>& wings) {
    const AeroLoads<S> aero{wings.aero.angle_of_attack, S(1.0),           S(0.0),
                            wings.aero.stroke_moment,   wings.aero.power, wings.inertia - N_J};
    static_cast<Motion<S>&>(m) =
        motion_on(v, instant, terms_under(v, instant, {aero, wings.inertia, wings.moment}, mode), mode);
    if constexpr (ScalarTraits<S>::reads_tables) {
      if (value_of(mode.slip) < 0.0) {
        detail::stand_still<V, S>(v, wings.moment, m, instant.configuration.spring_moment, actuator_load(instant));
      }
    }
    m.pitch_acceleration = wings.free_acceleration + wings.coupling * m.stroke_acceleration;
    m.hinge_loss = wings.hinge.loss;
    m.stop_moment =
        select(mode.held >= S(0.0), S(0.0), S(wings.pitching_moment + wings.coupling_moment * m.stroke_acceleration));
  };
  m.damped_speed = damped_speed(instant);
  if constexpr (requires { instant.twist; }) {
    if (twists(p.torsion)) {
      const TwistingWings<S> wings =
          wings_at_twist(v.wings, p, N_J, state, instant.twist, mode.stroke, mode.turn, mode.held);
      take(wings);
      m.twist_acceleration = wings.twist_free + wings.twist_coupling * m.stroke_acceleration;
      m.aero.lift = wings.steady_lift + wings.lift.stroke * m.stroke_acceleration +
                    wings.lift.pitch * m.pitch_acceleration + wings.lift.twist * m.twist_acceleration;
      m.hinge_loss = m.hinge_loss + wings.torsion_loss;
      m.chordwise_lift = wings.chordwise_lift;
      return m;
    }
  }
  const WingsAtPitch<S> wings = wings_at_pitch(v.wings, p, N_J, state, mode.stroke, mode.turn, mode.held);
  take(wings);
  m.aero.lift = lift_at_pitch(p, wings, state, m.stroke_acceleration, m.pitch_acceleration);
  m.chordwise_lift = chordwise_lift(p, state);
  return m;
}

/// What acts at an instant, in a given mode.
template <Scalar S>
PitchMotion<S> evaluate(const Vehicle<S>& v, const FullState<S>& instant, const Mode<S>& mode) {
  if (pitches(v)) return pitch_motion_at(v, instant, mode);
  PitchMotion<S> m;
  static_cast<Motion<S>&>(m) = motion_at(v, instant, mode);
  if (value_of(mode.slip) < 0.0) {
    detail::stand_still(v, S(0.0), m, instant.configuration.spring_moment, instant.load);
  }
  m.damped_speed = instant.damped_speed;
  return m;
}

/// The rate of each coordinate where `m` acts at an instant of these coordinates.
template <Scalar S>
Coordinates<S> rates_of(const Vehicle<S>& v, const Coordinates<S>& place, const FullState<S>& instant,
                        const PitchMotion<S>& m) {
  Coordinates<S> rates{instant.omega, m.crank_acceleration};
  if (has_current_state(v)) rates.current = m.inductive_voltage / v.motor.armature_inductance;
  rates.tip = place.tip_velocity, rates.tip_velocity = instant.tip_acceleration;
  rates.pitch_angle = instant.pitch_velocity, rates.pitch_velocity = m.pitch_acceleration;
  rates.twist_angle = place.twist_velocity, rates.twist_velocity = m.twist_acceleration;
  return rates;
}

/// Whether the torque on the shaft jumps where its speed changes sign, which then decides: by constant friction,
/// friction that follows the load, or a gearbox that loses torque. A crank always counts as one that does.
template <Scalar S>
bool jumps_at_rest(const Vehicle<S>& v) {
  return drive_of(v).rotates || value_of(v.friction.torque + v.motor.friction_torque) > 0.0 ||
         value_of(v.friction.radius) > 0.0 || has_gear_loss(v.motor);
}

/// Whether the sign of the rod force matters: to friction, or, of a crank, to what is reported of it.
template <Scalar S>
bool force_has_branches(const Vehicle<S>& v) {
  return drive_of(v).rotates || value_of(v.friction.radius) > 0.0;
}

/// A mode with those signs that follow from the instant and, of a shaft whose torque jumps with its direction, from
/// that of `mode`: stroke velocity, pitch velocity, bound of the angle of attack. `keeps_bound`: the last is that of
/// `mode` where the accelerations jump with it.
template <Scalar S>
Mode<S> with_signs_of_motion(const Vehicle<S>& v, const FullState<S>& instant, Mode<S> mode, bool keeps_bound = false) {
  using std::abs;
  const S stroke_slope = instant.configuration.kinematics.stroke_slope, stroke_velocity = stroke_slope * instant.omega;
  if (jumps_at_rest(v)) {
    // A shaft that is about to leave rest moves as it will, and does not turn back within a smooth piece.
    mode.stroke = mode.direction * sign_of(stroke_slope);
  } else {
    mode.stroke = mode.direction = sign_of(stroke_velocity);
  }
  if (pitches(v)) {
    // Wings that friction of their joint lets go turn as they will.
    if (!has_friction(v.pitch.hinge)) mode.turn = sign_of(instant.pitch_velocity);
  } else if (!(keeps_bound && jumps_at_pitch_stop(v))) {
    mode.pitching = sign_of(pitch_margin(v.wings, S(abs(stroke_velocity))));
  }
  return mode;
}

/// with_signs_of_motion() and the sign of the gear torque, in which the rod force and a bound of the angle of attack
/// with which the accelerations jump keep their signs; `*motion` is what acts then.
template <Scalar S>
Mode<S> on_force_branch(const Vehicle<S>& v, const FullState<S>& instant, Mode<S> mode, PitchMotion<S>* motion) {
  mode = with_signs_of_motion(v, instant, mode, true);
  mode.gear = S(1.0);
  *motion = evaluate(v, instant, mode);
  if (value_of(motion->gear_torque) < 0.0 && value_of(mode.slip) > 0.0) {
    mode.gear = S(-1.0);
    *motion = evaluate(v, instant, mode);
  }
  if (value_of(mode.slip) < 0.0) mode.force = sign_of(motion->rod_force);
  return mode;
}

/// The mode at an instant, of which `mode` says what holds still and in which direction the shaft turns or is about to;
/// `*motion` is what acts in it. The signs of rod force and gear torque may depend on each other: on one of their
/// branches both agree (model.md section 9).
template <Scalar S>
Mode<S> mode_at(const Vehicle<S>& v, const FullState<S>& instant, Mode<S> mode, PitchMotion<S>* motion) {
  mode = with_signs_of_motion(v, instant, mode);
  for (const double gear : {1.0, -1.0}) {
    mode.gear = S(gear);
    mode.force = S(1.0);
    *motion = evaluate(v, instant, mode);
    if (force_has_branches(v) && value_of(motion->force_switch) < 0.0) {
      mode.force = S(-1.0);
      *motion = evaluate(v, instant, mode);
    }
    if (gear * value_of(motion->gear_torque) >= 0.0 || value_of(mode.slip) < 0.0) break;
  }
  if (value_of(mode.slip) < 0.0) mode.force = sign_of(motion->rod_force);
  return mode;
}

/// The wings that pitch, or twist, at an instant at which the shaft stands.
template <Scalar S, class State>
WingsAtPitch<S> wings_standing(const Vehicle<S>& v, const State& instant, const Mode<S>& mode) {
  const S N_J = v.wing_count * v.wing_inertia;
  const PitchState<S> state =
      pitch_state<S>(instant.pitch_angle, instant.pitch_velocity, S(0.0), S(1.0), instant.configuration.stroke_angle);
  const S turn = has_friction(v.pitch.hinge) ? mode.turn : sign_of(instant.pitch_velocity);
  if constexpr (requires { instant.twist; }) {
    if (twists(v.pitch.torsion)) {
      return wings_at_twist(v.wings, v.pitch, N_J, state, instant.twist, S(1.0), turn, mode.held);
    }
  }
  return wings_at_pitch(v.wings, v.pitch, N_J, state, S(1.0), turn, mode.held);
}

/// T_c, the constant friction that holds the motor at rest, its own included [N m]; that of the mechanism as the motor
/// meets it through the gearbox. With up(T) of torque_before_gear(), \f$\operatorname{up}(T) = T\f$ without a loss
/// there:
/// \f[
/// \operatorname{up}(T_\mathrm{c}) + T_\mathrm{c,m}
/// \f]
template <template <Scalar> class V, Scalar S>
S breakaway_torque(const V<S>& v) {
  return torque_before_gear(v.motor, v.friction.torque) + v.motor.friction_torque;
}

/// The rod force at rest [N] under the springs' moment N_w k beta [N m] (model.md section 2, "Not flapping").
/// \f[
/// F_\mathrm{s} = \frac{N_\mathrm{w} k \beta}{g}
/// \f]
template <Scalar S>
S static_rod_force(const CrankKinematics<S>& k, const S& N_k_beta) {
  return N_k_beta / k.wing_jacobian;
}

/// What friction can hold at rest [N m], \f$T_\mathrm{c}\f$ being breakaway_torque():
/// \f$\mu r_\mathrm{e} |F_\mathrm{s}| + T_\mathrm{c}\f$.
template <template <Scalar> class V, Scalar S>
S holding_torque(const V<S>& v, const S& F_s) {
  using std::abs;
  return v.friction.radius * abs(F_s) + breakaway_torque(v);
}

/// Torques of the motor [N m] between which a crank stands. Behind a gearbox that loses torque the motor needs more
/// than the load to start the crank either way, so that the gearbox helps to hold it (model.md section 9). With up(T)
/// of torque_before_gear() and the load \f$T_\mathrm{x}\f$:
/// \f[
/// \begin{aligned}
/// T_\mathrm{high} &= T_\mathrm{c,m} + \operatorname{up}\left( F_\mathrm{s} h + T_\mathrm{x}
/// + \mu r_\mathrm{e} |F_\mathrm{s}| + T_\mathrm{c} \right) \cr
/// T_\mathrm{low} &= -T_\mathrm{c,m} - \operatorname{up}\left( -F_\mathrm{s} h - T_\mathrm{x}
/// + \mu r_\mathrm{e} |F_\mathrm{s}| + T_\mathrm{c} \right)
/// \end{aligned}
/// \f]
template <Scalar S>
struct StandingTorques {
  S low, high;

  bool hold(const S& torque) const {
    return value_of(low) < value_of(high) && value_of(torque) >= value_of(low) && value_of(torque) <= value_of(high);
  }
  /// Positive while they hold [N m].
  S margin(const S& torque) const {
    const S above = high - torque, below = torque - low;
    return value_of(above) < value_of(below) ? above : below;
  }
  S middle() const { return S(0.5) * (low + high); }    ///< the torque against which it starts either way alike
  S friction() const { return S(0.5) * (high - low); }  ///< what friction can hold
  /// In which it starts under a torque that they do not hold.
  S direction(const S& torque) const { return sign_of(S(torque - middle())); }
};
template <template <Scalar> class V, Scalar S>
StandingTorques<S> standing_torques(const V<S>& v, const CrankKinematics<S>& k, const S& F_s) {
  using std::abs;
  const S load = F_s * k.crank_jacobian + v.load_torque, friction = v.friction.radius * abs(F_s) + v.friction.torque;
  const S own = v.motor.friction_torque;
  return {-torque_before_gear(v.motor, S(friction - load)) - own,
          torque_before_gear(v.motor, S(load + friction)) + own};
}

/// The stroke angle beta [rad], of any drive.
template <Scalar S>
S stroke_angle_at(const Vehicle<S>& v, const CrankKinematics<S>& k, const S& shaft_angle) {
  return drive_of(v).rotates ? S(stroke_angle(k)) : shaft_angle;
}

/// wing_energy() of any drive [J].
template <Scalar S>
S wing_energy(const Vehicle<S>& v, const Coordinates<S>& place) {
  const CrankKinematics<S> k = configuration_at_angle(v, place.angle).kinematics;
  if (drive_of(v).rotates) return wing_energy(v, k, S(k.stroke_slope * place.speed));
  return S(0.5) * v.wing_count *
         (v.wing_inertia * square(place.speed) + v.spring.stiffness * square(S(place.angle - v.spring.rest_angle)));
}

/// Energy beside wing_energy() of wings at the stroke velocity beta' [rad/s]: of the air that moves with them and,
/// where they pitch on hinges, of hinges and pitching [J].
template <Scalar S>
S pitch_energy(const Vehicle<S>& v, const Coordinates<S>& place, const S& stroke_velocity) {
  using std::abs;
  using std::sin;
  if (twists(v.pitch.torsion)) {
    const PitchState<S> state = pitch_state(place.pitch_angle, place.pitch_velocity, stroke_velocity);
    const TwistState<S> twist{place.twist_angle, place.twist_velocity};
    return hinge_loads(v.pitch.hinge, place.pitch_angle, place.pitch_velocity).energy +
           S(0.5) * v.pitch.torsion.stiffness * square(twist.angle) +
           kinetic_energy(strip_sums(v.wings, v.pitch, S(0.0), state, twist, S(1.0)).inertia, state, twist.velocity);
  }
  if (pitches(v)) {
    const PitchState<S> state = pitch_state(place.pitch_angle, place.pitch_velocity, stroke_velocity);
    return hinge_loads(v.pitch.hinge, place.pitch_angle, place.pitch_velocity).energy +
           kinetic_energy(pitch_inertia(v.pitch, S(0.0), state), state);
  }
  const S alpha = aero_loads(v.wings, S(abs(stroke_velocity))).angle_of_attack;
  return S(0.5) * v.wings.added_inertia * square(S(sin(alpha) * stroke_velocity));
}

/// All that is stored [J]: in rotor and inductance, wings and the air that moves with them, springs and hinges.
template <Scalar S>
S stored_energy(const Vehicle<S>& v, const Coordinates<S>& place) {
  const S stroke_velocity = configuration_at_angle(v, place.angle).kinematics.stroke_slope * place.speed;
  return S(0.5) * (v.motor.inertia * square(place.speed) + v.motor.armature_inductance * square(place.current)) +
         wing_energy(v, place) + pitch_energy(v, place, stroke_velocity) + piezo_energy(v, place);
}

}  // namespace wingbeat

// The dynamic model of a vehicle: what acts in a state, whatever of the vehicle moves, and which mode holds there. All
// that integrates a vehicle, in time, crank angle or phase of the supply, evaluates these. model.md sections 2, 6, 9
// and 12.
#pragma once

#include <cmath>
#include <cstddef>

#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// What moves. Of a direct drive the shaft angle is the stroke angle; of wings under the pitch law the pitch is 0.
template <Scalar S>
struct Coordinates {
  S angle = S(0.0);           ///< theta, or beta of a direct drive [rad]
  S speed = S(0.0);           ///< its rate omega [rad/s]
  S current = S(0.0);         ///< i [A]; without inductance it follows from the voltage instead
  S pitch_angle = S(0.0);     ///< psi [rad]
  S pitch_velocity = S(0.0);  ///< psi' [rad/s]
};

inline constexpr std::size_t max_unknowns = 5;

/// Where the coordinates of a vehicle are among its unknowns: in the order of Coordinates, without those that it does
/// not have.
struct UnknownIndices {
  bool rotates, inductive, pitching;
  std::size_t current, pitch, count;

  template <Scalar S>
  explicit UnknownIndices(const Vehicle<S>& v)
      : rotates(drive_of(v).rotates),
        inductive(has_current_state(v)),
        pitching(pitches(v)),
        current(2),
        pitch(inductive ? 3 : 2),
        count(2u + (inductive ? 1u : 0u) + (pitching ? 2u : 0u)) {}

  template <Scalar S>
  Coordinates<S> coordinates(const S* y) const {
    Coordinates<S> c{y[0], y[1]};
    if (inductive) c.current = y[current];
    if (pitching) c.pitch_angle = y[pitch], c.pitch_velocity = y[pitch + 1];
    return c;
  }
};

/// Geometry and springs at a shaft angle [rad], of any drive.
template <Scalar S>
Configuration<S> configuration_at_angle(const Vehicle<S>& v, const S& angle) {
  using std::cos;
  using std::sin;
  if (drive_of(v).rotates) return configuration_at(v, S(sin(angle)), S(cos(angle)));
  return {direct_kinematics(v.transmission.direct), v.wing_count * v.spring.stiffness * angle};
}

/// The instant at these coordinates where the supply drives `supply_voltage` [V], in a mode of which `held` and `slip`
/// matter: what stands still has no speed.
template <Scalar S>
MotionState<S> instant_at(const Vehicle<S>& v, const Coordinates<S>& place, const S& supply_voltage,
                          const Mode<S>& mode) {
  const S omega = value_of(mode.slip) < 0.0 ? S(0.0) : place.speed;
  const S i = has_current_state(v) ? place.current : algebraic_current(v, supply_voltage, omega);
  return {configuration_at_angle(v, place.angle),
          omega,
          i,
          terminal_voltage(v, supply_voltage, i),
          place.pitch_angle,
          value_of(mode.held) < 0.0 ? S(0.0) : place.pitch_velocity};
}

/// What acts, with what belongs to wings that pitch on hinges; 0 under the pitch law. `aero` holds what the air does to
/// stroke and pitch then, the lift with the air's inertia.
template <Scalar S>
struct PitchMotion : Motion<S> {
  S pitch_acceleration = S(0.0);  ///< psi'' [rad/s2]
  S hinge_loss = S(0.0);          ///< in the damping of all hinges [W]
  S chordwise_lift = S(0.0);      ///< chordwise_lift() [N]
  S stop_moment = S(0.0);  ///< with which the wings press on a stop that holds them, towards a positive psi [N m]
};

namespace detail {

/// Of crank or shaft that friction holds, under the moment of the wings: no more than the springs' gets through.
template <template <Scalar> class V, Scalar S>
void stand_still(const V<S>& v, const S& wing_moment, Motion<S>& m, const S& spring_moment) {
  m.crank_acceleration = m.stroke_acceleration = S(0.0);
  m.stored_moment = spring_moment;
  m.rod_force = (spring_moment + wing_moment) / m.kinematics.wing_jacobian;
  m.motor_torque = v.motor.torque_constant * m.current;
  m.friction_torque = m.motor_torque - m.rod_force * m.kinematics.crank_jacobian;
  if constexpr (ScalarTraits<S>::reads_tables) m.friction_torque = m.friction_torque - v.load_torque;
}

}  // namespace detail

/// What acts at an instant on wings that pitch on hinges, in a given mode. Of the loads of the air the pitch margin
/// means nothing.
template <template <Scalar> class V, Scalar S>
PitchMotion<S> pitch_motion_at(const V<S>& v, const MotionState<S>& instant, const Mode<S>& mode) {
  const PitchingWings<S>& p = v.pitch;
  const CrankKinematics<S>& k = instant.configuration.kinematics;
  const PitchState<S> state =
      pitch_state<S>(instant.pitch_angle, instant.pitch_velocity, k.stroke_slope * instant.omega);
  const S N_J = v.wing_count * v.wing_inertia;
  const WingsAtPitch<S> wings = wings_at_pitch(v.wings, p, N_J, state, mode.stroke, mode.turn, mode.held);
  const AeroLoads<S> aero{wings.aero.angle_of_attack, S(1.0),           S(0.0),
                          wings.aero.stroke_moment,   wings.aero.power, wings.inertia - N_J};
  PitchMotion<S> m;
  static_cast<Motion<S>&>(m) = motion_on(v, terms_under(v, instant, {aero, wings.inertia, wings.moment}, mode), mode);
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (value_of(mode.slip) < 0.0) detail::stand_still<V, S>(v, wings.moment, m, instant.configuration.spring_moment);
  }
  m.pitch_acceleration = wings.free_acceleration + wings.coupling * m.stroke_acceleration;
  m.aero.lift = lift_at_pitch(p, wings, state, m.stroke_acceleration, m.pitch_acceleration);
  m.hinge_loss = wings.hinge.loss;
  m.chordwise_lift = chordwise_lift(p, state);
  m.stop_moment =
      select(mode.held >= S(0.0), S(0.0), S(wings.pitching_moment + wings.coupling_moment * m.stroke_acceleration));
  return m;
}

/// What acts at an instant, in a given mode.
template <Scalar S>
PitchMotion<S> evaluate(const Vehicle<S>& v, const MotionState<S>& instant, const Mode<S>& mode) {
  if (pitches(v)) return pitch_motion_at(v, instant, mode);
  PitchMotion<S> m;
  static_cast<Motion<S>&>(m) = motion_at(v, instant, mode);
  if (value_of(mode.slip) < 0.0) detail::stand_still(v, S(0.0), m, instant.configuration.spring_moment);
  return m;
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

/// A mode with those signs that follow from the instant alone: stroke velocity, pitch velocity, bound of the angle of
/// attack.
template <Scalar S>
Mode<S> with_signs_of_motion(const Vehicle<S>& v, const MotionState<S>& instant, Mode<S> mode) {
  using std::abs;
  const S stroke_velocity = instant.configuration.kinematics.stroke_slope * instant.omega;
  // A shaft that is about to leave rest moves as it will.
  mode.stroke = !drive_of(v).rotates && jumps_at_rest(v) ? mode.direction : sign_of(stroke_velocity);
  if (!drive_of(v).rotates && !jumps_at_rest(v)) mode.direction = mode.stroke;
  if (pitches(v)) mode.turn = sign_of(instant.pitch_velocity);
  else mode.pitching = sign_of(pitch_margin(v.wings, S(abs(stroke_velocity))));
  return mode;
}

/// with_signs_of_motion() and the sign of the gear torque, in which the rod force keeps its sign; `*motion` is what
/// acts then.
template <Scalar S>
Mode<S> on_force_branch(const Vehicle<S>& v, const MotionState<S>& instant, Mode<S> mode, PitchMotion<S>* motion) {
  mode = with_signs_of_motion(v, instant, mode);
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
Mode<S> mode_at(const Vehicle<S>& v, const MotionState<S>& instant, Mode<S> mode, PitchMotion<S>* motion) {
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

/// The wings that pitch at an instant at which the shaft stands.
template <Scalar S>
WingsAtPitch<S> wings_standing(const Vehicle<S>& v, const MotionState<S>& instant, const Mode<S>& mode) {
  return wings_at_pitch(v.wings, v.pitch, S(v.wing_count * v.wing_inertia),
                        pitch_state<S>(instant.pitch_angle, instant.pitch_velocity, S(0.0)), S(1.0),
                        sign_of(instant.pitch_velocity), mode.held);
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
  return S(0.5) * v.wing_count * (v.wing_inertia * square(place.speed) + v.spring.stiffness * square(place.angle));
}

/// Energy beside wing_energy() of wings at the stroke velocity beta' [rad/s]: of the air that moves with them and,
/// where they pitch on hinges, of hinges and pitching [J].
template <Scalar S>
S pitch_energy(const Vehicle<S>& v, const Coordinates<S>& place, const S& stroke_velocity) {
  using std::abs;
  using std::sin;
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
         wing_energy(v, place) + pitch_energy(v, place, stroke_velocity);
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
template <template <Scalar> class V, Scalar S>
StopImpact<S> stop_impact(const V<S>& v, const MotionState<S>& instant, const S& direction, const S& left = S(0.0)) {
  const PitchingWings<S>& p = v.pitch;
  const CrankKinematics<S>& k = instant.configuration.kinematics;
  const S &omega = instant.omega, &velocity = instant.pitch_velocity;
  const PitchState<S> state = pitch_state<S>(instant.pitch_angle, velocity, k.stroke_slope * omega);
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
StopImpact<S> stop_impact_standing(const V<S>& v, const MotionState<S>& instant) {
  const PitchingWings<S>& p = v.pitch;
  const S& velocity = instant.pitch_velocity;
  const PitchState<S> state = pitch_state<S>(instant.pitch_angle, velocity, S(0.0));
  const PitchInertia<S> m = pitch_inertia<S>(p, v.wing_count * v.wing_inertia, state);
  const S none(0.0);
  return {none,
          -m.bp * velocity / instant.configuration.kinematics.wing_jacobian,
          none,
          none,
          none,
          none,
          none,
          S(0.5) * m.pp * square(velocity),
          p.air.p * velocity * state.sin_psi};
}

/// The wings meet the stop that they are at: `*instant` becomes the instant after it, and of `*mode` the direction and
/// whether friction still holds the shaft. A shaft that the blow brings to rest turns back where the lever of the rod
/// exceeds that of friction, as does one that friction holds; else the stop takes what is left. use(impact) is called
/// for each part of it.
template <Scalar S, class Use>
void meet_stop(const Vehicle<S>& v, MotionState<S>* instant, Mode<S>* mode, const Use& use) {
  const auto pass = [&](const StopImpact<S>& impact, const S& left) {
    instant->omega = instant->omega + impact.shaft_speed;
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
    using std::cos;
    const S coupling = (v.pitch.mass_product + v.pitch.air.rp) * cos(instant->pitch_angle);
    const S direction =
        sign_of(S(coupling * instant->pitch_velocity * instant->configuration.kinematics.crank_jacobian));
    const StopImpact<S> turning = stop_impact(v, *instant, direction);
    pass(value_of(direction) * value_of(turning.shaft_speed) > 0.0 ? turning : stop_impact_standing(v, *instant),
         S(0.0));
  }
  if (value_of(instant->omega) != 0.0) mode->direction = sign_of(instant->omega);
}

}  // namespace wingbeat

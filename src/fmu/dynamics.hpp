// Everything that acts at one instant of a vehicle in time, on any scalar: rates and outputs of an FMU, on dual numbers
// their directional derivatives. The same equations as CrankModel, DirectModel and PitchDirectModel; the signs of kinks
// follow from the unknowns, what holds or sticks is given.
#pragma once

#include <array>

#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/motion.hpp"
#include "wingbeat/vehicle/pitch_motion.hpp"

namespace wingbeat::fmu {

inline constexpr std::size_t max_unknowns = 5;

/// What of a vehicle does not follow from its unknowns.
struct Mode {
  bool stuck = false;      ///< friction holds crank or shaft
  bool held = false;       ///< a stop holds the wings
  double direction = 1.0;  ///< of turning or, where constant friction acts on a direct drive, of slipping
};

/// Indices of the unknowns: theta, omega, i, psi, psi' of a crank; beta, beta', psi, psi', i of a direct drive,
/// without those that it does not have.
struct StateIndices {
  bool crank, inductive, pitching;
  std::size_t current, pitch, count;

  template <Scalar S>
  explicit StateIndices(const Vehicle<S>& v)
      : crank(!drive_of(v).alternating),
        inductive(has_current_state(v)),
        pitching(pitches(v)),
        current(crank || !pitching ? 2 : 4),
        pitch(crank && inductive ? 3 : 2),
        count(2u + (inductive ? 1u : 0u) + (pitching ? 2u : 0u)) {}
};

/// Rates of the unknowns and what outputs are read from.
template <Scalar S>
struct Dynamics {
  std::array<S, max_unknowns> rates;
  Motion<S> motion;
  S angle;  ///< of crank or shaft
  S stroke_angle, shaft_speed, pitch_angle, pitch_velocity, load_torque;
  CycleIntegrals<S> integrands;
};

/// At the unknowns y, where the supply drives v_s [V] and the load takes v.load_torque.
template <Scalar S>
Dynamics<S> evaluate(const Vehicle<S>& v, const Mode& mode, const S* y, const S& v_s) {
  using std::abs;
  using std::cos;
  using std::sin;
  const StateIndices indices(v);
  const bool sticks = value_of(v.friction.torque + v.motor.friction_torque) > 0.0;
  const S omega = mode.stuck ? S(0.0) : y[1];
  const S i = indices.inductive ? y[indices.current] : algebraic_current(v, v_s, omega);
  const S v_t = terminal_voltage(v, v_s, i);
  const CrankKinematics<S> k =
      indices.crank ? crank_kinematics(v.transmission, S(sin(y[0])), S(cos(y[0]))) : direct_kinematics<S>();
  const S springs = indices.crank ? spring_moment(v, k) : S(v.wing_count * v.spring.stiffness * y[0]);
  const S psi = indices.pitching ? y[indices.pitch] : S(0.0);
  const S turning = indices.pitching && !mode.held ? y[indices.pitch + 1] : S(0.0);
  const S stroke_velocity = k.stroke_slope * omega;

  Branch<S> branch{sign_of(stroke_velocity), S(1.0), S(mode.direction), S(1.0), S(1.0), S(1.0)};
  if (!indices.crank) branch.direction = sticks ? S(mode.direction) : branch.stroke;
  if (!indices.crank && sticks) branch.stroke = branch.direction;
  if (!indices.pitching) branch.pitching = sign_of(pitch_margin(v.wings, S(abs(stroke_velocity))));
  const PitchBranch<S> pitch_branch{sign_of(turning), S(mode.held ? -1.0 : 1.0)};
  Dynamics<S> all;
  all.pitch_angle = psi;
  S pitch_acceleration(0.0);
  const auto on_branch = [&] {
    if (indices.pitching) {
      const PitchMotion<S> m =
          pitch_motion_on<Vehicle, S>(v, v.pitch, k, springs, omega, i, v_t, psi, turning, branch, pitch_branch);
      all.motion = m.stroke;
      pitch_acceleration = m.acceleration;
    } else {
      const IntermediateTerms<S> terms =
          terms_at(v, k, springs, omega, i, v_t, branch.stroke, branch.direction, branch.pitching, branch.gear);
      all.motion = motion_on(v, terms, i, v_t, branch);
    }
  };
  on_branch();
  if (indices.crank) {
    if (value_of(all.motion.force_switch) < 0.0) branch.force = S(-1.0), on_branch();
    if (value_of(all.motion.gear_torque) < 0.0) {
      branch.gear = S(-1.0), on_branch();
      const S force = sign_of(all.motion.force_switch);
      if (value_of(force) != value_of(branch.force)) branch.force = force, on_branch();
    }
  }
  Motion<S>& m = all.motion;
  if (mode.stuck) {
    m.crank_acceleration = m.stroke_acceleration = S(0.0);
    m.stored_moment = springs;
    S moment = springs;
    if (indices.pitching) {
      const PitchState<S> state = pitch_state<S>(psi, turning, S(0.0));
      const WingsAtPitch<S> wings = wings_at_pitch(v.wings, v.pitch, S(v.wing_count * v.wing_inertia), state, S(1.0),
                                                   pitch_branch.turn, pitch_branch.held);
      pitch_acceleration = wings.free_acceleration;
      m.aero.lift = lift_at_pitch(v.pitch, wings, state, S(0.0), wings.free_acceleration);
      moment = moment + wings.moment;
    }
    m.rod_force = moment / k.wing_jacobian;
    m.motor_torque = v.motor.torque_constant * i;
    m.friction_torque = m.motor_torque - m.rod_force * k.crank_jacobian - v.load_torque;
  }
  all.angle = y[0];
  all.pitch_velocity = turning;
  all.load_torque = v.load_torque;
  all.stroke_angle = indices.crank ? S(stroke_angle(k)) : y[0];
  all.shaft_speed = omega;
  all.rates.fill(S(0.0));
  all.rates[0] = omega;
  all.rates[1] = m.crank_acceleration;
  if (indices.inductive) {
    all.rates[indices.current] =
        (v_s - circuit_resistance(v) * i - v.motor.torque_constant * omega) / v.motor.armature_inductance;
  }
  if (indices.pitching) {
    all.rates[indices.pitch] = turning;
    all.rates[indices.pitch + 1] = pitch_acceleration;
  }
  all.integrands = integrands(m, omega, branch);
  return all;
}

}  // namespace wingbeat::fmu

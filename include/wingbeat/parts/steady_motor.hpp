// A motor at constant speed and voltage: the curves of a data sheet; model.md sections 1 and 9.
#pragma once

#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/motor.hpp"

namespace wingbeat {

/// Steady speed without load, against the motor's own friction as well [rad/s]: (K v - R_a T_c) / (K^2 + R_a b); 0
/// where that friction stalls it.
template <Scalar S>
S free_speed(const Motor<S>& m, const S& v) {
  const S drive = m.torque_constant * v - m.armature_resistance * m.friction_torque;
  return select<S>(drive > S(0.0), drive, S(0.0)) /
         (m.torque_constant * m.torque_constant + m.armature_resistance * m.viscous_damping);
}

/// A motor that turns forwards at a constant speed.
template <Scalar S>
struct SteadyMotor {
  S current;           ///< (v - K omega) / R_a [A]
  S torque;            ///< on the shaft, behind the gearbox: e (K i - b omega - T_c) [N m]
  S power_electrical;  ///< v i [W]
  S power_mechanical;  ///< torque times omega [W]
};

/// The motor at terminal voltage v [V] and shaft speed omega >= 0 [rad/s]; of torques below zero the load drives it.
template <Scalar S>
SteadyMotor<S> steady_motor(const Motor<S>& m, const S& v, const S& omega) {
  const S i = (v - m.torque_constant * omega) / m.armature_resistance;
  const MotorLoads<S> loads = motor_loads(m, v, i, omega);
  const S before_gear = loads.torque - loads.drag_torque - m.friction_torque;
  const S torque = gear_torque_ratio(m, before_gear) * before_gear;
  return {i, torque, v * i, torque * omega};
}

}  // namespace wingbeat

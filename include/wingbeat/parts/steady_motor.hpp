// A motor at constant speed and voltage: the curves of a data sheet; model.md sections 1 and 9.
#pragma once

#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/motor.hpp"

namespace wingbeat {

/// Steady speed without load, against the motor's own friction as well [rad/s]; 0 where that friction stalls it.
/// \f[
/// \omega_0 = \frac{\max(K v - R_\mathrm{a} T_\mathrm{c,m},\, 0)}{K^2 + R_\mathrm{a} b}
/// \f]
template <Scalar S>
S free_speed(const Motor<S>& m, const S& v) {
  const S drive = m.torque_constant * v - m.armature_resistance * m.friction_torque;
  return select<S>(drive > S(0.0), drive, S(0.0)) /
         (m.torque_constant * m.torque_constant + m.armature_resistance * m.viscous_damping);
}

/// A motor that turns forwards at a constant speed.
template <Scalar S>
struct SteadyMotor {
  S current;           ///< \f$i\f$ [A]
  S torque;            ///< \f$T\f$ on the shaft, behind the gearbox [N m]
  S power_electrical;  ///< \f$v i\f$ [W]
  S power_mechanical;  ///< \f$T \omega\f$ [W]
};

/// The motor at terminal voltage v [V] and shaft speed omega >= 0 [rad/s]; of torques below zero the load drives it.
/// With e of gear_torque_ratio() (eqs 9-11 at constant speed and current; model.md section 9):
/// \f[
/// i = \frac{v - K \omega}{R_\mathrm{a}}, \qquad T = e \left( K i - b\, \omega - T_\mathrm{c,m} \right)
/// \f]
template <Scalar S>
SteadyMotor<S> steady_motor(const Motor<S>& m, const S& v, const S& omega) {
  const S i = (v - m.torque_constant * omega) / m.armature_resistance;
  const MotorLoads<S> loads = motor_loads(m, v, i, omega);
  const S before_gear = loads.torque - loads.drag_torque - m.friction_torque;
  const S torque = gear_torque_ratio(m, before_gear) * before_gear;
  return {i, torque, v * i, torque * omega};
}

}  // namespace wingbeat

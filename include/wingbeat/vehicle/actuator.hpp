// What the actuator of a vehicle does at an instant: a DC motor, one behind electronics that limit its current, or a
// piezo bimorph; model.md sections 2 and 15.
#pragma once

#include <cmath>

#include "wingbeat/parts/twisting_wings.hpp"
#include "wingbeat/vehicle/unknowns.hpp"

namespace wingbeat {

/// What the supply drives at a moment.
template <Scalar S>
struct SupplyMoment {
  S voltage;         ///< v [V]
  S slope = S(0.0);  ///< v' [V/s]; of a piezo alone
};

/// What an actuator is to the shaft beside a motor's K i, b omega and J.
template <Scalar S>
struct ActuatorAction {
  S current;                    ///< i [A]
  S voltage;                    ///< at the terminals [V]
  S load = S(0.0);              ///< torque that it takes from the shaft [N m]
  S inertia = S(0.0);           ///< that it adds to the shaft's [kg m2]
  S damped_speed;               ///< of which the damping b takes the square [rad/s]
  S tip_acceleration = S(0.0);  ///< x'' behind a compliant transmission [m/s2]
};

/// The branch of the electronics at a current that is no state: it follows the voltage within its limits.
template <Scalar S>
Mode<S> with_bridge(const Vehicle<S>& v, const S& voltage, const S& omega, Mode<S> mode) {
  const double i = value_of(algebraic_current(v, voltage, omega));
  mode.bridge = S(!v.electronics.regenerates && i < 0.0 ? -1.0 : 1.0);
  mode.limit = S(i > value_of(v.electronics.current_max) ? -1.0 : 1.0);
  return mode;
}

namespace detail {

/// Of a motor: blocked it carries no current under its back-EMF, at its limit the voltage that keeps the current there.
template <Scalar S>
ActuatorAction<S> motor_action(const Vehicle<S>& v, const Coordinates<S>& c, const S& omega, const S& voltage,
                               const Mode<S>& mode) {
  const S back_emf = v.motor.torque_constant * omega;
  if (value_of(mode.bridge) < 0.0) return {.current = S(0.0), .voltage = back_emf, .damped_speed = omega};
  if (value_of(mode.limit) < 0.0) {
    const S i = v.electronics.current_max;
    return {.current = i, .voltage = v.motor.armature_resistance * i + back_emf, .damped_speed = omega};
  }
  const S i = has_current_state(v) ? c.current : algebraic_current(v, voltage, omega);
  return {.current = i, .voltage = terminal_voltage(v, voltage, i), .damped_speed = omega};
}

/// Of a piezo, whose mass and damping v.motor holds as they are about the stroke angle zero. With x of the transmission
/// and T' there, its torque on the stroke and its inertia are
/// \f[
/// \frac{1}{T'} \left( \kappa V - c_\mathrm{a} \dot x - k_\mathrm{a} x + m_\mathrm{a} \frac{T''}{T'} \dot x^2 \right),
/// \qquad \frac{m_\mathrm{a}}{T'^2}
/// \f]
/// and behind a series stiffness \f$k_\mathrm{s} (x - x_\mathrm{t}) / T'\f$ and none.
template <Scalar S>
ActuatorAction<S> piezo_action(const Vehicle<S>& v, const Coordinates<S>& c, const S& omega,
                               const SupplyMoment<S>& supply) {
  const Piezo<S>& p = v.piezo;
  const FlexurePlace<S> flexure = flexure_at(p, c.angle);
  const S kappa = force_per_volt_at(p, supply.voltage), force = kappa * supply.voltage;
  const S per_slope = S(1.0) / flexure.slope;
  S torque, tip_velocity, inertia(0.0), acceleration(0.0);
  if (is_compliant(p)) {
    const S taken = p.series_stiffness * (c.tip - flexure.tip);
    tip_velocity = c.tip_velocity;
    acceleration = (force - p.damping * tip_velocity - p.stiffness * c.tip - taken) / p.mass;
    torque = taken * per_slope;
  } else {
    tip_velocity = omega * per_slope;
    inertia = p.mass * square(per_slope);
    torque = (force - p.damping * tip_velocity - p.stiffness * flexure.tip +
              p.mass * flexure.second * per_slope * square(tip_velocity)) *
             per_slope;
  }
  return {.current = p.capacitance * supply.slope + kappa * tip_velocity,
          .voltage = supply.voltage,
          .load = -torque - v.motor.viscous_damping * omega,
          .inertia = inertia - v.motor.inertia,
          .damped_speed = p.transmission_ratio * tip_velocity,
          .tip_acceleration = acceleration};
}

}  // namespace detail

/// What the actuator does at these coordinates, of which the shaft turns at omega.
template <Scalar S>
ActuatorAction<S> actuator_action(const Vehicle<S>& v, const Coordinates<S>& c, const S& omega,
                                  const SupplyMoment<S>& supply, const Mode<S>& mode) {
  if (is_given(v.piezo)) return detail::piezo_action(v, c, omega, supply);
  return detail::motor_action(v, c, omega, supply.voltage, mode);
}

/// An instant of a vehicle of any kind.
template <Scalar S>
struct FullState : MotionState<S> {
  S load, inertia, damped_speed, tip_acceleration;  ///< as of ActuatorAction
  TwistState<S> twist;
};

/// What the actuator takes from a shaft beside K i, of either kind of instant [N m].
template <class State>
auto actuator_load(const State& instant) {
  if constexpr (requires { instant.load; }) return instant.load;
  else return decltype(instant.omega)(0.0);
}
template <class State>
auto damped_speed(const State& instant) {
  if constexpr (requires { instant.damped_speed; }) return instant.damped_speed;
  else return instant.omega;
}

/// Torque on the shaft at rest that the actuator gives [N m], of either kind of instant.
template <Scalar S, class State>
S standing_torque(const Vehicle<S>& v, const State& instant) {
  return v.motor.torque_constant * instant.current - actuator_load(instant);
}

/// Energy of the piezo's mass and springs beyond that of v.motor's inertia [J].
template <Scalar S>
S piezo_energy(const Vehicle<S>& v, const Coordinates<S>& c) {
  const Piezo<S>& p = v.piezo;
  if (!is_given(p)) return S(0.0);
  const FlexurePlace<S> flexure = flexure_at(p, c.angle);
  const bool compliant = is_compliant(p);
  const S tip = compliant ? c.tip : flexure.tip;
  const S velocity = compliant ? c.tip_velocity : S(c.speed / flexure.slope);
  return S(0.5) * (p.mass * square(velocity) + p.stiffness * square(tip) +
                   p.series_stiffness * square(S(tip - flexure.tip)) - v.motor.inertia * square(c.speed));
}

}  // namespace wingbeat

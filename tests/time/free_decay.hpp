// A rotor that constant friction and its own short-circuited motor bring to rest, in closed form.
#pragma once

#include <cmath>

#include "vehicle/reference_vehicle.hpp"

namespace wingbeat {

/// J omega' = -T_c - (K^2 / R_a) omega, without voltage, wings and inductance:
/// t = (J/c) ln(1 + c |omega_0| / T_c), angle = (J |omega_0| - T_c t) / c with c = K^2 / R_a.
struct FreeDecay {
  Vehicle<double> vehicle;
  double end_time;         ///< [s]
  double end_crank_angle;  ///< [rad]

  explicit FreeDecay(double omega_0) : vehicle(wingless_vehicle()) {
    vehicle.voltage = 0.0;
    vehicle.friction.radius = 0.0;
    vehicle.friction.torque = 2e-4;
    vehicle.motor.viscous_damping = 0.0;
    vehicle.motor.armature_inductance = 0.0;
    const double c = square(vehicle.motor.torque_constant) / vehicle.motor.armature_resistance;
    const double J = vehicle.motor.inertia, T_c = vehicle.friction.torque;
    end_time = J / c * std::log1p(c * std::abs(omega_0) / T_c);
    end_crank_angle = std::copysign((J * std::abs(omega_0) - T_c * end_time) / c, omega_0);
  }
};

}  // namespace wingbeat

#pragma once

#include <complex>

#include "vehicle/random_vehicle.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// The wings of the reference vehicle on a motor shaft: 3 V at 22 Hz, where the springs resonate, without friction.
inline Design<double> direct_design() {
  Design<double> d = reference_design();
  d.transmission = {};
  d.transmission.type = TransmissionType::direct;
  d.supply = {SupplyType::sine, 3.0, 22.0, 1.0};
  d.friction = {FrictionLaw::none, 0.0};
  d.spring.resonance = 22.0;
  return d;
}

/// A random direct drive whose equations are smooth between two reversals: no constant friction, no pitch stop.
inline Design<double> smooth_direct_design(std::mt19937_64& random) {
  Design<double> d = random_direct_design(random, false);
  d.aerodynamics.angle_of_attack_min.reset();
  return d;
}

/// Amplitudes without air and with viscous friction alone, by the complex impedances.
struct LinearResponse {
  std::complex<double> speed;    ///< [rad/s]
  std::complex<double> current;  ///< [A]
};
inline LinearResponse linear_response(const Vehicle<double>& v) {
  using Complex = std::complex<double>;
  const double w = two_pi * v.drive_frequency, K = v.motor.torque_constant, V = v.voltage;
  const Complex j(0.0, 1.0), electrical = v.motor.armature_resistance + j * w * v.motor.armature_inductance;
  const Complex mechanical = v.motor.viscous_damping + v.friction.damping +
                             j * w * (v.motor.inertia + v.wing_count * v.wing_inertia) +
                             v.wing_count * v.spring.stiffness / (j * w);
  const Complex speed = K * V / (electrical * mechanical + K * K);
  return {speed, (V - K * speed) / electrical};
}

}  // namespace wingbeat

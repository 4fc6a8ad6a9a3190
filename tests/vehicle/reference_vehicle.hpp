// The 2022 friction paper's vehicle for tests: data/designs/friction2022.toml, and friction2022-springs.toml.
#pragma once

#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

inline Vehicle<double> reference_vehicle(bool springs = false) {
  Vehicle<double> v;
  v.voltage = 3.0;
  v.motor = {9.0, 29e-3, 0.01, 1.5e-7, 3.6e-6};
  v.crank = {5e-3, 20e-3, 6e-3, 20e-3, Formulation::rod_force};
  v.friction.radius = 2.5e-3;
  v.spring.stiffness = springs ? 1.377e-3 : 0.0;
  v.wing_count = 2.0;
  v.wing_inertia = 7.205e-8;
  v.wings = {1.225, 5e-3, 2.457e-6, 1.048e-7, translational_2022()};
  return v;
}

/// The same without wings and springs: the rod force is zero.
inline Vehicle<double> wingless_vehicle() {
  Vehicle<double> v = reference_vehicle();
  v.wing_inertia = 0.0;
  v.wings.air_density = v.wings.s2 = v.wings.s3 = 0.0;
  return v;
}

}  // namespace wingbeat

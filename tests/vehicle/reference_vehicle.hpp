// The 2022 friction paper's vehicle for tests: data/designs/friction2022.toml, and friction2022-springs.toml.
#pragma once

#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// The reference design: rod-force formulation, 3 V, no springs.
inline Design<double> reference_design() {
  Design<double> d;
  d.name = "reference";
  d.mass = 3.34e-3;
  d.bench_torque_constant = 7.664e-3;
  d.supply.voltage = 3.0;
  d.motor.constants = {9.0, 29e-3, 0.01, 1.5e-7, 3.6e-6, 0.0};
  d.transmission = {5e-3, 20e-3, 6e-3, {}, {}, Formulation::rod_force};
  d.friction = {FrictionLaw::load_proportional, 2.5e-3};
  d.wing.inertia = 7.205e-8;
  d.wing.planform.s2 = 2.457e-6;
  d.wing.planform.s3 = 1.048e-7;
  d.aerodynamics.air_density = 1.225;
  d.aerodynamics.pitch_coefficient = 5e-3;
  d.aerodynamics.coefficients = translational_2022();
  return d;
}

inline Vehicle<double> reference_vehicle(bool springs = false) {
  Design<double> design = reference_design();
  if (springs) design.spring.stiffness = 1.377e-3;
  return resolve(design);
}

/// The reference vehicle without wings and springs: the rod force is zero.
inline Vehicle<double> wingless_vehicle() {
  Vehicle<double> v = reference_vehicle();
  v.wing_inertia = 0.0;
  v.wings.air_density = v.wings.s2 = v.wings.s3 = 0.0;
  return v;
}

}  // namespace wingbeat

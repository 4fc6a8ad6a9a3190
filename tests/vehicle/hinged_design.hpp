// A design of a direct drive whose wings pitch on hinges, for tests.
#pragma once

#include <cmath>
#include <random>

#include "vehicle/direct_design.hpp"
#include "wingbeat/parts/pitching_wings.hpp"

namespace wingbeat {

/// The direct drive with wings of membrane and spar on hinges.
inline Design<double> hinged_design(double stiffness) {
  Design<double> d = direct_design();
  d.wing.planform = {};
  d.wing.planform.shape = PlanformShape::semi_ellipse;
  d.wing.planform.length = 63e-3;
  d.wing.planform.root_chord = 25e-3;
  d.wing.areal_density = 17e-3;
  d.wing.spar_density = 0.614e-3;
  d.pitch.stiffness = stiffness;
  d.pitch.damping = 2e-8;
  d.aerodynamics.pitch_coefficient = 0.0;
  d.aerodynamics.added_mass = true;
  d.aerodynamics.coefficients_name = normal_force_set;
  d.aerodynamics.coefficients = force_coefficients_robofly();
  return d;
}

inline Design<double> random_hinged_design(std::mt19937_64& random, bool stops) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  Design<double> d = hinged_design(std::exp(uniform(std::log(1e-4), std::log(3e-3))));
  d.supply.voltage = uniform(0.5, 5.0);
  d.supply.frequency = uniform(14.0, 32.0);
  d.wing.areal_density = 17e-3 * std::exp(uniform(-0.7, 0.7));
  d.pitch.damping *= std::exp(uniform(-2.0, 4.0));
  d.pitch.rotational_lift = uniform(0.0, 1.0) < 0.7;
  d.aerodynamics.added_mass = uniform(0.0, 1.0) < 0.7;
  if (uniform(0.0, 1.0) < 0.3) {
    d.aerodynamics.coefficients_name = "translational-2022";
    d.aerodynamics.coefficients = translational_2022();
  }
  if (uniform(0.0, 1.0) < 0.3) d.motor.constants.armature_inductance = 0.0;
  if (uniform(0.0, 1.0) < 0.3) d.friction = {FrictionLaw::viscous, 2e-6};
  if (stops) d.pitch.stop = uniform(0.05, 0.5);
  return d;
}

}  // namespace wingbeat

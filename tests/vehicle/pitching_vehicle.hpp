// A direct drive with wings that pitch, for tests.
#pragma once

#include <cmath>
#include <random>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/parts/pitching_wings.hpp"

namespace wingbeat {

/// The reference vehicle's motor and equivalent wings, driven directly at their resonance, on hinges of `stiffness`
/// [N m/rad] each.
inline Vehicle<double> pitching_vehicle(double stiffness, double voltage = 3.0, Condition condition = Condition::air) {
  Design<double> d = reference_design();
  d.transmission = {};
  d.transmission.type = TransmissionType::direct;
  d.supply = {SupplyType::sine, voltage, 22.0, 1.0};
  d.friction = {FrictionLaw::viscous, 1e-6};
  d.spring.resonance = 22.0;
  d.wing.planform = {};
  d.wing.planform.shape = PlanformShape::semi_ellipse;
  d.wing.planform.length = 63e-3;
  d.wing.planform.root_chord = 25e-3;
  Vehicle<double> v = resolve(d, condition);
  PitchingWings<double>& w = v.pitch;
  w.hinge = hinges_together<double>({stiffness, 2e-8}, d.wing.count);
  w.pitch_inertia = d.wing.count * 3e-9;
  w.mass_product = d.wing.count * 8e-9;
  w.moments = pitch_chord_moments(d.wing.planform, d.wing.count);
  w.air = pitch_added_mass(v.wings.air_density, w.moments, 0.0);
  w.normal_force = NormalForce::normal_force;
  return v;
}

/// Hinges from soft to stiff, with and without stops, driven below and above resonance.
inline Vehicle<double> random_pitching_vehicle(std::mt19937_64& random, bool stops) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const double stiffness = std::exp(uniform(std::log(5e-5), std::log(3e-3)));
  Vehicle<double> v = pitching_vehicle(stiffness, uniform(0.5, 5.0));
  v.drive_frequency = uniform(14.0, 34.0);
  v.pitch.pitch_inertia *= std::exp(uniform(-0.7, 0.7));
  v.pitch.mass_product *= uniform(-0.5, 1.2);
  v.pitch.hinge.damping *= std::exp(uniform(-3.0, 3.0));
  if (uniform(0.0, 1.0) < 0.3) v.pitch.rotational_coefficient = 0.0;
  if (stops) set_stops(v.pitch.hinge, uniform(0.05, 0.6));
  return v;
}

}  // namespace wingbeat

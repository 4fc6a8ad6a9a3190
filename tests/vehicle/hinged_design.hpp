// Designs whose wings, a membrane and a spar, pitch on hinges: a direct drive, random ones, random cranks.
#pragma once

#include <cmath>
#include <random>

#include "vehicle/direct_design.hpp"
#include "vehicle/random_vehicle.hpp"
#include "vehicle/wide_boxes.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"

namespace wingbeat {

/// The design with wings of a semi-ellipse on hinges of `stiffness` [N m/rad] in place of those that it has.
inline Design<double> on_hinges(Design<double> d, double stiffness) {
  d.wing.planform = {};
  d.wing.planform.shape = PlanformShape::semi_ellipse;
  d.wing.planform.length = 63e-3;
  d.wing.planform.root_chord = 25e-3;
  d.wing.areal_density = 17e-3;
  d.wing.spar_density = 0.614e-3;
  d.pitch.stiffness = stiffness;
  d.pitch.damping = 2e-8;
  d.pitch.damping_coefficient = rotational_damping_coefficient;
  d.aerodynamics.pitch_coefficient = 0.0;
  d.aerodynamics.added_mass = true;
  d.aerodynamics.coefficients_name = normal_force_set;
  d.aerodynamics.coefficients = *named_coefficients(normal_force_set);
  return d;
}

inline Design<double> hinged_design(double stiffness) { return on_hinges(direct_design(), stiffness); }

/// Damping, rotational lift, added mass and coefficients of wings on hinges, drawn by `uniform`.
template <class Uniform>
void scatter_hinged_wings(Design<double>& d, const Uniform& uniform) {
  d.pitch.damping *= std::exp(uniform(-2.0, 4.0));
  d.pitch.rotational_lift = uniform(0.0, 1.0) < 0.7;
  d.aerodynamics.added_mass = uniform(0.0, 1.0) < 0.7;
  if (uniform(0.0, 1.0) < 0.3) {
    d.aerodynamics.coefficients_name = "translational-2022";
    d.aerodynamics.coefficients = translational_2022();
  }
}

/// A direct drive with and without stops, inductance and friction, on hinges from soft to stiff.
inline Design<double> random_hinged_design(std::mt19937_64& random, bool stops) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  Design<double> d = hinged_design(std::exp(uniform(std::log(1e-4), std::log(3e-3))));
  d.supply.voltage = uniform(0.5, 5.0);
  d.supply.frequency = uniform(14.0, 32.0);
  d.wing.areal_density = 17e-3 * std::exp(uniform(-0.7, 0.7));
  scatter_hinged_wings(d, uniform);
  if (uniform(0.0, 1.0) < 0.3) d.motor.constants.armature_inductance = 0.0;
  if (uniform(0.0, 1.0) < 0.3) d.friction = {FrictionLaw::viscous, 2e-6};
  if (stops) d.pitch.stop = uniform(0.05, 0.5);
  return d;
}

/// A crank of any transmission, friction law and formulation, with and without springs, losses of the gearbox,
/// inductance and stops, on hinges from soft to stiff.
inline Design<double> random_hinged_crank(std::uint32_t n, std::uint32_t seed) {
  std::seed_seq sequence{seed, 77u, n};
  std::mt19937_64 random(sequence);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto logarithmic = [&](double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); };
  const double stiffness = logarithmic(1.5e-4, 3e-3);
  Design<double> d = on_hinges(random_design(random, 1.6), stiffness);
  const double kind = uniform(0.0, 1.0);
  if (kind > 0.5) {
    Design<double> other;
    std::uint32_t k = n;
    do {
      other = wide_vehicle(kind > 0.75 ? FarBox::four_bar : FarBox::tabulated, k, seed).design;
      k += 100000;
    } while (stroke_amplitude(transmission_of(other.transmission)) > 1.3);
    d.transmission = other.transmission;
  }
  d.wing.areal_density = 17e-3 * logarithmic(0.5, 2.0);
  scatter_hinged_wings(d, uniform);
  if (uniform(0.0, 1.0) < 0.2) d.motor.gear_efficiency = uniform(0.6, 1.0);
  if (n % 2 == 1) d.pitch.stop = uniform(0.1, 0.8);
  return d;
}

}  // namespace wingbeat

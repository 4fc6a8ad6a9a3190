// Further physics on top of a random vehicle: docs/model.md sections 9 to 12, each with numbers from weak to strong.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string_view>

#include "wingbeat/parts/coefficient_sets.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

enum class ModelOption { none, added_mass, gear, heat, all, pitch };
inline constexpr std::array<std::string_view, 6> model_option_names = {"none", "added_mass",  "gear",
                                                                       "heat", "all_options", "pitch"};

/// Turns the model option on, its numbers drawn by `n` and the seed alone. A direct drive has no gear efficiency, and
/// none of constant friction whose wings pitch.
inline void add_model_option(Design<double>& d, ModelOption option, std::uint32_t n, std::uint32_t seed) {
  std::seed_seq sequence{seed, 1000u + std::uint32_t(option), n};
  std::mt19937_64 random(sequence);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto logarithmic = [&](double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); };
  if ((option == ModelOption::added_mass || option == ModelOption::all) && d.aerodynamics.air_density > 0.0) {
    d.aerodynamics.added_mass = true;
    d.aerodynamics.angle_of_attack_min.reset();
    // J_a up to the limit beyond which no inertia would be left at some angle of attack.
    const bool direct = d.transmission.type == TransmissionType::direct;
    const double inertia = d.wing.count * d.wing.inertia + (direct ? d.motor.constants.inertia : 0.0);
    d.wing.planform.s22 =
        logarithmic(0.01, 0.9) * (direct ? 1.0 : 3.0) * inertia / (0.25 * pi * d.aerodynamics.air_density);
  }
  if ((option == ModelOption::gear || option == ModelOption::all) && d.transmission.type != TransmissionType::direct) {
    d.motor.gear_efficiency = uniform(0.5, 1.0);
  }
  if (option == ModelOption::heat || option == ModelOption::all) {
    d.motor.thermal.resistance_winding = logarithmic(1.0, 40.0);
    d.motor.thermal.resistance_case = logarithmic(3.0, 80.0);
    if (uniform(0.0, 1.0) < 0.5) d.motor.thermal.magnet_temperature_coefficient = -0.001;
  }
  if (option == ModelOption::pitch) {
    // The semi-ellipse of the same S_2 and S_3, on hinges whose own frequency lies about that of flapping.
    Planform<double>& p = d.wing.planform;
    const double length = p.s3 / p.s2 * 15.0 * pi / 32.0;
    p.root_chord = 16.0 * p.s2 / (d.wing.count * pi * length * length * length);
    p.length = length;
    p.shape = PlanformShape::semi_ellipse;
    const double inertia = logarithmic(0.01, 0.15) * d.wing.inertia;
    d.wing.pitch_inertia = inertia;
    d.wing.mass_product = uniform(-0.3, 0.9) * std::sqrt(d.wing.inertia * inertia);
    d.pitch.stiffness = inertia * square(two_pi * logarithmic(15.0, 300.0));
    d.pitch.damping = std::sqrt(*d.pitch.stiffness * inertia) * logarithmic(1e-3, 1.0);
    if (uniform(0.0, 1.0) < 0.5) d.pitch.stop = uniform(0.1, 1.2);
    d.pitch.rotational_lift = uniform(0.0, 1.0) < 0.7;
    d.pitch.damping_coefficient = rotational_damping_coefficient;
    d.aerodynamics.added_mass = uniform(0.0, 1.0) < 0.7;
    d.aerodynamics.angle_of_attack_min.reset();
    d.aerodynamics.pitch_coefficient = 0.0;
    d.aerodynamics.coefficients_name = normal_force_set;
    d.aerodynamics.coefficients = *named_coefficients(normal_force_set);
    if (d.transmission.type == TransmissionType::direct) {
      d.motor.constants.friction_torque = 0.0;
      if (d.friction.law == FrictionLaw::constant) d.friction = {FrictionLaw::none, 0.0};
    }
  }
}

}  // namespace wingbeat

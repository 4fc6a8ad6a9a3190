// Further physics on top of a random vehicle: docs/model.md sections 9 to 11, each with numbers from weak to strong.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <string_view>

#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

enum class Rung { none, added_mass, gear, heat, all };
inline constexpr std::array<std::string_view, 5> rung_names = {"none", "added_mass", "gear", "heat", "all_rungs"};

/// Turns the rung on, its numbers drawn by `n` and the seed alone. A direct drive has no gear efficiency.
inline void add_rung(Design<double>& d, Rung rung, std::uint32_t n, std::uint32_t seed) {
  std::seed_seq sequence{seed, 1000u + std::uint32_t(rung), n};
  std::mt19937_64 random(sequence);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto logarithmic = [&](double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); };
  if ((rung == Rung::added_mass || rung == Rung::all) && d.aerodynamics.air_density > 0.0) {
    d.aerodynamics.added_mass = true;
    d.aerodynamics.angle_of_attack_min.reset();
    // J_a up to the limit beyond which no inertia would be left at some angle of attack.
    const bool direct = d.transmission.type == TransmissionType::direct;
    const double inertia = d.wing.count * d.wing.inertia + (direct ? d.motor.constants.inertia : 0.0);
    d.wing.planform.s22 =
        logarithmic(0.01, 0.9) * (direct ? 1.0 : 3.0) * inertia / (0.25 * pi * d.aerodynamics.air_density);
  }
  if ((rung == Rung::gear || rung == Rung::all) && d.transmission.type != TransmissionType::direct) {
    d.motor.gear_efficiency = uniform(0.5, 1.0);
  }
  if (rung == Rung::heat || rung == Rung::all) {
    d.motor.thermal.resistance_winding = logarithmic(1.0, 40.0);
    d.motor.thermal.resistance_case = logarithmic(3.0, 80.0);
    if (uniform(0.0, 1.0) < 0.5) d.motor.thermal.magnet_temperature_coefficient = -0.001;
  }
}

}  // namespace wingbeat

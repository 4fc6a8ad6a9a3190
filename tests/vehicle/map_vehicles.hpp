// Random vehicles with a motor for either wing, of each kind that static maps are made of, with stops and without.
#pragma once

#include <array>
#include <random>
#include <string_view>

#include "vehicle/hinged_design.hpp"
#include "vehicle/wide_boxes.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"

namespace wingbeat {

enum class MapKind { crank, four_bar, tabulated, direct, hinged_crank, hinged_direct };
inline constexpr std::array<std::string_view, 6> map_kind_names = {"crank",  "four_bar",     "tabulated",
                                                                   "direct", "hinged_crank", "hinged_direct"};

/// Vehicle number n of a kind: it depends on the kind, n and the seed alone. With `stops`, wings on hinges hit them,
/// and the pitch law ends at a least angle of attack. It need not flap.
inline Design<double> map_vehicle(MapKind kind, bool stops, std::uint32_t n, std::uint32_t seed = 33) {
  std::seed_seq sequence{seed, 3000u + std::uint32_t(kind), n};
  std::mt19937_64 random(sequence);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  Design<double> d;
  switch (kind) {
    case MapKind::crank: d = random_design(random, 1.6); break;
    case MapKind::four_bar: d = wide_vehicle(FarBox::four_bar, n, seed).design; break;
    case MapKind::tabulated: d = wide_vehicle(FarBox::tabulated, n, seed).design; break;
    case MapKind::direct: d = random_direct_design(random, uniform(0.0, 1.0) < 0.3); break;
    case MapKind::hinged_crank: d = random_hinged_crank(n, seed); break;
    case MapKind::hinged_direct: d = random_hinged_design(random, stops); break;
  }
  d.wing.count = 1.0;
  d.motors = 2.0;
  d.aerodynamics.angle_of_attack_min.reset();
  d.pitch.stop.reset();
  const double share = uniform(0.3, 0.9);
  if (!stops) return d;
  try {
    validate(d);
  } catch (const ParameterError&) {
    return d;
  }
  // Within what the wings do without stops.
  const SteadyFlapping free = find_steady_flapping(resolve(d), {.tolerance = 1e-6, .stability = false});
  if (free.status != FlappingStatus::flapping) return d;
  if (kind == MapKind::hinged_crank || kind == MapKind::hinged_direct) {
    d.pitch.stop = share * free.metrics[Metric::pitch_amplitude] / degrees_per_radian;
  } else {
    const double least = free.metrics[Metric::angle_of_attack_min] / degrees_per_radian;
    d.aerodynamics.angle_of_attack_min = 0.5 * pi - share * (0.5 * pi - least);
  }
  return d;
}

}  // namespace wingbeat

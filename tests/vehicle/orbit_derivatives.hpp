#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>

#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"

namespace wingbeat {

/// Derivatives of metrics by some numbers of a design, along its orbit, against central differences of fourth order of
/// orbits to 1e-12. `parameters` gives their addresses in a design of any scalar; `tolerance` is relative to
/// metric over number.
template <class Parameters>
void expect_orbit_derivatives(const Design<double>& d, const Parameters& parameters,
                              std::initializer_list<Metric> metrics, double tolerance) {
  const auto orbit_of = [](const Design<double>& design) {
    const SteadyFlapping found = find_steady_flapping(resolve(design), {.tolerance = 1e-12, .stability = false});
    EXPECT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
    return found;
  };
  Design<GradientJet> seeded = cast<GradientJet>(d);
  const auto jets = parameters(seeded);
  for (std::size_t k = 0; k < jets.size(); ++k) *jets[k] = gradient_seed(value_of(*jets[k]), int(k));
  const OrbitGradient g = orbit_gradient(orbit_of(d), gradient_vehicle(seeded, Condition::air));
  ASSERT_TRUE(g.regular);
  for (std::size_t k = 0; k < jets.size(); ++k) {
    const double value = value_of(*jets[k]), h = 2e-4 * value;
    const double steps[] = {-2.0, -1.0, 1.0, 2.0}, weights[] = {1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};
    std::array<Metrics<double>, 4> shifted;
    for (std::size_t n = 0; n < 4; ++n) {
      Design<double> moved = d;
      *parameters(moved)[k] = value + steps[n] * h;
      shifted[n] = orbit_of(moved).metrics;
    }
    for (const Metric m : metrics) {
      double difference = 0.0;
      for (std::size_t n = 0; n < 4; ++n) difference += weights[n] * shifted[n][m] / h;
      EXPECT_NEAR(g.metrics[m].v[gradient_first_slot + Eigen::Index(k)], difference,
                  tolerance * std::abs(value_of(g.metrics[m]) / value))
          << metric_info(m).key << " by parameter " << k;
    }
  }
}

}  // namespace wingbeat

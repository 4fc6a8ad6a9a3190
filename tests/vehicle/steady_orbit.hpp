// The periodic orbit of a design that flaps, and the same from rest in time.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "vehicle/metrics_apart.hpp"
#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

inline SteadyFlapping steady_orbit(const Design<double>& d, double tolerance = 1e-9) {
  validate(d);
  const SteadyFlapping found = find_steady_flapping(resolve(d), {.tolerance = tolerance}, start_up_in_time());
  EXPECT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
  return found;
}

/// The orbit's metrics are those that the simulation in its air settles to, 1e-6, and its energy balance closes, 1e-7.
inline void expect_as_in_time(const SteadyFlapping& orbit, const Design<double>& d, std::ptrdiff_t number) {
  TransientOptions options;
  options.tolerance = 1e-7;
  const TransientResult time = simulate_start_up(in_air(resolve(d), air_of(orbit.metrics)), options);
  ASSERT_TRUE(time.metrics) << number << ": " << describe(time.evidence);
  std::string where;
  EXPECT_LT(metrics_apart(orbit.metrics, *time.metrics, where), 1e-6) << number << ", " << where;
  EXPECT_LT(std::abs(energy_audit(orbit.metrics).imbalance), 1e-7 * orbit.metrics[Metric::power_electrical]) << number;
}

}  // namespace wingbeat

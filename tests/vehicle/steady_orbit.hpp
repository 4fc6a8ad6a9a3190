// The periodic orbit of a design that flaps.
#pragma once

#include <gtest/gtest.h>

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

}  // namespace wingbeat

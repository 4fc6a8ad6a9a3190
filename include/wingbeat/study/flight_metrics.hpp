// Metrics of a whole flight on a battery, which cost a simulated discharge; study/endurance.hpp.
#pragma once

#include <bitset>

#include "wingbeat/cycle/metric_values.hpp"

namespace wingbeat {

/// Which metrics of a whole flight are wanted.
struct FlightMetrics {
  bool hover = false, endurance = false;
  bool allow_extrapolation = false;  ///< a vehicle outside the model's domain may hover

  bool any() const { return hover || endurance; }
};
FlightMetrics flight_metrics(const std::bitset<metric_count>& metrics, bool allow_extrapolation);

}  // namespace wingbeat

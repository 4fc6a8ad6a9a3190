// What an ensemble is made of.
#pragma once

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// One vehicle of an ensemble, validated and resolved.
struct EnsembleMember {
  Vehicle<double> vehicle;
  Reporting reporting;
};

}  // namespace wingbeat

// What the search for steady flapping is given: options, and who is asked what happens from rest.
#pragma once

#include <functional>
#include <optional>

#include "wingbeat/core/status.hpp"
#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/status_evidence.hpp"
#include "wingbeat/vehicle/coordinates.hpp"

namespace wingbeat {

/// A settled cycle as it was simulated in time, where the crank angle cannot be the independent variable.
struct SimulatedCycle {
  Metrics<double> metrics;         ///< floquet_multiplier_max is absent
  double error_estimate = absent;  ///< of the metrics, relative
  int cycles = 1;                  ///< after which the motion repeats; the metrics are averages over them
};

/// What a vehicle does when it is switched on at rest at stroke angle zero; the transient solver supplies it.
struct StartUpOutcome {
  FlappingStatus status = FlappingStatus::flapping;
  bool settled = false;  ///< false: undecided within the solver's limits
  StatusEvidence evidence;
  /// Flapping: how everything is at crank angle 0 (direct drive: phase 0 of the supply); a crank's angle is 0.
  Coordinates<double> state{};
  /// Flapping: goes on with the simulation for the metrics of the settled cycle, to a tolerance; empty if it does not
  /// settle. An assessment that cannot tell them leaves this empty.
  std::function<std::optional<SimulatedCycle>(double tolerance, const Reporting& reporting)> cycle;
};
/// Asked at the end of each turn of a crank with everything there, the angle being 0: true where what becomes of it is
/// known, so that it counts as settled.
using Arrival = std::function<bool(const Coordinates<double>&)>;
using StartUp = std::function<StartUpOutcome(const Vehicle<double>&, const Arrival&)>;

struct SteadyOptions {
  double tolerance = 1e-6;  ///< wanted relative accuracy of every metric; 1e-12 is the tightest that makes sense
  bool stability = true;    ///< compute floquet_multiplier_max
  Reporting reporting = {};
};

}  // namespace wingbeat

// The steady flapping of one vehicle, found as a periodic orbit in crank angle or in the phase of the supply, or the
// reason why it does not flap.
#pragma once

#include <functional>
#include <string>

#include "wingbeat/core/status.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/record.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/solve/periodic.hpp"

namespace wingbeat {

/// What a vehicle does when it is switched on at rest at stroke angle zero; the transient solver supplies it.
struct StartUpOutcome {
  FlappingStatus status = FlappingStatus::flapping;
  bool settled = false;      ///< false: undecided within the solver's limits
  std::string detail;        ///< the evidence, one sentence
  double crank_speed = 0.0;  ///< flapping: omega at crank angle 0 (direct drive: phase 0 of the supply) [rad/s]
  double current = 0.0;      ///< flapping: i there [A]
  double stroke_angle = 0.0; ///< flapping, direct drive: beta there [rad]
};
using StartUp = std::function<StartUpOutcome(const Vehicle<double>&)>;

struct SteadyOptions {
  double tolerance = 1e-6;  ///< wanted relative accuracy of every metric; 1e-12 is the tightest that makes sense
  bool stability = true;    ///< compute floquet_multiplier_max
  Reporting reporting = {};
};

struct SteadyFlapping {
  FlappingStatus status = FlappingStatus::stalled;
  std::string detail;              ///< one sentence: what was found, with the evidence
  solve::PeriodicSummary summary;  ///< of the orbit search
  StaticBalance balance{};
  Metrics<double> metrics;  ///< all absent unless flapping
  CycleRecord record;       ///< the orbit's cycle; empty unless flapping
  double crank_speed = absent;  ///< flapping: omega at crank angle 0 (direct drive: phase 0 of the supply) [rad/s]
  double current = absent;      ///< flapping: i there [A]
};

/// Finds the steady flapping of a validated vehicle. Never throws on account of the vehicle, never hangs, never returns
/// NaN but for absent metrics. `start_up` decides what happens from rest where the orbit alone cannot: where the crank
/// could lock or jam, where several orbits may exist, and where no orbit is found. Without it such vehicles are judged
/// by statics alone.
SteadyFlapping find_steady_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options = {},
                                    const StartUp& start_up = {});

}  // namespace wingbeat

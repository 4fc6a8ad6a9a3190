// The steady flapping of one vehicle, found as a periodic orbit in crank angle or in the phase of the supply, or the
// reason why it does not flap.
#pragma once

#include <optional>

#include "wingbeat/core/status.hpp"
#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/record.hpp"
#include "wingbeat/cycle/statics.hpp"
#include "wingbeat/cycle/status_evidence.hpp"
#include "wingbeat/cycle/steady_options.hpp"
#include "wingbeat/parts/motor_thermal.hpp"
#include "wingbeat/solve/periodic_summary.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

struct SteadyFlapping {
  FlappingStatus status = FlappingStatus::stalled;
  StatusEvidence evidence;          ///< what shows it; in words: describe()
  solver::PeriodicSummary summary;  ///< of the orbit search
  StaticBalance balance{};
  Metrics<double> metrics;  ///< all absent unless flapping
  CycleRecord record;       ///< the orbit's cycle; empty unless flapping, and where the cycle was simulated in time
  std::optional<SimulatedCycle> simulated;  ///< where no periodic orbit in crank angle gives the metrics, but this does
  double crank_speed = absent;  ///< flapping: omega at crank angle 0 (direct drive: phase 0 of the supply) [rad/s]
  double current = absent;      ///< flapping: i there [A]
  /// At which the motor's constants were taken [K]; absent where it does not heat up.
  MotorTemperatures<double> temperatures{absent, absent};
};

/// Finds the steady flapping of a validated vehicle. Never throws on account of the vehicle, never hangs, never returns
/// NaN but for absent metrics. `start_up` decides what happens from rest where the orbit alone cannot: where the crank
/// could lock or jam, where several orbits may exist, and where no orbit is found. Without it such vehicles are
/// assessed by statics alone. A motor with thermal resistances is taken at the temperatures at which it settles
/// (cycle/thermal_equilibrium.hpp), also where it is asked what happens from rest.
SteadyFlapping find_steady_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options = {},
                                    const StartUp& start_up = {});

}  // namespace wingbeat

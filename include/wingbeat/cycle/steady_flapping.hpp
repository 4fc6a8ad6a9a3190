// The steady flapping of one vehicle, found as a periodic orbit in crank angle or in the phase of the supply, or the
// reason why it does not flap.
#pragma once

#include <functional>
#include <optional>

#include "wingbeat/core/status.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/record.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/cycle/status_evidence.hpp"
#include "wingbeat/solve/periodic.hpp"

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
  double crank_speed = 0.0;     ///< flapping: omega at crank angle 0 (direct drive: phase 0 of the supply) [rad/s]
  double current = 0.0;         ///< flapping: i there [A]
  double stroke_angle = 0.0;    ///< flapping, direct drive: beta there [rad]
  double pitch_angle = 0.0;     ///< flapping, of wings that pitch: psi there [rad]
  double pitch_velocity = 0.0;  ///< psi' there [rad/s]
  /// Flapping: goes on with the simulation for the metrics of the settled cycle, to a tolerance; empty if it does not
  /// settle. An assessment that cannot tell them leaves this empty.
  std::function<std::optional<SimulatedCycle>(double tolerance, const Reporting& reporting)> cycle;
};
using StartUp = std::function<StartUpOutcome(const Vehicle<double>&)>;

struct SteadyOptions {
  double tolerance = 1e-6;  ///< wanted relative accuracy of every metric; 1e-12 is the tightest that makes sense
  bool stability = true;    ///< compute floquet_multiplier_max
  Reporting reporting = {};
};

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

#include "wingbeat/cycle/steady_flapping.hpp"

#include "wingbeat/core/cancellation.hpp"
#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/cycle/orbit_search.hpp"
#include "wingbeat/cycle/thermal_equilibrium.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

using Evidence = StatusEvidence::Kind;

}  // namespace

bool detail::stalls(const StaticBalance& statics, SteadyFlapping& result) {
  result.metrics.values.fill(absent);
  result.balance = statics;
  if (!statics.stalled()) return false;
  result.status = FlappingStatus::stalled;
  result.evidence = {
      .kind = Evidence::weak_motor, .torque = statics.stall_torque, .friction_torque = statics.breakaway_torque};
  return true;
}

bool detail::stalls(const Vehicle<double>& vehicle, const DirectBalance& balance, SteadyFlapping& result) {
  result.metrics.values.fill(absent);
  result.balance.stall_torque = balance.drive_torque;
  result.balance.breakaway_torque = balance.breakaway_torque;
  if (!balance.stalled()) return false;
  result.status = FlappingStatus::stalled;
  result.evidence = {.kind = vehicle.voltage_offset == 0.0 ? Evidence::weak_supply : Evidence::weak_alternation,
                     .frequency = vehicle.drive_frequency,
                     .torque = balance.drive_torque,
                     .friction_torque = balance.breakaway_torque};
  return true;
}

StatusEvidence detail::jam_evidence(const StaticBalance& s) {
  if (s.lever_min <= 0.0) return {.kind = Evidence::lever_may_vanish, .angle = s.lever_angle, .lever = s.lever_min};
  return {.kind = Evidence::inertia_may_vanish, .angle = s.inertia_angle, .inertia = s.inertia_min};
}

void detail::add_locks(const Vehicle<double>& vehicle, const StaticBalance& statics, StatusEvidence& evidence) {
  evidence.can_lock = statics.can_lock();
  if (evidence.can_lock) evidence.locks = lock_intervals(vehicle);
}

void detail::fill_simulated(const StartUpOutcome& outcome, const SteadyOptions& options, bool direct,
                            SteadyFlapping& result) {
  if (outcome.settled && outcome.cycle) result.simulated = outcome.cycle(options.tolerance, options.reporting);
  result.evidence.search = result.summary.status;
  result.evidence.direct = direct;
  if (!result.simulated) {
    result.status = FlappingStatus::undecided;
    result.evidence.kind = Evidence::no_cycle;
    return;
  }
  result.status = FlappingStatus::flapping;
  result.metrics = result.simulated->metrics;
  result.crank_speed = outcome.state.speed;
  result.current = outcome.state.current;
  result.evidence.kind = Evidence::simulated_cycle;
  result.evidence.frequency = result.metrics[Metric::frequency];
  result.evidence.change = result.simulated->error_estimate;
  result.evidence.repeats_after = result.simulated->cycles;
}

SteadyFlapping detail::find_flapping_among(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                           const StartUp& start_up, SharedSearch& shared) {
  const bool rotates = drive_of(vehicle).rotates;
  if (is_of_further_kind(vehicle)) {
    return rotates ? find_any_crank_flapping(vehicle, options, start_up, shared)
                   : find_any_direct_flapping(vehicle, options, start_up, shared);
  }
  if (pitches(vehicle)) {
    return rotates ? find_pitching_crank_flapping(vehicle, options, start_up, shared)
                   : find_pitching_flapping(vehicle, options, start_up, shared);
  }
  return rotates ? find_crank_flapping(vehicle, options, start_up, shared)
                 : find_direct_flapping(vehicle, options, start_up, shared);
}

SteadyFlapping detail::find_flapping_as_it_is(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                              const StartUp& start_up) {
  check_cancellation();
  SharedSearch alone;
  alone.work.limit = search_work(vehicle);
  return find_flapping_among(vehicle, options, start_up, alone);
}

namespace {

/// `find` in the air that settles around what it finds.
template <class Find>
SteadyFlapping find_in_its_air(const Vehicle<double>& vehicle, const SteadyOptions& options, const Find& find) {
  if (!settles_air(vehicle)) return find(vehicle, options);
  SteadyOptions within = options;
  within.tolerance = tolerance_within_equilibrium(options.tolerance);
  AirEquilibrium equilibrium(vehicle, options.tolerance);
  SteadyFlapping found;
  do {
    found = find(in_air(vehicle, equilibrium.at()), within);
  } while (!equilibrium.advance(found.status == FlappingStatus::flapping, found.metrics));
  if (conclude(equilibrium, found.status, found.evidence)) return found;
  SteadyFlapping none;
  none.metrics.values.fill(absent);
  none.status = found.status;
  none.evidence = found.evidence;
  return none;
}

}  // namespace

SteadyFlapping detail::find_flapping_at_given_temperature(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                                          const StartUp& start_up) {
  return find_in_its_air(vehicle, options, [&](const Vehicle<double>& v, const SteadyOptions& within) {
    return find_flapping_as_it_is(v, within, start_up);
  });
}

SteadyFlapping find_steady_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                    const StartUp& start_up) {
  if (!heats_up(vehicle.thermal)) return detail::find_flapping_at_given_temperature(vehicle, options, start_up);
  return find_in_its_air(vehicle, options, [&](const Vehicle<double>& v, const SteadyOptions& within) {
    return detail::find_warm_flapping(v, within, start_up);
  });
}

}  // namespace wingbeat

#include "wingbeat/cycle/steady_flapping.hpp"

#include <cmath>

#include "wingbeat/core/cancellation.hpp"
#include "wingbeat/cycle/orbit_search.hpp"
#include "wingbeat/cycle/thermal_equilibrium.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

using detail::OrbitSearch;

using Evidence = StatusEvidence::Kind;

template <int N>
CrankSystem<double, N> crank_system(const Vehicle<double>& vehicle) {
  typename CrankSystem<double, N>::State typical{no_load_speed(vehicle)};
  if constexpr (N == 2) typical[1] = vehicle.voltage / circuit_resistance(vehicle);
  return {vehicle, typical, 1e-4 * no_load_speed(vehicle)};
}

template <int N>
class CrankSearch : public OrbitSearch<CrankSystem<double, N>> {
 public:
  CrankSearch(const Vehicle<double>& vehicle, const SteadyOptions& options, solver::WorkBudget& work)
      : OrbitSearch<CrankSystem<double, N>>(crank_system<N>(vehicle), options, work) {}

  /// One search from crank speed omega at crank angle zero, with the quasi-steady current of `earlier_speed`.
  bool from(double omega, double earlier_speed, double expected_multiplier = 1.0) {
    const auto& system = this->system();
    if (!(omega > system.speed_floor)) return false;
    if constexpr (N == 2) {
      return this->search({omega, algebraic_current(system.vehicle, system.vehicle.voltage, earlier_speed)},
                          expected_multiplier);
    } else {
      return this->search({omega}, expected_multiplier);
    }
  }
  /// Searches from where a simulation in time has settled.
  bool near(double omega, double current) {
    if (!(omega > this->system().speed_floor)) return false;
    if constexpr (N == 2) {
      return this->search_near({omega, current});
    } else {
      return this->search_near({omega});
    }
  }
  double crank_speed() const { return this->start()[0]; }
};

template <int N>
SteadyFlapping search(const Vehicle<double>& vehicle, const SteadyOptions& options, const StartUp& start_up,
                      solver::WorkBudget& work) {
  SteadyFlapping result;
  const StaticBalance statics = static_balance(vehicle);
  if (detail::stalls(statics, result)) return result;

  CrankSearch<N> orbit(vehicle, options, work);
  bool found = false, ambiguous = false;
  if (!statics.can_jam()) {
    const OrbitGuess<double> guess = guess_orbit(vehicle);
    found = guess.balanced.count > 0.0 && orbit.from(guess.crank_speed, guess.earlier_speed, guess.multiplier);
    // The fastest start: if cycles from there fail, no slower one can be expected to last.
    if (!found) found = orbit.from(no_load_speed(vehicle), no_load_speed(vehicle));
    ambiguous =
        guess.balanced.count > 1.0 || (found && hardly_returns(vehicle, orbit.multiplier(), 1.0 / orbit.frequency()));
  }

  std::optional<StartUpOutcome> outcome;
  if ((statics.can_jam() || statics.can_lock() || ambiguous || !found) && start_up) {
    outcome = start_up(vehicle);
    if (outcome->status != FlappingStatus::flapping) {
      result.status = outcome->status;
      result.evidence = outcome->evidence;
      if (result.status == FlappingStatus::undecided) result.evidence.search = orbit.summary().status;
      if (found) result.evidence.faster_orbit = orbit.frequency();
      result.summary = orbit.summary();
      return result;
    }
    if (outcome->settled) {
      const auto is_reached = [&](double closeness) {
        return std::abs(orbit.crank_speed() - outcome->crank_speed) < closeness * outcome->crank_speed &&
               orbit.multiplier() < 1.0;
      };
      found = (found && is_reached(1e-3)) || (orbit.near(outcome->crank_speed, outcome->current) && is_reached(1e-2));
    } else if (ambiguous) {
      found = false;  // it rotates, on an orbit that is not determined
    }
  } else if (found) {
    found = orbit.multiplier() < 1.0;
  }
  result.summary = orbit.summary();
  if (found) {
    result.status = FlappingStatus::flapping;
    result.evidence = {.kind = Evidence::orbit, .frequency = orbit.frequency(), .assessed = bool(start_up)};
    detail::add_locks(vehicle, statics, result.evidence);
    orbit.fill(result);
    return result;
  }
  if (outcome) {
    detail::fill_simulated(*outcome, options, false, result);
    return result;
  }
  if (statics.can_jam()) {
    result.status = FlappingStatus::jammed;
    result.evidence = detail::jam_evidence(statics);
  } else if (result.summary.status == solver::PeriodicStatus::converged) {
    result.status = FlappingStatus::undecided;
    result.evidence = {
        .kind = Evidence::unstable_orbit, .frequency = orbit.frequency(), .multiplier = orbit.multiplier()};
  } else if (result.summary.status == solver::PeriodicStatus::unbalanced) {
    result.status = FlappingStatus::undecided;
    result.evidence = {.kind = Evidence::open_balance, .change = orbit.imbalance(), .search = result.summary.status};
  } else {
    result.status = FlappingStatus::locked;
    result.evidence = {.kind = Evidence::no_orbit, .angle = result.summary.stop, .search = result.summary.status};
    detail::add_locks(vehicle, statics, result.evidence);
  }
  return result;
}

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
  result.evidence = {.kind = Evidence::weak_supply,
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
  result.crank_speed = outcome.crank_speed;
  result.current = outcome.current;
  result.evidence.kind = Evidence::simulated_cycle;
  result.evidence.frequency = result.metrics[Metric::frequency];
  result.evidence.change = result.simulated->error_estimate;
  result.evidence.repeats_after = result.simulated->cycles;
}

SteadyFlapping detail::find_flapping_among(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                           const StartUp& start_up, SharedSearch& shared) {
  const bool rotates = drive_of(vehicle).rotates;
  if (pitches(vehicle)) {
    return rotates ? find_pitching_crank_flapping(vehicle, options, start_up, shared)
                   : find_pitching_flapping(vehicle, options, start_up, shared);
  }
  if (!rotates) return find_direct_flapping(vehicle, options, start_up, shared);
  return has_current_state(vehicle) ? search<2>(vehicle, options, start_up, shared.work)
                                    : search<1>(vehicle, options, start_up, shared.work);
}

SteadyFlapping detail::find_flapping_as_it_is(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                              const StartUp& start_up) {
  check_cancellation();
  SharedSearch alone;
  alone.work.limit = search_work(vehicle);
  return find_flapping_among(vehicle, options, start_up, alone);
}

SteadyFlapping find_steady_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                    const StartUp& start_up) {
  return heats_up(vehicle.thermal) ? detail::find_warm_flapping(vehicle, options, start_up)
                                   : detail::find_flapping_as_it_is(vehicle, options, start_up);
}

}  // namespace wingbeat

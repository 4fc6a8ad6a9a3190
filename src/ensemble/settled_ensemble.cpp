// Ensembles of vehicles around whose orbits something settles: the temperatures of their motors, the air. All of them
// are solved at a place each, again and again, until each has settled.
#include <utility>
#include <vector>

#include "ensemble/ensemble_run.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/cycle/thermal_equilibrium.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

template <class Equilibrium>
struct Search {
  std::size_t member;
  Equilibrium equilibrium;
};

bool fails(const ThermalEquilibrium& e) { return e.outcome() == ThermalOutcome::does_not_settle; }
bool fails(const AirEquilibrium& e) { return e.outcome() == AirOutcome::does_not_settle; }

/// `place(vehicle, equilibrium)` is the vehicle where the search wants it solved, `solve(trials, results)` solves all.
template <class Equilibrium, class Place, class Solve>
void settle(std::span<const EnsembleMember> members, std::vector<Search<Equilibrium>> active, const MetricSet& wanted,
            const Place& place, const Solve& solve, std::span<EnsembleOutcome> outcomes) {
  std::vector<EnsembleMember> trials;
  std::vector<EnsembleOutcome> results;
  while (!active.empty()) {
    trials.clear();
    for (const auto& search : active) {
      const EnsembleMember& member = members[search.member];
      trials.push_back({place(member.vehicle, search.equilibrium), member.reporting});
    }
    results.resize(trials.size());
    solve(trials, results);
    std::size_t left = 0;
    for (std::size_t k = 0; k < active.size(); ++k) {
      Search<Equilibrium>& search = active[k];
      if (!search.equilibrium.advance(results[k].status == FlappingStatus::flapping, results[k].metrics)) {
        active[left++] = search;
        continue;
      }
      EnsembleOutcome& outcome = outcomes[search.member];
      outcome = results[k];
      if (fails(search.equilibrium)) {
        outcome = {FlappingStatus::undecided, results[k].scalar, absent, {}};
        outcome.metrics.values.fill(absent);
      }
      keep_wanted(wanted, outcome.metrics);
    }
    active.erase(active.begin() + std::ptrdiff_t(left), active.end());
  }
}

EnsembleOptions options_within(const EnsembleOptions& options, std::initializer_list<Metric> needed) {
  EnsembleOptions within = options;
  within.tolerance = tolerance_within_equilibrium(options.tolerance);
  for (const Metric m : needed) within.metrics.set(std::size_t(m));
  return within;
}

/// All members, each in the air as its vehicle has it.
void solve_in_given_air(std::span<const EnsembleMember> members, const EnsembleOptions& options,
                        const StartUp& start_up, std::span<EnsembleOutcome> outcomes) {
  run_ensemble(members, options, start_up, outcomes, [](const Vehicle<double>& v) { return !heats_up(v.thermal); });
  std::vector<Search<ThermalEquilibrium>> warm;
  for (std::size_t n = 0; n < members.size(); ++n) {
    const MotorThermal<double>& thermal = members[n].vehicle.thermal;
    if (heats_up(thermal)) warm.push_back({n, ThermalEquilibrium(thermal, options.tolerance)});
  }
  const EnsembleOptions within = options_within(options, {Metric::winding_temperature, Metric::case_temperature});
  settle(
      members, std::move(warm), options.metrics,
      [](const Vehicle<double>& v, const ThermalEquilibrium& e) { return with_motor_at(v, e.at()); },
      [&](std::span<const EnsembleMember> trials, std::span<EnsembleOutcome> results) {
        run_ensemble(trials, within, start_up, results, [](const Vehicle<double>&) { return true; });
      },
      outcomes);
}

}  // namespace

void solve_ensemble(std::span<const EnsembleMember> members, const EnsembleOptions& options, const StartUp& start_up,
                    std::span<EnsembleOutcome> outcomes) {
  require(options.tolerance >= 1e-12 && options.tolerance <= 1e-2, "tolerance", "must lie between 1e-12 and 1e-2", "1",
          options.tolerance);
  if (!is_available(options.isa)) throw ParameterError("isa", "this processor lacks the instruction set");
  std::vector<Search<AirEquilibrium>> settling;
  for (std::size_t n = 0; n < members.size(); ++n) {
    const Vehicle<double>& v = members[n].vehicle;
    if (settles_air(v)) settling.push_back({n, AirEquilibrium(v, options.tolerance)});
  }
  if (settling.empty()) return solve_in_given_air(members, options, start_up, outcomes);
  std::vector<EnsembleMember> others;
  std::vector<std::size_t> which;
  for (std::size_t n = 0; n < members.size(); ++n) {
    if (!settles_air(members[n].vehicle)) others.push_back(members[n]), which.push_back(n);
  }
  std::vector<EnsembleOutcome> results(others.size());
  solve_in_given_air(others, options, start_up, results);
  for (std::size_t k = 0; k < which.size(); ++k) outcomes[which[k]] = results[k];
  const EnsembleOptions within = options_within(options, {Metric::induced_velocity, Metric::stroke_angle_max});
  settle(
      members, std::move(settling), options.metrics,
      [](const Vehicle<double>& v, const AirEquilibrium& e) { return in_air(v, e.at()); },
      [&](std::span<const EnsembleMember> trials, std::span<EnsembleOutcome> found) {
        solve_in_given_air(trials, within, start_up, found);
      },
      outcomes);
}

}  // namespace wingbeat

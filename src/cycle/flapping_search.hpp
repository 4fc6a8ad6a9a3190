// How the steady flapping of one vehicle is found, whatever drives it: stable orbits from several starts, and where
// they leave a doubt, the one that it reaches from rest. Where searches start and what their end means is the drive's
// matter: cycle/crank_search.hpp, cycle/direct_search.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "wingbeat/cycle/orbit_search.hpp"

namespace wingbeat::detail {

/// Typical sizes of a system's states; 1 of what the vehicle does not have.
template <class System>
typename System::State sizes_of_states(const Vehicle<double>& vehicle, const Coordinates<double>& typical) {
  typename System::State sizes = System::state_of(typical, vehicle);
  if constexpr (System::general) {
    for (double& size : sizes) size = size > 0.0 ? size : 1.0;
  }
  return sizes;
}

/// The stable orbits of a vehicle that searches have found so far, and what they have found beside.
template <class System>
class StableOrbits {
 public:
  using State = typename System::State;
  /// Evaluations that all searches may take together.
  static constexpr long all = System::on_hinges ? pitching_search_work : orbit_search_work;

  StableOrbits(const System& system, const SteadyOptions& options, SharedSearch& shared)
      : system_(system), options_(options), shared_(shared) {}

  /// Searches from a state; keeps the orbit found if it is stable and none that is known. It may take so many
  /// evaluations: one start may not take what is left for the others.
  void attempt(State guess, long max_evaluations = all, double expected_multiplier = 1.0) {
    if (System::on_hinges && leads_to_known(guess)) return;
    keep(guess, max_evaluations, [&](auto& orbit) { return orbit.search(guess, expected_multiplier); });
  }
  void attempt_near(const State& guess, long max_evaluations = all) {
    keep(guess, max_evaluations, [&](auto& orbit) { return orbit.search_near(guess); });
  }

  /// Searches for the mirror image of the only orbit known. Under a sine without an offset the equations stay the same
  /// if every state changes its sign and time moves by half a period: an orbit that changes by this has a twin.
  void attempt_mirror_image()
    requires(!System::turns)
  {
    if (orbits_.size() != 1 || system_.vehicle.voltage_offset != 0.0) return;
    State mirrored = orbits_[0].half_way();
    for (double& y : mirrored) y = -y;
    mirrored[0] += 2.0 * system_.vehicle.spring.rest_angle;
    if (apart(mirrored, orbits_[0].start(), springs_return() ? 0 : 1) > same) attempt_near(mirrored);
  }

  /// Which of them it is that a simulation has settled on, at that state; it is sought there where none is known.
  std::optional<std::size_t> reached_at(const State& settled) {
    std::optional<std::size_t> which = nearest_to(settled);
    if (!which) attempt_near(settled), which = nearest_to(settled);
    if (!which && !System::on_hinges) attempt(settled), which = nearest_to(settled);
    if (which && orbits_[*which].holds_wings()) hold_where_left(*which, settled);
    return which;
  }

  /// Which of them a drive whose cycle is the supply's comes to from rest: iterates from there are its start-up.
  /// Nothing where they come to none within a few hundred.
  std::optional<std::size_t> reached_from_rest()
    requires(!System::turns)
  {
    return reached_from({});
  }

  /// Which of them iterates from a state come to; nothing as above, and where the crank does not turn on. One whose
  /// hinges hold the wings becomes the one on which they are held where these iterates leave them.
  std::optional<std::size_t> reached_from(State here) {
    const std::optional<std::size_t> which = plain_iterates(here, hold_wings() ? on_held : usual, 300);
    if (which && orbits_[*which].holds_wings()) hold_where_left(*which, here);
    return which;
  }

  /// Whether on one of them friction of the pitch hinge holds the wings all the time.
  bool hold_wings() const {
    return std::any_of(orbits_.begin(), orbits_.end(), [](const auto& orbit) { return orbit.holds_wings(); });
  }

  bool empty() const { return orbits_.empty(); }
  std::size_t size() const { return orbits_.size(); }
  OrbitSearch<System>& operator[](std::size_t which) { return orbits_[which]; }

  const System& system() const { return system_; }
  const solver::PeriodicSummary& last() const { return last_; }  ///< of the last search, its iterates those of all
  int iterates() const { return iterates_; }                     ///< of all searches
  double imbalance() const { return imbalance_; }  ///< of a cycle refused for its energy balance; absent without
  /// Of an orbit found that is unstable; absent without.
  double unstable_multiplier() const { return unstable_multiplier_; }
  double unstable_frequency() const { return unstable_frequency_; }
  /// A search that ended with its evaluations was here last, if there was one.
  const std::optional<State>& unfinished() const { return unfinished_; }

  /// Nothing returns a shaft without springs, or a piezo's own, to any angle: a multiplier of 1 there.
  bool springs_return() const {
    return System::turns || system_.vehicle.spring.stiffness > 0.0 || is_given(system_.vehicle.piezo);
  }

 private:
  static constexpr double close = 1e-2;  ///< to an orbit: on the way to it
  static constexpr double same = 1e-3;   ///< orbits that are nearer to each other are one
  /// Of iterates alone: where hinges hold the wings, their errors decide where.
  static constexpr solver::IterateOptions usual{.tolerance = 1e-6, .max_steps = 2000},
      on_held{.tolerance = 1e-9, .max_steps = 20000};

  /// The orbit that `search` finds, at most with so many evaluations, and what it was like: of none as well.
  template <class Search>
  std::pair<OrbitSearch<System>, bool> found(long max_evaluations, const Search& search) {
    solver::WorkBudget part = shared_.work.part(max_evaluations);
    OrbitSearch<System> orbit(system_, options_, part);
    const bool is_found = search(orbit);
    shared_.work.used += part.used;
    iterates_ += orbit.summary().iterates;
    return {std::move(orbit), is_found};
  }

  template <class Search>
  void keep(const State& guess, long max_evaluations, const Search& search) {
    if (!system_.admissible(guess)) return;
    auto [orbit, is_found] = found(max_evaluations, search);
    last_ = orbit.summary();
    last_.iterates = iterates_;
    if (last_.status == solver::PeriodicStatus::unbalanced) imbalance_ = orbit.imbalance();
    if (last_.status == solver::PeriodicStatus::out_of_work && orbit.started() && !unfinished_) {
      unfinished_ = orbit.start();
    }
    if (!is_found) return;
    const bool held = orbit.holds_wings();
    if (springs_return() && !held && !(orbit.multiplier() < 1.0)) {
      unstable_multiplier_ = orbit.multiplier();
      unstable_frequency_ = orbit.frequency();
      return;
    }
    for (OrbitSearch<System>& known : orbits_) {
      if (held && known.holds_wings()) return;
      if (apart(known.start(), orbit.start(), springs_return() ? 0 : 1) < same) return;
    }
    orbits_.push_back(std::move(orbit));
  }

  /// Of an orbit whose hinges hold the wings: the one on which they are held where iterates from a state close to it
  /// leave them.
  void hold_where_left(std::size_t which, State here) {
    constexpr double settled = 1e-6;
    iterate_until(here, on_held, 300, [&](const State& from, const State& to) { return apart(from, to) < settled; });
    auto [orbit, is_found] = found(all, [&](auto& search) { return search.search_near(here); });
    if (is_found && orbit.holds_wings()) orbits_[which] = std::move(orbit);
  }

  /// Whether plain iterates from a state come to a stable orbit that is known, at less work than to find it once more;
  /// moves the state along them.
  bool leads_to_known(State& y) {
    if (orbits_.empty() || !springs_return()) return false;
    constexpr solver::IterateOptions rough{.tolerance = 1e-3, .max_steps = 2000};
    constexpr int fewest = 8, most = 40;
    // As many as leave of the largest distance what counts as close.
    double slowest = 0.0;
    for (OrbitSearch<System>& known : orbits_) slowest = std::max(slowest, known.multiplier());
    const double needed = std::ceil(std::log(close) / std::log(std::min(slowest, 0.99)));
    return plain_iterates(y, rough, int(std::clamp(needed + 2.0, double(fewest), double(most)))).has_value();
  }

  /// Moves a state along iterates until it is close to one of the orbits: which.
  std::optional<std::size_t> plain_iterates(State& y, const solver::IterateOptions& options, int max_iterates) {
    std::optional<std::size_t> which;
    iterate_until(y, options, max_iterates, [&](const State&, const State& end) {
      which = nearest_to(end);
      return which.has_value();
    });
    return which;
  }

  /// Moves a state along at most so many iterates, until `done` of the ends of one; not at all where one cannot be
  /// completed.
  template <class Done>
  void iterate_until(State& y, const solver::IterateOptions& options, int max_iterates, const Done& done) {
    solver::Iterate<System> iterate;
    State here = y;
    for (int n = 0; n < max_iterates && !shared_.work.spent() && system_.admissible(here); ++n) {
      solver::run_iterate<false>(system_, here, options, iterate);
      shared_.work.used += long(iterate.steps.size());
      ++iterates_;
      if (iterate.status != solver::IterateStatus::complete) return;
      const State from = std::exchange(here, iterate.end);
      if (done(from, here)) break;
    }
    y = here;
  }

  std::optional<std::size_t> nearest_to(const State& settled) const {
    const auto nearest = std::min_element(orbits_.begin(), orbits_.end(), [&](const auto& a, const auto& b) {
      return apart(a.start(), settled) < apart(b.start(), settled);
    });
    if (nearest == orbits_.end() || !(apart(nearest->start(), settled) < close)) return std::nullopt;
    return std::size_t(nearest - orbits_.begin());
  }

  /// Largest distance of two states, over their typical sizes; of a crank's speeds over the second one.
  double apart(const State& a, const State& b, std::size_t from = 0) const {
    double highest = 0.0;
    for (std::size_t n = from; n < a.size(); ++n) {
      const double size = System::turns && n == System::shaft ? b[n] : system_.typical[n];
      highest = std::max(highest, std::abs(a[n] - b[n]) / size);
    }
    return highest;
  }

  System system_;
  const SteadyOptions& options_;
  SharedSearch& shared_;
  std::vector<OrbitSearch<System>> orbits_;
  solver::PeriodicSummary last_;
  std::optional<State> unfinished_;
  int iterates_ = 0;
  double imbalance_ = absent, unstable_multiplier_ = absent, unstable_frequency_ = absent;
};

/// The steady flapping of a vehicle of one kind. Drive: CrankSearch or DirectSearch.
template <class Drive>
SteadyFlapping search_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options, const StartUp& start_up,
                               SharedSearch& shared) {
  using System = typename Drive::System;
  SteadyFlapping result;
  Drive drive(vehicle);
  if (drive.stalls(result)) return result;
  StableOrbits<System> orbits(drive.system(), options, shared);
  if (System::on_hinges && shared.orbit.size() == std::tuple_size_v<typename System::State>) {
    typename System::State before;
    std::copy(shared.orbit.begin(), shared.orbit.end(), before.begin());
    orbits.attempt_near(before, Drive::part);
  }
  if (orbits.empty()) drive.search(orbits);
  shared.orbit.clear();
  result.summary = orbits.last();

  std::size_t chosen = 0;
  const auto unresolved = [&] {
    return orbits.size() != 1 || drive.in_doubt(orbits) || orbits[0].over_rotates() || orbits.hold_wings();
  };
  std::optional<std::size_t> from_rest;
  if constexpr (System::on_hinges && !System::turns) {
    if (start_up && !orbits.empty() && unresolved()) from_rest = orbits.reached_from_rest();
    if (from_rest) chosen = *from_rest;
  }
  if (start_up && !from_rest && unresolved()) {
    // A crank that has turned is in the orbit search's own terms: iterates follow it on, many times as fast.
    Arrival arrived;
    if constexpr (System::turns) {
      arrived = [&, first_turn = true](const Coordinates<double>& there) mutable {
        if (std::exchange(first_turn, false) && !orbits.empty()) {
          from_rest = orbits.reached_from(System::state_of(there, vehicle));
        }
        return from_rest.has_value();
      };
    }
    const StartUpOutcome outcome = start_up(vehicle, arrived);
    if (outcome.status != FlappingStatus::flapping) {
      result.status = outcome.status;
      result.evidence = outcome.evidence;
      if (result.status == FlappingStatus::undecided) result.evidence.search = orbits.last().status;
      if (System::turns) {
        result.evidence.faster_orbit = orbits.empty() ? orbits.unstable_frequency() : orbits[0].frequency();
      }
      return result;
    }
    std::optional<std::size_t> which = from_rest;
    if (!which && outcome.settled) {
      which = orbits.reached_at(System::state_of(outcome.state, vehicle));
    }
    result.summary = orbits.last();
    if (!which) {
      fill_simulated(outcome, options, !System::turns, result);
      return result;
    }
    chosen = *which;
  }
  if (orbits.empty()) {
    drive.explain(orbits, result);
    return result;
  }

  std::optional<SteadyFlapping> other;
  if (orbits.size() > 1) orbits[chosen == 0 ? 1 : 0].fill(other.emplace());
  OrbitSearch<System>& orbit = orbits[chosen];
  if (System::on_hinges && !other) shared.orbit.assign(orbit.start().begin(), orbit.start().end());
  result.summary = orbit.summary();
  result.summary.iterates = orbits.iterates();
  const bool held = orbit.holds_wings();
  orbit.fill(result);
  if (held && std::isfinite(result.metrics[Metric::floquet_multiplier_max])) {
    result.metrics[Metric::floquet_multiplier_max] = 1.0;  // plain iterates that have closed it do not see it
  }
  if (!orbits.springs_return()) result.metrics[Metric::floquet_multiplier_max] = absent;
  result.status = FlappingStatus::flapping;
  const double over_rotation = vehicle.wings.air_density > 0.0 ? result.evidence.over_rotation : absent;
  result.evidence = drive.evidence(result.metrics, other ? &other->metrics : nullptr, bool(start_up));
  result.evidence.over_rotation = over_rotation;
  return result;
}

}  // namespace wingbeat::detail

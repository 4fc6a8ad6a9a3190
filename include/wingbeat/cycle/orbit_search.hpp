// The search for one vehicle's orbit, and what is reported of it: the same for every system.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "wingbeat/cycle/direct_balance.hpp"
#include "wingbeat/cycle/extremes.hpp"
#include "wingbeat/cycle/integrals_audit.hpp"
#include "wingbeat/cycle/pitch_metrics.hpp"
#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/solve/periodic.hpp"

namespace wingbeat::detail {

/// What one vehicle's searches may take together, over all starts. It bounds the processor time: a step of the explicit
/// pair takes about a microsecond, of wings that pitch about three.
constexpr long orbit_search_work = 1000000, pitching_search_work = 300000;
inline long search_work(const Vehicle<double>& vehicle) {
  return pitches(vehicle) || is_of_further_kind(vehicle) ? pitching_search_work : orbit_search_work;
}

/// What the solutions of one vehicle share that differ by the temperatures of its motor alone.
struct SharedSearch {
  solver::WorkBudget work;
  /// Start of the only stable orbit of wings that pitch at the last temperature, which a motor that warms up follows;
  /// empty where there was none, or more than one.
  std::vector<double> orbit;
};

/// find_flapping_as_it_is() as one of several solutions.
SteadyFlapping find_flapping_among(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                   const StartUp& start_up, SharedSearch& shared);

/// The steady flapping of a vehicle of one kind; see find_steady_flapping.
SteadyFlapping find_crank_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                   const StartUp& start_up, SharedSearch& shared);
SteadyFlapping find_pitching_crank_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                            const StartUp& start_up, SharedSearch& shared);
SteadyFlapping find_direct_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                    const StartUp& start_up, SharedSearch& shared);
SteadyFlapping find_pitching_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                      const StartUp& start_up, SharedSearch& shared);
SteadyFlapping find_any_crank_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                       const StartUp& start_up, SharedSearch& shared);
SteadyFlapping find_any_direct_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                        const StartUp& start_up, SharedSearch& shared);

/// The start of every search under a crank: its statics. True, with the decision, of a motor that never starts.
bool stalls(const StaticBalance& statics, SteadyFlapping& result);
/// The start of every search of a direct drive: its harmonic balance. True, with the decision, where it stalls.
bool stalls(const Vehicle<double>& vehicle, const DirectBalance& balance, SteadyFlapping& result);

/// What shows that a crank may jam.
StatusEvidence jam_evidence(const StaticBalance& statics);
/// Adds where the crank locks once it has stopped.
void add_locks(const Vehicle<double>& vehicle, const StaticBalance& statics, StatusEvidence& evidence);

/// Takes the metrics of a vehicle that flaps, but on no orbit found, from its simulated cycle; undecided without one.
void fill_simulated(const StartUpOutcome& outcome, const SteadyOptions& options, bool direct, SteadyFlapping& result);

/// Searches for a periodic orbit and fills the result from it.
template <class System>
class OrbitSearch {
 public:
  using State = typename System::State;

  /// What the search takes is added to `work`, which ends it.
  OrbitSearch(const System& system, const SteadyOptions& options, solver::WorkBudget& work)
      : options_(options), system_(system), work_(work) {}

  /// One search from a state at the start of an iterate; of the multiplier see PeriodicOptions.
  bool search(const State& guess, double expected_multiplier = 1.0) {
    solver::PeriodicOptions periodic{.tolerance = step_tolerance(),
                                     .stability = options_.get().stability,
                                     .expected_multiplier = expected_multiplier};
    if constexpr (System::on_hinges) periodic.max_steps = pitching_steps;
    if (stiff(guess)) periodic.method = solver::Method::radau;
    const int iterates_before = summary_.iterates;
    solve(guess, periodic);
    const bool other_method = summary_.status == solver::PeriodicStatus::too_many_steps ||
                              summary_.status == solver::PeriodicStatus::unbalanced;
    if (other_method && periodic.method != solver::Method::radau) {
      periodic.method = solver::Method::radau;
      solve(guess, periodic);
    }
    if (summary_.status == solver::PeriodicStatus::too_many_steps && !System::turns) {
      // Not stiff then, but hard: a shaft that hardly breaks away.
      periodic.method = solver::Method::explicit_pair;
      periodic.max_steps *= 20;
      solve(guess, periodic);
    }
    summary_.iterates += iterates_before;
    return summary_.status == solver::PeriodicStatus::converged;
  }

  /// Searches from a state close to the orbit. Explicit steps that are unstable may end at the edge as well as take too
  /// many: implicit ones tell.
  bool search_near(const State& guess) {
    solver::PeriodicOptions periodic{
        .tolerance = step_tolerance(), .stability = options_.get().stability, .near = true};
    if constexpr (System::on_hinges) periodic.max_steps = pitching_steps;
    for (const auto method : {solver::Method::explicit_pair, solver::Method::radau}) {
      if (method == solver::Method::explicit_pair && stiff(guess)) continue;
      periodic.method = method;
      const int iterates_before = summary_.iterates;
      solve(guess, periodic);
      summary_.iterates += iterates_before;
      if (summary_.status == solver::PeriodicStatus::converged) return true;
    }
    return false;
  }

  /// The largest multiplier of the orbit found, if only roughly: where plain iterates have closed it, that shows that
  /// they contract.
  double multiplier() {
    if (std::isfinite(summary_.floquet_multiplier_max)) return summary_.floquet_multiplier_max;
    if (summary_.newton_steps == 0) return 0.0;
    if (!multiplier_) {
      constexpr int n = int(std::tuple_size_v<State>);
      multiplier_ = solver::monodromy_product(system_, system_.template cast<Jet<n>>(), iterate_).spectral_radius();
    }
    return *multiplier_;
  }

  /// What the energy balance leaves open of a cycle refused for that, of the input.
  double imbalance() const { return imbalance_; }

  const System& system() const { return system_; }
  const solver::PeriodicSummary& summary() const { return summary_; }
  /// True where a start() is known, if only that of the last iterate of a search that ended without an orbit.
  bool started() const { return !iterate_.steps.empty(); }
  const State& start() const { return iterate_.steps.front().y; }
  /// Half a period after start().
  State half_way() const {
    const solver::Step<System>& last = iterate_.steps.back();
    const double x = 0.5 * (iterate_.steps.front().x + last.x + last.h);
    return solver::evaluate_inside<false>(system_, iterate_, solver::step_at(iterate_, x), x).y;
  }
  double frequency() const {
    double period = 0.0;
    for (const auto& step : iterate_.steps) period += step.dq[std::size_t(Integral::time)];
    return 1.0 / period;
  }

  /// True where friction of the pitch hinge holds the wings all the time, or lets them slip less and less: so it does
  /// at any pitch within its reach, and nothing brings them back to this one.
  bool holds_wings() const {
    if constexpr (!System::on_hinges) return false;
    else {
      constexpr double slip = 1e-8;  // of the pitch, in rad
      const PitchHinge<double>& hinge = system_.vehicle.pitch.hinge;
      if (!has_friction(hinge) || is_at_stop(hinge, start()[System::pitch])) return false;
      const auto is_held = [](const auto& step) { return step.signs[System::held] < 0.0; };
      return std::any_of(iterate_.steps.begin(), iterate_.steps.end(), is_held) &&
             std::all_of(iterate_.steps.begin(), iterate_.steps.end(), [&](const auto& step) {
               return is_held(step) || std::abs(step.y[System::pitch] - start()[System::pitch]) < slip;
             });
    }
  }

  /// True where wings over-rotate for a notable part of the period: there, a second orbit is stable now and then.
  bool over_rotates() {
    if constexpr (!System::on_hinges) return false;
    else
      return pitches(system_.vehicle) && system_.vehicle.wings.air_density > 0.0 &&
             pitch().over_rotation_of_moving() > notable_over_rotation;
  }

  void fill(SteadyFlapping& result) {
    result.crank_speed = system_.shaft_speed(start());
    result.current = system_.current(0.0, start());
    const CycleExtremes<double> extremes = cycle_extremes(system_, iterate_, options_.get().tolerance);
    const bool pitching = System::on_hinges && pitches(system_.vehicle);
    PitchMetrics of_pitch{};
    if constexpr (System::on_hinges) {
      if (pitching) of_pitch = pitch();
    }
    result.record = CycleRecord(CycleRecord::Recorded{RecordedCycle<System>{system_, std::move(iterate_)}});
    result.metrics = cycle_metrics(system_.vehicle, result.record.integrals(), extremes,
                                   summary_.floquet_multiplier_max, options_.get().reporting);
    if (pitching) {
      set_pitch_metrics(of_pitch, system_.vehicle.pitch, result.metrics);
      result.evidence.over_rotation = of_pitch.over_rotation_of_moving();
    }
  }

 private:
  /// The part of an iterate's error that the estimates of its steps see: across the knots of a table, steps err more.
  double seen_by_steps() const {
    const Vehicle<double>& v = system_.vehicle;
    const bool knots = v.wings.coefficients.table || is_given(v.wings.tabulated) ||
                       (System::turns && v.transmission.type == TransmissionType::tabulated);
    return knots ? 0.2 : 1.0;
  }
  double step_tolerance() const { return seen_by_steps() * options_.get().tolerance; }

  const PitchMetrics& pitch() {
    if (!pitch_) pitch_ = pitch_metrics(system_, iterate_);
    return *pitch_;
  }

  /// The estimate of the steps is raised to what they do not see.
  void solve(const State& guess, const solver::PeriodicOptions& periodic) {
    search_balanced(guess, periodic);
    summary_.error_estimate /= seen_by_steps();
  }
  /// An orbit whose energy balance stays open is none: finer steps first.
  void search_balanced(const State& guess, solver::PeriodicOptions periodic) {
    pitch_.reset();
    multiplier_.reset();
    constexpr double finer = 1e-2, finest = 1e-12;
    summary_ = solver::solve_periodic(system_, guess, periodic, iterate_, work_.get());
    if (summary_.status != solver::PeriodicStatus::converged || balances()) return;
    const EnergyAudit open = audit();
    imbalance_ = std::abs(open.imbalance / open.electrical);
    const int iterates_before = summary_.iterates;
    periodic.tolerance = std::max(finer * periodic.tolerance, std::min(finest, periodic.tolerance));
    periodic.near = true;
    const State start = iterate_.steps.front().y;
    summary_ = solver::solve_periodic(system_, start, periodic, iterate_, work_.get());
    summary_.iterates += iterates_before;
    if (summary_.status == solver::PeriodicStatus::converged && balances()) return;
    summary_.status = solver::PeriodicStatus::unbalanced;
  }

  bool balances() const { return closes(audit(), options_.get().tolerance, 0.0, blocked_input(system_.vehicle)); }
  EnergyAudit audit() const {
    double hinge_work = 0.0;
    if constexpr (System::on_hinges) {
      for (const auto& step : iterate_.steps) hinge_work += step.dq[System::hinge_work];
    }
    return energy_audit(system_.vehicle, cycle_integrals(iterate_), hinge_work);
  }

  /// True where explicit steps need not be tried.
  bool stiff([[maybe_unused]] const State& guess) const {
    if constexpr (requires { system_.stiff(guess); }) return system_.stiff(guess);
    else return false;
  }

  static constexpr int pitching_steps = 2000;  ///< a stiff hinge's own frequency is many times the supply's

  std::reference_wrapper<const SteadyOptions> options_;
  System system_;
  std::reference_wrapper<solver::WorkBudget> work_;
  solver::Iterate<System> iterate_;
  solver::PeriodicSummary summary_;
  std::optional<PitchMetrics> pitch_;
  std::optional<double> multiplier_;
  double imbalance_ = absent;
};

}  // namespace wingbeat::detail

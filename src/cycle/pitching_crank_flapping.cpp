// How the steady flapping of a crank whose wings pitch on a hinge is found: model.md section 12.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "wingbeat/core/root.hpp"
#include "wingbeat/cycle/orbit_search.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

using PitchCrankEvidence = StatusEvidence::Kind;

/// The vehicle with the largest inertia that its wings have at any pitch: whether its equations have one solution must
/// not depend on how they pitch.
Vehicle<double> of_max_inertia(Vehicle<double> vehicle) {
  vehicle.wings.added_inertia = std::max(vehicle.pitch.air.rr, vehicle.pitch.pitch_inertia);
  return vehicle;
}

/// Pitch [rad] at which the hinge balances the air on a wing that moves steadily: the quasi-static pitch law, of
/// magnitude alone, at most a right angle and the stop.
double quasi_static_pitch(const Vehicle<double>& v, double stroke_velocity) {
  const PitchingWings<double>& p = v.pitch;
  const double max_angle = std::min(0.5 * pi, p.hinge.stop);
  const auto holds = [&](double psi) {
    const PitchState<double> state = pitch_state(-psi, 0.0, std::abs(stroke_velocity));
    return p.hinge.stiffness * psi < aero_loads(v.wings, p, state, 1.0, 1.0).pitch_moment;
  };
  if (holds(max_angle)) return max_angle;
  return bisect(holds, 0.0, max_angle).before;
}

/// Searches from several starts: where the pitching is lightly damped, the return map does not forget them, and more
/// than one orbit may be stable.
template <int N>
class PitchingCrankSearch {
 public:
  using System = PitchCrankSystem<double, N>;
  using State = typename System::State;

  PitchingCrankSearch(const Vehicle<double>& vehicle, const SteadyOptions& options)
      : vehicle_(vehicle),
        options_(options),
        statics_(static_balance(of_max_inertia(vehicle))),
        no_load_(no_load_speed(vehicle)),
        balanced_(balanced_speed(vehicle)),
        typical_(typical_state()) {}

  SteadyFlapping run(const StartUp& start_up, SharedSearch& shared);

 private:
  static State state(double speed, double psi, double pitch_velocity, double current) {
    State y{speed};
    if constexpr (System::inductive) y[System::current_state] = current;
    y[System::pitch] = psi;
    y[System::pitch + 1] = pitch_velocity;
    return y;
  }

  State typical_state() const {
    const double speed = balanced_.slowest;
    const double psi = typical_pitch(vehicle_, typical_stroke_slope(vehicle_.transmission) * speed, speed);
    return state(speed, psi, speed * psi, vehicle_.voltage / circuit_resistance(vehicle_));
  }

  /// At crank angle zero at a crank speed [rad/s], wings pitched by `psi` [rad] against their velocity.
  State turning(double speed, double psi) const {
    const double stroke = sign_of(crank_kinematics(vehicle_.transmission, 0.0, 1.0).stroke_slope);
    return state(speed, -stroke * psi, 0.0, algebraic_current(vehicle_, vehicle_.voltage, speed));
  }

  /// Largest distance of two states, over their typical sizes.
  double apart(const State& a, const State& b) const {
    double highest = 0.0;
    for (std::size_t n = 0; n < N; ++n) highest = std::max(highest, std::abs(a[n] - b[n]) / typical_[n]);
    return highest;
  }

  /// Keeps the orbit found from there, if it is stable and none that is known.
  /// It takes at most a part of the work that is left: one start may not take what is left for the others.
  void attempt(const State& guess, SharedSearch& shared, long max_evaluations, bool near = false);
  std::optional<std::size_t> reached_by(const State& settled) const;
  SteadyFlapping undecided(SteadyFlapping result) const;

  const Vehicle<double>& vehicle_;
  const SteadyOptions& options_;
  StaticBalance statics_;
  double no_load_;
  BalancedSpeed<double> balanced_;
  State typical_;

  std::vector<OrbitSearch<System>> stable_;
  solver::PeriodicSummary last_;
  int iterates_ = 0;
  double unstable_multiplier_ = absent, unstable_frequency_ = absent, imbalance_ = absent;
  bool ambiguous_ = false;
};

template <int N>
void PitchingCrankSearch<N>::attempt(const State& guess, SharedSearch& shared, long max_evaluations, bool near) {
  constexpr double same = 1e-3;  // orbits that are nearer to each other are one
  const System system(vehicle_, typical_, 1e-4 * no_load_);
  if (!system.admissible(guess)) return;
  solver::WorkBudget part = shared.work.part(max_evaluations);
  OrbitSearch<System> orbit(system, options_, part);
  const bool found = near ? orbit.search_near(guess) : orbit.search(guess);
  shared.work.used += part.used;
  iterates_ += orbit.summary().iterates;
  last_ = orbit.summary();
  if (last_.status == solver::PeriodicStatus::unbalanced) imbalance_ = orbit.imbalance();
  if (!found) return;
  const double multiplier = orbit.multiplier();
  if (!(multiplier < 1.0)) {
    unstable_multiplier_ = multiplier;
    unstable_frequency_ = orbit.frequency();
    return;
  }
  for (const OrbitSearch<System>& known : stable_) {
    if (apart(known.start(), orbit.start()) < same) return;
  }
  ambiguous_ = ambiguous_ || hardly_returns(vehicle_, multiplier, 1.0 / orbit.frequency());
  stable_.push_back(std::move(orbit));
}

/// The stable orbit on which a simulation has settled.
template <int N>
std::optional<std::size_t> PitchingCrankSearch<N>::reached_by(const State& settled) const {
  constexpr double close = 1e-2;
  const auto nearest = std::min_element(stable_.begin(), stable_.end(), [&](const auto& a, const auto& b) {
    return apart(a.start(), settled) < apart(b.start(), settled);
  });
  if (nearest == stable_.end() || !(apart(nearest->start(), settled) < close)) return std::nullopt;
  return std::size_t(nearest - stable_.begin());
}

/// What statics and search alone say of a crank for which no stable orbit was found.
template <int N>
SteadyFlapping PitchingCrankSearch<N>::undecided(SteadyFlapping result) const {
  if (statics_.can_jam()) {
    result.status = FlappingStatus::jammed;
    result.evidence = jam_evidence(statics_);
  } else if (std::isfinite(unstable_multiplier_)) {
    result.status = FlappingStatus::undecided;
    result.evidence = {.kind = PitchCrankEvidence::unstable_orbit,
                       .frequency = unstable_frequency_,
                       .multiplier = unstable_multiplier_};
  } else if (std::isfinite(imbalance_)) {
    result.status = FlappingStatus::undecided;
    result.evidence = {.kind = PitchCrankEvidence::open_balance, .change = imbalance_, .search = last_.status};
  } else {
    result.status = FlappingStatus::locked;
    result.evidence = {.kind = PitchCrankEvidence::no_orbit, .angle = last_.stop, .search = last_.status};
    add_locks(vehicle_, statics_, result.evidence);
  }
  return result;
}

template <int N>
SteadyFlapping PitchingCrankSearch<N>::run(const StartUp& start_up, SharedSearch& shared) {
  SteadyFlapping result;
  if (stalls(statics_, result)) return result;
  if (!statics_.can_jam()) {
    constexpr long part = pitching_search_work / 3, part_with_orbit = pitching_search_work / 10;
    if (shared.orbit.size() == N) {
      State before;
      std::copy(shared.orbit.begin(), shared.orbit.end(), before.begin());
      attempt(before, shared, part, true);
    }
    if (stable_.empty()) {
      const double slope = crank_kinematics(vehicle_.transmission, 0.0, 1.0).stroke_slope;
      const auto max_part = [&] { return stable_.empty() ? part : part_with_orbit; };
      attempt(turning(balanced_.slowest, quasi_static_pitch(vehicle_, slope * balanced_.slowest)), shared, part);
      attempt(turning(balanced_.slowest, 0.0), shared, part);
      attempt(turning(no_load_, std::min(0.5 * pi, vehicle_.pitch.hinge.stop)), shared, max_part());
      if (stable_.empty()) attempt(turning(no_load_, 0.0), shared, part);
    }
  }
  shared.orbit.clear();
  result.summary = last_;

  std::size_t chosen = 0;
  const bool unresolved =
      statics_.can_jam() || statics_.can_lock() || ambiguous_ || stable_.size() != 1 || stable_.front().over_rotates();
  if (unresolved && start_up) {
    const StartUpOutcome outcome = start_up(vehicle_);
    if (outcome.status != FlappingStatus::flapping) {
      result.status = outcome.status;
      result.evidence = outcome.evidence;
      if (result.status == FlappingStatus::undecided) result.evidence.search = last_.status;
      if (!stable_.empty()) result.evidence.faster_orbit = stable_.front().frequency();
      return result;
    }
    std::optional<std::size_t> which;
    if (outcome.settled) {
      const State settled = state(outcome.crank_speed, outcome.pitch_angle, outcome.pitch_velocity, outcome.current);
      which = reached_by(settled);
      if (!which) {
        attempt(settled, shared, pitching_search_work, true);
        which = reached_by(settled);
      }
    }
    if (!which) {
      result.summary = last_;
      fill_simulated(outcome, options_, false, result);
      return result;
    }
    chosen = *which;
  }
  if (stable_.empty()) return undecided(std::move(result));

  const double other_frequency = stable_.size() > 1 ? stable_[chosen == 0 ? 1 : 0].frequency() : absent;
  OrbitSearch<System>& orbit = stable_[chosen];
  if (stable_.size() == 1) shared.orbit.assign(orbit.start().begin(), orbit.start().end());
  result.summary = orbit.summary();
  result.summary.iterates = iterates_;
  result.status = FlappingStatus::flapping;
  result.evidence = {.kind = PitchCrankEvidence::orbit,
                     .frequency = orbit.frequency(),
                     .other_frequency = other_frequency,
                     .assessed = bool(start_up)};
  add_locks(vehicle_, statics_, result.evidence);
  orbit.fill(result);
  if (!(vehicle_.wings.air_density > 0.0)) result.evidence.over_rotation = absent;
  return result;
}

}  // namespace

SteadyFlapping find_pitching_crank_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                            const StartUp& start_up, SharedSearch& shared) {
  return has_current_state(vehicle) ? PitchingCrankSearch<4>(vehicle, options).run(start_up, shared)
                                    : PitchingCrankSearch<3>(vehicle, options).run(start_up, shared);
}

}  // namespace wingbeat::detail

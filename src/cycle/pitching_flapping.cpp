// How the steady flapping of a direct drive whose wings pitch on a hinge is found: model.md section 12.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "wingbeat/cycle/direct_balance.hpp"
#include "wingbeat/cycle/orbit_search.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

using PitchEvidence = StatusEvidence::Kind;

/// Searches from several starts: where the pitching is lightly damped, the return map does not forget them, and more
/// than one response may be stable.
template <int N>
class PitchingSearch {
 public:
  using System = PitchDirectSystem<double, N>;
  using State = typename System::State;

  PitchingSearch(const Vehicle<double>& vehicle, const SteadyOptions& options)
      : vehicle_(vehicle),
        options_(options),
        balance_(direct_balance(vehicle)),
        w_(two_pi * vehicle.drive_frequency),
        typical_(typical_state()) {}

  SteadyFlapping run(const StartUp& start_up, SharedSearch& shared);

 private:
  static State state(double stroke, double speed, double psi, double pitch_velocity, double current) {
    State y{stroke, speed};
    if constexpr (System::inductive) y[System::current_state] = current;
    y[System::pitch] = psi;
    y[System::pitch + 1] = pitch_velocity;
    return y;
  }

  State typical_state() const {
    const double inertia = vehicle_.motor.inertia + vehicle_.wing_count * vehicle_.wing_inertia;
    const double speed =
        balance_.responses.empty() ? balance_.drive_torque / (inertia * w_) : std::abs(balance_.responses.back().speed);
    const double psi = typical_pitch(vehicle_, speed);
    return state(speed / w_ + 1e-12, speed + 1e-9, psi, w_ * psi,
                 balance_.drive_torque / vehicle_.motor.torque_constant + 1e-12);
  }

  /// Wings that swing as harmonic balance says and pitch by `amplitude` [rad] against their velocity.
  State harmonic(double amplitude) const {
    const HarmonicResponse& r = balance_.responses.front();
    const std::complex<double> psi = -amplitude * r.speed / std::abs(r.speed);
    return state(r.stroke.imag(), r.speed.imag(), psi.imag(), (std::complex<double>(0.0, w_) * psi).imag(),
                 r.current.imag());
  }

  bool is_stable(OrbitSearch<System>& orbit) const {
    // Nothing returns a shaft without springs to any angle: a multiplier of 1 there.
    return !(vehicle_.spring.stiffness > 0.0) || orbit.multiplier() < 1.0;
  }

  /// Largest distance of two states, over their typical sizes.
  double apart(const State& a, const State& b) const {
    double highest = 0.0;
    for (std::size_t n = 0; n < N; ++n) highest = std::max(highest, std::abs(a[n] - b[n]) / typical_[n]);
    return highest;
  }

  const Vehicle<double>& vehicle_;
  const SteadyOptions& options_;
  DirectBalance balance_;
  double w_;
  State typical_;
};

template <int N>
SteadyFlapping PitchingSearch<N>::run(const StartUp& start_up, SharedSearch& shared) {
  constexpr double same = 1e-3;                              // orbits that are nearer to each other are one
  constexpr double pitch_guesses[] = {0.25 * pi, 0.5 * pi};  // [rad]
  SteadyFlapping result;
  if (stalls(vehicle_, balance_, result)) return result;

  const System system{vehicle_, typical_};
  std::vector<OrbitSearch<System>> stable;
  bool any_found = false;
  int iterates = 0;
  double unstable_multiplier = absent;
  solver::PeriodicSummary last;
  bool cut_short = false;  // some start, when the budget of work was spent
  State reached_from_rest{};
  // One start may not take what is left for the others.
  const auto attempt = [&](const State& guess, bool near, long max_evaluations) {
    solver::WorkBudget part = shared.work.part(max_evaluations);
    OrbitSearch<System> orbit(system, options_, part);
    const bool found = near ? orbit.search_near(guess) : orbit.search(guess);
    shared.work.used += part.used;
    iterates += orbit.summary().iterates;
    last = orbit.summary();
    if (last.status == solver::PeriodicStatus::out_of_work && orbit.started() && !cut_short) {
      cut_short = true;
      reached_from_rest = orbit.start();
    }
    if (!found) return;
    any_found = true;
    if (!is_stable(orbit)) {
      unstable_multiplier = orbit.multiplier();
      return;
    }
    for (const OrbitSearch<System>& known : stable) {
      if (apart(known.start(), orbit.start()) < same) return;
    }
    stable.push_back(std::move(orbit));
  };
  constexpr long all = pitching_search_work, part = all / 8;
  if (shared.orbit.size() == N) {
    State before;
    std::copy(shared.orbit.begin(), shared.orbit.end(), before.begin());
    attempt(before, true, part);
  }
  if (stable.empty()) {
    attempt(State{}, false, part);
    for (const double psi : pitch_guesses) {
      if (!balance_.responses.empty()) attempt(harmonic(psi), false, part);
    }
    if (stable.empty() && cut_short) attempt(reached_from_rest, false, all);
  }
  shared.orbit.clear();

  std::size_t chosen = 0;
  if (start_up && (stable.size() != 1 || stable.front().over_rotates())) {
    const StartUpOutcome outcome = start_up(vehicle_);
    result.summary = last;
    if (outcome.status != FlappingStatus::flapping) {
      result.status = outcome.status;
      result.evidence = outcome.evidence;
      if (result.status == FlappingStatus::undecided) result.evidence.search = last.status;
      return result;
    }
    const auto reached_by = [&](const State& reached) {
      const auto nearest = std::min_element(stable.begin(), stable.end(), [&](const auto& a, const auto& b) {
        return apart(a.start(), reached) < apart(b.start(), reached);
      });
      return nearest != stable.end() && apart(nearest->start(), reached) < 1e-2
                 ? std::optional<std::size_t>(nearest - stable.begin())
                 : std::nullopt;
    };
    std::optional<std::size_t> which;
    if (outcome.settled) {
      const State reached = state(outcome.stroke_angle, outcome.crank_speed, outcome.pitch_angle,
                                  outcome.pitch_velocity, outcome.current);
      which = reached_by(reached);
      if (!which) {
        attempt(reached, true, all);
        which = reached_by(reached);
      }
    }
    if (!which) {
      result.summary = last;
      fill_simulated(outcome, options_, true, result);
      return result;
    }
    chosen = *which;
  }
  if (stable.empty()) {
    result.summary = last;
    result.status = FlappingStatus::undecided;
    if (any_found) result.evidence = {.kind = PitchEvidence::unstable_response, .multiplier = unstable_multiplier};
    else result.evidence = {.kind = PitchEvidence::no_response, .search = last.status};
    return result;
  }

  double other_amplitude = absent;
  if (stable.size() > 1) {
    SteadyFlapping other;
    stable[chosen == 0 ? 1 : 0].fill(other);
    other_amplitude = other.metrics[Metric::stroke_amplitude];
  }
  OrbitSearch<System>& orbit = stable[chosen];
  if (stable.size() == 1) shared.orbit.assign(orbit.start().begin(), orbit.start().end());
  result.summary = orbit.summary();
  result.summary.iterates = iterates;
  orbit.fill(result);
  if (!(vehicle_.spring.stiffness > 0.0)) result.metrics[Metric::floquet_multiplier_max] = absent;
  result.status = FlappingStatus::flapping;
  const bool in_air = vehicle_.wings.air_density > 0.0;
  result.evidence = {.kind = PitchEvidence::response,
                     .frequency = vehicle_.drive_frequency,
                     .stroke_amplitude = result.metrics[Metric::stroke_amplitude],
                     .over_rotation = in_air ? result.evidence.over_rotation : absent,
                     .other_amplitude = other_amplitude};
  return result;
}

}  // namespace

SteadyFlapping find_pitching_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                      const StartUp& start_up, SharedSearch& shared) {
  return has_current_state(vehicle) ? PitchingSearch<5>(vehicle, options).run(start_up, shared)
                                    : PitchingSearch<4>(vehicle, options).run(start_up, shared);
}

}  // namespace wingbeat::detail

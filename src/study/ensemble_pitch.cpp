#include "study/ensemble_pitch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "study/pitch_search.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/study/ensemble_hold.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {
namespace {

constexpr int max_rounds = 12, max_smaller = 3;

/// One member's search, in logarithms: of C_alpha, and of the pitch at the peak, 90 deg less the angle of attack there,
/// over the one sought.
struct PitchTrial {
  std::size_t member;
  double ln_C = 0.0;
  double last_ln_C = absent, last_gap = absent;  ///< of the trial before
  int smaller = 0;  ///< times that C_alpha was made smaller because what is held was not reached
};

class EnsembleAtAngles {
 public:
  EnsembleAtAngles(std::span<EnsembleMember> members, std::span<const double> angles, std::span<const Hold> holds,
                   const EnsembleOptions& options, const StartUp& start_up, std::span<EnsembleOutcome> outcomes,
                   std::span<FrequencyOutcome> reached)
      : members_(members),
        angles_(angles),
        holds_(holds),
        options_(options),
        start_up_(start_up),
        outcomes_(outcomes),
        reached_(reached) {}

  void solve() {
    for (std::size_t n = 0; n < members_.size(); ++n) {
      if (std::isnan(angles_[n])) settled_.push_back(n);
      else searches_.push_back({n, std::log(members_[n].vehicle.wings.pitch_coefficient)});
    }
    for (int round = 0; round < max_rounds && !searches_.empty(); ++round) try_all(round);
    for (const PitchTrial& s : searches_) left_.push_back(s.member);
    for (const std::size_t n : left_) search_singly(n);
    finish();
  }

 private:
  /// Solves some members as they are; the voltages of those that hold something are changed.
  void solve_some(std::span<const std::size_t> which, const EnsembleOptions& options) {
    some_.clear(), some_holds_.clear();
    for (const std::size_t n : which) {
      some_.push_back(members_[n]);
      if (!holds_.empty()) some_holds_.push_back(holds_[n]);
    }
    some_outcomes_.assign(which.size(), {});
    some_reached_.assign(which.size(), FrequencyOutcome::reached);
    if (holds_.empty()) solve_ensemble(some_, options, start_up_, some_outcomes_);
    else solve_ensemble_held(some_, some_holds_, options, start_up_, some_outcomes_, some_reached_);
  }

  /// The first trials show slopes alone.
  EnsembleOptions trial_options(int round) const {
    EnsembleOptions options = options_;
    options.domain = false;
    options.metrics = MetricSet().set(std::size_t(Metric::angle_of_attack_min));
    options.tolerance = std::max(0.1 * options_.tolerance, 1e-12);
    if (round < 2) options.tolerance = std::max(options.tolerance, std::min(options_.tolerance, 1e-5));
    return options;
  }

  void try_all(int round) {
    std::vector<std::size_t> which;
    for (const PitchTrial& s : searches_) {
      members_[s.member].vehicle.wings.pitch_coefficient = std::exp(s.ln_C);
      which.push_back(s.member);
    }
    solve_some(which, trial_options(round));
    std::vector<PitchTrial> going_on;
    for (std::size_t k = 0; k < which.size(); ++k) {
      PitchTrial s = searches_[k];
      const double angle = some_outcomes_[k].metrics[Metric::angle_of_attack_min];
      const bool flaps = some_outcomes_[k].status == FlappingStatus::flapping && std::isfinite(angle) && angle < 90.0;
      if (!flaps || some_reached_[k] != FrequencyOutcome::reached) {
        // Wings that pitch too far may not reach what is held.
        if (holds_.empty() || ++s.smaller > max_smaller) left_.push_back(s.member);
        else s.ln_C -= 0.5, s.last_ln_C = s.last_gap = absent, going_on.push_back(s);
        continue;
      }
      const double gap = std::log((90.0 - angle) / (90.0 - degrees_per_radian * angles_[s.member]));
      if (round >= 2 && std::abs(gap) < 0.1 * options_.tolerance) {
        settled_.push_back(s.member);
        continue;
      }
      double slope = (gap - s.last_gap) / (s.ln_C - s.last_ln_C);
      if (!(slope > 0.3 && slope < 3.0)) slope = 1.0;  // the speed hardly depends on how the wings pitch
      s.last_ln_C = s.ln_C, s.last_gap = gap;
      s.ln_C -= std::clamp(gap / slope, -1.0, 1.0);
      going_on.push_back(s);
    }
    searches_ = std::move(going_on);
  }

  void search_singly(std::size_t n) {
    SteadyOptions steady;
    steady.tolerance = options_.tolerance;
    steady.reporting = members_[n].reporting;
    Vehicle<double> vehicle = members_[n].vehicle;
    FlappingStatus status = FlappingStatus::flapping;
    FrequencyOutcome why = FrequencyOutcome::outside_domain;
    const auto angle_with = [&](double C) {
      vehicle.wings.pitch_coefficient = C;
      if (!holds_.empty()) {
        const FrequencySearch found = find_voltage(vehicle, holds_[n], steady, start_up_);
        if (found.outcome != FrequencyOutcome::reached) {
          status = found.status, why = found.outcome;
          return status == FlappingStatus::flapping && leaves_angle_range(found.finding) ? below_range : absent;
        }
        set_mean_voltage(vehicle, found.voltage);
      }
      const SteadyFlapping orbit = find_steady_flapping(vehicle, steady, start_up_);
      status = orbit.status;
      return orbit.metrics[Metric::angle_of_attack_min];
    };
    const PitchSearch search = find_pitch_coefficient(members_[n].vehicle.wings.pitch_coefficient,
                                                      degrees_per_radian * angles_[n], options_.tolerance, angle_with);
    if (search.outcome == PitchOutcome::found) {
      members_[n].vehicle.wings.pitch_coefficient = search.pitch_coefficient;
      settled_.push_back(n);
      return;
    }
    reached_[n] = why;
    outcomes_[n] = {};
    outcomes_[n].status = search.outcome == PitchOutcome::no_angle ? status : FlappingStatus::flapping;
    outcomes_[n].scalar = true;
    outcomes_[n].metrics.values.fill(absent);
  }

  /// All whose C_alpha is known.
  void finish() {
    std::sort(settled_.begin(), settled_.end());
    solve_some(settled_, options_);
    for (std::size_t k = 0; k < settled_.size(); ++k) {
      const std::size_t n = settled_[k];
      members_[n] = some_[k];
      outcomes_[n] = some_outcomes_[k];
      reached_[n] = some_reached_[k];
    }
  }

  std::span<EnsembleMember> members_;
  std::span<const double> angles_;
  std::span<const Hold> holds_;
  const EnsembleOptions& options_;
  const StartUp& start_up_;
  std::span<EnsembleOutcome> outcomes_;
  std::span<FrequencyOutcome> reached_;
  std::vector<PitchTrial> searches_;
  std::vector<std::size_t> settled_, left_;  ///< C_alpha known; for the search of one
  std::vector<EnsembleMember> some_;
  std::vector<Hold> some_holds_;
  std::vector<EnsembleOutcome> some_outcomes_;
  std::vector<FrequencyOutcome> some_reached_;
};

}  // namespace

void solve_ensemble_at_angles(std::span<EnsembleMember> members, std::span<const double> angles,
                              std::span<const Hold> holds, const EnsembleOptions& options, const StartUp& start_up,
                              std::span<EnsembleOutcome> outcomes, std::span<FrequencyOutcome> reached) {
  EnsembleAtAngles(members, angles, holds, options, start_up, outcomes, reached).solve();
}

}  // namespace wingbeat::detail

#include "wingbeat/study/ensemble_hold.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "study/held_search.hpp"
#include "study/lift_peak.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

using detail::EnsembleSearch;

constexpr int max_rounds = 25;
/// Where so many trials do not flap, the search of one settles the member.
constexpr int max_still = 3;
/// Where a search has begun again so often at lower voltages, trials near the peak of the lift settle the member.
constexpr int max_returns = 8;
constexpr int strokes = 40;  ///< of which shapes are compared

/// Whether a crank's wings are so fast that the force coefficients hold at no higher voltage.
bool is_beyond_coefficients(const Vehicle<double>& v, const Metrics<double>& m) {
  const double flow = m[Metric::flapping_velocity_peak] * v.wings.s3 / v.wings.s2;
  return m[Metric::angle_of_attack_min] < angle_of_attack_lowest_deg || flow > flow_speed_max;
}

/// Whether batches can tell the lift of the wings.
bool suits_lift_search(const Vehicle<double>& v) {
  return drive_of(v).voltage_sets_frequency && !pitches(v) && v.wings.air_density > 0.0 && v.wings.s2 > 0.0;
}

class HeldEnsemble {
 public:
  HeldEnsemble(std::span<EnsembleMember> members, std::span<const Hold> holds, const EnsembleOptions& options,
               const StartUp& start_up, std::span<EnsembleOutcome> outcomes, std::span<FrequencyOutcome> reached)
      : members_(members),
        holds_(holds),
        holds_lift_(!holds.empty() && is_lift(holds.front().held)),
        holds_power_(!holds.empty() && holds.front().held == Held::power),
        options_(options),
        start_up_(start_up),
        outcomes_(outcomes),
        reached_(reached) {}

  void solve() {
    begin();
    for (int round = 0; round < max_rounds && !searches_.empty(); ++round) try_all(round);
    for (const EnsembleSearch& s : searches_) left_.push_back(s.member);
    for (const std::size_t n : left_) {
      if (search_singly(n)) settled_.push_back(n);
    }
    finish();
  }

 private:
  void begin() {
    for (std::size_t n = 0; n < members_.size(); ++n) {
      Vehicle<double>& vehicle = members_[n].vehicle;
      const Hold& hold = holds_[n];
      if (holds_lift_) {
        if (suits_lift_search(vehicle)) {
          const double lift = held_lift(hold, members_[n].reporting);
          searches_.push_back(detail::search_lift(vehicle, n, lift, in_range_of_coefficients(n)));
        } else {
          left_.push_back(n);
        }
      } else if (holds_power_) {
        const bool turns = drive_of(vehicle).voltage_sets_frequency && circuit_resistance(vehicle) > 0.0;
        if (turns) searches_.push_back(detail::search_power(vehicle, n, hold.value));
        else left_.push_back(n);
      } else if (!drive_of(vehicle).voltage_sets_frequency) {
        vehicle.drive_frequency = hold.value;
        settled_.push_back(n);
      } else if (hold.value > highest_frequency(vehicle, SearchRange::extrapolation)) {
        refuse(n, FrequencyOutcome::outside_domain, FlappingStatus::flapping, false);
      } else {
        searches_.push_back(detail::search_frequency(vehicle, n, hold.value));
      }
    }
  }

  Metric sought() const {
    return holds_lift_ ? Metric::lift_mean : holds_power_ ? Metric::power_electrical : Metric::frequency;
  }

  /// Those wanted, and those by which a lift is assessed.
  MetricSet assessed_metrics(MetricSet wanted) const {
    wanted.set(std::size_t(sought()));
    if (holds_lift_) {
      wanted.set(std::size_t(Metric::angle_of_attack_min)).set(std::size_t(Metric::flapping_velocity_peak));
    }
    return wanted;
  }

  /// The first trials are far from the answer and need not be exact. The later ones have the tolerance of the answer,
  /// so that their values differ from it as its own would: by the voltage alone.
  EnsembleOptions trial_options(int round) const {
    EnsembleOptions options = options_;
    options.domain = false;
    options.metrics = assessed_metrics({});
    constexpr double rough[] = {1e-4, 1e-5};
    if (round < 2) options.tolerance = std::max(options_.tolerance, rough[round]);
    return options;
  }

  void try_all(int round) {
    const auto answers =
        std::stable_partition(searches_.begin(), searches_.end(), [](const EnsembleSearch& s) { return !s.is_last; });
    std::vector<EnsembleSearch> going_on;
    const auto try_some = [&](std::span<const EnsembleSearch> some, const EnsembleOptions& options) {
      trials_.clear();
      for (const EnsembleSearch& s : some) {
        trials_.push_back(members_[s.member]);
        set_mean_voltage(trials_.back().vehicle, s.next);
      }
      results_.resize(some.size());
      solve_ensemble(trials_, options, start_up_, results_);
      for (std::size_t k = 0; k < some.size(); ++k) {
        EnsembleSearch s = some[k];
        if (goes_on_after(s, results_[k], round)) going_on.push_back(s);
      }
    };
    EnsembleOptions complete = options_;
    complete.metrics = assessed_metrics(options_.metrics);
    const std::size_t first_answer = std::size_t(answers - searches_.begin());
    const std::span<const EnsembleSearch> all = searches_;
    try_some(all.first(first_answer), trial_options(round));
    try_some(all.subspan(first_answer), complete);
    searches_ = std::move(going_on);
  }

  bool goes_on_after(EnsembleSearch& s, const EnsembleOutcome& result, int round) {
    const Vehicle<double>& v = members_[s.member].vehicle;
    const bool flaps = result.status == FlappingStatus::flapping;
    const double value = result.metrics[sought()];
    const double miss = std::abs(value / s.target - 1.0);
    // An answer costs little more than a trial of a lift; of others the metrics may cost as much again.
    const double closeness = std::max((holds_lift_ ? 3.0 : 0.1) * options_.tolerance, 1e-13);
    const bool is_answer = flaps && s.is_last && miss <= 0.5 * options_.tolerance;
    const double peak = result.metrics[Metric::flapping_velocity_peak];
    if (holds_lift_ && is_answer && !detail::lift_has_risen(v.wings, peak, rises(s))) {
      left_.push_back(s.member);  // a lower voltage may yield it, too
      return false;
    }
    if (is_answer && s.next > holds_[s.member].highest_voltage) {
      refuse(s.member, FrequencyOutcome::too_high, FlappingStatus::flapping, result.scalar);
      return false;
    }
    if (is_answer) {
      set_mean_voltage(members_[s.member].vehicle, s.next);
      if (holds_lift_ && is_beyond_coefficients(v, result.metrics) && in_range_of_coefficients(s.member)) {
        refuse(s.member, FrequencyOutcome::outside_domain, FlappingStatus::flapping, result.scalar);
      } else {
        reach(s.member, result);
      }
      return false;
    }
    if (holds_lift_ && flaps) {
      const bool in_range = in_range_of_coefficients(s.member), beyond = is_beyond_coefficients(v, result.metrics);
      if (in_range && beyond) return goes_on_within_range(s, peak);
      if (value > 0.0) note_lift(s, value);
      if (in_range && detail::peak_is_too_low(s.lifts)) {
        refuse(s.member, FrequencyOutcome::too_high, FlappingStatus::flapping, result.scalar);
        return false;
      }
      const bool falls = detail::sinusoidal_lift(v.wings, peak) < detail::sinusoidal_lift(v.wings, 0.95 * peak);
      if (value < s.target && (falls || beyond)) return goes_on_below(s, result);
    }
    advance(s, flaps, value, round, closeness);
    if (s.next <= s.limit && s.still < max_still) return true;
    left_.push_back(s.member);
    return false;
  }

  bool in_range_of_coefficients(std::size_t n) const { return holds_[n].range != SearchRange::extrapolation; }

  /// After too small a lift past its peak, or where the coefficients do not hold: a slower stroke may have the lift
  /// sought. By the shape of a sinusoidal one, the voltage of the slowest that has; else that of the peak, which
  /// decides.
  bool goes_on_below(EnsembleSearch& s, const EnsembleOutcome& result) {
    if (in_range_of_coefficients(s.member) && s.lifts.size() >= 3 && goes_on_towards_peak(s)) return true;
    constexpr double near = 0.93;    // from a trial at this share of its stroke velocity or closer,
    constexpr double margin = 1.02;  // the shape gives the largest lift to within this factor
    const BladeElement<double>& w = members_[s.member].vehicle.wings;
    const double peak = result.metrics[Metric::flapping_velocity_peak], lift = result.metrics[Metric::lift_mean];
    const double fastest = detail::fastest_stroke(w);
    const double shape = detail::sinusoidal_lift(w, peak);
    double share = std::clamp(fastest / peak, 0.5, 0.9);
    bool found = false;
    if (lift > 0.0 && shape > 0.0) {
      const auto lift_at = [&](int n) { return lift / shape * detail::sinusoidal_lift(w, peak * n / strokes); };
      const int end = std::min(strokes, int(strokes * fastest / peak));
      int best = 1, n = 1;
      for (; n <= end && lift_at(n) < s.target; ++n) {
        if (lift_at(n) > lift_at(best)) best = n;
      }
      found = n <= end;
      share = double(found ? n : best) / strokes;
      if (!found && share >= near && margin * lift_at(best) < s.target && in_range_of_coefficients(s.member)) {
        refuse(s.member, FrequencyOutcome::too_high, FlappingStatus::flapping, result.scalar);
        return false;
      }
    }
    const bool is_slower = found ? share < 1.0 : share < near;
    if (is_slower && ++s.returns < max_returns && in_range_of_coefficients(s.member)) {
      begin_again(s, share * s.next);
      return true;
    }
    if (in_range_of_coefficients(s.member) && goes_on_towards_peak(s)) return true;
    left_.push_back(s.member);
    return false;
  }

  /// After a trial that is so fast that the coefficients do not hold, whatever its lift: slower ones decide, at first
  /// one with the stroke of the largest lift by the shape of a sinusoidal one.
  bool goes_on_within_range(EnsembleSearch& s, double peak) {
    s.too_fast = std::min(s.too_fast, s.next);
    const bool enough = std::any_of(s.lifts.begin(), s.lifts.end(), [](const auto& trial) { return trial.gap >= 0.0; });
    if (!s.lifts.empty() && !enough && goes_on_towards_peak(s)) return true;
    if (!s.lifts.empty() || ++s.returns == max_returns) {
      left_.push_back(s.member);
      return false;
    }
    constexpr double slowest = 0.2, slower = 0.95;  // than the trial
    const BladeElement<double>& w = members_[s.member].vehicle.wings;
    const double fastest = std::min(detail::fastest_stroke(w), slower * peak);
    const auto lift_at = [&](int n) { return detail::sinusoidal_lift(w, fastest * n / strokes); };
    int best = strokes;
    for (int n = 1; n < strokes; ++n) {
      if (lift_at(n) > lift_at(best)) best = n;
    }
    begin_again(s, s.next * std::clamp(fastest / peak * best / strokes, slowest, slower));
    return true;
  }

  void refuse(std::size_t n, FrequencyOutcome why, FlappingStatus status, bool scalar) {
    reached_[n] = why;
    outcomes_[n] = {};
    outcomes_[n].status = status;
    outcomes_[n].scalar = scalar;
    outcomes_[n].metrics.values.fill(absent);
  }

  void reach(std::size_t n, const EnsembleOutcome& result) {
    reached_[n] = FrequencyOutcome::reached;
    outcomes_[n] = result;
    for (std::size_t m = 0; m < metric_count; ++m) {
      if (!options_.metrics[m]) outcomes_[n].metrics.values[m] = absent;
    }
  }

  bool search_singly(std::size_t n) {
    SteadyOptions steady;
    steady.tolerance = options_.tolerance;
    steady.reporting = members_[n].reporting;
    const FrequencySearch found = find_voltage(members_[n].vehicle, holds_[n], steady, start_up_);
    if (found.outcome != FrequencyOutcome::reached) refuse(n, found.outcome, found.status, true);
    else set_mean_voltage(members_[n].vehicle, found.voltage);
    return found.outcome == FrequencyOutcome::reached;
  }

  /// The metrics of members whose voltages are known.
  void finish() {
    trials_.clear();
    for (const std::size_t n : settled_) trials_.push_back(members_[n]);
    results_.resize(settled_.size());
    solve_ensemble(trials_, options_, start_up_, results_);
    for (std::size_t k = 0; k < settled_.size(); ++k) {
      if (drive_of(trials_[k].vehicle).voltage_sets_frequency || holds_lift_ || holds_power_) results_[k].scalar = true;
      reach(settled_[k], results_[k]);
    }
  }

  std::span<EnsembleMember> members_;
  std::span<const Hold> holds_;
  bool holds_lift_, holds_power_;  ///< else a frequency
  const EnsembleOptions& options_;
  const StartUp& start_up_;
  std::span<EnsembleOutcome> outcomes_;
  std::span<FrequencyOutcome> reached_;
  std::vector<EnsembleMember> trials_;
  std::vector<EnsembleOutcome> results_;
  std::vector<EnsembleSearch> searches_;
  std::vector<std::size_t> settled_;  ///< voltages known
  std::vector<std::size_t> left_;     ///< for the search of one
};

}  // namespace

void solve_ensemble_held(std::span<EnsembleMember> members, std::span<const Hold> holds, const EnsembleOptions& options,
                         const StartUp& start_up, std::span<EnsembleOutcome> outcomes,
                         std::span<FrequencyOutcome> reached) {
  for (std::size_t n = 0; n < members.size(); ++n) {
    const Hold& h = holds[n];
    require(h.held == holds[0].held || (is_lift(h.held) && is_lift(holds[0].held)), "hold",
            "must be a frequency of all, a lift of all or a power of all", "", h.value);
    if (!is_lift(h.held)) {
      const bool power = h.held == Held::power;
      require(h.value > 0.0 && std::isfinite(h.value), power ? "power" : "frequency", "must be > 0 and finite",
              power ? "W" : "Hz", h.value);
      continue;
    }
    const double lift = held_lift(h, members[n].reporting);
    require(lift > 0.0 && std::isfinite(lift), "lift", "must be > 0 and finite", "N", lift);
  }
  HeldEnsemble(members, holds, options, start_up, outcomes, reached).solve();
}

}  // namespace wingbeat

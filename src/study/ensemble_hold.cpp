#include "wingbeat/study/ensemble_hold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "study/voltage_trials.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

constexpr int max_rounds = 25;
/// Where so many trials do not flap, the search of one settles the member.
constexpr int max_still = 3;

/// What one trial gave, in logarithms: of the voltage, and of the value over the one sought.
struct Trial {
  double ln_voltage, gap;
};

/// The search for one member's voltage.
struct EnsembleSearch {
  std::size_t member = 0;
  double target = 0.0;          ///< [Hz or N]
  double usual_slope = 1.0;     ///< d ln(value) / d ln(voltage) before two trials have shown it
  double low = 0.0;             ///< voltage known to be too low, or 0
  double high = 0.0;            ///< voltage known to be high enough, or 0
  std::array<Trial, 3> last{};  ///< that flap with a value > 0, the newest first
  int trials = 0;               ///< in `last`
  double next = 0.0;            ///< voltage to be tried
  bool is_last = false;         ///< the next trial is expected to be the answer
  double limit = 0.0;           ///< no voltage above is tried here
  int still = 0;                ///< trials that did not flap
  int returns = 0;              ///< to lower voltages, from past the peak of the lift
  std::vector<Trial> too_low;   ///< all that flap with a value > 0 and less than sought, where a lift is
};

/// A crank that turns evenly, with its wings.
class EvenTurn {
 public:
  explicit EvenTurn(const Vehicle<double>& v) : vehicle_(v) {
    for (int n = 0; n < angles; ++n) {
      const double theta = two_pi * (n + 0.5) / angles;
      slope_[std::size_t(n)] = crank_kinematics(v.transmission, std::sin(theta), std::cos(theta)).stroke_slope;
    }
  }

  double steepest() const {
    double steepest = 0.0;
    for (const double x : slope_) steepest = std::max(steepest, std::abs(x));
    return steepest;
  }

  /// At that crank speed [rad/s].
  double lift(double omega) const {
    double sum = 0.0;
    for (const double x : slope_) sum += aero_loads(vehicle_.wings, std::abs(x * omega)).lift;
    return sum / angles;
  }
  double voltage(double omega) const {
    constexpr double losses_in_mechanism = 1.15;
    double power = 0.0;
    for (const double x : slope_) power += aero_loads(vehicle_.wings, std::abs(x * omega)).power / angles;
    const double torque = vehicle_.motor.friction_torque + losses_in_mechanism * power / omega;
    return detail::unloaded_voltage(vehicle_, omega, torque);
  }

 private:
  static constexpr int angles = 16;
  const Vehicle<double>& vehicle_;
  std::array<double, angles> slope_;
};

constexpr double slope_step = 1.05;  ///< of speeds whose voltages show a slope

EnsembleSearch search_frequency(const Vehicle<double>& v, std::size_t member, double frequency) {
  const double omega = two_pi * frequency;
  const EvenTurn turn(v);
  EnsembleSearch s;
  s.member = member;
  s.target = frequency;
  s.next = turn.voltage(omega);
  s.usual_slope = std::log(slope_step) / std::log(turn.voltage(slope_step * omega) / s.next);
  s.limit = frequency_search_span * detail::unloaded_voltage(v, omega, v.motor.friction_torque);
  return s;
}

EnsembleSearch search_power(const Vehicle<double>& v, std::size_t member, double power) {
  const EvenTurn turn(v);
  const double K = v.motor.torque_constant, R = circuit_resistance(v);
  const auto power_at = [&](double omega) {
    const double voltage = turn.voltage(omega);
    return voltage * (voltage - K * omega) / R;
  };
  double low = 1e-3 * std::sqrt(power * R) / K, high = low;
  while (power_at(high) < power && high < 1e12) high *= 2.0;
  for (int round = 0; round < 30; ++round) {
    const double middle = 0.5 * (low + high);
    (power_at(middle) < power ? low : high) = middle;
  }
  EnsembleSearch s;
  s.member = member;
  s.target = power;
  s.next = turn.voltage(high);
  const double faster = slope_step * high;
  s.usual_slope = std::log(power_at(faster) / power_at(high)) / std::log(turn.voltage(faster) / s.next);
  if (!(s.usual_slope > 1.0 && s.usual_slope < 4.0)) s.usual_slope = 2.5;
  s.limit = frequency_search_span * s.next;
  return s;
}

EnsembleSearch search_lift(const Vehicle<double>& v, std::size_t member, double lift) {
  const EvenTurn turn(v);
  double omega = std::sqrt(2.0 * lift / (v.wings.air_density * v.wings.s2)) / turn.steepest();
  for (int round = 0; round < 8; ++round) {
    const double mean = turn.lift(omega), ratio = mean > 0.0 ? std::pow(lift / mean, 0.6) : 1.3;
    omega *= std::clamp(ratio, 0.7, 1.3);
    if (std::abs(ratio - 1.0) < 0.01) break;
  }
  EnsembleSearch s;
  s.member = member;
  s.target = lift;
  s.next = turn.voltage(omega);
  const double growth = std::log(turn.lift(slope_step * omega) / turn.lift(omega));
  s.usual_slope = growth / std::log(turn.voltage(slope_step * omega) / s.next);
  if (!(s.usual_slope > 0.3 && s.usual_slope < 4.0)) s.usual_slope = 1.7;
  s.limit = frequency_search_span * s.next;
  return s;
}

/// The voltage [ln] at which a curve through the last trials has the value sought; in logarithms it is nearly straight.
double interpolated(const EnsembleSearch& s) {
  const auto& [a, b, c] = s.last;
  const double at_usual_slope = a.ln_voltage - a.gap / s.usual_slope;
  if (s.trials == 1) return at_usual_slope;
  const double inverse_slope = (a.ln_voltage - b.ln_voltage) / (a.gap - b.gap);
  if (!(inverse_slope > 0.1 && inverse_slope < 5.0)) return at_usual_slope;
  double x = a.ln_voltage - a.gap * inverse_slope;
  if (s.trials == 3) {
    const double bend = (inverse_slope - (b.ln_voltage - c.ln_voltage) / (b.gap - c.gap)) / (a.gap - c.gap);
    const double more = a.gap * b.gap * bend;
    if (std::abs(more) < 0.5 * std::abs(a.gap * inverse_slope)) x += more;
  }
  return x;
}

/// About by how much, relative, the value at an interpolated voltage misses the one sought.
double expected_miss(const EnsembleSearch& s) {
  const auto& [a, b, c] = s.last;
  if (s.trials < 2) return 1.0;
  return std::abs(a.gap * b.gap * (s.trials == 3 ? c.gap : 1.0));
}

/// Notes what the trial gave and chooses the next voltage.
void advance(EnsembleSearch& s, bool flaps, double value, int round, double closeness) {
  const double tried = s.next;
  if (!flaps) ++s.still;
  (flaps && value >= s.target ? s.high : s.low) = tried;
  const bool shows = flaps && value > 0.0;
  if (shows) {
    std::copy_backward(s.last.begin(), s.last.end() - 1, s.last.end());
    s.last[0] = {std::log(tried), std::log(value / s.target)};
    s.trials = std::min(s.trials + 1, 3);
  }
  const double guess = shows ? std::exp(interpolated(s)) : 0.0;
  s.is_last = shows && expected_miss(s) < closeness;
  if (s.high == 0.0) {
    s.next = shows ? std::clamp(guess, tried, 1.6 * tried) : 1.5 * tried;
  } else if (s.low == 0.0) {
    s.next = std::clamp(guess, 0.5 * tried, tried);
  } else {
    const bool inside = guess >= s.low && guess <= s.high;
    const bool halves = !inside || (round % 6 == 5 && !s.is_last);
    s.next = halves ? 0.5 * (s.low + s.high) : guess;
    s.is_last = s.is_last && !halves;
  }
}

/// Mean lift of a sinusoidal stroke of that peak velocity [rad/s].
double sinusoidal_lift(const BladeElement<double>& w, double peak) {
  constexpr int instants = 12;
  double sum = 0.0;
  for (int n = 0; n < instants; ++n) {
    sum += aero_loads(w, peak * std::sin(0.5 * pi * (n + 0.5) / instants)).lift;
  }
  return sum / instants;
}

constexpr int slower_strokes = 12;

/// Whether the lift is certainly larger than at any lower voltage, by a sinusoidal stroke of any smaller peak velocity.
bool lift_has_risen(const BladeElement<double>& w, double peak) {
  const double lift = sinusoidal_lift(w, peak);
  if (!(lift > 0.0)) return false;
  for (int n = 1; n < slower_strokes; ++n) {
    const double share = double(n) / slower_strokes;
    if (!(sinusoidal_lift(w, share * peak) < (1.0 - 0.25 * (1.0 - share)) * lift)) return false;
  }
  return true;
}

/// Whether a parabola through the three largest lifts, all of them too small, has its peak between them and too small
/// by more than the fit may miss.
bool peak_is_too_low(std::vector<Trial> lifts) {
  if (lifts.size() < 3) return false;
  std::partial_sort(lifts.begin(), lifts.begin() + 3, lifts.end(),
                    [](const Trial& x, const Trial& y) { return x.gap > y.gap; });
  std::sort(lifts.begin(), lifts.begin() + 3,
            [](const Trial& x, const Trial& y) { return x.ln_voltage < y.ln_voltage; });
  const Trial &a = lifts[0], &b = lifts[1], &c = lifts[2];
  const double left = (b.gap - a.gap) / (b.ln_voltage - a.ln_voltage);
  const double right = (c.gap - b.gap) / (c.ln_voltage - b.ln_voltage);
  const double bend = (right - left) / (c.ln_voltage - a.ln_voltage);
  if (!(bend < 0.0)) return false;
  const double ln_peak = 0.5 * (a.ln_voltage + b.ln_voltage) - 0.5 * left / bend;
  const double peak = a.gap + (ln_peak - a.ln_voltage) * (left + bend * (ln_peak - b.ln_voltage));
  const double highest = std::max({a.gap, b.gap, c.gap}), lowest = std::min({a.gap, b.gap, c.gap});
  const bool between = ln_peak > a.ln_voltage && ln_peak < c.ln_voltage;
  return between && peak + std::max(0.5 * (highest - lowest), 1e-4) < 0.0;
}

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
          searches_.push_back(search_lift(vehicle, n, held_lift(hold, members_[n].reporting)));
        } else {
          left_.push_back(n);
        }
      } else if (holds_power_) {
        const bool turns = drive_of(vehicle).voltage_sets_frequency && circuit_resistance(vehicle) > 0.0;
        if (turns) searches_.push_back(search_power(vehicle, n, hold.value));
        else left_.push_back(n);
      } else if (!drive_of(vehicle).voltage_sets_frequency) {
        vehicle.drive_frequency = hold.value;
        settled_.push_back(n);
      } else if (hold.value > highest_frequency(vehicle, SearchRange::extrapolation)) {
        refuse(n, FrequencyOutcome::outside_domain, FlappingStatus::flapping, false);
      } else {
        searches_.push_back(search_frequency(vehicle, n, hold.value));
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

  /// The slopes in the first trials need not be as exact as the values in the later ones, in which the search must not
  /// see the solver's own error: metrics follow the frequency with a slope of up to 3.
  EnsembleOptions trial_options(int round) const {
    EnsembleOptions options = options_;
    options.domain = false;
    options.metrics = assessed_metrics({});
    options.tolerance = std::max(0.05 * options_.tolerance, 1e-12);
    if (round < 2) options.tolerance = std::max(options.tolerance, std::min(options_.tolerance, 1e-5));
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
    const double miss = std::abs(value / s.target - 1.0), closeness = std::max(0.1 * options_.tolerance, 1e-13);
    const bool is_answer = flaps && s.is_last && miss <= 0.5 * options_.tolerance;
    if (holds_lift_ && is_answer && !lift_has_risen(v.wings, result.metrics[Metric::flapping_velocity_peak])) {
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
    if (holds_lift_ && flaps && value < s.target) {
      const double peak = result.metrics[Metric::flapping_velocity_peak];
      if (value > 0.0) s.too_low.push_back({std::log(s.next), std::log(value / s.target)});
      const bool falls = sinusoidal_lift(v.wings, peak) < sinusoidal_lift(v.wings, 0.95 * peak);
      if (falls || is_beyond_coefficients(v, result.metrics)) return goes_on_below(s, result);
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
    constexpr int max_returns = 8, steps = 40;
    constexpr double near = 0.93;    // from a trial at this share of its stroke velocity or closer,
    constexpr double margin = 1.02;  // the shape gives the largest lift to within this factor
    const BladeElement<double>& w = members_[s.member].vehicle.wings;
    const double peak = result.metrics[Metric::flapping_velocity_peak], lift = result.metrics[Metric::lift_mean];
    const double fastest = std::min(stroke_speed_at(w, 0.0), flow_speed_max * w.s2 / w.s3);
    const double shape = sinusoidal_lift(w, peak);
    double share = std::clamp(fastest / peak, 0.5, 0.9);
    bool found = false;
    if (lift > 0.0 && shape > 0.0) {
      const auto lift_at = [&](int n) { return lift / shape * sinusoidal_lift(w, peak * n / steps); };
      const int end = std::min(steps, int(steps * fastest / peak));
      int best = 1, n = 1;
      for (; n <= end && lift_at(n) < s.target; ++n) {
        if (lift_at(n) > lift_at(best)) best = n;
      }
      found = n <= end;
      share = double(found ? n : best) / steps;
      if (!found && share >= near && margin * lift_at(best) < s.target && in_range_of_coefficients(s.member)) {
        refuse(s.member, FrequencyOutcome::too_high, FlappingStatus::flapping, result.scalar);
        return false;
      }
    }
    if (in_range_of_coefficients(s.member) && s.returns > 1 && peak_is_too_low(s.too_low)) {
      refuse(s.member, FrequencyOutcome::too_high, FlappingStatus::flapping, result.scalar);
      return false;
    }
    const bool is_slower = found ? share < 1.0 : share < near;
    if (is_slower && ++s.returns < max_returns && in_range_of_coefficients(s.member)) {
      s.next *= share;
      s.low = s.high = 0.0;
      s.trials = 0;
      s.is_last = false;
      return true;
    }
    left_.push_back(s.member);
    return false;
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

#include "wingbeat/study/ensemble_frequency.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "study/voltage_trials.hpp"

namespace wingbeat {
namespace {

constexpr int max_rounds = 25;
/// Where so many trials do not flap, the search of one settles the member.
constexpr int max_still = 3;

/// The search for one member's voltage.
struct EnsembleSearch {
  std::size_t member = 0;
  double target = 0.0;             ///< [Hz]
  double low = 0.0;                ///< voltage known to be too low, or 0
  double high = 0.0;               ///< voltage known to be high enough, or 0
  double low_frequency = absent;   ///< at low; absent where it does not flap there
  double high_frequency = absent;  ///< at high
  double next = 0.0;               ///< voltage to be tried
  double limit = 0.0;              ///< no voltage above is tried here
  int still = 0;                   ///< trials that did not flap
};

EnsembleSearch begin(const Vehicle<double>& v, std::size_t member, double frequency) {
  const double unloaded = detail::unloaded_voltage(v, two_pi * frequency, v.motor.friction_torque);
  EnsembleSearch s;
  s.member = member;
  s.target = frequency;
  s.next = 1.3 * unloaded;  // between unloaded and the load of most efficient working
  s.limit = frequency_search_span * unloaded;
  return s;
}

/// Notes what the trial gave and chooses the next voltage. True when the voltage just tried is the answer.
bool advance(EnsembleSearch& s, bool flaps, double frequency, double closeness) {
  const double tried = s.next;
  if (!flaps) ++s.still;
  if (flaps && std::abs(frequency - s.target) <= closeness * s.target) return true;
  if (flaps && frequency >= s.target) {
    s.high = tried;
    s.high_frequency = frequency;
  } else {
    s.low = tried;
    s.low_frequency = flaps ? frequency : absent;
  }
  const bool secant = std::isfinite(s.low_frequency) && std::isfinite(s.high_frequency);
  if (secant) {
    // Inverse to frequency = a voltage^b through both ends, which is nearly straight; kept off the ends, so that
    // neither end stays for ever.
    const double b = std::log(s.high_frequency / s.low_frequency) / std::log(s.high / s.low);
    const double guess = s.low * std::pow(s.target / s.low_frequency, 1.0 / b);
    const double margin = 1e-9 * (s.high - s.low);
    s.next = guess > s.low + margin && guess < s.high - margin ? guess : 0.5 * (s.low + s.high);
  } else if (s.high == 0.0) {
    s.next = flaps ? tried * std::clamp(1.02 * s.target / frequency, 1.01, 1.5) : 1.5 * tried;
  } else if (s.low == 0.0) {
    s.next = tried * std::clamp(0.98 * s.target / frequency, 0.5, 0.99);
  } else {
    s.next = 0.5 * (s.low + s.high);
  }
  return false;
}

}  // namespace

void solve_ensemble_at_frequency(std::span<EnsembleMember> members, std::span<const double> frequencies,
                                 const EnsembleOptions& options, const StartUp& start_up,
                                 std::span<EnsembleOutcome> outcomes, std::span<FrequencyOutcome> reached) {
  for (const double f : frequencies) {
    require(f > 0.0 && std::isfinite(f), "frequency", "must be > 0 and finite", "Hz", f);
  }
  // The metrics follow the frequency with a slope of up to 3; the search must not see the solver's own error.
  EnsembleOptions trial_options = options;
  trial_options.domain = false;
  trial_options.metrics = MetricSet().set(std::size_t(Metric::frequency));
  trial_options.tolerance = std::max(0.05 * options.tolerance, 1e-12);
  const double closeness = std::max(0.1 * options.tolerance, 1e-13);

  const auto refuse = [&](std::size_t n, FrequencyOutcome why, FlappingStatus status) {
    reached[n] = why;
    outcomes[n] = {};
    outcomes[n].status = status;
    outcomes[n].scalar = true;
    outcomes[n].metrics.values.fill(absent);
  };
  std::vector<EnsembleSearch> searches;
  std::vector<std::size_t> settled, left;
  for (std::size_t n = 0; n < members.size(); ++n) {
    Vehicle<double>& vehicle = members[n].vehicle;
    if (!drive_of(vehicle).voltage_sets_frequency) {
      vehicle.drive_frequency = frequencies[n];
      settled.push_back(n);
    } else if (frequencies[n] > highest_frequency(vehicle, SearchRange::extrapolation)) {
      // As find_voltage_for_frequency refuses it.
      refuse(n, FrequencyOutcome::outside_domain, FlappingStatus::flapping);
      outcomes[n].scalar = false;
    } else {
      searches.push_back(begin(vehicle, n, frequencies[n]));
    }
  }
  std::vector<EnsembleMember> trials(members.size());
  std::vector<EnsembleOutcome> results(members.size());
  for (int round = 0; round < max_rounds && !searches.empty(); ++round) {
    const std::size_t active = searches.size();
    for (std::size_t k = 0; k < active; ++k) {
      trials[k] = members[searches[k].member];
      trials[k].vehicle.voltage = searches[k].next;
    }
    solve_ensemble({trials.data(), active}, trial_options, start_up, {results.data(), active});
    std::size_t kept = 0;
    for (std::size_t k = 0; k < active; ++k) {
      EnsembleSearch& s = searches[k];
      const double tried = s.next;
      const bool flaps = results[k].status == FlappingStatus::flapping;
      if (advance(s, flaps, results[k].metrics[Metric::frequency], closeness)) {
        members[s.member].vehicle.voltage = tried;
        settled.push_back(s.member);
      } else if (!(s.next <= s.limit) || s.still >= max_still) {
        left.push_back(s.member);
      } else {
        searches[kept++] = s;
      }
    }
    searches.resize(kept);
  }
  for (const EnsembleSearch& s : searches) left.push_back(s.member);

  std::vector<std::size_t> searched_singly;
  for (const std::size_t n : left) {
    SteadyOptions steady;
    steady.tolerance = options.tolerance;
    const FrequencySearch found = find_voltage_for_frequency(members[n].vehicle, frequencies[n], steady, start_up);
    if (found.outcome == FrequencyOutcome::reached) {
      members[n].vehicle.voltage = found.voltage;
      settled.push_back(n);
      searched_singly.push_back(n);
      continue;
    }
    refuse(n, found.outcome, found.status);
  }

  for (std::size_t k = 0; k < settled.size(); ++k) trials[k] = members[settled[k]];
  solve_ensemble({trials.data(), settled.size()}, options, start_up, {results.data(), settled.size()});
  for (std::size_t k = 0; k < settled.size(); ++k) {
    reached[settled[k]] = FrequencyOutcome::reached;
    outcomes[settled[k]] = results[k];
  }
  for (const std::size_t n : searched_singly) outcomes[n].scalar = true;
}

}  // namespace wingbeat

// What the benchmarks of the batched solver share: sets of metrics, errors, quantiles, times.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "wingbeat/ensemble/ensemble.hpp"

namespace wingbeat {

struct Wanted {
  const char* name;
  MetricSet metrics;
};

inline std::vector<Wanted> wanted_sets() {
  MetricSet no_multipliers = all_metrics();
  no_multipliers.reset(std::size_t(Metric::floquet_multiplier_max));
  MetricSet power_and_lift = no_multipliers;
  for (const Metric m :
       {Metric::current_peak, Metric::rod_force_peak, Metric::crank_speed_min, Metric::crank_speed_max}) {
    power_and_lift.reset(std::size_t(m));
  }
  MetricSet means = power_and_lift;
  for (const Metric m : {Metric::lift_peak, Metric::flapping_velocity_peak, Metric::angle_of_attack_min}) {
    means.reset(std::size_t(m));
  }
  return {{"means", means},
          {"power and lift", power_and_lift},
          {"all but multipliers", no_multipliers},
          {"all", all_metrics()}};
}

inline double quantile(std::vector<double> values, double q) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[std::size_t(q * double(values.size() - 1))];
}

/// Errors of the designs that flap by both solvers, Floquet multipliers aside, on the scale of error_scale().
struct Errors {
  std::vector<double> lift, worst;
  int other = 0;  ///< statuses that differ
};

/// `expected` holds every `every`-th design of `outcomes`.
inline Errors errors_of(const std::vector<EnsembleOutcome>& outcomes, const std::vector<EnsembleOutcome>& expected,
                        std::size_t every, const MetricSet& metrics) {
  Errors errors;
  for (std::size_t n = 0; n < expected.size(); ++n) {
    const EnsembleOutcome& got = outcomes[n * every];
    errors.other += got.status != expected[n].status;
    if (got.status != FlappingStatus::flapping || expected[n].status != FlappingStatus::flapping) continue;
    const Metrics<double>& exact = expected[n].metrics;
    const auto off = [&](Metric m) { return std::abs(got.metrics[m] - exact[m]); };
    errors.lift.push_back(off(Metric::lift_mean) / error_scale(exact, Metric::lift_mean));
    double largest = 0.0;
    for (int k = 0; k < metric_count; ++k) {
      const Metric m = Metric(k);
      if (!metrics[std::size_t(k)] || m == Metric::floquet_multiplier_max) continue;
      if (off(m) > largest * error_scale(exact, m)) largest = off(m) / error_scale(exact, m);
    }
    errors.worst.push_back(largest);
  }
  return errors;
}

template <class F>
double best_time(const F& f, double seconds) {
  using clock = std::chrono::steady_clock;
  const auto end = clock::now() + std::chrono::duration<double>(seconds);
  double best = INFINITY;
  do {
    const auto start = clock::now();
    f();
    best = std::min(best, std::chrono::duration<double>(clock::now() - start).count());
  } while (clock::now() < end);
  return best;
}

}  // namespace wingbeat

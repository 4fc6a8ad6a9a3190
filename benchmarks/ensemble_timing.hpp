// What the benchmarks of the batched solver share: sets of metrics, quantiles, times.
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

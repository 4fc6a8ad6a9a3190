// The orbit search against the simulation from rest.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {

/// Largest deviation of a metric, over its error_scale().
inline double worst_metric(const Metrics<double>& a, const Metrics<double>& b, std::string& where) {
  double worst = 0.0;
  for (int m = 0; m < metric_count; ++m) {
    const Metric which = Metric(m);
    if (which == Metric::floquet_multiplier_max || which == Metric::lift_to_weight) continue;
    EXPECT_EQ(std::isnan(a[which]), std::isnan(b[which])) << metric_info(which).key;
    const double off = std::abs(a[which] - b[which]) / error_scale(b, which);
    if (off > worst) worst = off, where = metric_info(which).key;
  }
  return worst;
}

/// What a comparison saw.
struct Compared {
  bool flaps = false;
  bool meets_stop = false;  ///< wings on hinges, in the last period of the simulation
};

/// The same status; where the vehicle flaps, all metrics to 1e-6 and an energy balance to 1e-7.
inline Compared expect_orbit_as_simulated(const Design<double>& design, int n) {
  validate(design);
  const Vehicle<double> vehicle = resolve(design);
  const SteadyFlapping orbit = find_steady_flapping(vehicle, {.tolerance = 1e-8}, start_up_in_time());
  TransientOptions options;
  options.tolerance = 1e-7;
  const TransientResult transient = simulate_start_up(vehicle, options);
  EXPECT_EQ(orbit.status, transient.status)
      << "vehicle " << n << ": " << describe(orbit.evidence) << " / " << describe(transient.evidence);
  Compared seen;
  seen.flaps = orbit.status == FlappingStatus::flapping;
  if (!seen.flaps) return seen;
  const double period = 1.0 / orbit.metrics[Metric::frequency];
  for (const TransientEvent& e : transient.events) {
    const bool last = e.time > transient.end_time - period;
    seen.meets_stop = seen.meets_stop || (last && e.kind == TransientEvent::Kind::stop_impact);
  }
  EXPECT_TRUE(transient.metrics) << "vehicle " << n;
  if (!transient.metrics) return seen;
  std::string where;
  EXPECT_LT(worst_metric(orbit.metrics, *transient.metrics, where), 1e-6) << "vehicle " << n << ", " << where;
  EXPECT_LT(std::abs(energy_audit(orbit.metrics).imbalance), 1e-7 * orbit.metrics[Metric::power_electrical]) << n;
  return seen;
}

}  // namespace wingbeat

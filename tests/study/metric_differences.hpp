// Derivatives of an orbit's metrics against central differences of fourth order.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/files/design_parameter.hpp"

namespace wingbeat {

inline SteadyFlapping accurate_orbit(const Design<double>& design) {
  return find_steady_flapping(resolve(design),
                              {.tolerance = 1e-12, .stability = false, .reporting = reporting_of(design)});
}

/// Calls `assess(key, metric, metrics, exact, difference)` of every parameter and metric that the orbit has: what a
/// change by all of the parameter would do to the metric, by its derivative and by differences.
template <class Assess>
void compare_with_differences(const Design<double>& design, const std::vector<DesignParameter>& parameters,
                              const Assess& assess) {
  const SteadyFlapping orbit = accurate_orbit(design);
  ASSERT_EQ(orbit.status, FlappingStatus::flapping) << describe(orbit.evidence);
  const MetricGradients gradients = metric_gradients(design, Condition::air, orbit, parameters);
  ASSERT_TRUE(gradients.regular);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    constexpr double h = 1e-4;
    const double value = *parameters[p].value(design);
    const auto metrics_at = [&](double steps) {
      Design<double> moved = design;
      parameters[p].set(moved, value + steps * h * value);
      return accurate_orbit(moved).metrics;
    };
    const Metrics<double> a = metrics_at(-2.0), b = metrics_at(-1.0), c = metrics_at(1.0), d = metrics_at(2.0);
    for (int m = 0; m < metric_count; ++m) {
      const Metric which = Metric(m);
      if (which == Metric::floquet_multiplier_max || std::isnan(orbit.metrics[which])) continue;
      const double difference = (8.0 * (c[which] - b[which]) - (d[which] - a[which])) / (12.0 * h);
      assess(parameters[p].key, which, orbit.metrics, gradients.by_parameter[p][std::size_t(m)] * value, difference);
    }
  }
}

}  // namespace wingbeat

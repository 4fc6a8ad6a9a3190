// How far metrics of two solutions are apart.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "wingbeat/cycle/metrics.hpp"

namespace wingbeat {

/// Largest deviation of a metric beside `size(metric)`; without the Floquet multiplier.
template <class Size>
double metrics_apart(const Metrics<double>& a, const Metrics<double>& b, std::string& where, const Size& size) {
  double worst = 0.0;
  for (int n = 0; n < metric_count; ++n) {
    const Metric m = Metric(n);
    if (m == Metric::floquet_multiplier_max) continue;
    const double off = std::abs(a[m] - b[m]);
    if (off > worst * size(m)) worst = off / size(m), where = metric_info(m).key;
  }
  return worst;
}

/// Beside error_scale(); a crank may all but stop on its way, a gearbox all but idle.
inline double metrics_apart(const Metrics<double>& a, const Metrics<double>& b, std::string& where) {
  return metrics_apart(a, b, where, [&](Metric m) {
    if (m == Metric::crank_speed_min) return b[Metric::crank_speed_max];
    if (m == Metric::power_gear) return b[Metric::power_electrical];
    return error_scale(b, m);
  });
}

/// Beside error_scale(), and both have the same metrics.
inline double worst_metric(const Metrics<double>& a, const Metrics<double>& b, std::string& where) {
  for (int n = 0; n < metric_count; ++n) {
    const Metric m = Metric(n);
    if (m == Metric::floquet_multiplier_max || m == Metric::lift_to_weight) continue;
    EXPECT_EQ(std::isnan(a[m]), std::isnan(b[m])) << metric_info(m).key;
  }
  return metrics_apart(a, b, where,
                       [&](Metric m) { return m == Metric::lift_to_weight ? HUGE_VAL : error_scale(b, m); });
}

}  // namespace wingbeat

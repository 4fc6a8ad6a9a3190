#pragma once

#include <cmath>
#include <string>

#include "wingbeat/cycle/metrics.hpp"

namespace wingbeat {

/// Largest deviation of metrics beside their error_scale().
inline double metrics_apart(const Metrics<double>& a, const Metrics<double>& b, std::string& where) {
  double worst = 0.0;
  for (int n = 0; n < metric_count; ++n) {
    const Metric m = Metric(n);
    if (m == Metric::floquet_multiplier_max) continue;
    // A crank may all but stop on its way, a gearbox all but idle.
    double size = error_scale(b, m);
    if (m == Metric::crank_speed_min) size = b[Metric::crank_speed_max];
    if (m == Metric::power_gear) size = b[Metric::power_electrical];
    const double off = std::abs(a[m] - b[m]);
    if (off > worst * size) worst = off / size, where = metric_info(m).key;
  }
  return worst;
}

}  // namespace wingbeat

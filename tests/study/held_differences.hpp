// Derivatives of what a hold finds against central differences of designs that it finds for themselves.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {

/// `allowed` is over what the metric is to the parameter's value. A charge of 1 has differences of one side, of first
/// order.
inline DesignPoint expect_held_derivatives(const Design<double>& design, const DesignPointOptions& options,
                                           const std::vector<const char*>& keys, const std::vector<Metric>& metrics,
                                           double allowed, double step = 1e-4) {
  std::vector<DesignParameter> parameters;
  for (const char* key : keys) parameters.push_back(design_parameter(key));
  DesignPoint point = design_point(design, options, parameters, start_up_in_time());
  EXPECT_EQ(point.status, SweepStatus::flapping) << describe(point);
  if (point.status != SweepStatus::flapping) return point;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double x = parameters[k].value(design).value_or(0.0), h = step * x;
    if (h == 0.0) continue;
    const auto there = [&](double value) {
      Design<double> moved = design;
      parameters[k].set(moved, value);
      return design_point(moved, options, {}, start_up_in_time()).metrics;
    };
    const bool one_side = parameters[k].key == "supply.charge" && x == 1.0;
    const Metrics<double> a = there(x - h), b = one_side ? point.metrics : there(x + h);
    for (const Metric m : metrics) {
      const double expected = (b[m] - a[m]) / (one_side ? h : 2.0 * h), scale = std::abs(point.metrics[m] / x);
      EXPECT_NEAR(point.gradients[k][std::size_t(m)], expected,
                  (one_side ? std::max(allowed, 2.0 * step) : allowed) * scale)
          << parameters[k].key << " " << metric_info(m).key;
    }
  }
  return point;
}

}  // namespace wingbeat

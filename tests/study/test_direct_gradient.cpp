// Derivatives through the orbit of a direct drive against central differences, over jumps of dry friction too.
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

SteadyFlapping orbit_of(const Design<double>& design) {
  return find_steady_flapping(resolve(design),
                              {.tolerance = 1e-12, .stability = false, .reporting = reporting_of(design)});
}

void expect_gradients(const Design<double>& design, double tolerance) {
  std::vector<DesignParameter> parameters;
  for (const auto& key : parameter_table<double>()) {
    if (!key.set || key.path == "wing.count") continue;
    const auto value = key.get(design);
    if (value && *value != 0.0) parameters.push_back(design_parameter(key.path));
  }
  ASSERT_GT(parameters.size(), 12u);
  const SteadyFlapping orbit = orbit_of(design);
  ASSERT_EQ(orbit.status, FlappingStatus::flapping) << describe(orbit.evidence);
  const MetricGradients gradients = metric_gradients(design, Condition::air, orbit, parameters);
  ASSERT_TRUE(gradients.regular);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const double value = *parameters[p].value(design), h = 1e-4 * value;
    const auto at = [&](double by) {
      Design<double> moved = design;
      parameters[p].set(moved, value + by);
      return orbit_of(moved).metrics;
    };
    const Metrics<double> a = at(-2.0 * h), b = at(-h), c = at(h), d = at(2.0 * h);
    for (int m = 0; m < metric_count; ++m) {
      const Metric which = Metric(m);
      if (which == Metric::floquet_multiplier_max || which == Metric::current_mean || which == Metric::power_residual) {
        continue;
      }
      if (std::isnan(orbit.metrics[which])) continue;
      const double difference = (8.0 * (c[which] - b[which]) - (d[which] - a[which])) / 12.0;
      const double exact = gradients.by_parameter[p][std::size_t(m)] * h;
      // Per one: what a change by all of the parameter would do to the metric, beside the metric.
      EXPECT_NEAR(exact, difference, 1e-4 * tolerance * std::abs(orbit.metrics[which]))
          << parameters[p].key << ", " << metric_table()[std::size_t(m)].key;
    }
  }
}

// A vehicle takes a minute under sanitizers, which look for other mistakes than differences do.
#if defined(__SANITIZE_ADDRESS__)
constexpr int vehicles = 1;
#else
constexpr int vehicles = 4;
#endif

TEST(DirectGradient, AgreesWithDifferences) {
  std::mt19937_64 random(21);
  for (int n = 0; n < vehicles; ++n) {
    Design<double> d = random_direct_design(random, false);
    if (n == 0) d.motor.constants.armature_inductance = 0.0;
    expect_gradients(d, 1e-6);
  }
}

TEST(DirectGradient, FlowsThroughTiesOfFrequencySpringAndInertia) {
  std::mt19937_64 random(22);
  Design<double> d = random_direct_design(random, false);
  d.spring = {};
  d.spring.resonance_ratio = 1.1;
  expect_gradients(d, 1e-6);
  d.spring = {};
  d.spring.stiffness = 2e-3;
  d.supply_resonance_ratio = 0.95;
  expect_gradients(d, 1e-6);
  d.wing.resonance = 0.6 * std::sqrt(2e-3 / (0.5 * d.motor.constants.inertia)) / two_pi;
  expect_gradients(d, 1e-6);
}

TEST(DirectGradient, CrossesTheJumpsOfConstantFriction) {
  std::mt19937_64 random(23);
  for (int n = 0; n < vehicles; ++n) expect_gradients(random_direct_design(random, true), 1e-5);
}

}  // namespace
}  // namespace wingbeat

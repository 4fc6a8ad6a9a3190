// Derivatives through the orbit of a direct drive against central differences, over jumps of dry friction too.
#include <gtest/gtest.h>

#include <cmath>

#include "study/metric_differences.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

void expect_gradients(const Design<double>& design, double tolerance) {
  std::vector<DesignParameter> parameters;
  for (const auto& key : parameter_table<double>()) {
    if (!key.set || key.path == "wing.count") continue;
    const auto value = key.get(design);
    if (value && *value != 0.0) parameters.push_back(design_parameter(key.path));
  }
  ASSERT_GT(parameters.size(), 12u);
  compare_with_differences(
      design, parameters,
      [&](const auto& key, Metric m, const Metrics<double>& metrics, double exact, double difference) {
        if (m == Metric::current_mean || m == Metric::power_residual) return;
        EXPECT_NEAR(exact, difference, tolerance * std::abs(metrics[m])) << key << ", " << metric_info(m).key;
      });
}

// A vehicle takes a minute under sanitizers, which look for other mistakes than differences do.
#ifdef WINGBEAT_SANITIZED
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

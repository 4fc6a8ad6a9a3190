#include "wingbeat/cycle/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/wide_design.hpp"

namespace wingbeat {
namespace {

Metrics<double> some_metrics() {
  Metrics<double> m;
  for (int k = 0; k < metric_count; ++k) m[Metric(k)] = 1.0 + k;
  return m;
}

TEST(ErrorScale, IsTheMetricUnlessItMayVanish) {
  Metrics<double> m = some_metrics();
  m[Metric::frequency] = -20.0;
  EXPECT_EQ(error_scale(m, Metric::frequency), 20.0);
  EXPECT_EQ(error_scale(m, Metric::power_electrical), m[Metric::power_electrical]);
  m[Metric::efficiency_motor] = absent;
  EXPECT_TRUE(std::isnan(error_scale(m, Metric::efficiency_motor)));

  m[Metric::angle_of_attack_min] = -1e-3;
  EXPECT_EQ(error_scale(m, Metric::angle_of_attack_min), 90.0);
  m[Metric::angle_of_attack_min] = -200.0;
  EXPECT_EQ(error_scale(m, Metric::angle_of_attack_min), 200.0);

  m[Metric::power_residual] = 0.0;
  m[Metric::power_electrical] = -0.5;
  EXPECT_EQ(error_scale(m, Metric::power_residual), 0.5);

  m[Metric::crank_speed_max] = 50.0;
  m[Metric::crank_speed_min] = 0.0;
  EXPECT_EQ(error_scale(m, Metric::crank_speed_min), 0.5);
  m[Metric::crank_speed_min] = 20.0;
  EXPECT_EQ(error_scale(m, Metric::crank_speed_min), 20.0);

  m[Metric::lift_mean] = 1e-9;
  m[Metric::lift_peak] = 0.04;
  m[Metric::lift_to_weight] = 2e-9;
  EXPECT_DOUBLE_EQ(error_scale(m, Metric::lift_mean), 4e-5);
  EXPECT_DOUBLE_EQ(error_scale(m, Metric::lift_to_weight), 8e-5);
}

TEST(ErrorScale, OfAMeanCurrentDependsOnTheDrive) {
  Metrics<double> m = some_metrics();
  m[Metric::current_mean] = 1e-12;
  m[Metric::current_peak] = 0.3;
  EXPECT_EQ(error_scale(m, Metric::current_mean), 1e-12);  // a crank's, which is direct current
  m[Metric::rod_force_mean] = absent;
  EXPECT_EQ(error_scale(m, Metric::current_mean), 0.3);
}

// What the tests of accuracy compare by.
TEST(MetricsApart, NamesTheWorstAndSeesWhatIsAbsentFromOne) {
  const Metrics<double> exact = some_metrics();
  Metrics<double> m = exact;
  int where = -1;
  EXPECT_EQ(metrics_apart(m, exact, &where), 0.0);
  m[Metric::lift_peak] *= 1.0 + 1e-6;
  m[Metric::frequency] *= 1.0 - 3e-6;
  m[Metric::floquet_multiplier_max] = 0.0;
  EXPECT_NEAR(metrics_apart(m, exact, &where), 3e-6, 1e-15);
  EXPECT_EQ(Metric(where), Metric::frequency);
  m[Metric::power_electrical] = absent;
  EXPECT_EQ(metrics_apart(m, exact, &where), HUGE_VAL);
  EXPECT_EQ(Metric(where), Metric::power_electrical);
}

}  // namespace
}  // namespace wingbeat

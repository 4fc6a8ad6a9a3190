// C_alpha from the angle of attack at mid-stroke.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

constexpr double degree = 1.0 / degrees_per_radian;

TEST(PitchSearch, TheRunHasTheAngleAskedFor) {
  int searched = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(WINGBEAT_DATA) / "designs")) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().filename().string());
    Design<double> d = read_design(entry.path());
    const bool sine_crank = d.supply.type == SupplyType::sine && d.transmission.type != TransmissionType::direct;
    if (!follows_pitch_law(d) || d.aerodynamics.angle_of_attack_min || sine_crank) {
      if (!sine_crank) {
        EXPECT_THROW(run_design(d, {.angle_of_attack = 45.0 * degree}), ParameterError);
      }
      continue;
    }
    if (run_design(d).status != FlappingStatus::flapping) continue;
    for (const double angle : {70.0, 45.0, 20.0}) {
      const RunResult r = run_design(d, {.tolerance = 1e-8, .angle_of_attack = angle * degree});
      ASSERT_EQ(r.status, FlappingStatus::flapping) << describe(r);
      ASSERT_TRUE(r.pitch_coefficient.has_value());
      EXPECT_EQ(*r.pitch_coefficient, r.design.aerodynamics.pitch_coefficient);
      // The law itself at the peak of a run with that C_alpha.
      Design<double> there = d;
      there.aerodynamics.pitch_coefficient = *r.pitch_coefficient;
      const RunResult again = run_design(there, {.tolerance = 1e-9});
      const double at_peak = 90.0 - *r.pitch_coefficient * again.metrics[Metric::flapping_velocity_peak] / degree;
      EXPECT_NEAR(at_peak, angle, 2e-6);
      EXPECT_NEAR(r.metrics[Metric::angle_of_attack_min], angle, 2e-6);
      ++searched;
      // From wherever the search begins.
      d.aerodynamics.pitch_coefficient *= 0.3;
      const RunResult other = run_design(d, {.tolerance = 1e-8, .angle_of_attack = angle * degree});
      EXPECT_NEAR(*other.pitch_coefficient / *r.pitch_coefficient, 1.0, 1e-7);
    }
  }
  EXPECT_GT(searched, 15);
}

TEST(PitchSearch, BesideALiftOrAFrequency) {
  const Design<double> d = reference_design();
  const RunResult by_lift =
      run_design(d, {.tolerance = 1e-8, .lift = 0.01, .angle_of_attack = 40.0 * degree, .waveform_rows = 11});
  ASSERT_EQ(by_lift.status, FlappingStatus::flapping) << describe(by_lift);
  EXPECT_NEAR(by_lift.metrics[Metric::lift_mean] / 0.01, 1.0, 1e-6);
  EXPECT_NEAR(by_lift.metrics[Metric::angle_of_attack_min], 40.0, 1e-5);
  EXPECT_EQ(by_lift.cycle.size(), 11U);
  const RunResult by_frequency =
      run_design(d, {.tolerance = 1e-8, .frequency = 25.0, .angle_of_attack = 40.0 * degree});
  EXPECT_NEAR(by_frequency.metrics[Metric::frequency], 25.0, 1e-6);
  EXPECT_NEAR(by_frequency.metrics[Metric::angle_of_attack_min], 40.0, 1e-5);
  const RunResult in_time = run_design(d, {.method = Method::transient, .angle_of_attack = 40.0 * degree});
  EXPECT_NEAR(in_time.metrics[Metric::angle_of_attack_min], 40.0, 1e-3);
}

// On the way a trial's wings turn over before the power is reached: its C_alpha is too large, and the search goes on.
TEST(PitchSearch, GoesBackFromTrialsThatLeaveTheCoefficientsRange) {
  Design<double> d = reference_design();
  d.aerodynamics.pitch_coefficient = 5e-3;
  const RunResult known = run_design(d, {.tolerance = 1e-8, .angle_of_attack = 15.0 * degree});
  const double power = known.metrics[Metric::power_electrical];
  for (const double start : {1e-3, 5e-3, 20e-3}) {
    d.aerodynamics.pitch_coefficient = start;
    const RunResult r = run_design(d, {.tolerance = 1e-8, .power = power, .angle_of_attack = 15.0 * degree});
    ASSERT_TRUE(r.pitch_coefficient.has_value()) << start << ": " << describe(r);
    EXPECT_NEAR(*r.pitch_coefficient / *known.pitch_coefficient, 1.0, 1e-6) << start;
  }
}

TEST(PitchSearch, WhatCannotBeIsSaid) {
  Design<double> d = reference_design();
  const RunResult much = run_design(d, {.lift = 5.0, .angle_of_attack = 45.0 * degree});
  ASSERT_TRUE(much.search.has_value());
  EXPECT_NE(much.search->outcome, FrequencyOutcome::reached);
  EXPECT_FALSE(much.pitch_coefficient.has_value());
  d.supply.voltage = 0.0;
  EXPECT_EQ(run_design(d, {.angle_of_attack = 45.0 * degree}).status, FlappingStatus::stalled);
  d = reference_design();
  for (const double angle : {0.0, 90.0, -10.0}) {
    EXPECT_THROW(run_design(d, {.angle_of_attack = angle * degree}), ParameterError);
  }
  EXPECT_THROW(run_design(d, {.condition = Condition::vacuum, .angle_of_attack = 0.8}), ParameterError);
  d.aerodynamics.angle_of_attack_min = 0.5;
  EXPECT_THROW(run_design(d, {.angle_of_attack = 0.8}), ParameterError);
}

}  // namespace
}  // namespace wingbeat

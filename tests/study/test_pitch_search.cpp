// C_alpha from the angle of attack at mid-stroke.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "study/held_differences.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/sweep.hpp"
#include "wingbeat/vehicle/parameters.hpp"

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

Design<double> at_angle(double angle) {
  Design<double> d = reference_design();
  d.wing.planform = {PlanformShape::semi_ellipse, 63e-3, 25e-3};
  d.aerodynamics.pitch_coefficient = 0.0;
  d.aerodynamics.angle_of_attack = angle * degree;
  return d;
}

TEST(PitchSearch, ADesignThatStatesTheAngleRunsAsWithTheOption) {
  for (const RunOptions& options : {RunOptions{}, RunOptions{.frequency = 20.0}, RunOptions{.lift = 0.01}}) {
    const Design<double> d = at_angle(45.0);
    Design<double> plain = d;
    plain.aerodynamics.angle_of_attack.reset();
    RunOptions asked = options;
    asked.angle_of_attack = 45.0 * degree;
    const RunResult by_key = run_design(d, options), by_option = run_design(plain, asked);
    ASSERT_EQ(by_key.status, FlappingStatus::flapping) << describe(by_key);
    EXPECT_EQ(by_key.pitch_coefficient, by_option.pitch_coefficient);
    EXPECT_FALSE(by_key.design.aerodynamics.angle_of_attack);
    EXPECT_EQ(by_key.metrics[Metric::power_electrical], by_option.metrics[Metric::power_electrical]);
    // An option goes before the key.
    asked.angle_of_attack = 30.0 * degree;
    EXPECT_NEAR(run_design(d, asked).metrics[Metric::angle_of_attack_min], 30.0, 1e-5);
  }
  // Without air the angle has no effect.
  EXPECT_EQ(run_design(at_angle(45.0), {.condition = Condition::vacuum}).status, FlappingStatus::flapping);
  EXPECT_FALSE(run_design(at_angle(45.0), {.condition = Condition::vacuum}).pitch_coefficient);
}

TEST(PitchSearch, WhatDoesNotFindCAlphaRefusesTheDesign) {
  const Design<double> d = at_angle(45.0);
  EXPECT_NO_THROW(validate(d));
  try {
    resolve(d);
    FAIL() << "resolved";
  } catch (const ParameterError& error) {
    EXPECT_STREQ(error.what(),
                 "aerodynamics.angle_of_attack: stands for a C_alpha that this does not find; give "
                 "aerodynamics.pitch_coefficient instead, which wingbeat run prints for the vehicle");
  }
  EXPECT_NO_THROW(resolve(d, Condition::vacuum));
  Design<double> stopped = d;
  stopped.aerodynamics.angle_of_attack_min = 0.5;
  EXPECT_THROW(validate(stopped), ParameterError);
}

/// Each design of a sweep against a run of its own.
void expect_sweep_as_runs(Sweep& sweep, int flapping) {
  const std::uint64_t count = sweep.size();
  SweepColumns columns;
  columns.resize(count, metric_count);
  sweep.options.metrics.set();
  sweep.options.metrics.reset(std::size_t(Metric::hover)).reset(std::size_t(Metric::endurance));
  columns.resize(count, sweep.options.metrics.count());
  SweepSolver(sweep, start_up_in_time()).solve(columns, 0, count);
  int flaps = 0, batched = 0;
  for (std::uint64_t n = 0; n < count; ++n) {
    const SweepDesign one = design_at(sweep, n);
    DesignPointOptions options;
    options.condition = one.condition;
    options.hold = one.hold;
    const DesignPoint point = design_point(one.design, options, {}, start_up_in_time());
    ASSERT_EQ(columns.status[n], std::int8_t(point.status)) << n << ": " << describe(point);
    if (point.status != SweepStatus::flapping) continue;
    ++flaps;
    batched += !columns.recomputed[n];
    std::size_t column = 0;
    for (int m = 0; m < metric_count; ++m) {
      if (!sweep.options.metrics[std::size_t(m)]) continue;
      const double value = columns.metrics[column++][n], expected = point.metrics.values[std::size_t(m)];
      if (m == int(Metric::floquet_multiplier_max)) continue;
      if (m == int(Metric::angle_of_attack_min)) {
        EXPECT_NEAR(value, *one.design.aerodynamics.angle_of_attack / degree, 1e-4);
      }
      if (std::isnan(expected)) continue;
      EXPECT_NEAR(value, expected, 5e-6 * std::abs(expected) + 1e-9 * point.metrics[Metric::power_electrical])
          << n << " " << metric_info(Metric(m)).key;
    }
  }
  EXPECT_GE(flaps, flapping);
  EXPECT_GT(batched, has_packs ? flaps / 2 : -1);
}

SweptQuantity swept(const char* key, std::vector<double> values) {
  SweptQuantity q;
  q.key = q.name = key;
  q.set = numeric_parameter<double>(key).set;
  q.values = std::move(values);
  return q;
}

Sweep sweep_at_angles() {
  Sweep sweep;
  sweep.variants.push_back({at_angle(45.0), Condition::air, true});
  SweepAxis angles, lengths;
  angles.quantities.push_back(swept("aerodynamics.angle_of_attack", {25.0 * degree, 45.0 * degree, 60.0 * degree}));
  angles.count = 3;
  lengths.quantities.push_back(swept("wing.planform.length", {40e-3, 50e-3, 60e-3, 70e-3, 80e-3}));
  lengths.count = 5;
  sweep.axes = {angles, lengths};
  sweep.variant_stride = {0, 0};
  return sweep;
}

TEST(PitchSearch, EachDesignOfASweepFindsItsOwn) {
  Sweep at_voltage = sweep_at_angles();
  expect_sweep_as_runs(at_voltage, 12);
  Sweep at_lift = sweep_at_angles();
  at_lift.hold = Hold{Held::lift, 0.008};
  expect_sweep_as_runs(at_lift, 10);
  // What does not flap has no angle.
  Sweep stalled = sweep_at_angles();
  stalled.variants[0].design.friction = {FrictionLaw::constant, 1.0};
  SweepColumns columns;
  columns.resize(15, 0);
  stalled.options.metrics = {};
  SweepSolver(stalled, start_up_in_time()).solve(columns, 0, 15);
  for (const std::int8_t status : columns.status) EXPECT_NE(status, std::int8_t(SweepStatus::flapping));
}

TEST(PitchSearch, DerivativesHoldTheAngle) {
  const std::vector<const char*> keys{"aerodynamics.angle_of_attack", "wing.planform.length", "supply.voltage"};
  const std::vector<Metric> metrics{Metric::frequency, Metric::power_electrical, Metric::lift_mean};
  DesignPointOptions options;
  options.tolerance = 1e-10;
  const DesignPoint point = expect_held_derivatives(at_angle(45.0), options, keys, metrics, 1e-5);
  ASSERT_EQ(point.status, SweepStatus::flapping);
  EXPECT_GT(point.pitch_coefficient, 0.0);
  options.hold = Hold{Held::lift, 0.01};
  expect_held_derivatives(at_angle(45.0), options, {"aerodynamics.angle_of_attack", "wing.planform.length"},
                          {Metric::power_electrical, Metric::voltage}, 1e-5);
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

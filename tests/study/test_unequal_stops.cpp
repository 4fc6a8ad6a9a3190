// Stops of the pitch that differ to either side, and springs that rest away from stroke angle zero.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "study/metric_differences.hpp"
#include "vehicle/hinged_design.hpp"
#include "vehicle/orbit_and_simulation.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/cycle/cycle_instants.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

void set_unequal_stops(Design<double>& d, std::mt19937_64& random) {
  std::uniform_real_distribution<double> stop(0.05, 0.5);
  d.pitch.stop.reset();
  d.pitch.stop_low = -stop(random);
  d.pitch.stop_high = stop(random);
}

TEST(UnequalStops, OrbitAgreesWithTheSimulationOfRandomVehicles) {
  std::mt19937_64 random(51);
  int flapping = 0, stopped = 0;
  for (int n = 0; n < 40; ++n) {
    Design<double> d = n % 4 == 3 ? random_hinged_crank(std::uint32_t(n), 52) : random_hinged_design(random, true);
    set_unequal_stops(d, random);
    if (n % 4 == 1) d.spring.rest_angle = 0.2;
    const Compared seen = expect_orbit_as_simulated(d, n);
    flapping += seen.flaps;
    stopped += seen.meets_stop;
  }
  EXPECT_GT(flapping, 33);
  EXPECT_GT(stopped, 15);
}

// Both stops are met, each at its own angle.
TEST(UnequalStops, BoundThePitchToEitherSide) {
  Design<double> d = hinged_design(2e-4);
  d.pitch.stop_low = -0.3;
  d.pitch.stop_high = 0.45;
  const SteadyFlapping orbit = accurate_orbit(d);
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  double low = 0.0, high = 0.0;
  for (const auto& [row, share, phase] : cycle_instants(orbit.record)) {
    low = std::min(low, row.pitch_angle);
    high = std::max(high, row.pitch_angle);
  }
  EXPECT_NEAR(low, -0.3, 1e-9);
  EXPECT_NEAR(high, 0.45, 1e-9);
  EXPECT_NEAR(orbit.metrics[Metric::pitch_amplitude], degrees_per_radian * 0.375, 1e-9);
}

TEST(UnequalStops, EqualOnesGivenSeparatelyAreTheSameNumbers) {
  std::mt19937_64 random(53);
  for (int n = 0; n < 6; ++n) {
    Design<double> together =
        n % 2 == 0 ? random_hinged_design(random, true) : random_hinged_crank(std::uint32_t(2 * n + 1), 54);
    together.pitch.stop = together.pitch.stop.value_or(0.3);
    Design<double> separate = together;
    separate.pitch.stop.reset();
    separate.pitch.stop_low = -*together.pitch.stop;
    separate.pitch.stop_high = *together.pitch.stop;
    for (const Method method : {Method::orbit, Method::transient}) {
      const RunResult a = run_design(together, {.method = method}), b = run_design(separate, {.method = method});
      EXPECT_EQ(a.status, b.status) << n;
      for (int m = 0; m < metric_count; ++m) {
        const double x = a.metrics[Metric(m)], y = b.metrics[Metric(m)];
        EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << n << ", " << metric_info(Metric(m)).key;
      }
    }
  }
}

// Seen in a mirror stroke, pitch, current and voltage change their signs: half a period later it is the same motion.
TEST(UnequalStops, AMirroredVehicleHasTheMirroredOrbit) {
  Design<double> d = hinged_design(2e-4);
  d.pitch.stop_low = -0.25;
  d.pitch.stop_high = 0.5;
  d.spring.rest_angle = 0.15;
  d.motor.constants.friction_torque = 2e-6;
  d.pitch.friction = 2e-7;
  Design<double> mirrored = d;
  mirrored.pitch.stop_low = -0.5;
  mirrored.pitch.stop_high = 0.25;
  mirrored.spring.rest_angle = -0.15;
  const SteadyFlapping one = accurate_orbit(d), other = accurate_orbit(mirrored);
  ASSERT_EQ(one.status, FlappingStatus::flapping);
  ASSERT_EQ(other.status, FlappingStatus::flapping);
  for (const Metric m : {Metric::lift_mean, Metric::lift_peak, Metric::power_electrical, Metric::power_hinge,
                         Metric::stroke_amplitude, Metric::current_rms, Metric::pitch_amplitude}) {
    EXPECT_NEAR(one.metrics[m], other.metrics[m], 1e-9 * std::abs(one.metrics[m])) << metric_info(m).key;
  }
  for (const double phase : {0.3, 1.1, 2.0, 2.9}) {
    const WaveformRow a = one.record.at(phase), b = other.record.at(phase + pi);
    EXPECT_NEAR(a.stroke_angle, -b.stroke_angle, 1e-8) << phase;
    EXPECT_NEAR(a.pitch_angle, -b.pitch_angle, 1e-8) << phase;
    EXPECT_NEAR(a.lift, b.lift, 1e-8) << phase;
  }
}

// Only the springs know the stroke angle of a direct drive: with their rest all of the motion moves.
TEST(RestAngle, MovesTheWholeStroke) {
  for (const bool hinged : {false, true}) {
    for (const Method method : {Method::orbit, Method::transient}) {
      Design<double> d = hinged ? hinged_design(3e-4) : direct_design();
      if (hinged) d.pitch.stop = 0.4;
      RunOptions options{.method = method, .tolerance = 1e-9};
      options.waveform_rows = 9;
      const RunResult about_zero = run_design(d, options);
      d.spring.rest_angle = -0.21;
      const RunResult moved = run_design(d, options);
      ASSERT_EQ(about_zero.status, FlappingStatus::flapping);
      ASSERT_EQ(moved.status, FlappingStatus::flapping);
      for (const Metric m : {Metric::lift_mean, Metric::power_electrical, Metric::stroke_amplitude,
                             Metric::flapping_velocity_peak, Metric::power_reactive}) {
        EXPECT_NEAR(moved.metrics[m], about_zero.metrics[m], 1e-7 * about_zero.metrics[m]) << metric_info(m).key;
      }
      ASSERT_EQ(moved.cycle.size(), about_zero.cycle.size());
      for (std::size_t n = 0; n < moved.cycle.size(); ++n) {
        EXPECT_NEAR(moved.cycle[n].stroke_angle, about_zero.cycle[n].stroke_angle - 0.21, 1e-6) << n;
        EXPECT_NEAR(moved.cycle[n].spring_moment, about_zero.cycle[n].spring_moment, 1e-8) << n;
      }
    }
  }
}

// The closed form of a mean voltage: the motor's mean torque bends the springs from their rest by K V_0 / (R N_w k).
TEST(RestAngle, AddsToWhatAMeanVoltageBends) {
  Design<double> d = direct_design();
  d.aerodynamics.air_density = 0.0;
  d.friction = {};
  d.supply.offset = 0.4;
  d.spring.rest_angle = 0.1;
  const Vehicle<double> v = resolve(d);
  const SteadyFlapping orbit = accurate_orbit(d);
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  double mean = 0.0;
  constexpr int samples = 64;
  for (int n = 0; n < samples; ++n) mean += orbit.record.at(two_pi * n / samples).stroke_angle / samples;
  const double bent = v.motor.torque_constant * 0.4 / (v.motor.armature_resistance * v.wing_count * v.spring.stiffness);
  EXPECT_NEAR(mean, 0.1 + bent, 1e-9);
}

TEST(UnequalStops, DerivativesAgreeWithDifferences) {
  Design<double> d = hinged_design(2e-4);
  d.pitch.stop_low = -0.3;
  d.pitch.stop_high = 0.45;
  d.spring.rest_angle = 0.12;
  d.supply.offset = 0.3;
  std::vector<DesignParameter> parameters;
  for (const char* key : {"pitch.stop_low", "pitch.stop_high", "spring.rest_angle", "spring.stiffness"}) {
    parameters.push_back(design_parameter(key));
  }
  d.spring.stiffness = resolve(d).spring.stiffness;
  d.spring.resonance.reset();
  d.spring.resonance_ratio.reset();
  int by_stops = 0;
  compare_with_differences(
      d, parameters, [&](const auto& key, Metric m, const Metrics<double>& metrics, double exact, double difference) {
        EXPECT_NEAR(exact, difference, 1e-5 * (error_scale(metrics, m) + std::abs(difference)))
            << key << ", " << metric_info(m).key;
        if (m == Metric::lift_mean && key.starts_with("pitch.")) by_stops += std::abs(exact) > 1e-3 * metrics[m];
      });
  EXPECT_EQ(by_stops, 2);
}

std::string refusal(const Design<double>& d) {
  try {
    validate(d);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(UnequalStops, BadOnesAreRefused) {
  Design<double> d = hinged_design(2e-4);
  EXPECT_EQ(refusal(d), "accepted");
  d.pitch.stop_low = -0.3;
  EXPECT_EQ(refusal(d), "pitch.stop_high: missing: give both stop_low and stop_high, or stop to either side alike");
  d.pitch.stop_high = -0.1;
  EXPECT_EQ(refusal(d), "pitch.stop_high: must be > 0 and < pi [rad], got -0.1 (-5.73 deg)");
  d.pitch.stop_high = 0.1;
  EXPECT_EQ(refusal(d), "accepted");
  d.pitch.stop_low = 0.05;
  EXPECT_EQ(refusal(d), "pitch.stop_low: must be < 0 and > -pi [rad], got 0.05 (2.865 deg)");
  d = direct_design();
  d.spring.rest_angle = 1.6;
  EXPECT_EQ(refusal(d), "spring.rest_angle: must lie between -pi/2 and pi/2 [rad], got 1.6 (91.67 deg)");
  d.spring = {};
  d.spring.rest_angle = 0.1;
  EXPECT_EQ(refusal(d), "spring.rest_angle: there are no springs to be at rest: give spring.stiffness");
}

}  // namespace
}  // namespace wingbeat

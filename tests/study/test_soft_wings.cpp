// Wings that twist and hinges with friction: the orbit search against the simulation from rest, which shares the
// equations alone; the energy balance of both; limits.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/hinged_design.hpp"
#include "vehicle/orbit_and_simulation.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/time/simulation.hpp"
#include "wingbeat/vehicle/dynamics.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

template <class Change>
int flapping_of(unsigned seed, int count, const Change& change) {
  std::mt19937_64 random(seed);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  int flapping = 0;
  for (int n = 0; n < count; ++n) {
    Design<double> d = n % 2 ? random_hinged_crank(std::uint32_t(n), seed) : random_hinged_design(random, n % 4 == 2);
    change(d, uniform);
    flapping += expect_orbit_as_simulated(d, n).flaps;
  }
  return flapping;
}

TEST(SoftWings, TorsionBesideTheHinge) {
  EXPECT_GE(flapping_of(61, 16,
                        [](Design<double>& d, const auto& uniform) {
                          d.wing.torsion = {*d.pitch.stiffness * uniform(0.5, 5.0), 0.3 * d.pitch.damping};
                        }),
            10);
}

TEST(SoftWings, TorsionInPlaceOfTheHinge) {
  EXPECT_GE(flapping_of(62, 16,
                        [](Design<double>& d, const auto& uniform) {
                          d.wing.torsion = {*d.pitch.stiffness * uniform(0.5, 3.0), d.pitch.damping};
                          d.pitch.stiffness.reset();
                          d.pitch.stop.reset();
                        }),
            10);
}

TEST(SoftWings, FrictionOfThePitchJoint) {
  EXPECT_GE(flapping_of(63, 16,
                        [](Design<double>& d, const auto& uniform) {
                          d.pitch.friction = *d.pitch.stiffness * uniform(0.005, 0.1);
                        }),
            10);
}

TEST(SoftWings, TorsionAndFrictionTogether) {
  EXPECT_GE(flapping_of(64, 12,
                        [](Design<double>& d, const auto& uniform) {
                          d.wing.torsion = {*d.pitch.stiffness * uniform(0.5, 5.0), 0.3 * d.pitch.damping};
                          d.pitch.friction = *d.pitch.stiffness * uniform(0.005, 0.05);
                        }),
            7);
}

// A wing stiff in torsion is the one of section 12, to the inverse of its stiffness.
TEST(SoftWings, AStiffWingDoesNotTwist) {
  for (Design<double> d : {hinged_design(4e-4), random_hinged_crank(5, 3)}) {
    const SteadyFlapping rigid = find_steady_flapping(resolve(d), {.tolerance = 1e-8});
    ASSERT_EQ(rigid.status, FlappingStatus::flapping);
    double before = infinity;
    for (const double times : {30.0, 300.0}) {
      d.wing.torsion = {times * *d.pitch.stiffness, d.pitch.damping};
      const SteadyFlapping soft = find_steady_flapping(resolve(d), {.tolerance = 1e-8});
      ASSERT_EQ(soft.status, FlappingStatus::flapping) << describe(soft.evidence);
      const double off = std::abs(soft.metrics[Metric::pitch_amplitude] / rigid.metrics[Metric::pitch_amplitude] - 1.0);
      EXPECT_LT(off, 0.2 * before);
      before = off;
    }
    EXPECT_LT(before, 0.01);
  }
}

TEST(SoftWings, GradientsAreThoseOfDifferences) {
  Design<double> d = hinged_design(4e-4);
  d.wing.torsion = {6e-4, 3e-8};
  d.pitch.friction = 4e-6;
  const SteadyFlapping orbit = find_steady_flapping(resolve(d), {.tolerance = 1e-11});
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  const char* keys[] = {"wing.torsion.stiffness", "wing.torsion.damping", "pitch.friction", "wing.planform.length"};
  std::vector<DesignParameter> parameters;
  for (const char* key : keys) parameters.push_back(design_parameter(key));
  const MetricGradients g = metric_gradients(d, Condition::air, orbit, parameters, {});
  for (std::size_t k = 0; k < std::size(keys); ++k) {
    const auto& parameter = numeric_parameter<double>(keys[k]);
    const double value = *parameter.get(d), h = 2e-5 * value;
    Metrics<double> side[2];
    for (const int s : {0, 1}) {
      Design<double> moved = d;
      parameter.set(moved, value + (s ? h : -h));
      side[s] = find_steady_flapping(resolve(moved), {.tolerance = 1e-11}).metrics;
    }
    for (const Metric m : {Metric::lift_mean, Metric::power_electrical, Metric::power_hinge, Metric::pitch_amplitude}) {
      const double difference = (side[1][m] - side[0][m]) / (2.0 * h), size = std::abs(orbit.metrics[m] / value);
      EXPECT_NEAR(g.by_parameter[k][std::size_t(m)], difference, 2e-5 * size) << keys[k] << ' ' << metric_info(m).key;
    }
  }
}

// A wing in vacuum beside a stroke that friction holds: its pitching decays by 4 T_psi / k_psi a period, and it stops
// where less than T_psi / k_psi is left.
// Any pitch within its reach is an orbit's; the one from rest is found, and no second one.
TEST(SoftWings, FrictionThatHoldsTheWings) {
  Design<double> d = hinged_design(4e-4);
  d.pitch.friction = 2.0 * *d.pitch.stiffness;
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    const SteadyFlapping orbit = find_steady_flapping(resolve(d), {.tolerance = tolerance});
    ASSERT_EQ(orbit.status, FlappingStatus::flapping) << describe(orbit.evidence);
    EXPECT_NEAR(orbit.summary.floquet_multiplier_max, 1.0, 1e-9);
    EXPECT_EQ(orbit.metrics[Metric::pitch_amplitude], 0.0);
    EXPECT_NEAR(orbit.metrics[Metric::lift_peak], 0.0, 1e-12);
    EXPECT_TRUE(std::isnan(orbit.metrics[Metric::lift_added_mass_share]));
    EXPECT_TRUE(std::isnan(orbit.evidence.other_amplitude));
  }
}

TEST(SoftWings, FrictionStopsAFreeHinge) {
  Design<double> d = hinged_design(4e-4);
  d.pitch.friction = 4e-6;
  d.pitch.damping = 0.0;
  d.friction = {FrictionLaw::constant, 1.0};
  const Vehicle<double> v = resolve(d, Condition::vacuum);
  SimulationOptions options;
  options.pitch_angle = 0.1;
  Simulation hinge(v, {}, options);
  hinge.command(0.0);
  const double w = std::sqrt(v.pitch.hinge.stiffness / v.pitch.pitch_inertia), loss = 4e-6 / 4e-4;
  double amplitude = 0.1;
  for (int half = 1; half <= 4; ++half) {
    hinge.step_to(half * pi / w);
    amplitude -= 2.0 * loss;
    EXPECT_NEAR(hinge.now().pitch_angle, (half % 2 ? -1.0 : 1.0) * amplitude, 1e-6) << half;
  }
  hinge.step_to(40.0 * pi / w);
  EXPECT_LE(std::abs(hinge.now().pitch_angle), loss);
  const double rests = hinge.now().pitch_angle;
  hinge.step_to(60.0 * pi / w);
  EXPECT_EQ(hinge.now().pitch_angle, rests);
}

}  // namespace
}  // namespace wingbeat

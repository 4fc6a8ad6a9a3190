// Steady flapping of direct drives whose wings pitch on a hinge, as it is asked for: from a design, by the orbit search
// and by a simulation from rest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/hinged_design.hpp"
#include "vehicle/orbit_and_simulation.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;

TEST(PitchFlapping, OrbitAgreesWithTheSimulationOfRandomVehicles) {
  std::mt19937_64 random(14);
  int flapping = 0, stopped = 0;
  for (int n = 0; n < 100; ++n) {
    const Compared seen = expect_orbit_as_simulated(random_hinged_design(random, n % 2 == 1), n);
    flapping += seen.flaps;
    stopped += seen.meets_stop;
  }
  EXPECT_GT(flapping, 90);
  EXPECT_GT(stopped, 20);
}

TEST(PitchFlapping, DesignGivesTheWingsOfItsDrawing) {
  Design<double> d = hinged_design(3e-4);
  d.pitch.stop = 0.7;
  const Vehicle<double> v = resolve(d);
  ASSERT_TRUE(pitches(v));
  const WingMass<double> one = *wing_mass(d.wing);
  EXPECT_DOUBLE_EQ(v.pitch.pitch_inertia, 2.0 * one.pitch_inertia);
  EXPECT_DOUBLE_EQ(v.pitch.mass_product, 2.0 * one.mass_product);
  EXPECT_DOUBLE_EQ(v.pitch.hinge.stiffness, 6e-4);
  EXPECT_EQ(v.pitch.hinge.stop, 0.7);
  EXPECT_GT(v.pitch.air.rr, 0.0);
  d.aerodynamics.added_mass = false;
  d.pitch.rotational_lift = false;
  EXPECT_EQ(resolve(d).pitch.air.rr, 0.0);
  EXPECT_EQ(resolve(d).pitch.rotational_coefficient, 0.0);
  EXPECT_EQ(resolve(d, Condition::vacuum).pitch.air.pp, 0.0);
  EXPECT_FALSE(pitches(resolve(d, Condition::wingless)));
  EXPECT_FALSE(pitches(resolve(direct_design())));
  d.motors = 3.0;
  EXPECT_DOUBLE_EQ(resolve(d).pitch.pitch_inertia, 6.0 * one.pitch_inertia);
}

// M motors, each with its wings, are M times one motor at the same voltage.
TEST(PitchFlapping, SeveralMotorsAreAsManyTimesOne) {
  Design<double> d = hinged_design(4e-4);
  const SteadyFlapping one = find_steady_flapping(resolve(d));
  d.motors = 2.0;
  const SteadyFlapping two = find_steady_flapping(resolve(d));
  ASSERT_EQ(one.status, FlappingStatus::flapping);
  for (const Metric m : {Metric::lift_mean, Metric::power_electrical, Metric::power_hinge}) {
    EXPECT_NEAR(two.metrics[m] / one.metrics[m], 2.0, 1e-6) << metric_info(m).key;
  }
  EXPECT_NEAR(two.metrics[Metric::pitch_amplitude], one.metrics[Metric::pitch_amplitude], 1e-5);
}

TEST(PitchFlapping, EnsemblesLeaveItToTheScalarSolver) {
  expect_left_to_scalar_solver(hinged_design(3e-4), {Metric::lift_mean, Metric::pitch_amplitude, Metric::power_hinge});
}

// A soft hinge turns the wing late, beyond 90 degrees of attack after each reversal: that is said.
TEST(PitchFlapping, OverRotationIsNamed) {
  Design<double> d = hinged_design(3e-5);
  const SteadyFlapping soft = find_steady_flapping(resolve(d), {}, start_up_in_time());
  ASSERT_EQ(soft.status, FlappingStatus::flapping) << describe(soft.evidence);
  EXPECT_THAT(describe(soft.evidence), HasSubstr("the wings over-rotate"));
  EXPECT_GT(soft.metrics[Metric::angle_of_attack_max], 90.0);
}

}  // namespace
}  // namespace wingbeat

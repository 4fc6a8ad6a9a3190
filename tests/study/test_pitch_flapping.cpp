// Steady flapping of direct drives whose wings pitch on a hinge, as it is asked for: from a design, by the orbit search
// and by a simulation from rest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/hinged_design.hpp"
#include "vehicle/orbit_and_simulation.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
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
  EXPECT_EQ(v.pitch.hinge.stop_high, 0.7);
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

/// Lift of the added mass by the force normal to the chord alone and by all of it, by either method.
void expect_share_of_added_mass(Design<double> d) {
  const auto metrics = [&](Method method, double suction) {
    d.pitch.edge_suction = suction;
    const RunResult r = run_design(d, {.method = method, .tolerance = 1e-7});
    EXPECT_EQ(r.status, FlappingStatus::flapping) << describe(r.evidence);
    const double share = r.metrics[Metric::lift_added_mass_share];
    EXPECT_EQ(r.added_mass_lift.has_value(), std::abs(share) > 0.05) << share;
    return r.metrics;
  };
  const Metrics<double> normal = metrics(Method::orbit, 0.0), whole = metrics(Method::orbit, 1.0);
  const double share = normal[Metric::lift_added_mass_share];
  EXPECT_GT(std::abs(share), 0.01);
  EXPECT_EQ(whole[Metric::lift_added_mass_share], 0.0);
  // Nothing moves because of it.
  for (const Metric m : {Metric::power_electrical, Metric::frequency, Metric::pitch_amplitude}) {
    EXPECT_NEAR(whole[m] / normal[m], 1.0, 1e-6) << metric_info(m).key;
  }
  EXPECT_NEAR(whole[Metric::lift_mean] / normal[Metric::lift_mean], 1.0 - share, 1e-6);
  const Metrics<double> half = metrics(Method::orbit, 0.5);
  EXPECT_NEAR(half[Metric::lift_added_mass_share], 0.5 * share / (1.0 - 0.5 * share), 1e-6);
  const Metrics<double> in_time = metrics(Method::transient, 0.5);
  EXPECT_NEAR(in_time[Metric::lift_added_mass_share], half[Metric::lift_added_mass_share], 1e-6);
  EXPECT_NEAR(in_time[Metric::lift_mean] / half[Metric::lift_mean], 1.0, 1e-6);
}

TEST(PitchFlapping, LiftOfTheAddedMassComesFromWhatIsLeftOutAlongTheChord) {
  for (const bool stops : {false, true}) {
    SCOPED_TRACE(stops);
    Design<double> d = hinged_design(3e-4);
    if (stops) d.pitch.stop = 0.4;
    expect_share_of_added_mass(d);
    Design<double> crank = on_hinges(reference_design(), 6e-4);
    if (stops) crank.pitch.stop = 0.25;
    expect_share_of_added_mass(crank);
  }
  Design<double> none = hinged_design(3e-4);
  none.aerodynamics.added_mass = false;
  const RunResult r = run_design(none);
  EXPECT_TRUE(std::isnan(r.metrics[Metric::lift_added_mass_share]));
  EXPECT_FALSE(r.added_mass_lift);
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

// Steady flapping of cranks whose wings pitch on a hinge, as it is asked for: from a design, by the orbit search and by
// a simulation from rest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/hinged_design.hpp"
#include "vehicle/orbit_and_simulation.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

TEST(PitchCrankFlapping, OrbitAgreesWithTheSimulationOfRandomVehicles) {
  int flapping = 0, stopped = 0, kinds[4] = {};
  for (std::uint32_t n = 0; n < 100; ++n) {
    const Design<double> design = random_hinged_crank(n, 14);
    const Compared seen = expect_orbit_as_simulated(design, int(n));
    flapping += seen.flaps;
    stopped += seen.meets_stop;
    kinds[int(design.transmission.type)] += seen.flaps;
  }
  EXPECT_GT(flapping, 70);
  EXPECT_GT(stopped, 15);
  EXPECT_GT(kinds[int(TransmissionType::slider_crank)], 10);
  EXPECT_GT(kinds[int(TransmissionType::four_bar)], 10);
  EXPECT_GT(kinds[int(TransmissionType::tabulated)], 10);
}

Design<double> hinged_crank(double stiffness) {
  Design<double> d = on_hinges(reference_design(), stiffness);
  d.transmission.formulation = Formulation::virtual_work;
  return d;
}

/// The crank with wings that stay normal to the stroke plane.
Design<double> upright_crank() {
  Design<double> d = hinged_crank(1.0);
  d.pitch = {};
  d.aerodynamics.coefficients_name = "own";
  d.aerodynamics.coefficients.drag = {3.45, 0.0, 1.0, 0.0};  // C_N of the normal-force set at 90 degrees
  return d;
}

// A hinge that hardly gives way, and stops that hardly leave room, are wings at 90 degrees of attack.
TEST(PitchCrankFlapping, FrozenWingsAreTheLawWithoutPitching) {
  const SteadyFlapping law = find_steady_flapping(resolve(upright_crank()), {.tolerance = 1e-8});
  ASSERT_EQ(law.status, FlappingStatus::flapping);
  Design<double> stiff = hinged_crank(0.5), stopped = hinged_crank(3e-4);
  stiff.pitch.damping = 1e-5;
  stopped.pitch.stop = 1e-4;
  for (const Design<double>& d : {stiff, stopped}) {
    const SteadyFlapping found = find_steady_flapping(resolve(d), {.tolerance = 1e-8}, start_up_in_time());
    ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
    for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::power_aerodynamic,
                           Metric::rod_force_mean, Metric::flapping_velocity_peak}) {
      EXPECT_NEAR(found.metrics[m] / law.metrics[m], 1.0, 2e-3) << metric_info(m).key;
    }
    EXPECT_LT(found.metrics[Metric::pitch_amplitude], 0.1);
  }
}

TEST(PitchCrankFlapping, OverRotationIsNamed) {
  const SteadyFlapping soft = find_steady_flapping(resolve(hinged_crank(3e-5)), {}, start_up_in_time());
  ASSERT_EQ(soft.status, FlappingStatus::flapping) << describe(soft.evidence);
  EXPECT_THAT(describe(soft.evidence), testing::HasSubstr("the wings over-rotate"));
  EXPECT_GT(soft.metrics[Metric::angle_of_attack_max], 90.0);
}

// Without constant friction or springs only the rotor's lightness can stop a crank: where the wings' inertia and
// friction leave no unique acceleration.
TEST(PitchCrankFlapping, JamsAreFoundByEitherMethod) {
  Design<double> d = hinged_crank(3e-4);
  d.motor.constants.inertia = 1e-9;
  d.friction.coefficient = 6e-3;
  const SteadyFlapping found = find_steady_flapping(resolve(d), {}, start_up_in_time());
  EXPECT_EQ(found.status, FlappingStatus::jammed) << describe(found.evidence);
  EXPECT_EQ(simulate_start_up(resolve(d)).status, FlappingStatus::jammed);
  EXPECT_EQ(find_steady_flapping(resolve(d)).status, FlappingStatus::jammed);
}

TEST(PitchCrankFlapping, SpringsCanLockIt) {
  Design<double> d = hinged_crank(3e-4);
  d.spring.stiffness = 5e-2;
  const SteadyFlapping found = find_steady_flapping(resolve(d), {}, start_up_in_time());
  EXPECT_EQ(found.status, FlappingStatus::locked) << describe(found.evidence);
}

// A bridge that switches fast is its mean voltage.
TEST(PitchCrankFlapping, SwitchedSupplyIsItsMean) {
  Design<double> d = hinged_crank(3e-4);
  const SteadyFlapping constant = find_steady_flapping(resolve(d));
  TransientOptions options;
  options.supply = Supply<double>{SupplyType::pwm, 6.0, 20e3, 0.5};
  options.tolerance = 1e-5;
  const TransientResult switched = simulate_start_up(resolve(d), options);
  ASSERT_EQ(switched.status, FlappingStatus::flapping) << describe(switched.evidence);
  for (const Metric m : {Metric::frequency, Metric::lift_mean, Metric::pitch_amplitude}) {
    EXPECT_NEAR(switched.metrics->values[std::size_t(m)] / constant.metrics[m], 1.0, 2e-3) << metric_info(m).key;
  }
}

TEST(PitchCrankFlapping, EnsemblesLeaveItToTheScalarSolver) {
  expect_left_to_scalar_solver(
      hinged_crank(3e-4), {Metric::lift_mean, Metric::pitch_amplitude, Metric::power_hinge, Metric::rod_force_peak});
}

}  // namespace
}  // namespace wingbeat

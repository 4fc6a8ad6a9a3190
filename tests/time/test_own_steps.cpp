// Start-up by the project's own steps, which the bare core has: closed forms, known orbits, statuses.
#include <gtest/gtest.h>

#include <cmath>

#include "time/free_decay.hpp"
#include "vehicle/known_orbits.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {
namespace {

TransientResult by_own_steps(const Vehicle<double>& vehicle, TransientOptions options = {}) {
  options.integrator = TimeIntegrator::own_steps;
  return simulate_start_up(vehicle, options);
}

TEST(OwnSteps, ReachTheKnownOrbits) {
  for (const KnownOrbit& orbit : known_orbits) {
    for (const double tolerance : {1e-4, 1e-6, 1e-9}) {
      TransientOptions options;
      options.tolerance = tolerance;
      const TransientResult r = by_own_steps(reference_vehicle(orbit.springs), options);
      ASSERT_TRUE(r.settled && r.metrics) << describe(r.evidence);
      EXPECT_NEAR((*r.metrics)[Metric::frequency] / orbit.frequency, 1.0, tolerance);
      EXPECT_NEAR((*r.metrics)[Metric::lift_mean] / orbit.lift_mean, 1.0, tolerance);
      EXPECT_NEAR((*r.metrics)[Metric::rod_force_peak] / orbit.rod_force_peak, 1.0, tolerance);
    }
  }
}

TEST(OwnSteps, FollowAFreeDecay) {
  for (const double omega_0 : {400.0, -400.0}) {
    const FreeDecay exact(omega_0);
    TransientOptions options;
    options.tolerance = 1e-10;
    options.start.speed = omega_0;
    const TransientResult r = by_own_steps(exact.vehicle, options);
    EXPECT_EQ(r.status, FlappingStatus::stalled) << describe(r.evidence);
    EXPECT_NEAR(r.end_time / exact.end_time, 1.0, 1e-9);
    EXPECT_NEAR(r.end_crank_angle / exact.end_crank_angle, 1.0, 1e-9);
  }
}

TEST(OwnSteps, AreImplicitWhereStiff) {
  Vehicle<double> v = reference_vehicle();
  v.motor.armature_inductance = 0.0;
  TransientOptions options;
  options.tolerance = 1e-8;
  const TransientResult none = by_own_steps(v, options);
  v.motor.armature_inductance = 1e-8;  // L_a / R_a = 1 ns
  const TransientResult small = by_own_steps(v, options);
  ASSERT_TRUE(none.metrics && small.metrics) << describe(small.evidence);
  EXPECT_FALSE(none.stiff);
  EXPECT_TRUE(small.stiff);
  EXPECT_LT(small.steps, 20000);
  for (const Metric metric : {Metric::frequency, Metric::power_electrical, Metric::lift_mean, Metric::rod_force_peak}) {
    EXPECT_NEAR((*small.metrics)[metric] / (*none.metrics)[metric], 1.0, 5e-7);
  }
}

TEST(OwnSteps, SeeEveryRevolutionOfAFreeMotor) {
  // Nothing bounds the steps of a motor at constant speed but the cycles.
  const TransientResult r = by_own_steps(wingless_vehicle());
  ASSERT_EQ(r.status, FlappingStatus::flapping) << describe(r.evidence);
  int revolutions = 0;
  for (const TransientEvent& e : r.events) {
    if (e.kind != TransientEvent::Kind::revolution) continue;
    ++revolutions;
    EXPECT_NEAR(e.crank_angle, two_pi * revolutions, 1e-9 * revolutions);
  }
  EXPECT_EQ(revolutions, r.cycles);
  EXPECT_GE(revolutions, 3);
}

TEST(OwnSteps, RepeatToTheBit) {
  TransientOptions options;
  options.record = true;
  const TransientResult first = by_own_steps(reference_vehicle(true), options);
  const TransientResult second = by_own_steps(reference_vehicle(true), options);
  ASSERT_EQ(first.samples.size(), second.samples.size());
  for (std::size_t k = 0; k < first.samples.size(); ++k) EXPECT_EQ(first.samples[k].current, second.samples[k].current);
}

// Without an assessment of start-up the bare core called these flapping: they have an orbit, but lock on the way to it.
TEST(OwnSteps, JudgeWhatLocksOnTheWay) {
  int corrected = 0;
  for (int n = 0; n < 15; ++n) {
    for (const double crank_radius : {4e-3, 5e-3, 6e-3, 7e-3, 8e-3}) {
      Design<double> design = reference_design();
      design.supply.voltage = 0.6 + 0.3 * n;
      design.spring.stiffness = 3e-3;
      design.transmission.crank_radius = crank_radius;
      const Vehicle<double> vehicle = resolve(design);
      const FlappingStatus assessed =
          find_steady_flapping(vehicle, {}, start_up_in_time(1e-6, TimeIntegrator::own_steps)).status;
      EXPECT_TRUE(assessed == FlappingStatus::flapping || assessed == FlappingStatus::locked ||
                  assessed == FlappingStatus::stalled);
      corrected +=
          assessed == FlappingStatus::locked && find_steady_flapping(vehicle).status == FlappingStatus::flapping;
    }
  }
  EXPECT_GE(corrected, 2);
}

}  // namespace
}  // namespace wingbeat

// Start-up by the project's own steps, which the bare core has: closed forms, known orbits, statuses.
#include <gtest/gtest.h>

#include <cmath>

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
  // The frequencies and lifts of tests/vehicle/test_transient.cpp.
  for (const double tolerance : {1e-4, 1e-6, 1e-9}) {
    TransientOptions options;
    options.tolerance = tolerance;
    const TransientResult plain = by_own_steps(reference_vehicle(), options);
    ASSERT_TRUE(plain.settled && plain.metrics) << plain.detail;
    EXPECT_NEAR((*plain.metrics)[Metric::frequency] / 21.952226143327449, 1.0, tolerance);
    EXPECT_NEAR((*plain.metrics)[Metric::lift_mean] / 0.0087391846723811966, 1.0, tolerance);
    const TransientResult springs = by_own_steps(reference_vehicle(true), options);
    ASSERT_TRUE(springs.settled && springs.metrics) << springs.detail;
    EXPECT_NEAR((*springs.metrics)[Metric::frequency] / 23.430706596318597, 1.0, tolerance);
    EXPECT_NEAR((*springs.metrics)[Metric::rod_force_peak] / 0.38663637234591627, 1.0, tolerance);
  }
}

TEST(OwnSteps, FollowAFreeDecay) {
  // J omega' = -T_c - (K^2 / R_a) omega: tests/vehicle/test_transient.cpp.
  Vehicle<double> v = wingless_vehicle();
  v.voltage = 0.0;
  v.friction.radius = 0.0;
  v.friction.torque = 2e-4;
  v.motor.viscous_damping = 0.0;
  v.motor.armature_inductance = 0.0;
  for (const double omega_0 : {400.0, -400.0}) {
    TransientOptions options;
    options.tolerance = 1e-10;
    options.crank_speed = omega_0;
    const TransientResult r = by_own_steps(v, options);
    const double c = square(v.motor.torque_constant) / v.motor.armature_resistance, J = v.motor.inertia, T_c = 2e-4;
    const double t = J / c * std::log1p(c * std::abs(omega_0) / T_c);
    const double angle = (J * std::abs(omega_0) - T_c * t) / c;
    EXPECT_EQ(r.status, FlappingStatus::stalled) << r.detail;
    EXPECT_NEAR(r.end_time / t, 1.0, 1e-9);
    EXPECT_NEAR(r.end_crank_angle / std::copysign(angle, omega_0), 1.0, 1e-9);
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
  ASSERT_TRUE(none.metrics && small.metrics) << small.detail;
  EXPECT_FALSE(none.stiff);
  EXPECT_TRUE(small.stiff);
  EXPECT_LT(small.steps, 20000);
  for (const Metric metric : {Metric::frequency, Metric::power_electrical, Metric::lift_mean, Metric::rod_force_peak}) {
    EXPECT_NEAR((*small.metrics)[metric] / (*none.metrics)[metric], 1.0, 5e-7);
  }
}

TEST(OwnSteps, SeeEveryRevolutionOfAFreeMotor) {
  // Nothing bounds the steps of a motor at constant speed but the laps.
  const TransientResult r = by_own_steps(wingless_vehicle());
  ASSERT_EQ(r.status, FlappingStatus::flapping) << r.detail;
  int revolutions = 0;
  for (const TransientEvent& e : r.events) {
    if (e.kind != TransientEvent::Kind::revolution) continue;
    ++revolutions;
    EXPECT_NEAR(e.crank_angle, two_pi * revolutions, 1e-9 * revolutions);
  }
  EXPECT_EQ(revolutions, r.laps);
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

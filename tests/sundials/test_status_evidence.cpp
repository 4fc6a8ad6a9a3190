// The evidence of every status on vehicles whose numbers follow from statics, friction and geometry.
#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

#include "vehicle/direct_design.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "vehicle/wide_boxes.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {
namespace {

using Evidence = StatusEvidence::Kind;

template <class T>
TransientOptions limited(T TransientOptions::* limit, std::type_identity_t<T> value) {
  TransientOptions options;
  options.*limit = value;
  return options;
}

CrankKinematics<double> at_angle(const Vehicle<double>& v, double theta) {
  return crank_kinematics(v.transmission, std::sin(theta), std::cos(theta));
}

constexpr double stall_torque_at_3_v = 0.01 * 3.0 / 9.0;

TEST(StatusEvidence, OfFlappingIsTheFrequencyAndWhereTheCrankLocks) {
  const SteadyFlapping found = find_steady_flapping(reference_vehicle(), {.tolerance = 1e-9});
  EXPECT_EQ(found.evidence.kind, Evidence::orbit);
  EXPECT_NEAR(found.evidence.frequency / found.metrics[Metric::frequency], 1.0, 1e-12);
  EXPECT_EQ(found.evidence.can_lock, found.balance.can_lock());
  EXPECT_EQ(found.evidence.locks.size(), lock_intervals(reference_vehicle()).size());
  EXPECT_FALSE(found.evidence.assessed);
  EXPECT_TRUE(find_steady_flapping(reference_vehicle(), {}, start_up_in_time()).evidence.assessed);

  const TransientResult in_time = simulate_start_up(reference_vehicle());
  const StatusEvidence& e = in_time.evidence;
  EXPECT_EQ(e.kind, Evidence::settled_cycles);
  EXPECT_NEAR(e.frequency / found.metrics[Metric::frequency], 1.0, 1e-5);
  EXPECT_EQ(e.time, in_time.time_to_steady);
  EXPECT_GT(e.time, 0.0);
  EXPECT_EQ(e.cycles, in_time.cycles);
  EXPECT_LT(e.change, 1e-6);
  EXPECT_EQ(e.repeats_after, 1);
  EXPECT_FALSE(e.extrapolated);
}

TEST(StatusEvidence, OfAStallIsBothTorques) {
  Vehicle<double> v = reference_vehicle();
  v.motor.friction_torque = 3.4e-3;
  const StatusEvidence by_statics = find_steady_flapping(v).evidence;
  EXPECT_EQ(by_statics.kind, Evidence::weak_motor);
  EXPECT_DOUBLE_EQ(by_statics.torque, stall_torque_at_3_v);
  EXPECT_DOUBLE_EQ(by_statics.friction_torque, 3.4e-3);
  const StatusEvidence in_time = simulate_start_up(v).evidence;
  EXPECT_EQ(in_time.kind, Evidence::stalled_crank);
  EXPECT_DOUBLE_EQ(in_time.torque, stall_torque_at_3_v);
  EXPECT_DOUBLE_EQ(in_time.friction_torque, 3.4e-3);
  EXPECT_EQ(in_time.angle, 0.0);
}

TEST(StatusEvidence, OfALockIsWhatHoldsTheCrankAndWhere) {
  Vehicle<double> v = reference_vehicle();
  v.spring.stiffness = 0.02;
  const StatusEvidence friction = simulate_start_up(v).evidence;
  EXPECT_EQ(friction.kind, Evidence::friction_holds);
  const CrankKinematics<double> k = at_angle(v, friction.angle);
  const double F_s = v.wing_count * v.spring.stiffness * stroke_angle(k) / k.wing_jacobian;
  EXPECT_NEAR(friction.friction_torque, v.friction.radius * std::abs(F_s), 1e-12);
  EXPECT_NEAR(friction.torque_margin,
              v.friction.radius * std::abs(F_s) - std::abs(stall_torque_at_3_v - F_s * k.crank_jacobian), 1e-12);

  v.friction.radius = 0.0;
  const StatusEvidence springs = simulate_start_up(v).evidence;
  EXPECT_EQ(springs.kind, Evidence::springs_balance);
  EXPECT_DOUBLE_EQ(springs.torque, stall_torque_at_3_v);
  const CrankKinematics<double> there = at_angle(v, springs.angle);
  EXPECT_NEAR(v.wing_count * v.spring.stiffness * stroke_angle(there) / there.wing_jacobian * there.crank_jacobian,
              stall_torque_at_3_v, 1e-10);
}

TEST(StatusEvidence, OfALockByTheOrbitSearchIsWhereCyclesEnd) {
  Vehicle<double> v = reference_vehicle(true);
  v.spring.stiffness *= 10.0;
  const SteadyFlapping found = find_steady_flapping(v);
  EXPECT_EQ(found.evidence.kind, Evidence::no_orbit);
  EXPECT_EQ(found.evidence.search, found.summary.status);
  EXPECT_NE(found.evidence.search, solver::PeriodicStatus::not_tried);
  EXPECT_NE(found.evidence.search, solver::PeriodicStatus::converged);
  EXPECT_GT(found.evidence.angle, 0.0);
  EXPECT_LT(found.evidence.angle, two_pi);
  EXPECT_TRUE(found.evidence.can_lock);
  ASSERT_FALSE(found.evidence.locks.empty());
  for (const LockInterval& lock : found.evidence.locks) EXPECT_NEAR(lock_margin(v, lock.from), 0.0, 1e-9);
}

TEST(StatusEvidence, OfALockNamesAnOrbitThatAFasterStartReaches) {
  Vehicle<double> v = reference_vehicle(true);
  v.motor.inertia *= 20.0;
  bool seen = false;
  for (double stiffness = 2e-3; stiffness < 2e-2 && !seen; stiffness *= 1.05) {
    v.spring.stiffness = stiffness;
    const SteadyFlapping alone = find_steady_flapping(v);
    if (alone.status != FlappingStatus::flapping || !static_balance(v).can_lock()) continue;
    const SteadyFlapping found = find_steady_flapping(v, {}, start_up_in_time());
    if (found.status != FlappingStatus::locked) continue;
    seen = true;
    EXPECT_NEAR(found.evidence.faster_orbit / alone.metrics[Metric::frequency], 1.0, 1e-5);
    EXPECT_TRUE(std::isnan(simulate_start_up(v).evidence.faster_orbit));
  }
  EXPECT_TRUE(seen);
}

TEST(StatusEvidence, OfSwingsIsTheirRange) {
  TransientOptions options;
  options.supply = Supply<double>{SupplyType::sine, 3.0, 40.0};
  const TransientResult r = simulate_start_up(reference_vehicle(), options);
  ASSERT_EQ(r.status, FlappingStatus::locked) << describe(r.evidence);
  EXPECT_EQ(r.evidence.kind, Evidence::swings);
  ASSERT_TRUE(r.evidence.range);
  EXPECT_LE(r.evidence.range->from, r.end_crank_angle);
  EXPECT_GE(r.evidence.range->to, r.end_crank_angle);
  EXPECT_LT(r.evidence.range->to - r.evidence.range->from, two_pi);
}

TEST(StatusEvidence, OfAJamIsTheInertiaThatVanishes) {
  Vehicle<double> v = reference_vehicle();
  v.motor.inertia = 1e-9;
  v.friction.radius = 3e-3;
  const StatusEvidence in_time = simulate_start_up(v).evidence;
  EXPECT_EQ(in_time.kind, Evidence::inertia_vanishes);
  EXPECT_DOUBLE_EQ(in_time.inertia, min_inertia(v, at_angle(v, in_time.angle)));
  EXPECT_NEAR(in_time.inertia / v.motor.inertia, 0.0, 1e-5);

  const StatusEvidence by_statics = find_steady_flapping(v).evidence;
  const StaticBalance balance = static_balance(v);
  EXPECT_EQ(by_statics.kind, Evidence::inertia_may_vanish);
  EXPECT_EQ(by_statics.inertia, balance.inertia_min);
  EXPECT_LE(by_statics.inertia, 0.0);
  EXPECT_EQ(by_statics.angle, balance.inertia_angle);
}

TEST(StatusEvidence, OfGivingUpIsTheLimitThatWasReached) {
  const Vehicle<double> v = reference_vehicle();
  const StatusEvidence time = simulate_start_up(v, limited(&TransientOptions::max_time, 0.02)).evidence;
  EXPECT_EQ(time.kind, Evidence::out_of_time);
  EXPECT_DOUBLE_EQ(time.time, 0.02);
  const StatusEvidence cycles = simulate_start_up(v, limited(&TransientOptions::max_cycles, 2)).evidence;
  EXPECT_EQ(cycles.kind, Evidence::cycles_differ);
  EXPECT_EQ(cycles.cycles, 2);
  EXPECT_GT(cycles.change, 1e-6);
  EXPECT_NEAR(cycles.frequency, 17.0, 6.0);
  EXPECT_FALSE(cycles.range);
  const StatusEvidence steps = simulate_start_up(v, limited(&TransientOptions::max_steps, 30)).evidence;
  EXPECT_EQ(steps.kind, Evidence::out_of_steps);
  EXPECT_EQ(steps.steps, 30);
  ASSERT_TRUE(steps.range);
  EXPECT_LT(steps.range->from, steps.range->to);
  TransientOptions options;
  options.cancel = [] { return true; };
  EXPECT_EQ(simulate_start_up(v, options).evidence.kind, Evidence::cancelled);
}

TEST(StatusEvidence, OfASimulatedCycleIsItsErrorAndWhyNoOrbitWasFound) {
  const WideVehicle drawn = wide_vehicle(FarBox::crank_near_rod, 22);
  const SteadyFlapping found =
      find_steady_flapping(resolve(drawn.design), {.reporting = reporting_of(drawn.design)}, start_up_in_time());
  ASSERT_TRUE(found.simulated);
  EXPECT_EQ(found.evidence.kind, Evidence::simulated_cycle);
  EXPECT_EQ(found.evidence.frequency, found.metrics[Metric::frequency]);
  EXPECT_EQ(found.evidence.change, found.simulated->error_estimate);
  EXPECT_EQ(found.evidence.repeats_after, found.simulated->cycles);
  EXPECT_EQ(found.evidence.search, found.summary.status);
  EXPECT_FALSE(found.evidence.direct);
}

TEST(StatusEvidence, OfADirectDriveIsTheTorqueOfItsSupply) {
  Design<double> d = direct_design();
  const double drive = 0.01 * 3.0 / std::hypot(9.0, two_pi * 22.0 * 29e-3);
  d.friction = {FrictionLaw::constant, 1.001 * drive};
  const Vehicle<double> v = resolve(d);
  const StatusEvidence found = find_steady_flapping(v).evidence;
  EXPECT_EQ(found.kind, Evidence::weak_supply);
  EXPECT_DOUBLE_EQ(found.frequency, 22.0);
  EXPECT_NEAR(found.torque / drive, 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(found.friction_torque, 1.001 * drive);
  const TransientResult in_time = simulate_start_up(v);
  EXPECT_EQ(in_time.evidence.kind, Evidence::held_shaft);
  EXPECT_EQ(in_time.evidence.angle, in_time.end_crank_angle);
  EXPECT_GE(in_time.evidence.torque, drive * (1.0 - 1e-12));
  EXPECT_LE(in_time.evidence.torque, in_time.evidence.friction_torque);
  EXPECT_DOUBLE_EQ(in_time.evidence.friction_torque, 1.001 * drive);

  d.supply.voltage = 0.0;
  d.friction = {FrictionLaw::none, 0.0};
  EXPECT_EQ(simulate_start_up(resolve(d)).evidence.kind, Evidence::no_voltage);

  const Vehicle<double> flaps = resolve(direct_design());
  const SteadyFlapping response = find_steady_flapping(flaps);
  EXPECT_EQ(response.evidence.kind, Evidence::response);
  EXPECT_EQ(response.evidence.frequency, 22.0);
  EXPECT_EQ(response.evidence.stroke_amplitude, response.metrics[Metric::stroke_amplitude]);
  const TransientResult settled = simulate_start_up(flaps);
  EXPECT_EQ(settled.evidence.kind, Evidence::settled_periods);
  EXPECT_EQ(settled.evidence.cycles, settled.cycles);
  EXPECT_EQ(settled.evidence.time, settled.time_to_steady);
  const StatusEvidence early = simulate_start_up(flaps, limited(&TransientOptions::max_steps, 30)).evidence;
  EXPECT_EQ(early.kind, Evidence::out_of_steps);
  EXPECT_TRUE(early.direct);
  EXPECT_FALSE(early.range);
}

}  // namespace
}  // namespace wingbeat

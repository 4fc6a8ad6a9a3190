// Where cranks stand and jam, of every crank angle: against samples far finer than the intervals, and what the solvers
// make of it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/case_design.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {
namespace {

double drawn_over_decades(std::mt19937_64& random, double from, double to) {
  return std::exp(std::uniform_real_distribution<double>(std::log(from), std::log(to))(random));
}
double drawn_between(std::mt19937_64& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

/// Long cranks with small hinge offsets, four-bars and tables: what is narrow of them lies at any angle.
AnyTransmission<double> narrow_transmission(std::mt19937_64& random, int n) {
  AnyTransmission<double> t{};
  if (n % 3 == 0) {
    const double crank = drawn_over_decades(random, 1e-3, 4e-2), rod = crank * drawn_over_decades(random, 1.05, 8.0);
    t.slider_crank = {crank, rod, crank * drawn_over_decades(random, 0.03, 4.0),
                      rod + crank * drawn_between(random, -0.5, 0.5),
                      n % 2 == 0 ? Formulation::rod_force : Formulation::virtual_work};
  } else if (n % 3 == 1) {
    t.type = TransmissionType::four_bar;
    for (bool valid = false; !valid;) {
      t.four_bar = {drawn_over_decades(random, 1e-4, 5e-3), drawn_over_decades(random, 2e-3, 2e-2),
                    drawn_over_decades(random, 2e-3, 2e-2), drawn_over_decades(random, 2e-3, 2e-2),
                    drawn_over_decades(random, 0.3, 10.0)};
      try {
        validate(t.four_bar);
        t.four_bar.ground_angle = centred_ground_angle(t.four_bar);
        valid = true;
      } catch (const ParameterError&) {}
    }
  } else {
    t.type = TransmissionType::tabulated;
    const int rows = 5 + n % 20;
    std::vector<std::pair<double, double>> law;
    for (int k = 0; k < rows; ++k) {
      const double angle = two_pi * k / rows;
      law.emplace_back(angle + 0.3, std::sin(angle) + 0.01 * drawn_between(random, -1.0, 1.0));
    }
    t.tabulated = {std::make_shared<const StrokeCurve>(law), 1.3, 2e-3};
  }
  return t;
}

Vehicle<double> narrow_vehicle(std::mt19937_64& random, int n) {
  Vehicle<double> v = reference_vehicle();
  v.transmission = narrow_transmission(random, n);
  v.friction.radius = drawn_between(random, 0.0, 1.0) < 0.7 ? drawn_over_decades(random, 1e-5, 5e-3) : 0.0;
  v.friction.torque = drawn_between(random, 0.0, 1.0) < 0.3 ? drawn_over_decades(random, 1e-5, 1e-3) : 0.0;
  v.motor.friction_torque = drawn_between(random, 0.0, 1.0) < 0.3 ? drawn_over_decades(random, 1e-5, 1e-3) : 0.0;
  v.motor.gear_efficiency = drawn_between(random, 0.0, 1.0) < 0.3 ? drawn_between(random, 0.5, 1.0) : 1.0;
  v.spring.stiffness = drawn_over_decades(random, 1e-5, 1e-2);
  v.motor.inertia = drawn_over_decades(random, 1e-9, 1e-6);
  v.voltage = drawn_over_decades(random, 0.5, 10.0);
  return v;
}

/// Below the limit no sample is less than the value found; beyond it both are.
void expect_least_value(double found, double sampled, double limit, int n) {
  if (sampled < limit) {
    EXPECT_LE(found, sampled + 1e-12 * limit) << n;
  } else {
    EXPECT_GT(found, found < limit ? sampled - 1e-2 * limit : limit) << n;
  }
}

TEST(Statics, LeastValuesAreThoseOfEveryAngle) {
  std::mt19937_64 random(17);
  constexpr int samples = 4001;
  int locking = 0, jamming = 0;
  for (int n = 0; n < 150; ++n) {
    const Vehicle<double> v = narrow_vehicle(random, n);
    const StaticBalance statics = static_balance(v);
    double inertia = infinity, lever = infinity, advance = infinity;
    for (int k = 0; k < samples; ++k) {
      const double angle = two_pi * k / samples;
      const auto kinematics = crank_kinematics(v.transmission, std::sin(angle), std::cos(angle));
      lever = std::min(lever, kinematics.wing_jacobian);
      inertia = std::min(inertia, min_inertia(v, kinematics));
      advance = std::min(advance, advance_torque(v, angle));
    }
    expect_least_value(statics.lever_min, lever, 0.1 * typical_lever(v.transmission), n);
    if (!(lever > 0.0)) continue;
    expect_least_value(statics.inertia_min, inertia, 0.3 * v.motor.inertia, n);
    expect_least_value(statics.advance_min, advance, 0.2 * statics.stall_torque, n);
    locking += statics.can_lock();
    jamming += statics.can_jam();
  }
  EXPECT_GT(locking, 20);
  EXPECT_GT(jamming, 10);
}

/// Every sample that friction holds lies in an interval, and none other does.
void expect_all_locks(const Vehicle<double>& v, int n) {
  const std::vector<LockInterval> locks = lock_intervals(v);
  constexpr int samples = 2003;
  for (int k = 0; k < samples; ++k) {
    const double angle = two_pi * k / samples;
    const bool locked = std::any_of(locks.begin(), locks.end(), [&](const LockInterval& lock) {
      return (lock.from <= angle && angle <= lock.to) || (lock.from <= angle + two_pi && angle + two_pi <= lock.to);
    });
    EXPECT_EQ(locked, lock_margin(v, angle) >= 0.0) << n << " at " << angle;
  }
  for (const LockInterval& lock : locks) {
    EXPECT_LE(lock.from, lock.to);
    EXPECT_GE(lock.margin, 0.0);
  }
}

TEST(Statics, LockIntervalsAreAllThereAre) {
  std::mt19937_64 random(18);
  for (int n = 0, seen = 0; seen < 24; ++n) {
    const Vehicle<double> v = narrow_vehicle(random, n);
    const StaticBalance statics = static_balance(v);
    if (statics.lever_min <= 0.0 || !statics.can_lock()) continue;
    ++seen;
    expect_all_locks(v, n);
  }
}

TEST(Statics, AnIntervalOfAMillionthOfAnAngle) {
  // The stall torque is just what springs and friction hold at most, less a trillionth.
  Vehicle<double> v = resolve(case_design("locks-at-26-deg"));
  const StaticBalance before = static_balance(v);
  v.voltage *= (before.stall_torque - before.advance_min) * (1.0 - 1e-12) / before.stall_torque;
  EXPECT_TRUE(static_balance(v).can_lock());
  const std::vector<LockInterval> locks = lock_intervals(v);
  ASSERT_FALSE(locks.empty());
  for (const LockInterval& lock : locks) EXPECT_LT(lock.to - lock.from, 0.01);
  v.voltage *= 1.0 + 1e-10;
  EXPECT_FALSE(static_balance(v).can_lock());
  EXPECT_TRUE(lock_intervals(v).empty());
}

TEST(Statics, SpringsAloneBalanceAtSingleAngles) {
  Vehicle<double> v = reference_vehicle(true);
  v.friction.radius = 0.0;
  v.spring.stiffness *= 10.0;
  const std::vector<LockInterval> locks = lock_intervals(v);
  ASSERT_EQ(locks.size(), 4u);
  for (const LockInterval& lock : locks) {
    EXPECT_EQ(lock.from, lock.to);
    EXPECT_NEAR(lock_margin(v, lock.angle), 0.0, 1e-15);
  }
}

TEST(Statics, NearestJamsOnEitherSide) {
  // Where friction's lever outweighs the wings', beside the dead centres alone: no grid shows how closely.
  Vehicle<double> v = reference_vehicle();
  v.friction.radius = 2e-4;
  const auto least = [&] {
    Vehicle<double> light = v;
    light.motor.inertia = 1e-15;
    return light.motor.inertia - static_balance(light).inertia_min;
  };
  v.motor.inertia = least() * (1.0 - 1e-9);
  ASSERT_TRUE(static_balance(v).can_jam());
  const JamAngles jams = nearest_jams(v, 0.0, 0.0);
  ASSERT_TRUE(std::isfinite(jams.above));
  ASSERT_TRUE(std::isfinite(jams.below));
  EXPECT_NEAR(uniqueness(v, jams.above), 0.0, 1e-8);
  EXPECT_NEAR(uniqueness(v, jams.below), 0.0, 1e-8);
  EXPECT_GT(jams.above, 0.0);
  EXPECT_LT(jams.below, 0.0);
  for (int k = 1; k < 1000; ++k) EXPECT_GT(uniqueness(v, jams.above * k / 1000.0), 0.0) << k;
  v.motor.inertia *= 1.0 + 1e-6;
  EXPECT_FALSE(static_balance(v).can_jam());
  EXPECT_EQ(nearest_jams(v, 0.0, 0.0).above, infinity);
}

SteadyFlapping decided_by_orbit(const Vehicle<double>& v) { return find_steady_flapping(v, {}, start_up_in_time()); }

FlappingStatus status_in_batch(const Vehicle<double>& v) {
  const EnsembleMember member{v, {}};
  EnsembleOutcome outcome;
  solve_ensemble({&member, 1}, {}, start_up_in_time(), {&outcome, 1});
  return outcome.status;
}

TEST(Statics, ACrankThatANarrowIntervalHoldsIsLockedByEveryMethod) {
  const Vehicle<double> v = resolve(case_design("locks-at-26-deg"));
  const SteadyFlapping orbit = decided_by_orbit(v);
  ASSERT_EQ(orbit.status, FlappingStatus::locked) << describe(orbit.evidence);
  EXPECT_NEAR(orbit.evidence.angle * degrees_per_radian, 25.94, 0.01);
  const TransientResult in_time = simulate_start_up(v);
  ASSERT_EQ(in_time.status, FlappingStatus::locked) << describe(in_time.evidence);
  EXPECT_NEAR(*in_time.lock_angle * degrees_per_radian, 25.94, 0.01);
  EXPECT_EQ(status_in_batch(v), FlappingStatus::locked);
  ASSERT_EQ(lock_intervals(v).size(), 4u);
}

TEST(Statics, AStallComesBeforeAJamByEveryMethod) {
  const Vehicle<double> v = resolve(case_design("stalled-and-jammed"));
  ASSERT_TRUE(static_balance(v).stalled());
  ASSERT_TRUE(static_balance(v).can_jam());
  EXPECT_EQ(decided_by_orbit(v).status, FlappingStatus::stalled);
  const TransientResult in_time = simulate_start_up(v);
  EXPECT_EQ(in_time.status, FlappingStatus::stalled) << describe(in_time.evidence);
  EXPECT_FALSE(in_time.jam_angle);
  EXPECT_EQ(status_in_batch(v), FlappingStatus::stalled);
}

}  // namespace
}  // namespace wingbeat

#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "time/free_decay.hpp"
#include "vehicle/any_start.hpp"
#include "vehicle/known_orbits.hpp"
#include "vehicle/reference_vehicle.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;
using Event = TransientEvent::Kind;

void expect_relative(double value, double expected, double tolerance, const char* what) {
  EXPECT_NEAR(value / expected, 1.0, tolerance) << what << ": " << value << ", expected " << expected;
}

TransientOptions with_tolerance(double tolerance) {
  TransientOptions options;
  options.tolerance = tolerance;
  return options;
}

double audit_residual(const Metrics<double>& m) {
  return (m[Metric::power_copper] + m[Metric::power_viscous] + m[Metric::power_motor_friction] +
          m[Metric::power_friction] + m[Metric::power_aerodynamic] + m[Metric::power_residual]) /
             m[Metric::power_electrical] -
         1.0;
}

class KnownOrbits : public testing::TestWithParam<KnownOrbit> {};

TEST_P(KnownOrbits, IsReachedFromRest) {
  const KnownOrbit& orbit = GetParam();
  TransientOptions options = with_tolerance(1e-9);
  options.record = true;
  const TransientResult r = simulate_start_up(reference_vehicle(orbit.springs), options);
  ASSERT_EQ(r.status, FlappingStatus::flapping) << describe(r.evidence);
  EXPECT_TRUE(r.settled);
  ASSERT_TRUE(r.metrics);
  const Metrics<double>& m = *r.metrics;
  expect_relative(m[Metric::frequency], orbit.frequency, 1e-9, "frequency");
  expect_relative(m[Metric::power_electrical], orbit.power_electrical, 1e-9, "electrical power");
  expect_relative(m[Metric::lift_mean], orbit.lift_mean, 1e-9, "lift");
  expect_relative(m[Metric::rod_force_mean], orbit.rod_force_mean, 1e-9, "rod force, mean");
  expect_relative(m[Metric::rod_force_peak], orbit.rod_force_peak, 1e-9, "rod force, peak");
  EXPECT_TRUE(std::isnan(m[Metric::floquet_multiplier_max]));

  // A step of the measured cycle ends at each dead centre.
  double nearest = 1.0;
  TransientSample lower{};
  for (const TransientSample& s : r.samples) {
    const double distance = std::abs(s.crank_angle - (two_pi * r.cycles - 0.5 * pi));
    if (distance < nearest) {
      nearest = distance;
      lower = s;
    }
  }
  EXPECT_LT(nearest, 1e-11);
  expect_relative(lower.crank_speed, orbit.crank_speed, 1e-8, "speed at the lower dead centre");
  expect_relative(lower.current, orbit.current, 1e-8, "current at the lower dead centre");

  int kinks = 0;
  for (const TransientEvent& e : r.events) {
    if (e.kind != Event::force_sign_change || e.crank_angle < two_pi * (r.cycles - 1)) continue;
    ++kinks;
    const double angle = wrap_angle(e.crank_angle);
    EXPECT_LT(std::min(std::abs(angle - orbit.kinks[0]), std::abs(angle - orbit.kinks[1])), 1e-8);
  }
  EXPECT_EQ(kinks, 2);
}

TEST_P(KnownOrbits, ErrorsStayBelowTheToleranceAskedFor) {
  const KnownOrbit& orbit = GetParam();
  for (const double tolerance : {1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10}) {
    const TransientResult r = simulate_start_up(reference_vehicle(orbit.springs), with_tolerance(tolerance));
    ASSERT_TRUE(r.settled && r.metrics) << describe(r.evidence);
    const Metrics<double>& m = *r.metrics;
    expect_relative(m[Metric::frequency], orbit.frequency, tolerance, "frequency");
    expect_relative(m[Metric::power_electrical], orbit.power_electrical, tolerance, "electrical power");
    expect_relative(m[Metric::lift_mean], orbit.lift_mean, tolerance, "lift");
    expect_relative(m[Metric::rod_force_mean], orbit.rod_force_mean, tolerance, "rod force, mean");
    expect_relative(m[Metric::rod_force_peak], orbit.rod_force_peak, tolerance, "rod force, peak");
    EXPECT_NEAR(audit_residual(m), 0.0, tolerance);
  }
}

TEST_P(KnownOrbits, IsItsOwnContinuation) {
  const Vehicle<double> v = reference_vehicle(GetParam().springs);
  const TransientResult first = simulate_start_up(v, with_tolerance(1e-9));
  TransientOptions options = with_tolerance(1e-9);
  options.start.speed = first.crank_speed;
  options.start.current = first.current;
  const TransientResult again = simulate_start_up(v, options);
  ASSERT_TRUE(again.settled) << describe(again.evidence);
  EXPECT_EQ(again.time_to_steady, 0.0);
  expect_relative(again.crank_speed, first.crank_speed, 2e-9, "speed");
  expect_relative(again.current, first.current, 2e-9, "current");
}

INSTANTIATE_TEST_SUITE_P(Transient, KnownOrbits, testing::ValuesIn(known_orbits),
                         [](const auto& orbit) { return orbit.param.springs ? "Springs" : "NoSprings"; });

TEST(Transient, VirtualWorkHasNoResidualPower) {
  Vehicle<double> v = reference_vehicle(true);
  v.transmission.slider_crank.formulation = Formulation::virtual_work;
  const TransientResult r = simulate_start_up(v, with_tolerance(1e-9));
  ASSERT_TRUE(r.settled && r.metrics) << describe(r.evidence);
  EXPECT_NEAR((*r.metrics)[Metric::power_residual], 0.0, 1e-14);
  EXPECT_NEAR(audit_residual(*r.metrics), 0.0, 1e-9);
}

TEST(Transient, PeaksAreMaximaNotSamples) {
  TransientOptions options = with_tolerance(1e-9);
  options.record = true;
  options.record_interval = 1e-6;
  const TransientResult r = simulate_start_up(reference_vehicle(), options);
  ASSERT_TRUE(r.metrics);
  double fastest = 0.0, slowest = 1e9, current = 0.0, inrush = 0.0, inrush_time = 0.0;
  for (const TransientSample& s : r.samples) {
    if (s.current > inrush) inrush = s.current, inrush_time = s.time;
    if (s.crank_angle < two_pi * (r.cycles - 1)) continue;
    fastest = std::max(fastest, s.crank_speed);
    slowest = std::min(slowest, s.crank_speed);
    current = std::max(current, s.current);
  }
  const Metrics<double>& m = *r.metrics;
  // A maximum lies above its samples by the curvature over the sampling interval squared: below 1e-6 of it here.
  EXPECT_GE(m[Metric::crank_speed_max], fastest * (1.0 - 1e-10));
  expect_relative(m[Metric::crank_speed_max], fastest, 1e-6, "highest speed");
  EXPECT_LE(m[Metric::crank_speed_min], slowest * (1.0 + 1e-10));
  expect_relative(m[Metric::crank_speed_min], slowest, 1e-6, "lowest speed");
  EXPECT_GE(m[Metric::current_peak], current * (1.0 - 1e-10));
  expect_relative(m[Metric::current_peak], current, 1e-6, "peak current");
  EXPECT_GE(r.inrush_current, inrush);
  expect_relative(r.inrush_current, inrush, 1e-6, "inrush current");
  EXPECT_NEAR(r.inrush_current_time, inrush_time, 2e-6);
}

TEST(Transient, WinglessReachesTheNoLoadSpeed) {
  for (const double inductance : {29e-3, 1e-4, 0.0}) {
    Vehicle<double> v = wingless_vehicle();
    v.motor.armature_inductance = inductance;
    const TransientResult r = simulate_start_up(v, with_tolerance(1e-9));
    ASSERT_TRUE(r.settled && r.metrics) << describe(r.evidence);
    const double omega = no_load_speed(v.motor, v.voltage);
    expect_relative(two_pi * (*r.metrics)[Metric::frequency], omega, 2e-9, "speed");
    expect_relative((*r.metrics)[Metric::crank_speed_min], omega, 1e-8, "lowest speed");
    expect_relative((*r.metrics)[Metric::current_mean], omega * v.motor.viscous_damping / v.motor.torque_constant, 2e-9,
                    "current");
    EXPECT_EQ((*r.metrics)[Metric::rod_force_peak], 0.0);
  }
}

TEST(Transient, SmallInductanceApproachesNone) {
  Vehicle<double> v = reference_vehicle(true);
  v.motor.armature_inductance = 0.0;
  const TransientResult none = simulate_start_up(v, with_tolerance(1e-8));
  ASSERT_TRUE(none.settled && none.metrics) << describe(none.evidence);
  EXPECT_FALSE(none.stiff);
  EXPECT_NEAR(audit_residual(*none.metrics), 0.0, 1e-8);
  EXPECT_DOUBLE_EQ(none.inrush_current, v.voltage / v.motor.armature_resistance);

  v.motor.armature_inductance = 1e-8;  // L_a / R_a = 1 ns
  const TransientResult small = simulate_start_up(v, with_tolerance(1e-8));
  ASSERT_TRUE(small.settled && small.metrics) << describe(small.evidence);
  EXPECT_TRUE(small.stiff);
  EXPECT_LT(small.steps, 50000);
  for (const Metric metric : {Metric::frequency, Metric::power_electrical, Metric::lift_mean, Metric::rod_force_peak}) {
    expect_relative((*small.metrics)[metric], (*none.metrics)[metric], 5e-7, metric_table()[std::size_t(metric)].key);
  }
  EXPECT_NEAR(audit_residual(*small.metrics), 0.0, 1e-8);
}

TEST(Transient, WeakDampingConverges) {
  // A hundredfold rotor: cycles contract by some ten per cent only.
  Vehicle<double> v = reference_vehicle();
  v.motor.inertia = 1.5e-5;
  const TransientResult jumped = simulate_start_up(v, with_tolerance(1e-8));
  TransientOptions options = with_tolerance(1e-8);
  options.record = true;  // no extrapolation then
  const TransientResult patient = simulate_start_up(v, options);
  ASSERT_TRUE(jumped.settled && jumped.metrics) << describe(jumped.evidence);
  ASSERT_TRUE(patient.settled && patient.metrics) << describe(patient.evidence);
  EXPECT_LT(jumped.cycles, patient.cycles);
  for (const Metric metric : {Metric::frequency, Metric::power_electrical, Metric::lift_mean, Metric::rod_force_peak}) {
    expect_relative((*jumped.metrics)[metric], (*patient.metrics)[metric], 2e-8,
                    metric_table()[std::size_t(metric)].key);
  }
  EXPECT_DOUBLE_EQ(jumped.time_to_steady, patient.time_to_steady);
}

TEST(Transient, StallsWhereFrictionExceedsTheStallTorque) {
  Vehicle<double> v = reference_vehicle();
  v.motor.friction_torque = 3.4e-3;  // stall torque K V / R_a = 3.33e-3 N m
  const TransientResult r = simulate_start_up(v);
  EXPECT_EQ(r.status, FlappingStatus::stalled);
  EXPECT_TRUE(r.settled);
  EXPECT_THAT(describe(r.evidence), HasSubstr("0.003333"));
  EXPECT_EQ(r.cycles, 0);
  EXPECT_FALSE(r.metrics);
  ASSERT_TRUE(r.lock_angle && r.torque_margin);
  EXPECT_EQ(*r.lock_angle, 0.0);
  EXPECT_NEAR(*r.torque_margin, 3.4e-3 - 0.01 * 3.0 / 9.0, 1e-15);

  v.motor.friction_torque = 3.3e-3;
  TransientOptions options;
  options.tolerance = 1e-10;
  const TransientResult starts = simulate_start_up(v, options);
  EXPECT_NE(starts.status, FlappingStatus::stalled) << describe(starts.evidence);
  // The current must first rise to the friction torque: i(t) = v / R_a (1 - exp(-t R_a / L_a)).
  ASSERT_FALSE(starts.events.empty());
  EXPECT_EQ(starts.events[0].kind, Event::breakaway);
  EXPECT_NEAR(starts.events[0].time, -29e-3 / 9.0 * std::log1p(-3.3e-3 / (0.01 * 3.0 / 9.0)), 1.5e-12);
}

TEST(Transient, WithoutVoltageNothingMoves) {
  Vehicle<double> v = reference_vehicle(true);
  v.voltage = 0.0;
  EXPECT_EQ(simulate_start_up(v).status, FlappingStatus::stalled);
  EXPECT_EQ(simulate_start_up(wingless_vehicle(),
                              [] {
                                TransientOptions o;
                                o.supply = Supply<double>{SupplyType::pwm, 3.0, 1000.0, 0.0};
                                return o;
                              }())
                .status,
            FlappingStatus::stalled);
}

double static_torque(const Vehicle<double>& v, double theta, double i) {
  const CrankKinematics<double> k = crank_kinematics(v.transmission, std::sin(theta), std::cos(theta));
  return v.motor.torque_constant * i -
         v.wing_count * v.spring.stiffness * stroke_angle(k) / k.wing_jacobian * k.crank_jacobian;
}

TEST(Transient, LocksAgainstStrongSpringsAndFriction) {
  Vehicle<double> v = reference_vehicle();
  v.spring.stiffness = 0.02;
  const TransientResult r = simulate_start_up(v);
  ASSERT_EQ(r.status, FlappingStatus::locked) << describe(r.evidence);
  EXPECT_TRUE(r.settled);
  ASSERT_TRUE(r.lock_angle && r.torque_margin);
  const CrankKinematics<double> k = crank_kinematics(v.transmission, std::sin(*r.lock_angle), std::cos(*r.lock_angle));
  const double F_s = v.wing_count * v.spring.stiffness * stroke_angle(k) / k.wing_jacobian;
  const double margin = v.friction.radius * std::abs(F_s) - std::abs(static_torque(v, *r.lock_angle, 3.0 / 9.0));
  EXPECT_GT(margin, 0.0);
  EXPECT_NEAR(*r.torque_margin, margin, 1e-12);
  EXPECT_THAT(describe(r.evidence), HasSubstr("rests at crank angle"));
}

TEST(Transient, SpiralsIntoAnEquilibriumWithoutFriction) {
  for (const double inductance : {29e-3, 0.0}) {
    Vehicle<double> v = reference_vehicle();
    v.friction.radius = 0.0;
    v.motor.armature_inductance = inductance;
    v.spring.stiffness = 0.02;
    const TransientResult r = simulate_start_up(v);
    ASSERT_EQ(r.status, FlappingStatus::locked) << describe(r.evidence);
    EXPECT_TRUE(r.settled);
    ASSERT_TRUE(r.lock_angle);
    EXPECT_NEAR(static_torque(v, *r.lock_angle, 3.0 / 9.0), 0.0, 1e-10);
    EXPECT_THAT(describe(r.evidence), HasSubstr("stable equilibrium"));
  }
}

TEST(Transient, CreepingToRestIsRecognised) {
  // Overdamped: the crank nears the edge of the friction band exponentially and never stands still.
  Vehicle<double> v = reference_vehicle();
  v.spring.stiffness = 0.02;
  v.friction.damping = 1e-2;
  const TransientResult r = simulate_start_up(v);
  ASSERT_EQ(r.status, FlappingStatus::locked) << describe(r.evidence);
  EXPECT_TRUE(r.settled);
  EXPECT_NEAR(*r.torque_margin, 0.0, 1e-9);
}

TEST(Transient, JamsWhereTheRotorIsTooLight) {
  Vehicle<double> v = reference_vehicle();
  v.motor.inertia = 1e-9;
  v.friction.radius = 3e-3;
  const TransientResult r = simulate_start_up(v);
  ASSERT_EQ(r.status, FlappingStatus::jammed) << describe(r.evidence);
  EXPECT_TRUE(r.settled);
  ASSERT_TRUE(r.jam_angle);
  const CrankKinematics<double> k = crank_kinematics(v.transmission, std::sin(*r.jam_angle), std::cos(*r.jam_angle));
  EXPECT_NEAR(effective_inertia(v, k, -1.0) / v.motor.inertia, 0.0, 1e-5);
  EXPECT_EQ(r.events.back().kind, Event::jam);
  EXPECT_THAT(describe(r.evidence), HasSubstr("jams at crank angle"));
  EXPECT_GT(r.end_time, 0.0);

  v.friction.radius = 6e-3;  // longer than the crank: jammed where it stands
  const TransientResult start = simulate_start_up(v);
  EXPECT_EQ(start.status, FlappingStatus::jammed);
  EXPECT_EQ(start.end_time, 0.0);
}

TEST(Transient, FreeDecayAgainstConstantFriction) {
  for (const double omega_0 : {400.0, -400.0}) {
    const FreeDecay exact(omega_0);
    TransientOptions options = with_tolerance(1e-10);
    options.start.speed = omega_0;
    const TransientResult r = simulate_start_up(exact.vehicle, options);
    EXPECT_EQ(r.status, FlappingStatus::stalled) << describe(r.evidence);
    EXPECT_TRUE(r.settled);
    EXPECT_NEAR(r.end_time / exact.end_time, 1.0, 1e-9);
    EXPECT_NEAR(r.end_crank_angle / exact.end_crank_angle, 1.0, 1e-9);
  }
}

TEST(Transient, FastPwmApproachesItsMeanVoltage) {
  const TransientResult mean = simulate_start_up(reference_vehicle(true));
  double previous = 1.0;
  for (const double frequency : {500.0, 5000.0}) {
    TransientOptions options;
    options.supply = Supply<double>{SupplyType::pwm, 4.0, frequency, 0.75};
    const TransientResult r = simulate_start_up(reference_vehicle(true), options);
    ASSERT_EQ(r.status, FlappingStatus::flapping) << describe(r.evidence);
    EXPECT_TRUE(r.settled);
    ASSERT_TRUE(r.metrics);
    EXPECT_GT(r.averaged_cycles, 1);
    const double difference = std::abs((*r.metrics)[Metric::frequency] / (*mean.metrics)[Metric::frequency] - 1.0);
    EXPECT_LT(difference, previous);
    previous = difference;
  }
  EXPECT_LT(previous, 1e-4);
}

TEST(Transient, PwmWithoutInductanceSwitchesTheCurrent) {
  Vehicle<double> v = reference_vehicle();
  v.motor.armature_inductance = 0.0;
  TransientOptions options;
  options.supply = Supply<double>{SupplyType::pwm, 4.0, 2000.0, 0.75};
  options.record = true;
  const TransientResult r = simulate_start_up(v, options);
  ASSERT_EQ(r.status, FlappingStatus::flapping) << describe(r.evidence);
  EXPECT_NEAR(r.inrush_current, 4.0 / 9.0, 1e-12);
  // While switched off, the motor brakes: its current is -K omega / R_a.
  double lowest = 0.0;
  for (const TransientSample& s : r.samples) lowest = std::min(lowest, s.current);
  EXPECT_LT(lowest, -0.1);
}

TEST(Transient, SineOnACrankEndsHonestly) {
  for (const double frequency : {5.0, 22.0, 150.0}) {
    TransientOptions options;
    options.supply = Supply<double>{SupplyType::sine, 3.0, frequency, 1.0};
    const TransientResult r = simulate_start_up(reference_vehicle(true), options);
    EXPECT_FALSE(describe(r.evidence).empty());
    EXPECT_TRUE(std::isfinite(r.end_crank_angle));
    EXPECT_LE(r.steps, 1000001);
  }
}

TEST(Transient, ASineBreaksTheCrankAwayBetweenTwoLooks) {
  // A stuck crank is looked at 64 times a period; the moment in between is found, and no sample lies about what
  // follows.
  Vehicle<double> v = reference_vehicle();
  v.motor.armature_inductance = 0.0;
  v.friction.torque = 0.4 * stall_torque(v);
  const double frequency = 5.0, amplitude = 3.0;
  TransientOptions options;
  options.supply = Supply<double>{SupplyType::sine, amplitude, frequency, 1.0};
  options.record = true;
  options.record_interval = 1e-4;
  options.max_time = 0.05;
  const TransientResult r = simulate_start_up(v, options);
  const auto breakaway = std::find_if(r.events.begin(), r.events.end(),
                                      [](const TransientEvent& e) { return e.kind == Event::breakaway; });
  ASSERT_NE(breakaway, r.events.end());
  // Without springs and inductance K v(t) / R_a = T_c.
  EXPECT_NEAR(breakaway->time, std::asin(0.4) / (two_pi * frequency), 1e-12);
  int moving = 0;
  for (const TransientSample& s : r.samples) {
    if (s.time < breakaway->time) {
      EXPECT_EQ(s.crank_speed, 0.0);
    } else if (s.time < breakaway->time + 1.0 / (64.0 * frequency)) {
      EXPECT_GT(s.crank_speed, 0.0) << s.time;
      ++moving;
    }
  }
  EXPECT_GE(moving, 30);
}

TEST(Transient, BudgetsEndUnsettled) {
  TransientOptions options;
  options.max_time = 0.02;
  const TransientResult short_time = simulate_start_up(reference_vehicle(), options);
  EXPECT_FALSE(short_time.settled);
  EXPECT_DOUBLE_EQ(short_time.end_time, 0.02);
  EXPECT_THAT(describe(short_time.evidence), HasSubstr("no decision within 0.02 s"));

  options = {};
  options.max_cycles = 2;
  const TransientResult few_cycles = simulate_start_up(reference_vehicle(), options);
  EXPECT_FALSE(few_cycles.settled);
  EXPECT_EQ(few_cycles.cycles, 2);
  EXPECT_EQ(few_cycles.status, FlappingStatus::undecided);

  options = {};
  options.max_steps = 100;
  EXPECT_THAT(describe(simulate_start_up(reference_vehicle(), options).evidence), HasSubstr("100 integration steps"));

  options = {};
  options.cancel = [] { return true; };
  const TransientResult cancelled = simulate_start_up(reference_vehicle(), options);
  EXPECT_FALSE(cancelled.settled);
  EXPECT_THAT(describe(cancelled.evidence), HasSubstr("cancelled"));
}

TEST(Transient, RunawayIsNamed) {
  // Turned backwards, "rod-force" can feed the crank more power than all losses take.
  Vehicle<double> v = reference_vehicle();
  v.voltage = 0.02;
  v.motor = {10.7, 0.0, 1.7e-3, 2.5e-6, 3.6e-5};
  v.transmission.slider_crank = {4.09e-3, 7.52e-3, 2.68e-3, 7.52e-3, Formulation::rod_force};
  v.friction.radius = 1.7e-4;
  v.spring.stiffness = 9.6e-4;
  v.wing_inertia = 2.83e-7;
  v.wings.air_density = 0.0;
  TransientOptions options;
  options.start.speed = -499.0;
  const TransientResult r = simulate_start_up(v, options);
  EXPECT_FALSE(r.settled);
  EXPECT_THAT(describe(r.evidence), HasSubstr("speeds up without bound"));
}

TEST(Transient, SamplesAtTheIntervalAskedFor) {
  TransientOptions options;
  options.record = true;
  options.record_interval = 1e-3;
  const TransientResult r = simulate_start_up(reference_vehicle(), options);
  ASSERT_GT(r.samples.size(), 100u);
  for (std::size_t k = 0; k < r.samples.size(); ++k) {
    EXPECT_NEAR(r.samples[k].time, 1e-3 * double(k), 1e-12);
    if (k > 0) {
      EXPECT_GE(r.samples[k].crank_angle, r.samples[k - 1].crank_angle);
    }
  }
}

TEST(Transient, RejectsParametersOutOfRange) {
  Vehicle<double> v = reference_vehicle();
  v.motor.armature_resistance = -9.0;
  try {
    simulate_start_up(v);
    FAIL();
  } catch (const ParameterError& e) {
    EXPECT_STREQ(e.what(), "motor.armature_resistance: must be > 0 [ohm], got -9");
  }
  v = reference_vehicle();
  v.voltage = std::nan("");
  EXPECT_THROW(simulate_start_up(v), ParameterError);
  EXPECT_THROW(simulate_start_up(reference_vehicle(), with_tolerance(0.0)), ParameterError);
  TransientOptions options;
  options.start.speed = std::numeric_limits<double>::infinity();
  EXPECT_THROW(simulate_start_up(reference_vehicle(), options), ParameterError);
}

TEST(Transient, AnyVehicleEndsWithFiniteNumbers) {
  int flapping = 0, settled = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const auto [v, options] = any_start(seed);
    const TransientResult r = simulate_start_up(v, options);
    SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << describe(r.evidence));
    EXPECT_FALSE(describe(r.evidence).empty());
    EXPECT_LE(r.steps, options.max_steps + 1);
    for (const double x : {r.end_time, r.end_crank_angle, r.time_to_steady, r.inrush_current, r.inrush_current_time,
                           r.crank_speed, r.current, r.cycle_scatter}) {
      EXPECT_TRUE(std::isfinite(x));
    }
    for (const std::optional<double>& x : {r.lock_angle, r.torque_margin, r.jam_angle}) {
      EXPECT_TRUE(!x || std::isfinite(*x));
    }
    settled += r.settled;
    EXPECT_EQ(r.metrics.has_value(), r.metrics && r.status == FlappingStatus::flapping);
    if (!r.metrics) continue;
    ++flapping;
    for (int k = 0; k <= int(Metric::crank_speed_max); ++k) {
      if (Metric(k) == Metric::power_motor_reference || Metric(k) == Metric::power_electronics) continue;
      EXPECT_TRUE(std::isfinite(r.metrics->values[std::size_t(k)])) << metric_table()[std::size_t(k)].key;
    }
    if (!options.supply) {
      EXPECT_NEAR(audit_residual(*r.metrics), 0.0, 1e-5);
    }
  }
  EXPECT_GT(flapping, 20);
  EXPECT_GT(settled, 85);
}

}  // namespace
}  // namespace wingbeat

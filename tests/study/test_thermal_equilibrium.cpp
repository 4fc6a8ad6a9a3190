// The motor's temperatures in steady flapping: closed forms, expected sizes, runaway, the same answer in time.
#include "wingbeat/cycle/thermal_equilibrium.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;

/// An 0816-size motor: 20 K/W and 48 K/W.
Design<double> warm_design(double voltage = 3.0) {
  Design<double> d = reference_design();
  d.supply.voltage = voltage;
  d.motor.thermal.resistance_winding = 20.0;
  d.motor.thermal.resistance_case = 48.0;
  return d;
}

SteadyFlapping flapping_of(const Design<double>& d, double tolerance = 1e-9) {
  return find_steady_flapping(resolve(d), {.tolerance = tolerance, .reporting = reporting_of(d)}, start_up_in_time());
}

/// Drives the search with a held current of mean square i2.
ThermalEquilibrium under_held_current(const MotorThermal<double>& thermal, double i2) {
  ThermalEquilibrium search(thermal, 1e-12);
  const Motor<double> motor = reference_design().motor.constants;
  Metrics<double> m;
  do {
    const double R = at_temperatures(motor, thermal, search.at()).armature_resistance;
    const MotorTemperatures<double> T = settled_temperatures(thermal, R * i2, 0.0);
    m[Metric::winding_temperature] = T.winding - zero_celsius;
    m[Metric::case_temperature] = T.casing - zero_celsius;
  } while (!search.advance(true, m));
  return search;
}

TEST(ThermalEquilibrium, HeldCurrentHasAClosedForm) {
  const MotorThermal<double> thermal = resolve(warm_design()).thermal;
  const double R_th = 68.0, R_0 = 9.0, a_Cu = 0.0039, T_amb = thermal.ambient_temperature;
  for (const double feedback : {0.01, 0.1, 0.5, 0.7}) {
    const double i2 = feedback / (a_Cu * R_th * R_0);
    const ThermalEquilibrium search = under_held_current(thermal, i2);
    EXPECT_EQ(search.outcome(), ThermalOutcome::settled) << feedback;
    EXPECT_NEAR(search.at().winding - T_amb, R_th * R_0 * i2 / (1.0 - feedback), 1e-8) << feedback;
    EXPECT_LE(search.solutions(), 4) << feedback;  // a linear law: the first secant is exact
  }
  for (const double feedback : {0.95, 1.0, 1.5}) {  // at 0.95 the winding would settle above copper's melting point
    EXPECT_EQ(under_held_current(thermal, feedback / (a_Cu * R_th * R_0)).outcome(), ThermalOutcome::runaway);
  }
}

TEST(ThermalEquilibrium, LossesThatJumpDoNotSettle) {
  ThermalEquilibrium search(resolve(warm_design()).thermal, 1e-9);
  FlappingStatus status = FlappingStatus::flapping;
  StatusEvidence evidence;
  Metrics<double> m;
  m.values.fill(absent);
  do {
    // Below 60 degC they lead to 120 degC, above to 30 degC.
    m[Metric::winding_temperature] = search.at().winding < 60.0 + zero_celsius ? 120.0 : 30.0;
    m[Metric::case_temperature] = 0.5 * (m[Metric::winding_temperature] + 25.0);
  } while (!search.advance(true, m));
  EXPECT_EQ(search.outcome(), ThermalOutcome::does_not_settle);
  EXPECT_FALSE(conclude(search, status, evidence));
  EXPECT_EQ(status, FlappingStatus::undecided);
  EXPECT_EQ(evidence.kind, StatusEvidence::Kind::no_steady_temperature);
  EXPECT_NEAR(evidence.winding_temperature, 60.0, 1.0);
}

TEST(ThermalEquilibrium, WinglessMotorSettlesWhereItsClosedFormDoes) {
  Design<double> d = warm_design(5.0);
  d.friction = {FrictionLaw::constant, 1e-3};
  d.motor.thermal.magnet_temperature_coefficient = -0.001;
  Vehicle<double> v = resolve(d, Condition::wingless);
  const SteadyFlapping found = find_steady_flapping(v, {.tolerance = 1e-11}, start_up_in_time());
  ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
  // K i = b omega + T_c and v = R i + K omega; plain iteration of the two temperatures.
  MotorTemperatures<double> T{298.15, 298.15};
  double omega = 0.0;
  for (int n = 0; n < 200; ++n) {
    const Motor<double> m = at_temperatures(v.motor, v.thermal, T);
    const double K = m.torque_constant, R = m.armature_resistance, b = m.viscous_damping;
    omega = (K * 5.0 - R * 1e-3) / (K * K + R * b);
    const double i = (b * omega + 1e-3) / K;
    T = settled_temperatures(v.thermal, R * i * i, b * omega * omega);
  }
  EXPECT_GT(T.winding, 298.15 + 5.0);
  EXPECT_NEAR(found.metrics[Metric::winding_temperature] + zero_celsius, T.winding, 1e-7);
  EXPECT_NEAR(found.metrics[Metric::case_temperature] + zero_celsius, T.casing, 1e-7);
  EXPECT_NEAR(found.metrics[Metric::frequency] / (omega / two_pi), 1.0, 1e-9);
}

TEST(ThermalEquilibrium, ReferenceVehicleLosesLiftAsExpected) {
  // docs/model.md section 11: about 20 K and -8 % of lift at 3 V, about 60 K and -24 % at 5 V.
  const struct {
    double voltage, rise, lift;
  } expected[] = {{3.0, 20.0, -0.08}, {5.0, 60.0, -0.24}};
  for (const auto& e : expected) {
    Design<double> cold = reference_design();
    cold.supply.voltage = e.voltage;
    const SteadyFlapping before = flapping_of(cold), after = flapping_of(warm_design(e.voltage));
    ASSERT_EQ(after.status, FlappingStatus::flapping);
    EXPECT_TRUE(std::isnan(before.metrics[Metric::winding_temperature]));
    EXPECT_NEAR(after.metrics[Metric::winding_temperature] - 25.0, e.rise, 0.15 * e.rise);
    EXPECT_NEAR(after.metrics[Metric::lift_mean] / before.metrics[Metric::lift_mean] - 1.0, e.lift, 0.2 * -e.lift);
  }
}

TEST(ThermalEquilibrium, LossesLeadToTheTemperaturesTheyWereComputedAt) {
  for (const double tolerance : {1e-6, 1e-9}) {
    Design<double> d = warm_design(4.0);
    d.motor.thermal.magnet_temperature_coefficient = -0.0011;
    d.motor.thermal.ambient_temperature = 310.0;
    d.motor.constants.friction_torque = 2e-4;
    const SteadyFlapping found = flapping_of(d, tolerance);
    ASSERT_EQ(found.status, FlappingStatus::flapping);
    const Metrics<double>& m = found.metrics;
    const Vehicle<double> hot = with_motor_at(resolve(d), found.temperatures);
    const double P_cu = hot.motor.armature_resistance * square(m[Metric::current_rms]);
    const double P_friction = 2e-4 * two_pi * m[Metric::frequency];
    const MotorTemperatures<double> T = settled_temperatures(hot.thermal, P_cu, m[Metric::power_viscous] + P_friction);
    EXPECT_NEAR(T.winding, found.temperatures.winding, 300.0 * tolerance);
    EXPECT_NEAR(T.casing, found.temperatures.casing, 300.0 * tolerance);
    // That vehicle with the hot motor's constants stated outright.
    Design<double> stated = reference_design();
    stated.supply.voltage = 4.0;
    stated.motor.constants = hot.motor;
    const SteadyFlapping again = flapping_of(stated, tolerance);
    EXPECT_NEAR(again.metrics[Metric::lift_mean] / m[Metric::lift_mean], 1.0, 10.0 * tolerance);
    EXPECT_NEAR(again.metrics[Metric::efficiency_system] / m[Metric::efficiency_system], 1.0, 10.0 * tolerance);
  }
}

TEST(ThermalEquilibrium, NoResistanceIsNoChange) {
  Design<double> d = warm_design(4.0);
  *d.motor.thermal.resistance_winding = *d.motor.thermal.resistance_case = 0.0;
  const SteadyFlapping found = flapping_of(d, 1e-6);
  EXPECT_DOUBLE_EQ(found.metrics[Metric::winding_temperature], 25.0);
  Design<double> cold = reference_design();
  cold.supply.voltage = 4.0;
  EXPECT_NEAR(found.metrics[Metric::lift_mean] / flapping_of(cold, 1e-6).metrics[Metric::lift_mean], 1.0, 1e-6);
}

TEST(ThermalEquilibrium, BeyondTheLargestTemperatureIsOutsideTheDomain) {
  Design<double> d = warm_design(4.0);
  d.motor.thermal.winding_temperature_max = 85.0 + zero_celsius;
  EXPECT_TRUE(run_design(d, {}).domain.none());
  d.motor.thermal.ambient_temperature = 60.0 + zero_celsius;
  const RunResult hot = run_design(d, {});
  EXPECT_EQ(hot.status, FlappingStatus::flapping);
  EXPECT_EQ(name_of(hot.domain), "winding_temperature");
  EXPECT_LT(hot.metrics[Metric::winding_temperature_margin], 0.0);
  EXPECT_NEAR(hot.metrics[Metric::winding_temperature_margin] + hot.metrics[Metric::winding_temperature], 85.0, 1e-9);
  EXPECT_THAT(describe(hot.domain_evidence), HasSubstr("the winding heats up to "));
  EXPECT_THAT(describe(hot.domain_evidence), HasSubstr("(at most 85 degC)"));
}

TEST(ThermalEquilibrium, RunawayIsNamed) {
  Design<double> d = warm_design(5.0);
  d.motor.thermal.resistance_case = 5000.0;
  d.motor.thermal.copper_temperature_coefficient = 0.0;
  d.motor.thermal.magnet_temperature_coefficient = -1e-5;
  const RunResult found = run_design(d, {});
  EXPECT_EQ(found.status, FlappingStatus::flapping);
  EXPECT_EQ(name_of(found.domain), "winding_temperature");
  EXPECT_EQ(describe(found.domain_evidence),
            "thermal runaway: the losses do not settle before copper melts at 1085 degC (at most 125 degC)");
}

TEST(ThermalEquilibrium, HeatsUpUntilItStops) {
  Design<double> d = warm_design(3.0);
  d.friction = {FrictionLaw::constant, 2e-3};
  EXPECT_EQ(flapping_of(d, 1e-6).status, FlappingStatus::flapping);
  d.motor.thermal.resistance_case = 400.0;
  const SteadyFlapping found = flapping_of(d, 1e-6);
  EXPECT_NE(found.status, FlappingStatus::flapping);
  EXPECT_NE(found.status, FlappingStatus::undecided);
  EXPECT_THAT(describe(found.evidence),
              HasSubstr("while the motor is colder it flaps, and heats up until the winding is at "));
  EXPECT_TRUE(std::isnan(found.metrics[Metric::frequency]));
}

TEST(ThermalEquilibrium, ColdStandstillIsAsBefore) {
  Design<double> d = warm_design(0.5);
  d.friction = {FrictionLaw::constant, 2e-3};
  Design<double> plain = d;
  plain.motor.thermal = {};
  const SteadyFlapping found = flapping_of(d), without = flapping_of(plain);
  EXPECT_EQ(found.status, without.status);
  EXPECT_EQ(describe(found.evidence), describe(without.evidence));
}

/// Orbit against simulation in time, on random vehicles.
TEST(ThermalEquilibrium, SimulationInTimeAgrees) {
  std::mt19937_64 random(814);
  int flapping = 0;
  for (int n = 0; n < 12; ++n) {
    Design<double> d = n % 4 == 3 ? random_direct_design(random, false) : box_design(random);
    d.motor.thermal = warm_design().motor.thermal;
    d.motor.thermal.magnet_temperature_coefficient = -0.001;
    const RunResult orbit = run_design(d, {.tolerance = 1e-8});
    const RunResult time = run_design(d, {.method = Method::transient, .tolerance = 1e-8});
    ASSERT_EQ(orbit.status, time.status) << n << ": " << describe(orbit.evidence) << "; " << describe(time.evidence);
    if (orbit.status != FlappingStatus::flapping) continue;
    ++flapping;
    for (const Metric m : {Metric::frequency, Metric::lift_mean, Metric::power_electrical, Metric::winding_temperature,
                           Metric::case_temperature, Metric::current_rms}) {
      EXPECT_NEAR(orbit.metrics[m], time.metrics[m], 1e-6 * error_scale(orbit.metrics, m))
          << n << " " << metric_info(m).key;
    }
  }
  EXPECT_GE(flapping, 8);
}

/// The search for a voltage sees the warm motor.
TEST(ThermalEquilibrium, HoverTakesMoreVoltageFromAWarmMotor) {
  RunOptions options;
  options.frequency = 20.0;
  const RunResult cold = run_design(reference_design(), options), warm = run_design(warm_design(), options);
  ASSERT_EQ(warm.status, FlappingStatus::flapping) << describe(warm.evidence);
  EXPECT_NEAR(warm.metrics[Metric::frequency], 20.0, 1e-4);
  EXPECT_GT(warm.metrics[Metric::voltage], 1.02 * cold.metrics[Metric::voltage]);
  EXPECT_NEAR(warm.metrics[Metric::lift_mean] / cold.metrics[Metric::lift_mean], 1.0, 0.01);
}

}  // namespace
}  // namespace wingbeat

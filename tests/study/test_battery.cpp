// Vehicles on a supply with internal resistance: closed forms, and one solver against the other.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

Design<double> battery_design(double voltage = 3.7, double resistance = 1.5) {
  Design<double> d = reference_design();
  d.supply.type = SupplyType::battery;
  d.supply.battery.cell_voltage = voltage;
  d.supply.battery.internal_resistance = resistance;
  d.supply.battery.capacity = 180.0;
  return d;
}

TEST(BatteryVehicle, CellsReachTheEquations) {
  Design<double> d = battery_design(3.7, 0.4);
  d.supply.battery.cells = 2.0;
  const Vehicle<double> v = resolve(d);
  EXPECT_DOUBLE_EQ(v.voltage, 7.4);
  EXPECT_DOUBLE_EQ(v.source_resistance, 0.8);
  EXPECT_EQ(resolve(reference_design()).source_resistance, 0.0);
}

// A constant supply reports its own voltage to the last bit.
TEST(BatteryVehicle, ConstantSupplyKeepsItsVoltage) {
  Design<double> d = reference_design();
  d.supply.voltage = 3.3;
  EXPECT_EQ(run_design(d).metrics[Metric::voltage], 3.3);
}

// Wingless: i = v b / (K^2 + (R_a + R_i) b), and the terminals see v - R_i i.
TEST(BatteryVehicle, SagOfAWinglessVehicleMatchesItsClosedForm) {
  const Design<double> d = battery_design();
  const Motor<double>& m = d.motor.constants;
  for (const Method method : {Method::orbit, Method::transient}) {
    const RunResult r = run_design(d, {.condition = Condition::wingless, .method = method, .tolerance = 1e-10});
    ASSERT_EQ(r.status, FlappingStatus::flapping);
    const double R = m.armature_resistance + 1.5, K = m.torque_constant;
    const double i = 3.7 * m.viscous_damping / (K * K + R * m.viscous_damping);
    EXPECT_NEAR(r.metrics[Metric::current_mean], i, 1e-9 * i);
    EXPECT_NEAR(r.metrics[Metric::voltage], 3.7 - 1.5 * i, 1e-9);
    EXPECT_NEAR(r.metrics[Metric::power_electrical], (3.7 - 1.5 * i) * i, 1e-9);
    EXPECT_NEAR(two_pi * r.metrics[Metric::frequency], K * 3.7 / (K * K + R * m.viscous_damping), 1e-6);
  }
}

// A locked rotor is a resistive load: i = v / (R_a + R_i), reached with the time constant L_a / (R_a + R_i).
TEST(BatteryVehicle, LockedRotorDrawsTheCurrentOfBothResistances) {
  Vehicle<double> v = resolve(battery_design(3.7, 3.0));
  const double stall = v.motor.torque_constant * 3.7 / 12.0;
  EXPECT_DOUBLE_EQ(stall_torque(v), stall);
  v.friction.torque = 1.0001 * stall;
  EXPECT_EQ(find_steady_flapping(v).status, FlappingStatus::stalled);
  v.friction.torque = 0.9 * stall;
  v.motor.inertia = 1e6;  // turns too slowly to matter
  v.wing_inertia = 0.0;
  v.wings.air_density = 0.0;
  TransientOptions options;
  options.max_time = 3.0 * 29e-3 / 12.0;
  options.record = true;
  options.tolerance = 1e-9;
  const TransientResult r = simulate_start_up(v, options);
  ASSERT_FALSE(r.samples.empty());
  for (const TransientSample& s : r.samples) {
    EXPECT_NEAR(s.current, 3.7 / 12.0 * -std::expm1(-s.time * 12.0 / 29e-3), 1e-8) << s.time;
  }
}

// R_i acts on the motion as more armature resistance does; only what counts as the terminals differs.
TEST(BatteryVehicle, ActsAsArmatureResistanceOnTheMotion) {
  std::mt19937_64 random(11);
  int compared = 0;
  for (int n = 0; n < 60; ++n) {
    Vehicle<double> inside = resolve(box_design(random));
    Vehicle<double> outside = inside;
    const double R_i = 0.3 * inside.motor.armature_resistance;
    inside.motor.armature_resistance += R_i;
    outside.source_resistance = R_i;
    const SteadyFlapping a = find_steady_flapping(inside, {.tolerance = 1e-10});
    const SteadyFlapping b = find_steady_flapping(outside, {.tolerance = 1e-10});
    ASSERT_EQ(a.status, b.status);
    if (b.status != FlappingStatus::flapping) continue;
    ++compared;
    const double lost =
        R_i * b.record.integrals()[std::size_t(Integral::current_square)] * b.metrics[Metric::frequency];
    for (const Metric m : {Metric::frequency, Metric::current_mean, Metric::current_peak, Metric::lift_mean,
                           Metric::power_aerodynamic, Metric::rod_force_peak, Metric::floquet_multiplier_max}) {
      EXPECT_NEAR(b.metrics[m], a.metrics[m], 1e-8 * std::abs(a.metrics[m])) << metric_table()[std::size_t(m)].key;
    }
    EXPECT_NEAR(b.metrics[Metric::power_electrical], a.metrics[Metric::power_electrical] - lost, 1e-9);
    EXPECT_NEAR(b.metrics[Metric::power_copper], a.metrics[Metric::power_copper] - lost, 1e-9);
    EXPECT_NEAR(b.metrics[Metric::voltage], outside.voltage - R_i * b.metrics[Metric::current_mean], 1e-12);
    const EnergyAudit audit = energy_audit(b.metrics);
    EXPECT_LT(std::abs(audit.imbalance / audit.electrical), 1e-9);
  }
  EXPECT_GT(compared, 40);
}

TEST(BatteryVehicle, OrbitAgreesWithTheTransient) {
  std::mt19937_64 random(12);
  int compared = 0;
  for (int n = 0; n < 40; ++n) {
    Design<double> d = n % 2 ? box_design(random) : random_design(random, 1.5);
    const double voltage = d.supply.voltage;
    d.supply = battery_design(voltage, 0.25 * d.motor.constants.armature_resistance).supply;
    const RunResult a = run_design(d, {.tolerance = 1e-8});
    const RunResult b = run_design(d, {.method = Method::transient, .tolerance = 1e-8});
    if (!b.settled) continue;
    ASSERT_EQ(a.status, b.status) << n << ' ' << describe(a) << " / " << describe(b);
    if (a.status != FlappingStatus::flapping) continue;
    ++compared;
    for (int k = 0; k < metric_count; ++k) {
      const Metric m = Metric(k);
      if (m == Metric::floquet_multiplier_max || (std::isnan(a.metrics[m]) && std::isnan(b.metrics[m]))) continue;
      const double scale = m == Metric::power_residual ? a.metrics[Metric::power_motor] : std::abs(a.metrics[m]);
      EXPECT_NEAR(a.metrics[m], b.metrics[m], 1e-6 * scale) << n << ' ' << metric_table()[std::size_t(k)].key;
    }
  }
  EXPECT_GT(compared, 20);
}

// Waveforms hold the voltage at the terminals, with and without inductance, by either method.
TEST(BatteryVehicle, WaveformVoltageSagsWithTheCurrent) {
  for (const double inductance : {29e-3, 0.0}) {
    for (const Method method : {Method::orbit, Method::transient}) {
      Design<double> d = battery_design();
      d.motor.constants.armature_inductance = inductance;
      const RunResult r = run_design(d, {.method = method, .waveform_rows = 91});
      ASSERT_EQ(r.cycle.size(), 91u);
      for (std::size_t n = 0; n < r.cycle.size(); ++n) {
        EXPECT_NEAR(r.cycle[n].voltage, 3.7 - 1.5 * r.cycle[n].current, 1e-12);
      }
    }
  }
}

TEST(BatteryVehicle, TheDutyIsFoundForAFrequency) {
  const RunResult r = run_design(battery_design(), {.frequency = 10.0});
  ASSERT_EQ(r.search->outcome, FrequencyOutcome::reached);
  EXPECT_NEAR(r.metrics[Metric::frequency], 10.0, 1e-5);
  EXPECT_LT(r.design.supply.duty, 1.0);
  EXPECT_NEAR(run_design(r.design).metrics[Metric::frequency], 10.0, 1e-4);
}

}  // namespace
}  // namespace wingbeat

// A battery that feeds a direct drive through a bridge: a sine of a given amplitude, no losses between them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;

Design<double> swinging_on_a_sine() {
  return read_design(std::filesystem::path(WINGBEAT_DATA) / "designs" / "direct-drive.toml");
}

/// The amplitude and frequency of the sine supply from a battery.
Design<double> swinging_on_a_battery(double cell_voltage, double resistance) {
  Design<double> d = swinging_on_a_sine();
  d.supply.type = SupplyType::battery_sine;
  Battery<double>& b = d.supply.battery;
  b.cell_voltage = cell_voltage;
  b.internal_resistance = resistance;
  b.capacity = 108.0;
  return d;
}

std::string refusal_of(const Design<double>& d) {
  try {
    validate(d);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "";
}

TEST(Bridge, GivesTheSineOfASineSupply) {
  const RunResult sine = run_design(swinging_on_a_sine(), {.tolerance = 1e-9});
  for (const Method method : {Method::orbit, Method::transient}) {
    const RunResult bridged = run_design(swinging_on_a_battery(3.7, 0.5), {.method = method, .tolerance = 1e-9});
    ASSERT_EQ(bridged.status, FlappingStatus::flapping);
    for (const Metric m : {Metric::voltage, Metric::frequency, Metric::power_electrical, Metric::lift_mean}) {
      EXPECT_NEAR(bridged.metrics[m] / sine.metrics[m], 1.0, 1e-7) << metric_info(m).key;
    }
  }
}

// (E - R I) I = P.
TEST(Bridge, TakesTheMeanPowerFromTheBattery) {
  const double P = run_design(swinging_on_a_sine(), {.tolerance = 1e-10}).metrics[Metric::power_electrical];
  for (const double R : {0.0, 0.5, 2.0}) {
    const EnduranceResult r = simulate_discharge(swinging_on_a_battery(3.7, R));
    ASSERT_EQ(r.end, EnduranceEnd::empty) << describe(r);
    const EnduranceRow& last = r.rows.back();
    const double I = last.battery_current;
    EXPECT_NEAR((3.7 - R * I) * I / P, 1.0, 1e-8);
    EXPECT_LT(R * I, 0.5 * 3.7);
    EXPECT_DOUBLE_EQ(last.terminal_voltage, 3.7 - R * I);
    EXPECT_NEAR(r.endurance() * I / 108.0, 1.0, 1e-9);
    EXPECT_NEAR(last.energy_electrical / (P * r.endurance()), 1.0, 1e-8);
    EXPECT_NEAR(last.energy_electrical + last.energy_internal, 108.0 * 3.7, 1e-8 * 108.0 * 3.7);
    EXPECT_EQ(last.metrics[Metric::voltage], 3.0);
    EXPECT_LE(r.evaluations, 2);
  }
}

// Without resistance time is energy over power, whatever the curve.
TEST(Bridge, TimeIsEnergyOverPower) {
  Design<double> d = swinging_on_a_battery(0.0, 0.0);
  d.supply.battery.discharge_curve = {{0.0, 3.1}, {0.2, 3.6}, {0.8, 3.9}, {1.0, 4.2}};
  const EnduranceResult r = simulate_discharge(d);
  const double P = r.rows.front().metrics[Metric::power_electrical];
  EXPECT_NEAR(r.endurance() * P / (108.0 * mean_open_circuit_voltage(d.supply.battery)), 1.0, 1e-8);
}

TEST(Bridge, EndsTheFlightAtItsAmplitude) {
  Design<double> d = swinging_on_a_battery(0.0, 0.5);
  d.supply.battery.discharge_curve = {{0.0, 2.0}, {1.0, 4.2}};
  const EnduranceResult r = simulate_discharge(d);
  ASSERT_EQ(r.end, EnduranceEnd::bridge);
  EXPECT_NEAR(r.rows.back().terminal_voltage, 3.0, 1e-9);
  EXPECT_THAT(describe(r),
              HasSubstr("the battery's terminal voltage falls to the amplitude of the bridge's sine, 3 V"));
  d.supply.battery.cutoff_voltage = 3.2;
  EXPECT_EQ(simulate_discharge(d).end, EnduranceEnd::cutoff);

  const EnduranceResult sags = simulate_discharge(swinging_on_a_battery(3.01, 0.5));
  EXPECT_EQ(sags.end, EnduranceEnd::bridge);
  EXPECT_EQ(sags.endurance(), 0.0);
  EXPECT_THAT(describe(sags), HasSubstr("less than the amplitude of its sine, 3 V"));
  const EnduranceResult weak = simulate_discharge(swinging_on_a_battery(3.7, 500.0));
  EXPECT_EQ(weak.end, EnduranceEnd::bridge);
  EXPECT_THAT(describe(weak), HasSubstr("the battery cannot give the"));
}

TEST(Bridge, ReachesALiftWithinTheBatterysVoltage) {
  const Design<double> d = swinging_on_a_battery(3.7, 0.5);
  const RunResult reached = run_design(d, {.lift = 0.014});
  ASSERT_TRUE(reached.search);
  EXPECT_GT(reached.design.supply.voltage, 3.0);
  EXPECT_NEAR(reached.metrics[Metric::lift_mean], 0.014, 1e-7);
  const RunResult beyond = run_design(d, {.lift = 0.025});
  ASSERT_EQ(beyond.search->outcome, FrequencyOutcome::too_high);
  EXPECT_EQ(beyond.search->closest_voltage, 3.7);
  EXPECT_THAT(describe(beyond), HasSubstr("N at most, at 3.7 V (voltages up to 3.7 V)"));
}

TEST(Bridge, SeveralMotorsAndAWarmMotor) {
  Design<double> two = swinging_on_a_battery(3.7, 0.25);
  two.motors = 2.0;
  two.supply.battery.capacity = 216.0;
  const double time = simulate_discharge(swinging_on_a_battery(3.7, 0.5)).endurance();
  EXPECT_NEAR(simulate_discharge(two).endurance() / time, 1.0, 1e-7);

  Design<double> warm = swinging_on_a_battery(3.7, 0.5);
  MotorThermalDesign<double>& t = warm.motor.thermal;
  t.resistance_winding = t.resistance_case = 20.0;
  const double settled = simulate_discharge(warm).endurance();
  t.time_constant_winding = 3.0;
  t.time_constant_case = 60.0;
  const EnduranceResult warming = simulate_discharge(warm, {.tolerance = 1e-7});
  EXPECT_EQ(warming.end, EnduranceEnd::empty) << describe(warming);
  EXPECT_NE(settled, time);
  EXPECT_LT(std::abs(warming.endurance() - settled), std::abs(time - settled));
}

TEST(Bridge, EnduranceAsAMetric) {
  const Design<double> d = swinging_on_a_battery(3.7, 0.5);
  const DesignParameter parameters[] = {design_parameter("supply.capacity"), design_parameter("supply.amplitude")};
  const Endurance e = endurance_of(d, Condition::air, 1e-7, parameters);
  EXPECT_NEAR(e.by_parameter.at(0) * 108.0 / e.time, 1.0, 1e-5);
  EXPECT_LT(e.by_parameter.at(1), 0.0);
}

TEST(Bridge, IsForADirectDriveWithinTheBatterysVoltage) {
  EXPECT_EQ(refusal_of(swinging_on_a_battery(3.7, 0.5)), "");
  EXPECT_EQ(refusal_of(swinging_on_a_battery(2.9, 0.5)),
            "supply.amplitude: 3 V exceed what the bridge has from the battery, 2.9 V without load at a charge of 1");
  Design<double> crank = read_design(std::filesystem::path(WINGBEAT_DATA) / "designs" / "friction2022-battery.toml");
  crank.supply.type = SupplyType::battery_sine;
  crank.supply.voltage = 1.0;
  crank.supply.frequency = 20.0;
  EXPECT_EQ(refusal_of(crank), "supply.type: the sine that a bridge makes is for a direct drive: expected battery");
  Design<double> plain = swinging_on_a_battery(3.7, 0.5);
  plain.supply.type = SupplyType::battery;
  EXPECT_EQ(refusal_of(plain), "supply.type: a direct drive swings as its supply does: expected sine or battery-sine");
}

}  // namespace
}  // namespace wingbeat

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "parts/expect_error.hpp"
#include "wingbeat/parts/motor.hpp"
#include "wingbeat/parts/steady_motor.hpp"

namespace wingbeat {
namespace {

constexpr Motor<double> reference_motor = {9.0, 29e-3, 0.01, 1.5e-7, 3.6e-6, 1e-4};

TEST(Motor, RefersMotorShaftConstantsToTheOutputShaft) {
  const GearMotor<double> geared{20.0, {9.0, 29e-3, 5e-4, 3e-10, 7e-9, 2e-6}, 4e-8, 9e-7};
  const Motor<double> m = at_output_shaft(geared);
  EXPECT_DOUBLE_EQ(m.armature_resistance, 9.0);
  EXPECT_DOUBLE_EQ(m.armature_inductance, 29e-3);
  EXPECT_DOUBLE_EQ(m.torque_constant, 0.01);
  EXPECT_DOUBLE_EQ(m.inertia, 1.6e-7);
  EXPECT_DOUBLE_EQ(m.viscous_damping, 3.7e-6);
  EXPECT_DOUBLE_EQ(m.friction_torque, 4e-5);
}

TEST(Motor, GearingKeepsEnergyAndPower) {
  const double n = 13.0, omega = 140.0, shaft = n * omega, i = 0.21;
  const Motor<double> motor_shaft = {9.0, 29e-3, 5e-4, 3e-10, 7e-9, 2e-6};
  const Motor<double> m = at_output_shaft(GearMotor<double>{n, motor_shaft, 0.0, 0.0});
  const auto out = motor_loads(m, 3.0, i, omega);
  const auto in = motor_loads(motor_shaft, 3.0, i, shaft);
  EXPECT_NEAR(0.5 * m.inertia * omega * omega, 0.5 * motor_shaft.inertia * shaft * shaft, 1e-18);
  EXPECT_NEAR(out.power_viscous, in.power_viscous, 1e-15);
  EXPECT_NEAR(out.torque * omega, in.torque * shaft, 1e-15);
  EXPECT_NEAR(m.friction_torque * omega, motor_shaft.friction_torque * shaft, 1e-15);
  EXPECT_NEAR(out.inductive_voltage, in.inductive_voltage, 1e-14);
}

TEST(Motor, GearRatioOneWithoutGearboxChangesNothing) {
  const Motor<double> m = at_output_shaft(GearMotor<double>{1.0, reference_motor, 0.0, 0.0});
  EXPECT_DOUBLE_EQ(m.torque_constant, reference_motor.torque_constant);
  EXPECT_DOUBLE_EQ(m.inertia, reference_motor.inertia);
  EXPECT_DOUBLE_EQ(m.viscous_damping, reference_motor.viscous_damping);
  EXPECT_DOUBLE_EQ(m.friction_torque, reference_motor.friction_torque);
}

TEST(Motor, ElectricalPowerIsCopperLossPlusFieldPlusShaft) {
  for (const double v : {-3.0, 0.0, 3.0}) {
    for (const double i : {-0.4, 0.0, 0.3}) {
      for (const double omega : {-200.0, 0.0, 150.0}) {
        const auto loads = motor_loads(reference_motor, v, i, omega);
        EXPECT_NEAR(v * i, loads.power_copper + loads.inductive_voltage * i + loads.torque * omega, 1e-15);
        EXPECT_GE(loads.power_copper, 0.0);
        EXPECT_GE(loads.power_viscous, 0.0);
        EXPECT_DOUBLE_EQ(loads.power_viscous, loads.drag_torque * omega);
      }
    }
  }
}

TEST(Motor, NoLoadSpeedBalancesTorqueAndVoltage) {
  const double omega = no_load_speed(reference_motor, 3.0);
  // K v / (K^2 + R b) = 0.03 / (1e-4 + 3.24e-5)
  EXPECT_NEAR(omega, 226.58610271903323, 1e-11);
  const double i = reference_motor.viscous_damping * omega / reference_motor.torque_constant;
  const auto loads = motor_loads(reference_motor, 3.0, i, omega);
  EXPECT_NEAR(loads.inductive_voltage, 0.0, 1e-14);
  EXPECT_NEAR(loads.torque, loads.drag_torque, 1e-18);
}

TEST(Motor, NoLoadSpeedWithoutDampingIsVoltageOverConstant) {
  Motor<double> m = reference_motor;
  m.viscous_damping = 0.0;
  EXPECT_DOUBLE_EQ(no_load_speed(m, 3.0), 300.0);
  EXPECT_DOUBLE_EQ(no_load_speed(m, 0.0), 0.0);
}

TEST(Motor, SteadyMotorKeepsPower) {
  Motor<double> geared = reference_motor;
  geared.gear_efficiency = 0.8;
  for (const Motor<double>& m : {reference_motor, geared}) {
    const double v = 3.0, free = free_speed(m, v);
    EXPECT_LT(free, no_load_speed(m, v));
    EXPECT_NEAR(steady_motor(m, v, free).torque, 0.0, 1e-17);
    EXPECT_NEAR(steady_motor(m, v, 0.0).current, v / 9.0, 1e-15);
    for (const double omega : {0.1 * free, 0.9 * free, 1.2 * free}) {
      const SteadyMotor<double> steady = steady_motor(m, v, omega);
      const MotorLoads<double> loads = motor_loads(m, v, steady.current, omega);
      EXPECT_NEAR(loads.inductive_voltage, 0.0, 1e-14);
      const double before_gear =
          steady.power_electrical - loads.power_copper - loads.power_viscous - m.friction_torque * omega;
      const double e = before_gear > 0.0 ? m.gear_efficiency : 1.0 / m.gear_efficiency;
      EXPECT_NEAR(steady.power_mechanical, e * before_gear, 1e-15);
      EXPECT_EQ(steady.torque > 0.0, omega < free);
    }
  }
  EXPECT_EQ(free_speed(reference_motor, 0.01), 0.0);
}

TEST(Motor, StalledMotorDrawsVoltageOverResistance) {
  EXPECT_NEAR(motor_loads(reference_motor, 3.0, 3.0 / 9.0, 0.0).inductive_voltage, 0.0, 1e-15);
}

TEST(Motor, RefusesConstantsOutOfRange) {
  using M = Motor<double>;
  EXPECT_NO_THROW(validate(reference_motor));
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.armature_resistance = -9.0; }),
            "motor.armature_resistance: must be > 0 [ohm], got -9");
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.armature_resistance = 0.0; }),
            "motor.armature_resistance: must be > 0 [ohm], got 0");
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.armature_inductance = -0.029; }),
            "motor.armature_inductance: must be >= 0 [H], got -0.029");
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.torque_constant = 0.0; }),
            "motor.torque_constant: must be > 0 [N m/A], got 0");
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.inertia = 0.0; }), "motor.inertia: must be > 0 [kg m2], got 0");
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.viscous_damping = -1e-6; }),
            "motor.viscous_damping: must be >= 0 [N m s/rad], got -1e-06");
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.friction_torque = -2.5; }),
            "motor.friction_torque: must be >= 0 [N m], got -2.5");
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.gear_efficiency = 1.2; }),
            "motor.gear_efficiency: must be > 0 and <= 1 [1], got 1.2");
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.inertia = std::nan(""); }),
            "motor.inertia: must be > 0 [kg m2], got nan");
  EXPECT_EQ(refusal(reference_motor, [](M& m) { m.torque_constant = std::numeric_limits<double>::infinity(); }),
            "motor.torque_constant: must be > 0 [N m/A], got inf");
}

TEST(Motor, ZeroInductanceAndZeroLossesAreLegal) {
  EXPECT_NO_THROW(validate(Motor<double>{9.0, 0.0, 0.01, 1.5e-7, 0.0, 0.0}));
}

}  // namespace
}  // namespace wingbeat

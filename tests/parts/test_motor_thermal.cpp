// Temperatures of a motor: what losses lead to, and what temperatures change.
#include "wingbeat/parts/motor_thermal.hpp"

#include <gtest/gtest.h>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/members.hpp"

namespace wingbeat {
namespace {

const Motor<double> motor{9.0, 29e-3, 0.01, 1.5e-7, 3.6e-6, 0.0};

MotorThermal<double> small_motor() {
  MotorThermal<double> t;
  t.resistance_winding = 20.0;
  t.resistance_case = 48.0;
  return t;
}

TEST(MotorThermal, SettlesByItsLosses) {
  MotorThermal<double> t = small_motor();
  t.ambient_temperature = 300.0;
  const MotorTemperatures<double> T = settled_temperatures(t, 0.5, 0.1);
  EXPECT_DOUBLE_EQ(T.casing, 300.0 + 48.0 * 0.6);
  EXPECT_DOUBLE_EQ(T.winding, T.casing + 20.0 * 0.5);
}

TEST(MotorThermal, ConstantsFollowTheirTemperatures) {
  MotorThermal<double> t = small_motor();
  t.magnet_temperature_coefficient = -0.001;
  const double T_0 = t.reference_temperature;
  const Motor<double> hot = at_temperatures(motor, t, {T_0 + 100.0, T_0 + 50.0});
  EXPECT_DOUBLE_EQ(hot.armature_resistance, 9.0 * 1.39);
  EXPECT_DOUBLE_EQ(hot.torque_constant, 0.01 * 0.95);
  EXPECT_EQ(hot.viscous_damping, motor.viscous_damping);
  const Motor<double> same = at_temperatures(motor, t, {T_0, T_0});
  EXPECT_EQ(same.armature_resistance, motor.armature_resistance);
  EXPECT_EQ(same.torque_constant, motor.torque_constant);
  EXPECT_EQ(at_temperatures(motor, t, {T_0, T_0 + 2000.0}).torque_constant, 0.0);
}

TEST(MotorThermal, IsOffUnlessResistancesAreGiven) {
  const MotorThermal<double> off;
  EXPECT_FALSE(heats_up(off));
  EXPECT_TRUE(heats_up(small_motor()));
  EXPECT_TRUE(std::isnan(settled_temperatures(off, 0.5, 0.1).winding));
}

TEST(MotorThermal, DerivativesAreThoseOfDifferences) {
  using J = Jet<2>;
  MotorThermal<J> t = cast<J>(small_motor());
  t.magnet_temperature_coefficient = J(-0.001);
  const Motor<J> hot = at_temperatures(cast<J>(motor), t, {J(340.0, 0), J(330.0, 1)});
  EXPECT_DOUBLE_EQ(hot.armature_resistance.v[0], 9.0 * 0.0039);
  EXPECT_EQ(hot.armature_resistance.v[1], 0.0);
  EXPECT_DOUBLE_EQ(hot.torque_constant.v[1], -1e-5);
}

TEST(MotorThermal, RefusesSurroundingsThatLeaveNothing) {
  MotorThermal<double> t = small_motor();
  t.ambient_temperature = 200.0;
  t.copper_temperature_coefficient = 0.02;
  EXPECT_THROW(validate(t), ParameterError);
  t = small_motor();
  t.ambient_temperature = 500.0;
  t.magnet_temperature_coefficient = -0.01;
  try {
    validate(t);
    ADD_FAILURE() << "accepted";
  } catch (const ParameterError& error) {
    EXPECT_STREQ(error.what(),
                 "motor.magnet_temperature_coefficient: leaves the magnet no field at the ambient temperature: must be "
                 "nearer to 0 [1/K], got -0.01");
  }
}

}  // namespace
}  // namespace wingbeat

// Lists of motors as manufacturers and collections write them.
#include <gmock/gmock.h>

#include "files/motor_catalogue.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {
namespace {

using detail::StatedTable, detail::parse_motor_catalogue;
using testing::HasSubstr;

MotorCandidate only(const std::string& text, const StatedTable& form = {}) {
  const std::vector<MotorCandidate> motors =
      parse_motor_catalogue(text, "list.csv", 20.0, 0.002, reference_design(), form);
  EXPECT_EQ(motors.size(), 1U);
  return motors.at(0);
}

std::string complaint(const std::string& text, const StatedTable& form = {}) {
  try {
    parse_motor_catalogue(text, "list.csv", 20.0, 0.002, reference_design(), form);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expect_0816(const MotorCandidate& m) {
  EXPECT_EQ(m.refused, "");
  EXPECT_EQ(m.model, "0816K003SR");
  const auto& c = m.design.motor.constants;
  EXPECT_NEAR(c.armature_resistance, 5.4, 1e-12);
  EXPECT_NEAR(c.torque_constant, 2.11e-3, 1e-15);
  EXPECT_NEAR(c.inertia, 5.1e-9, 1e-21);
  EXPECT_NEAR(c.armature_inductance, 53e-6, 1e-17);
  EXPECT_NEAR(c.friction_torque, 3.4e-5, 1e-17);
  EXPECT_NEAR(c.viscous_damping, 1e-9, 1e-21);
  EXPECT_NEAR(m.design.masses.motor.value_or(0.0), 4.5e-3, 1e-15);
  EXPECT_NEAR(m.nominal_current.value_or(0.0), 0.37, 1e-12);
  EXPECT_EQ(m.design.motor.gear_ratio, 20.0);
}

TEST(MotorCatalogue, NamesUnitsAndSignsInUse) {
  expect_0816(
      only("model,resistance_ohm,torque_constant_Nm_per_A,rotor_inertia_kgm2,inductance_H,friction_torque_Nm,"
           "viscous_friction_Nms,mass_kg,nominal_current_A\n"
           "0816K003SR,5.4,0.00211,5.1e-9,53e-6,3.4e-5,1e-9,0.0045,0.37\n"));
  expect_0816(
      only("Type;Terminal resistance [ohm];k_t [mN m/A];Rotor inertia [g cm2];Terminal inductance [mH];"
           "Coulomb friction (mN m);Viscous friction (N m s/rad);Weight (g);Max continuous current (mA);Price\n"
           "0816K003SR;5,4;2,11;0,051;0,053;0,034;1e-9;4,5;370;99,95\n"));
  expect_0816(only(
      "# from the web\nType\tR (mohm)\tKt (N m/A)\tJ (kg m2)\tL (uH)\tfriction_torque [N m]\tviscous_damping "
      "[N m s/rad]\tmass [kg]\tRated current [A]\n0816K003SR\t5400\t0.00211\t5.1e-9\t53\t3.4e-5\t1e-9\t0.0045\t.37\n"));
}

TEST(MotorCatalogue, ColumnsAreNamedByTheStudy) {
  StatedTable form;
  form.columns = {{"Bestellnummer", "model"},
                  {"Widerstand", "armature_resistance [ohm]"},
                  {"Konstante (mN m/A)", "torque_constant"},
                  {"Masse (g)", "mass"},
                  {"R (ohm)", "ignore"}};
  expect_0816(
      only("Bestellnummer,Widerstand,R (ohm),Konstante (mN m/A),inertia [kg m2],inductance [H],friction_torque [N m],"
           "viscous_damping [N m s/rad],Masse (g),nominal_current [A]\n"
           "0816K003SR,5.4,99,2.11,5.1e-9,53e-6,3.4e-5,1e-9,4.5,0.37\n",
           form));
  form.columns = {{"Masse", "mass [g]"}};
  EXPECT_THAT(complaint("model,mass [kg]\na,1\n", form),
              HasSubstr("motors.columns names \"Masse\", which the header has not"));
  form.columns = {{"Masse", "weights"}};
  EXPECT_THAT(complaint("model,Masse\na,1\n", form),
              HasSubstr("motors.columns names \"weights\", which is none of model,"));
}

TEST(MotorCatalogue, WhatIsAmbiguousIsAsked) {
  const std::string rest = ",torque_constant [N m/A],inertia [kg m2],inductance [H]\n";
  EXPECT_THAT(complaint("model,armature_resistance" + rest),
              HasSubstr("list.csv:1:7: armature_resistance: names no unit; write armature_resistance_ohm or"));
  EXPECT_THAT(complaint("model,armature_resistance [kg]" + rest), HasSubstr("the unit \"kg\" is wrong"));
  EXPECT_THAT(complaint("model,R [ohm],resistance [ohm]" + rest),
              HasSubstr("armature_resistance is given twice, as \"R [ohm]\" and as \"resistance [ohm]\""));
  EXPECT_THAT(complaint("model" + rest), HasSubstr("armature_resistance: missing; expected a column of that name"));
  EXPECT_THAT(complaint("model,R [ohm]" + rest + "a,five,1,1,1\n"),
              HasSubstr("list.csv:2:3: R [ohm]: expected a number, got \"five\""));
  // The column's own name goes before what others call it.
  EXPECT_EQ(only("model,R [ohm],armature_resistance [ohm],mass [kg],viscous_damping [N m s/rad]" + rest +
                 "a,5,7,0.001,0,0.01,1e-7,1e-3\n")
                .design.motor.constants.armature_resistance,
            7.0);
}

}  // namespace
}  // namespace wingbeat

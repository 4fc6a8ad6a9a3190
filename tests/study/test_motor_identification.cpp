#include "wingbeat/report/identification_report.hpp"
#include "wingbeat/study/motor_identification.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "wingbeat/core/math.hpp"
#include "wingbeat/files/datasheet_file.hpp"
#include "wingbeat/files/design_file.hpp"

namespace wingbeat {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Rows of data/motors/motors.csv by column name; no field of it is quoted.
std::vector<std::map<std::string, std::string>> motor_rows() {
  std::istringstream text(read_text_file(std::string(WINGBEAT_DATA) + "/motors/motors.csv"));
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
  for (std::string line; std::getline(text, line);) {
    std::vector<std::string> cells;
    std::istringstream fields(line);
    for (std::string cell; std::getline(fields, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    rows.emplace_back();
    for (std::size_t n = 0; n < cells.size() && n < names.size(); ++n) rows.back()[names[n]] = cells[n];
  }
  return rows;
}

MotorDatasheet sheet_of(std::map<std::string, std::string>& row) {
  const auto number = [&](const char* name) -> std::optional<double> {
    if (row[name].empty()) return std::nullopt;
    return std::stod(row[name]);
  };
  MotorDatasheet s;
  s.name = row["model"];
  s.gear_ratio = *number("gear_ratio");
  s.shaft = s.gear_ratio > 1.0 ? Shaft::output : Shaft::motor;
  s.voltage = number("nominal_voltage_V");
  s.no_load_speed = number("no_load_speed_rad_s");
  s.no_load_current = number("no_load_current_A");
  s.stall_torque = number("stall_torque_Nm");
  s.stall_current = number("stall_current_A");
  s.torque_constant = number("torque_constant_Nm_per_A");
  // The table computes the gearmotors' resistance from the stall current: no fact of its own.
  if (s.torque_constant) s.resistance = number("resistance_ohm");
  s.friction_torque = number("friction_torque_Nm");
  s.rotor_inertia = number("rotor_inertia_kgm2");
  s.inductance = number("inductance_H");
  return s;
}

TEST(MotorIdentification, RowsReturnTheirResistanceAndConstantWithinTheirOwnContradictions) {
  int rows = 0;
  for (auto& row : motor_rows()) {
    MotorDatasheet s = sheet_of(row);
    if (!s.resistance || !s.torque_constant) continue;
    ++rows;
    double contradiction_R = 0.0, contradiction_K = 0.0;
    for (const Contradiction& c : identify_motor(s).contradictions) {
      if (c.constant == "armature resistance") contradiction_R = std::max(contradiction_R, c.size);
      if (c.constant == "torque constant") contradiction_K = std::max(contradiction_K, c.size);
    }
    const double R = *s.resistance, K = *s.torque_constant;
    s.resistance.reset();
    s.torque_constant.reset();
    const MotorIdentification without = identify_motor(s);
    ASSERT_TRUE(without.complete()) << s.name;
    // Each constant may be moved by the contradictions of both, and by the rounding of three digits.
    const double slack = contradiction_R + contradiction_K + 5e-3;
    if (std::getenv("WINGBEAT_PRINT")) {
      std::printf("%s: R %+.2f %%, K %+.2f %%; contradictions R %.2f %%, K %.2f %%\n", s.name.c_str(),
                  100.0 * (*without.armature_resistance.value / R - 1.0),
                  100.0 * (*without.torque_constant.value / K - 1.0), 100.0 * contradiction_R, 100.0 * contradiction_K);
    }
    EXPECT_LT(std::abs(*without.armature_resistance.value / R - 1.0), slack) << s.name;
    EXPECT_LT(std::abs(*without.torque_constant.value / K - 1.0), slack) << s.name;
    // The brushless motors' stall values are those of motor and driver together.
    if (!s.name.starts_with("BMS")) {
      EXPECT_LT(slack, 0.15) << s.name;
    }
  }
  EXPECT_EQ(rows, 9);
}

TEST(MotorIdentification, IncompleteRowsNameWhatIsMissing) {
  int rows = 0;
  for (auto& row : motor_rows()) {
    MotorDatasheet s = sheet_of(row);
    if (s.rotor_inertia) continue;
    ++rows;
    const MotorIdentification found = identify_motor(s, 10.0);
    EXPECT_FALSE(found.complete());
    EXPECT_TRUE(found.armature_resistance.value && found.torque_constant.value) << s.name;
    EXPECT_FALSE(found.inertia.value.has_value());
    EXPECT_THAT(found.missing, testing::ElementsAre(HasSubstr("rotor inertia: give rotor_inertia")));
    EXPECT_THAT(found.remarks, Contains(HasSubstr("no inductance given: assumed 0; at 10 Hz")));
    EXPECT_THROW(found.motor(), std::logic_error);
    s.rotor_diameter = 7e-3;
    s.rotor_length = 8e-3;
    EXPECT_FALSE(identify_motor(s).complete()) << "a fallback must be asked for";
    s.assume_steel_cylinder = true;
    const MotorIdentification with = identify_motor(s);
    ASSERT_TRUE(with.complete());
    EXPECT_THAT(with.remarks, Contains(HasSubstr("solid steel cylinder")));
    const double J = 0.5 * 7850.0 * pi * std::pow(3.5e-3, 4) * 8e-3;
    EXPECT_NEAR(with.motor().inertia / (s.gear_ratio * s.gear_ratio * J), 1.0, 1e-12);
  }
  EXPECT_EQ(rows, 9);
}

/// The sheet that a motor would have.
MotorDatasheet exact_sheet(const Motor<double>& m, double v) {
  const double w = (m.torque_constant * v / m.armature_resistance - m.friction_torque) /
                   (m.torque_constant * m.torque_constant / m.armature_resistance + m.viscous_damping);
  MotorDatasheet s;
  s.voltage = v;
  s.no_load_speed = w;
  s.no_load_current = (v - m.torque_constant * w) / m.armature_resistance;
  s.stall_current = v / m.armature_resistance;
  s.stall_torque = m.torque_constant * v / m.armature_resistance - m.friction_torque;
  s.inductance = m.armature_inductance;
  s.rotor_inertia = m.inertia;
  return s;
}

constexpr Motor<double> motor = {5.4, 5e-5, 2.1e-3, 5e-9, 3e-9, 0.0};

TEST(MotorIdentification, ExactSheetGivesTheMotorBack) {
  const Motor<double> m = identify_motor(exact_sheet(motor, 3.0)).motor();
  EXPECT_NEAR(m.armature_resistance / motor.armature_resistance, 1.0, 1e-6);
  EXPECT_NEAR(m.torque_constant / motor.torque_constant, 1.0, 1e-6);
  EXPECT_NEAR(m.viscous_damping / motor.viscous_damping, 1.0, 1e-5);
  EXPECT_EQ(m.friction_torque, 0.0);
  EXPECT_EQ(m.inertia, motor.inertia);
}

TEST(MotorIdentification, EverySufficientMixGivesTheSameMotor) {
  const MotorDatasheet full = exact_sheet(motor, 3.0);
  const auto with = [&](auto change) {
    MotorDatasheet s;
    s.voltage = 3.0;
    s.rotor_inertia = motor.inertia;
    change(s);
    return identify_motor(s).motor();
  };
  const Motor<double> found[] = {
      with([&](auto& s) { s.resistance = 5.4, s.torque_constant = 2.1e-3, s.no_load_current = full.no_load_current; }),
      with([&](auto& s) {
        s.resistance = 5.4, s.no_load_speed = full.no_load_speed, s.no_load_current = full.no_load_current;
      }),
      with([&](auto& s) {
        s.stall_current = full.stall_current, s.speed_constant = 1.0 / 2.1e-3, s.viscous_damping = 3e-9;
      }),
      with([&](auto& s) {
        for (const double torque : {0.0, 3e-4, 6e-4}) {
          const double w = (2.1e-3 * 3.0 / 5.4 - torque) / (2.1e-3 * 2.1e-3 / 5.4 + 3e-9);
          s.points.push_back({{}, torque, w, (torque + 3e-9 * w) / 2.1e-3, {}});
        }
      })};
  for (const Motor<double>& m : found) {
    EXPECT_NEAR(m.armature_resistance, 5.4, 1e-4);
    EXPECT_NEAR(m.torque_constant, 2.1e-3, 1e-7);
    EXPECT_NEAR(m.viscous_damping, 3e-9, 1e-12);
  }
}

TEST(MotorIdentification, ConstantFrictionWhereTheDataShowIt) {
  Motor<double> rubbing = motor;
  rubbing.friction_torque = 3e-5;
  MotorDatasheet s = exact_sheet(rubbing, 3.0);
  s.stall_current.reset();
  s.stall_torque.reset();
  s.resistance = 5.4;
  s.torque_constant = 2.1e-3;
  s.deviation = 0.01;
  for (const double v : {1.0, 2.0, 3.0}) {
    const double w = (2.1e-3 * v / 5.4 - 3e-5) / (2.1e-3 * 2.1e-3 / 5.4 + 3e-9);
    s.points.push_back({v, 0.0, w, (v - 2.1e-3 * w) / 5.4, {}});
  }
  const Motor<double> m = identify_motor(s).motor();
  EXPECT_NEAR(m.friction_torque / 3e-5, 1.0, 1e-3);
  EXPECT_NEAR(m.viscous_damping / 3e-9, 1.0, 1e-2);
}

TEST(MotorIdentification, TimeConstantGivesInertiaAndContradictsAWrongOne) {
  MotorDatasheet s = exact_sheet(motor, 3.0);
  s.mechanical_time_constant = 5.4 * 5e-9 / (2.1e-3 * 2.1e-3);
  s.rotor_inertia.reset();
  EXPECT_NEAR(identify_motor(s).motor().inertia / 5e-9, 1.0, 1e-5);
  s.rotor_inertia = 6e-9;
  const MotorIdentification two = identify_motor(s);
  ASSERT_FALSE(two.contradictions.empty());
  EXPECT_EQ(two.contradictions[0].constant, "rotor inertia");
  EXPECT_NEAR(two.contradictions[0].size, 1.0 / 6.0, 1e-4);
  EXPECT_NEAR(two.motor().inertia, std::sqrt(5e-9 * 6e-9), 1e-13);
}

TEST(MotorIdentification, ContradictionHasItsSize) {
  MotorDatasheet s = exact_sheet(motor, 3.0);
  s.resistance = 5.4 * 1.09;
  const MotorIdentification found = identify_motor(s);
  ASSERT_FALSE(found.contradictions.empty());
  EXPECT_THAT(text_identification(found, s),
              HasSubstr("resistance and stall current disagree about the armature resistance by 8.3 %"));
}

TEST(MotorIdentification, ContradictionsWidenTheIntervals) {
  MotorDatasheet s = exact_sheet(motor, 3.0);
  const MotorIdentification consistent = identify_motor(s);
  EXPECT_EQ(consistent.birge_ratio, 1.0);
  s.resistance = 1.5 * 5.4;
  s.torque_constant = 2.1e-3;
  const MotorIdentification found = identify_motor(s);
  ASSERT_TRUE(found.complete());
  EXPECT_GT(found.birge_ratio, 2.0);
  EXPECT_GT(found.armature_resistance.standard_error, 2.0 * consistent.armature_resistance.standard_error);
  EXPECT_LT(std::abs(*found.armature_resistance.value - 5.4), 2.0 * found.armature_resistance.standard_error);
  EXPECT_THAT(found.remarks, Contains(HasSubstr("(Birge ratio)")));
  // Two inertias apart by far more than their deviations.
  s = exact_sheet(motor, 3.0);
  s.mechanical_time_constant = 2.0 * 5.4 * 5e-9 / (2.1e-3 * 2.1e-3);
  const IdentifiedConstant inertia = identify_motor(s).inertia;
  EXPECT_GT(*inertia.value + 1.5 * inertia.standard_error, 1e-8);
  EXPECT_LT(*inertia.value - 1.5 * inertia.standard_error, 5e-9);
}

TEST(MotorIdentification, GrossContradictionsAreRefused) {
  for (const double factor : {0.1, 10.0}) {
    MotorDatasheet s = read_datasheet(std::string(WINGBEAT_DATA) + "/motors/0816K003SR.toml");
    *s.resistance *= factor;
    const MotorIdentification found = identify_motor(s);
    EXPECT_FALSE(found.complete()) << factor;
    EXPECT_FALSE(found.armature_resistance.value.has_value());
    EXPECT_FALSE(found.torque_constant.value.has_value());
    EXPECT_TRUE(found.inertia.value.has_value());
    EXPECT_THAT(found.missing,
                testing::ElementsAre(HasSubstr("resistance and stall torque contradict each other about the armature "
                                               "resistance by a factor of ")));
    // Said to be that uncertain it is a value like any other.
    if (factor < 1.0) continue;
    s.deviations["resistance"] = 0.9;
    const MotorIdentification doubted = identify_motor(s);
    ASSERT_TRUE(doubted.complete()) << factor;
    EXPECT_NEAR(*doubted.armature_resistance.value, 5.4, 0.5) << factor;
  }
  MotorDatasheet s = exact_sheet(motor, 3.0);
  s.mechanical_time_constant = 10.0 * 5.4 * 5e-9 / (2.1e-3 * 2.1e-3);
  const MotorIdentification found = identify_motor(s);
  EXPECT_FALSE(found.inertia.value.has_value());
  EXPECT_TRUE(found.armature_resistance.value.has_value());
  // A point of the performance curve has no second way of its own.
  s = exact_sheet(motor, 3.0);
  s.points.push_back({{}, 3e-4, 0.05 * (2.1e-3 * 3.0 / 5.4 - 3e-4) / (2.1e-3 * 2.1e-3 / 5.4 + 3e-9), {}, {}});
  EXPECT_THAT(identify_motor(s).missing, testing::ElementsAre(HasSubstr(") and the rest of the sheet (")));
}

TEST(MotorIdentification, GearEfficiencyIsKept) {
  MotorDatasheet s = exact_sheet(motor, 3.0);
  s.gear_ratio = 20.0;
  s.gear_efficiency = 0.7;
  const MotorIdentification at_motor = identify_motor(s);
  EXPECT_THAT(at_motor.remarks, Contains(HasSubstr("its efficiency of 0.7 serves no reading")));
  EXPECT_THAT(motor_section(at_motor, s, "made by a test"), HasSubstr("\"\ngear_efficiency = 0.7\n"));
  EXPECT_THAT(json_identification(at_motor, s), HasSubstr("\"gear_efficiency\": 0.7"));
  s.shaft = Shaft::output;
  EXPECT_THAT(identify_motor(s).remarks, Contains(HasSubstr("the gear efficiency of 0.7 served to read")));
  s.gear_efficiency.reset();
  EXPECT_THAT(motor_section(identify_motor(s), s, "made by a test"), Not(HasSubstr("gear_efficiency")));
}

TEST(MotorIdentification, GearReferredToTheOutput) {
  MotorDatasheet s = exact_sheet(motor, 3.0);
  s.gear_ratio = 20.0;
  const Motor<double> m = identify_motor(s).motor();
  EXPECT_NEAR(m.torque_constant, 20.0 * 2.1e-3, 1e-6);
  EXPECT_NEAR(m.viscous_damping, 400.0 * 3e-9, 1e-9);
  EXPECT_NEAR(m.inertia, 400.0 * 5e-9, 1e-18);
  EXPECT_NEAR(m.armature_resistance, 5.4, 1e-5);
  // That motor stated at the output of a gearbox that eats a third of the torque.
  MotorDatasheet out = s;
  out.shaft = Shaft::output;
  out.gear_efficiency = 2.0 / 3.0;
  *out.no_load_speed /= 20.0;
  *out.stall_torque *= 20.0 * 2.0 / 3.0;
  EXPECT_NEAR(identify_motor(out).motor().torque_constant, 20.0 * 2.1e-3, 1e-6);
}

TEST(MotorIdentification, LossesNeedAFactOrANamedFallback) {
  MotorDatasheet s;
  s.resistance = 5.4;
  s.torque_constant = 2.1e-3;
  s.rotor_inertia = 5e-9;
  const MotorIdentification insensitive = identify_motor(s);
  EXPECT_THAT(insensitive.missing, testing::ElementsAre(HasSubstr("viscous damping: give no_load_current")));
  s.assume_typical_damping = true;
  const MotorIdentification assumed = identify_motor(s);
  ASSERT_TRUE(assumed.complete());
  EXPECT_EQ(assumed.motor().viscous_damping, 29.6e-9);
  EXPECT_THAT(assumed.remarks, Contains(HasSubstr("fallback: viscous damping")));
}

TEST(MotorIdentification, UnderdeterminedElectricalSideIsNamed) {
  MotorDatasheet s;
  s.voltage = 3.0;
  s.no_load_speed = 1400.0;
  s.rotor_inertia = 5e-9;
  const MotorIdentification found = identify_motor(s);
  EXPECT_FALSE(found.complete());
  EXPECT_THAT(found.missing, Contains(HasSubstr("armature resistance: give resistance")));
  EXPECT_THAT(found.missing, Contains(HasSubstr("torque constant: give torque_constant")));
}

TEST(Datasheet, MotorSectionReadsBackToTheSameMotor) {
  const MotorDatasheet sheet = read_datasheet(std::string(WINGBEAT_DATA) + "/motors/0816K003SR.toml");
  const MotorIdentification found = identify_motor(sheet);
  std::string vehicle = read_text_file(std::string(WINGBEAT_DATA) + "/designs/friction2022.toml");
  const auto from = vehicle.find("[motor]"), to = vehicle.find("[transmission]");
  vehicle.replace(from, to - from, motor_section(found, sheet, "made by a test") + "\n");
  const Motor<double> read = parse_design(vehicle, "vehicle.toml").motor.constants, m = found.motor();
  EXPECT_EQ(read.armature_resistance, m.armature_resistance);
  EXPECT_EQ(read.armature_inductance, m.armature_inductance);
  EXPECT_EQ(read.torque_constant, m.torque_constant);
  EXPECT_EQ(read.inertia, m.inertia);
  EXPECT_EQ(read.viscous_damping, m.viscous_damping);
  EXPECT_EQ(read.friction_torque, m.friction_torque);
}

TEST(Datasheet, StatedValuesAreWrittenAsStated) {
  MotorDatasheet s;
  s.voltage = 3.7;
  s.resistance = 2.6;
  s.torque_constant = 1.7e-3;
  s.no_load_current = 0.02;
  s.rotor_inertia = 5e-9;
  s.gear_ratio = 12.0;
  EXPECT_THAT(motor_section(identify_motor(s), s, "made by a test", Shaft::motor),
              HasSubstr("armature_resistance = \"2.6 ohm\"\narmature_inductance = \"0 H\"\n"
                        "torque_constant = \"0.0017 N m/A\"\ninertia = \"5e-09 kg m2\"\n"));
}

std::string error_of(const std::string& text) {
  try {
    parse_datasheet(text, "sheet.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Datasheet, RefusalsNamePlaceAndReason) {
  EXPECT_EQ(error_of("[datasheet]\nresistanc = \"5 ohm\"\n"),
            "sheet.toml:2:1: datasheet.resistanc: unknown key; did you mean resistance?");
  EXPECT_THAT(error_of("[datasheet]\nresistance = \"5 V\"\n"), HasSubstr("sheet.toml:2:"));
  EXPECT_THAT(error_of("[datasheet]\nresistance = \"-5 ohm\"\n"),
              HasSubstr("datasheet.resistance: must be > 0 [ohm], got -5"));
  EXPECT_THAT(error_of("[datasheet]\nno_load_current = \"16 mA\"\n"),
              HasSubstr("datasheet.voltage: missing: no-load, stall and performance values hold at one voltage"));
  EXPECT_THAT(error_of("[datasheet]\nshaft = \"output\"\nresistance = 5\n"),
              HasSubstr("datasheet.gear_ratio: missing"));
  EXPECT_THAT(error_of("[datasheet]\n[fallback]\ninertia = \"guess\"\n"),
              HasSubstr("fallback.inertia: expected one of solid-steel-cylinder, got \"guess\""));
  EXPECT_THAT(error_of("[datasheet]\n[fallback]\ninertia = \"solid-steel-cylinder\"\n"),
              HasSubstr("fallback.inertia: a solid steel cylinder needs rotor_diameter and rotor_length"));
}

}  // namespace
}  // namespace wingbeat

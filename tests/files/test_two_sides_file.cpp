// [left] and [right] of a vehicle file: what is read, and what is refused with file, line and key.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "wingbeat/files/two_sides_file.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;

std::string shipped_text(const char* name) {
  return read_text_file(std::filesystem::path(WINGBEAT_DATA) / "designs" / (std::string(name) + ".toml"));
}

const std::string& plain_text() {
  static const std::string text = shipped_text("purdue-flapper");
  return text;
}

std::string refusal_of_sides(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_vehicle(text, "v.toml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// Where the added lines begin.
std::string line_after_plain() {
  return std::to_string(1 + std::count(plain_text().begin(), plain_text().end(), '\n'));
}
std::string next_line_after_plain() {
  return std::to_string(2 + std::count(plain_text().begin(), plain_text().end(), '\n'));
}

TEST(TwoSidesFile, AFileWithoutSidesIsThePlainDesign) {
  const VehicleFile file = parse_vehicle(plain_text(), "v.toml");
  EXPECT_FALSE(file.sides);
  EXPECT_EQ(write_design(file.design), write_design(parse_design(plain_text(), "v.toml")));
}

TEST(TwoSidesFile, EachSideHasItsOwnNumbers) {
  const VehicleFile file =
      read_vehicle(std::filesystem::path(WINGBEAT_DATA) / "designs" / "sides" / "purdue-flapper-trimmed.toml");
  ASSERT_TRUE(file.sides);
  const auto& [whole, left, right] = *file.sides;
  EXPECT_EQ(whole.motors, 2.0);
  EXPECT_TRUE(whole.mass);
  EXPECT_EQ(left.motors, 1.0);
  EXPECT_FALSE(left.mass);
  EXPECT_EQ(left.motor.constants.armature_resistance, 14.780065776);
  EXPECT_EQ(right.motor.constants.armature_resistance, 13.763265084);
  EXPECT_FALSE(left.pitch.stop);
  EXPECT_EQ(left.pitch.stop_low, -0.765164977);
  EXPECT_EQ(right.pitch.stop_high, 0.854799666);
  EXPECT_EQ(left.spring.rest_angle, -0.0403463879);
  EXPECT_EQ(left.supply.voltage, right.supply.voltage);
}

TEST(TwoSidesFile, ATableOfLoadsIsOfTheWingsOfBothSides) {
  std::string text = plain_text();
  const auto line = text.find("coefficients = ");
  ASSERT_NE(line, std::string::npos);
  text.replace(line, text.find('\n', line) - line,
               "type = \"tabulated\"\nload_table = [[0, 0, -1, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0, 0], "
               "[0, 90, -1, 0, 0.1, 1e-3, 0], [0, 90, 1, 0, 0.1, 1e-3, 0]]");
  const VehicleFile alike = parse_vehicle(text, "v.toml");
  ASSERT_FALSE(alike.sides);
  const VehicleFile file = parse_vehicle(text + "[left]\nmotor.armature_resistance = \"14 ohm\"\n", "v.toml");
  ASSERT_TRUE(file.sides);
  for (const Design<double>* side : {&file.sides->left, &file.sides->right}) {
    EXPECT_DOUBLE_EQ(resolve(*side).wings.tabulated.factor, 0.5 * resolve(alike.design).wings.tabulated.factor);
  }
}

TEST(TwoSidesFile, KeysMayBeDottedOrStandInSections) {
  const std::string forms[] = {"[left]\n\"motor.armature_resistance\" = \"14 ohm\"\n",
                               "[left]\nmotor.armature_resistance = \"14 ohm\"\n",
                               "[left.motor]\narmature_resistance = 14\n"};
  for (const std::string& form : forms) {
    const VehicleFile file = parse_vehicle(plain_text() + form, "v.toml");
    ASSERT_TRUE(file.sides) << form;
    EXPECT_EQ(file.sides->left.motor.constants.armature_resistance, 14.0);
    EXPECT_EQ(file.sides->right.motor.constants.armature_resistance, 12.4);
  }
}

TEST(TwoSidesFile, EqualSidesAreThePlainVehicle) {
  const std::string both = "[left]\nmotor.inertia = 7.5e-10\n[right]\nmotor.inertia = \"7.5e-10 kg m2\"\n";
  const VehicleFile file = parse_vehicle(plain_text() + both, "v.toml");
  EXPECT_FALSE(file.sides);
  const std::string overrides[] = {"motor.inertia=7.5e-10"};
  EXPECT_EQ(write_design(file.design), write_design(parse_design(plain_text(), "v.toml", overrides)));
}

TEST(TwoSidesFile, OverridesComeAfterTheSides) {
  const std::string text = plain_text() + "[left]\nmotor.inertia = 7.5e-10\nmotor.armature_resistance = 14\n";
  const std::string overrides[] = {"motor.armature_resistance=13", "supply.amplitude=10 V"};
  const VehicleFile file = parse_vehicle(text, "v.toml", overrides);
  ASSERT_TRUE(file.sides);
  EXPECT_EQ(file.sides->left.motor.constants.armature_resistance, 13.0);
  EXPECT_EQ(file.sides->left.motor.constants.inertia, 7.5e-10);
  EXPECT_EQ(file.sides->right.supply.voltage, 10.0);
}

TEST(TwoSidesFile, RefusesWhatHasNoPlace) {
  const std::string below = "v.toml:" + next_line_after_plain() + ":1: ";
  const auto with = [](const std::string& lines) { return refusal_of_sides(plain_text() + lines); };
  EXPECT_EQ(with("[left]\n\"motor.armature_resistanc\" = 14\n"),
            below + "motor.armature_resistanc: unknown key; did you mean motor.armature_resistance?");
  EXPECT_EQ(with("[right]\n\"motor.armature_resistance\" = \"-3 ohm\"\n"),
            below + "motor.armature_resistance: must be > 0 [ohm], got -3");
  EXPECT_EQ(with("[right]\nsupply.amplitude = \"9 V\"\n"),
            "v.toml:" + next_line_after_plain() + ":8: supply.amplitude: is the whole vehicle's: both sides share it");
  EXPECT_EQ(with("[right]\n\"vehicle.mass\" = \"9 g\"\n"),
            below + "vehicle.mass: is the whole vehicle's: both sides share it");
  EXPECT_THAT(refusal_of_sides("left = 3\n" + plain_text()),
              HasSubstr("left: expected a section [left], keys of that side alone"));
  EXPECT_THAT(refusal_of_sides(plain_text() + "[left]\nmotor.inertia = 7e-10\n", {"vehicle.motors=1"}),
              HasSubstr("left: sides differ where vehicle.motors = 2, one motor on either side; there is 1"));
  const std::string crank = shipped_text("friction2022") + "[left]\nmotor.inertia = 1e-7\n";
  EXPECT_THAT(refusal_of_sides(crank), HasSubstr("left: the wings of one crank move together; sides differ where "
                                                 "transmission.type = \"direct\", it is \"slider-crank\""));
  EXPECT_THAT(refusal_of_sides(plain_text() + "[left]\nmotor.inertia = 7e-10\n",
                               {"supply={type=\"sine\",amplitude=9,resonance_ratio=1}"}),
              HasSubstr("supply.resonance_ratio would give the sides different frequencies"));
}

TEST(TwoSidesFile, OtherReadersRefuseIt) {
  try {
    parse_design(plain_text() + "[left]\nmotor.inertia = 7.5e-10\n", "v.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), "v.toml:" + line_after_plain() +
                                             ":2: left: this takes no vehicle whose sides differ; wingbeat run, "
                                             "linearise, trim, stability and fly do");
  }
}

}  // namespace
}  // namespace wingbeat

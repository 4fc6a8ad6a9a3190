// A vehicle file written back keeps the user's text.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>
#include <fstream>
#include <sstream>

#include "wingbeat/files/design_edit.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string vehicle = R"(# My flapper, 3rd prototype.

[wing]            # bought
count = 2
planform = { shape = "semi-ellipse", length = "63 mm", root_chord = "2.5 cm" } # glued
inertia = "0.7205 g cm2"

[supply]
type = 'constant'
voltage = 3       # bare: volts

[motor]
armature_resistance = "9 ohm"     # measured twice
armature_inductance = '29 mH'
torque_constant = "0.01 N m/A"
  inertia = "1.5e-7 kg m2"
viscous_damping = "3.6e-6 N m s/rad"
[transmission]
type = "slider-crank"
crank_radius = "5 mm"
rod_length = "20 mm"
stroke_amplitude = "39.8 deg"     # as drawn
formulation = "rod-force"

[friction]
type = "load-proportional"
radius = "2.5 mm" # mu r_e

[aerodynamics]
air_density = "1.225 kg/m3"
pitch_coefficient = "5 ms"
coefficients = "translational-2022"
# The end.
)";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

void set(Design<double>& design, std::string_view key, double value) {
  ASSERT_TRUE(numeric_parameter<double>(key).set(design, value)) << key;
}

double value(const Design<double>& design, std::string_view key) { return *numeric_parameter<double>(key).get(design); }

TEST(DesignEdit, ChangesTheValuesAloneInTheirOwnUnits) {
  Design<double> design = parse_design(vehicle, "v.toml");
  EXPECT_EQ(edited_design(vehicle, design), vehicle);
  set(design, "motor.armature_resistance", 8.25);
  set(design, "motor.armature_inductance", 0.0307);
  set(design, "motor.inertia", 1.75e-7);
  set(design, "supply.voltage", 3.5);
  set(design, "wing.planform.root_chord", 0.0262);
  set(design, "wing.inertia", 7.5e-8);
  set(design, "aerodynamics.pitch_coefficient", 0.0051);
  const std::string text = edited_design(vehicle, design);
  std::string expected = vehicle;
  const auto put = [&](const std::string& old, const std::string& now) {
    expected.replace(expected.find(old), old.size(), now);
  };
  put("\"9 ohm\"", "\"8.25 ohm\"");
  put("'29 mH'", "'30.7 mH'");
  put("1.5e-7 kg m2", "1.75e-07 kg m2");
  put("voltage = 3 ", "voltage = 3.5 ");
  put("\"2.5 cm\"", "\"2.62 cm\"");
  put("0.7205 g cm2", "0.75 g cm2");
  put("5 ms", "5.1 ms");
  EXPECT_EQ(text, expected);
}

TEST(DesignEdit, ReadsBackAsTheDesignForAnyDigits) {
  Design<double> design = parse_design(vehicle, "v.toml");
  double x = 0.37;
  for (int n = 0; n < 500; ++n) {
    x = 3.9 * x * (1.0 - x);
    const std::pair<const char*, double> values[] = {{"motor.armature_inductance", 0.1 * x},
                                                     {"transmission.crank_radius", 1e-3 * (4.0 + x)},
                                                     {"wing.inertia", 1e-7 * (0.1 + x)},
                                                     {"transmission.stroke_amplitude", 0.3 + 0.2 * x},
                                                     {"wing.planform.root_chord", 0.02 + 0.01 * x}};
    for (const auto& [key, number] : values) set(design, key, number);
    const std::string text = edited_design(vehicle, design);
    EXPECT_THAT(text, HasSubstr("# measured twice"));
    const Design<double> back = parse_design(text, "back.toml");
    for (const auto& [key, number] : values) EXPECT_NEAR(value(back, key) / number, 1.0, 1e-15) << key;
    const auto before = lines_of(vehicle), after = lines_of(text);
    ASSERT_EQ(before.size(), after.size());
    int changed = 0;
    for (std::size_t k = 0; k < before.size(); ++k) changed += before[k] != after[k];
    EXPECT_LE(changed, 5);
  }
}

TEST(DesignEdit, AlternativesTakeTheirPlaceAndNewKeysTheirSection) {
  Design<double> design = parse_design(vehicle, "v.toml");
  set(design, "transmission.hinge_offset", 0.0065);
  std::string text = edited_design(vehicle, design);
  EXPECT_THAT(text, HasSubstr("\nhinge_offset = \"0.0065 m\"     # as drawn\n"));
  EXPECT_THAT(text, Not(HasSubstr("stroke_amplitude")));

  design = parse_design(vehicle, "v.toml",
                        std::vector<std::string>{"motor.friction_torque=0.2 mN m", "spring.stiffness=1e-3 N m/rad",
                                                 "wing.planform.hub_offset=4 mm"});
  text = edited_design(vehicle, design);
  EXPECT_THAT(text,
              HasSubstr("viscous_damping = \"3.6e-6 N m s/rad\"\nfriction_torque = \"0.0002 N m\"\n[transmission]\n"));
  EXPECT_THAT(text, HasSubstr("root_chord = \"2.5 cm\", hub_offset = \"0.004 m\" } # glued\n"));
  EXPECT_THAT(text, HasSubstr("# The end.\n\n[spring]\nstiffness = \"0.001 N m/rad\"\n"));
  EXPECT_EQ(write_design(parse_design(text, "t.toml")), write_design(design));
}

TEST(DesignEdit, WhatHasNoPlaceAnyMoreBecomesAComment) {
  const Design<double> design = parse_design(
      vehicle, "v.toml", std::vector<std::string>{"friction.type=viscous", "friction.damping=1e-6 N m s/rad"});
  const std::string text = edited_design(vehicle, design);
  EXPECT_THAT(text, HasSubstr("type = \"viscous\"\n# radius = \"2.5 mm\" # mu r_e\ndamping = \"1e-06 N m s/rad\"\n"));
  EXPECT_EQ(write_design(parse_design(text, "t.toml")), write_design(design));
}

TEST(DesignEdit, LineEndsOfOtherSystemsStay) {
  std::string text;
  for (const char c : vehicle) text += c == '\n' ? "\r\n" : std::string(1, c);
  Design<double> design = parse_design(text, "v.toml");
  set(design, "transmission.crank_radius", 0.0055);
  std::string expected = text;
  expected.replace(expected.find("\"5 mm\""), 6, "\"5.5 mm\"");
  EXPECT_EQ(edited_design(text, design), expected);
  design = parse_design(text, "v.toml", std::vector<std::string>{"motor.friction_torque=0.2 mN m"});
  EXPECT_THAT(edited_design(text, design), HasSubstr("rad\"\r\nfriction_torque = \"0.0002 N m\"\r\n[transmission]"));
}

TEST(DesignEdit, TableFilesAreNamedFromTheNewPlace) {
  std::string pattern = testing::TempDir() + "wingbeat-edit-XXXXXX";
  const std::filesystem::path folder = ::mkdtemp(pattern.data());
  std::filesystem::create_directory(folder / "out");
  std::string text = vehicle;
  const std::string ellipse = "shape = \"semi-ellipse\", length = \"63 mm\", root_chord = \"2.5 cm\"";
  text.replace(text.find(ellipse), ellipse.size(), "shape = \"tabulated\", file = \"chords.csv\"");
  std::ofstream(folder / "chords.csv") << "distance_mm,chord_mm\n0,20\n30,22\n60,5\n";
  std::ofstream(folder / "v.toml") << text;
  Design<double> design = read_design(folder / "v.toml");
  set(design, "motor.armature_resistance", 8.0);
  const std::string moved = edited_design(folder / "v.toml", folder / "out" / "new.toml", design);
  EXPECT_THAT(moved, HasSubstr("file = \"../chords.csv\" } # glued"));
  std::ofstream(folder / "out" / "new.toml") << moved;
  EXPECT_EQ(write_design(read_design(folder / "out" / "new.toml")), write_design(design));
  EXPECT_THAT(edited_design(folder / "v.toml", folder / "new.toml", design), HasSubstr("file = \"chords.csv\" }"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace wingbeat

// Vehicle files of direct drives: what is read, what is written back, and what is refused with file, line and key.
#include <gtest/gtest.h>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

const std::string direct_file = R"([supply]
type = "sine"
amplitude = "3 V"
frequency = "22 Hz"
[motor]
armature_resistance = "9 ohm"
armature_inductance = 0
torque_constant = "0.01 N m/A"
inertia = "1.5e-7 kg m2"
viscous_damping = "3.6e-6 N m s/rad"
[transmission]
type = "direct"
[friction]
type = "constant"
torque = "1e-4 N m"
[spring]
resonance_ratio = 1
[wing]
count = 1
inertia = "7.205e-8 kg m2"
planform = { shape = "semi-ellipse", length = "60 mm", chord_ratio = 0.25, hub_offset = "4.5 mm" }
[aerodynamics]
air_density = "1.225 kg/m3"
pitch_coefficient = "5e-3 s"
angle_of_attack_min = "45 deg"
)";

std::string direct_with(const std::string& old, const std::string& replacement) {
  std::string text = direct_file;
  const auto position = text.find(old);
  EXPECT_NE(position, std::string::npos) << old;
  return text.replace(position, old.size(), replacement);
}

std::string refusal(const std::string& text) {
  try {
    parse_design(text, "v.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DirectFile, IsReadAndWrittenBack) {
  const Design<double> d = parse_design(direct_file, "v.toml");
  EXPECT_EQ(d.transmission.type, TransmissionType::direct);
  EXPECT_EQ(d.spring.resonance_ratio, 1.0);
  EXPECT_EQ(d.wing.planform.chord_ratio, 0.25);
  EXPECT_NEAR(*d.aerodynamics.angle_of_attack_min, pi / 4.0, 1e-16);
  const ChordMoments<double> by_ratio = chord_moments(d.wing.planform, 1.0);
  Planform<double> outright = d.wing.planform;
  outright.chord_ratio.reset();
  outright.root_chord = 0.015;
  EXPECT_NEAR(by_ratio.s2 / chord_moments(outright, 1.0).s2, 1.0, 1e-15);
  const std::string text = write_design(d);
  EXPECT_EQ(write_design(parse_design(text, "again.toml")), text);
  EXPECT_EQ(text.find("crank_radius"), std::string::npos);
  const Vehicle<double> v = resolve(d);
  EXPECT_EQ(v.drive_frequency, 22.0);
  EXPECT_NEAR(v.spring.stiffness / ((1.5e-7 + 7.205e-8) * square(two_pi * 22.0)), 1.0, 1e-15);
  EXPECT_EQ(v.wings.angle_of_attack_min, *d.aerodynamics.angle_of_attack_min);
}

TEST(DirectFile, TiesAreReadAndWrittenBack) {
  const std::string tied = direct_with("frequency = \"22 Hz\"", "resonance_ratio = 1.05");
  std::string text = tied;
  text.replace(text.find("resonance_ratio = 1\n"), 19, "stiffness = \"2e-3 N m/rad\"");
  text.replace(text.find("inertia = \"7.205e-8 kg m2\""), 26, "resonance = \"15 Hz\"");
  const Design<double> d = parse_design(text, "v.toml");
  EXPECT_NEAR(resolve(d).drive_frequency, 1.05 * 15.0, 1e-12);
  EXPECT_NEAR(resolve(d).wing_inertia, 2e-3 / square(two_pi * 15.0) - 1.5e-7, 1e-18);
  EXPECT_EQ(write_design(parse_design(write_design(d), "again.toml")), write_design(d));
}

TEST(DirectFile, RefusesWithPlaceAndKey) {
  EXPECT_EQ(refusal(direct_file), "accepted");
  EXPECT_EQ(refusal("[vehicle]\nmass = \"3 g\"\n" +
                    direct_with("type = \"direct\"", "type = \"direct\"\nrod_linear_density = \"1 g/m\"")),
            "v.toml:15:1: transmission.rod_linear_density: a direct drive has no rod");
  EXPECT_EQ(refusal(direct_with("type = \"constant\"\ntorque = \"1e-4 N m\"",
                                "type = \"load-proportional\"\nradius = 0.002")),
            "v.toml:13:2: friction.reference_radius: missing: load-proportional friction of a direct drive acts on the "
            "wings' moment over this radius, at which the shaft takes it up");
  EXPECT_EQ(refusal(direct_with("type = \"sine\"\namplitude = \"3 V\"\nfrequency = \"22 Hz\"",
                                "type = \"constant\"\nvoltage = 3\n")),
            "v.toml:2:1: supply.type: a direct drive swings as its supply does: expected sine or battery-sine");
  EXPECT_EQ(refusal(direct_with("type = \"direct\"", "type = \"direct\"\ncrank_radius = \"5 mm\"")),
            "v.toml:13:1: transmission.crank_radius: belongs to transmission.type = slider-crank or four-bar, but "
            "transmission.type is \"direct\"");
  EXPECT_EQ(
      refusal(direct_with("type = \"direct\"", "type = \"direct\"\nformulation = \"virtual-work\"")),
      "v.toml:13:1: transmission.formulation: belongs to transmission.type = slider-crank, but transmission.type is "
      "\"direct\"");
  EXPECT_EQ(
      refusal(direct_with("frequency = \"22 Hz\"\n", "")),
      "v.toml:1:2: supply.frequency: missing in [supply]; expected a frequency such as \"22 Hz\", or resonance_ratio "
      "instead");
  EXPECT_EQ(refusal(direct_with("frequency = \"22 Hz\"\n", "frequency = \"22 Hz\"\nresonance_ratio = 1\n")),
            "v.toml:5:1: supply.resonance_ratio: give frequency or resonance_ratio, not both");
  EXPECT_EQ(
      refusal(direct_with("frequency = \"22 Hz\"\n", "resonance_ratio = 1\n")),
      "v.toml:4:1: supply.resonance_ratio: ties the frequency to the springs, which spring.resonance_ratio ties to "
      "the frequency; give one of them");
  EXPECT_EQ(refusal(direct_with("resonance_ratio = 1\n", "resonance_ratio = 0\n")),
            "v.toml:17:1: spring.resonance_ratio: must be > 0 [1], got 0");
  EXPECT_EQ(refusal(direct_with("resonance_ratio = 1\n", "resonance_ratio = \"22 Hz\"\n")).substr(0, 37),
            "v.toml:17:1: spring.resonance_ratio: ");
  EXPECT_EQ(refusal(direct_with("resonance_ratio = 1\n", "resonance_ratio = 1\nstiffness = 1\n")),
            "v.toml:17:1: spring.resonance_ratio: give stiffness or resonance_ratio, not both");
  EXPECT_EQ(refusal(direct_with("inertia = \"7.205e-8 kg m2\"", "resonance = \"22 Hz\"")),
            "v.toml:20:1: wing.resonance: gives the inertia that resonates on a known spring; give spring.stiffness");
  EXPECT_EQ(refusal(direct_with("chord_ratio = 0.25", "chord_ratio = 0")),
            "v.toml:21:56: wing.planform.chord_ratio: must be > 0 [1], got 0");
  EXPECT_EQ(refusal(direct_with("chord_ratio = 0.25", "chord_ratio = 0.25, root_chord = 0.01")).substr(0, 13),
            "v.toml:21:56:");
  EXPECT_EQ(refusal(direct_with("\"45 deg\"", "\"95 deg\"")).substr(0, 74),
            "v.toml:25:1: aerodynamics.angle_of_attack_min: must be >= 0 and < pi/2 [ra");
  EXPECT_EQ(refusal(direct_with("\"45 deg\"", "\"45 s\"")).substr(0, 47),
            "v.toml:25:1: aerodynamics.angle_of_attack_min: ");
}

}  // namespace
}  // namespace wingbeat

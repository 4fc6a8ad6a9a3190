// Vehicle files that are refused: place, key and what was expected.
#include <gmock/gmock.h>

#include <fstream>

#include "files/vehicle_text.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using namespace design_file_test;
using testing::HasSubstr;

// One test for each class of refusal.

TEST(DesignErrors, NotToml) {
  EXPECT_EQ(refusal(with("\"9 ohm\"", "9 ohm")),
            "v.toml:7:25: not TOML: in a key-value pair, expected a comment or whitespace, saw 'o'; a text or a "
            "quantity "
            "with a unit stands in quotes, as in \"5 mm\"");
  EXPECT_EQ(refusal(with("[motor]", "[motor")), "v.toml:6:7: not TOML: in a table header, expected ']', saw '\\n'");
  EXPECT_THAT(refusal(with("test", "\xff")), HasSubstr(": not TOML: invalid utf-8 sequence"));
}

TEST(DesignErrors, FileCannotBeRead) {
  const auto refusal_of = [](const std::filesystem::path& file) -> std::string {
    try {
      read_design(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal_of("no/such.toml"), "no/such.toml: no such file");
  EXPECT_EQ(refusal_of(designs), designs.string() + ": is a directory, not a file");
}

TEST(DesignErrors, UnknownKeyOrSection) {
  EXPECT_EQ(refusal(with("torque_constant", "torque_constan")),
            "v.toml:9:1: motor.torque_constan: unknown key; did you mean motor.torque_constant?");
  EXPECT_EQ(refusal(with("[friction]", "[fricton]")), "v.toml:18:2: fricton: unknown key; did you mean [friction]?");
  EXPECT_EQ(refusal(with("s3 =", "s4 =")),
            "v.toml:23:53: wing.planform.s4: unknown key; did you mean wing.planform.s2?");
  EXPECT_THAT(refusal(with("[wing]", "[wing]\nmass = 1")),
              HasSubstr("wing.mass: unknown key; did you mean body.wing_mass?"));
  EXPECT_EQ(refusal("voltage = 3\n" + vehicle_text), "v.toml:1:1: voltage: unknown key; did you mean supply.voltage?");
  EXPECT_THAT(refusal(with("voltage =", "'supply.voltage' =")),
              HasSubstr("v.toml:5:1: supply.\"supply.voltage\": unknown key"));
}

TEST(DesignErrors, TheFirstUnknownKeyIsReported) {
  EXPECT_THAT(refusal(with("[motor]", "[motor]\nzzz = 1\naaa = 1")), HasSubstr("v.toml:7:1: motor.zzz: unknown key"));
}

TEST(DesignErrors, Batteries) {
  std::string text = with("\"constant\"", battery_supply);
  text.erase(text.find("voltage = \"3 V\"\n"), 16);
  const auto spoiled = [&](const std::string& from, const std::string& to) {
    std::string s = text;
    const auto position = s.find(from);
    EXPECT_NE(position, std::string::npos) << from;
    return refusal(s.replace(position, from.size(), to));
  };
  EXPECT_EQ(spoiled("\"50 mA h\"", "\"50 mV\""),
            "v.toml:5:1: supply.capacity: expected an electric charge such as \"50 mA h\", got \"50 mV\"");
  EXPECT_EQ(spoiled("\"50 mA h\"", "0"), "v.toml:5:1: supply.capacity: must be > 0 [C], got 0");
  EXPECT_EQ(spoiled("\"0.8 ohm\"", "-1"), "v.toml:6:1: supply.internal_resistance: must be >= 0 [ohm], got -1");
  EXPECT_EQ(spoiled("capacity", "charge = 1.5\ncapacity"),
            "v.toml:5:1: supply.charge: must lie between 0 and 1 [1], got 1.5");
  EXPECT_EQ(spoiled("capacity", "cells = 0\ncapacity"),
            "v.toml:5:1: supply.cells: must be a whole number >= 1 [1], got 0");
  EXPECT_EQ(spoiled("capacity", "cutoff_voltage = -3\ncapacity"),
            "v.toml:5:1: supply.cutoff_voltage: must be >= 0 [V], got -3");
  EXPECT_EQ(spoiled("capacity", "cell_voltage = 3.7\ncapacity"),
            "v.toml:8:1: supply.discharge_curve: give cell_voltage or discharge_curve, not both");
  EXPECT_EQ(spoiled("capacity", "voltage = 3\ncapacity"),
            "v.toml:5:1: supply.voltage: belongs to supply.type = constant or pwm, but supply.type is \"battery\"");
  EXPECT_EQ(spoiled("[0.5, 3.7]", "[0.5]"), "v.toml:7:1: supply.discharge_curve: row 2 must hold 2 values");
  EXPECT_EQ(spoiled("[0.5, 3.7]", "[0.5, 2.9]"),
            "v.toml:7:1: supply.discharge_curve: row 2 of the discharge curve must not have a lower voltage than the "
            "row before it");
  EXPECT_EQ(spoiled("[0, \"3 V\"]", "[0.1, \"3 V\"]"),
            "v.toml:7:1: supply.discharge_curve: the states of charge must run from 0 to 1");
  EXPECT_EQ(spoiled("[[0, \"3 V\"], [0.5, 3.7], [1, \"4200 mV\"]]", "[]"),
            "v.toml:7:1: supply.discharge_curve: has no rows");
  EXPECT_EQ(spoiled("discharge_curve = [[0, \"3 V\"], [0.5, 3.7], [1, \"4200 mV\"]]", "cell_voltage = 0"),
            "v.toml:7:1: supply.cell_voltage: must be > 0 [V], got 0");
  EXPECT_EQ(spoiled("discharge_curve = [[0, \"3 V\"], [0.5, 3.7], [1, \"4200 mV\"]]", ""),
            "v.toml:3:2: supply.cell_voltage: missing in [supply]; expected a voltage such as \"3 V\", or "
            "discharge_curve instead");
  EXPECT_EQ(spoiled("capacity = \"50 mA h\"\n", ""),
            "v.toml:3:2: supply.capacity: missing in [supply]; expected an electric charge such as \"50 mA h\"");
  EXPECT_EQ(
      refusal(with("\"3 V\"", "\"3 V\"\ncapacity = 3")),
      "v.toml:6:1: supply.capacity: belongs to supply.type = battery or battery-sine, but supply.type is \"constant\"");
}

TEST(DesignErrors, MissingKeyOrSection) {
  EXPECT_EQ(refusal(without_line("inertia = \"1.5e-7 kg m2\"")),
            "v.toml:6:2: motor.inertia: missing in [motor]; expected a moment of inertia such as \"1.5e-7 kg m2\"");
  EXPECT_EQ(refusal(without_line("crank_radius = \"5 mm\"")),
            "v.toml:12:2: transmission.crank_radius: missing in [transmission]; expected a length such as \"5 mm\"");
  EXPECT_EQ(refusal(without_line("hinge_offset = \"6 mm\"")),
            "v.toml:12:2: transmission.hinge_offset: missing in [transmission]; expected a length such as \"5 mm\", or "
            "stroke_amplitude instead");
  EXPECT_EQ(refusal(without_line("formulation = \"rod-force\"")),
            "v.toml:12:2: transmission.formulation: missing in [transmission]; expected rod-force or virtual-work: "
            "virtual-work conserves power and is the choice for a new vehicle, rod-force is equation (1) of the 2022 "
            "paper as printed");
  EXPECT_EQ(refusal(without_line("type = \"constant\"")),
            "v.toml:3:2: supply.type: missing in [supply]; expected constant, sine, pwm, battery or battery-sine");
  EXPECT_EQ(refusal(with("[friction]\ntype = \"load-proportional\"\nradius = \"2.5 mm\"\n", "")),
            "v.toml:23:1: friction: missing section [friction]: the friction law; without friction write type = "
            "\"none\"");
  EXPECT_EQ(refusal(vehicle_text + "[spring]\n"),
            "v.toml:27:2: spring.stiffness: missing in [spring]; expected a torsional stiffness such as "
            "\"1.4e-3 N m/rad\", or resonance instead");
  EXPECT_EQ(refusal(with("planform = { shape = \"moments\", s2 = \"2.457e-6 m4\", s3 = \"1.048e-7 m5\" }\n", "")),
            "v.toml:21:2: wing.planform: missing in [wing]; expected a table such as { shape = \"semi-ellipse\", "
            "length = \"63 mm\", root_chord = \"25 mm\" }");
  EXPECT_EQ(refusal(""), "v.toml:1:1: supply: missing section [supply]: the voltage at the motor terminals");
}

TEST(DesignErrors, WrongType) {
  EXPECT_EQ(refusal(with("\"3 V\"", "true")),
            "v.toml:5:1: supply.voltage: expected a voltage such as \"3 V\", got a boolean");
  EXPECT_EQ(refusal(with("\"3 V\"", "nan")),
            "v.toml:5:1: supply.voltage: expected a voltage such as \"3 V\", got the number nan");
  EXPECT_EQ(refusal(with("\"3 V\"", "[3]")),
            "v.toml:5:1: supply.voltage: expected a voltage such as \"3 V\", got an array");
  EXPECT_EQ(refusal(with("\"3 V\"", "2022-01-01")),
            "v.toml:5:1: supply.voltage: expected a voltage such as \"3 V\", got a date");
  EXPECT_EQ(refusal(with("\"test vehicle\"", "7")), "v.toml:2:1: vehicle.name: expected a text, got the number 7");
  EXPECT_EQ(refusal(with("[motor]", "[[motor]]")),
            "v.toml:6:3: motor: expected a section [motor], got a list of tables");
  EXPECT_EQ(refusal(with("\"constant\"", "\"steady\"")),
            "v.toml:4:1: supply.type: expected constant, sine, pwm, battery or battery-sine, got \"steady\"");
  EXPECT_EQ(refusal(with("\"slider-crank\"", "\"geared\"")),
            "v.toml:13:1: transmission.type: expected slider-crank, four-bar, tabulated or direct, got \"geared\"");
}

TEST(DesignErrors, WrongDimensionOrUnit) {
  EXPECT_EQ(refusal(with("\"5 mm\"", "\"5 kg\"")),
            "v.toml:14:1: transmission.crank_radius: expected a length such as \"5 mm\", got \"5 kg\"");
  EXPECT_EQ(refusal(with("\"5 mm\"", "\"5 mn\"")),
            "v.toml:14:1: transmission.crank_radius: expected a length such as \"5 mm\", got \"5 mn\" with the "
            "unknown unit "
            "\"mn\"");
  EXPECT_EQ(refusal(with("\"5 mm\"", "\"mm\"")),
            "v.toml:14:1: transmission.crank_radius: expected a length such as \"5 mm\", got \"mm\", which does not "
            "begin "
            "with a number");
}

// It decides whether the rest of its section applies, of which nothing is said then.
TEST(DesignErrors, AForcePerVoltThatCannotBeRead) {
  std::string text = read_text_file(designs / "robobee-piezo.toml");
  const std::string stated = "\"1.150 mN/V\"";
  text.replace(text.find(stated), stated.size(), "\"1.150 mN\"");
  try {
    parse_design(text, "v.toml");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.key(), "piezo.force_per_volt");
    for (const InputError& other : error.others()) ADD_FAILURE() << other.what();
  }
}

TEST(DesignErrors, OutOfRange) {
  EXPECT_EQ(refusal(with("\"9 ohm\"", "\"-9 ohm\"")),
            "v.toml:7:1: motor.armature_resistance: must be > 0 [ohm], got -9");
  EXPECT_EQ(refusal(with("[wing]", "[wing]\ncount = 1.5")),
            "v.toml:22:1: wing.count: must be a whole number >= 1 [1], got 1.5");
  EXPECT_EQ(refusal(with("s2 = \"2.457e-6 m4\"", "s2 = -1")),
            "v.toml:23:33: wing.planform.s2: must be >= 0 [m4], got -1");
}

TEST(DesignErrors, Duplicates) {
  EXPECT_EQ(refusal(with("voltage = \"3 V\"", "voltage = 3\nvoltage = 4")), "v.toml:6:11: \"voltage\" is given twice");
  EXPECT_EQ(refusal(vehicle_text + "[motor]\n"), "v.toml:27:1: \"motor\" is given twice");
  EXPECT_EQ(refusal(with("[friction]", "stroke_amplitude = 0.7\n[friction]")),
            "v.toml:18:1: transmission.stroke_amplitude: give hinge_offset or stroke_amplitude, not both");
  EXPECT_EQ(refusal(vehicle_text + "[spring]\nstiffness = 1e-3\nresonance = 22\n"),
            "v.toml:29:1: spring.resonance: give stiffness or resonance, not both");
}

TEST(DesignErrors, KeyOfAnotherChoice) {
  EXPECT_EQ(refusal(with("radius = \"2.5 mm\"", "radius = \"2.5 mm\"\ndamping = 1e-6")),
            "v.toml:21:1: friction.damping: belongs to friction.type = viscous, but friction.type is "
            "\"load-proportional\"");
  EXPECT_EQ(refusal(with("\"3 V\"", "\"3 V\"\nfrequency = 20")),
            "v.toml:6:1: supply.frequency: belongs to supply.type = sine or pwm or battery-sine, but supply.type is "
            "\"constant\"");
  EXPECT_EQ(refusal(with("[motor]", "[motor]\ngear_inertia = 1e-9")),
            "v.toml:7:1: motor.gear_inertia: needs motor.gear_ratio, which is not given");
  EXPECT_EQ(refusal(with("\"moments\"", "\"moments\", length = 1")),
            "v.toml:23:33: wing.planform.length: belongs to wing.planform.shape = semi-ellipse or rectangle, but "
            "wing.planform.shape is \"moments\"");
  EXPECT_EQ(refusal(vehicle_text + "coefficients = { table = [], lift = { offset = 1 } }\n"),
            "v.toml:27:30: aerodynamics.coefficients.lift: give table, or lift and drag, not both");
}

TEST(DesignErrors, Coefficients) {
  EXPECT_EQ(refusal(vehicle_text + "coefficients = \"theodorsen\"\n"),
            "v.toml:27:1: aerodynamics.coefficients: expected translational-2022, normal-force-robofly, robobee, "
            "normal-tangential or a table of coefficients, got \"theodorsen\"");
  EXPECT_EQ(refusal(vehicle_text + "coefficients = { lift = { offset = 1, amplitude = 1, rate = 2, phase = 0 } }\n"),
            "v.toml:27:1: aerodynamics.coefficients.drag.offset: missing in [aerodynamics.coefficients.drag]; "
            "expected a "
            "number such as 2");
  EXPECT_EQ(refusal(vehicle_text + "coefficients = { table = [[0, 1, 1], [1, 1, 1], [0.5, 1, 1]] }\n"),
            "v.toml:27:18: aerodynamics.coefficients.table: row 3 of the coefficient table must have a larger angle of "
            "attack than the row before it");
  EXPECT_EQ(refusal(vehicle_text + "coefficients = { table = [[0, 1]] }\n"),
            "v.toml:27:18: aerodynamics.coefficients.table: row 1 must hold 3 values");
}

TEST(DesignErrors, TableFiles) {
  const auto refusal_of = [](const std::string& csv) {
    return refusal(with("shape = \"moments\", s2 = \"2.457e-6 m4\", s3 = \"1.048e-7 m5\"",
                        "shape = \"tabulated\", file = \"c.csv\""),
                   {}, [&](const std::string&) { return csv; });
  };
  const std::string where = "v.toml:23:35: wing.planform.file: ";
  EXPECT_EQ(refusal_of(""), where + "c.csv: is empty; expected a header such as distance_mm,chord_mm");
  EXPECT_EQ(refusal_of("distance,chord_mm\n"),
            where + "c.csv:1:1: column \"distance\" names no unit; expected a header such as distance_mm,chord_mm");
  EXPECT_EQ(refusal_of("distance_mm,chord_kg\n"), where + "c.csv:1:13: expected a length such as \"5 mm\", got \"kg\"");
  EXPECT_EQ(refusal_of("x_mm,chord_mm\n"),
            where + "c.csv:1:1: unknown column \"x_mm\"; expected a header such as distance_mm,chord_mm");
  EXPECT_EQ(refusal_of("distance_mm,chord_mm\n0,1\n1\n"), where + "c.csv:3:1: expected 2 numbers, got 1");
  EXPECT_EQ(refusal_of("distance_mm,chord_mm\n0, x\n"), where + "c.csv:2:4: expected a number, got \"x\"");
  EXPECT_EQ(refusal_of("distance_mm,chord_mm\n0,1\n"), where + "the chord table needs at least two rows");
  EXPECT_NE(refusal(vehicle_text, {"wing.planform={shape='tabulated'}"}).find("wing.planform.file: missing"),
            std::string::npos);
  EXPECT_EQ(refusal(vehicle_text, {"wing.planform={shape='tabulated', file='c.csv'}"}),
            "--set wing.planform={shape='tabulated', file='c.csv'}: wing.planform.file: table files cannot be read "
            "here; "
            "give the rows in place");
}

TEST(DesignErrors, Nesting) {
  std::string keys = "a", brackets = "a=";
  for (int n = 0; n < 100000; ++n) keys += ".a";
  EXPECT_EQ(refusal("\n" + keys + "=1"), "v.toml:2:34: nested more than 16 levels deep, which no vehicle file is");
  EXPECT_EQ(refusal(brackets + std::string(100000, '[')),
            "v.toml:1:19: nested more than 16 levels deep, which no vehicle file is");
  EXPECT_EQ(refusal(vehicle_text + "# ........................ \"[[[[[[[[[[[[[[[[[[[[[[[[[\n"), "accepted");
  EXPECT_EQ(refusal(with("test vehicle", "..................[[[[[[[[[[[[[[[[[[[[[[[#")), "accepted");
  EXPECT_EQ(refusal(std::string(5 << 20, '\n')), "v.toml: larger than 4 MB, which no vehicle file is");
}

TEST(DesignErrors, TableHeaderWithoutAName) {
  for (const char* header : {"[=", "[&", "[[[1]]]", "[[=", "[ ]", "[", "[[ ."}) {
    EXPECT_EQ(refusal(std::string("\n").append(header)),
              "v.toml:2:1: not TOML: a table header needs a name, as in [motor]");
  }
}

TEST(DesignErrors, LettersOutsideAscii) {
  EXPECT_EQ(refusal("[vehicle]\nname = \"ä\" ö"), "v.toml:2:12: not TOML: a letter outside ASCII belongs in quotes");
  EXPECT_EQ(refusal("a = \"\"\"\\\n é\"\"\""),
            "v.toml:1:8: a backslash before a letter outside ASCII is not supported");
  EXPECT_EQ(parse_design(with("\"test vehicle\"", "\"\"\"ä \\\n  b \\u00e9\"\"\" # ü"), "v.toml").name, "ä b é");
}

TEST(DesignErrors, QuoteInsideAWord) {
  EXPECT_EQ(refusal("a = 5\"mm\""), "v.toml:1:6: not TOML: a quote inside a word");
  EXPECT_EQ(refusal("a = \"5\"\"mm\""), "v.toml:1:8: not TOML: a quote inside a word");
  EXPECT_EQ(parse_design(with("\"test vehicle\"", "\"\"\"\"quoted\"\"\"\""), "v.toml").name, "\"quoted\"");
}

TEST(DesignErrors, CarryTheirPlace) {
  try {
    parse_design(with("\"9 ohm\"", "\"-9 ohm\""), "v.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "v.toml");
    EXPECT_EQ(error.line(), 7);
    EXPECT_EQ(error.column(), 1);
    EXPECT_EQ(error.key(), "motor.armature_resistance");
  }
}

}  // namespace
}  // namespace wingbeat

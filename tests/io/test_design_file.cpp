#include "wingbeat/files/design_file.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cstdint>
#include <fstream>
#include <map>

#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using Overrides = std::vector<std::string>;
using testing::HasSubstr;

const std::filesystem::path designs = std::filesystem::path(WINGBEAT_DATA) / "designs";
const std::filesystem::path test_data = std::filesystem::path(WINGBEAT_DATA) / ".." / "tests" / "io" / "data";

// Line numbers count in the tests below.
const std::string vehicle_text = R"([vehicle]
name = "test vehicle"
[supply]
type = "constant"
voltage = "3 V"
[motor]
armature_resistance = "9 ohm"
armature_inductance = "29 mH"
torque_constant = "0.01 N m/A"
inertia = "1.5e-7 kg m2"
viscous_damping = "3.6e-6 N m s/rad"
[transmission]
type = "slider-crank"
crank_radius = "5 mm"
rod_length = "20 mm"
hinge_offset = "6 mm"
formulation = "rod-force"
[friction]
type = "load-proportional"
radius = "2.5 mm"
[wing]
inertia = "7.205e-8 kg m2"
planform = { shape = "moments", s2 = "2.457e-6 m4", s3 = "1.048e-7 m5" }
[aerodynamics]
air_density = "1.225 kg/m3"
pitch_coefficient = "5e-3 s"
)";

/// The test vehicle with the first occurrence of one text replaced by another.
std::string with(const std::string& from, const std::string& to) {
  std::string text = vehicle_text;
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string without_line(const std::string& line) { return with(line + "\n", ""); }

std::string refusal(const std::string& text, const Overrides& overrides = {}, const TableLoader& load = {}) {
  try {
    parse_design(text, "v.toml", overrides, load);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

std::string override_refusal(const std::string& assignment) { return refusal(vehicle_text, {assignment}); }

/// Bits of every number and every text of a design.
std::map<std::string, std::string> fingerprint(const Design<double>& d) {
  std::map<std::string, std::string> result;
  const auto bits = [](double x) { return std::to_string(std::bit_cast<std::uint64_t>(x)); };
  for (const auto& key : parameter_table<double>()) {
    const std::string path(key.path);
    if (key.text) {
      result[path] = key.text(d);
    } else if (const auto x = key.get(d)) {
      result[path] = bits(*x);
    }
  }
  for (const auto& [x, chord] : d.wing.planform.chord_table) result["chords"] += bits(x) + " " + bits(chord) + " ";
  if (const auto& table = d.aerodynamics.coefficients.table) {
    for (const auto* column : {&table->alpha(), &table->lift(), &table->drag()}) {
      for (const double x : *column) result["table"] += bits(x) + " ";
    }
  }
  result["coefficients_name"] = d.aerodynamics.coefficients_name;
  return result;
}

TEST(DesignFile, ReadsTheReferenceVehicle) {
  const Design<double> d = read_design(designs / "friction2022.toml");
  EXPECT_EQ(d.name, "slider-crank flapper of the 2022 friction paper");
  EXPECT_EQ(d.mass, 0.00334);
  EXPECT_EQ(d.supply.type, SupplyType::constant);
  EXPECT_EQ(d.supply.voltage, 3.0);
  EXPECT_FALSE(d.motor.gear_ratio);
  EXPECT_EQ(d.motor.constants.armature_inductance, 0.029);
  EXPECT_EQ(d.motor.constants.friction_torque, 0.0);
  EXPECT_EQ(d.transmission.crank_radius, 0.005);
  EXPECT_EQ(d.transmission.hinge_offset, 0.006);
  EXPECT_EQ(d.friction.law, FrictionLaw::load_proportional);
  EXPECT_EQ(d.friction.coefficient, 0.0025);
  EXPECT_FALSE(d.spring.stiffness || d.spring.resonance);
  EXPECT_EQ(d.wing.count, 2.0);
  EXPECT_EQ(d.wing.planform.shape, PlanformShape::moments);
  EXPECT_EQ(d.wing.planform.s2, 2.457e-6);
  EXPECT_EQ(d.aerodynamics.pitch_coefficient, 0.005);
  EXPECT_EQ(d.aerodynamics.coefficients.lift.amplitude, 1.58);
  EXPECT_EQ(d.bench_torque_constant, 7.664e-3);
  EXPECT_EQ(read_design(designs / "friction2022-springs.toml").spring.stiffness, 1.377e-3);
}

TEST(DesignFile, DefaultsAreTheDocumentedOnes) {
  const Design<double> d = parse_design(vehicle_text, "v.toml");
  EXPECT_EQ(d.wing.count, 2.0);
  EXPECT_FALSE(d.transmission.mid_stroke_height);
  EXPECT_FALSE(d.mass);
  EXPECT_EQ(d.aerodynamics.coefficients_name, "translational-2022");
  EXPECT_EQ(parse_design(without_line("name = \"test vehicle\""), "v.toml").name, "");
}

TEST(DesignFile, WritesWhatReadsBackBitIdentical) {
  const std::string chords = "wing.planform={shape='tabulated', chords=[[0, '25 mm'], ['1e-2 ft', 0.3], [0.1, 0]]}";
  const Overrides variants[] = {
      {},
      {"vehicle.name='a \"quoted\" \\ nämé'", "vehicle.mass=0.1 lb", "bench.torque_constant=0.1"},
      {"supply.type=sine", "supply.amplitude=3.3 V", "supply.frequency=22.1 Hz"},
      {"supply.type=pwm", "supply.frequency=20 kHz", "supply.duty=0.3", "spring.resonance=22.3 Hz"},
      {"motor.gear_ratio=10.5", "motor.gear_inertia=1e-9", "motor.gear_damping=1e-8", "motor.friction_torque=1 uN m"},
      {"transmission.stroke_amplitude=39.8 deg", "transmission.formulation=virtual-work"},
      {"transmission.mid_stroke_height=0.0201", "friction.type=none", "spring.stiffness=1.1e-3 N m"},
      {"friction.type=viscous", "friction.damping=1e-6"},
      {"friction.type=quadratic", "friction.coefficient=1e-8"},
      {"friction.type=constant", "friction.torque=0.1 mN m"},
      {"wing.planform={shape='semi-ellipse', length='63 mm', root_chord='25 mm', hub_offset='3 mm'}", "wing.count=4"},
      {"wing.planform={shape='rectangle', length='6.3 cm', root_chord='1 inch'}"},
      {chords, "aerodynamics.air_density=0"},
      {"aerodynamics.coefficients.lift.offset=-0.0"},
      {"aerodynamics.coefficients={table=[['0 deg', 0.1, 0.2], ['45 deg', 1.7, 2e22], ['90 deg', 0, -3.3]]}"}};
  for (const Overrides& overrides : variants) {
    const Design<double> design = parse_design(vehicle_text, "v.toml", overrides);
    const std::string text = write_design(design);
    EXPECT_EQ(fingerprint(parse_design(text, "written.toml")), fingerprint(design)) << text;
  }
}

TEST(DesignFile, MassesAreStatedBesideTheVehicles) {
  const Overrides masses = {"vehicle.mass=1.5 g",    "supply.mass=0.8 g", "motor.mass=0.6 g",
                            "spring.stiffness=1e-3", "spring.mass=50 mg", "transmission.rod_linear_density=5 g/m"};
  const Design<double> d = parse_design(vehicle_text, "v.toml", masses);
  EXPECT_DOUBLE_EQ(*total_mass(d), 1.5e-3 + 0.8e-3 + 0.6e-3 + 5e-3 * d.transmission.rod_length + 1e-4);
  EXPECT_EQ(fingerprint(parse_design(write_design(d), "w.toml")), fingerprint(d));
  const std::string mass = "vehicle.mass=1.5 g";
  EXPECT_EQ(refusal(vehicle_text, {mass, "motor.mass=-1 g"}),
            "--set motor.mass=-1 g: motor.mass: must be >= 0 [kg], got -0.001");
  EXPECT_EQ(refusal(vehicle_text, {mass, "transmission.rod_linear_density=5 g"}),
            "--set transmission.rod_linear_density=5 g: transmission.rod_linear_density: expected a mass over a length "
            "such as \"2 g/m\", got \"5 g\"");
  EXPECT_EQ(override_refusal("motor.mass=1 g"),
            "--set motor.mass=1 g: motor.mass: needs vehicle.mass, which is not given");
}

TEST(DesignFile, BothMotorFormsGiveTheSameVehicle) {
  // n = 10: K = n K_b, J = J_G + n^2 J_m, b = b_G + n^2 b_m.
  const Overrides geared = {"motor.gear_ratio=10",       "motor.torque_constant=1e-3", "motor.inertia=1.4e-9",
                            "motor.gear_inertia=1e-8",   "motor.viscous_damping=3e-8", "motor.gear_damping=0.6e-6",
                            "motor.friction_torque=1e-6"};
  const Motor<double> m = resolve(parse_design(vehicle_text, "v.toml", geared)).motor;
  const Overrides output_shaft = {"motor.friction_torque=1e-5"};
  const Motor<double> output = resolve(parse_design(vehicle_text, "v.toml", output_shaft)).motor;
  EXPECT_DOUBLE_EQ(m.torque_constant, output.torque_constant);
  EXPECT_DOUBLE_EQ(m.inertia, output.inertia);
  EXPECT_DOUBLE_EQ(m.viscous_damping, output.viscous_damping);
  EXPECT_DOUBLE_EQ(m.friction_torque, output.friction_torque);
  EXPECT_EQ(m.armature_resistance, output.armature_resistance);
}

TEST(DesignFile, ChordTableGivesTheClosedForm) {
  const TableLoader load = [](const std::string& name) { return read_text_file(test_data / name); };
  const Overrides table = {"wing.planform={shape='tabulated', file='semi_ellipse_mm.csv', hub_offset='4 mm'}"};
  const Overrides closed = {
      "wing.planform={shape='semi-ellipse', length='63 mm', root_chord='25 mm', hub_offset='4 mm'}"};
  const auto a = resolve(parse_design(vehicle_text, "v.toml", table, load)).wings;
  const auto b = resolve(parse_design(vehicle_text, "v.toml", closed)).wings;
  EXPECT_NEAR(a.s2 / b.s2, 1.0, 2e-4);
  EXPECT_NEAR(a.s3 / b.s3, 1.0, 2e-4);
}

TEST(DesignFile, CoefficientTableFollowsTheNamedSet) {
  const TableLoader load = [](const std::string& name) { return read_text_file(test_data / name); };
  const Design<double> d =
      parse_design(vehicle_text, "v.toml", Overrides{"aerodynamics.coefficients.table=translational.csv"}, load);
  EXPECT_EQ(d.aerodynamics.coefficients_name, "table");
  for (const double alpha : {0.3, 0.8, 1.3}) {
    EXPECT_NEAR(lift_coefficient(d.aerodynamics.coefficients, alpha), lift_coefficient(translational_2022(), alpha),
                1e-3);
    EXPECT_NEAR(drag_coefficient(d.aerodynamics.coefficients, alpha), drag_coefficient(translational_2022(), alpha),
                1e-3);
  }
}

TEST(DesignFile, TableFilesAreSoughtBesideTheVehicle) {
  const auto folder = std::filesystem::temp_directory_path() / "wingbeat-test-design-file";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "v.toml") << with("{ shape = \"moments\", s2 = \"2.457e-6 m4\", s3 = \"1.048e-7 m5\" }",
                                           "{ shape = \"tabulated\", file = \"chords.csv\" }");
  std::ofstream(folder / "chords.csv") << "\xEF\xBB\xBF"
                                          "distance_mm,chord_mm\r\n0,25\r\n\r\n63,20\r\n";
  const auto& table = read_design(folder / "v.toml").wing.planform.chord_table;
  EXPECT_THAT(table, testing::ElementsAre(std::pair(0.0, 0.025), std::pair(0.063, 0.02)));
  std::filesystem::remove_all(folder);
}

TEST(DesignFile, ByteOrderMarkAndCarriageReturns) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : vehicle_text) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(fingerprint(parse_design(text, "v.toml")), fingerprint(parse_design(vehicle_text, "v.toml")));
}

TEST(DesignFile, DottedKeysAndSubTables) {
  std::string text = with("[supply]\ntype = \"constant\"\nvoltage = \"3 V\"\n", "");
  text = "supply.type = 'constant'\nsupply . 'voltage' = 3\n" + text;
  EXPECT_EQ(fingerprint(parse_design(text, "v.toml")), fingerprint(parse_design(vehicle_text, "v.toml")));
}

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
  EXPECT_EQ(refusal("voltage = 3\n" + vehicle_text), "v.toml:1:1: voltage: unknown key; did you mean supply.voltage?");
  EXPECT_THAT(refusal(with("voltage =", "'supply.voltage' =")),
              HasSubstr("v.toml:5:1: supply.\"supply.voltage\": unknown key"));
}

TEST(DesignErrors, TheFirstUnknownKeyIsReported) {
  EXPECT_THAT(refusal(with("[motor]", "[motor]\nzzz = 1\naaa = 1")), HasSubstr("v.toml:7:1: motor.zzz: unknown key"));
}

constexpr const char* battery_supply =
    "\"battery\"\ncapacity = \"50 mA h\"\ninternal_resistance = \"0.8 ohm\"\n"
    "discharge_curve = [[0, \"3 V\"], [0.5, 3.7], [1, \"4200 mV\"]]";

TEST(DesignFile, BatteryIsReadAndWrittenBack) {
  std::string text = with("\"constant\"", battery_supply);
  text.erase(text.find("voltage = \"3 V\"\n"), 16);
  const Design<double> d = parse_design(text, "v.toml");
  const Battery<double>& b = d.supply.battery;
  EXPECT_EQ(d.supply.type, SupplyType::battery);
  EXPECT_DOUBLE_EQ(b.capacity, 180.0);
  EXPECT_EQ(b.cells, 1.0);
  EXPECT_EQ(b.charge, 1.0);
  EXPECT_EQ(b.internal_resistance, 0.8);
  ASSERT_EQ(b.discharge_curve.size(), 3u);
  EXPECT_EQ(b.discharge_curve[2], std::pair(1.0, 4.2));
  EXPECT_FALSE(b.cutoff_voltage);
  const std::string written = write_design(d);
  EXPECT_EQ(write_design(parse_design(written, "again.toml")), written);
  const std::string constant[] = {"supply.cell_voltage=\"3.7 V\"", "supply.cells=2"};
  const Design<double> flat = parse_design(text, "v.toml", constant);
  EXPECT_TRUE(flat.supply.battery.discharge_curve.empty());
  EXPECT_EQ(resolve(flat).voltage, 7.4);
  const std::string file[] = {"supply.discharge_curve=\"cell.csv\""};
  const Design<double> read = parse_design(text, "v.toml", file, [](const std::string& name) {
    EXPECT_EQ(name, "cell.csv");
    return std::string("voltage_mV,charge\n3100,0\n4100,1\n");
  });
  EXPECT_DOUBLE_EQ(read.supply.battery.discharge_curve[1].second, 4.1);
}

TEST(DesignErrors, Batteries) {
  std::string text = with("\"constant\"", battery_supply);
  text.erase(text.find("voltage = \"3 V\"\n"), 16);
  const auto spoiled = [&](const std::string& from, const std::string& to) {
    std::string s = text;
    const auto at = s.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return refusal(s.replace(at, from.size(), to));
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
  EXPECT_EQ(refusal(with("\"3 V\"", "\"3 V\"\ncapacity = 3")),
            "v.toml:6:1: supply.capacity: belongs to supply.type = battery, but supply.type is \"constant\"");
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
            "v.toml:3:2: supply.type: missing in [supply]; expected constant, sine, pwm or battery");
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
            "v.toml:4:1: supply.type: expected constant, sine, pwm or battery, got \"steady\"");
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
            "v.toml:6:1: supply.frequency: belongs to supply.type = sine or pwm, but supply.type is \"constant\"");
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
            "v.toml:27:1: aerodynamics.coefficients: expected \"translational-2022\" or a table of coefficients, got "
            "\"theodorsen\"");
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

Design<double> overridden(const Overrides& overrides) { return parse_design(vehicle_text, "v.toml", overrides); }

TEST(Overrides, TakeTomlValuesAndBareStrings) {
  EXPECT_EQ(overridden({"supply.voltage=\"3.7 V\""}).supply.voltage, 3.7);
  EXPECT_EQ(overridden({"supply.voltage=3.7 V"}).supply.voltage, 3.7);
  EXPECT_EQ(overridden({" supply.voltage = 3.7 "}).supply.voltage, 3.7);
  EXPECT_EQ(overridden({"vehicle.name=a = b"}).name, "a = b");
  EXPECT_EQ(overridden({"wing.planform={shape=\"moments\", s2=1e-6, s3=2e-8}"}).wing.planform.s3, 2e-8);
  EXPECT_EQ(overridden({"supply.voltage=1", "supply.voltage=2"}).supply.voltage, 2.0);
}

TEST(Overrides, CreateSectionsAndReplaceAlternatives) {
  EXPECT_EQ(overridden({"spring.stiffness=1 mN m/rad"}).spring.stiffness, 1e-3);
  const auto amplitude = overridden({"transmission.stroke_amplitude=40 deg"}).transmission;
  EXPECT_FALSE(amplitude.hinge_offset);
  EXPECT_TRUE(amplitude.stroke_amplitude);
  const Overrides resonance = {"spring.resonance=22 Hz"};
  const auto spring = read_design(designs / "friction2022-springs.toml", resonance).spring;
  EXPECT_FALSE(spring.stiffness);
  EXPECT_EQ(spring.resonance, 22.0);
  EXPECT_EQ(refusal(vehicle_text, {"spring.resonance=22", "spring.stiffness=1"}),
            "--set spring.resonance=22: spring.resonance: give stiffness or resonance, not both");
}

TEST(Overrides, ChangeTypesInAnyOrder) {
  for (const Overrides& overrides : {Overrides{"friction.type=viscous", "friction.damping=1e-6"},
                                     Overrides{"friction.damping=1e-6", "friction.type=viscous"}}) {
    const auto friction = overridden(overrides).friction;
    EXPECT_EQ(friction.law, FrictionLaw::viscous);
    EXPECT_EQ(friction.coefficient, 1e-6);
  }
  EXPECT_EQ(overridden({"friction.type=none"}).friction.law, FrictionLaw::none);
  EXPECT_EQ(overridden({"supply.type=sine", "supply.amplitude=2", "supply.frequency=30"}).supply.voltage, 2.0);
  const auto planform =
      overridden({"wing.planform.shape=rectangle", "wing.planform.length=63 mm", "wing.planform.root_chord=20 mm"})
          .wing.planform;
  EXPECT_EQ(planform.shape, PlanformShape::rectangle);
  EXPECT_EQ(planform.s2, 0.0);
}

TEST(Overrides, SpellOutNamedCoefficients) {
  const auto coefficients =
      overridden({"aerodynamics.coefficients=translational-2022", "aerodynamics.coefficients.lift.offset=0.3"})
          .aerodynamics;
  EXPECT_EQ(coefficients.coefficients_name, "custom");
  EXPECT_EQ(coefficients.coefficients.lift.offset, 0.3);
  EXPECT_EQ(coefficients.coefficients.drag.phase, translational_2022().drag.phase);
  // The default set as well, which the file does not name.
  EXPECT_EQ(overridden({"aerodynamics.coefficients.lift.offset=0.3"}).aerodynamics.coefficients.lift.amplitude, 1.58);
}

TEST(Overrides, NameThemselvesInErrors) {
  EXPECT_EQ(override_refusal("motor.inertia=-1"), "--set motor.inertia=-1: motor.inertia: must be > 0 [kg m2], got -1");
  EXPECT_EQ(override_refusal("motor.inerta=1"),
            "--set motor.inerta=1: motor.inerta: unknown key; did you mean motor.inertia?");
  EXPECT_EQ(override_refusal("motor.inertia=5 mm"),
            "--set motor.inertia=5 mm: motor.inertia: expected a moment of inertia such as \"1.5e-7 kg m2\", got \"5 "
            "mm\"");
  EXPECT_EQ(override_refusal("wing.planform={shape='rectangle', lenght=1}"),
            "--set wing.planform={shape='rectangle', lenght=1}: wing.planform.lenght: unknown key; did you mean "
            "wing.planform.length?");
  EXPECT_EQ(override_refusal("friction.damping=1e-6"),
            "--set friction.damping=1e-6: friction.damping: belongs to friction.type = viscous, but friction.type is "
            "\"load-proportional\"");
  EXPECT_EQ(override_refusal("motor=3"), "--set motor=3: motor: expected a section [motor], got the number 3");
  EXPECT_EQ(override_refusal("nonsense"), "--set nonsense: expected KEY=VALUE, as in --set supply.voltage=\"3 V\"");
  EXPECT_EQ(override_refusal("=1"),
            "--set =1: unknown key; the sections are [vehicle], [supply], [motor], "
            "[transmission], [friction], [spring], [wing], [aerodynamics], [bench]");
  EXPECT_EQ(override_refusal("supply.voltage=1\nmotor.inertia=2"),
            "--set supply.voltage=1\\nmotor.inertia=2: neither a TOML value nor one line of plain UTF-8 text");
  EXPECT_THAT(override_refusal("vehicle.name=\xff"),
              HasSubstr("neither a TOML value nor one line of plain UTF-8 text"));
}

}  // namespace
}  // namespace wingbeat

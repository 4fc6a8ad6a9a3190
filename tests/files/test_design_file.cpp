// Vehicle files: what is read, what is written back, overrides.
#include <gmock/gmock.h>

#include <bit>
#include <cstdint>
#include <fstream>

#include "files/design_settings.hpp"
#include "files/vehicle_text.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using namespace design_file_test;
using testing::HasSubstr;

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
    EXPECT_EQ(fingerprint(design_of(document_of(design, "the design"), {})), fingerprint(design)) << text;
  }
}

TEST(DesignFile, ValuesInTomlReadBack) {
  for (const double x : {1e-7, -0.0, 5.0, 0.1, 1e22, 123456789012345680.0, -2.5e-300}) {
    TomlNode node;
    node.kind = TomlNode::Kind::number;
    node.number = x;
    const TomlNode read = parse_toml_tree("x = " + toml_value(node), "values").members.at(0).node;
    EXPECT_EQ(read.kind, TomlNode::Kind::number);
    EXPECT_FALSE(read.whole);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.number), std::bit_cast<std::uint64_t>(x)) << toml_value(node);
  }
}

TEST(DesignFile, NamedCoefficientsBringTheirRotationTerms) {
  std::string text = without_line("pitch_coefficient = \"5e-3 s\"");
  text += "[pitch]\nstiffness = \"6e-4 N m/rad\"\n";
  const Overrides wing = {"wing.pitch_inertia=3e-9", "wing.mass_product=8e-9",
                          "wing.planform={shape='semi-ellipse', length='63 mm', root_chord='25 mm'}"};
  const auto read = [&](Overrides more) {
    more.insert(more.end(), wing.begin(), wing.end());
    const Design<double> d = parse_design(text, "v.toml", more);
    EXPECT_EQ(fingerprint(parse_design(write_design(d), "w.toml")), fingerprint(d)) << write_design(d);
    EXPECT_EQ(parse_design(write_design(d), "w.toml").pitch.rotational_lift, d.pitch.rotational_lift);
    return d.pitch;
  };
  const std::string robofly = "aerodynamics.coefficients=normal-force-robofly";
  EXPECT_TRUE(read({}).rotational_lift);
  EXPECT_EQ(read({}).damping_coefficient, 0.0);
  EXPECT_FALSE(read({robofly}).rotational_lift);
  EXPECT_EQ(read({robofly}).damping_coefficient, 5.0);
  // What a file states holds.
  EXPECT_TRUE(read({robofly, "pitch.rotational_lift=true"}).rotational_lift);
  EXPECT_FALSE(read({"pitch.rotational_lift=false"}).rotational_lift);
  EXPECT_EQ(read({"pitch.damping_coefficient=2", "pitch.leading_edge_suction=0.5"}).damping_coefficient, 2.0);
  EXPECT_EQ(read({"pitch.leading_edge_suction=0.5"}).edge_suction, 0.5);
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
            "--set =1: unknown key; the sections are [vehicle], [supply], [motor], [electronics], [piezo], "
            "[transmission], [friction], [spring], [wing], [pitch], [aerodynamics], [bench], [body]");
  EXPECT_EQ(override_refusal("supply.voltage=1\nmotor.inertia=2"),
            "--set supply.voltage=1\\nmotor.inertia=2: neither a TOML value nor one line of plain UTF-8 text");
  EXPECT_THAT(override_refusal("vehicle.name=\xff"),
              HasSubstr("neither a TOML value nor one line of plain UTF-8 text"));
}

}  // namespace
}  // namespace wingbeat

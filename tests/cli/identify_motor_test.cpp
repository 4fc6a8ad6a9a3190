#include <gmock/gmock.h>

#include "program.hpp"

namespace cli {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class IdentifyMotor : public Program {};

const std::string faulhaber = data + "/motors/0816K003SR.toml";

TEST_F(IdentifyMotor, WritesAMotorThatAVehicleFileTakes) {
  const std::string out = path("motor.toml");
  const Outcome o = run({"identify-motor", faulhaber, "-o", out});
  EXPECT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "wrote " + out + "\n");
  EXPECT_THAT(o.out, HasSubstr("resistance and stall torque disagree about the armature resistance by 1.9 %"));
  std::string vehicle = read(plain);
  const auto from = vehicle.find("[motor]"), to = vehicle.find("[transmission]");
  vehicle.replace(from, to - from, read(out) + "\n");
  std::ofstream(path("vehicle.toml")) << vehicle;
  EXPECT_EQ(run({"run", path("vehicle.toml"), "--condition", "wingless"}).status, 0);
}

// A vehicle with either section is the same; with the motor shaft's constants the gear ratio can be varied.
TEST_F(IdentifyMotor, TheMotorShaftsConstantsLeaveTheGearRatioFree) {
  const auto vehicle_with = [&](const std::string& section) {
    std::string vehicle = read(plain);
    const auto from = vehicle.find("[motor]"), to = vehicle.find("[transmission]");
    vehicle.replace(from, to - from, read(section) + "\n");
    std::ofstream(path("vehicle.toml")) << vehicle;
    return path("vehicle.toml");
  };
  EXPECT_EQ(run({"identify-motor", faulhaber, "-o", path("output.toml")}).status, 0);
  EXPECT_EQ(run({"identify-motor", faulhaber, "-o", path("motor.toml"), "--motor-shaft"}).status, 0);
  EXPECT_THAT(read(path("motor.toml")), HasSubstr("constants at the motor shaft"));
  EXPECT_THAT(read(path("motor.toml")), HasSubstr("[motor]\ngear_ratio = 20\n"));
  const std::vector<std::string> wingless = {"--condition", "wingless", "--json"};
  const auto frequency = [&](const std::string& section, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"run", vehicle_with(section)};
    arguments.insert(arguments.end(), wingless.begin(), wingless.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, 0) << o.err;
    return o.json()["frequency_hz"].get<double>();
  };
  const double one = frequency(path("output.toml"), {});
  EXPECT_NEAR(frequency(path("motor.toml"), {}) / one, 1.0, 1e-9);
  EXPECT_LT(frequency(path("motor.toml"), {"--set", "motor.gear_ratio=30"}), one);
  const Outcome lost = run({"identify-motor", faulhaber, "--motor-shaft"});
  EXPECT_EQ(lost.status, 2);
  EXPECT_THAT(lost.err, HasSubstr("says how -o writes the motor"));
}

TEST_F(IdentifyMotor, HandsOnWhatTheSheetSaysOfHeat) {
  const std::string heat = "thermal_resistance_winding = \"20 K/W\"\n", rest = "thermal_resistance_case = \"48 K/W\"\n";
  std::ofstream(path("sheet.toml")) << read(faulhaber) << heat << rest << "winding_temperature_max = \"85 degC\"\n";
  EXPECT_EQ(run({"identify-motor", path("sheet.toml"), "-o", path("motor.toml")}).status, 0);
  EXPECT_THAT(read(path("motor.toml")),
              HasSubstr("thermal_resistance_winding = \"20 K/W\"\nthermal_resistance_case = \"48 K/W\"\n"
                        "winding_temperature_max = \"85 degC\"\n"));
  std::ofstream(path("half.toml")) << read(faulhaber) << heat;
  EXPECT_THAT(run({"identify-motor", path("half.toml")}).err, HasSubstr("give both thermal resistances"));
}

TEST_F(IdentifyMotor, ReadsAHeatingCurve) {
  const std::string heated = data + "/motors/0816K003SR-heating.toml";
  const Outcome o = run({"identify-motor", heated, "-o", path("motor.toml")});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("Heat, from heating-0816.csv"));
  const Json heat = run({"identify-motor", heated, "--json"}).json()["heat"];
  const std::pair<const char*, double> truths[] = {{"thermal_resistance_winding", 20.0},
                                                   {"thermal_resistance_case", 48.0},
                                                   {"thermal_time_constant_winding", 5.0},
                                                   {"thermal_time_constant_case", 200.0}};
  for (const auto& [key, truth] : truths) {
    EXPECT_LT(heat[key]["low"].get<double>(), truth) << key;
    EXPECT_GT(heat[key]["high"].get<double>(), truth) << key;
    EXPECT_THAT(read(path("motor.toml")), HasSubstr("\n" + std::string(key) + " = \""));
  }
  // A vehicle takes what is written.
  std::string vehicle = read(plain);
  const auto from = vehicle.find("[motor]"), to = vehicle.find("[transmission]");
  vehicle.replace(from, to - from, read(path("motor.toml")) + "\n");
  std::ofstream(path("vehicle.toml")) << vehicle;
  EXPECT_EQ(run({"run", path("vehicle.toml"), "--condition", "wingless"}).status, 0);
}

TEST_F(IdentifyMotor, OfAHeatingCurveAlone) {
  const std::string curve = read(data + "/bench/heating-0816.csv");
  std::ofstream(path("all.csv")) << curve;
  const auto sheet = [&](const std::string& file, const std::string& more = "voltage = \"2 V\"\n") {
    std::ofstream(path("heat.toml")) << "[datasheet]\nresistance = \"5.4 ohm\"\n[heating]\nfile = \"" << file << "\"\n"
                                     << "ambient_temperature = \"22 degC\"\n"
                                     << more;
    return path("heat.toml");
  };
  const Outcome all = run({"identify-motor", sheet("all.csv"), "-o", path("motor.toml")});
  EXPECT_EQ(all.status, 0) << all.err;
  EXPECT_THAT(all.out, testing::Not(HasSubstr("Constants at the output shaft")));
  EXPECT_THAT(read(path("motor.toml")), HasSubstr(": heat alone.\n\n[motor]\nthermal_resistance_winding = \""));

  // The first half minute says too little of the case.
  std::ofstream(path("short.csv")) << curve.substr(0, curve.find("\n30,"));
  const Outcome little = run({"identify-motor", sheet("short.csv"), "-o", path("none.toml")});
  EXPECT_EQ(little.status, 2);
  EXPECT_THAT(little.out, HasSubstr("too short for the case"));
  EXPECT_THAT(little.out, HasSubstr("heat capacity of the case"));
  EXPECT_THAT(little.err, HasSubstr("the curve does not determine both thermal resistances: no file was written"));
  EXPECT_FALSE(fs::exists(path("none.toml")));

  const auto said = [&](const std::string& file, const std::string& more = "voltage = \"2 V\"\n") {
    const Outcome o = run({"identify-motor", sheet(file, more)});
    EXPECT_EQ(o.status, 2);
    return o.err;
  };
  EXPECT_THAT(said("nothing.csv"), HasSubstr("heating.file: there is no file"));
  std::ofstream bare(path("bare.csv"));
  bare << "time [s],current [A]\n";
  for (int n = 1; n < 20; ++n) bare << n << ",0.3\n";
  bare.close();
  EXPECT_THAT(said("bare.csv", ""), HasSubstr("heating.file: shows no temperature"));
  EXPECT_THAT(said("all.csv", "current = \"1 A\"\n"), HasSubstr("is a column of all.csv as well"));
  std::ofstream(path("back.csv")) << "time [s],current [A]\n1,0.3\n1,0.2\n";
  EXPECT_THAT(said("back.csv"), HasSubstr("back.csv:3:1: time: must grow from row to row: 1 s after 1 s"));
  std::ofstream(path("word.csv")) << "time [s],current [A]\n1,much\n";
  EXPECT_THAT(said("word.csv"), HasSubstr("word.csv:2:3: current [A]: expected a number, got \"much\""));
}

TEST_F(IdentifyMotor, JsonHoldsConstantsAndContradictions) {
  const Json json = run({"identify-motor", faulhaber, "--json"}).json();
  EXPECT_EQ(json["complete"], true);
  EXPECT_NEAR(json["motor"]["armature_resistance"]["value"].get<double>(), 5.4, 0.1);
  EXPECT_NEAR(json["motor"]["inertia"]["value"].get<double>(), 400.0 * 5.1e-9, 1e-15);
  EXPECT_GT(json["contradictions"].size(), 0U);
}

TEST_F(IdentifyMotor, AnIncompleteSheetIsRefusedByName) {
  std::ofstream(path("sheet.toml"))
      << "[datasheet]\nvoltage = \"6 V\"\nno_load_speed = \"270 rpm\"\n"
         "no_load_current = \"20 mA\"\nstall_torque = \"43 mN m\"\n"
         "stall_current = \"0.36 A\"\nrotor_diameter = \"7 mm\"\nrotor_length = \"8 mm\"\n";
  const Outcome o = run({"identify-motor", path("sheet.toml"), "-o", path("motor.toml"), "--frequency", "22 Hz"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.out, HasSubstr("rotor inertia: give rotor_inertia or mechanical_time_constant"));
  EXPECT_THAT(o.out, HasSubstr("no inductance given: assumed 0; at 22 Hz"));
  EXPECT_THAT(o.err, HasSubstr("does not determine the motor: no file was written"));
  EXPECT_THAT(files(), testing::ElementsAre("sheet.toml"));
  EXPECT_EQ(run({"identify-motor", path("sheet.toml"), "--fallback", "inertia=solid-steel-cylinder"}).status, 0);
  EXPECT_THAT(run({"identify-motor", path("sheet.toml"), "--fallback", "inertia=wood"}).err,
              HasSubstr("must be inertia=solid-steel-cylinder or viscous_damping=typical"));
}

TEST_F(IdentifyMotor, HelpShowsAnExampleThatRuns) {
  EXPECT_THAT(run({"identify-motor", "--help"}).out, HasSubstr("wingbeat identify-motor 0816K003SR -o"));
}

}  // namespace
}  // namespace cli

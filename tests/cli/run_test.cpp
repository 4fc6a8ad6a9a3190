#include <gmock/gmock.h>

#include <chrono>
#include <cmath>

#include "program.hpp"
#include "wingbeat/cycle/metrics.hpp"

namespace cli {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;

class Run : public Program {};

std::vector<std::string> keys_of(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

/// The contract's keys, in its order.
const std::vector<std::string> contract_keys = {"status",
                                                "status_detail",
                                                "domain",
                                                "domain_detail",
                                                "warnings",
                                                "voltage_v",
                                                "frequency_hz",
                                                "current_mean_a",
                                                "current_peak_a",
                                                "current_rms_a",
                                                "power_electrical_w",
                                                "power_motor_w",
                                                "power_motor_reference_w",
                                                "power_friction_w",
                                                "power_aerodynamic_w",
                                                "power_reactive_w",
                                                "power_copper_w",
                                                "power_viscous_w",
                                                "power_motor_friction_w",
                                                "power_gear_w",
                                                "power_electronics_w",
                                                "power_loss_w",
                                                "power_residual_w",
                                                "lift_mean_n",
                                                "lift_peak_n",
                                                "rod_force_peak_n",
                                                "rod_force_mean_n",
                                                "stroke_amplitude_rad",
                                                "flapping_velocity_peak_rad_per_s",
                                                "angle_of_attack_min_deg",
                                                "crank_speed_min_rad_per_s",
                                                "crank_speed_max_rad_per_s",
                                                "efficiency_system",
                                                "efficiency_motor",
                                                "efficiency_mechanism",
                                                "floquet_multiplier_max",
                                                "lift_to_weight",
                                                "winding_temperature_degc",
                                                "case_temperature_degc",
                                                "winding_temperature_margin_k",
                                                "added_mass_inertia_ratio",
                                                "power_hinge_w",
                                                "pitch_amplitude_deg",
                                                "pitch_phase_deg",
                                                "angle_of_attack_max_deg",
                                                "lift_added_mass_share",
                                                "reynolds_number",
                                                "stroke_angle_max_rad",
                                                "induced_velocity_m_per_s",
                                                "hover_s",
                                                "endurance_s"};

void expect_same_metrics(const Json& a, const Json& b, double tolerance) {
  for (const std::string& key : contract_keys) {
    if (!a.at(key).is_number() || !b.at(key).is_number()) continue;
    const double expected = b.at(key).get<double>();
    EXPECT_NEAR(a.at(key).get<double>(), expected, tolerance * std::abs(expected)) << key;
  }
}

TEST_F(Run, JsonIsOneObjectWithTheContractsKeysAndNothingElse) {
  const Outcome o = run({"run", plain, "--json"});
  EXPECT_EQ(o.status, 0);
  EXPECT_THAT(o.err, IsEmpty());
  const Json json = o.json();
  EXPECT_EQ(keys_of(json), contract_keys);
  EXPECT_EQ(o.out.front(), '{');
  EXPECT_EQ(o.out.substr(o.out.size() - 2), "}\n");
  EXPECT_EQ(json["status"], "flapping");
  for (std::size_t k = 5; k < contract_keys.size(); ++k) {
    const std::string& key = contract_keys[k];
    const bool option = key.find("temperature") != std::string::npos || key == "added_mass_inertia_ratio" ||
                        key == "lift_added_mass_share" || key.find("pitch") == 0 || key == "power_hinge_w" ||
                        key == "power_electronics_w" || key == "angle_of_attack_max_deg" || key == "reynolds_number" ||
                        key == "hover_s" || key == "endurance_s" || key == "stroke_angle_max_rad" ||
                        key == "induced_velocity_m_per_s";
    EXPECT_EQ(json[key].is_number(), !option) << key;
  }
  EXPECT_EQ(json["voltage_v"], 3.0);
}

TEST_F(Run, NumbersReadBackToTheSameDouble) {
  const Json json = run({"run", plain, "--json"}).json();
  EXPECT_EQ(Json::parse(json.dump()), json);
  EXPECT_GT(json["frequency_hz"].dump().size(), 14U);
}

TEST_F(Run, TableNamesStatusMetricsAndBooks) {
  const Outcome o = run({"run", plain});
  EXPECT_EQ(o.status, 0);
  EXPECT_THAT(o.err, IsEmpty());
  for (const char* part :
       {"slider-crank flapper", "flapping: steady flapping at 21.", "Operating point", "copper loss",
        "energy-balance error", "mean lift", "mN", "stroke amplitude", "deg", "Floquet", "iterates, closed to"}) {
    EXPECT_THAT(o.out, HasSubstr(part));
  }
  std::istringstream lines(o.out);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 90U) << line;
    EXPECT_TRUE(line.empty() || line.back() != ' ') << line;
  }
}

TEST_F(Run, LiftBelowTheWeightIsSaidNotToHover) {
  EXPECT_THAT(run({"run", plain}).out, HasSubstr("below weight: cannot hover"));
  const Outcome light = run({"run", plain, "--set", "vehicle.mass=0.5 g"});
  EXPECT_THAT(light.out, HasSubstr("   can hover"));
  // Every mass stated for itself is carried too, also where a lift over weight is asked for.
  const std::vector<std::string> heavy = {"--set", "vehicle.mass=0.5 g", "--set", "motor.mass=1 g"};
  const Json json =
      run({"run", plain, "--json", "--lift-to-weight", "0.5", heavy[0], heavy[1], heavy[2], heavy[3]}).json();
  EXPECT_NEAR(json["lift_to_weight"].get<double>(), 0.5, 1e-6);
}

TEST_F(Run, SetReplacesKeysInOrder) {
  const Json base = run({"run", plain, "--json"}).json();
  const Json set = run({"run", plain, "--json", "--set", "supply.voltage=9 V", "--set", "supply.voltage=4 V", "--set",
                        "wing.planform={shape=\"moments\", s2=2.457e-6, s3=1.048e-7}"})
                       .json();
  EXPECT_EQ(set["voltage_v"], 4.0);
  EXPECT_GT(set["frequency_hz"].get<double>(), base["frequency_hz"].get<double>());
  EXPECT_EQ(run({"run", plain, "--json", "--set", "supply.voltage=4 V"}).out,
            run({"run", plain, "--json", "--voltage", "4 V"}).out);
  EXPECT_EQ(run({"run", plain, "--json", "--voltage", "4000 mV"}).json()["voltage_v"], 4.0);
}

TEST_F(Run, ConditionsTakeAwayAirAndWings) {
  const Json air = run({"run", plain, "--json", "--condition", "air"}).json();
  const Json vacuum = run({"run", plain, "--json", "--condition", "vacuum"}).json();
  const Json wingless = run({"run", plain, "--json", "--condition", "wingless"}).json();
  EXPECT_EQ(vacuum["lift_mean_n"], 0.0);
  EXPECT_GT(vacuum["rod_force_mean_n"].get<double>(), 0.0);
  EXPECT_EQ(wingless["rod_force_mean_n"], 0.0);
  EXPECT_LT(air["frequency_hz"], vacuum["frequency_hz"]);
  // omega = K v / (K^2 + R_a b)
  EXPECT_NEAR(wingless["frequency_hz"].get<double>(), 0.01 * 3.0 / (1e-4 + 9.0 * 3.6e-6) / (2.0 * M_PI), 1e-6);
}

TEST_F(Run, AbsentMetricsAreNull) {
  std::string text = read(plain);
  text.replace(text.find("mass ="), 6, "# mas=");
  text.erase(text.find("[bench]"));
  std::ofstream(path("bare.toml")) << text;
  const Json json = run({"run", path("bare.toml"), "--json"}).json();
  EXPECT_TRUE(json["lift_to_weight"].is_null());
  EXPECT_TRUE(json["power_motor_reference_w"].is_null());
  EXPECT_EQ(keys_of(json), contract_keys);
}

TEST_F(Run, FrequencyIsReached) {
  for (const std::string& vehicle : {plain, springs}) {
    const Outcome o = run({"run", vehicle, "--json", "--frequency", "22 Hz"});
    ASSERT_EQ(o.status, 0) << o.err;
    EXPECT_NEAR(o.json()["frequency_hz"].get<double>(), 22.0, 22e-6);
    const std::string voltage = o.json()["voltage_v"].dump();
    const Json again = run({"run", vehicle, "--json", "--voltage", voltage}).json();
    expect_same_metrics(again, o.json(), 1e-6);
  }
  EXPECT_NEAR(run({"run", plain, "--json", "--frequency", "1320 rpm", "--tolerance", "1e-11"})
                  .json()["frequency_hz"]
                  .get<double>(),
              22.0, 22e-11);
}

TEST_F(Run, FrequencyBelowTheRangeLocksAndSaysFromWhereItFlaps) {
  const Outcome o = run({"run", springs, "--json", "--frequency", "1 Hz"});
  EXPECT_EQ(o.status, 3);
  EXPECT_EQ(o.json()["status"], "locked");
  EXPECT_TRUE(o.json()["frequency_hz"].is_null());
  EXPECT_THAT(o.json()["status_detail"].get<std::string>(),
              MatchesRegex("1 Hz cannot be reached: from rest it flaps only above 1\\.[0-9]+ V, and there at "
                           "[0-9.]+ Hz already; below, it is locked .*"));
}

TEST_F(Run, FrequencyAboveTheRangeIsRefusedWithTheHighestReached) {
  const Outcome o = run({"run", plain, "--json", "--frequency", "22 Hz", "--set",
                         "friction={type=\"quadratic\", coefficient=\"1e-4 N m s2/rad2\"}"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.out, IsEmpty());
  EXPECT_THAT(o.err, MatchesRegex("wingbeat: --frequency 22 Hz: 22 Hz cannot be reached: up to [0-9.]+ V it flaps at "
                                  "[0-9.]+ Hz at most, at [0-9.]+ V\n"));
}

TEST_F(Run, NotFlappingGivesJsonWithNullsAndStatus3) {
  const Outcome o =
      run({"run", springs, "--json", "--voltage", "0.3 V", "--plot", path("p.svg"), "--waveforms", path("w.csv")});
  EXPECT_EQ(o.status, 3);
  const Json json = o.json();
  EXPECT_EQ(keys_of(json), contract_keys);
  EXPECT_EQ(json["status"], "locked");
  for (std::size_t k = 5; k < contract_keys.size(); ++k) EXPECT_TRUE(json[contract_keys[k]].is_null());
  EXPECT_TRUE(json["domain"].is_null());
  EXPECT_THAT(o.err, HasSubstr("no file was written"));
  EXPECT_THAT(files(), IsEmpty());

  EXPECT_EQ(run({"run", plain, "--json", "--voltage", "0 V"}).json()["status"], "stalled");
  const Outcome jam = run({"run", plain, "--set", "friction.radius=40 mm", "--set", "motor.inertia=1e-9", "--json"});
  EXPECT_EQ(jam.status, 3);
  EXPECT_EQ(jam.json()["status"], "jammed");
  EXPECT_THAT(run({"run", springs, "--voltage", "0.3 V"}).out, HasSubstr("locked: "));
}

TEST_F(Run, MethodsAgree) {
  for (const std::string& vehicle : {plain, springs}) {
    const Json orbit = run({"run", vehicle, "--json"}).json();
    const Outcome transient = run({"run", vehicle, "--json", "--method", "transient"});
    EXPECT_EQ(transient.status, 0);
    std::vector<std::string> keys = contract_keys;
    keys.push_back("start_up");
    EXPECT_EQ(keys_of(transient.json()), keys);
    EXPECT_TRUE(transient.json()["floquet_multiplier_max"].is_null());
    expect_same_metrics(orbit, transient.json(), 1e-6);
    const Json start_up = transient.json()["start_up"];
    EXPECT_GT(start_up["time_to_steady_s"].get<double>(), 0.0);
    EXPECT_GT(start_up["inrush_current_a"], orbit["current_peak_a"]);
    EXPECT_GT(start_up["events"]["force_sign_change"].get<int>(), 0);
    EXPECT_EQ(start_up["events"]["revolution"], start_up["cycles"]);
  }
  const Outcome table = run({"run", plain, "--method", "transient"});
  EXPECT_THAT(table.out, HasSubstr("Start-up from rest"));
  EXPECT_THAT(table.out, HasSubstr("inrush current"));
}

TEST_F(Run, SwitchedSupplies) {
  const std::string pwm = "supply={type=\"pwm\", voltage=\"6 V\", duty=0.5, frequency=\"20 kHz\"}";
  const Outcome mean = run({"run", plain, "--json", "--set", pwm});
  EXPECT_EQ(mean.status, 0);
  EXPECT_THAT(mean.json()["status_detail"].get<std::string>(),
              HasSubstr("sees the mean voltage of the pwm supply, 3 V"));
  expect_same_metrics(mean.json(), run({"run", plain, "--json"}).json(), 1e-12);
  const Json found = run({"run", plain, "--json", "--set", pwm, "--frequency", "22 Hz"}).json();
  EXPECT_NEAR(found["frequency_hz"].get<double>(), 22.0, 1e-4);

  const std::string sine = "supply={type=\"sine\", amplitude=\"3 V\", frequency=\"20 Hz\"}";
  const Outcome refused = run({"run", plain, "--json", "--set", sine});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("--method transient"));
  EXPECT_THAT(refused.out, IsEmpty());
  EXPECT_EQ(run({"run", plain, "--json", "--set", sine, "--method", "transient"}).status, 3);
  EXPECT_THAT(run({"run", plain, "--set", sine, "--voltage", "3 V"}).err, HasSubstr("supply.amplitude"));
  EXPECT_THAT(run({"run", plain, "--set", sine, "--frequency", "3 Hz"}).err, HasSubstr("sine supply has no voltage"));
}

TEST_F(Run, ToleranceSharpensTheAnswer) {
  const auto frequency = [&](const char* tolerance) {
    return run({"run", plain, "--json", "--tolerance", tolerance}).json()["frequency_hz"].get<double>();
  };
  const double sharp = frequency("1e-12");
  EXPECT_NEAR(frequency("1e-6") / sharp, 1.0, 1e-6);
  EXPECT_NEAR(frequency("1e-9") / sharp, 1.0, 1e-9);
  EXPECT_NEAR(frequency("1e-2") / sharp, 1.0, 1e-2);
}

struct BadCase {
  std::vector<std::string> arguments;
  std::string sentence;
};

TEST_F(Run, BadInputIsSentencesOnStandardErrorAndStatus2) {
  std::ofstream(path("not.toml")) << "[vehicle\n";
  std::ofstream(path("short.toml")) << "[supply]\ntype = \"constant\"\nvoltage = \"3 V\"\n";
  const std::vector<BadCase> cases = {
      {{}, "subcommand"},
      {{"glide"}, "there is no command \"glide\""},
      {{"run"}, "vehicle is required"},
      {{"run", plain, "--jsn"}, "--jsn"},
      {{"run", plain, "extra"}, "extra"},
      {{"run", path("absent.toml")}, "no such file"},
      {{"run", data}, ""},
      {{"run", path("not.toml")}, "not.toml:1:"},
      {{"run", path("short.toml")}, "missing section [motor]"},
      {{"run", plain, "--set", "motor.inerti=1"}, "did you mean motor.inertia?"},
      {{"run", plain, "--set", "motor.inertia=-1"}, "motor.inertia: must be > 0"},
      {{"run", plain, "--set", "motor.inertia=1 kg"}, "motor.inertia"},
      {{"run", plain, "--set", "motor.inertia"}, "motor.inertia"},
      {{"run", plain, "--set"}, "--set"},
      {{"run", plain, "--voltage", "3 kg"}, "--voltage: expected a voltage such as \"3 V\", got \"3 kg\""},
      {{"run", plain, "--voltage", "-3 V"}, "--voltage: must be >= 0 V"},
      {{"run", plain, "--frequency", "0 Hz"}, "--frequency: must be > 0 Hz"},
      {{"run", plain, "--frequency", "22 mm"}, "--frequency: expected a frequency"},
      {{"run", plain, "--frequency", "22 Hz", "--voltage", "3 V"}, "excludes"},
      {{"run", plain, "--condition", "water"}, "--condition: must be air, vacuum or wingless, got \"water\""},
      {{"run", plain, "--method", "guess"}, "--method: must be orbit or transient, got \"guess\""},
      {{"run", plain, "--tolerance", "0.5"}, "--tolerance 0.5: must be a number between 1e-12 and 1e-2"},
      {{"run", plain, "--tolerance", "nan"}, "must be a number between"},
      {{"run", plain, "--tolerance", "tight"}, "must be a number between"},
      {{"run", plain, "--waveforms", path("w.txt")}, "must end in .csv or .nc"},
      {{"run", plain, "--plot", path("p.bmp")}, "must end in .svg, .pdf or .png"},
      {{"run", plain, "--plot-power", path("p")}, "must end in .svg, .pdf or .png"},
      {{"run", plain, "--plot", path("p.svg"), "--plot-power", path("p.svg")}, "is also the file of --plot"},
      {{"run", plain, "--plot", path("no/such/p.svg")}, "there is no folder"},
      {{"compare"}, "file is required"},
      {{"compare", plain}, "unknown key"},
      {{"compare", path("absent.toml")}, "no such file"},
  };
  for (const BadCase& c : cases) {
    const Outcome o = run(c.arguments);
    EXPECT_EQ(o.status, 2) << o.err;
    EXPECT_THAT(o.out, IsEmpty());
    EXPECT_THAT(o.err, HasSubstr(c.sentence));
    EXPECT_THAT(o.err, testing::StartsWith("wingbeat: "));
    // A line for each error: one, but where most of a file is missing.
    EXPECT_EQ(count_of(o.err, "\n"), c.sentence == "missing section [motor]" ? 5U : 1U) << o.err;
    EXPECT_EQ(count_of("\n" + o.err, "\nwingbeat: "), count_of(o.err, "\n")) << o.err;
  }
}

TEST_F(Run, AFullDiskIsAnError) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", plain}, {"run", plain, "--json"}, {"--help"}, {"--version"}}) {
    const Outcome o = run(arguments, "", "/dev/full");
    EXPECT_EQ(o.status, 1);
    EXPECT_THAT(o.err, HasSubstr("cannot write to standard output: No space left on device"));
  }
}

TEST_F(Run, HelpShowsAnExampleThatWorksAndVersionTheBuild) {
  EXPECT_THAT(run({"--version"}).out, MatchesRegex("wingbeat [0-9.]+ \\(.+ [0-9.]+, .+ build\\)\n"));
  for (const std::string command : {"", "run", "compare"}) {
    const Outcome o = command.empty() ? run({"--help"}) : run({command, "--help"});
    EXPECT_EQ(o.status, 0);
    const std::size_t position = o.out.find("Example:\n");
    ASSERT_NE(position, std::string::npos);
    // As typed, from the root of the source tree.
    std::string example = o.out.substr(position + 9, o.out.find("\n\n", position) - position - 9);
    ASSERT_THAT(example, testing::StartsWith("  wingbeat "));
    example = "cd " + path("") + " && ln -sfn " + data +
              " data && PATH=" + fs::path(WINGBEAT_PROGRAM).parent_path().string() + ":$PATH && " + example +
              " > /dev/null";
    EXPECT_EQ(std::system(example.c_str()), 0) << example;
  }
}

}  // namespace
}  // namespace cli

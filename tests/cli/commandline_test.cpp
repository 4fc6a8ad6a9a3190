// What all commands share: options, suggestions, every error at once, files by name, standard input, what was written.
#include <gmock/gmock.h>

#include <algorithm>
#include <regex>

#include "program.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class CommandLine : public Program {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  /// A line of a shell, run in the test's folder with `wingbeat` at its beginning.
  Outcome shell(const std::string& line) const {
    const std::string command = "cd '" + path("") + "' && wingbeat() { '" WINGBEAT_PROGRAM "' \"$@\"; } && (" + line +
                                ") > stdout.txt 2> stderr.txt < /dev/null";
    Outcome outcome;
    const int status = std::system(("bash -c " + quoted(command)).c_str());
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    outcome.out = read(path("stdout.txt"));
    outcome.err = read(path("stderr.txt"));
    return outcome;
  }
  static std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
  }
  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
};

const std::vector<std::string> commands = {"run",           "compare",   "sweep",     "identify-motor",
                                           "read-bench",    "fit",       "tolerance", "optimise",
                                           "endurance",     "reproduce", "new",       "scale",
                                           "keys",          "metrics",   "schema",    "export-kinematics",
                                           "compare-loads", "trim",      "stability", "fly"};

TEST_F(CommandLine, EveryHelpExampleWorksAsTyped) {
  for (const std::string& command : commands) {
    const std::string help = run({command, "--help"}).out;
    const auto position = help.find("Example:\n");
    ASSERT_NE(position, std::string::npos) << command;
    std::string example;
    for (const std::string& line : lines_of(help.substr(position + 9))) {
      if (line.empty()) break;
      example += line + "\n";
    }
    // The commands that take long are tried in short below and in their own tests.
    if (command == "reproduce") continue;
    if (command == "optimise") example = example.substr(0, example.find('\n'));
    const Outcome o = shell(example);
    EXPECT_EQ(o.status, 0) << example << o.err;
    EXPECT_THAT(o.err, Not(HasSubstr("wingbeat: "))) << example;
  }
}

TEST_F(CommandLine, OptionsAreSpelledAlikeEverywhere) {
  for (const char* command : {"run", "compare", "sweep", "fit", "tolerance", "optimise", "endurance", "trim"}) {
    EXPECT_THAT(run({command, "--help"}).out, HasSubstr("--set KEY=VALUE")) << command;
  }
  for (const std::string& command : commands) {
    const std::string help = run({command, "--help"}).out;
    EXPECT_EQ(help.find("--json") != std::string::npos, command != "new") << command;
    EXPECT_THAT(help, Not(HasSubstr("--plot-metrics")));
  }
  for (const char* command : {"sweep", "tolerance", "optimise", "reproduce"}) {
    EXPECT_THAT(run({command, "--help"}).out, HasSubstr("--threads N")) << command;
  }
  for (const char* command : {"sweep", "tolerance"}) {
    EXPECT_THAT(run({command, "--help"}).out, HasSubstr("--plot-metric ")) << command;
  }
}

TEST_F(CommandLine, UnknownOptionsAndCommandsSuggestTheNearest) {
  const auto said = [&](std::vector<std::string> arguments) {
    const Outcome o = run(std::move(arguments));
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.out, IsEmpty());
    EXPECT_EQ(count_of(o.err, "\n"), 1U) << o.err;
    return o.err;
  };
  EXPECT_EQ(said({"run", plain, "--volt", "3 V"}),
            "wingbeat: unknown option --volt of wingbeat run; did you mean --voltage? (see wingbeat run --help)\n");
  EXPECT_EQ(said({"run", "--volt", "3 V", plain}), said({"run", plain, "--volt", "3 V"}));
  EXPECT_EQ(said({"run", plain, "--volt=3 V"}), said({"run", plain, "--volt", "3 V"}));
  EXPECT_THAT(said({"run", "--volt", "3 V"}), HasSubstr("did you mean --voltage?"));
  EXPECT_THAT(said({"run", plain, "--freqency", "22 Hz"}), HasSubstr("did you mean --frequency?"));
  EXPECT_THAT(said({"run", plain, "--lift-to", "1"}), HasSubstr("did you mean --lift-to-weight?"));
  EXPECT_THAT(said({"sweep", "crank-radius", "-o", path("x.nc"), "--thread", "2"}),
              HasSubstr("did you mean --threads?"));
  EXPECT_THAT(said({"tolerance", "tolerance-hover", "--voltage", "3 V"}),
              HasSubstr("unknown option --voltage of wingbeat tolerance; wingbeat run has it"));
  EXPECT_THAT(said({"run", plain, "--quietly"}), StartsWith("wingbeat: unknown option --quietly of wingbeat run (see"));
  EXPECT_EQ(said({"run", plain, springs}), "wingbeat: one argument too many: \"" + springs.substr(0, 60) +
                                               (springs.size() > 60 ? "..." : "") + "\" (see wingbeat run --help)\n");
  EXPECT_EQ(said({"optimize", "x"}), "wingbeat: there is no command \"optimize\"; did you mean wingbeat optimise?\n");
  EXPECT_THAT(said({"identify", "x"}), HasSubstr("did you mean wingbeat identify-motor?"));
  EXPECT_THAT(said({"flapper.toml"}), HasSubstr("did you mean wingbeat run flapper.toml?"));
  EXPECT_THAT(said({"bogus"}), HasSubstr("the commands are run, compare, sweep"));
}

TEST_F(CommandLine, ThreadsAreAWholeNumberFromOne) {
  for (const char* n : {"0", "-1", "1.5", "two", "99999999999999999999"}) {
    const Outcome o = run({"sweep", "crank-radius", "-o", path("x.nc"), "--threads", n});
    EXPECT_EQ(o.status, 2);
    EXPECT_EQ(o.err, "wingbeat: --threads: must be a whole number >= 1, got \"" + std::string(n) +
                         "\" (see wingbeat sweep --help)\n");
  }
}

TEST_F(CommandLine, EveryErrorOfAVehicleFileIsSaidAtItsPlace) {
  std::string text = read(plain);
  const auto replace = [&](const std::string& from, const std::string& to) {
    const auto position = text.find(from);
    ASSERT_NE(position, std::string::npos) << from;
    text.replace(position, from.size(), to);
  };
  replace("voltage = \"3 V\"", "voltage = \"3 A\"");
  replace("torque_constant = \"0.01 N m/A\"", "torque_constan = \"0.01 N m/A\"");
  replace("inertia = \"1.5e-7 kg m2\"", "inertia = \"-1.5e-7 kg m2\"");
  replace("type = \"load-proportional\"", "type = \"load\"");
  replace("pitch_coefficient = \"5e-3 s\"\n", "");
  replace("[bench]", "[bensh]");
  const std::string file = write("bad.toml", text);
  const Outcome o = run({"run", file});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.out, IsEmpty());
  const auto lines = lines_of(o.err);
  const std::string head = "wingbeat: " + file + ":";
  ASSERT_EQ(lines.size(), 6U) << o.err;
  const char* const wanted[] = {"supply.voltage: expected a voltage",
                                "motor.torque_constan: unknown key; did you mean motor.torque_constant?",
                                "motor.inertia: must be > 0",
                                "friction.type: expected",
                                "bensh: unknown key; did you mean [bench]?",
                                "aerodynamics.pitch_coefficient: missing"};  // after what stands in the file
  int line_before = 0;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    EXPECT_THAT(lines[n], StartsWith(head));
    EXPECT_THAT(lines[n], HasSubstr(wanted[n]));
    const int line = std::stoi(lines[n].substr(head.size()));
    EXPECT_TRUE(line >= line_before || n + 1 == lines.size()) << o.err;
    line_before = line;
  }
  // Overrides too, each with its own.
  const Outcome set = run({"run", plain, "--set", "motor.inertai=1", "--set", "supply.voltage=3 A"});
  EXPECT_EQ(set.status, 2);
  EXPECT_EQ(lines_of(set.err).size(), 2U) << set.err;
}

TEST_F(CommandLine, EveryErrorOfAStudyIsSaid) {
  const std::string study =
      write("bad.toml", "[study]\nvehicle = \"" + plain +
                            "\"\ntolerance = 5\ntitel = \"x\"\n"
                            "[set]\nmotor.inertai = 1\nsupply.voltage = \"3 A\"\n"
                            "[[axis]]\nkey = \"transmission.crank_radios\"\nvalues = [1]\n"
                            "[[axis]]\nkey = \"supply.duty\"\nfrom = \"1 mm\"\nto = 1\ncount = 3\n");
  const Outcome o = run({"sweep", study, "-o", path("x.nc")});
  EXPECT_EQ(o.status, 2);
  for (const char* wanted :
       {":4:1: study.titel: unknown key; did you mean study.title?", ":3:1: study.tolerance: ",
        ":6:7: set.motor.inertai: unknown key", ":7:8: set.supply.voltage: supply.voltage: expected a voltage",
        ":9:1: axis.key: transmission.crank_radios: unknown key", ":13:1: axis.from: expected a number"}) {
    EXPECT_THAT(o.err, HasSubstr(study + wanted));
  }
  EXPECT_EQ(lines_of(o.err).size(), 6U) << o.err;
}

TEST_F(CommandLine, FilesThatComeWithTheProgramAreFoundByName) {
  EXPECT_EQ(shell("wingbeat run friction2022 --json").out, run({"run", plain, "--json"}).out);
  EXPECT_EQ(shell("wingbeat run friction2022.toml --json").out, run({"run", plain, "--json"}).out);
  EXPECT_EQ(shell("wingbeat compare friction2022 --json").status, 0);
  EXPECT_EQ(shell("wingbeat identify-motor pololu-1098 --json").out,
            run({"identify-motor", data + "/motors/pololu-1098.toml", "--json"}).out);
  const Outcome near = shell("wingbeat run friction2023");
  EXPECT_EQ(near.status, 2);
  EXPECT_EQ(near.err,
            "wingbeat: friction2023: no such file, and no design of that name comes with the program; did you "
            "mean friction2022?\n");
  EXPECT_THAT(shell("wingbeat run pigeon").err, HasSubstr("its designs are direct-drive, flight-friction2022, "));
  EXPECT_THAT(shell("wingbeat sweep crank-radios -o x.nc").err, HasSubstr("did you mean crank-radius?"));
  EXPECT_THAT(shell("wingbeat run ./friction2022").err, HasSubstr("./friction2022: no such file"));
  // One's own file of that name goes first.
  std::string text = read(plain);
  text.replace(text.find("\"3 V\""), 5, "\"2 V\"");
  write("friction2022.toml", text);
  EXPECT_EQ(shell("wingbeat run friction2022 --json").json()["voltage_v"], 2.0);
  // A study names them as well.
  write("mine.toml", "[study]\nvehicle = \"friction2022-springs\"\n[[axis]]\nkey = \"supply.voltage\"\nvalues = [3]\n");
  EXPECT_EQ(shell("wingbeat sweep mine.toml -o mine.nc --json").json()["status"]["flapping"], 1);
}

TEST_F(CommandLine, TheProgramMayBeInstalledAnywhere) {
  fs::create_directories(path("prefix/bin"));
  fs::create_directories(path("prefix/share/wingbeat/designs"));
  std::error_code error;
  fs::create_hard_link(WINGBEAT_PROGRAM, path("prefix/bin/wingbeat"), error);
  if (error) fs::copy_file(WINGBEAT_PROGRAM, path("prefix/bin/wingbeat"));
  fs::copy_file(springs, path("prefix/share/wingbeat/designs/ours.toml"));
  const Outcome o = shell("prefix/bin/wingbeat run ours --json");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.out, run({"run", springs, "--json"}).out);
}

TEST_F(CommandLine, StandardInputIsAFileInTheCurrentFolder) {
  fs::copy_file(plain, path("v.toml"));
  EXPECT_EQ(shell("wingbeat run - --json < v.toml").out, run({"run", plain, "--json"}).out);
  EXPECT_EQ(shell("wingbeat run - --set supply.voltage=\"2 V\" --json < v.toml").json()["voltage_v"], 2.0);
  write("s.toml", "[study]\nvehicle = \"v.toml\"\n[[axis]]\nkey = \"supply.voltage\"\nvalues = [2, 3]\n");
  EXPECT_EQ(shell("wingbeat sweep - -o x.nc --json < s.toml").json()["designs"], 2);
  const Outcome bad = shell("echo '[supply' | wingbeat run -");
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, StartsWith("wingbeat: standard input:1:"));
  const Outcome study = shell("sed s/v.toml/w.toml/ s.toml | wingbeat sweep - -o y.nc");
  EXPECT_EQ(study.err, "wingbeat: standard input:2:1: study.vehicle: there is no file w.toml\n");
  write("t.toml",
        "[study]\nvehicle = \"v.toml\"\n[samples]\ncount = 8\n[[parameter]]\nkey = \"motor.inertia\"\n"
        "distribution = \"normal\"\nrelative_deviation = 0.01\n");
  EXPECT_EQ(shell("wingbeat tolerance - -o t.nc --json < t.toml").status, 0);
}

TEST_F(CommandLine, SetReachesTheVehicleOfAStudy) {
  write("s.toml",
        "[study]\nvehicle = \"friction2022\"\n[set]\nfriction.radius = \"2 mm\"\n"
        "[[axis]]\nkey = \"supply.voltage\"\nvalues = [\"3 V\"]\n");
  const Json one = shell("wingbeat sweep s.toml -o a.nc --json --set friction.radius=\"1 mm\"").json();
  const Json run_alone = run({"run", plain, "--json", "--set", "friction.radius=1 mm"}).json();
  EXPECT_NEAR(one["max_lift_mean"]["lift_mean_n"].get<double>() / run_alone["lift_mean_n"].get<double>(), 1.0, 1e-5);
  EXPECT_EQ(one["max_lift_mean"]["parameters"]["supply.voltage"], 3.0);
  const auto refused = [&](const std::string& line) {
    const Outcome o = shell(line);
    EXPECT_EQ(o.status, 2) << line;
    return o.err;
  };
  EXPECT_EQ(refused("wingbeat sweep s.toml -o b.nc --set supply.voltage=4"),
            "wingbeat: --set supply.voltage=4: supply.voltage: has no effect: the study varies it\n");
  EXPECT_THAT(refused("wingbeat sweep s.toml -o b.nc --set motor.inertai=4"), HasSubstr("did you mean motor.inertia?"));
  EXPECT_THAT(refused("wingbeat sweep a.nc -o b.nc --set motor.inertia=4"), HasSubstr("computed again as it is"));
  EXPECT_THAT(refused("wingbeat optimise optimise-hover --set transmission.crank_radius=\"5 mm\""),
              HasSubstr("has no effect: the study varies it"));
}

TEST_F(CommandLine, WhatWasWrittenIsSaidAndNeverInJson) {
  const Outcome text = shell("wingbeat run friction2022 --plot a.svg --waveforms b.csv");
  EXPECT_EQ(text.err, "wrote b.csv\nwrote a.svg\n");
  EXPECT_THAT(text.out, Not(HasSubstr("wrote")));
  const Outcome json = shell("wingbeat run friction2022 --plot c.svg --json");
  EXPECT_EQ(json.err, "wrote c.svg\n");
  EXPECT_EQ(json.json()["status"], "flapping");
  EXPECT_EQ(shell("wingbeat identify-motor 0816K003SR -o motor.toml --json").err, "wrote motor.toml\n");
  EXPECT_EQ(shell("wingbeat new mine").err, "wrote mine.toml\n");
  EXPECT_THAT(shell("wingbeat run mine.toml").err, IsEmpty());
}

TEST_F(CommandLine, NewWritesAFileThatRuns) {
  for (const std::string type : {"slider-crank", "direct"}) {
    const std::string file = type + ".toml";
    ASSERT_EQ(shell("wingbeat new " + file + " --transmission " + type).status, 0);
    const std::string text = read(path(file));
    for (const std::string& line : lines_of(text)) EXPECT_LE(line.size(), 120U) << line;
    EXPECT_THAT(text, HasSubstr("type = \"" + type + "\""));
    const Outcome o = shell("wingbeat run " + file + " --json");
    EXPECT_EQ(o.status, 0) << o.err << o.out;
    EXPECT_GE(o.json()["angle_of_attack_min_deg"].get<double>(), 0.0);
    const Outcome again = shell("wingbeat new " + file);
    EXPECT_EQ(again.status, 2);
    EXPECT_EQ(again.err, "wingbeat: " + file + ": is there already and is never overwritten; give another name\n");
    EXPECT_EQ(read(path(file)), text);
    // Each commented line is a key that may be there.
    for (std::string line : lines_of(text)) {
      const std::regex commented("# ([a-z0-9_]+) = [^.]*");
      if (std::regex_match(line.substr(0, line.find("  #")), commented)) {
        EXPECT_THAT(run({"keys", line.substr(2, line.find(" = ") - 2)}).status, 0) << line;
      }
    }
  }
  EXPECT_EQ(shell("wingbeat new - | wingbeat run - --json").json()["status"], "flapping");
  EXPECT_EQ(shell("wingbeat new x --transmission belt").status, 2);
}

TEST_F(CommandLine, KeysAndMetricsAreTheTables) {
  const Json keys = run({"keys", "--json"}).json();
  ASSERT_EQ(keys["keys"].size(), wingbeat::parameter_table<double>().size());
  EXPECT_EQ(keys["keys"][0]["key"], "vehicle.name");
  EXPECT_TRUE(keys["keys"][0]["unit"].is_null());
  const std::string text = run({"keys"}).out;
  for (const auto& key : wingbeat::parameter_table<double>()) EXPECT_THAT(text, HasSubstr(std::string(key.path)));
  EXPECT_THAT(run({"keys", "crank_radius"}).out,
              testing::AllOf(StartsWith("transmission.crank_radius  [m]  > 0"), Not(HasSubstr("armature"))));
  const Outcome none = run({"keys", "crank_radios"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("\"crank_radios\": no key has this"));
  const Json metrics = run({"metrics", "--json"}).json();
  ASSERT_EQ(int(metrics["metrics"].size()), int(wingbeat::metric_count));
  EXPECT_THAT(run({"metrics", "lift"}).out, testing::AllOf(HasSubstr("lift_mean_n"), Not(HasSubstr("current"))));
}

TEST_F(CommandLine, JsonOfASweepIsOneObject) {
  const Outcome o = shell("wingbeat sweep crank-radius -o x.nc --json");
  ASSERT_EQ(o.status, 0) << o.err;
  const Json json = o.json();
  EXPECT_EQ(o.err, "wrote x.nc\n");
  EXPECT_EQ(json["data_set"], "x.nc");
  EXPECT_TRUE(json["plot"].is_null());
  std::size_t all = 0;
  for (const auto& [name, count] : json["status"].items()) all += count.get<std::size_t>();
  EXPECT_EQ(json["designs"], all);
  EXPECT_GT(json["max_efficiency_system"]["efficiency_system"].get<double>(), 0.0);
}

TEST_F(CommandLine, UnitsThatPeopleType) {
  const Json plain_run = run({"run", plain, "--json"}).json();
  for (const char* set : {"motor.torque_constant=10 mNm/A", "motor.inertia=1.5 gcm2", "friction.radius=2.5mm",
                          "motor.torque_constant=954.929658551372 rpm/V"}) {
    const Json json = run({"run", plain, "--json", "--set", set}).json();
    EXPECT_NEAR(json["frequency_hz"].get<double>() / plain_run["frequency_hz"].get<double>(), 1.0, 1e-9) << set;
  }
  const Outcome o = run({"run", plain, "--set", "transmission.crank_radius=5 mm\u00b72"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("which holds a second number"));
}

}  // namespace
}  // namespace cli

#include <gmock/gmock.h>

#include "program.hpp"

namespace cli {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

class Fit : public Program {};

const std::string bench = data + "/bench/flapper.toml";

TEST_F(Fit, WritesAVehicleThatRunsAndItsCovariance) {
  const Outcome o = run({"fit", bench, "-o", path("fitted.toml"), "--no-profiles", "--plot", path("residuals.svg")});
  EXPECT_EQ(o.status, 0);
  EXPECT_EQ(o.err, "wrote " + path("fitted.toml") + "\nwrote " + path("fitted.covariance.toml") + "\nwrote " +
                       path("residuals.svg") + "\n");
  for (const char* part : {"3 parameters, 36 rows", "converged", "friction.radius", "Identifiability",
                           "only air determines aerodynamics.pitch_coefficient", "Share of the information"}) {
    EXPECT_THAT(o.out, HasSubstr(part));
  }
  std::istringstream lines(o.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 90U) << line;
  EXPECT_THAT(files(), UnorderedElementsAre("fitted.toml", "fitted.covariance.toml", "residuals.svg"));
  EXPECT_EQ(run({"run", path("fitted.toml")}).status, 0);
  EXPECT_THAT(read(path("fitted.covariance.toml")), HasSubstr("vehicle = \"fitted.toml\""));
  EXPECT_THAT(read(path("residuals.svg")), HasSubstr("wingless"));
}

// Signals in time on a balance: the truth of data/bench/waveforms.toml comes back.
TEST_F(Fit, SignalsInTimeGiveVehicleAndBalance) {
  const std::string waveforms = data + "/bench/waveforms.toml";
  const Outcome shown = run({"read-bench", waveforms});
  EXPECT_EQ(shown.status, 0) << shown.err;
  for (const char* part : {"1200 rows", "burst", "Hz/s", "600", "2.500 V"}) EXPECT_THAT(shown.out, HasSubstr(part));
  const Outcome o =
      run({"fit", waveforms, "--no-profiles", "-o", path("fitted.toml"), "--plot-cycles", path("cycles.svg")});
  EXPECT_EQ(o.status, 0) << o.err;
  for (const char* part : {"balance.stiffness", "Also fitted", "phase of waveforms.csv, burst 2",
                           "zero of stroke_angle in waveforms.csv"}) {
    EXPECT_THAT(o.out, HasSubstr(part)) << o.out;
  }
  std::istringstream lines(o.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 90U) << line;
  EXPECT_THAT(read(path("cycles.svg")), HasSubstr("balance reading"));
  EXPECT_THAT(read(path("fitted.covariance.toml")), Not(HasSubstr("balance")));
  const Json json = run({"fit", waveforms, "--no-profiles", "--json"}).json();
  EXPECT_EQ(json["cycles"].size(), 6U);
  const std::map<std::string, double> truth = {{"friction.radius", 2.5e-3},
                                               {"aerodynamics.pitch_coefficient", 5e-3},
                                               {"motor.inertia", 1.5e-7},
                                               {"balance.stiffness", 1700.0},
                                               {"balance.damping", 0.5}};
  int compared = 0;
  for (const Json& p : json["parameters"]) {
    const auto found = truth.find(p["key"].get<std::string>());
    if (found == truth.end()) continue;
    ++compared;
    EXPECT_NEAR(p["value"].get<double>(), found->second, 4.0 * p["standard_error"].get<double>()) << found->first;
    EXPECT_LT(p["standard_error"].get<double>(), 0.1 * found->second) << found->first;
  }
  EXPECT_EQ(compared, 5);
  EXPECT_EQ(run({"fit", bench, "--plot-cycles", path("none.svg")}).status, 2);
}

TEST_F(Fit, ReadBenchShowsWhatWasUnderstood) {
  const Outcome o = run({"read-bench", data + "/bench/spreadsheet.csv"});
  EXPECT_EQ(o.status, 0) << o.err;
  for (const char* part :
       {"cells between semicolons, decimal comma, 1 line of remarks", "3 rows, sorted by the voltage",
        "left out: 1 cell without a value", "U [V]", "lift_mean", "8.630 mN to 22.06 mN", "set"}) {
    EXPECT_THAT(o.out, HasSubstr(part)) << o.out;
  }
  const Json json = run({"read-bench", bench, "--json"}).json();
  ASSERT_EQ(json["logs"].size(), 3U);
  EXPECT_EQ(json["logs"][0]["columns"][0]["role"], "set");
  std::ofstream(path("open.csv")) << "voltage_V;current_mA\n2;1,204\n3;1,305\n";
  const Outcome open = run({"read-bench", path("open.csv")});
  EXPECT_EQ(open.status, 2);
  EXPECT_THAT(open.err, HasSubstr("open.csv:2:3: is \"1,204\" a decimal fraction or a number of thousands?"));
}

// Logs with gaps and one wrong value: what is left out is counted, what is alone far off is named.
TEST_F(Fit, GapsAreCountedAndALoneOutlierNamed) {
  for (const char* name : {"vacuum.csv", "wingless.csv"}) fs::copy_file(data + "/bench/" + name, path(name));
  std::string toml = read(bench);
  const std::string vehicle = "../designs/";
  toml.replace(toml.find(vehicle), vehicle.size(), data + "/designs/");
  std::ofstream(path("bench.toml")) << toml;
  std::istringstream lines(read(data + "/bench/air.csv"));
  std::ofstream air(path("air.csv"));
  int row = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#") || line.starts_with("voltage")) {
      air << line << "\n";
      continue;
    }
    ++row;
    const std::size_t last = line.rfind(',');
    if (row == 2) line = line.substr(0, last + 1);  // the last cell is empty
    if (row == 5) line = line.substr(0, last + 1) + std::to_string(1.3 * std::stod(line.substr(last + 1)));
    air << line << "\n";
  }
  air.close();
  const Outcome o = run({"fit", path("bench.toml"), "--no-profiles"});
  EXPECT_THAT(o.out, HasSubstr("107 measured values in 3 logs"));
  EXPECT_THAT(o.out, HasSubstr("air.csv: left out: 1 cell without a value"));
  EXPECT_THAT(o.out, HasSubstr("loss = \"huber\" in [fit]"));
  EXPECT_THAT(run({"fit", bench, "--no-profiles"}).out, Not(HasSubstr("huber")));
}

TEST_F(Fit, JsonHoldsTheTruthInItsIntervals) {
  const Outcome o = run({"fit", bench, "--json"});
  EXPECT_EQ(o.status, 0);
  const Json json = o.json();
  const std::map<std::string, double> truth = {
      {"friction.radius", 2.5e-3}, {"aerodynamics.pitch_coefficient", 5e-3}, {"motor.viscous_damping", 3.6e-6}};
  ASSERT_EQ(json["parameters"].size(), 3U);
  for (const Json& p : json["parameters"]) {
    const double value = truth.at(p["key"].get<std::string>());
    EXPECT_LT(p["profile_lower_95"].get<double>(), value) << p["key"];
    EXPECT_GT(p["profile_upper_95"].get<double>(), value) << p["key"];
    EXPECT_GT(p["profile"].size(), 2U);
  }
  EXPECT_EQ(json["points"].size(), 108U);
}

TEST_F(Fit, BadInputIsOneSentence) {
  const Outcome missing = run({"fit", path("none.toml")});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("none.toml: no such file"));
  EXPECT_EQ(run({"fit", bench, "--plot", path("plot.gif")}).status, 2);
  std::string text = read(bench);
  text.replace(text.find("condition = \"air\""), 17, "");
  std::ofstream(path("bench.toml")) << text;
  const Outcome unnamed = run({"fit", path("bench.toml"), "-o", path("fitted.toml")});
  EXPECT_EQ(unnamed.status, 2);
  EXPECT_EQ(count_of(unnamed.err, "\n"), 1U);
}

TEST_F(Fit, RowsOutOfReachAreReportedByFileAndLine) {
  std::string vehicle = read(plain);
  vehicle.replace(vehicle.find("[transmission]"), 0, "friction_torque = \"0.4 mN m\"\n\n");
  std::ofstream(path("vehicle.toml")) << vehicle;
  std::ofstream log(path("log.csv"));
  log << "voltage_V,frequency_Hz,current_mean_mA\n0.3,2,33\n";
  for (const char* v : {"2", "2.5", "3"}) {
    const Json json = run({"run", path("vehicle.toml"), "--json", "--voltage", v}).json();
    log << v << "," << json["frequency_hz"].dump() << "," << 1e3 * json["current_mean_a"].get<double>() << "\n";
  }
  log.close();
  std::ofstream(path("bench.toml"))
      << "[bench]\nvehicle = \"vehicle.toml\"\n[[parameter]]\nkey = \"friction.radius\"\n"
         "lower = 0\nupper = 8e-3\nstart = 1e-3\n[deviation]\ndefault = { relative = 0.01 }\n"
         "[[log]]\nfile = \"log.csv\"\ncondition = \"air\"\n";
  const Outcome o = run({"fit", path("bench.toml"), "-o", path("fitted.toml")});
  EXPECT_EQ(o.status, 3);
  EXPECT_THAT(o.out, HasSubstr("log.csv:2 (0.3 V, air):"));
  EXPECT_THAT(o.out, HasSubstr("stalled: the motor never starts"));
  EXPECT_THAT(o.err, HasSubstr("1 of the rows cannot be reached by the fitted model"));
  EXPECT_THAT(read(path("fitted.toml")), HasSubstr("# not reached: "));
  const Json json = run({"fit", path("bench.toml"), "--json"}).json();
  EXPECT_NEAR(json["parameters"][0]["value"].get<double>(), 2.5e-3, 1e-5);
  EXPECT_EQ(json["unreached"].size(), 1U);
  EXPECT_EQ(json["points"][0]["fitted"], nullptr);
}

/// The shipped bench with its currents in mA labelled A, of which `deviation` is said.
class WrongUnit : public Fit {
 protected:
  Outcome fit(const std::string& deviation, std::vector<std::string> more = {}) {
    fs::create_directories(path("bench"));
    fs::copy(data + "/designs", path("designs"), fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    for (const char* log : {"air.csv", "vacuum.csv", "wingless.csv"}) {
      std::string text = read(data + "/bench/" + log);
      for (auto position = text.find("_mA"); position != std::string::npos; position = text.find("_mA"))
        text.replace(position, 3, "_A");
      std::ofstream(path(std::string("bench/") + log)) << text;
    }
    std::string text = read(bench);
    const auto from = text.find("[deviation]"), to = text.find("[[log]]");
    std::ofstream(path("bench/flapper.toml")) << text.replace(from, to - from, deviation);
    std::vector<std::string> arguments = {"fit", path("bench/flapper.toml"), "-o", path("fitted.toml")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(WrongUnit, IsAMisfitBeforeAnythingElse) {
  const Outcome o = fit("[deviation]\ndefault = { relative = 0.01 }\n");
  EXPECT_EQ(o.status, 3);
  EXPECT_TRUE(o.out.starts_with("MISFIT: the model does not describe the data: chi square is ")) << o.out;
  EXPECT_THAT(o.err, HasSubstr("the model does not describe the data"));
  EXPECT_THAT(o.err, HasSubstr("no vehicle file was written"));
  EXPECT_THAT(o.err, HasSubstr("is its unit right?"));
  EXPECT_THAT(o.out, testing::Not(HasSubstr(" .. ")));
  EXPECT_THAT(o.out, testing::Not(HasSubstr("the data determine")));
  EXPECT_FALSE(fs::exists(path("fitted.toml")));
  EXPECT_FALSE(fs::exists(path("fitted.covariance.toml")));
  const Json json = fit("[deviation]\ndefault = { relative = 0.01 }\n", {"--json"}).json();
  EXPECT_THAT(json["misfit"].get<std::string>(), HasSubstr("degrees of freedom"));
  EXPECT_LT(json["p_value"].get<double>(), 1e-6);
  for (const Json& p : json["parameters"]) {
    for (const char* key : {"standard_error", "lower_95", "upper_95", "profile_lower_95"})
      EXPECT_TRUE(p[key].is_null());
  }
}

TEST_F(WrongUnit, IsAMisfitOfDeviationsThatAreEstimatedToo) {
  const Outcome o = fit("[deviation]\ndefault = \"estimated\"\n");
  EXPECT_EQ(o.status, 3);
  EXPECT_TRUE(o.out.starts_with("MISFIT: ")) << o.out;
  EXPECT_THAT(o.err, HasSubstr("the residuals of current_mean_a are on average"));
  EXPECT_THAT(o.out, testing::Not(HasSubstr(" .. ")));
}

TEST_F(Fit, IntervalsKeepToTheBounds) {
  const Json json = run({"fit", bench, "--json", "--no-profiles"}).json();
  EXPECT_TRUE(json["misfit"].is_null());
  EXPECT_GT(json["p_value"].get<double>(), 1e-3);
  std::string text = read(bench);
  fs::copy(data + "/bench", path("bench"));
  fs::copy(data + "/designs", path("designs"));
  // A lower bound right below the truth: what is left of the interval begins there.
  const auto radius = text.find("lower = \"0 mm\"");
  text.replace(radius, 14, "lower = \"2.499 mm\"");
  text.replace(text.find("start = \"1 mm\""), 14, "start = \"4 mm\"");
  std::ofstream(path("bench/flapper.toml")) << text;
  const Json bounded = run({"fit", path("bench/flapper.toml"), "--json", "--no-profiles"}).json();
  for (const Json& p : bounded["parameters"]) {
    if (p["key"] != "friction.radius") continue;
    for (const char* key : {"value", "lower_95"}) EXPECT_GE(p[key].get<double>(), 2.499e-3) << key;
    EXPECT_GT(p["upper_95"].get<double>(), 2.51e-3);
  }
}

TEST_F(Fit, StartsHaveALimit) {
  std::string text = read(bench);
  text += "\n[fit]\nstarts = 20000000\n";
  fs::copy(data + "/bench", path("bench"));
  fs::copy(data + "/designs", path("designs"));
  std::ofstream(path("bench/flapper.toml")) << text;
  const Outcome o = run({"fit", path("bench/flapper.toml")});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("fit.starts: must be at most 1000, got 20000000; every start is a whole fit"));
}

TEST_F(Fit, UnknownParametersAreNoNumbers) {
  std::string text = read(bench);
  const auto air = text.find("[[log]]"), vacuum = text.find("[[log]]", air + 1);
  text.erase(air, vacuum - air);
  std::filesystem::copy(data + "/bench", path("bench"));
  std::filesystem::copy(data + "/designs", path("designs"));
  std::ofstream(path("bench/flapper.toml")) << text;
  const Outcome o = run({"fit", path("bench/flapper.toml"), "--json"});
  EXPECT_EQ(o.status, 0);
  const Json json = o.json();
  EXPECT_EQ(json["parameters"][1]["key"], "aerodynamics.pitch_coefficient");
  EXPECT_EQ(json["parameters"][1]["value"], nullptr);
  EXPECT_EQ(json["covariance"][1][1], nullptr);
  EXPECT_TRUE(json["parameters"][0]["value"].is_number());
}

TEST_F(Fit, HelpShowsAnExampleThatRuns) {
  EXPECT_THAT(run({"fit", "--help"}).out, HasSubstr("wingbeat fit flapper -o fitted.toml"));
}

}  // namespace
}  // namespace cli

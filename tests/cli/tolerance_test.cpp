#include <gmock/gmock.h>

#include <fstream>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;

class Tolerance : public Program {
 protected:
  Tolerance() { fs::copy_file(springs, path("vehicle.toml")); }

  std::string study(const std::string& text) const {
    std::ofstream(path("study.toml")) << "[study]\nvehicle = \"vehicle.toml\"\n" << text;
    return path("study.toml");
  }

  /// What is said about a study, without the folder; lines of `text` count from 3.
  std::string complaint(const std::string& text) const {
    const Outcome outcome = run({"tolerance", study(text)});
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    std::string said = outcome.err;
    const std::string folder = path("");
    for (auto position = said.find(folder); position != std::string::npos; position = said.find(folder))
      said.erase(position, folder.size());
    return said;
  }
};

const std::string friction =
    "[[parameter]]\nkey = \"friction.radius\"\ndistribution = \"normal\"\ndeviation = \"0.2 mm\"\n";

TEST_F(Tolerance, ReportDataSetFigureAndJsonOfOneStudy) {
  const std::string file = study("hold = { voltage = \"5.3 V\" }\n[samples]\ncount = 128\n" + friction +
                                 "[[parameter]]\nkey = \"vehicle.mass\"\ndistribution = \"uniform\"\n"
                                 "lower = \"3.2 g\"\nupper = \"3.5 g\"\n");
  const Outcome text = run({"tolerance", file, "-o", path("t.nc"), "--plot", path("t.svg")});
  ASSERT_EQ(text.status, 0) << text.err;
  for (const char* part : {"256 scrambled Sobol samples, 512 vehicles", "hovers", "linear prediction",
                           "Where the variance of lift_to_weight comes from", "sum of first order"}) {
    EXPECT_THAT(text.out, HasSubstr(part));
  }
  EXPECT_THAT(read(path("t.svg")), HasSubstr("friction radius"));

  const Json json = run({"tolerance", file, "--json", "--threads", "1"}).json();
  const wingbeat::NetcdfReader data(path("t.nc"));
  const auto lift = data.read("lift_to_weight");
  ASSERT_EQ(lift.size(), 256U);
  double sum = 0.0, hover = 0.0;
  for (const double x : lift) {
    sum += x;
    hover += x >= 1.0;
  }
  EXPECT_NEAR(json["outputs"]["lift_to_weight"]["mean"].get<double>(), sum / 256.0, 1e-12);
  EXPECT_EQ(json["probability"]["hover"]["count"], hover);
  EXPECT_EQ(data.read("friction_radius").size(), 256U);
  EXPECT_EQ(data.read("sobol_total").size(), 2 * json["outputs"].size());
  EXPECT_EQ(json["outputs"]["lift_to_weight"]["factors"][0]["name"], "friction.radius");
  EXPECT_THAT(*data.attribute("study"), HasSubstr("deviation = \"0.2 mm\""));
}

TEST_F(Tolerance, CovarianceOfAFit) {
  std::ofstream(path("f.covariance.toml"))
      << "vehicle = \"vehicle.toml\"\n[[parameter]]\nkey = \"friction.radius\"\nvalue = 2.5e-3\n"
         "[[parameter]]\nkey = \"motor.viscous_damping\"\nvalue = 3.6e-6\n"
         "[covariance]\nmatrix = [\n  [1e-8, -5e-12],\n  [-5e-12, 4e-14],\n]\n";
  const std::string file = study("[samples]\ncount = 64\n[fit]\ncovariance = \"f.covariance.toml\"\n");
  const Json json = run({"tolerance", file, "--json"}).json();
  EXPECT_NEAR(json["parameters"][0]["deviation"].get<double>(), 1e-4, 1e-12);
  EXPECT_TRUE(json["parameters"][1]["correlated"].get<bool>());
  ASSERT_EQ(json["outputs"]["power_electrical_w"]["factors"].size(), 1U);
  EXPECT_EQ(json["outputs"]["power_electrical_w"]["factors"][0]["name"], "f");

  std::ofstream(path("bad.covariance.toml")) << "[[parameter]]\nkey = \"friction.radius\"\nvalue = 2.5e-3\n"
                                                "[[parameter]]\nkey = \"wing.inertia\"\nvalue = 7e-8\n"
                                                "[covariance]\nmatrix = [\n  [1e-8, 9],\n  [9, 4e-14],\n]\n";
  EXPECT_EQ(complaint("[fit]\ncovariance = \"bad.covariance.toml\"\n"),
            "wingbeat: bad.covariance.toml:8:1: covariance.matrix: is not positive definite\n");
  EXPECT_EQ(complaint("[fit]\ncovariance = \"none.toml\"\n"),
            "wingbeat: study.toml:4:1: fit.covariance: there is no file none.toml\n");
}

TEST_F(Tolerance, CorrelationsOfParameters) {
  const std::string resistance =
      "[[parameter]]\nkey = \"motor.armature_resistance\"\ndistribution = \"lognormal\"\n"
      "geometric_deviation = 1.1\n";
  const std::string radius =
      "[[parameter]]\nkey = \"friction.radius\"\ndistribution = \"normal\"\n"
      "relative_deviation = 0.1\n";
  const auto with = [](const std::string& key, const std::string& value) {
    return "correlation = { with = \"" + key + "\", value = " + value + " }\n";
  };
  const std::string few = "[samples]\ncount = 64\n";
  const Outcome text = run({"tolerance", study(few + radius + with("motor.armature_resistance", "-0.7") + resistance)});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("correlation -0.7 of friction.radius with motor.armature_resistance"));
  EXPECT_THAT(text.out, HasSubstr("friction.radius + motor.armature_resistance"));

  EXPECT_EQ(
      complaint(radius + with("motor.inertia", "0.5") + resistance),
      "wingbeat: study.toml:7:17: parameter.correlation.with: \"motor.inertia\" is no uncertain parameter of this "
      "study\n");
  EXPECT_EQ(complaint(radius + with("friction.radius", "0.5")),
            "wingbeat: study.toml:7:17: parameter.correlation.with: names the parameter itself\n");
  EXPECT_THAT(complaint(radius + with("motor.armature_resistance", "1.5") + resistance),
              HasSubstr("parameter.correlation.value: must lie between -1 and 1\n"));
  EXPECT_THAT(complaint(radius + "lower = 0\n" + with("motor.armature_resistance", "0.5") + resistance),
              HasSubstr("friction.radius must be normal or lognormal without bounds to be correlated\n"));
  EXPECT_THAT(
      complaint(radius + with("motor.armature_resistance", "0.5") + resistance + with("friction.radius", "0.5")),
      HasSubstr("the correlation of motor.armature_resistance with friction.radius is given already\n"));
  const std::string constant =
      "[[parameter]]\nkey = \"motor.torque_constant\"\ndistribution = \"normal\"\n"
      "relative_deviation = 0.02\n";
  EXPECT_THAT(complaint(radius + with("motor.armature_resistance", "0.9") + resistance +
                        with("motor.torque_constant", "0.9") + constant + with("friction.radius", "-0.9")),
              HasSubstr("no parameters can have all the correlations given: their matrix is not positive definite\n"));
}

TEST_F(Tolerance, BadStudiesAreRefusedWithTheirPlace) {
  EXPECT_EQ(
      complaint(""),
      "wingbeat: study.toml:1:2: study: nothing is uncertain; give [[parameter]] or [[choice]] sections or [fit]\n");
  EXPECT_EQ(complaint(friction + friction),
            "wingbeat: study.toml:8:1: parameter.key: friction.radius is given already\n");
  EXPECT_EQ(complaint("[[parameter]]\nkey = \"friction.radios\"\n"),
            "wingbeat: study.toml:4:1: parameter.key: friction.radios: unknown key; did you mean friction.radius?\n");
  EXPECT_EQ(complaint("[[parameter]]\nkey = \"wing.count\"\ndistribution = \"normal\"\ndeviation = 1\n"),
            "wingbeat: study.toml:4:1: parameter.key: wing.count is a whole number and has no derivative\n");
  EXPECT_EQ(
      complaint("[[parameter]]\nkey = \"motor.gear_ratio\"\ndistribution = \"normal\"\ndeviation = 1\n"),
      "wingbeat: study.toml:4:1: parameter.key: motor.gear_ratio is not in the vehicle; give it in [set] first\n");
  EXPECT_EQ(complaint("hold = { frequency = \"22 Hz\" }\n[[parameter]]\nkey = \"supply.voltage\"\n"),
            "wingbeat: study.toml:5:1: parameter.key: supply.voltage has no effect where the frequency is held\n");
  EXPECT_EQ(complaint("[[parameter]]\nkey = \"friction.radius\"\ndistribution = \"normal\"\nmean = \"2 mm\"\n"),
            "wingbeat: study.toml:3:1: parameter.deviation: give one of deviation and relative_deviation\n");
  EXPECT_EQ(complaint("[[parameter]]\nkey = \"friction.radius\"\ndistribution = \"normal\"\ndeviation = \"2 kg\"\n"),
            "wingbeat: study.toml:6:1: parameter.deviation: expected a length such as \"5 mm\", got \"2 kg\"\n");
  EXPECT_EQ(complaint("[[parameter]]\nkey = \"friction.radius\"\ndistribution = \"uniform\"\nmedian = 1\n"),
            "wingbeat: study.toml:6:1: parameter.median: has no place with distribution = \"uniform\"\n");
  EXPECT_EQ(complaint("[[parameter]]\nkey = \"friction.radius\"\ndistribution = \"uniform\"\n"
                      "lower = \"3 mm\"\nupper = \"2 mm\"\n"),
            "wingbeat: study.toml:7:1: parameter.upper: must exceed parameter.lower\n");
  EXPECT_EQ(
      complaint("[[parameter]]\nkey = \"transmission.crank_radius\"\ndistribution = \"uniform\"\n"
                "lower = \"30 mm\"\nupper = \"31 mm\"\n"),
      "wingbeat: study.toml:4:1: transmission.rod_length: at the parameters' means: must be longer than the crank "
      "radius [m], got 0.02\n");
}

TEST_F(Tolerance, AVehicleThatNeverFlapsSaysSo) {
  const std::string file = study("hold = { voltage = \"0.5 V\" }\n[samples]\ncount = 16\n" + friction);
  const Outcome outcome = run({"tolerance", file});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.out, HasSubstr("No linear prediction: at the parameters' means the vehicle is locked"));
}

}  // namespace

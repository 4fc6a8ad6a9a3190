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
            "wingbeat: study.toml:6:1: parameter.median: does not apply with distribution = \"uniform\"\n");
  EXPECT_EQ(complaint("[[parameter]]\nkey = \"friction.radius\"\ndistribution = \"uniform\"\n"
                      "lower = \"3 mm\"\nupper = \"2 mm\"\n"),
            "wingbeat: study.toml:7:1: parameter.upper: must exceed parameter.lower\n");
  EXPECT_EQ(
      complaint("[[parameter]]\nkey = \"transmission.crank_radius\"\ndistribution = \"uniform\"\n"
                "lower = \"30 mm\"\nupper = \"31 mm\"\n"),
      "wingbeat: study.toml:4:1: transmission.rod_length: at the parameters' means: must be longer than the crank "
      "radius [m], got 0.02 (20 mm)\n");
}

TEST_F(Tolerance, AVehicleThatNeverFlapsSaysSo) {
  const std::string file = study("hold = { voltage = \"0.5 V\" }\n[samples]\ncount = 16\n" + friction);
  const Outcome outcome = run({"tolerance", file});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.out, HasSubstr("No linear prediction: at the parameters' means the vehicle is locked"));
}

const std::string formulations =
    "[[choice]]\nname = \"formulation\"\nalternative = [\n  { name = \"rod-force\", weight = 3 },\n"
    "  { name = \"virtual-work\", set = { transmission.formulation = \"virtual-work\" } },\n]\n";
const std::string coefficients =
    "[[choice]]\nname = \"coefficients\"\n[[choice.alternative]]\nname = \"translational-2022\"\n"
    "[[choice.alternative]]\nname = \"own\"\n"
    "set.aerodynamics.coefficients.lift = { offset = 0, amplitude = 1.8, rate = 2, phase = 0 }\n"
    "set.aerodynamics.coefficients.drag = { offset = 1.9, amplitude = -1.5, rate = 2, phase = 0 }\n";

TEST_F(Tolerance, ChoicesOfModelInReportDataSetFigureAndJson) {
  const std::string file =
      study("hold = { voltage = \"5.5 V\" }\nmetrics = [\"lift_mean_n\"]\n[samples]\ncount = 128\n" + friction +
            formulations + coefficients);
  const Outcome text = run({"tolerance", file, "-o", path("t.nc"), "--plot", path("t.svg")});
  ASSERT_EQ(text.status, 0) << text.err;
  for (const char* part :
       {"256 scrambled Sobol samples, 640 vehicles including those for the indices",
        "Uncertain parameters and choices of model\n",
        "  formulation                       choice, rod-force 75 %, virtual-work 25 %\n",
        "The linear prediction is that of the most likely alternatives, rod-force (formulation),\n"
        "  translational-2022 (coefficients). It has no share for a choice.\n",
        "Effect of the choice of formulation\n", "Effect of the choice of coefficients\n",
        "  mean +- deviation                 difference  parameters   translational-2022                  own\n"}) {
    EXPECT_THAT(text.out, HasSubstr(part));
  }
  EXPECT_THAT(text.out, testing::ContainsRegex("  virtual-work +64    100.00 %    [0-9.]+ % "));
  EXPECT_THAT(text.out, testing::ContainsRegex("\n  formulation +0[^\n]*    -\n"));
  for (std::size_t begin = 0, end; (end = text.out.find('\n', begin)) != std::string::npos; begin = end + 1) {
    EXPECT_LE(end - begin, 102U) << text.out.substr(begin, end - begin);
  }
  EXPECT_THAT(read(path("t.svg")), HasSubstr("formulation"));

  const Json json = run({"tolerance", file, "--json", "--threads", "1"}).json();
  ASSERT_EQ(json["choices"].size(), 2U);
  const Json& choice = json["choices"][0];
  EXPECT_EQ(choice["name"], "formulation");
  EXPECT_EQ(choice["keys"], Json::array({"transmission.formulation"}));
  EXPECT_EQ(choice["linear_alternative"], "rod-force");
  EXPECT_EQ(choice["alternatives"][0]["share"], 0.75);
  EXPECT_EQ(choice["alternatives"][1]["samples"], 64);
  EXPECT_EQ(json["outputs"]["lift_mean_n"]["factors"][1]["name"], "formulation");
  EXPECT_FALSE(json["outputs"]["lift_mean_n"]["factors"][1].contains("linear_share"));
  EXPECT_TRUE(json["outputs"]["lift_mean_n"]["factors"][0].contains("linear_share"));

  // The data set's own samples give what the report says.
  const wingbeat::NetcdfReader data(path("t.nc"));
  const auto lift = data.read("lift_to_weight"), chosen = data.read("choice_formulation");
  ASSERT_EQ(chosen.size(), 256U);
  double sums[] = {0.0, 0.0}, counts[] = {0.0, 0.0}, hovers[] = {0.0, 0.0};
  for (std::size_t n = 0; n < 256; ++n) {
    const std::size_t a = std::size_t(chosen[n]);
    ASSERT_LT(a, 2U);
    sums[a] += lift[n];
    counts[a] += 1.0;
    hovers[a] += lift[n] >= 1.0;
  }
  for (std::size_t a = 0; a < 2; ++a) {
    const Json& alternative = choice["alternatives"][a];
    EXPECT_EQ(alternative["samples"], counts[a]);
    EXPECT_EQ(alternative["hover"]["count"], hovers[a]);
    EXPECT_NEAR(alternative["outputs"]["lift_to_weight"]["mean"].get<double>(), sums[a] / counts[a], 1e-12);
  }
  EXPECT_NEAR(choice["outputs"]["lift_to_weight"]["difference"].get<double>(),
              sums[1] / counts[1] - sums[0] / counts[0], 1e-12);
  EXPECT_EQ(data.read("mean_by_coefficients").size(), 2 * json["outputs"].size());
  EXPECT_EQ(data.read("share_of_formulation"), (std::vector<double>{0.75, 0.25}));
  EXPECT_EQ(data.read("parameter_deviation").size(), json["outputs"].size());
}

TEST_F(Tolerance, ManyAlternativesGoOnInFurtherColumns) {
  std::string list = "[[choice]]\nname = \"mass\"\nalternative = [\n";
  for (int a = 1; a <= 5; ++a) {
    list += "  { name = \"mass-of-copy-" + std::to_string(a) + "\", set.vehicle.mass = \"3." + std::to_string(a) +
            " g\" },\n";
  }
  const Outcome text = run({"tolerance", study("metrics = [\"lift_mean_n\"]\n[samples]\ncount = 16\nindices = false\n" +
                                               list + "]\n" + friction)});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out,
              HasSubstr("  mean +- deviation                 difference  parameters       mass-of-copy-1       "
                        "mass-of-copy-2\n"));
  EXPECT_THAT(text.out, HasSubstr("  mean +- deviation                      mass-of-copy-3       mass-of-copy-4       "
                                  "mass-of-copy-5\n"));
}

TEST_F(Tolerance, AChoiceAloneNeedsNoParameter) {
  const Json json = run({"tolerance", study("[samples]\ncount = 32\n" + formulations), "--json"}).json();
  EXPECT_EQ(json["parameters"].size(), 0U);
  EXPECT_EQ(json["samples"], 64);
  EXPECT_GT(json["choices"][0]["outputs"]["lift_mean_n"]["difference"].get<double>(), 0.0);
}

TEST_F(Tolerance, BadChoicesAreRefusedWithTheirPlace) {
  const std::string begin = "[[choice]]\nname = \"mass\"\n";
  const auto choice = [&](const std::string& one, const std::string& other) {
    return begin + "alternative = [\n  " + one + ",\n  " + other + ",\n]\n";
  };
  const std::string light = "{ name = \"light\", set.vehicle.mass = \"3 g\" }";
  EXPECT_EQ(complaint("[[choice]]\nalternative = []\n"),
            "wingbeat: study.toml:3:1: choice.name: missing; expected a name such as \"coefficients\"\n");
  EXPECT_EQ(complaint("[[choice]]\nname = \"lift and drag\"\n"),
            "wingbeat: study.toml:4:1: choice.name: expected a name of letters, digits and '_', at most 40 of them, "
            "got \"lift and drag\"\n");
  EXPECT_EQ(
      complaint(begin),
      "wingbeat: study.toml:3:1: choice.alternative: missing; expected [[choice.alternative]] sections, each with "
      "name, weight and set\n");
  EXPECT_EQ(
      complaint(begin + "alternative = [" + light + "]\n"),
      "wingbeat: study.toml:3:1: choice.alternative: the choice mass has one; expected two alternatives or more\n");
  EXPECT_EQ(complaint(choice(light, "{ set.vehicle.mass = \"4 g\" }")),
            "wingbeat: study.toml:7:3: choice.alternative.name: missing; expected a name such as "
            "\"translational-2022\"\n");
  EXPECT_EQ(complaint(choice(light, light)),
            "wingbeat: study.toml:7:5: choice.alternative.name: \"light\" is the name of another alternative\n");
  EXPECT_EQ(complaint(choice(light, "{ name = \"b\", weight = 0 }")),
            "wingbeat: study.toml:7:17: choice.alternative.weight: must be > 0\n");
  EXPECT_EQ(complaint(choice(light, "{ name = \"b\", wait = 1 }")),
            "wingbeat: study.toml:7:17: choice.alternative.wait: unknown key; known here: name, weight, set\n");
  EXPECT_EQ(
      complaint(choice("{ name = \"a\" }", "{ name = \"b\" }")),
      "wingbeat: study.toml:3:1: choice.alternative: no alternative of mass sets anything; expected set = { ... } "
      "with vehicle-file keys\n");
  EXPECT_EQ(
      complaint(choice(light, "{ name = \"b\", set = 3 }")),
      "wingbeat: study.toml:7:17: choice.alternative.set: expected a table of vehicle-file keys, got the number 3\n");
  EXPECT_EQ(complaint(choice(light, "{ name = \"b\", set.vehicle.mas = 1 }")),
            "wingbeat: study.toml:7:29: choice.alternative.set.vehicle.mas: unknown key; did you mean vehicle.mass?\n");

  const std::string heavy = "{ name = \"heavy\", set.vehicle.mass = \"4 g\" }", mass = choice(light, heavy);
  const std::string voltage = "{ name = \"low\", set.supply.voltage = \"3 V\" }";
  EXPECT_EQ(complaint(mass + mass), "wingbeat: study.toml:10:1: choice.name: \"mass\" is the name of another choice\n");
  EXPECT_EQ(complaint(mass + "[[choice]]\nname = \"other\"\nalternative = [{ name = \"none\" }, " + heavy + "]\n"),
            "wingbeat: study.toml:11:65: choice.alternative.set.vehicle.mass: the choice mass sets it already\n");
  EXPECT_EQ(complaint(mass + "[[parameter]]\nkey = \"vehicle.mass\"\n"),
            "wingbeat: study.toml:10:1: parameter.key: the choice mass sets vehicle.mass already\n");
  EXPECT_EQ(complaint("hold = { voltage = \"5 V\" }\n" + choice(voltage, "{ name = \"b\" }")),
            "wingbeat: study.toml:7:30: choice.alternative.set.supply.voltage: study.hold holds the voltage already\n");
  EXPECT_EQ(complaint("hold = { frequency = \"22 Hz\" }\n" + choice(voltage, "{ name = \"b\" }")),
            "wingbeat: study.toml:7:30: choice.alternative.set.supply.voltage: has no effect where the frequency is "
            "held\n");
  const Outcome overridden = run({"tolerance", study(mass), "--set", "vehicle.mass=3 g"});
  EXPECT_EQ(overridden.status, 2);
  EXPECT_EQ(overridden.err, "wingbeat: --set vehicle.mass=3 g: vehicle.mass: has no effect: the choice mass sets it\n");
}

TEST_F(Tolerance, AlternativesThatMakeAnImpossibleVehicleAreRefusedByName) {
  const auto choice = [](const std::string& name, const std::string& set) {
    return "[[choice]]\nname = \"" + name + "\"\nalternative = [{ name = \"none\" }, { name = \"own\", set = { " + set +
           " } }]\n";
  };
  const std::string mass = choice("mass", "vehicle.mass = \"4 g\"");
  EXPECT_EQ(complaint(choice("mass", "vehicle.mass = \"4 m\"")),
            "wingbeat: study.toml:5:67: choice.alternative.set.vehicle.mass: with mass = own: vehicle.mass: expected a "
            "mass such as \"3 g\", got \"4 m\"\n");
  // Alone, whatever the other choice.
  EXPECT_EQ(complaint(mass + choice("air", "aerodynamics.added_mass = true")),
            "wingbeat: study.toml:8:72: choice.alternative.set.aerodynamics.added_mass: with air = own: "
            "aerodynamics.added_mass: needs the wing's outline: give wing.planform.s22, or a planform with a shape\n");
  // Only with the other.
  EXPECT_EQ(
      complaint(choice("crank", "transmission.crank_radius = \"9 mm\"") +
                choice("rod", "transmission.rod_length = \"8 mm\"")),
      "wingbeat: study.toml:8:72: choice.alternative.set.transmission.rod_length: with crank = own and rod = own: "
      "transmission.rod_length: must be longer than the crank radius [m], got 0.008 (8 mm)\n");
  EXPECT_EQ(complaint(choice("friction", "friction.type = \"none\"") + friction),
            "wingbeat: study.toml:7:1: friction.radius: with friction = own, the vehicle does not have it\n");
  EXPECT_EQ(
      complaint(choice("rod", "transmission.rod_length = \"5.1 mm\"") +
                "[[parameter]]\nkey = \"transmission.crank_radius\"\ndistribution = \"uniform\"\n"
                "lower = \"5 mm\"\nupper = \"5.4 mm\"\n"),
      "wingbeat: study.toml:5:35: transmission.rod_length: with rod = own, at the parameters' means: must be longer "
      "than the crank radius [m], got 0.0051 (5.1 mm)\n");
  EXPECT_EQ(
      complaint(choice("supply", "supply = { type = \"sine\", amplitude = \"3 V\", frequency = \"20 Hz\" }")),
      "wingbeat: study.toml:5:35: choice.alternative: with supply = own: supply.type: a sine supply gives no steady "
      "flapping in crank angle; expected constant or pwm\n");
}

}  // namespace

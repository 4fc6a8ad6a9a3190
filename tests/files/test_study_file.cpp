#include "wingbeat/files/study_file.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/files/tolerance_file.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class StudyFile : public testing::Test {
 protected:
  StudyFile() {
    std::string pattern = testing::TempDir() + "wingbeat-study-XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
    for (const char* name : {"friction2022.toml", "friction2022-springs.toml"}) {
      fs::copy_file(fs::path(WINGBEAT_DATA) / "designs" / name, folder_ / name);
    }
  }
  ~StudyFile() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }

  /// A study of the vehicle with springs; lines of `text` count from 3.
  Study read(const std::string& text) const {
    write("s.toml", "[study]\nvehicle = \"friction2022-springs.toml\"\n" + text);
    return read_study(folder_ / "s.toml");
  }

  /// What is said about a study, without the folder.
  std::string complaint(const std::string& text) const {
    try {
      read(text);
      return "no complaint";
    } catch (const InputError& error) {
      std::string said = error.what();
      const std::string folder = folder_.string() + "/";
      for (auto position = said.find(folder); position != std::string::npos; position = said.find(folder))
        said.erase(position, folder.size());
      return said;
    }
  }

  fs::path folder_;
};

const std::string radius_axis = "[[axis]]\nkey = \"transmission.crank_radius\"\nvalues = [\"4 mm\", \"5 mm\"]\n";

TEST_F(StudyFile, ExamplesAreRead) {
  std::vector<std::uint64_t> sizes;
  for (const char* name :
       {"crank-radius", "sobol-22hz", "voltage-crank-radius", "trend-crank-fixed-hinge", "trend-crank-fixed-stroke",
        "trend-rod", "trend-voltage", "trend-spring", "trend-frequency"}) {
    sizes.push_back(read_study(fs::path(WINGBEAT_DATA) / "studies" / (std::string(name) + ".toml")).sweep.size());
  }
  EXPECT_THAT(sizes, ElementsAre(222U, 2048U, 56U * 76U, 444U, 444U, 484U, 16U * 161U, 2U * 181U, 4U * 149U));
}

TEST_F(StudyFile, NoLiftOverTheWeightIsHeldWithoutAMass) {
  std::string vehicle;
  std::ifstream file(folder_ / "friction2022-springs.toml");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("mass")) vehicle += line + "\n";
  }
  write("friction2022-springs.toml", vehicle);
  const std::string hover = "hold = { lift_to_weight = 1 }\n";
  EXPECT_THAT(complaint(hover + radius_axis), HasSubstr("vehicle.mass: the vehicle states no mass; give vehicle.mass"));
  const std::string by_mass = "[[axis]]\nkey = \"vehicle.mass\"\nvalues = [0.001, 0.002]\n";
  EXPECT_EQ(read(hover + "[set]\nvehicle.mass = 0.001\n" + radius_axis).sweep.size(), 2U);
  EXPECT_NO_THROW(read(hover + by_mass));
}

TEST_F(StudyFile, ExamplesOfToleranceAndOptimiseAreRead) {
  const fs::path studies = fs::path(WINGBEAT_DATA) / "studies";
  EXPECT_EQ(read_tolerance_study(studies / "tolerance-hover.toml").parameters.size(), 10U);
  const ToleranceStudy models = read_tolerance_study(studies / "tolerance-model-form.toml");
  EXPECT_EQ(models.choices.size(), 3U);
  EXPECT_EQ(models.combinations.size(), 12U);
  EXPECT_EQ(read_optimise_study(studies / "optimise-hover.toml").study.constraints.size(), 3U);
  const OptimiseFile motors = read_optimise_study(studies / "optimise-motor.toml");
  EXPECT_EQ(motors.motors.size(), 18U);
  const auto refused = [](const MotorCandidate& motor) { return !motor.refused.empty(); };
  EXPECT_EQ(std::count_if(motors.motors.begin(), motors.motors.end(), refused), 10);
}

TEST_F(StudyFile, LinearAndLogarithmicAxesHitTheirEnds) {
  const Study study = read(
      "[[axis]]\nkey = \"supply.voltage\"\nfrom = \"3 V\"\nto = 5\ncount = 5\n"
      "[[axis]]\nkey = \"friction.radius\"\nfrom = \"3 mm\"\nto = \"0.003 mm\"\ncount = 4\nscale = \"log\"\n");
  const auto& axes = study.sweep.axes;
  ASSERT_EQ(axes.size(), 2U);
  EXPECT_THAT(axes[0].quantities[0].values, ElementsAre(3.0, 3.5, 4.0, 4.5, 5.0));
  EXPECT_EQ(axes[0].name, "supply_voltage");
  EXPECT_EQ(axes[0].quantities[0].unit, "V");
  const auto& radius = axes[1].quantities[0].values;
  EXPECT_EQ(radius.front(), 3e-3);
  EXPECT_EQ(radius.back(), 3e-6);
  EXPECT_NEAR(radius[1], 3e-4, 1e-18);
  EXPECT_NEAR(radius[2], 3e-5, 1e-18);
}

TEST_F(StudyFile, ListedAndZippedValues) {
  const Study study = read(
      "[[axis]]\nname = \"wing\"\nkeys = [\"wing.inertia\", \"wing.planform.s2\", \"transmission.formulation\"]\n"
      "values = [[\"7e-8 kg m2\", 8e-8], [2.4e-6, 2.6e-6], [\"rod-force\", \"virtual-work\"]]\n");
  const Sweep& sweep = study.sweep;
  ASSERT_EQ(sweep.axes.size(), 1U);
  EXPECT_EQ(sweep.axes[0].name, "wing");
  EXPECT_EQ(sweep.axes[0].quantities[0].name, "wing_inertia");
  const SweepDesign first = design_at(sweep, 0), second = design_at(sweep, 1);
  EXPECT_EQ(first.design.wing.inertia, 7e-8);
  EXPECT_EQ(second.design.wing.inertia, 8e-8);
  EXPECT_EQ(second.design.wing.planform.s2, 2.6e-6);
  EXPECT_EQ(first.design.transmission.formulation, Formulation::rod_force);
  EXPECT_EQ(second.design.transmission.formulation, Formulation::virtual_work);
}

TEST_F(StudyFile, AxesOfVeryManyValues) {
  std::string text = "[[axis]]\nkey = \"supply.voltage\"\nvalues = [\n";
  for (int n = 0; n < 300000; ++n) text += std::to_string(2.0 + 1e-5 * n) + "000000000000,\n";
  ASSERT_GT(text.size(), std::size_t(6) << 20);
  const Study study = read(text + "]\n");
  EXPECT_EQ(study.sweep.size(), 300000U);
  EXPECT_NEAR(study.sweep.axes[0].quantities[0].values.back(), 4.99999, 1e-9);
  // A file that is not a study is not read to its end.
  write("large.toml", std::string(largest_study + 1, '\n'));
  try {
    read_study(folder_ / "large.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("large.toml: larger than 64 MB, which no study file is"));
  }
}

TEST_F(StudyFile, ChoicesMakeVariants) {
  const Study study = read(
      "[[axis]]\nkey = \"springs\"\nvalues = [false, true]\n"
      "[[axis]]\nkey = \"spring.resonance\"\nvalues = [\"10 Hz\", \"22 Hz\"]\n"
      "[[axis]]\nkey = \"condition\"\nvalues = [\"air\", \"vacuum\", \"wingless\"]\n");
  const Sweep& sweep = study.sweep;
  ASSERT_EQ(sweep.size(), 12U);
  EXPECT_EQ(sweep.variants.size(), 6U);
  EXPECT_FALSE(design_at(sweep, 3).design.spring.resonance);
  EXPECT_EQ(design_at(sweep, 11).design.spring.resonance, 22.0);
  EXPECT_FALSE(design_at(sweep, 11).design.spring.stiffness);
  EXPECT_EQ(design_at(sweep, 11).condition, Condition::wingless);
  EXPECT_EQ(design_at(sweep, 7).condition, Condition::vacuum);
}

TEST_F(StudyFile, OptionsAndOverrides) {
  const Study study = read(
      "title = \"t\"\ntolerance = 1e-8\nmetrics = [\"lift_mean_n\", \"frequency_hz\"]\nhold = { voltage = \"4 V\" }\n"
      "[set]\n\"motor.inertia\" = \"2e-7 kg m2\"\nspring.stiffness = 1e-3\n"
      "wing.planform = { shape = \"rectangle\", length = \"60 mm\", root_chord = \"20 mm\" }\n" +
      radius_axis);
  EXPECT_EQ(study.title, "t");
  EXPECT_EQ(study.sweep.options.tolerance, 1e-8);
  EXPECT_EQ(study.sweep.options.metrics.count(), 2U);
  EXPECT_TRUE(study.sweep.options.metrics[std::size_t(Metric::lift_mean)]);
  const Design<double> d = design_at(study.sweep, 0).design;
  EXPECT_EQ(d.supply.voltage, 4.0);
  EXPECT_EQ(d.motor.constants.inertia, 2e-7);
  EXPECT_EQ(d.spring.stiffness, 1e-3);
  EXPECT_EQ(d.wing.planform.shape, PlanformShape::rectangle);
  const std::optional<Hold> fast = read("hold = { frequency = \"22 Hz\" }\n" + radius_axis).sweep.hold;
  ASSERT_TRUE(fast);
  EXPECT_EQ(fast->held, Held::frequency);
  EXPECT_EQ(fast->value, 22.0);
  const Sweep hovers = read("hold = { lift_to_weight = 1 }\n[set]\nvehicle.mass = \"2 g\"\n" + radius_axis).sweep;
  ASSERT_TRUE(hovers.hold);
  EXPECT_EQ(hovers.hold->held, Held::lift_to_weight);
  EXPECT_EQ(hovers.hold->value, 1.0);
  const Sweep lifts = read("[[axis]]\nkey = \"lift\"\nvalues = [\"10 mN\", \"20 mN\"]\n").sweep;
  ASSERT_TRUE(design_at(lifts, 1).hold);
  EXPECT_EQ(design_at(lifts, 1).hold->held, Held::lift);
  EXPECT_EQ(design_at(lifts, 1).hold->value, 0.02);
}

TEST_F(StudyFile, TheTextsOfAStudyMakeItAgain) {
  write("d.csv", "# designs\nsupply.voltage [V], friction.radius (mm)\n3, 2\n4.5,1e0\n\n");
  const std::string text =
      "[set]\nmotor.inertia = 2e-7\n[[axis]]\nkey = \"springs\"\nvalues = [true, false]\n"
      "[samples]\nmethod = \"csv\"\nfile = \"d.csv\"\n";
  const Study study = read(text);
  fs::remove_all(folder_);
  const Study again = parse_study(study.input);
  ASSERT_EQ(again.sweep.size(), 4U);
  for (std::uint64_t n = 0; n < 4; ++n) {
    const auto a = design_at(study.sweep, n).design, b = design_at(again.sweep, n).design;
    EXPECT_EQ(write_design(a), write_design(b));
  }
  const Design<double> d = design_at(again.sweep, 1).design;
  EXPECT_EQ(d.supply.voltage, 4.5);
  EXPECT_EQ(d.friction.coefficient, 1e-3);
  EXPECT_EQ(d.motor.constants.inertia, 2e-7);
}

TEST_F(StudyFile, SamplesFillTheirRanges) {
  for (const char* method : {"sobol", "latin-hypercube"}) {
    const Study study =
        read(std::string("[samples]\nmethod = \"") + method +
             "\"\ncount = 64\nseed = 9\n[[samples.range]]\nkey = \"supply.voltage\"\nfrom = 2\nto = 4\n"
             "[[samples.range]]\nkey = \"spring.stiffness\"\nfrom = 1e-4\nto = 1e-2\nscale = \"log\"\n");
    const SweepAxis& axis = study.sweep.axes.at(0);
    ASSERT_EQ(axis.count, 64U);
    std::vector<int> voltage(64, 0), stiffness(64, 0);
    for (std::uint64_t n = 0; n < 64; ++n) {
      ++voltage.at(std::size_t((axis.value(0, n) - 2.0) * 32.0));
      ++stiffness.at(std::size_t(std::log10(axis.value(1, n) / 1e-4) * 32.0));
    }
    EXPECT_EQ(voltage, std::vector<int>(64, 1)) << method;
    EXPECT_EQ(stiffness, std::vector<int>(64, 1)) << method;
  }
}

TEST_F(StudyFile, WrongStudiesAreRefused) {
  const std::pair<std::string, std::string> cases[] = {
      {"titel = 1\n" + radius_axis, "s.toml:3:1: study.titel: unknown key; did you mean study.title?"},
      {"[axes]\n", "s.toml:3:2: axes: unknown key; did you mean axis?"},
      {"title = 5\n" + radius_axis, "s.toml:3:1: study.title: expected a text, got the number 5"},
      {"tolerance = 1\n" + radius_axis,
       "s.toml:3:1: study.tolerance: expected a number from 1e-12 to 1e-2, got the number 1"},
      {"metrics = [\"lift_mean\"]\n" + radius_axis,
       "s.toml:3:12: study.metrics: \"lift_mean\" is no metric; did you mean lift_mean_n?"},
      {"metrics = [\"lift_mean_n\", \"lift_mean_n\"]\n" + radius_axis,
       "s.toml:3:27: study.metrics: \"lift_mean_n\" is given twice"},
      {"metrics = []\n" + radius_axis,
       "s.toml:3:1: study.metrics: expected an array of names such as [\"frequency_hz\", "
       "\"lift_mean_n\"], got an array"},
      {"hold = { voltage = \"3 kg\" }\n" + radius_axis,
       "s.toml:3:10: study.hold.voltage: expected a voltage such as \"3 V\", got \"3 kg\""},
      {"hold = { voltage = 3, frequency = 22 }\n" + radius_axis,
       "s.toml:3:1: study.hold: give one of voltage, frequency, lift, lift_to_weight and power"},
      {"hold = { frequency = 22, lift = 1 }\n" + radius_axis, "s.toml:3:26: study.hold: holds the frequency already"},
      {"hold = { lift_to_weigth = 1 }\n" + radius_axis,
       "s.toml:3:10: study.hold.lift_to_weigth: unknown key; did you mean study.hold.lift_to_weight?"},
      {"hold = { lift = \"0 mN\" }\n" + radius_axis, "s.toml:3:10: study.hold.lift: must be > 0 N"},
      {"hold = { lift_to_weight = -1 }\n" + radius_axis, "s.toml:3:10: study.hold.lift_to_weight: must be > 0"},
      {"hold = { lift = \"9 mN\" }\n[[axis]]\nkey = \"supply.voltage\"\nvalues = [1, 2]\n",
       "s.toml:5:1: supply.voltage: has no effect where the mean lift is held: the voltage is found for it"},
      {"hold = { lift = \"9 mN\" }\n[[axis]]\nkey = \"frequency\"\nvalues = [11, 22]\n",
       "s.toml:5:1: axis.key: study.hold holds the mean lift already"},
      {"[[axis]]\nkey = \"lift\"\nvalues = [0.01]\n[[axis]]\nkey = \"frequency\"\nvalues = [11]\n",
       "s.toml:7:1: axis.key: another axis gives what is held"},
      {"hold = { frequency = \"0 Hz\" }\n" + radius_axis, "s.toml:3:10: study.hold.frequency: must be > 0 Hz"},
      {"", "s.toml:1:2: study: nothing to vary; give [[axis]] sections or [samples]"},
      {"x =\n", "s.toml:3:4: not TOML: in a key-value pair, expected value, saw '\\n'"},
      {"[set]\nmotor.inertja = 1\n" + radius_axis,
       "s.toml:4:7: set.motor.inertja: unknown key; did you mean motor.inertia?"},
      {"[set]\nmotor.inertia = \"3 V\"\n" + radius_axis,
       "s.toml:4:7: set.motor.inertia: motor.inertia: expected a moment of inertia such as \"1.5e-7 kg m2\", got "
       "\"3 V\""},
      {"[set]\nmotor.inertia = -1\n" + radius_axis,
       "s.toml:4:7: set.motor.inertia: motor.inertia: must be > 0 [kg m2], got -1"},
      {"[[axis]]\nvalues = [1]\n", "s.toml:3:1: axis: give one of key and keys"},
      {"[[axis]]\nkey = \"motor.inertja\"\nvalues = [1]\n",
       "s.toml:4:1: axis.key: motor.inertja: unknown key; did you mean motor.inertia?"},
      {"[[axis]]\nkey = \"spring\"\nvalues = [true]\n",
       "s.toml:4:1: axis.key: spring: unknown key; did you mean springs?"},
      {"[[axis]]\nkey = \"wing.planform.chords\"\nvalues = [1]\n",
       "s.toml:4:1: axis.key: wing.planform.chords is a table, of which no axis can be made"},
      {radius_axis + radius_axis, "s.toml:7:1: axis.key: transmission.crank_radius is varied already"},
      {"[set]\nsupply.voltage = 2\n[[axis]]\nkey = \"supply.voltage\"\nvalues = [1, 2]\n",
       "s.toml:6:1: axis.key: supply.voltage is given in [set] already"},
      {"[[axis]]\nkey = \"supply.voltage\"\nvalues = [1, \"2 A\"]\n",
       "s.toml:5:14: axis.values: expected a voltage such as \"3 V\", got \"2 A\""},
      {"[[axis]]\nkey = \"supply.voltage\"\nvalues = [1, \"1 V\"]\n",
       "s.toml:5:14: axis.values: the same value is given twice"},
      {"[[axis]]\nkey = \"supply.voltage\"\nvalues = []\n",
       "s.toml:5:1: axis.values: expected an array of values, got an array"},
      {"[[axis]]\nkey = \"supply.voltage\"\nvalues = [1]\ncount = 3\n",
       "s.toml:6:1: axis.count: give values, or from, to and count, not both"},
      {"[[axis]]\nkey = \"supply.voltage\"\nfrom = 1\ncount = 3\n",
       "s.toml:3:1: axis.to: missing; expected a voltage such as \"3 V\""},
      {"[[axis]]\nkey = \"supply.voltage\"\nfrom = 1\nto = 1\ncount = 3\n",
       "s.toml:6:1: axis.to: is the value of from"},
      {"[[axis]]\nkey = \"supply.voltage\"\nfrom = 0\nto = 1\ncount = 3\nscale = \"log\"\n",
       "s.toml:5:1: axis.from: must be > 0 on a logarithmic scale"},
      {"[[axis]]\nkey = \"supply.voltage\"\nfrom = 1\nto = 2\ncount = 3\nscale = \"cubic\"\n",
       "s.toml:8:1: axis.scale: expected \"linear\" or \"log\", got \"cubic\""},
      {"[[axis]]\nkey = \"supply.voltage\"\nfrom = 1\nto = 2\ncount = 1\n",
       "s.toml:7:1: axis.count: expected a whole number from 2 to 1000000, got the number 1"},
      {"[[axis]]\nkey = \"supply.voltage\"\nfrom = 1\nto = 2\ncount = 2.5\n",
       "s.toml:7:1: axis.count: expected a whole number from 2 to 1000000, got the number 2.5"},
      {"[[axis]]\nkey = \"springs\"\nvalues = [\"off\"]\n",
       "s.toml:5:11: axis.values: expected true or false, got \"off\""},
      {"[[axis]]\nkey = \"condition\"\nvalues = [\"water\"]\n",
       "s.toml:5:11: axis.values: expected \"air\", \"vacuum\" or \"wingless\", got \"water\""},
      {"[[axis]]\nkey = \"condition\"\nfrom = 1\n",
       "s.toml:3:1: axis.values: missing; expected the values of condition"},
      {"[[axis]]\nkey = \"transmission.formulation\"\nvalues = [\"rod-force\", \"rod\"]\n",
       "s.toml:4:1: axis: transmission.formulation: expected rod-force or virtual-work, got \"rod\""},
      {"[[axis]]\nkey = \"friction.type\"\nvalues = [\"viscous\"]\n",
       "s.toml:4:1: axis: friction.damping: missing in [friction]; expected a torsional damping such as "
       "\"3.6e-6 N m s/rad\""},
      {"[[axis]]\nkeys = [\"wing.inertia\", \"wing.count\"]\nvalues = [[1e-7]]\n",
       "s.toml:5:1: axis.values: expected 2 arrays of values, one for each of keys, got 1"},
      {"[[axis]]\nkeys = [\"wing.inertia\", \"wing.count\"]\nvalues = [[1e-7], [2, 4]]\n",
       "s.toml:5:19: axis.values: wing.count has 2 values, wing.inertia has 1"},
      {"[[axis]]\nkey = \"supply.voltage\"\nname = \"9 V\"\nvalues = [1]\n",
       "s.toml:5:1: axis.name: expected a name of letters, digits and _, beginning with a letter, got \"9 V\""},
      {"[[axis]]\nkey = \"supply.voltage\"\nname = \"lift_mean_n\"\nvalues = [1]\n",
       "s.toml:3:1: axis.name: lift_mean_n is the name of another variable"},
      {"[[axis]]\nkey = \"supply.duty\"\nvalues = [0.5]\n",
       "s.toml:4:1: supply.duty: only with supply.type = pwm or battery"},
      {"[[axis]]\nkey = \"supply.voltage\"\nvalues = [-1, 2]\n",
       "s.toml:4:1: supply.voltage: must be >= 0 [V], got -1"},
      {"[[axis]]\nkey = \"motor.inertia\"\nfrom = 0\nto = 1e-7\ncount = 3\n",
       "s.toml:4:1: motor.inertia: must be > 0 [kg m2], got 0"},
      {"[[axis]]\nkey = \"spring.stiffness\"\nvalues = [1e-3]\n[[axis]]\nkey = \"spring.resonance\"\nvalues = [20]\n",
       "s.toml:4:1: spring.stiffness: another varied key takes its place"},
      {"hold = { frequency = 22 }\n[[axis]]\nkey = \"supply.voltage\"\nvalues = [1]\n",
       "s.toml:5:1: supply.voltage: has no effect where the frequency is held: the voltage is found for it"},
      {"hold = { voltage = 3 }\n[[axis]]\nkey = \"frequency\"\nvalues = [22]\n",
       "s.toml:5:1: axis.key: study.hold holds the voltage, which then sets the frequency"},
      {"[[axis]]\nkey = \"frequency\"\nvalues = [22, \"0 Hz\"]\n", "s.toml:5:15: axis.values: must be > 0 Hz"},
      {"[set]\nsupply = { type = \"sine\", amplitude = 3, frequency = 20 }\n" + radius_axis,
       "s.toml:1:2: supply.type: a sine supply gives no steady flapping in crank angle; expected constant or pwm"},
      {"[samples]\ncount = 3\n",
       "s.toml:3:2: samples.method: missing; expected \"latin-hypercube\", \"sobol\" or \"csv\""},
      {"[samples]\nmethod = \"grid\"\n",
       "s.toml:4:1: samples.method: expected \"latin-hypercube\", \"sobol\" or \"csv\", got \"grid\""},
      {"[samples]\nmethod = \"sobol\"\ncount = 3\n",
       "s.toml:3:2: samples.range: missing; expected [[samples.range]] sections"},
      {"[samples]\nmethod = \"sobol\"\nfile = \"d.csv\"\n",
       "s.toml:5:1: samples.file: does not apply with method = \"sobol\""},
      {"[samples]\nmethod = \"csv\"\nfile = \"none.csv\"\n", "s.toml:5:1: samples.file: there is no file none.csv"},
      {"[samples]\nmethod = \"sobol\"\n[[samples.range]]\nkey = \"condition\"\n",
       "s.toml:6:1: samples.range.key: condition is not a number; make it an [[axis]]"},
      {"[samples]\nmethod = \"sobol\"\ncount = 0\n[[samples.range]]\nkey = \"supply.voltage\"\nfrom = 1\nto = 2\n",
       "s.toml:5:1: samples.count: expected a whole number from 1 to 1000000000, got the number 0"},
      {"[samples]\nmethod = \"sobol\"\ncount = 4\n[[samples.range]]\nkey = \"supply.voltage\"\nfrom = -1\nto = 2\n",
       "s.toml:7:1: supply.voltage: must be >= 0 [V], got -1"},
  };
  write("d.csv", "supply.voltage [V]\n3\n");
  for (const auto& [text, expected] : cases) EXPECT_EQ(complaint(text), expected) << text;
}

TEST_F(StudyFile, SpringsToSwitchOnMustBeThere) {
  write("s.toml", "[study]\nvehicle = \"friction2022.toml\"\n[[axis]]\nkey = \"springs\"\nvalues = [false, true]\n");
  try {
    read_study(folder_ / "s.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("s.toml:4:1: springs: the vehicle has none to switch on"));
  }
}

TEST_F(StudyFile, VehiclesAreSoughtBesideTheStudy) {
  const auto said = [&](const std::string& text) {
    write("s.toml", text);
    try {
      read_study(folder_ / "s.toml");
      return std::string("no complaint");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(said("[study]\n" + radius_axis), HasSubstr("s.toml:1:2: study.vehicle: missing; expected the name of a"));
  EXPECT_THAT(said(radius_axis), HasSubstr("s.toml:1:1: study: missing; expected a section [study]"));
  EXPECT_THAT(said("[study]\nvehicle = \"none.toml\"\n" + radius_axis),
              HasSubstr("s.toml:2:1: study.vehicle: there is no file "));
  const std::string too_long(300, 'x');
  EXPECT_THAT(said("[study]\nvehicle = \"" + too_long + ".toml\"\n" + radius_axis),
              HasSubstr("s.toml:2:1: study.vehicle: there is no file "));
  EXPECT_THAT(said("[study]\nvehicle = \"friction2022\"\n[samples]\nmethod = \"csv\"\nfile = \"" + too_long + "\"\n"),
              HasSubstr("samples.file: there is no file "));
  write("bad.toml", "[motor]\ninertja = 1\n");
  EXPECT_THAT(said("[study]\nvehicle = \"bad.toml\"\n" + radius_axis),
              HasSubstr("bad.toml:2:1: motor.inertja: unknown key"));
}

TEST_F(StudyFile, WrongTablesOfDesignsAreRefused) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "d.csv: holds no designs"},
      {"supply.voltage [V]\n", "d.csv: holds no designs"},
      {"supply.voltag [V]\n3\n", "d.csv:1:1: supply.voltag: unknown key; did you mean supply.voltage?"},
      {"supply.voltage\n3\n",
       "d.csv:1:1: supply.voltage names no unit; expected a heading such as \"supply.voltage [V]\""},
      {"supply.voltage [A]\n3\n", "d.csv:1:1: supply.voltage: expected a voltage"},
      {"supply.voltage [V\n3\n", "the unit stands in brackets"},
      {"condition\nair\n", "d.csv:1:1: condition is not a number"},
      {"supply.voltage [V],friction.radius [mm]\n3\n", "d.csv:2:1: expected 2 numbers, got 1"},
      {"supply.voltage [V],friction.radius [mm]\n3, x\n", "d.csv:2:4: friction.radius: expected a number, got \"x\""},
      {"supply.voltage [V]\n3\n-3\n", "d.csv:3:1: supply.voltage: must be >= 0 [V], got -3"},
      {"transmission.crank_radius [mm]\n5\n25\n", "d.csv:3:1: transmission."}};
  for (const auto& [text, expected] : cases) {
    write("d.csv", text);
    EXPECT_THAT(complaint("[samples]\nmethod = \"csv\"\nfile = \"d.csv\"\n"), HasSubstr(expected)) << text;
  }
}

}  // namespace
}  // namespace wingbeat

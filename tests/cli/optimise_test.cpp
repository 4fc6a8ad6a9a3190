#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;

const std::string objective = "[objective]\nminimise = \"power_electrical_w\"\nstarts = 3\nscreen = 64\n";
const std::string voltage = "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"3 V\"\nupper = \"8 V\"\n";
const std::string hover = "[[constraint]]\nmetric = \"lift_to_weight\"\nat_least = 1\n";

class Optimise : public Program {
 protected:
  Optimise() { fs::copy_file(springs, path("vehicle.toml")); }

  std::string study(const std::string& text) const {
    std::ofstream(path("study.toml")) << "[study]\nvehicle = \"vehicle.toml\"\n" << text;
    return path("study.toml");
  }

  /// What is said about a study, without the folder; lines of `text` count from 3.
  std::string complaint(const std::string& text) const {
    const Outcome outcome = run({"optimise", study(text)});
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    std::string said = outcome.err;
    const std::string folder = path("");
    for (auto position = said.find(folder); position != std::string::npos; position = said.find(folder))
      said.erase(position, folder.size());
    return said;
  }
};

TEST_F(Optimise, TheVehicleFileIsTheOptimum) {
  const std::string file = study(objective + voltage + hover);
  const Outcome text = run({"optimise", file, "-o", path("best.toml")});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("lift_to_weight >= 1"));
  EXPECT_THAT(text.out, HasSubstr("the active limits leave no freedom"));
  const Json json = run({"optimise", file, "--json"}).json();
  const Json best = run({"run", path("best.toml"), "--json"}).json();
  EXPECT_NEAR(best["power_electrical_w"].get<double>(), json["value"].get<double>(), 1e-5);
  EXPECT_NEAR(best["lift_to_weight"].get<double>(), 1.0, 1e-5);
}

TEST_F(Optimise, TheWayThereAsDataAndFigure) {
  const std::string stiffness =
      "[[parameter]]\nkey = \"spring.stiffness\"\nlower = \"0 N m/rad\"\nupper = \"4e-3 N m/rad\"\n";
  const std::string file = study(objective + voltage + stiffness + hover);
  const Outcome text = run({"optimise", file, "-o", path("way.nc"), "--plot", path("way.svg")});
  ASSERT_EQ(text.status, 0) << text.err;
  const std::string drawn = read(path("way.svg"));
  EXPECT_THAT(drawn, HasSubstr("spring stiffness"));
  EXPECT_THAT(drawn, testing::Not(HasSubstr("spring.stiffness")));
  EXPECT_THAT(drawn, testing::Not(HasSubstr("<title")));
  EXPECT_THAT(drawn, HasSubstr("objective worse by (%)"));
  const wingbeat::NetcdfReader data(path("way.nc"));
  const Json json = run({"optimise", file, "--json"}).json();
  EXPECT_EQ(data.read("power_electrical_w")[0], json["value"].get<double>());
  EXPECT_EQ(data.read("search_ended").size(), 3U);
  EXPECT_NEAR(data.read("constraint_value")[0], 1.0, 1e-5);
  // A walk ends where the objective is 0.1 % worse.
  const std::vector<double> walk = data.read("walk_objective");
  EXPECT_NEAR(walk.front(), 1.001 * json["value"].get<double>(), 1e-5);
  EXPECT_THAT(*data.attribute("study"), HasSubstr("spring.stiffness"));
}

TEST_F(Optimise, NoDesignIsStatusThreeWithTheReason) {
  const std::string low = "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"0.1 V\"\nupper = \"0.5 V\"\n";
  const Outcome outcome = run({"optimise", study(objective + low), "-o", path("best.toml")});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.out, HasSubstr("No design found: none of 64 designs within the bounds flaps: 64 locked"));
  EXPECT_FALSE(fs::exists(path("best.toml")));
  const std::string tall = "[[constraint]]\nmetric = \"lift_to_weight\"\nat_least = 9\n";
  const Outcome heavy = run({"optimise", study(objective + voltage + tall)});
  EXPECT_EQ(heavy.status, 3);
  EXPECT_THAT(heavy.out, HasSubstr("of 64 that flap break it, the best of them reaches"));
}

TEST_F(Optimise, ACatalogueOfMotorsExplainsEveryRow) {
  std::ofstream(path("motors.csv"))
      << "model,gear_ratio,no_load_speed_rad_s,no_load_current_A,resistance_ohm,torque_constant_Nm_per_A,"
         "rotor_inertia_kgm2,inductance_H,friction_torque_Nm,viscous_friction_Nms,mass_kg\n"
         "strong,20,,,9,0.01,1.5e-7,0.029,,3.6e-6,0.001\n"
         "heavy,20,,,9,0.01,1.5e-7,0.029,,3.6e-6,0.03\n"
         "no-load,20,290,0.1,9,0.01,1.5e-7,0.029,,,0.001\n"
         "bare,20,,,9,0.01,,,,3.6e-6,0.001\n";
  const std::string motors = "[motors]\ncatalogue = \"motors.csv\"\ngear_ratio = 1\nmass_without = \"2.34 g\"\n";
  const std::string file = study(motors + objective + voltage + hover);
  const Outcome text = run({"optimise", file, "-o", path("best.toml")});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("incomplete, no rotor inertia, inductance"));
  EXPECT_THAT(text.out, HasSubstr("b = 3.4e-06 N m s/rad from the"));
  EXPECT_THAT(text.out, HasSubstr("Best: no-load"));
  EXPECT_THAT(read(path("best.toml")), HasSubstr("# Motor: no-load"));
  const Json json = run({"optimise", file, "--json", "--threads", "1"}).json();
  ASSERT_EQ(json["motors"].size(), 4U);
  EXPECT_EQ(json["best"], "no-load");
  EXPECT_EQ(json["motors"][1]["result"]["outcome"], "infeasible");
  EXPECT_EQ(json["motors"][3]["refused"], "incomplete, no rotor inertia, inductance");
  // Stated at the output shaft, with its mass, as the vehicle's own, the motor gives the same optimum.
  const Json own = run({"optimise", study(objective + voltage + hover), "--json"}).json();
  EXPECT_NEAR(json["motors"][0]["result"]["value"].get<double>(), own["value"].get<double>(), 1e-6);
}

TEST_F(Optimise, ADriveTrainIsChosenFromLists) {
  std::ofstream(path("gearboxes.csv")) << "model,ratio,mass [g],efficiency,torque_peak [mN m]\n"
                                          "weak,22,0.5,0.9,5\nstrong,22,1,0.81,200\nslow,60,1,0.81,200\n";
  std::ofstream(path("batteries.csv")) << "model,cells,capacity [mAh],internal_resistance [mohm],mass [g]\n"
                                          "small,1,130,230,3.2\nheavy,1,900,50,22\nunknown,1,130,230,\n";
  const std::string lists =
      "[drive_train]\nmass_without = \"11.5 g\"\n[gearboxes]\ncatalogue = \"gearboxes.csv\"\n"
      "[batteries]\ncatalogue = \"batteries.csv\"\n";
  fs::copy_file(data + "/designs/x-wing-battery.toml", path("vehicle.toml"), fs::copy_options::overwrite_existing);
  const std::string held = "hold = { lift_to_weight = 1 }\n",
                    least = "[objective]\nminimise = \"power_electrical_w\"\n";
  // The vehicle's own motor, whose mass is stated for itself.
  const std::string file = study(held + "[set]\nmotor.mass = \"0 g\"\n" + lists + least);
  const Outcome text = run({"optimise", file, "-o", path("best.toml")});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("6 combinations of 3 gearboxes and 2 batteries\n"));
  EXPECT_THAT(text.out, HasSubstr("peak torque of the gearbox"));
  EXPECT_THAT(text.out, HasSubstr("Best: strong, small"));
  EXPECT_THAT(text.out, HasSubstr("unknown: incomplete, no mass"));
  EXPECT_THAT(text.out, HasSubstr("its gearbox: no inertia stated: taken as none"));
  const std::string best = read(path("best.toml"));
  EXPECT_THAT(best, HasSubstr("# Gearbox: strong\n# Battery: small\n"));
  const Json json = run({"optimise", file, "--json"}).json();
  EXPECT_EQ(json["best"], "strong, small");
  EXPECT_EQ(json["screening"]["combinations"], 6);
  EXPECT_EQ(json["drive_trains"][0]["gearbox"], "strong");
  const Json flown = run({"run", path("best.toml"), "--json"}).json();
  EXPECT_NEAR(flown["power_electrical_w"].get<double>(), json["drive_trains"][0]["result"]["value"].get<double>(),
              1e-5);
  EXPECT_NEAR(flown["lift_to_weight"].get<double>(), 1.0, 1e-5);
  // One thread screens as several do.
  Json one = run({"optimise", file, "--json", "--threads", "1"}).json();
  EXPECT_EQ(one["screening"], json["screening"]);

  EXPECT_THAT(complaint(lists + least + "[motors]\ncatalogue = \"" + data + "/motors/motors.csv\"\ngear_ratio = 10\n"),
              HasSubstr("motors.gear_ratio: cannot be combined with [gearboxes], which state theirs"));
  EXPECT_THAT(complaint("[drive_train]\nrefine = 3\n" + least + voltage),
              HasSubstr("needs a list of gearboxes or of batteries"));
  const std::string without = "[gearboxes]\ncatalogue = \"gearboxes.csv\"\n" + least;
  fs::copy_file(springs, path("vehicle.toml"), fs::copy_options::overwrite_existing);
  EXPECT_THAT(complaint(without), HasSubstr("gearboxes: needs a list of motors, or a vehicle with motor.gear_ratio"));
  EXPECT_THAT(complaint("[set]\nmotor.gear_ratio = 1\n" + without), HasSubstr("drive_train.mass_without: missing"));
  EXPECT_THAT(complaint(lists + least), HasSubstr("batteries: needs a vehicle with supply.type = \"battery\""));
}

TEST_F(Optimise, AMotorKeepsItsNominalCurrent) {
  const auto with =
      [&](const char* nominal, const std::string& keys = "") {
        std::ofstream(path("motors.csv"))
            << "Type;R [ohm];k_t [mN m/A];Rotor inertia [kg m2];L [mH];viscous_damping [N m s/rad];Rated current [A];"
               "ratio\n"
            << "own;9;10;1,5e-7;29;3,6e-6;" << nominal << ";20\n";
        const std::string motors = "[motors]\ncatalogue = \"motors.csv\"\ngear_ratio = 1\n" + keys;
        return run({"optimise", study(motors + objective + voltage + hover), "--json"}).json()["motors"][0]["result"];
      };
  const Json free = with("");
  const double current = free["metrics"]["current_rms_a"].get<double>();
  EXPECT_EQ(with("5,0"), free);
  const Json much = with("0,01");
  EXPECT_EQ(much["outcome"], "infeasible");
  EXPECT_THAT(much["reason"].get<std::string>(), HasSubstr("current_rms_a <= 0.01"));
  EXPECT_EQ(with("0,01", "within_nominal_current = false\n"), free);
  EXPECT_GT(current, 0.01);
}

TEST_F(Optimise, TheMotorsMassCountsWhereTheVehicleGivesOne) {
  std::ofstream(path("motors.csv"))
      << "model,gear_ratio,resistance_ohm,torque_constant_Nm_per_A,rotor_inertia_kgm2,inductance_H,"
         "viscous_friction_Nms,mass_kg\n"
         "own,20,9,0.01,1.5e-7,0.029,3.6e-6,0.001\n"
         "unweighed,20,9,0.01,1.5e-7,0.029,3.6e-6,\n";
  const std::string motors = "[motors]\ncatalogue = \"motors.csv\"\ngear_ratio = 1\n";
  const std::string masses = "[set]\nvehicle.mass = \"2.34 g\"\nmotor.mass = \"0.5 g\"\n";
  const Json json = run({"optimise", study(motors + masses + objective + voltage + hover), "--json"}).json();
  const Json own = run({"optimise", study(objective + voltage + hover), "--json"}).json();
  EXPECT_NEAR(json["motors"][0]["result"]["value"].get<double>(), own["value"].get<double>(), 1e-6);
  EXPECT_EQ(json["motors"][1]["refused"], "incomplete, no mass");
  EXPECT_EQ(complaint(motors + "mass_without = \"2 g\"\n" + masses + objective + voltage),
            "wingbeat: study.toml:6:1: motors.mass_without: does not apply where the vehicle gives motor.mass: "
            "vehicle.mass is without the motor already\n");
}

TEST_F(Optimise, DiscreteValuesAreTriedOneByOne) {
  const std::string gears = "[set]\nmotor.gear_ratio = 1\n";
  const std::string ratios = "[[parameter]]\nkey = \"motor.gear_ratio\"\nvalues = [0.7, 1, 1.5]\n";
  const std::string file = study(gears + objective + ratios + voltage + hover);
  const Outcome text = run({"optimise", file, "-o", path("best.toml")});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("Best: motor.gear_ratio "));
  const Json json = run({"optimise", file, "--json"}).json();
  ASSERT_EQ(json["choices"].size(), 3U);
  double least = HUGE_VAL;
  for (const double ratio : {0.7, 1.0, 1.5}) {
    const std::string one = "[set]\nmotor.gear_ratio = " + std::to_string(ratio) + "\n";
    const Json alone = run({"optimise", study(one + objective + voltage + hover), "--json"}).json();
    if (alone["outcome"] == "found") least = std::min(least, alone["value"].get<double>());
  }
  const Json best = run({"run", path("best.toml"), "--json"}).json();
  EXPECT_NEAR(best["power_electrical_w"].get<double>(), least, 1e-5);

  // With a catalogue: each motor with each ratio. Without bounds: each design as it is.
  std::ofstream(path("motors.csv"))
      << "model,gear_ratio,resistance_ohm,torque_constant_Nm_per_A,rotor_inertia_kgm2,inductance_H,"
         "viscous_friction_Nms\n"
         "bare,1,9,0.01,1.5e-7,0.029,3.6e-6\n"
         "lame,1,,0.01,1.5e-7,0.029,3.6e-6\n";
  const std::string motors = "[motors]\ncatalogue = \"motors.csv\"\ngear_ratio = 1\n";
  const Outcome both = run({"optimise", study(motors + objective + ratios + voltage + hover)});
  EXPECT_THAT(both.out, HasSubstr("Best: bare, motor.gear_ratio "));
  EXPECT_EQ(count_of(both.out, "incomplete, no armature resistance"), 1U);
  const Outcome only = run({"optimise", study(motors + objective + ratios)});
  EXPECT_EQ(only.status, 0) << only.err;
  EXPECT_THAT(only.out, HasSubstr("Best: bare, motor.gear_ratio "));
}

const std::string two = "[[objective]]\nmaximise = \"lift_mean_n\"\n[[objective]]\nminimise = \"power_electrical_w\"\n";
const std::string short_search = "[search]\npopulation = 16\ngenerations = 5\nscreen = 64\ndesigns = 3\n";

TEST_F(Optimise, SeveralObjectivesGiveAFront) {
  const std::string limit = "[[constraint]]\nmetric = \"current_peak_a\"\nat_most = \"0.4 A\"\n";
  for (const std::string method : {"nsga2", "moead"}) {
    const std::string file = study(two + short_search + "method = \"" + method + "\"\n" + voltage + limit);
    const Outcome text =
        run({"optimise", file, "-o", path("front.nc"), "--plot", path("front.svg"), "--designs", path("designs")});
    ASSERT_EQ(text.status, 0) << text.err;
    EXPECT_THAT(text.err, testing::StartsWith("wrote " + path("front.nc") + "\nwrote " + path("front.svg") +
                                              "\nwrote " + path("designs") + "/"));
    EXPECT_EQ(count_of(text.err, "\n"), count_of(text.err, "wrote "));
    EXPECT_THAT(text.out, HasSubstr("hypervolume "));
    EXPECT_THAT(text.out, HasSubstr("knee"));
    EXPECT_THAT(read(path("front.svg")), HasSubstr("mean electrical input power (W)"));
    const Json json = run({"optimise", file, "--json"}).json();
    EXPECT_EQ(json, run({"optimise", file, "--json", "--threads", "1"}).json());
    EXPECT_EQ(json["evaluations"], 64 + 16 * 5);
    EXPECT_EQ(json["hypervolume_history"].size(), 6U);
    // Every vehicle written does what the front says.
    ASSERT_EQ(json["picks"].size(), 6U);
    for (const auto& [name, place] : json["picks"].items()) {
      const Json again = run({"run", path("designs/" + name + ".toml"), "--json"}).json();
      const Json& metrics = json["front"][place.get<std::size_t>()]["metrics"];
      for (const char* key : {"lift_mean_n", "power_electrical_w", "current_peak_a", "frequency_hz"}) {
        EXPECT_NEAR(again[key].get<double>(), metrics[key].get<double>(), 1e-6 * metrics[key].get<double>()) << key;
      }
      EXPECT_LE(again["current_peak_a"].get<double>(), 0.4);
    }
  }
}

TEST_F(Optimise, ThreeObjectivesAndMotors) {
  std::ofstream(path("motors.csv"))
      << "model,gear_ratio,resistance_ohm,torque_constant_Nm_per_A,rotor_inertia_kgm2,inductance_H,"
         "viscous_friction_Nms\n"
         "bare,1,9,0.01,1.5e-7,0.029,3.6e-6\nbetter,1,7,0.01,1.5e-7,0.029,3.6e-6\nlame,1,,0.01,1.5e-7,0.029,3.6e-6\n";
  const std::string file = study("[motors]\ncatalogue = \"motors.csv\"\ngear_ratio = 1\n" + two +
                                 "[[objective]]\nminimise = \"rod_force_peak_n\"\n" + short_search + voltage +
                                 "[[parameter]]\nkey = \"motor.gear_ratio\"\nvalues = [0.8, 1, 1.3]\n");
  const Outcome text = run({"optimise", file, "--plot", path("front.svg"), "-o", path("front.nc")});
  ASSERT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("motor of knee: "));
  EXPECT_THAT(text.out, HasSubstr("incomplete, no armature resistance"));
  EXPECT_EQ(count_of(read(path("front.svg")), "peak magnitude of the rod force"), 2U);
  const Json json = run({"optimise", file, "--json"}).json();
  EXPECT_EQ(json["motors"].size(), 3U);
  EXPECT_EQ(json["motors"][0]["solved"].get<int>() + json["motors"][1]["solved"].get<int>(), 64 + 16 * 5);
}

TEST_F(Optimise, AReferenceThatNothingBeatsIsSaid) {
  const std::string strict =
      "[[objective]]\nmaximise = \"lift_mean_n\"\nreference = \"90 mN\"\n"
      "[[objective]]\nminimise = \"power_electrical_w\"\nreference = \"1 mW\"\n";
  const Outcome o = run({"optimise", study(strict + short_search + voltage)});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("no design is better than the reference in every objective"));
  EXPECT_THAT(o.out, testing::Not(HasSubstr("nan")));
}

TEST_F(Optimise, AFrontThatIsNotThereIsStatusThree) {
  const std::string low = "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"0.1 V\"\nupper = \"0.5 V\"\n";
  const Outcome outcome = run({"optimise", study(two + short_search + low), "-o", path("front.nc")});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.out, HasSubstr("No design found: none of 64 designs within the bounds flaps: 64 locked"));
  EXPECT_FALSE(fs::exists(path("front.nc")));
}

TEST_F(Optimise, BadFrontsAreRefusedWithTheirPlace) {
  EXPECT_EQ(complaint("[[objective]]\nminimise = \"power_electrical_w\"\n" + voltage),
            "wingbeat: study.toml:3:1: objective: expected one section [objective], or two or three sections "
            "[[objective]]\n");
  EXPECT_EQ(complaint(two + "[[objective]]\nmaximise = \"lift_mean_n\"\n" + voltage),
            "wingbeat: study.toml:8:1: objective.maximise: is an objective already\n");
  EXPECT_EQ(
      complaint(objective + "[search]\nseed = 2\n" + voltage),
      "wingbeat: study.toml:7:2: search: belongs to several [[objective]] sections; starts, screen and seed of one "
      "stand in [objective]\n");
  EXPECT_EQ(complaint(two + "[search]\npopulation = 30\n" + voltage),
            "wingbeat: study.toml:8:1: search.population: must be a multiple of 4\n");
  EXPECT_EQ(complaint(two + "[search]\npopulation = 64\nscreen = 32\n" + voltage),
            "wingbeat: study.toml:9:1: search.screen: must be at least the population, 64\n");
  EXPECT_EQ(complaint(two + "[search]\nmethod = \"spea2\"\n" + voltage),
            "wingbeat: study.toml:8:1: search.method: expected \"nsga2\" or \"moead\", got \"spea2\"\n");
  EXPECT_EQ(complaint(two + "reference = \"4 V\"\n" + voltage),
            "wingbeat: study.toml:7:1: objective.reference: expected a quantity in W, got \"4 V\"\n");
  EXPECT_EQ(complaint(two + "[[parameter]]\nkey = \"supply.voltage\"\nvalues = [\"3 V\"]\n"),
            "wingbeat: study.toml:9:1: parameter.values: expected an array of at least two values, got an array\n");
  EXPECT_EQ(complaint(two + "[[parameter]]\nkey = \"supply.voltage\"\nvalues = [\"3 V\", 3]\n"),
            "wingbeat: study.toml:9:18: parameter.values: 3 is given twice\n");
  EXPECT_EQ(complaint(two + "[[parameter]]\nkey = \"motor.inertia\"\nvalues = [0, 1]\n"),
            "wingbeat: study.toml:9:11: parameter.values: motor.inertia: must be > 0 [kg m2], got 0\n");
  EXPECT_EQ(complaint(two + voltage.substr(0, voltage.size() - 1) + "\nvalues = [1, 2]\n"),
            "wingbeat: study.toml:9:1: parameter.lower: cannot be combined with parameter.values\n");
  const std::string file = study(two + short_search + voltage);
  EXPECT_EQ(run({"optimise", file, "-o", path("best.toml")}).status, 2);
  EXPECT_EQ(run({"optimise", file, "--plot", path("front.jpg")}).status, 2);
  EXPECT_EQ(run({"optimise", study(objective + voltage), "--designs", path("designs")}).status, 2);
}

TEST_F(Optimise, BadStudiesAreRefusedWithTheirPlace) {
  EXPECT_EQ(complaint(voltage),
            "wingbeat: study.toml:1:1: objective: missing; expected a section [objective] with minimise or maximise\n");
  EXPECT_EQ(complaint("[objective]\n" + voltage),
            "wingbeat: study.toml:3:2: objective: give one of minimise and maximise\n");
  EXPECT_EQ(complaint("[objective]\nminimise = \"power\"\n" + voltage).substr(0, 67),
            "wingbeat: study.toml:4:1: objective.minimise: \"power\" is no metric;");
  EXPECT_EQ(complaint("[objective]\nminimise = \"floquet_multiplier_max\"\n" + voltage),
            "wingbeat: study.toml:4:1: objective.minimise: floquet_multiplier_max has no derivative\n");
  EXPECT_EQ(complaint(objective),
            "wingbeat: study.toml:1:1: parameter: missing; expected [[parameter]] sections with key, lower and "
            "upper\n");
  EXPECT_EQ(complaint(objective + "[[parameter]]\nkey = \"supply.voltage\"\nlower = \"3 V\"\nupper = \"2 V\"\n"),
            "wingbeat: study.toml:10:1: parameter.upper: must exceed parameter.lower\n");
  EXPECT_EQ(complaint(objective + "[[parameter]]\nkey = \"motor.inertia\"\nlower = 0\nupper = 1\n"),
            "wingbeat: study.toml:9:1: parameter.lower: motor.inertia: must be > 0 [kg m2], got 0\n");
  EXPECT_EQ(complaint(objective + voltage + "[[constraint]]\nmetric = \"lift_to_weight\"\n"),
            "wingbeat: study.toml:11:1: constraint: give at_least, at_most or both\n");
  EXPECT_EQ(complaint(objective + voltage + "[[constraint]]\nmetric = \"current_peak_a\"\nat_most = \"1 V\"\n"),
            "wingbeat: study.toml:13:1: constraint.at_most: expected a current such as \"0.2 A\", got \"1 V\"\n");
  EXPECT_EQ(complaint(objective + "[[parameter]]\nkey = \"transmission.stroke_amplitude\"\nlower = 0.1\nupper = 1\n"),
            "wingbeat: study.toml:8:1: parameter.key: transmission.stroke_amplitude is not in the vehicle; give it in "
            "[set] first\n");
  EXPECT_EQ(complaint("[motors]\ncatalogue = \"none.csv\"\ngear_ratio = 2\n" + objective + voltage),
            "wingbeat: study.toml:4:1: motors.catalogue: there is no file none.csv\n");
}

}  // namespace

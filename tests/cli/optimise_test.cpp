#include <gmock/gmock.h>

#include <fstream>

#include "program.hpp"

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
    for (auto at = said.find(folder); at != std::string::npos; at = said.find(folder)) said.erase(at, folder.size());
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
  // The same motor at the output shaft and the same mass as the vehicle's own: the same optimum.
  const Json own = run({"optimise", study(objective + voltage + hover), "--json"}).json();
  EXPECT_NEAR(json["motors"][0]["result"]["value"].get<double>(), own["value"].get<double>(), 1e-6);
}

TEST_F(Optimise, BadStudiesAreRefusedWithTheirPlace) {
  EXPECT_EQ(complaint(""),
            "wingbeat: study.toml:1:1: objective: missing; expected a section [objective] with minimise or maximise\n");
  EXPECT_EQ(complaint("[objective]\n"), "wingbeat: study.toml:3:2: objective: give one of minimise and maximise\n");
  EXPECT_EQ(complaint("[objective]\nminimise = \"power\"\n").substr(0, 67),
            "wingbeat: study.toml:4:1: objective.minimise: \"power\" is no metric;");
  EXPECT_EQ(complaint("[objective]\nminimise = \"floquet_multiplier_max\"\n"),
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

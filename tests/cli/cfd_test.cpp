// The loop through CFD: the motion goes out, loads come in, and what was put into them is found.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>

#include "program.hpp"

namespace {

using namespace cli;
using testing::HasSubstr, testing::Not;

class Cfd : public Program {
 protected:
  const std::string hinged = data + "/designs/pitch-hinge-crank.toml";
};

TEST_F(Cfd, MotionOutAndTheModelsOwnLoadsBack) {
  const Outcome out = run({"export-kinematics", hinged, "--frequency", "22 Hz", "-o", path("wings.csv"), "--json"});
  ASSERT_EQ(out.status, 0) << out.err;
  const Json written = out.json();
  EXPECT_NEAR(written["frequency_hz"].get<double>(), 22.0, 1e-3);
  EXPECT_EQ(written["rows"], 361);
  EXPECT_TRUE(written["stroke_series"].is_null());
  const std::string csv = read(path("wings.csv"));
  EXPECT_THAT(csv, HasSubstr("time_s,phase_rad,stroke_angle_rad,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 362);

  // Loads of the model, at its own motion and at that of the file as series.
  const auto made = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"export-kinematics", hinged, "--frequency", "22 Hz",
                                          "--loads",           "-o",   path(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ASSERT_EQ(run(arguments).status, 0);
  };
  made("loads.csv", {"--rows", "201"});
  const Outcome own =
      run({"compare-loads", hinged, path("loads.csv"), "--frequency", "22 Hz", "--own-motion", "--json"});
  ASSERT_EQ(own.status, 0) << own.err;
  const Json comparison = own.json();
  EXPECT_TRUE(comparison["own_motion"].get<bool>());
  ASSERT_EQ(comparison["loads"].size(), 3u);
  for (const Json& load : comparison["loads"]) {
    EXPECT_NEAR(load["mean_ratio"].get<double>(), 1.0, 1e-9);
    EXPECT_NEAR(load["correlation"].get<double>(), 1.0, 1e-12);
    EXPECT_LT(load["rms_difference"].get<double>(), 1e-9);
    EXPECT_THAT(load["meaning"].get<std::string>(), HasSubstr("to rounding"));
  }
  EXPECT_THAT(comparison["columns_not_read"].dump(), HasSubstr("pitch_velocity_rad_per_s"));

  const Outcome motion = run({"compare-loads", hinged, path("loads.csv"), "--json"});
  ASSERT_EQ(motion.status, 0) << motion.err;
  const Json stated = motion.json();
  EXPECT_FALSE(stated["own_motion"].get<bool>());
  EXPECT_NEAR(stated["frequency_hz"].get<double>(), 22.0, 1e-3);
  EXPECT_LT(stated["stroke_series"]["error_max_rad"].get<double>(), 1e-4);
  EXPECT_NEAR(stated["loads"][0]["mean_ratio"].get<double>(), 1.0, 0.01);
  EXPECT_GT(stated["loads"][0]["correlation"].get<double>(), 0.999);
}

TEST_F(Cfd, AFactorOnTheCoefficientsIsFound) {
  ASSERT_EQ(run({"export-kinematics", plain, "--condition", "air", "--loads", "-o", path("loads.csv")}).status, 0);
  // The forces at one motion are proportional to the density; the file has the motion.
  const Outcome text = run({"compare-loads", plain, path("loads.csv"), "--plot", path("loads.svg"), "--set",
                            "aerodynamics.air_density=1.47 kg/m3", "--json"});
  ASSERT_EQ(text.status, 0) << text.err;
  const Json comparison = text.json();
  for (const Json& load : comparison["loads"]) {
    EXPECT_NEAR(load["mean_ratio"].get<double>(), 1.2, load["quantity"] == "lift" ? 1e-3 : 0.2);
    EXPECT_GT(load["variance_in_phase"].get<double>(), 0.9999);
  }
  for (const char* part : {"simulated", "model", "Lift of all wings", "time over the period"}) {
    EXPECT_THAT(read(path("loads.svg")), HasSubstr(part));
  }
  const Outcome shown =
      run({"compare-loads", plain, path("loads.csv"), "--set", "aerodynamics.air_density=1.47 kg/m3"});
  for (const char* part : {"Model over simulated, means", "RMS difference over simulated RMS", "Variance in phase",
                           "of the simulated variation", "stroke moment", "Columns not read", "is 1.2 times"}) {
    EXPECT_THAT(shown.out, HasSubstr(part));
  }
}

TEST_F(Cfd, SeriesForOtherPrograms) {
  const Outcome ini = run({"export-kinematics", plain, "--format", "wabbit", "-o", path("wings.ini"), "--json"});
  ASSERT_EQ(ini.status, 0) << ini.err;
  EXPECT_LT(ini.json()["stroke_series"]["error_max_rad"].get<double>(), 0.0002);
  EXPECT_THAT(read(path("wings.ini")), HasSubstr("\n[kinematics]\n"));
  EXPECT_THAT(read(path("wings.ini")), HasSubstr("\nai_phi="));
  const Outcome two =
      run({"export-kinematics", plain, "--format", "wabbit", "--harmonics", "2", "-o", path("two.ini")});
  EXPECT_THAT(two.out, HasSubstr("2 harmonics, largest error"));

  // The script is Python, whatever the name of the vehicle.
  const Outcome py = run({"export-kinematics", hinged, "--format", "pterasoftware", "-o", path("wings.py"), "--set",
                          "vehicle.name=a \\\"\\\"\\\" name"});
  ASSERT_EQ(py.status, 0) << py.err;
  const std::string script = read(path("wings.py"));
  EXPECT_THAT(script, HasSubstr("has not been run with it"));
  EXPECT_EQ(
      std::system(("python3 -c \"import ast, sys; ast.parse(open(sys.argv[1]).read())\" " + path("wings.py")).c_str()),
      0);
}

TEST_F(Cfd, Refusals) {
  const Outcome outline = run({"export-kinematics", plain, "--format", "pterasoftware", "-o", path("wings.py")});
  EXPECT_EQ(outline.status, 2);
  EXPECT_THAT(outline.err, HasSubstr("wing.planform.shape: is moments, which give no outline"));
  EXPECT_EQ(run({"export-kinematics", plain, "--format", "wabbit", "-o", path("wings.csv")}).status, 2);
  EXPECT_THAT(run({"export-kinematics", plain, "-o", path("wings.csv"), "--harmonics", "4"}).err,
              HasSubstr("a csv file has no series"));
  const Outcome still =
      run({"export-kinematics", plain, "--set", "motor.friction_torque=1 N m", "-o", path("wings.csv")});
  EXPECT_EQ(still.status, 3) << still.err;
  EXPECT_FALSE(fs::exists(path("wings.csv")));

  std::ofstream(path("half.csv")) << "phase_deg,lift_mN\n0,1\n90,2\n180,1\n";
  const Outcome half = run({"compare-loads", plain, path("half.csv")});
  EXPECT_EQ(half.status, 2);
  EXPECT_THAT(half.err, HasSubstr("half.csv: phase: the rows leave 0.500 of a cycle out, from 0.500 to 1.000"));
  EXPECT_EQ(std::count(half.err.begin(), half.err.end(), '\n'), 1);
  std::ofstream(path("unit.csv")) << "phase_deg,lift_mm\n0,1\n";
  const Outcome unit = run({"compare-loads", plain, path("unit.csv")});
  EXPECT_EQ(unit.status, 2);
  EXPECT_THAT(unit.err, HasSubstr("unit.csv:1:11: lift: the unit \"mm\" is wrong"));
  EXPECT_EQ(run({"compare-loads", plain, path("none.csv")}).status, 2);
}

}  // namespace

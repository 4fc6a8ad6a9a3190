// Vehicles whose sides differ: run, linearise and the commands of flight take them, no other does.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "program.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;

class TwoSides : public Program {
 protected:
  const std::string trimmed = data + "/designs/sides/purdue-flapper-trimmed.toml";
};

TEST_F(TwoSides, RunReportsTotalsAndBothSides) {
  const Outcome report = run({"run", trimmed});
  EXPECT_EQ(report.status, 0) << report.err;
  for (const char* part : {"left: flapping:", "right: flapping:", "Both sides together", "mean lift / weight",
                           "Where the sides differ", "stroke_amplitude_rad"}) {
    EXPECT_THAT(report.out, HasSubstr(part));
  }
  const Json json = run({"run", trimmed, "--json"}).json();
  EXPECT_EQ(json["status"], "flapping");
  EXPECT_EQ(json["lift_mean_n"].get<double>(),
            json["left"]["lift_mean_n"].get<double>() + json["right"]["lift_mean_n"].get<double>());
  EXPECT_LT(json["left"]["lift_mean_n"].get<double>(), json["right"]["lift_mean_n"].get<double>());
  EXPECT_TRUE(json["stroke_amplitude_rad"].is_null());
  // Overrides hold for both sides.
  const Json slow = run({"run", trimmed, "--json", "--set", "supply.amplitude=8 V"}).json();
  EXPECT_LT(slow["lift_mean_n"].get<double>(), json["lift_mean_n"].get<double>());
}

TEST_F(TwoSides, EqualSidesAreThePlainVehicleToTheBit) {
  const std::string text = read(data + "/designs/purdue-flapper.toml");
  std::ofstream(path("alike.toml"))
      << text + "\n[left]\nmotor.inertia = 7.2e-10\n[right.motor]\ninertia = \"7.2e-10 kg m2\"\n";
  EXPECT_EQ(run({"run", path("alike.toml"), "--json"}).out,
            run({"run", data + "/designs/purdue-flapper.toml", "--set", "motor.inertia=7.2e-10", "--json"}).out);
}

TEST_F(TwoSides, LineariseGivesMapsThatNeedNotVanish) {
  const Json json = run({"linearise", trimmed, "--hinge-offset", "13.95 mm", "--json"}).json();
  ASSERT_EQ(json["static_maps"].size(), 5u);
  const Json& difference = json["static_maps"][1];
  EXPECT_EQ(difference["input"], "differential_voltage");
  EXPECT_GT(std::abs(difference["roll_moment"][5].get<double>()), 1e-5);
  EXPECT_NEAR(difference["lift"][5].get<double>(), json["operating_point"]["lift_mean_n"].get<double>(), 1e-6);
  EXPECT_THAT(run({"linearise", trimmed}).out, HasSubstr("split_cycle_cosine [1]"));
}

TEST_F(TwoSides, FlyByControlsThatDiffer) {
  const std::string text = read(data + "/designs/flight-purdue.toml");
  std::ofstream(path("uneven.toml")) << text + "\n[right]\n\"motor.armature_resistance\" = \"14 ohm\"\n";
  const std::string study = "[study]\nvehicle = \"uneven.toml\"\nduration = \"0.4 s\"\n[controller]\ntype = \"lqr\"\n";
  std::ofstream(path("fly.toml")) << study;
  std::ofstream(path("heavy.toml")) << study + "[set]\nvehicle.mass = \"13 g\"\n";
  const Json trim = run({"trim", path("uneven.toml"), "--json"}).json()["flights"][0];
  EXPECT_GT(std::abs(trim["control_voltage_difference_v"].get<double>()), 0.1);
  const Outcome flown = run({"fly", path("fly.toml"), "-o", path("fly.nc"), "--json"});
  ASSERT_EQ(flown.status, 0) << flown.err;
  const Json flight = flown.json();
  EXPECT_EQ(flight["outcome"], "completed");
  EXPECT_NEAR(flight["power_electrical_w"].get<double>(), trim["power_electrical_w"].get<double>(),
              0.02 * trim["power_electrical_w"].get<double>());
  // [set] of the flight holds for both sides.
  EXPECT_GT(run({"fly", path("heavy.toml"), "--json"}).json()["power_electrical_w"].get<double>(),
            1.02 * flight["power_electrical_w"].get<double>());
  EXPECT_THAT(read(path("fly.nc")), AllOf(HasSubstr("vehicle_left"), HasSubstr("vehicle_right")));
}

TEST_F(TwoSides, OthersRefuseThem) {
  const auto complaint = [&](const std::vector<std::string>& arguments) {
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, 2) << o.out;
    return o.err;
  };
  const char* why = "this takes no vehicle whose sides differ; wingbeat run, linearise, trim, stability and fly do";
  EXPECT_THAT(complaint({"scale", trimmed, "--wing", "1.1"}), HasSubstr(why));
  EXPECT_THAT(complaint({"endurance", trimmed}), HasSubstr(why));
  EXPECT_THAT(complaint({"export-fmu", trimmed, "-o", path("v.fmu")}), HasSubstr("sides differ"));
  std::ofstream(path("sweep.toml")) << "[study]\nvehicle = \"" + trimmed +
                                           "\"\n[[axis]]\nkey = \"supply.amplitude\"\nvalues = [8, 9]\n";
  EXPECT_THAT(complaint({"sweep", path("sweep.toml"), "-o", path("out.nc")}), HasSubstr(why));
  EXPECT_THAT(complaint({"run", trimmed, "--lift-to-weight", "1"}), HasSubstr("neither has a known part"));
  EXPECT_THAT(complaint({"run", trimmed, "--plot", path("cycle.svg")}), HasSubstr("which has two cycles"));
  EXPECT_THAT(complaint({"linearise", trimmed, "-o", path("model.mat")}), HasSubstr("static maps alone"));
}

}  // namespace

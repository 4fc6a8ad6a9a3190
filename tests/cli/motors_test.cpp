// Several motors as users meet them: runs, sweeps, flights, what is refused.
#include <gmock/gmock.h>

#include <cmath>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace cli {
namespace {

using testing::HasSubstr;
using testing::Not;

class Motors : public Program {
 protected:
  static double number(const Json& json, const char* key) { return json.at(key).get<double>(); }
  std::string study(const std::string& sections) const {
    std::ofstream(path("study.toml")) << "[study]\nvehicle = \"" << plain << "\"\n" << sections;
    return path("study.toml");
  }
  /// A vehicle file with this line in its section [vehicle].
  std::string file_with(const std::string& line) const {
    std::string text = read(plain);
    text.insert(text.find("[vehicle]\n") + 10, line + "\n");
    std::ofstream(path("motors.toml")) << text;
    return path("motors.toml");
  }
};

TEST_F(Motors, ARunTellsWhatTheyGiveTogether) {
  const Json one = run({"run", plain, "--json"}).json();
  const Json two = run({"run", file_with("motors = 2"), "--json"}).json();
  for (const char* key : {"current_mean_a", "current_peak_a", "current_rms_a", "power_electrical_w", "power_copper_w",
                          "power_friction_w", "power_motor_reference_w", "lift_mean_n", "lift_to_weight"}) {
    EXPECT_NEAR(number(two, key) / number(one, key), 2.0, 1e-6) << key;
  }
  for (const char* key : {"voltage_v", "frequency_hz", "rod_force_peak_n", "rod_force_mean_n", "stroke_amplitude_rad",
                          "efficiency_system", "angle_of_attack_min_deg"}) {
    EXPECT_NEAR(number(two, key) / number(one, key), 1.0, 1e-6) << key;
  }
  const std::string text = run({"run", file_with("motors = 2")}).out;
  EXPECT_THAT(text, HasSubstr("totals of all motors"));
  EXPECT_THAT(text, HasSubstr("of one rod"));
  EXPECT_THAT(run({"run", plain}).out, Not(HasSubstr("of all of them")));
}

TEST_F(Motors, EachWeighs) {
  const std::vector<std::string> weighed = {"--set", "vehicle.mass=1 g", "--set", "motor.mass=1 g", "--json"};
  std::vector<std::string> arguments = {"run", plain};
  arguments.insert(arguments.end(), weighed.begin(), weighed.end());
  const Json one = run(arguments).json();
  arguments[1] = file_with("motors = 2");
  const Json two = run(arguments).json();
  EXPECT_NEAR(number(two, "lift_to_weight") / number(one, "lift_to_weight"), 2.0 * 2.0 / 3.0, 1e-6);
}

TEST_F(Motors, ASweepOverTheirNumber) {
  const Outcome o =
      run({"sweep", study("[[axis]]\nkey = \"vehicle.motors\"\nvalues = [1, 2, 3]\n"), "-o", path("sweep.nc")});
  ASSERT_EQ(o.status, 0) << o.err;
  const wingbeat::NetcdfReader file(path("sweep.nc"));
  const auto lift = file.read("lift_mean_n"), force = file.read("rod_force_peak_n");
  ASSERT_EQ(lift.size(), 3U);
  for (std::size_t n = 1; n < 3; ++n) {
    EXPECT_NEAR(lift[n] / lift[0], double(n + 1), 1e-5);
    EXPECT_NEAR(force[n] / force[0], 1.0, 1e-5);
  }
}

TEST_F(Motors, EmptyABatterySooner) {
  const std::string battery = data + "/designs/friction2022-battery.toml";
  const Json one = run({"endurance", battery, "--json"}).json();
  const Json two = run({"endurance", battery, "--set", "vehicle.motors=2", "--json"}).json();
  // More than half as long: the common internal resistance leaves each of them less voltage.
  EXPECT_GT(number(two, "endurance_s"), 0.5 * number(one, "endurance_s"));
  EXPECT_LT(number(two, "endurance_s"), 0.6 * number(one, "endurance_s"));
  EXPECT_GT(number(two, "energy_internal_j"), 1.5 * number(one, "energy_internal_j"));
}

TEST_F(Motors, AreAWholeNumberThatNoSearchVaries) {
  const Outcome half = run({"run", file_with("motors = 1.5")});
  EXPECT_EQ(half.status, 2);
  EXPECT_THAT(half.err, HasSubstr("vehicle.motors: must be a whole number >= 1 [1], got 1.5"));
  const Outcome search = run({"optimise", study("[objective]\nmaximise = \"lift_mean_n\"\n[[parameter]]\n"
                                                "key = \"vehicle.motors\"\nlower = 1\nupper = 4\n")});
  EXPECT_EQ(search.status, 2);
  EXPECT_THAT(search.err, HasSubstr("vehicle.motors is a whole number and has no derivative"));
}

}  // namespace
}  // namespace cli

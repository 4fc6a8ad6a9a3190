// Every command on a direct drive, as on any other vehicle.
#include <gmock/gmock.h>

#include <cmath>

#include "program.hpp"
#include "wingbeat/files/netcdf.hpp"

namespace cli {
namespace {

using testing::HasSubstr;

const std::string direct = data + "/designs/direct-drive.toml";

class Direct : public Program {
 protected:
  Direct() { fs::copy_file(direct, path("vehicle.toml")); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
};

const std::string study = "[study]\nvehicle = \"vehicle.toml\"\n";

TEST_F(Direct, RunsByBothMethods) {
  const Outcome orbit = run({"run", direct, "--json"});
  ASSERT_EQ(orbit.status, 0) << orbit.err;
  const Json transient = run({"run", direct, "--json", "--method", "transient"}).json();
  const Json json = orbit.json();
  for (const char* key : {"lift_mean_n", "power_electrical_w", "stroke_amplitude_rad", "current_peak_a"}) {
    EXPECT_NEAR(transient[key].get<double>() / json[key].get<double>(), 1.0, 1e-6) << key;
  }
  for (const char* key : {"rod_force_peak_n", "rod_force_mean_n", "crank_speed_min_rad_per_s",
                          "crank_speed_max_rad_per_s", "power_motor_reference_w"}) {
    EXPECT_TRUE(json[key].is_null()) << key;
  }
  EXPECT_NEAR(json["frequency_hz"].get<double>(), 22.0, 1e-12);
  const Json at_20 = run({"run", direct, "--json", "--frequency", "20 Hz"}).json();
  EXPECT_NEAR(at_20["frequency_hz"].get<double>(), 20.0, 1e-12);
  EXPECT_EQ(run({"run", direct, "--json", "--set", "friction.type=constant", "--set", "friction.torque=1 N m"}).status,
            3);
}

TEST_F(Direct, WaveformsLeaveTheRodForceOut) {
  const Outcome o =
      run({"run", direct, "--waveforms", path("w.csv"), "--plot", path("w.svg"), "--plot-power", path("p.svg")});
  ASSERT_EQ(o.status, 0) << o.err;
  std::istringstream lines(read(path("w.csv")));
  std::string header, row;
  std::getline(lines, header);
  EXPECT_THAT(header, HasSubstr("rod_force_n"));
  std::getline(lines, row);
  EXPECT_THAT(row, HasSubstr(",,"));
  EXPECT_THAT(read(path("w.svg")), HasSubstr("current (mA)"));
}

TEST_F(Direct, SweepsTypeVoltageAndFrequency) {
  const std::string s = file("s.toml", study +
                                           "[[axis]]\nkey = \"supply.amplitude\"\nvalues = [\"2 V\", \"3 V\"]\n"
                                           "[[axis]]\nkey = \"frequency\"\nvalues = [\"20 Hz\", \"22 Hz\"]\n");
  const Outcome o = run({"sweep", s, "-o", path("s.nc")});
  ASSERT_EQ(o.status, 0) << o.err;
  const wingbeat::NetcdfReader sweep(path("s.nc"));
  const auto lift = sweep.read("lift_mean_n"), frequency = sweep.read("frequency_hz");
  const Json json = run({"run", direct, "--json"}).json();
  EXPECT_NEAR(lift.at(3) / json["lift_mean_n"].get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(frequency.at(2), 20.0, 1e-12);
  EXPECT_THAT(sweep.read("recomputed"), testing::Each(0));
}

TEST_F(Direct, OptimisesAtAHeldFrequency) {
  const std::string s = file("o.toml",
                             "[study]\nvehicle = \"vehicle.toml\"\nhold = { frequency = \"22 Hz\" }\n"
                             "[objective]\nmaximise = \"lift_mean_n\"\nstarts = 3\n"
                             "[[parameter]]\nkey = \"spring.resonance\"\nlower = \"15 Hz\"\nupper = \"30 Hz\"\n");
  const Outcome o = run({"optimise", s, "--json"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("spring.resonance"));
}

TEST_F(Direct, ToleranceOfAHeldVoltage) {
  const std::string s =
      file("t.toml",
           "[study]\nvehicle = \"vehicle.toml\"\nhold = { voltage = \"4 V\" }\n[samples]\ncount = 32\n"
           "[[parameter]]\nkey = \"spring.resonance\"\ndistribution = \"normal\"\n"
           "deviation = \"0.5 Hz\"\n");
  const Outcome o = run({"tolerance", s, "--json"});
  ASSERT_EQ(o.status, 0) << o.err;
  const Json json = o.json();
  const double mean = json["outputs"]["lift_mean_n"]["mean"].get<double>();
  const Json result = run({"run", direct, "--json", "--set", "supply.amplitude=4 V"}).json();
  EXPECT_NEAR(mean / result["lift_mean_n"].get<double>(), 1.0, 0.1);
}

TEST_F(Direct, FitReturnsWhatTheLogWasMadeWith) {
  std::string log = "voltage_V,current_peak_A,power_electrical_W\n";
  for (const char* v : {"1", "2", "3", "4", "5"}) {
    const Json j = run({"run", direct, "--json", "--set", std::string("supply.amplitude=") + v}).json();
    char row[100];
    std::snprintf(row, sizeof row, "%s,%.12g,%.12g\n", v, j["current_peak_a"].get<double>(),
                  j["power_electrical_w"].get<double>());
    log += row;
  }
  file("log.csv", log);
  const std::string bench =
      file("bench.toml",
           "[bench]\nvehicle = \"vehicle.toml\"\n[[parameter]]\nkey = \"motor.viscous_damping\"\n"
           "lower = 0\nupper = 2e-5\nstart = 8e-6\n[deviation]\ndefault = { relative = 0.01 }\n"
           "[[log]]\nfile = \"log.csv\"\ncondition = \"air\"\nsprings = true\ngiven = \"voltage\"\n");
  const Outcome o = run({"fit", bench, "--json", "--no-profiles"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_NEAR(o.json()["parameters"][0]["value"].get<double>() / 3.6e-6, 1.0, 1e-3);
}

}  // namespace
}  // namespace cli

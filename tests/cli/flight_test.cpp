// Trim and stability as a user runs them.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "program.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;

class FlightCommands : public Program {};

TEST_F(FlightCommands, TrimOverTheSpeedWithItsFigure) {
  const Outcome out =
      run({"trim", "flight-x-wing-battery", "--to", "0.6 m/s", "--points", "3", "--json", "--plot", path("trim.svg")});
  ASSERT_EQ(out.status, 0) << out.err;
  const Json flights = out.json()["flights"];
  ASSERT_EQ(flights.size(), 3u);
  for (const Json& flight : flights) {
    EXPECT_EQ(flight["status"], "trimmed");
    EXPECT_NEAR(flight["range_m"].get<double>(),
                flight["speed_m_per_s"].get<double>() * flight["endurance_s"].get<double>(), 1e-9);
  }
  EXPECT_LT(flights[2]["pitch_rad"].get<double>(), flights[0]["pitch_rad"].get<double>() - 0.1);
  EXPECT_THAT(read(path("trim.svg")), HasSubstr("Range by the battery"));
}

TEST_F(FlightCommands, StabilityHasBothWays) {
  const Outcome out = run({"stability", "flight-x-wing", "--json", "--plot", path("modes.svg")});
  ASSERT_EQ(out.status, 0) << out.err;
  const Json result = out.json();
  EXPECT_EQ(result["A"].size(), 8u);
  EXPECT_EQ(result["B"][0].size(), result["controls"].size());
  EXPECT_TRUE(result["periodic"].get<bool>());
  const Json& first = result["modes"][0];
  EXPECT_GT(first["averaged_real_per_s"].get<double>(), 0.0);
  EXPECT_LT(first["apart"].get<double>(), 0.05);
  EXPECT_EQ(result["W"].size(), 8u);
  EXPECT_EQ(result["W"][0].size(), 3u);
  EXPECT_THAT(read(path("modes.svg")), HasSubstr("Longitudinal"));
}

TEST_F(FlightCommands, ToleranceOfHover) {
  std::string study = read(data + "/studies/tolerance-flight.toml");
  study.replace(study.find("count = 64"), 10, "count = 4");
  study.replace(study.find("../designs"), 10, data + "/designs");
  std::ofstream(path("few.toml")) << study;
  const Outcome out = run({"tolerance", path("few.toml"), "--flight", "--json"});
  ASSERT_EQ(out.status, 0) << out.err;
  const Json result = out.json();
  EXPECT_EQ(result["samples"], 4);
  EXPECT_EQ(result["flies"]["share"], 1.0);
  const Json trim = run({"trim", "flight-friction2022", "--json"}).json()["flights"][0];
  EXPECT_NEAR(result["flight"]["voltage_v"]["centre"].get<double>(), trim["control_voltage_v"].get<double>(), 1e-6);
  EXPECT_GT(result["flight"]["longitudinal_growth_per_s"]["deviation"].get<double>(), 0.0);
  EXPECT_THAT(run({"tolerance", path("few.toml"), "--flight"}).out, HasSubstr("a mode grows"));

  std::ofstream(path("held.toml")) << study.insert(study.find("vehicle ="), "hold = { frequency = \"36 Hz\" }\n");
  const Outcome held = run({"tolerance", path("held.toml"), "--flight"});
  EXPECT_EQ(held.status, 2);
  EXPECT_THAT(held.err, HasSubstr("study.hold: trim finds the voltage of each vehicle: leave it out"));
  const Outcome bodiless = run({"tolerance", "sobol-22hz", "--flight"});
  EXPECT_EQ(bodiless.status, 2);
  EXPECT_EQ(run({"tolerance", path("few.toml"), "--flight", "-o", path("a.nc")}).status, 2);
  EXPECT_EQ(run({"tolerance", path("few.toml"), "--speed", "1 m/s"}).status, 2);
  EXPECT_EQ(run({"tolerance", path("few.toml"), "--flight", "--allow-extrapolation"}).status, 2);
}

TEST_F(FlightCommands, RefuseInASentence) {
  const auto refused = [&](std::vector<std::string> arguments, const char* sentence) {
    const Outcome out = run(arguments);
    EXPECT_EQ(out.status, 2) << sentence;
    EXPECT_THAT(out.err, HasSubstr(sentence));
  };
  refused({"trim", "friction2022"}, "body.inertia_pitch: missing: flight needs [body]");
  refused({"trim", "flight-x-wing", "--speed", "1 m/s", "--to", "0.5 m/s"}, "--to: must be faster than --speed");
  refused({"trim", "flight-x-wing", "--plot", path("a.svg")}, "--plot: draws over the speed: give --to");
  refused({"trim", "flight-x-wing", "--to", "1 m/s", "--points", "1"}, "--points: must be a number of speeds");
  refused({"trim", "flight-x-wing", "--speed", "fast"}, "--speed");
  refused({"trim", "flight-x-wing", "--set", "wing.count=3"}, "a body carries two or four wings");
  refused({"trim", "flight-x-wing", "--set", "body.inertia_pitch=\"1 kg m2\""}, "no body has these three moments");
  refused({"stability", "flight-x-wing", "-o", path("model.json")}, "-o");
  refused({"stability", "flight-x-wing", "--set", "aerodynamics.induced_velocity=1"},
          "aerodynamics.induced_velocity: flight is not known");
}

TEST_F(FlightCommands, SayWhatDoesNotFly) {
  const Outcome heavy = run({"trim", "flight-friction2022", "--set", "vehicle.mass=\"30 g\""});
  EXPECT_EQ(heavy.status, 3);
  EXPECT_THAT(heavy.out, HasSubstr("untrimmable"));
  const Outcome modes =
      run({"stability", "flight-friction2022", "--set", "vehicle.mass=\"30 g\"", "-o", path("none.mat")});
  EXPECT_EQ(modes.status, 3);
  EXPECT_THAT(modes.err, HasSubstr("no file was written"));
  EXPECT_FALSE(std::filesystem::exists(path("none.mat")));
}

}  // namespace

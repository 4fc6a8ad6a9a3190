// Trim and stability as a user runs them.
#include <gmock/gmock.h>

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
  EXPECT_THAT(read(path("modes.svg")), HasSubstr("Longitudinal"));
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
  refused({"stability", "flight-x-wing", "--set", "aerodynamics.induced_velocity=1"},
          "aerodynamics.induced_velocity: flight is not known");
}

TEST_F(FlightCommands, SayWhatDoesNotFly) {
  const Outcome heavy = run({"trim", "flight-friction2022", "--set", "vehicle.mass=\"30 g\""});
  EXPECT_EQ(heavy.status, 3);
  EXPECT_THAT(heavy.out, HasSubstr("untrimmable"));
}

}  // namespace

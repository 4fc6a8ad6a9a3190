// Flight files: read, and refused in a sentence.
#include "wingbeat/files/flight_file.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace wingbeat {
namespace {

using testing::HasSubstr;

/// A flight file beside the vehicles that come with the program.
class FlightFiles : public testing::Test {
 protected:
  FlightFile read(const std::string& rest) {
    std::ofstream(file_) << "[study]\nvehicle = \"" WINGBEAT_DATA "/designs/flight-friction2022.toml\"\n" << rest;
    return read_flight_file(file_);
  }
  std::string refused(const std::string& rest) {
    try {
      read(rest);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  void TearDown() override { std::filesystem::remove(file_); }

  std::filesystem::path file_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("flight-") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml");
};

TEST_F(FlightFiles, ShippedFlightsAreRead) {
  const FlightFile hover = read_flight_file(WINGBEAT_DATA "/studies/fly-hover.toml");
  EXPECT_EQ(hover.plan.controller.type, ControllerType::lqr);
  EXPECT_DOUBLE_EQ(hover.plan.sensors.position, 0.002);
  ASSERT_EQ(hover.plan.wind.gusts.size(), 1u);
  EXPECT_DOUBLE_EQ(hover.plan.wind.gusts[0].velocity[0], 0.4);
  const FlightFile square = read_flight_file(WINGBEAT_DATA "/studies/fly-square.toml");
  ASSERT_EQ(square.plan.path.size(), 5u);
  EXPECT_DOUBLE_EQ(square.plan.path[1].position[2], -1.3);
  EXPECT_DOUBLE_EQ(square.plan.actuators.time_constant[std::size_t(FlightControl::mean_stroke_angle)], 0.01);
}

TEST_F(FlightFiles, KeysReachThePlan) {
  const FlightFile file = read(
      "duration = \"3 s\"\n[start]\nfrom = \"rest\"\nheight = \"2 m\"\nroll = \"10 deg\"\n"
      "[controller]\ntype = \"pid\"\n[controller.bandwidths]\nrates = 30\n[controller.gains.yaw]\nintegral = 0.1\n"
      "[wind]\nup = \"0.2 m/s\"\n[limits]\nground = 0\n");
  EXPECT_EQ(file.plan.duration, 3.0);
  EXPECT_EQ(file.plan.start, FlightStart::rest);
  EXPECT_NEAR(file.plan.disturbance.angles[0], 0.17453, 1e-5);
  EXPECT_EQ(file.plan.controller.bandwidths.rates, 30.0);
  EXPECT_EQ(file.plan.controller.gains[std::size_t(FlightAxis::yaw)].integral, 0.1);
  EXPECT_EQ(file.plan.wind.steady[2], -0.2);
  EXPECT_EQ(file.plan.ground, 0.0);
}

TEST_F(FlightFiles, ErrorsNameLineKeyAndWhatIsExpected) {
  EXPECT_THAT(refused("[sensors]\ndelai = \"2 ms\"\n"), AllOf(HasSubstr(":4:"), HasSubstr("delay")));
  EXPECT_THAT(refused("[controller]\ntype = \"pdi\"\n"), AllOf(HasSubstr("controller.type"), HasSubstr("pid")));
  EXPECT_THAT(refused("[sensors]\ndelay = \"2 m\"\n"), HasSubstr("sensors.delay"));
  EXPECT_THAT(refused("[sensors]\ndelay = \"-2 ms\"\n"), AllOf(HasSubstr("sensors.delay"), HasSubstr("between")));
  EXPECT_THAT(refused("[actuators.time_constant]\nbias = \"2 ms\"\n"), HasSubstr("does not have this control"));
  EXPECT_THAT(refused("[controller.gains.yaw]\nintegral = 1\n"), HasSubstr("is for type = \"pid\""));
  EXPECT_THAT(refused("[[gust]]\nstart = 1\n"), HasSubstr("gust.duration"));
  EXPECT_THAT(refused("[[waypoint]]\ntime = 2\n[[waypoint]]\ntime = 1\n"), HasSubstr("later"));
  EXPECT_THAT(refused("[limits]\nground = \"1 m\"\n"), HasSubstr("below the height"));
  EXPECT_THAT(refused("metrics = [\"lift_mean_n\"]\n"), HasSubstr("does not apply to a flight"));
}

}  // namespace
}  // namespace wingbeat

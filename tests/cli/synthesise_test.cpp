// wingbeat synthesise: from a stroke to links, to a vehicle that flaps with them, or to the reason why there are none.
#include <gmock/gmock.h>

#include <cmath>

#include "cli/program.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;
using testing::Not;

class Synthesise : public Program {
 protected:
  Outcome four_bar(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"synthesise", "four-bar"});
    return run(arguments);
  }
};

TEST_F(Synthesise, TheLinksMakeAVehicleWithThatStroke) {
  const std::string file = path("new.toml"), picture = path("links.svg");
  const Outcome o =
      four_bar({"--stroke", "150 deg", "--envelope", "20 mm", "--stroke-ratio", "3", "--clearance", "0.02 mm",
                "--vehicle", data + "/designs/two-wing-four-bar.toml", "-o", file, "--plot", picture, "--json"});
  ASSERT_EQ(o.status, 0) << o.err;
  const Json json = o.json();
  EXPECT_EQ(json["type"], "four-bar");
  EXPECT_NEAR(json["stroke_rad"].get<double>(), 150.0 * M_PI / 180.0, 1e-9);
  EXPECT_NEAR(json["envelope_m"].get<double>(), 0.02, 1e-9);
  EXPECT_GT(json["transmission_angle_min_rad"].get<double>(), 1.0);
  EXPECT_LT(json["clearance"]["stroke_min_rad"].get<double>(), json["stroke_rad"].get<double>());
  EXPECT_EQ(json["stroke_ratios"].size(), 5U);
  EXPECT_THAT(read(picture), HasSubstr("<svg"));
  const std::string text = read(file);
  EXPECT_THAT(text, HasSubstr("# Read in a source: span of the wings 200 mm"));
  const Outcome flown = run({"run", file, "--json"});
  ASSERT_EQ(flown.status, 0) << flown.err;
  EXPECT_NEAR(flown.json()["stroke_amplitude_rad"].get<double>() * 180.0 / M_PI, 75.0, 1e-5);
}

TEST_F(Synthesise, ASliderCrankMayGiveWayToAFourBar) {
  const std::string file = path("new.toml");
  const Outcome o =
      four_bar({"--stroke", "60 deg", "--envelope", "40 mm", "--vehicle", "friction2022", "-o", file, "--force"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("\n[transmission]\ntype = \"four-bar\"\ncrank_radius = \""));
  const Outcome flown = run({"run", file, "--json"});
  ASSERT_EQ(flown.status, 0) << flown.err;
  EXPECT_NEAR(flown.json()["stroke_amplitude_rad"].get<double>() * 180.0 / M_PI, 30.0, 1e-5);
  const Outcome back = run({"synthesise", "slider-crank", "--stroke", "80 deg", "--envelope", "40 mm", "--vehicle",
                            file, "-o", path("slider.toml")});
  ASSERT_EQ(back.status, 0) << back.err;
  EXPECT_NEAR(run({"run", path("slider.toml"), "--json"}).json()["stroke_amplitude_rad"].get<double>() * 180.0 / M_PI,
              40.0, 1e-5);
}

TEST_F(Synthesise, TheSectionAloneIsAFile) {
  const std::string file = path("links.toml");
  ASSERT_EQ(four_bar({"--stroke", "1 rad", "--envelope", "1 in", "-o", file}).status, 0);
  const std::string text = read(file);
  EXPECT_THAT(text, HasSubstr("[transmission]\ntype = \"four-bar\"\n"));
  const Outcome again = four_bar({"--stroke", "1 rad", "--envelope", "1 in", "-o", file});
  EXPECT_EQ(again.status, 2);
  EXPECT_EQ(read(file), text);
}

TEST_F(Synthesise, WhatCannotBeIsOneSentence) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& sentence) {
    const Outcome o = four_bar(arguments);
    EXPECT_EQ(o.status, 2);
    EXPECT_EQ(o.out, "");
    EXPECT_THAT(o.err, HasSubstr(sentence));
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  };
  refused({"--stroke", "160 deg", "--envelope", "20 mm", "--transmission-angle", "40 deg"},
          "no four-bar has a stroke of 160 deg within 20 mm and links of at least 2 mm and a transmission angle of at "
          "least 40 deg; the best one keeps ");
  refused({"--stroke", "200 deg", "--envelope", "20 mm"}, "a stroke ratio of 1.");
  refused({"--stroke", "20 mm", "--envelope", "20 mm"}, "--stroke: expected an angle such as ");
  refused({"--stroke", "-20 deg", "--envelope", "20 mm"}, "--stroke: must be > 0, <= 360 [deg], got -20");
  refused({"--stroke", "20 deg", "--envelope", "0 mm"}, "--envelope: must be > 0 [m], got 0");
  refused({"--stroke", "20 deg", "--envelope", "20 mm", "--shortest", "0 mm"}, "--shortest: must be > 0 m");
  refused({"--stroke", "20 deg", "--envelope", "20 mm", "--clearance", "2 mm"}, "so much play");
  refused({"--stroke", "90 deg", "--envelope", "20 mm", "--vehicle", "friction2022"}, "--vehicle: needs -o");
  refused({"--stroke", "90 deg", "--envelope", "20 mm", "--vehicle", "direct-drive", "-o", path("x.toml")},
          "transmission.type: is direct");
  const Outcome none = run({"synthesise", "tabulated", "--stroke", "1 rad", "--envelope", "20 mm"});
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.err, HasSubstr("must be four-bar or slider-crank, got \"tabulated\""));
  const Outcome ratio =
      run({"synthesise", "slider-crank", "--stroke", "1 rad", "--envelope", "20 mm", "--stroke-ratio", "2"});
  EXPECT_THAT(ratio.err, HasSubstr("--stroke-ratio: of a slider-crank must be 1"));
  EXPECT_FALSE(fs::exists(path("x.toml")));
}

TEST_F(Synthesise, AFileThatStatesTheStrokeOfAFourBarIsLedThere) {
  std::ofstream(path("v.toml")) << read(data + "/designs/two-wing-four-bar.toml");
  const Outcome o = run({"run", path("v.toml"), "--set", "transmission.stroke_amplitude=60 deg"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("wingbeat synthesise four-bar --stroke"));
}

}  // namespace

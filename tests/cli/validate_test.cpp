// wingbeat validate: what there is, every stage of a set, figures, and refusals.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "cli/program.hpp"

namespace {

using namespace cli;
using testing::HasSubstr;
using testing::Not;

class Validate : public Program {};

TEST_F(Validate, ListsWhatThereIsAndWhatIsNotPredicted) {
  const Outcome o = run({"validate"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("gammabot-thrust"));
  EXPECT_THAT(o.out, HasSubstr("Not predicted:\n"));
  EXPECT_THAT(o.out, HasSubstr("ucl-rig-stroke             torque constant"));
  const Json json = run({"validate", "--json"}).json();
  EXPECT_EQ(json["sets"].size(), 24U);
  for (const Json& set : json["sets"]) EXPECT_TRUE(set["stages"].empty());
}

TEST_F(Validate, ComputesASetWithAndWithoutAFit) {
  const std::string picture = path("gammabot.svg");
  const Outcome o = run({"validate", "gammabot-thrust", "--json", "--plot", picture});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(read(picture), HasSubstr("<svg"));
  const Json json = o.json();
  const Json set = json["sets"][0];
  EXPECT_THAT(set["source"].get<std::string>(), HasSubstr("PteraSoftware"));
  EXPECT_EQ(set["points"].size(), 5U);
  // Against sums over strips of a script of its own: translation, with rotational lift, with added mass [mN].
  const double expected[6][5] = {{0.1507, 0.213, 0.252, 0.196, 0.3037},    {0.1378, 0.1972, 0.2346, 0.1842, 0.2887},
                                 {0.1927, 0.2696, 0.3149, 0.2273, 0.3609}, {0.3736, 0.4815, 0.5395, 0.4014, 0.5948},
                                 {0.1435, 0.2064, 0.2461, 0.1938, 0.3056}, {0.3244, 0.4183, 0.4708, 0.3679, 0.5395}};
  for (int stage = 0; stage < 6; ++stage) {
    EXPECT_EQ(set["stages"][stage]["name"], "nothing fitted");
    for (int n = 0; n < 5; ++n) {
      EXPECT_NEAR(set["stages"][stage]["predicted"][n].get<double>(), expected[stage][n], 1e-4) << stage << " " << n;
    }
  }
  const Json fit = set["stages"][6];
  EXPECT_EQ(fit["parameters"][0]["key"], "factor on the force");
  EXPECT_LT(fit["parameters"][0]["lower_95"].get<double>(), fit["parameters"][0]["value"].get<double>());
  // The factor is the least-squares one of the first, third and fifth row.
  double above = 0.0, below = 0.0;
  for (const int n : {0, 2, 4}) {
    const double computed = set["stages"][0]["predicted"][n], measured = set["points"][n]["measured"];
    above += computed * measured;
    below += computed * computed;
  }
  EXPECT_NEAR(fit["parameters"][0]["value"].get<double>(), above / below, 1e-6);
}

TEST_F(Validate, WithNothingFittedIsARunWithTheFilesSettings) {
  const Json set = run({"validate", "purdue-flappy", "--json"}).json()["sets"][0];
  const Json run8 = run({"run", "two-wing-direct-hinge", "--set", "supply.amplitude=8 V", "--set",
                         "motor.friction_torque=2e-5 N m", "--set", "motor.gear_efficiency=0.9", "--json"})
                        .json();
  EXPECT_EQ(set["points"][1]["label"], "8 V");
  EXPECT_FALSE(set["points"][1]["fitted"].get<bool>());
  EXPECT_NEAR(set["stages"][0]["predicted"][1].get<double>(), run8["lift_mean_n"].get<double>(), 1e-6);
  EXPECT_EQ(set["settings"]["motor.gear_efficiency"], "0.9");
  // What is fitted is closer on the rows that the fit sees.
  const auto rms = [&](int stage) { return set["stages"][stage]["misses"][0]["rms"].get<double>(); };
  EXPECT_TRUE(set["stages"][1]["misses"][0]["fitted"].get<bool>());
  EXPECT_LT(rms(1), rms(0));
}

// A controller's lines beside static maps: the signs and factors of the source are those that its file states.
TEST_F(Validate, MapsAreThoseOfLinearise) {
  const Json set = run({"validate", "purdue-maps", "--json"}).json()["sets"][0];
  ASSERT_EQ(set["quantities"].size(), 4U);
  ASSERT_EQ(set["stages"].size(), 1U);
  const Json maps = run({"linearise", "purdue-flapper", "--hinge-offset", "13.95 mm", "--json"}).json()["static_maps"];
  // The slope of the map, at a command that is small enough for it.
  const auto row = [&](std::size_t quantity) {
    for (std::size_t n = 0; n < set["points"].size(); ++n) {
      if (set["points"][n]["quantity"] == quantity) return n;
    }
    return std::size_t(0);
  };
  const auto computed = [&](std::size_t n) { return set["stages"][0]["predicted"][n].get<double>(); };
  const auto slope = [&](std::size_t map, const char* column) { return maps[map]["slope"][column].get<double>(); };
  EXPECT_EQ(set["points"][row(1)]["label"], "0.5 V");
  EXPECT_NEAR(computed(row(1)), 1e3 * 2.0 * 0.5 * slope(1, "roll_moment"), 0.05 * computed(row(1)));
  EXPECT_NEAR(computed(row(2)), 1e3 * 0.5 * slope(2, "pitch_moment"), 0.05 * computed(row(2)));
  EXPECT_NEAR(computed(row(3)), 1e3 * 2.0 * 0.05 * slope(4, "yaw_moment"), 0.05 * computed(row(3)));
  for (std::size_t quantity = 0; quantity < 4; ++quantity) EXPECT_GT(computed(row(quantity)), 0.0);
  const Json at8 = run({"run", "purdue-flapper", "--set", "supply.amplitude=8 V", "--json"}).json();
  EXPECT_NEAR(computed(1), at8["lift_mean_n"].get<double>(), 1e-6);
  ASSERT_EQ(run({"validate", "purdue-maps", "--plot", path("maps.svg")}).status, 0);
  EXPECT_THAT(read(path("maps.svg")), HasSubstr("yaw moment"));
}

TEST_F(Validate, PrintsEveryRowWithinAPage) {
  const Outcome o = run({"validate", "battery-eis-0", "ucl-rig-stroke"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("licence"));
  EXPECT_THAT(o.out, HasSubstr("  resistance = "));
  EXPECT_THAT(o.out, HasSubstr("rms difference, predicted rows"));
  EXPECT_THAT(o.out, HasSubstr("not predicted"));
  EXPECT_THAT(o.out, HasSubstr("\nPredicted rows, rms difference / size, %"));
  std::size_t longest = 0, begin = 0;
  while (begin < o.out.size()) {
    const std::size_t end = o.out.find('\n', begin);
    longest = std::max(longest, end - begin);
    begin = end + 1;
  }
  EXPECT_LE(longest, 90U);
}

TEST_F(Validate, RefusesWhatItCannotDo) {
  const Outcome unknown = run({"validate", "gammabot"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean gammabot-thrust?"));
  EXPECT_EQ(run({"validate", "battery-eis-0", "--all"}).status, 2);
  const Outcome two = run({"validate", "battery-eis-0", "gammabot-thrust", "--plot", path("x.svg")});
  EXPECT_EQ(two.status, 2);
  EXPECT_THAT(two.err, HasSubstr("belongs to one measured set"));
  const Outcome nothing = run({"validate", "ucl-rig-stroke", "--plot", path("x.svg")});
  EXPECT_NE(nothing.status, 0);
  EXPECT_FALSE(fs::exists(path("x.svg")));
}

}  // namespace

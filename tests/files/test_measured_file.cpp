// Measured files: what ships reads and is split by the stated rule, and what cannot be used is refused at its place.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>

#include <unistd.h>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/measured_file.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string folder = std::string(WINGBEAT_DATA) + "/measured";

ValidationSet shipped(const std::string& name) { return read_measured(folder + "/" + name + ".toml"); }

TEST(MeasuredFile, EverySetThatShipsHasItsSourceAndIsPredictedOrNot) {
  int sets = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const ValidationSet set = read_measured(entry.path());
    SCOPED_TRACE(set.name);
    ++sets;
    EXPECT_THAT(set.source, testing::AnyOf(HasSubstr("github "), HasSubstr("J. Exp. Biol. ")));
    EXPECT_FALSE(set.licence.empty());
    EXPECT_FALSE(set.uncertainty.empty());
    EXPECT_EQ(set.points.empty(), !set.reason.empty());
    EXPECT_EQ(std::holds_alternative<std::monostate>(set.problem), set.model == ValidationModel::none);
    for (const ValidationPoint& p : set.points) {
      EXPECT_TRUE(std::isfinite(p.measured));
      EXPECT_LT(p.quantity, set.quantities.size());
    }
  }
  EXPECT_EQ(sets, 24);
}

TEST(MeasuredFile, NumbersAreThoseOfTheSource) {
  const ValidationSet set = shipped("robobee-sdab1");
  EXPECT_EQ(set.rows, 14);
  ASSERT_EQ(set.points.size(), 14U);
  // Sorted by voltage and frequency; rows with pitch and without it are one table.
  EXPECT_EQ(set.points.front().label, "180 V, 100 Hz");
  EXPECT_EQ(set.points.front().measured, 56.3);
  EXPECT_EQ(set.points[6].label, "180 V, 170 Hz");
  EXPECT_EQ(set.points[6].measured, 85.81);
  const auto& problem = std::get<BenchProblem>(set.problem);
  EXPECT_EQ(problem.voltages.front(), 90.0);
  EXPECT_NEAR(*problem.design.spring.stiffness, 30e-6, 1e-15);
}

TEST(MeasuredFile, EverySecondOperatingPointIsFitted) {
  // 180 V and 181 V: the first alone.
  for (const ValidationPoint& p : shipped("robobee-sdab1").points) EXPECT_EQ(p.fitted, p.label.starts_with("180"));
  // L 150, L 170, L 180, R 150, R 170.
  const ValidationSet gammabot = shipped("gammabot-thrust");
  std::string fitted;
  for (const ValidationPoint& p : gammabot.points) fitted += p.fitted ? 'f' : 'p';
  EXPECT_EQ(fitted, "fpfpf");
  // A line is measured where the file asks for it.
  const ValidationSet purdue = shipped("purdue-flappy");
  ASSERT_EQ(purdue.points.size(), 6U);
  EXPECT_NEAR(purdue.points[1].measured, 0.0165 * (8.0 - 2.5115), 1e-15);
  EXPECT_TRUE(purdue.points[0].fitted);
  EXPECT_FALSE(purdue.points[1].fitted);
  // Of one operating point the amplitude.
  const ValidationSet video = shipped("robobee-bee1-video-left");
  ASSERT_EQ(video.points.size(), 2U);
  EXPECT_TRUE(video.points[0].fitted);
  EXPECT_FALSE(video.points[1].fitted);
}

TEST(MeasuredFile, MapsHaveTheInputsAndSignsOfTheModel) {
  const ValidationSet set = shipped("purdue-maps");
  const auto& problem = std::get<MapsProblem>(set.problem);
  ASSERT_EQ(problem.maps.size(), 4U);
  ASSERT_EQ(problem.inputs.size(), set.points.size());
  EXPECT_EQ(problem.hinge_offset, 13.95e-3);
  EXPECT_NEAR(set.points[1].measured, 0.0165 * (8.0 - 2.5115), 1e-15);
  const std::size_t yaw = set.points.size() - 1;
  EXPECT_EQ(set.points[yaw].label, "0.15");
  EXPECT_NEAR(set.points[yaw].measured, 1.8401 * 0.15, 1e-12);
  EXPECT_EQ(problem.inputs[yaw], -2.0 * 0.15);
  EXPECT_EQ(problem.maps[3].per_value, -1e-3);
}

TEST(MeasuredFile, TheLineOfADelFlyHasItsExponentAtHover) {
  const ValidationSet set = shipped("delfly-nimble");
  // Thrust of one pair 0.0114 f - 0.0449 carries half of 29.4 g at 16.59 Hz.
  const double f = (0.0294 * 9.80665 / 2.0 + 0.0449) / 0.0114;
  EXPECT_NEAR(f, 16.59, 0.01);
  EXPECT_NEAR(set.points.front().measured, 0.0114 * f / (0.0114 * f - 0.0449), 1e-12);
}

class RefusedFile : public testing::Test {
 protected:
  RefusedFile() : folder_(fs::temp_directory_path() / ("measured" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~RefusedFile() override { fs::remove_all(folder_); }
  /// What is said of the text of a set that ships, one part replaced.
  std::string refusal(const std::string& name, const std::string& part, const std::string& other) const {
    std::string text = read_text_file(folder + "/" + name + ".toml");
    const auto found = text.find(part);
    if (found == std::string::npos) return "no " + part;
    text.replace(found, part.size(), other);
    const auto vehicle = text.find("\"../designs/");
    if (vehicle != std::string::npos) text.replace(vehicle, 3, std::string("\"") + WINGBEAT_DATA);
    const fs::path file = folder_ / "set.toml";
    std::ofstream(file) << text;
    try {
      read_measured(file);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(file.string().size());
    }
    return "read";
  }

  fs::path folder_;
};

TEST_F(RefusedFile, SaysWhereAndWhat) {
  EXPECT_EQ(refusal("robobee-sdab1", "robobee3d", "robobee3d"), "read");
  EXPECT_THAT(refusal("robobee-sdab1", "licence", "license"),
              HasSubstr(":4:1: measured.license: unknown key; did you mean licence?"));
  EXPECT_THAT(refusal("battery-eis-0", "[1, 17.175, -3.065]", "[1, 17.175]"),
              HasSubstr("data.rows[1]: has 2 cells, but there are 3 columns"));
  EXPECT_THAT(refusal("battery-eis-0", "17.175", "true"),
              HasSubstr("data.rows[1]: expected a number, nan where there is none, or a text"));
  EXPECT_THAT(refusal("battery-eis-0", "17.175", "\"much\""),
              HasSubstr("validation.column: row 1 has the text \"much\" in the column \"magnitude\""));
  EXPECT_THAT(refusal("battery-eis-0", "column = \"magnitude\"", "column = \"size\""),
              HasSubstr("validation.column: there is no column \"size\"; the columns are Hz, magnitude, phase_deg"));
  EXPECT_THAT(refusal("battery-eis-0", "[1, 17", "[nan, 17"),
              HasSubstr("validation.operating_point: row 1 has no number in the column \"Hz\""));
  EXPECT_THAT(refusal("purdue-maps", "gives = \"yaw_moment\"", "gives = \"jaw_moment\""),
              HasSubstr("gives: expected one of lift, roll_moment, pitch_moment, yaw_moment"));
  EXPECT_THAT(refusal("purdue-maps", "slope = \"K_Tz_mNm_per_split\"", "slope = \"K_Tw\""), HasSubstr("slope: "));
  EXPECT_THAT(refusal("purdue-maps", "at = [0.05", "at = [-0.05"), HasSubstr("at: expected a list of inputs > 0"));
  EXPECT_THAT(refusal("purdue-maps", "value_per_value = -1", "value_per_value = 0"),
              HasSubstr("value_per_value: must not be 0"));
  EXPECT_THAT(refusal("purdue-maps", "../designs/purdue-flapper.toml", "../designs/friction2022.toml"),
              HasSubstr("input: needs a vehicle of two motors on direct drives"));
  EXPECT_THAT(refusal("battery-eis-0", "\"resistance\"", "\"battery\""),
              HasSubstr("validation.model: expected one of"));
  EXPECT_THAT(refusal("robobee-sdab1", "one = \"piezo.force_per_volt\"", "one = \"piezo.mass\""),
              HasSubstr("validation.one: \"piezo.mass\" is the key of no [[validation.parameter]]"));
  EXPECT_THAT(refusal("robobee-sdab1", "lower = \"1e-6 N m/rad\"", "lower = \"1e-4 N m/rad\""),
              HasSubstr("lower: the vehicle's own value, 3e-05 N m/rad, must lie within lower and upper"));
  EXPECT_THAT(refusal("robobee-sdab1", "\"spring.stiffness\" = \"30e-6 N m/rad\"", "\"spring.stiffness\" = \"30 kg\""),
              HasSubstr("validation.settings: --set"));
  EXPECT_THAT(refusal("robobee-sdab1", "metric = \"stroke_amplitude_rad\"", "metric = \"stroke\""),
              HasSubstr("validation.metric: no metric is named \"stroke\""));
  EXPECT_THAT(refusal("robobee-sdab1", "unit = \"deg\"", "unit = \"mm\""), HasSubstr("validation.unit: "));
  EXPECT_THAT(refusal("gammabot-thrust", "[0.5, 1.2005]", "[0, 1.2005]"), HasSubstr("tables.planform_mm: "));
  EXPECT_THAT(refusal("gammabot-thrust", "hub_offset_mm", "hub"),
              HasSubstr("known: the model prescribed needs known.hub_offset_mm"));
  EXPECT_THAT(refusal("purdue-flappy", "slope = \"map_slope_N_per_V\"", "slope = \"steepness\""),
              HasSubstr("validation.line.slope: no row begins with \"steepness\""));
}

}  // namespace
}  // namespace wingbeat

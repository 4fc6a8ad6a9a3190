// Loads as CFD codes write them, and the motion as they read it: the series of the kinematics file are evaluated here
// by code that shares nothing with what wrote them.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <sstream>

#include "wingbeat/core/math.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/kinematics_file.hpp"
#include "wingbeat/files/loads_file.hpp"

namespace wingbeat {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::Not;

std::string refusal(const std::string& text) {
  try {
    parse_loads(text, "loads.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(LoadsFile, ReadsUnitsNamesAndFormsInUse) {
  LoadsNotes notes;
  const SimulatedLoads loads = parse_loads(
      "# from a simulation\nphase_deg;Lift per wing (mN);Stroke moment [mN m];psi;stroke_angle_deg\n"
      "90;1,5;-2,0;7;10\n270;2,5;NaN;7;-10\n0;0,5;1;7;0\n",
      "loads.csv", &notes);
  EXPECT_THAT(loads.places, ElementsAre(testing::DoubleNear(0.25, 1e-15), testing::DoubleNear(0.75, 1e-15), 0.0));
  EXPECT_FALSE(loads.in_time);
  ASSERT_TRUE(loads.loads[0] && loads.loads[1]);
  EXPECT_TRUE(loads.loads[0]->per_wing);
  EXPECT_DOUBLE_EQ(loads.loads[0]->values[1], 2.5e-3);
  EXPECT_FALSE(loads.loads[1]->per_wing);
  EXPECT_DOUBLE_EQ(loads.loads[1]->values[0], -2e-3);
  EXPECT_TRUE(std::isnan(loads.loads[1]->values[1]));
  EXPECT_FALSE(loads.loads[2]);
  EXPECT_DOUBLE_EQ(loads.stroke[0], 10.0 * pi / 180.0);
  EXPECT_TRUE(loads.pitch.empty());
  EXPECT_EQ(notes.columns[3].header, "psi");
  EXPECT_EQ(notes.columns[3].name, "");
}

TEST(LoadsFile, TimeAndPhaseTogetherGiveTheFrequency) {
  const SimulatedLoads both = parse_loads(
      "time_ms,phase_rad,lift_n\n0,0,1\n25,3.141592653589793,2\n50,"
      "6.283185307179586,1\n",
      "loads.csv");
  EXPECT_NEAR(both.frequency.value_or(0.0), 20.0, 1e-12);
  EXPECT_FALSE(both.in_time);
  // A phase that begins anew does not count cycles.
  const SimulatedLoads wrapped = parse_loads("time_s,cycle,lift_n\n0,0,1\n0.025,0.5,2\n0.05,0,1\n0.075,0.5,2\n", "x");
  EXPECT_FALSE(wrapped.frequency);
  const SimulatedLoads time = parse_loads("t (s),lift_gf\n0,1\n0.1,2\n", "x");
  EXPECT_TRUE(time.in_time);
  EXPECT_DOUBLE_EQ(time.loads[0]->values[0], 9.80665e-3);
}

TEST(LoadsFile, ColumnsOfTheProgramsOwnFiles) {
  const SimulatedLoads loads =
      parse_loads("time_s,current_a,stroke_angle_rad,lift_n,aero_moment_nm,pitch_angle_rad\n0,1,0.1,2,3,0.2\n", "x");
  EXPECT_FALSE(loads.loads[1]);  // without the inertia of the air
  EXPECT_DOUBLE_EQ(parse_loads("cycle,stroke_moment_nm\n0,3\n", "x").loads[1]->values[0], 3.0);  // no nanometres
  EXPECT_DOUBLE_EQ(loads.pitch[0], 0.2);
}

TEST(LoadsFile, RefusesInOneSentence) {
  EXPECT_EQ(refusal("phase_deg,lift_kPa\n0,1\n").substr(0, 16), "loads.csv:1:11: ");
  EXPECT_THAT(refusal("phase_deg,lift_kPa\n0,1\n"), HasSubstr("lift: the unit"));
  EXPECT_THAT(refusal("phase,lift_n\n0,1\n"), HasSubstr("loads.csv:1:1: phase: names no unit; write phase_rad"));
  EXPECT_EQ(refusal("phase_deg,lift_n\n0,1\n10,abc\n"), "loads.csv:3:4: lift: expected a number, got \"abc\"");
  EXPECT_EQ(refusal("phase_deg,lift_n\n0,1\n,2\n"), "loads.csv:3:1: phase: is missing; expected a number in each row");
  EXPECT_EQ(refusal("lift_n,drag_n\n1,2\n"),
            "loads.csv:1:1: missing column: a place in the cycle is needed, time_s, phase_deg or cycle (0 to 1); the "
            "header has \"lift_n\", \"drag_n\"");
  EXPECT_EQ(refusal("time_s,drag_n\n1,2\n"),
            "loads.csv:1:1: missing column: a load is needed, such as lift_mN, lift_per_wing_mN, stroke_moment_mN_m "
            "or pitch_moment_mN_m; the header has \"time_s\", \"drag_n\"");
  EXPECT_EQ(refusal("time_s,lift_n,lift_mN\n1,2,3\n"),
            "loads.csv:1:15: lift: is given twice, as \"lift_n\" and as \"lift_mN\"");
  EXPECT_EQ(refusal("time_s,lift_n,lift_per_wing_n\n1,2,3\n"),
            "loads.csv:1:1: lift_per_wing: is given of all wings and per wing; expected one of both");
  EXPECT_EQ(refusal("time_s,lift_n\n"), "loads.csv:1:1: holds no rows");
  EXPECT_EQ(refusal("time_s,lift_n\n1\n"), "loads.csv:2:1: expected 2 values, got 1");
  EXPECT_EQ(refusal("time_s,lift_n\n1,\n"), "loads.csv:1:1: lift: the column \"lift_n\" holds no numbers");
  EXPECT_THAT(refusal(""), HasSubstr("loads.csv: is empty; expected a header such as"));
}

// ---- the motion

/// The keys of a section "[kinematics]": values end at a semicolon, lines that begin with one are comments.
std::map<std::string, std::string> keys_of(const std::string& ini) {
  std::map<std::string, std::string> keys;
  std::istringstream lines(ini);
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.front() == ';') continue;
    if (line == "[kinematics]") {
      inside = true;
      continue;
    }
    const std::size_t equals = line.find('=');
    EXPECT_TRUE(inside) << line;
    EXPECT_NE(equals, std::string::npos) << line;
    EXPECT_EQ(line.back(), ';') << line;
    keys[line.substr(0, equals)] = line.substr(equals + 1, line.find(';') - equals - 1);
  }
  return keys;
}

double evaluated(std::map<std::string, std::string>& keys, const std::string& angle, double t) {
  const int count = std::stoi(keys["nfft_" + angle]);
  double sum = std::stod(keys["a0_" + angle]) / 2.0;
  std::istringstream a(keys["ai_" + angle]), b(keys["bi_" + angle]);
  int read = 0;
  for (double x, y; a >> x && b >> y;) {
    ++read;
    sum += x * std::cos(2.0 * M_PI * read * t) + y * std::sin(2.0 * M_PI * read * t);
  }
  EXPECT_EQ(read, count) << angle;
  return sum;
}

double stroke_at(double t) {
  return 0.1 + 0.7 * std::cos(2.0 * M_PI * t) + 0.02 * std::sin(6.0 * M_PI * t) - 0.004 * std::cos(14.0 * M_PI * t);
}
double pitch_at(double t) { return -0.8 * std::tanh(1.5 * std::sin(2.0 * M_PI * t + 0.3)); }

KinematicsSource source_of(int harmonics) {
  std::vector<double> stroke, pitch;
  for (int n = 0; n < 512; ++n) stroke.push_back(stroke_at(n / 512.0)), pitch.push_back(pitch_at(n / 512.0));
  return {"a vehicle;\nof \"two\" lines", "1.0", 22.0, angle_series(stroke, harmonics), angle_series(pitch, harmonics)};
}

TEST(KinematicsFile, WabbitSeriesGiveTheMotionToTheStatedError) {
  for (const int harmonics : {3, 5, 12}) {
    const KinematicsSource source = source_of(harmonics);
    auto keys = keys_of(kinematics_wabbit(source));
    EXPECT_EQ(keys["type"], "fourier");
    EXPECT_EQ(keys["units"], "degree");
    EXPECT_EQ(keys["convention"], "flusi");
    double stroke_error = 0.0, pitch_error = 0.0;
    for (int n = 0; n < 512; ++n) {
      const double t = n / 512.0;
      stroke_error = std::max(stroke_error, std::abs(evaluated(keys, "phi", t) * M_PI / 180.0 - stroke_at(t)));
      pitch_error = std::max(pitch_error, std::abs(evaluated(keys, "alpha", t) * M_PI / 180.0 - pitch_at(t)));
      EXPECT_EQ(evaluated(keys, "theta", t), 0.0);
    }
    EXPECT_NEAR(stroke_error, source.stroke.error_max, 1e-12);
    EXPECT_NEAR(pitch_error, source.pitch.error_max, 1e-12);
    EXPECT_NEAR(stroke_error, harmonics < 7 ? 0.004 : 0.0, 1e-12);
  }
}

TEST(KinematicsFile, CommentsOfAnIniFileHoldNoKeyAndNoLine) {
  std::istringstream lines(kinematics_wabbit(source_of(3)));
  for (std::string line; std::getline(lines, line) && line != "[kinematics]";) {
    EXPECT_EQ(line.front(), ';');
    EXPECT_THAT(line, Not(HasSubstr("=")));
  }
}

TEST(KinematicsFile, CsvHasUnitsAndReadsBack) {
  std::vector<WingInstant> wings(3);
  for (int n = 0; n < 3; ++n) {
    wings[std::size_t(n)].time = 0.01 * n;
    wings[std::size_t(n)].cycle = 0.5 * n;
    wings[std::size_t(n)].stroke = {0.1 * n, -1.0, 1.0 / 3.0};
  }
  const std::string csv = kinematics_csv(wings);
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "time_s,phase_rad,stroke_angle_rad,flapping_velocity_rad_per_s,stroke_acceleration_rad_per_s2,"
            "pitch_angle_rad,pitch_velocity_rad_per_s");
  EXPECT_THAT(csv, HasSubstr("\n0.01,3.141592653589793,0.1,-1,0.3333333333333333,0,0\n"));
  for (WingInstant& w : wings) w.loads = {2.0, 3.0};
  EXPECT_THAT(kinematics_csv(wings, true), HasSubstr("pitch_velocity_rad_per_s,lift_n,stroke_moment_nm\n"));
  for (WingInstant& w : wings) w.twist = 0.25;
  EXPECT_THAT(kinematics_csv(wings), HasSubstr("pitch_velocity_rad_per_s,twist_angle_rad\n0,0,0,-1,"));
}

TEST(KinematicsFile, SectionsHaveTheAreaOfTheWing) {
  Planform<double> p;
  p.shape = PlanformShape::semi_ellipse;
  p.length = 63e-3;
  p.root_chord = 25e-3;
  const auto area_of = [](const Planform<double>& planform, int count) {
    const auto sections = wing_sections(planform, count);
    double area = 0.0;
    for (std::size_t n = 1; n < sections.size(); ++n) {
      area += 0.5 * (sections[n].first - sections[n - 1].first) * (sections[n].second + sections[n - 1].second);
    }
    return area;
  };
  EXPECT_NEAR(area_of(p, 200) / (0.25 * pi * 63e-3 * 25e-3), 1.0, 1e-3);
  EXPECT_NEAR(area_of(p, 9) / (0.25 * pi * 63e-3 * 25e-3), 1.0, 0.01);
  p.shape = PlanformShape::rectangle;
  p.scale = 2.0;
  EXPECT_NEAR(area_of(p, 9), 0.995 * 4.0 * 63e-3 * 25e-3, 1e-12);
  p.shape = PlanformShape::tabulated;
  p.chord_table = {{0.0, 2e-3}, {3e-3, 5e-3}, {8e-3, 4.5e-3}, {13e-3, 1e-3}};
  p.scale = 1.0;
  EXPECT_NEAR(area_of(p, 400), 1.5e-3 * 7e-3 + 2.5e-3 * 9.5e-3 + 2.5e-3 * 5.5e-3, 2e-7);
  p.shape = PlanformShape::moments;
  EXPECT_THROW(wing_sections(p, 9), ParameterError);
}

}  // namespace
}  // namespace wingbeat

// Measured sets against the model: closed forms of the fits, known parameters found again, and what a stage says of it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "study/residual_fit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/study/validation.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

FreeParameter named(const char* key, double lower, double upper, double start) {
  FreeParameter p{{}, lower, upper, start};
  p.parameter.key = key;
  p.parameter.unit = "1";
  return p;
}

TEST(ResidualFit, OfALineHasTheTextbooksErrors) {
  const std::vector<double> x = {0.0, 1.0, 2.0, 3.0, 4.0}, y = {1.1, 2.9, 5.2, 6.8, 9.1};
  const ResidualFit fit = fit_residuals(
      [&](const std::vector<double>& p) {
        std::vector<double> line;
        for (const double t : x) line.push_back(p[0] + p[1] * t);
        return line;
      },
      y, {named("constant", -10.0, 10.0, 0.0), named("slope", -10.0, 10.0, 0.5)});
  ASSERT_TRUE(fit.converged);
  // Means 2 and 5.02; Sxx 10, Sxy 19.9.
  const double slope = 1.99, constant = 5.02 - 2.0 * slope;
  double squares = 0.0;
  for (std::size_t n = 0; n < x.size(); ++n) squares += std::pow(y[n] - constant - slope * x[n], 2);
  EXPECT_NEAR(fit.x[0], constant, 1e-8);
  EXPECT_NEAR(fit.x[1], slope, 1e-8);
  EXPECT_NEAR(fit.parameters[1].standard_error, std::sqrt(squares / 3.0 / 10.0), 1e-6);
  // Student's two-sided 95 % quantile of three degrees of freedom.
  EXPECT_NEAR(fit.parameters[1].upper_95, slope + 3.182446 * fit.parameters[1].standard_error, 1e-6);
}

TEST(ResidualFit, AtABoundHasNoInterval) {
  const ResidualFit fit = fit_residuals([](const std::vector<double>& p) { return std::vector<double>{p[0], p[0]}; },
                                        {3.0, 3.2}, {named("number", 0.0, 2.0, 1.0)});
  EXPECT_NEAR(fit.x[0], 2.0, 1e-6);
  EXPECT_TRUE(fit.parameters[0].at_bound);
  EXPECT_TRUE(std::isnan(fit.parameters[0].lower_95));
}

ValidationSet passive_set(double stiffness) {
  PassivePitchProblem problem;
  problem.design = read_design(std::string(WINGBEAT_DATA) + "/designs/robobee-piezo.toml");
  problem.frequency = 160.0;
  problem.strokes = {0.3, 0.4, 0.5, 0.6};
  problem.parameters = {{design_parameter("pitch.stiffness"), 2e-7, 1e-4, *problem.design.pitch.stiffness},
                        {design_parameter("pitch.damping_coefficient"), 0.0, 60.0, 5.0}};
  Design<double> other = problem.design;
  other.pitch.stiffness = stiffness;
  ValidationSet set;
  set.quantities = {{"pitch amplitude", "deg"}};
  for (std::size_t n = 0; n < 4; ++n) {
    const PassivePitch pitch = passive_pitch(resolve(other), {0.0, {{problem.strokes[n], 0.0}}}, 160.0);
    set.points.push_back({"", double(n), 0, degrees_per_radian * pitch.amplitude});
  }
  set.problem = problem;
  split_alternately(set, {0, 1, 2, 3});
  return set;
}

TEST(Validation, FindsTheParameterOfSyntheticRowsAndPredictsTheOthers) {
  const ValidationSet set = passive_set(5e-6);
  EXPECT_TRUE(set.points[0].fitted && set.points[2].fitted);
  EXPECT_FALSE(set.points[1].fitted || set.points[3].fitted);
  const ValidationResult result = validate_set(set);
  ASSERT_EQ(result.stages.size(), 3U);
  EXPECT_TRUE(result.stages[0].parameters.empty());
  for (const ValidationMiss& miss : result.stages[0].misses) EXPECT_GT(miss.rms, 1.0);
  ASSERT_EQ(result.stages[1].parameters.size(), 1U);
  EXPECT_NEAR(*result.stages[1].parameters[0].value, 5e-6, 1e-10);
  ASSERT_EQ(result.stages[1].misses.size(), 2U);
  EXPECT_TRUE(result.stages[1].misses[0].fitted);
  EXPECT_FALSE(result.stages[1].misses[1].fitted);
  EXPECT_EQ(result.stages[1].misses[1].points, 2);
  EXPECT_LT(result.stages[1].misses[1].rms, 1e-3);
  EXPECT_NEAR(*result.stages[2].parameters[1].value, 5.0, 0.01);
}

TEST(Validation, FitsAtEachRowsOwnVoltageAndFrequency) {
  BenchProblem problem;
  problem.design = read_design(std::string(WINGBEAT_DATA) + "/designs/direct-drive.toml");
  const double voltage = problem.design.supply.voltage, frequency = problem.design.supply.frequency;
  problem.metric = Metric::stroke_amplitude;
  problem.metric_per_value = 1.0 / degrees_per_radian;
  const DesignParameter parameter = design_parameter("motor.armature_resistance");
  const double resistance = *parameter.value(problem.design);
  problem.parameters = {{parameter, 0.5 * resistance, 2.0 * resistance, resistance}};
  ValidationSet set;
  set.quantities = {{"stroke", "deg"}};
  Design<double> other = problem.design;
  parameter.set(other, 1.2 * resistance);
  std::vector<std::size_t> operating_points;
  for (const double v : {0.7, 0.85, 1.0}) {
    for (const double f : {0.9, 1.0, 1.1}) {
      problem.voltages.push_back(v * voltage);
      problem.frequencies.push_back(f * frequency);
      Vehicle<double> vehicle = resolve(other);
      vehicle.voltage = v * voltage;
      vehicle.drive_frequency = f * frequency;
      const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = 1e-9});
      ASSERT_EQ(found.status, FlappingStatus::flapping);
      set.points.push_back({"", f, 0, degrees_per_radian * found.metrics[Metric::stroke_amplitude]});
      operating_points.push_back(v < 0.8 ? 0 : v < 0.9 ? 1 : 2);
    }
  }
  set.problem = problem;
  split_alternately(set, operating_points);
  const ValidationResult result = validate_set(set);
  ASSERT_EQ(result.stages.size(), 2U);
  EXPECT_GT(result.stages[0].misses[1].rms, 0.5);
  EXPECT_NEAR(*result.stages[1].parameters[0].value, 1.2 * resistance, 1e-4 * resistance);
  EXPECT_LT(result.stages[1].misses[1].rms, 1e-3);
}

TEST(Validation, MissesAreThoseOfTheirRows) {
  ValidationSet set;
  set.quantities = {{"impedance", "ohm"}};
  set.points = {{"", 0.0, 0, 1.0}, {"", 1.0, 0, 4.0}, {"", 2.0, 0, 3.0}, {"", 3.0, 0, 5.0}};
  set.problem = ResistanceProblem{};
  split_alternately(set, {0, 1, 2, 3});
  const ValidationResult result = validate_set(set);
  ASSERT_EQ(result.stages.size(), 1U);  // nothing is known without a fit
  const ValidationStage& stage = result.stages[0];
  EXPECT_NEAR(*stage.parameters[0].value, 2.0, 1e-9);  // mean of the first and the third
  EXPECT_NEAR(stage.misses[0].rms, 1.0, 1e-9);
  EXPECT_NEAR(stage.misses[1].rms, std::sqrt((4.0 + 9.0) / 2.0), 1e-9);
  EXPECT_NEAR(stage.misses[1].mean, -2.5, 1e-9);
  EXPECT_NEAR(stage.misses[1].relative, std::sqrt(13.0 / (16.0 + 25.0)), 1e-9);
}

}  // namespace
}  // namespace wingbeat

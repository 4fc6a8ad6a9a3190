// wingbeat/wingbeat.hpp says what the storeys below it say.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "wingbeat/files/waveform_file.hpp"
#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat {
namespace {

const std::string springs = WINGBEAT_DATA "/designs/friction2022-springs.toml";

TEST(Door, SolvesSimulatesAndDifferentiates) {
  Design<double> design = read_design(springs);
  const RunResult found = solve(design, {.tolerance = 1e-9});
  ASSERT_EQ(found.status, FlappingStatus::flapping);
  const double lift = found.metrics[Metric::lift_mean];

  const TransientResult start = simulate(design);
  ASSERT_EQ(start.status, FlappingStatus::flapping);
  EXPECT_NEAR((*start.metrics)[Metric::lift_mean] / lift, 1.0, 1e-6);
  EXPECT_GT(start.time_to_steady, 0.0);

  const DesignPoint slopes = gradient(design, {"supply.voltage", "transmission.crank_radius"}, {.tolerance = 1e-10});
  ASSERT_EQ(slopes.gradients.size(), 2U);
  const double step = 1e-5;
  const auto lift_with = [&](double change) {
    Design<double> other = design;
    other.transmission.crank_radius += change;
    return solve(other, {.tolerance = 1e-12}).metrics[Metric::lift_mean];
  };
  const double difference = (lift_with(step) - lift_with(-step)) / (2.0 * step);
  EXPECT_NEAR(slopes.gradients[1][std::size_t(Metric::lift_mean)] / difference, 1.0, 1e-5);
}

TEST(Door, StartUpIsAssessedWithoutBeingAsked) {
  Design<double> design = read_design(springs);
  design.supply.voltage = 0.4;
  EXPECT_EQ(solve(design).status, FlappingStatus::locked);
  EXPECT_EQ(simulate(design).status, FlappingStatus::locked);
  EXPECT_EQ(solve_ensemble(std::vector(3, design))[1].status, FlappingStatus::locked);
}

TEST(Door, EnsemblesAreWhatEachDesignGives) {
  std::vector<Design<double>> designs(40, read_design(springs));
  for (std::size_t n = 0; n < designs.size(); ++n) designs[n].supply.voltage = 0.3 + 0.1 * double(n);
  const std::vector<EnsembleOutcome> outcomes = solve_ensemble(designs);
  for (std::size_t n = 0; n < designs.size(); ++n) {
    const RunResult alone = solve(designs[n]);
    EXPECT_EQ(outcomes[n].status, alone.status) << designs[n].supply.voltage;
    if (alone.status != FlappingStatus::flapping) continue;
    EXPECT_NEAR(outcomes[n].metrics[Metric::lift_mean] / alone.metrics[Metric::lift_mean], 1.0, 2e-6);
  }
}

TEST(Door, BadParametersAreNamed) {
  Design<double> design = read_design(springs);
  EXPECT_THROW(gradient(design, {"transmission.crank"}), ParameterError);
  design.transmission.crank_radius = -1.0;
  EXPECT_THROW(solve(design), ParameterError);
  EXPECT_THROW(simulate(design), ParameterError);
  try {
    solve_ensemble(std::vector<Design<double>>{read_design(springs), design});
    FAIL() << "accepted";
  } catch (const ParameterError& error) {
    EXPECT_EQ(error.key(), "transmission.crank_radius");
    EXPECT_THAT(error.what(), testing::HasSubstr("design 1: must"));
  }
}

TEST(Door, DesignsFromValuesOfKeys) {
  const Design<double> design = read_design(springs);
  const std::vector<std::string> values = {"transmission.crank_radius=\"7 mm\"", "wing.count=4", "supply.voltage=2 V"};
  const Design<double> other = design_with(values, &design);
  EXPECT_EQ(other.transmission.crank_radius, 0.007);
  EXPECT_EQ(other.wing.count, 4.0);
  EXPECT_EQ(other.supply.voltage, 2.0);
  EXPECT_EQ(write_design(design_with({}, &design)), write_design(design));

  const std::vector<std::string> wrong = {"motor.inertia=-1", "wing.count=two"};
  try {
    design_with(wrong, &design);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "motor.inertia: must be > 0 [kg m2], got -1");
    EXPECT_EQ(error.file(), "");
    EXPECT_EQ(error.line(), 0);
    ASSERT_EQ(error.others().size(), 1U);
    EXPECT_STREQ(error.others()[0].what(),
                 "wing.count: expected a number such as 2, got \"two\", which does not begin with a number");
  }
  try {
    design_with({});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "supply: missing section [supply]: the voltage at the motor terminals");
  }
}

/// What design_with makes of one assignment: the vehicle file, or what is wrong.
std::string text_with(const std::string& assignment, const Design<double>& base) {
  try {
    return write_design(design_with(std::span(&assignment, 1), &base));
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Door, ANumberByItselfIsWhatTheVehicleFileWouldMakeOfIt) {
  int compared = 0, refused = 0;
  for (const auto& file : std::filesystem::directory_iterator(WINGBEAT_DATA "/designs")) {
    if (file.path().extension() != ".toml") continue;
    const Design<double> design = read_design(file.path());
    for (const Parameter<double>& key : parameter_table<double>()) {
      if (!key.get) continue;
      const double own = key.get(design).value_or(0.5);
      for (const double value : {own, 0.5 * own + 0.1, -1.0}) {
        const std::string number = fmt::format("{}", value), path(key.path);
        // The space makes of it an assignment that is read as one of a vehicle file.
        const std::string read = text_with(path + "= " + number, design);
        EXPECT_EQ(text_with(path + "=" + number, design), read) << file.path() << " " << path << " " << value;
        if (key.unit != "1" && value != own) {
          const std::string quantity = "\"" + number + " " + std::string(key.unit) + "\"";
          EXPECT_EQ(text_with(path + "=" + quantity, design), text_with(path + "= " + quantity, design)) << path;
        }
        ++compared;
        refused += read.starts_with(path + ": ");
      }
    }
  }
  EXPECT_GT(compared - refused, 500);
  EXPECT_GT(refused, 500);
}

TEST(Door, EveryNameIsTheKeyWithoutItsUnit) {
  EXPECT_EQ(name_without_unit("lift_mean_n", "N"), "lift_mean");
  EXPECT_EQ(name_without_unit("lift_to_weight", "1"), "lift_to_weight");
  EXPECT_EQ(name_without_unit("lift_n", "W"), "lift_n");
  for (const MetricInfo& metric : metric_table()) {
    EXPECT_EQ(name_without_unit(metric.key, metric.unit) == metric.key, metric.unit == std::string("1")) << metric.key;
  }
  for (const WaveformColumn& column : waveform_columns()) {
    EXPECT_NE(name_without_unit(column.name, column.unit), column.name);
  }
}

}  // namespace
}  // namespace wingbeat

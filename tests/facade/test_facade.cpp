// wingbeat/wingbeat.hpp says what the layers below it say.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "wingbeat/files/waveform_file.hpp"
#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat {
namespace {

const std::string springs = WINGBEAT_DATA "/designs/friction2022-springs.toml";

TEST(Facade, SolvesSimulatesAndDifferentiates) {
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

TEST(Facade, StartUpIsAssessedWithoutBeingAsked) {
  Design<double> design = read_design(springs);
  design.supply.voltage = 0.4;
  EXPECT_EQ(solve(design).status, FlappingStatus::locked);
  EXPECT_EQ(simulate(design).status, FlappingStatus::locked);
  EXPECT_EQ(solve_ensemble(std::vector(3, design))[1].status, FlappingStatus::locked);
}

TEST(Facade, EnsemblesAreWhatEachDesignGives) {
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

TEST(Facade, BadParametersAreNamed) {
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

TEST(Facade, DesignsFromValuesOfKeys) {
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

TEST(Facade, ANumberByItselfIsWhatTheVehicleFileWouldMakeOfIt) {
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

/// Classical Runge-Kutta steps from a sample of a simulation to the next.
std::vector<double> integrated(const EquationsOfMotion& equations, double from, double to, std::vector<double> y,
                               std::optional<double> voltage = {}) {
  constexpr int steps = 20;
  const double h = (to - from) / steps;
  const std::size_t n = y.size();
  std::vector<double> k[4], moved;
  for (int s = 0; s < steps; ++s) {
    const double t = from + s * h;
    for (int stage = 0; stage < 4; ++stage) {
      const double part = stage == 0 ? 0.0 : stage == 3 ? 1.0 : 0.5;
      moved = y;
      for (std::size_t c = 0; stage > 0 && c < n; ++c) moved[c] += part * h * k[stage - 1][c];
      k[stage].resize(n);
      equations.rates(t + part * h, moved.data(), k[stage].data(), voltage);
    }
    for (std::size_t c = 0; c < n; ++c) y[c] += h / 6.0 * (k[0][c] + 2.0 * k[1][c] + 2.0 * k[2][c] + k[3][c]);
  }
  return y;
}

TEST(Facade, EquationsOfMotionAreThoseOfTheSimulation) {
  int compared = 0;
  for (const auto& file : std::filesystem::directory_iterator(WINGBEAT_DATA "/designs")) {
    if (file.path().extension() != ".toml") continue;
    const Design<double> design = read_design(file.path());
    if (design.pitch.stiffness) continue;  // of whose simulation no sample has the pitch
    const EquationsOfMotion equations(design);
    TransientOptions options;
    options.tolerance = 1e-9;
    options.max_time = 0.2;
    options.record = true;
    options.record_interval = 2e-4;
    const TransientResult simulated = simulate(design, options);
    const bool inductive = equations.state_count() == 3;
    double largest = 0.0, speed = 0.0;
    const auto state_of = [&](const TransientSample& sample) {
      std::vector<double> state{sample.crank_angle, sample.crank_speed};
      if (inductive) state.push_back(sample.current);
      return state;
    };
    for (const TransientSample& sample : simulated.samples) speed = std::max(speed, std::abs(sample.crank_speed));
    for (std::size_t n = 50; n + 1 < simulated.samples.size(); ++n) {
      const TransientSample &from = simulated.samples[n], &to = simulated.samples[n + 1];
      if (from.crank_speed * to.crank_speed <= 0.0) continue;  // friction changes its direction there
      const std::vector<double> found = integrated(equations, from.time, to.time, state_of(from));
      largest = std::max(largest, std::abs(found[1] - to.crank_speed) / speed);
    }
    EXPECT_LT(largest, 1e-6) << file.path();
    EXPECT_GT(simulated.samples.size(), 100U) << file.path();
    ++compared;
  }
  EXPECT_GE(compared, 5);
}

TEST(Facade, EquationsOfMotionAreThoseOfTheSteppedSimulation) {
  for (const char* name : {"friction2022-springs", "direct-drive", "pitch-hinge", "pitch-hinge-crank"}) {
    const Design<double> design = read_design(fmt::format("{}/designs/{}.toml", WINGBEAT_DATA, name));
    for (const std::optional<double> voltage : {std::optional<double>(), std::optional<double>(2.5)}) {
      const EquationsOfMotion equations(design);
      Simulation simulated = simulation(design, {.tolerance = 1e-11});
      ASSERT_EQ(equations.state_names(), simulated.state_names());
      if (voltage) simulated.command(*voltage);
      simulated.step_to(0.05);
      std::vector<double> size(equations.state_count());
      double largest = 0.0;
      for (int n = 0; n < 200; ++n) {
        const std::vector<double> from = simulated.state();
        const double time = simulated.time();
        simulated.step_to(time + 1e-4);
        const std::vector<double> to = simulated.state();
        const auto found = integrated(equations, time, simulated.time(), from, voltage);
        for (std::size_t k = 0; k < size.size(); ++k) {
          size[k] = std::max(size[k], std::abs(to[k]));
          if (n > 50) largest = std::max(largest, std::abs(found[k] - to[k]) / size[k]);
        }
      }
      EXPECT_LT(largest, 1e-7) << name;
    }
  }
}

TEST(Facade, EquationsOfMotionUnderAnyVoltage) {
  Design<double> design = read_design(springs);
  const double state[] = {1.0, 100.0, 0.1};
  double given[3], stated[3];
  EquationsOfMotion(design).rates(0.0, state, given, 4.5);
  design.supply.voltage = 4.5;
  EquationsOfMotion(design).rates(0.0, state, stated);
  EXPECT_THAT(given, testing::ElementsAreArray(stated));
  EXPECT_THAT(EquationsOfMotion(design).state_names(), testing::ElementsAre("crank_angle", "crank_speed", "current"));

  design.motor.constants.armature_inductance = 0.0;
  const EquationsOfMotion algebraic(design);
  EXPECT_EQ(algebraic.state_count(), 2U);
  double fast[2];
  algebraic.rates(0.0, state, fast);
  EXPECT_TRUE(std::isfinite(fast[1]));
}

TEST(Facade, EveryNameIsTheKeyWithoutItsUnit) {
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

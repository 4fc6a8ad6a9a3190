// The voltage for an electrical power, of one vehicle.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "study/held_differences.hpp"
#include "vehicle/random_vehicle.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

Design<double> shipped(const char* name) {
  return read_design(std::filesystem::path(WINGBEAT_DATA) / "designs" / name);
}

TEST(PowerSearch, ARunOnThePowerOfAVoltageFindsTheVoltage) {
  std::mt19937_64 random(3721);
  int flapping = 0;
  for (int n = 0; n < 60; ++n) {
    Design<double> d = random_design(random, 1.5);
    const RunResult there = run_design(d, {.tolerance = 1e-9});
    if (there.status != FlappingStatus::flapping) continue;
    ++flapping;
    const double voltage = d.supply.voltage;
    d.supply.voltage = 1.0;
    const RunResult found = run_design(
        d, {.tolerance = 1e-8, .power = there.metrics[Metric::power_electrical], .allow_extrapolation = true});
    ASSERT_EQ(found.search->outcome, FrequencyOutcome::reached) << n << ": " << describe(found);
    EXPECT_NEAR(found.design.supply.voltage / voltage, 1.0, 1e-7);
  }
  EXPECT_GT(flapping, 30);
}

TEST(PowerSearch, OfADirectDriveTheAmplitude) {
  Design<double> d = shipped("direct-drive.toml");
  const double voltage = d.supply.voltage;
  const double power = run_design(d, {.tolerance = 1e-9}).metrics[Metric::power_electrical];
  d.supply.voltage = 0.3;
  const RunResult found = run_design(d, {.tolerance = 1e-8, .power = power});
  ASSERT_EQ(found.search->outcome, FrequencyOutcome::reached) << describe(found);
  EXPECT_NEAR(found.design.supply.voltage / voltage, 1.0, 1e-7);
}

TEST(PowerSearch, RefusalsSayWhatCanBeHad) {
  Design<double> sticks = reference_design();
  sticks.motor.constants.friction_torque = 1e-4;
  const RunResult little = run_design(sticks, {.power = 1e-6});
  EXPECT_EQ(little.search->outcome, FrequencyOutcome::too_low);
  EXPECT_NE(describe(little).find("1e-06 W cannot be reached: from rest it flaps only above"), std::string::npos)
      << describe(little);
  const RunResult much = run_design(reference_design(), {.power = 1e6});
  EXPECT_NE(much.search->outcome, FrequencyOutcome::reached);
  EXPECT_NE(describe(much).find("1e+06 W cannot be reached"), std::string::npos) << describe(much);
  EXPECT_THROW(run_design(reference_design(), {.power = -1.0}), ParameterError);
  EXPECT_THROW(run_design(reference_design(), {.lift = 0.01, .power = 0.1}), ParameterError);
}

TEST(PowerSearch, DerivativesAtAHeldPower) {
  for (const char* name : {"friction2022-springs.toml", "direct-drive.toml"}) {
    SCOPED_TRACE(name);
    const Design<double> d = shipped(name);
    const std::vector<const char*> keys{"motor.armature_resistance", "wing.inertia"};
    DesignPointOptions options;
    options.hold = Hold{Held::power, 0.2};
    options.tolerance = 1e-9;
    const DesignPoint point =
        expect_held_derivatives(d, options, keys, {Metric::lift_mean, Metric::power_copper, Metric::current_rms}, 3e-6);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const double x = design_parameter(keys[k]).value(d).value_or(absent);
      if (!(x > 0.0)) continue;
      EXPECT_NEAR(point.gradients[k][std::size_t(Metric::power_electrical)], 0.0, 1e-9 * 0.2 / x);
    }
  }
}

}  // namespace
}  // namespace wingbeat

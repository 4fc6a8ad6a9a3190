// Larger and smaller vehicles: similar flow of power, by the dimensions of every number.
#include "wingbeat/study/scaling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

// But for the resistance, of which the law is another one, everything is similar: lift, currents and powers grow with
// the square, the frequency falls with the factor, angles and efficiencies stay.
TEST(Scaling, AVehicleOfAnySizeFliesAlike) {
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(WINGBEAT_DATA) / "designs")) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const Design<double> d = read_design(entry.path());
    for (const double factor : {0.5, 1.7}) {
      ScaledDesign s = scaled(d, factor, ScaledPart::vehicle);
      s.design.motor.constants.armature_resistance *= factor;
      // A thermal motor's limits and the air's viscosity are not similar, and do not act on the flapping.
      const RunResult a = run_design(d, {.tolerance = 1e-8}), b = run_design(s.design, {.tolerance = 1e-8});
      ASSERT_EQ(a.status, b.status) << describe(b);
      if (a.status != FlappingStatus::flapping) continue;
      const auto grows = [&](Metric m, int exponent) {
        if (!std::isfinite(a.metrics[m])) return;
        EXPECT_NEAR(b.metrics[m], a.metrics[m] * std::pow(factor, exponent),
                    1e-6 * std::abs(b.metrics[m]) + 1e-9 * std::pow(factor, exponent))
            << metric_info(m).key;
      };
      grows(Metric::frequency, -1);
      grows(Metric::lift_mean, 2);
      grows(Metric::current_mean, 2);
      grows(Metric::power_electrical, 2);
      grows(Metric::power_aerodynamic, 2);
      grows(Metric::efficiency_system, 0);
      grows(Metric::stroke_amplitude, 0);
      grows(Metric::lift_to_weight, -1);
    }
  }
}

TEST(Scaling, OfWingsAloneTheDriveStays) {
  const Design<double> d = read_design(std::filesystem::path(WINGBEAT_DATA) / "designs" / "friction2022-springs.toml");
  const ScaledDesign s = scaled(d, 1.1, ScaledPart::wing);
  EXPECT_FALSE(s.parameters.empty());
  for (const ScaledParameter& p : s.parameters) {
    EXPECT_EQ(p.key.substr(0, 5), "wing.");
    EXPECT_NEAR(p.after, p.before * std::pow(1.1, p.exponent), 1e-12 * p.after);
  }
  EXPECT_NEAR(s.design.wing.planform.length, 1.1 * d.wing.planform.length, 1e-15);
  EXPECT_EQ(s.design.spring.stiffness, d.spring.stiffness);
  EXPECT_EQ(s.design.mass, d.mass);
  Design<double> wide = d;
  wide.wing.planform = {PlanformShape::rectangle, 60e-3, 20e-3};
  wide.wing.planform.shoulder_distance = 8e-3;
  EXPECT_EQ(scaled(wide, 1.1, ScaledPart::wing).design.wing.planform.shoulder_distance, 8e-3);
  EXPECT_NEAR(scaled(wide, 1.1, ScaledPart::vehicle).design.wing.planform.shoulder_distance, 8.8e-3, 1e-15);
}

TEST(Scaling, ThereAndBackIsTheSame) {
  const Design<double> d = read_design(std::filesystem::path(WINGBEAT_DATA) / "designs" / "two-wing-direct-hinge.toml");
  const ScaledDesign there = scaled(d, 4.0, ScaledPart::vehicle);
  const ScaledDesign back = scaled(there.design, 0.25, ScaledPart::vehicle);
  ASSERT_EQ(there.parameters.size(), back.parameters.size());
  for (std::size_t n = 0; n < back.parameters.size(); ++n) {
    EXPECT_DOUBLE_EQ(back.parameters[n].after, there.parameters[n].before) << back.parameters[n].key;
  }
  EXPECT_THROW(scaled(d, 0.0, ScaledPart::wing), ParameterError);
  EXPECT_THROW(scaled(d, NAN, ScaledPart::wing), ParameterError);
}

}  // namespace
}  // namespace wingbeat

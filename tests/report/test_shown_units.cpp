// Reports show parameters in the units of the vehicle file's examples: lengths in mm, angles in degrees.
#include "wingbeat/core/status.hpp"
#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/report/fit_report.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/report/scaling_report.hpp"
#include "wingbeat/report/tolerance_report.hpp"
#include "wingbeat/study/bench_fit.hpp"
#include "wingbeat/study/scaling.hpp"
#include "wingbeat/study/tolerance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wingbeat {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(ShownUnits, OfAnOptimum) {
  OptimiseFile file;
  const auto parameter = [&](const char* key, const char* unit, double lower, double upper) {
    OptimisedParameter p;
    p.parameter.key = key;
    p.parameter.unit = unit;
    p.lower = lower;
    p.upper = upper;
    file.study.parameters.push_back(p);
  };
  parameter("transmission.crank_radius", "m", 3e-3, 8e-3);
  parameter("transmission.stroke_amplitude", "rad", 0.5, 1.0);
  parameter("spring.stiffness", "N m/rad", 0.0, 5e-3);
  OptimiseResult r;
  r.outcome = OptimiseResult::Outcome::found;
  r.parameters = {8e-3, 0.7, 4.5e-3};
  file.study.constraints = {{Metric::lift_to_weight, true, 1.0}, {Metric::stroke_amplitude, false, 0.7}};
  r.active = {{"lift_to_weight >= 1", 0.01, false},
              {"stroke_amplitude_rad <= 0.7", 0.01, false},
              {"transmission.crank_radius <= 0.008 m", 0.02, false}};
  FlatDirection d;
  d.from = {7.5e-3, 0.6, 4e-3};
  d.to = {7.7e-3, 0.8, 4.4e-3};
  r.directions = {d};
  for (double& x : r.point.metrics.values) x = absent;
  r.point.metrics[Metric::power_electrical] = 1.0;
  r.point.metrics[Metric::stroke_amplitude] = 0.7;
  const std::string text = text_optimum(file, r);
  EXPECT_THAT(text, HasSubstr("  transmission.crank_radius                     8            3            8 mm\n"));
  EXPECT_THAT(text, HasSubstr("  transmission.stroke_amplitude            40.107       28.648       57.296 deg\n"));
  EXPECT_THAT(text, HasSubstr("  spring.stiffness                         0.0045            0        0.005 N m/rad\n"));
  EXPECT_THAT(text, HasSubstr("minimise power_electrical_w with lift_to_weight >= 1, "
                              "stroke_amplitude_rad <= 0.7 (40.107 deg)\n"));
  EXPECT_THAT(text, HasSubstr("\n  lift_to_weight >= 1   "));
  EXPECT_THAT(text, HasSubstr("\n  stroke_amplitude_rad <= 0.7 (40.107 deg)   "));
  EXPECT_THAT(text, HasSubstr("  transmission.crank_radius <= 8 mm   "));
  EXPECT_THAT(text, HasSubstr("    transmission.crank_radius                 7.5 .. 7.7 mm\n"));
  EXPECT_THAT(text, HasSubstr("    transmission.stroke_amplitude          34.377 .. 45.837 deg\n"));
  EXPECT_THAT(text, HasSubstr("stroke_amplitude_rad                0.7 rad (40.107 deg)\n"));
}

TEST(ShownUnits, OfUncertainParameters) {
  ToleranceStudy study;
  const auto parameter = [&](const char* key, const char* unit, const Distribution& distribution) {
    UncertainParameter p;
    p.parameter.key = key;
    p.parameter.unit = unit;
    p.distribution = distribution;
    study.parameters.push_back(p);
  };
  Distribution uniform;
  uniform.kind = DistributionKind::uniform;
  uniform.lower = 4.95e-3;
  uniform.upper = 5.05e-3;
  parameter("transmission.crank_radius", "m", uniform);
  Distribution normal;
  normal.kind = DistributionKind::normal;
  normal.centre = 0.7;
  normal.spread = 0.01;
  normal.lower = 0.6;
  parameter("transmission.stroke_amplitude", "rad", normal);
  const std::string text = text_tolerance(study, ToleranceResult{});
  EXPECT_THAT(text, HasSubstr("  transmission.crank_radius         uniform, 4.95 to 5.05 mm\n"));
  EXPECT_THAT(text, HasSubstr("  transmission.stroke_amplitude     normal, 40.11 +- 0.57 deg, not below 34.38 deg\n"));
}

TEST(ShownUnits, OfFittedAndScaledParameters) {
  FitResult fit;
  FittedParameter p;
  p.key = "friction.radius";
  p.unit = "m";
  p.value = 2.5e-3;
  p.standard_error = 1e-4;
  p.lower_95 = 2.3e-3;
  p.upper_95 = 2.7e-3;
  fit.parameters = {p};
  fit.correlation = {{1.0}};
  EXPECT_THAT(text_fit(BenchFit{}, fit),
              HasSubstr("friction.radius                      2.5000     0.10       2.300 .. 2.700*     mm\n"));
  EXPECT_THAT(fitted_vehicle_head(BenchFit{}, fit, "a test"), HasSubstr("# friction.radius = 2.5 +- 0.1 mm\n"));

  ScaledDesign scaled;
  scaled.parameters = {{"wing.planform.length", "m", 0.063, 0.126, 1},
                       {"vehicle.mass", "kg", 0.02, 0.16, 3},
                       {"supply.capacity", "C", 360, 720, 1}};
  const std::string text = text_scaling(scaled, 2.0);
  EXPECT_THAT(text, HasSubstr("wing.planform.length                            63           126  mm          1\n"));
  EXPECT_THAT(text, HasSubstr("vehicle.mass                                    20           160  g           3\n"));
  EXPECT_THAT(text, HasSubstr("supply.capacity                                100           200  mA h        1\n"));
  EXPECT_THAT(text, Not(HasSubstr(" m ")));
}

TEST(ShownUnits, OfRefusals) {
  EXPECT_EQ(range_message("must be > 0", "m", -8e-3), "must be > 0 [m], got -0.008 (-8 mm)");
  EXPECT_EQ(range_message("must be < 1", "rad", 1.5), "must be < 1 [rad], got 1.5 (85.94 deg)");
  EXPECT_EQ(range_message("must be > 0", "m", 0.0), "must be > 0 [m], got 0");
  EXPECT_EQ(range_message("must be > 0", "V", -1.0), "must be > 0 [V], got -1");
}

}  // namespace
}  // namespace wingbeat

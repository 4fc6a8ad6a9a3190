// A hovering insect as a check of the aerodynamics alone: nothing in data/designs/hawkmoth.toml, which names the
// sources of its numbers, was fitted to the lift.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/parts/blade_element.hpp"
#include "wingbeat/parts/planform.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

constexpr double hawkmoth_frequency = 26.1;  // [Hz]

Design<double> hawkmoth() { return read_design(WINGBEAT_DATA "/designs/hawkmoth.toml"); }

RunResult flapping_at(Design<double> design, double alpha_deg, Method method = Method::orbit) {
  design.aerodynamics.angle_of_attack_min = alpha_deg / degrees_per_radian;
  RunOptions options{.method = method};
  options.frequency = hawkmoth_frequency;
  return run_design(design, options);
}

// Mean of 1/2 rho C_L beta'^2 S_2 over a sine of amplitude phi: beta'^2 has the mean (2 pi f phi)^2 / 2. The
// semi-ellipse from the hinge has S_2 = 2 (pi/16) (4/pi c_mean) R^3 = c_mean R^3 / 2 for both wings: a radius of the
// second moment of area of R/2.
TEST(Hawkmoth, LiftIsTheClosedFormOfAConstantAngleOfAttack) {
  const Design<double> design = hawkmoth();
  const double R = 51.9e-3, c_mean = 18.26e-3, phi = 57.3 / degrees_per_radian;
  const double s2 = chord_moments(design.wing.planform, design.wing.count).s2;
  EXPECT_NEAR(s2, 0.5 * c_mean * R * R * R, 2e-5 * s2);
  for (const double alpha_deg : {30.0, 35.0, 40.0}) {
    const double C_L = lift_coefficient(translational_2022(), alpha_deg / degrees_per_radian);
    const double lift = 0.5 * 1.225 * C_L * 0.5 * square(two_pi * hawkmoth_frequency * phi) * s2;
    const RunResult result = flapping_at(design, alpha_deg);
    ASSERT_EQ(result.status, FlappingStatus::flapping);
    EXPECT_FALSE(result.domain.any());
    EXPECT_NEAR(result.metrics[Metric::lift_mean] / lift, 1.0, 2e-5) << alpha_deg;
  }
}

TEST(Hawkmoth, LiftAboutEqualsWeightAtObservedAnglesOfAttack) {
  for (const auto& [alpha_deg, expected] : {std::pair{30.0, 1.005}, {35.0, 1.095}, {40.0, 1.152}}) {
    const double ratio = flapping_at(hawkmoth(), alpha_deg).metrics[Metric::lift_to_weight];
    fmt::print("hawkmoth at {} deg: lift / weight {:.4f}\n", alpha_deg, ratio);
    EXPECT_NEAR(ratio, expected, 1e-3);
    EXPECT_GT(ratio, 1.0);
    EXPECT_LT(ratio, 1.16);
  }
}

// Kinetic energy of the wings is carried by a rotor a million times heavier: the stroke is the sine that is prescribed.
TEST(Hawkmoth, StrokeIsPrescribed) {
  const RunResult result = flapping_at(hawkmoth(), 35.0);
  EXPECT_NEAR(result.metrics[Metric::crank_speed_max] / result.metrics[Metric::crank_speed_min], 1.0, 2e-5);
  EXPECT_NEAR(result.metrics[Metric::stroke_amplitude] * degrees_per_radian, 57.3, 1e-6);
}

}  // namespace
}  // namespace wingbeat

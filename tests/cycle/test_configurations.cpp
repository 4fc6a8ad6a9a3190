// Configurations at many crank angles at once against one by one.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "vehicle/random_vehicle.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "vehicle/wide_boxes.hpp"
#include "wingbeat/cycle/configurations.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

void expect_same(const Vehicle<double>& v, std::size_t count) {
  std::vector<double> theta(count);
  for (std::size_t n = 0; n < count; ++n) theta[n] = -3.0 + 0.37 * double(n);
  std::vector<Configuration<double>> configurations(count);
  configurations_at(v, theta, configurations);
  for (std::size_t n = 0; n < count; ++n) {
    SCOPED_TRACE(theta[n]);
    const Configuration<double> one = configuration_at(v, std::sin(theta[n]), std::cos(theta[n]));
    const auto expect_near = [](double a, double b, double size) { EXPECT_NEAR(a, b, 2e-14 * size); };
    expect_near(stroke_angle(configurations[n].kinematics), stroke_angle(one.kinematics), 1.0);
    const double slope = typical_stroke_slope(v.transmission);
    expect_near(configurations[n].kinematics.stroke_slope, one.kinematics.stroke_slope, slope);
    expect_near(configurations[n].kinematics.stroke_second_derivative, one.kinematics.stroke_second_derivative,
                slope * (1.0 + slope));
    expect_near(configurations[n].kinematics.wing_jacobian, one.kinematics.wing_jacobian,
                std::abs(one.kinematics.wing_jacobian));
    expect_near(configurations[n].kinematics.crank_jacobian, one.kinematics.crank_jacobian,
                typical_crank_lever(v.transmission));
    expect_near(configurations[n].spring_moment, one.spring_moment, v.wing_count * v.spring.stiffness);
  }
}

TEST(Configurations, AtOnceAreThoseOneByOne) {
  for (const std::size_t count : {1, 3, 4, 11, 12, 50}) {
    for (const bool springs : {false, true}) expect_same(reference_vehicle(springs), count);
  }
  std::mt19937_64 random(11);
  for (int n = 0; n < 20; ++n) expect_same(resolve(random_design(random, 1.5)), 12);
}

TEST(Configurations, OfOtherTransmissionsToo) {
  for (const FarBox box : {FarBox::four_bar, FarBox::tabulated}) {
    for (std::uint32_t n = 0; n < 5; ++n) expect_same(resolve(wide_vehicle(box, n, 5).design), 12);
  }
}

}  // namespace
}  // namespace wingbeat

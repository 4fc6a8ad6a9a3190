#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "parts/expect_error.hpp"
#include "wingbeat/parts/slider_crank.hpp"

namespace wingbeat {
namespace {

constexpr SliderCrank<double> reference = {5e-3, 20e-3, 6e-3, 20e-3, Formulation::rod_force};

CrankKinematics<double> at(const SliderCrank<double>& c, double theta) {
  return crank_kinematics(c, std::sin(theta), std::cos(theta));
}

SliderCrank<double> random_crank(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  SliderCrank<double> c;
  c.crank_radius = 1e-3 * (1.0 + 9.0 * unit(random));
  c.rod_length = c.crank_radius * (1.5 + 6.0 * unit(random));
  c.hinge_offset = c.crank_radius * (0.8 + 2.0 * unit(random));
  c.mid_stroke_height = c.rod_length + c.crank_radius * (unit(random) - 0.5);
  c.formulation = Formulation::virtual_work;
  return c;
}

// Slider height and stroke angle written down from the mechanism, apart from the library and in more digits.
long double height(const SliderCrank<double>& c, long double theta) {
  const long double gamma = std::asin((long double)(c.crank_radius) * std::cos(theta) / c.rod_length);
  return c.crank_radius * std::sin(theta) + c.rod_length * std::cos(gamma);
}
long double stroke(const SliderCrank<double>& c, long double theta) {
  return std::atan((height(c, theta) - c.mid_stroke_height) / c.hinge_offset);
}

constexpr long double spacing = 0.005L;
/// First derivative by central differences of order 8.
template <class F>
double slope(const F& f, long double x) {
  const long double h = spacing;
  return double((672.0L * (f(x + h) - f(x - h)) - 168.0L * (f(x + 2 * h) - f(x - 2 * h)) +
                 32.0L * (f(x + 3 * h) - f(x - 3 * h)) - 3.0L * (f(x + 4 * h) - f(x - 4 * h))) /
                (840.0L * h));
}
/// Second derivative by central differences of order 8.
template <class F>
double curve(const F& f, long double x) {
  const long double h = spacing;
  return double((8064.0L * (f(x + h) + f(x - h)) - 1008.0L * (f(x + 2 * h) + f(x - 2 * h)) +
                 128.0L * (f(x + 3 * h) + f(x - 3 * h)) - 9.0L * (f(x + 4 * h) + f(x - 4 * h)) - 14350.0L * f(x)) /
                (5040.0L * h * h));
}

TEST(SliderCrank, PositionFollowsTheGeometry) {
  std::mt19937_64 random(11);
  for (int n = 0; n < 50; ++n) {
    const SliderCrank<double> c = random_crank(random);
    for (double theta = 0.05; theta < two_pi; theta += 0.3) {
      const auto k = at(c, theta);
      EXPECT_NEAR(slider_height(c, std::sin(theta), std::cos(theta)), double(height(c, theta)), 1e-15 * c.rod_length);
      EXPECT_NEAR(stroke_angle(k), double(stroke(c, theta)), 1e-14);
    }
  }
}

TEST(SliderCrank, SlopeAndCurveAreTheDerivativesOfTheStrokeAngle) {
  std::mt19937_64 random(12);
  for (int n = 0; n < 50; ++n) {
    const SliderCrank<double> c = random_crank(random);
    for (double theta = 0.0; theta < two_pi; theta += 0.2) {
      const auto beta = [&](long double x) { return stroke(c, x); };
      const auto k = at(c, theta);
      EXPECT_NEAR(k.stroke_slope, slope(beta, theta), 1e-10) << "theta " << theta;
      EXPECT_NEAR(k.stroke_second_derivative, curve(beta, theta), 1e-10) << "theta " << theta;
    }
  }
}

TEST(SliderCrank, CrankLeverIsCosGammaTimesSliderSlope) {
  std::mt19937_64 random(13);
  for (int n = 0; n < 50; ++n) {
    const SliderCrank<double> c = random_crank(random);
    for (double theta = 0.0; theta < two_pi; theta += 0.2) {
      const double gamma = std::asin(c.crank_radius * std::cos(theta) / c.rod_length);
      const double h = at(c, theta).crank_jacobian;
      EXPECT_NEAR(h, std::cos(gamma) * slope([&](long double x) { return height(c, x); }, theta),
                  1e-10 * c.crank_radius);
      // The paper's form of it (5).
      EXPECT_NEAR(h, c.crank_radius * (std::sin(theta) * std::sin(gamma) + std::cos(theta) * std::cos(gamma)),
                  1e-15 * c.crank_radius);
    }
  }
}

TEST(SliderCrank, VirtualWorkConservesPowerToRounding) {
  std::mt19937_64 random(14);
  for (int n = 0; n < 200; ++n) {
    const SliderCrank<double> c = random_crank(random);
    for (double theta = 0.0; theta < two_pi; theta += 0.1) {
      const auto k = at(c, theta);
      EXPECT_NEAR(k.wing_jacobian * k.stroke_slope, k.crank_jacobian, 2e-15 * std::abs(k.crank_jacobian))
          << "theta " << theta;
    }
  }
}

TEST(SliderCrank, RodForceMissesPowerByAKnownFactor) {
  // g B1 / h = cos^2 beta (1 + tan gamma tan beta): exact only where beta = 0.
  for (double theta = 0.03; theta < two_pi; theta += 0.1) {
    const auto k = at(reference, theta);
    const double gamma = std::asin(0.25 * std::cos(theta)), beta = stroke_angle(k);
    const double factor = std::cos(beta) * std::cos(beta) * (1.0 + std::tan(gamma) * std::tan(beta));
    EXPECT_NEAR(k.wing_jacobian * k.stroke_slope, factor * k.crank_jacobian, 1e-14 * reference.crank_radius);
    if (std::abs(beta) > 0.3) {
      EXPECT_GT(std::abs(1.0 - factor), 0.02) << "theta " << theta;
    }
  }
  const auto dead_centre = crank_kinematics(reference, 1.0, 0.0);
  EXPECT_DOUBLE_EQ(dead_centre.wing_jacobian, 6e-3);
  SliderCrank<double> other = reference;
  other.formulation = Formulation::virtual_work;
  EXPECT_DOUBLE_EQ(crank_kinematics(other, 1.0, 0.0).wing_jacobian, 6e-3 * 61.0 / 36.0);
}

TEST(SliderCrank, FormulationsShareTheirKinematics) {
  SliderCrank<double> other = reference;
  other.formulation = Formulation::virtual_work;
  for (double theta = 0.0; theta < two_pi; theta += 0.1) {
    const auto a = at(reference, theta), b = at(other, theta);
    EXPECT_EQ(stroke_angle(a), stroke_angle(b));
    EXPECT_EQ(a.stroke_slope, b.stroke_slope);
    EXPECT_EQ(a.stroke_second_derivative, b.stroke_second_derivative);
    EXPECT_EQ(a.crank_jacobian, b.crank_jacobian);
  }
}

TEST(SliderCrank, WingStandsStillAtTheDeadCentres) {
  for (const double sine : {1.0, -1.0}) {
    const auto k = crank_kinematics(reference, sine, 0.0);
    EXPECT_EQ(k.stroke_slope, 0.0);
    EXPECT_EQ(k.crank_jacobian, 0.0);
    EXPECT_NEAR(stroke_angle(k), sine * std::atan(5.0 / 6.0), 1e-15);
    EXPECT_LT(sine * k.stroke_second_derivative, 0.0);
  }
}

TEST(SliderCrank, CrankTurningUpwardsRaisesTheWing) {
  const auto k = crank_kinematics(reference, 0.0, 1.0);
  EXPECT_GT(k.stroke_slope, 0.0);
  EXPECT_GT(k.crank_jacobian, 0.0);
  EXPECT_GT(k.wing_jacobian, 0.0);
}

TEST(SliderCrank, LongRodMovesTheSliderLikeASine) {
  SliderCrank<double> c = reference;
  c.rod_length = c.mid_stroke_height = 1e4 * c.crank_radius;
  for (double theta = 0.0; theta < two_pi; theta += 0.1) {
    const auto k = at(c, theta);
    const double tan_beta = 5.0 / 6.0 * std::sin(theta), cos2 = 1.0 / (1.0 + tan_beta * tan_beta);
    EXPECT_NEAR(stroke_angle(k), std::atan(tan_beta), 1e-4);
    EXPECT_NEAR(k.stroke_slope, 5.0 / 6.0 * std::cos(theta) * cos2, 2e-4);
    EXPECT_NEAR(k.crank_jacobian, c.crank_radius * std::cos(theta), 2e-4 * c.crank_radius);
  }
}

TEST(SliderCrank, StrokeAmplitudeIsHalfThePeakToPeakStroke) {
  EXPECT_NEAR(stroke_amplitude(reference), std::atan(5.0 / 6.0), 1e-15);
  std::mt19937_64 random(15);
  for (int n = 0; n < 50; ++n) {
    const SliderCrank<double> c = random_crank(random);
    double top = -10.0, bottom = 10.0;
    for (int k = 0; k < 4000; ++k) {
      const double beta = stroke_angle(at(c, two_pi * k / 4000.0));
      top = std::max(top, beta);
      bottom = std::min(bottom, beta);
    }
    EXPECT_NEAR(stroke_amplitude(c), 0.5 * (top - bottom), 1e-14);
  }
}

TEST(SliderCrank, HingeOffsetForAnAmplitudeGivesIt) {
  EXPECT_NEAR(hinge_offset_for(pi / 4.0, 5e-3), 5e-3, 1e-17);
  for (const double amplitude : {0.1, 0.6, 1.2}) {
    SliderCrank<double> c = reference;
    c.hinge_offset = hinge_offset_for(amplitude, c.crank_radius);
    EXPECT_NEAR(stroke_amplitude(c), amplitude, 1e-15);
  }
}

TEST(SliderCrank, RefusesGeometryOutOfRange) {
  using C = SliderCrank<double>;
  EXPECT_NO_THROW(validate(reference));
  EXPECT_EQ(refusal(reference, [](C& c) { c.crank_radius = 0.0; }),
            "transmission.crank_radius: must be > 0 [m], got 0");
  EXPECT_EQ(refusal(reference, [](C& c) { c.rod_length = 5e-3; }),
            "transmission.rod_length: must be longer than the crank radius [m], got 0.005 (5 mm)");
  EXPECT_EQ(refusal(reference, [](C& c) { c.hinge_offset = -6e-3; }),
            "transmission.hinge_offset: must be > 0 [m], got -0.006 (-6 mm)");
  EXPECT_EQ(refusal(reference, [](C& c) { c.mid_stroke_height = std::nan(""); }),
            "transmission.mid_stroke_height: must be finite [m], got nan");
}

}  // namespace
}  // namespace wingbeat

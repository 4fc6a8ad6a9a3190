#include "wingbeat/parts/four_bar.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <functional>
#include <numbers>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/any_transmission.hpp"

namespace wingbeat {
namespace {

static_assert(Transmission<FourBar<double>, double>);
static_assert(Transmission<FourBar<Jet<2>>, Jet<2>>);
static_assert(Transmission<AnyTransmission<double>, double>);
static_assert(Transmission<AnyTransmission<Jet<2>>, Jet<2>>);

FourBar<double> four_bar(double stroke_ratio = 1.0) {
  FourBar<double> f{3e-3, 14e-3, 5e-3, 14.5e-3, stroke_ratio};
  f.ground_angle = centred_ground_angle(f);
  return f;
}

CrankKinematics<double> at(const FourBar<double>& f, double theta) {
  return crank_kinematics(f, std::sin(theta), std::cos(theta));
}

std::string refusal_of(const FourBar<double>& f) {
  try {
    validate(f);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "";
}

// The coupler keeps its length whatever the crank angle, which needs nothing of how the rocker's angle was found.
TEST(FourBar, LoopCloses) {
  const FourBar<double> f = four_bar();
  for (double theta = 0.0; theta < two_pi; theta += 0.1) {
    const double phi = stroke_angle(at(f, theta)) + f.ground_angle;
    const std::complex<double> pin = f.ground_length + std::polar(f.rocker_length, phi);
    EXPECT_NEAR(std::abs(pin - std::polar(f.crank_radius, theta)), f.coupler_length, 1e-16) << theta;
    EXPECT_GT(pin.imag(), 0.0);
  }
}

TEST(FourBar, SlopesAgreeWithDifferences) {
  const FourBar<double> f = four_bar(3.2);
  const double h = 1e-4;
  for (double theta = 0.05; theta < two_pi; theta += 0.17) {
    const CrankKinematics<double> k = at(f, theta), before = at(f, theta - h), after = at(f, theta + h);
    EXPECT_NEAR(k.stroke_slope, (stroke_angle(after) - stroke_angle(before)) / (2.0 * h), 1e-7) << theta;
    EXPECT_NEAR(k.stroke_second_derivative, (after.stroke_slope - before.stroke_slope) / (2.0 * h), 2e-7) << theta;
  }
}

TEST(FourBar, DualNumbersAgreeWithDifferences) {
  using J = Jet<6>;
  FourBar<double> f = four_bar(2.0);
  f.ground_angle = 1.7;
  for (const double theta : {0.3, 1.9, 4.4}) {
    FourBar<J> dual = cast<J>(f);
    int n = 0;
    for_each_number(dual, [&](J& x) { x = J(x.a, n++); });
    const auto jets = crank_kinematics(dual, J(std::sin(theta)), J(std::cos(theta)));
    for (int by = 0; by < 6; ++by) {
      const auto moved = [&](double sign) {
        FourBar<double> m = f;
        int k = 0;
        for_each_number(m, [&](double& x) {
          if (k++ == by) x *= 1.0 + sign * 1e-6;
        });
        return at(m, theta);
      };
      const CrankKinematics<double> high = moved(1.0), low = moved(-1.0);
      double value = 0.0;
      int k = 0;
      for_each_number(f, [&](double& x) { value = k++ == by ? x : value; });
      const auto expect = [&](const J& jet, double a, double b, const char* what) {
        EXPECT_NEAR(jet.v[by] * value, (a - b) / 2e-6, 1e-7 * (std::abs(jet.a) + std::abs(jet.v[by] * value)) + 1e-12)
            << what << " by " << by << " at " << theta;
      };
      expect(stroke_angle(jets), stroke_angle(high), stroke_angle(low), "beta");
      expect(jets.stroke_slope, high.stroke_slope, low.stroke_slope, "B1");
      expect(jets.stroke_second_derivative, high.stroke_second_derivative, low.stroke_second_derivative, "B2");
      expect(jets.wing_jacobian, high.wing_jacobian, low.wing_jacobian, "g");
      expect(jets.crank_jacobian, high.crank_jacobian, low.crank_jacobian, "h");
    }
  }
}

TEST(FourBar, ConservesPowerAndItsLeverIsThatOfTheTransmissionAngle) {
  const FourBar<double> f = four_bar(2.5);
  for (double theta = 0.0; theta < two_pi; theta += 0.1) {
    const CrankKinematics<double> k = at(f, theta);
    EXPECT_NEAR(k.crank_jacobian, k.wing_jacobian * k.stroke_slope, 1e-17) << theta;
    const double phi = stroke_angle(k) / f.stroke_ratio + f.ground_angle;
    const std::complex<double> coupler =
        f.ground_length + std::polar(f.rocker_length, phi) - std::polar(f.crank_radius, theta);
    const double mu = phi - std::arg(coupler);
    EXPECT_NEAR(k.wing_jacobian, f.rocker_length * std::sin(mu) / f.stroke_ratio, 1e-16) << theta;
  }
}

TEST(FourBar, ReversesWhereCrankAndCouplerAreInLine) {
  for (const double stroke_ratio : {1.0, 4.0}) {
    const FourBar<double> f = four_bar(stroke_ratio);
    const Reversals known = reversals(f), found = find_reversals(f);
    ASSERT_EQ(found.count, 2u);
    ASSERT_EQ(known.count, 2u);
    EXPECT_EQ(known.first_sign, found.first_sign);
    for (std::size_t n = 0; n < 2; ++n) EXPECT_NEAR(found.angle[n], known.angle[n], 1e-13);
    const double one = stroke_angle(at(f, known.angle[0])), other = stroke_angle(at(f, known.angle[1]));
    EXPECT_NEAR(stroke_amplitude(f), 0.5 * std::abs(other - one), 1e-14);
    EXPECT_NEAR(one, -other, 1e-14);  // centred
    EXPECT_NEAR(stroke_reach(f), stroke_amplitude(f), 1e-14);
  }
}

TEST(FourBar, ParallelogramTurnsItsRockerWithItsCrank) {
  const FourBar<double> f{6e-3, 20e-3, 6e-3, 20e-3, 1.0, 0.0};
  for (double theta = 0.3; theta < pi - 0.3; theta += 0.1) {  // away from where all links are in line
    const CrankKinematics<double> k = at(f, theta);
    EXPECT_NEAR(stroke_angle(k), theta, 1e-14);
    EXPECT_NEAR(k.stroke_slope, 1.0, 1e-13);
    EXPECT_NEAR(k.stroke_second_derivative, 0.0, 1e-12);
  }
}

// With rocker and ground ever longer the rocker's pin runs on the slider's line: the slider's height, and power
// conserved as by virtual-work. The wing law stays the four-bar's: beta itself, not its tangent, follows the height.
TEST(FourBar, LongRockerIsASlider) {
  const SliderCrank<double> slider = {5e-3, 20e-3, 6e-3, 20e-3, Formulation::virtual_work};
  double before = 0.0;
  for (const double p : {2.0, 20.0, 200.0}) {
    const double tilt = std::atan(slider.rod_length / p);  // the rocker's axis is as high as the pin in mid-stroke
    FourBar<double> f{slider.crank_radius, slider.rod_length, p, std::hypot(p, slider.rod_length)};
    f.stroke_ratio = p / slider.hinge_offset;
    f.ground_angle = pi - tilt;
    double off = 0.0;
    for (double theta = 0.1; theta < two_pi; theta += 0.2) {
      const CrankKinematics<double> s = crank_kinematics(slider, std::sin(theta), std::cos(theta));
      const CrankKinematics<double> k = at(f, theta - tilt);
      const double cos2_beta = 1.0 / (1.0 + square(s.tan_stroke));
      off = std::max({off, std::abs(-stroke_angle(k) - s.tan_stroke),
                      std::abs(-k.stroke_slope - s.stroke_slope / cos2_beta),
                      std::abs(k.wing_jacobian - s.wing_jacobian * cos2_beta) / slider.hinge_offset,
                      std::abs(-k.crank_jacobian - s.crank_jacobian) / slider.crank_radius});
    }
    EXPECT_LT(off, 0.02 / p);
    if (before > 0.0) {
      EXPECT_NEAR(before / off, 10.0, 0.5);
    }
    before = off;
  }
}

TEST(FourBar, RefusesWhatCannotTurn) {
  EXPECT_EQ(refusal_of(four_bar()), "");
  FourBar<double> f = four_bar();
  f.crank_radius = 5.5e-3;
  EXPECT_EQ(refusal_of(f),
            "transmission.crank_radius: must be the shortest link, or the crank cannot turn (Grashof) [m], "
            "got 0.0055 (5.5 mm)");
  f = four_bar();
  f.ground_length = 16.5e-3;
  EXPECT_EQ(refusal_of(f),
            "transmission.crank_radius: with the longest link must be shorter than the other two links together, or "
            "the crank cannot turn (Grashof) [m], got 0.003 (3 mm)");
  f = four_bar();
  f.ground_length = 15.99e-3;
  EXPECT_EQ(refusal_of(f).substr(0, 119),
            "transmission.coupler_length: must keep the transmission angle between coupler and rocker within 5 to 175 "
            "[deg], got 175");
  f = four_bar();
  f.stroke_ratio = 0.0;
  EXPECT_EQ(refusal_of(f), "transmission.stroke_ratio: must be > 0 [1], got 0");
}

}  // namespace
}  // namespace wingbeat

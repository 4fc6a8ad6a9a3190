// Mechanisms from their stroke, against linkages that are closed and measured here by other means.
#include "wingbeat/study/synthesis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <random>

#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/any_transmission.hpp"

namespace wingbeat {
namespace {

using Complex = std::complex<double>;
constexpr double degree = pi / 180.0;

struct Links {
  double r, l, p, d;
};

Links links_of(const TransmissionDesign<double>& t) {
  return {t.crank_radius, t.coupler_length, t.rocker_length, t.ground_length};
}

/// Rocker pin of the linkage at a crank angle: where circles around crank pin and rocker axis meet; NaN where they do
/// not.
Complex rocker_pin(const Links& k, double theta) {
  const Complex pin = std::polar(k.r, theta), axis(k.d, 0.0), between = axis - pin;
  const double D = std::abs(between), a = (D * D + k.l * k.l - k.p * k.p) / (2.0 * D);
  const Complex along = between / D;
  return pin + along * Complex(a, std::sqrt(k.l * k.l - a * a));
}

struct Measured {
  bool turns = true;
  double swing = 0.0, angle = 0.0, time_ratio = 0.0, envelope = 0.0;
};

/// By positions at many crank angles.
Measured measured(const Links& k, int steps = 7200, bool extent = true) {
  Measured m;
  double low = 1e9, high = -1e9, theta_low = 0.0, theta_high = 0.0;
  m.angle = pi;
  std::vector<Complex> points{0.0, {k.d, 0.0}};
  for (int n = 0; n < steps; ++n) {
    const double theta = two_pi * n / steps;
    const Complex q = rocker_pin(k, theta);
    if (!std::isfinite(q.real())) return {false};
    const Complex pin = std::polar(k.r, theta);
    const double phi = std::arg(q - k.d), mu = std::abs(std::arg((q - k.d) / (q - pin)));
    m.angle = std::min({m.angle, mu, pi - mu});
    if (phi < low) low = phi, theta_low = theta;
    if (phi > high) high = phi, theta_high = theta;
    if (extent && n % (steps / 240) == 0) points.push_back(q), points.push_back(pin);
  }
  m.swing = high - low;
  const double one = wrap_angle(theta_high - theta_low), other = two_pi - one;
  m.time_ratio = std::max(one, other) / std::min(one, other);
  for (const Complex& a : points) {
    for (const Complex& b : points) m.envelope = std::max(m.envelope, std::abs(a - b));
  }
  return m;
}

/// Least transmission angle from where the crank is on the line of the axes; negative where it does not turn.
double least_angle(const Links& k) {
  if (!(k.r < std::min({k.l, k.p, k.d}))) return -1.0;
  double least = pi;
  for (const double diagonal : {k.d - k.r, k.d + k.r}) {
    const double c = (k.l * k.l + k.p * k.p - diagonal * diagonal) / (2.0 * k.l * k.p);
    if (!(std::abs(c) < 1.0)) return -1.0;
    least = std::min({least, std::acos(c), pi - std::acos(c)});
  }
  return least;
}

/// Swing of the rocker by the triangles of the dead centres.
double swing_of(const Links& k) {
  const auto inner = [&](double reach) {
    return std::acos((k.d * k.d + k.p * k.p - reach * reach) / (2.0 * k.d * k.p));
  };
  return inner(k.l + k.r) - inner(k.l - k.r);
}

StrokeTarget random_target(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  StrokeTarget t{};
  t.stroke = (20.0 + 150.0 * unit(random)) * degree;
  t.envelope = std::exp(std::log(3e-3) + 3.0 * unit(random));
  t.shortest = t.envelope * (0.03 + 0.17 * unit(random));
  t.stroke_ratio = unit(random) < 0.5 ? 1.0 : 1.0 + 2.0 * unit(random);
  t.time_ratio = unit(random) < 0.4 ? 1.0 : 1.0 + 0.4 * unit(random);
  return t;
}

TEST(Synthesis, FourBarsHaveTheirStrokeAndNoneFoundByChanceIsBetter) {
  std::mt19937_64 random(20261127);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int found = 0, rivals = 0, close = 0;
  for (int n = 0; n < 200; ++n) {
    const StrokeTarget t = random_target(random);
    SCOPED_TRACE(std::to_string(n) + ": stroke " + std::to_string(t.stroke / degree) + ", shortest " +
                 std::to_string(t.shortest / t.envelope) + ", ratio " + std::to_string(t.stroke_ratio) + ", times " +
                 std::to_string(t.time_ratio));
    const SynthesisedMechanism s = synthesise_four_bar(t);
    const double swing = t.stroke / t.stroke_ratio;
    if (s.found) {
      ++found;
      const Links k = links_of(s.transmission);
      const Measured m = measured(k);
      ASSERT_TRUE(m.turns);
      EXPECT_NEAR(m.swing, swing, 1e-5);
      EXPECT_NEAR(swing_of(k), swing, 1e-10);
      EXPECT_NEAR(s.quality.stroke, t.stroke, 1e-10);
      EXPECT_NEAR(m.angle, s.quality.transmission_angle, 1e-5);
      EXPECT_NEAR(m.time_ratio, s.quality.time_ratio, 2e-3);
      EXPECT_LE(s.quality.time_ratio, t.time_ratio + 1e-8);
      EXPECT_NEAR(m.envelope / t.envelope, 1.0, 1e-3);
      EXPECT_NEAR(s.quality.envelope / t.envelope, 1.0, 1e-12);
      EXPECT_GE(k.r, t.shortest * (1.0 - 1e-8));
    }
    // Links by chance, the crank by bisection for the stroke.
    const double best = s.found ? s.quality.transmission_angle : transmission_angle_min_deg * degree;
    double rival = 0.0;
    for (int trial = 0; trial < 4000; ++trial) {
      // Some beside what was found, where a better one would be if it were no optimum.
      Links k = links_of(s.transmission);
      const bool beside = s.found && trial % 2 == 0;
      const double spread = std::pow(10.0, -1.0 - 4.0 * unit(random));
      if (beside) {
        k.l *= 1.0 + spread * (unit(random) - 0.5);
        k.p *= 1.0 + spread * (unit(random) - 0.5);
      } else {
        k = {0.0, std::exp(4.0 * (unit(random) - 0.5)), std::exp(4.0 * (unit(random) - 0.5)), 1.0};
      }
      double low = 0.0, high = std::min({k.l, k.p, k.d, std::abs(k.l + k.p - k.d)});
      for (int step = 0; step < 60; ++step) {
        k.r = 0.5 * (low + high);
        const double here = swing_of(k);
        (std::isnan(here) || here > swing ? high : low) = k.r;
      }
      if (!(std::abs(swing_of(k) - swing) < 1e-9) || least_angle(k) <= rival) continue;
      const double reach = k.l + k.r, inner = k.l - k.r;
      const auto pin = [&](double to) {
        return std::acos(std::clamp((k.d * k.d + to * to - k.p * k.p) / (2.0 * k.d * to), -1.0, 1.0));
      };
      const double quick = std::abs(pin(reach) - pin(inner));
      const double chord = swing < pi ? 2.0 * std::sin(0.5 * swing) : 2.0;
      const double extent = std::max({k.l + 2.0 * k.r, k.d + k.r, k.p, k.p * chord});
      // Of targets with half-strokes alike none is met by chance: there those within a thousandth count.
      const double allowed = std::max(pi * (t.time_ratio - 1.0) / (t.time_ratio + 1.0), 1e-3);
      if (quick <= allowed && k.r >= t.shortest / t.envelope * extent) rival = least_angle(k);
    }
    if (rival > 0.0) ++rivals;
    if (rival > best - 0.01) ++close;
    EXPECT_LE(rival, best + (t.time_ratio < 1.001 ? 2e-3 : 1e-6));
  }
  EXPECT_GT(found, 120);
  EXPECT_GT(rivals, 100);
  EXPECT_GT(close, 60);
}

TEST(Synthesis, WhatIsRefusedSaysWhichStrokeRatioWouldDo) {
  StrokeTarget t{};
  t.stroke = 150.0 * degree;
  t.envelope = 0.02;
  t.transmission_angle = 40.0 * degree;
  const SynthesisedMechanism s = synthesise_four_bar(t);
  EXPECT_FALSE(s.found);
  EXPECT_LT(s.quality.transmission_angle, 15.0 * degree);
  ASSERT_GT(s.ratio_needed, 1.5);
  t.stroke_ratio = s.ratio_needed;
  const SynthesisedMechanism enough = synthesise_four_bar(t);
  EXPECT_TRUE(enough.found);
  EXPECT_NEAR(enough.quality.transmission_angle, 40.0 * degree, 0.1 * degree);
  t.stroke_ratio = 0.98 * s.ratio_needed;
  EXPECT_FALSE(synthesise_four_bar(t).found);
  for (const StrokeRatioChoice& r : s.ratios) {
    t.stroke_ratio = r.stroke_ratio;
    t.transmission_angle = 0.0;
    const SynthesisedMechanism other = synthesise_four_bar(t);
    if (other.found) {
      EXPECT_NEAR(other.quality.transmission_angle, r.transmission_angle, 1e-12);
    }
  }
}

// With half-strokes alike r_c^2 + d^2 = l^2 + p^2 and r_c = p sin(swing/2).
TEST(Synthesis, HalfStrokesAlikeFollowTheKnownRelations) {
  StrokeTarget t{};
  t.stroke = 80.0 * degree;
  t.envelope = 0.03;
  const SynthesisedMechanism s = synthesise_four_bar(t);
  ASSERT_TRUE(s.found);
  const Links k = links_of(s.transmission);
  EXPECT_NEAR((k.r * k.r + k.d * k.d) / (k.l * k.l + k.p * k.p), 1.0, 1e-12);
  EXPECT_NEAR(k.r / (k.p * std::sin(40.0 * degree)), 1.0, 1e-12);
  EXPECT_NEAR(std::cos(s.quality.transmission_angle), k.r * k.d / (k.l * k.p), 1e-12);
  EXPECT_NEAR(s.quality.time_ratio, 1.0, 1e-12);
}

TEST(Synthesis, SliderCranksHaveTheLongestRodThatFits) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int found = 0;
  for (int n = 0; n < 200; ++n) {
    StrokeTarget t{};
    t.stroke = (10.0 + 160.0 * unit(random)) * degree;
    t.envelope = 0.02 + 0.02 * unit(random);
    t.shortest = t.envelope * (0.03 + 0.2 * unit(random));
    const SynthesisedMechanism s = synthesise_slider_crank(t);
    const auto fits = [&](double r, double l, double H) {
      double extent = 2.0 * H;
      for (int a = 0; a < 360; ++a) {
        const Complex pin = std::polar(r, two_pi * a / 360.0);
        for (const double slider : {l + r, l - r}) extent = std::max(extent, std::abs(pin - Complex(0.0, slider)));
        extent = std::max(extent, std::abs(pin - Complex(H, l)));
      }
      return extent <= t.envelope * (1.0 + 1e-4);
    };
    double rival = 0.0;
    for (int trial = 0; trial < 500; ++trial) {
      const double r = t.shortest * (1.0 + 3.0 * square(unit(random))), H = r / std::tan(0.5 * t.stroke);
      const double l = r + (t.envelope - r) * unit(random);
      if (H >= t.shortest && fits(r, l, H)) rival = std::max(rival, std::acos(r / l));
    }
    if (!s.found) {
      EXPECT_EQ(rival, 0.0);
      continue;
    }
    ++found;
    const TransmissionDesign<double>& k = s.transmission;
    EXPECT_TRUE(fits(k.crank_radius, k.rod_length, *k.hinge_offset));
    EXPECT_NEAR(2.0 * std::atan(k.crank_radius / *k.hinge_offset), t.stroke, 1e-12);
    EXPECT_NEAR(s.quality.stroke, t.stroke, 1e-9);
    EXPECT_LE(rival, s.quality.transmission_angle + 1e-4);
    EXPECT_EQ(s.quality.time_ratio, 1.0);
  }
  EXPECT_GT(found, 100);
}

/// Stroke angle with the four joints displaced by vectors of length c or less.
double displaced_stroke(const Links& k, double theta, double c, double middle, double stroke_ratio,
                        const std::array<Complex, 4>& by) {
  const Complex pin = c * by[0] + std::polar(k.r, theta) + c * by[1], axis = k.d + c * by[3];
  const Complex between = axis - pin;
  // The rocker's pin on its circle, the coupler's end displaced from it.
  const Complex shifted = between - c * by[2];
  const double D = std::abs(shifted), a = (D * D + k.l * k.l - k.p * k.p) / (2.0 * D);
  const Complex q = pin + shifted / D * Complex(a, std::sqrt(k.l * k.l - a * a)) + c * by[2];
  return stroke_ratio * (std::arg(q - axis) - middle);
}

TEST(Synthesis, PlayIsWhatDisplacedJointsAllow) {
  StrokeTarget t{};
  t.stroke = 110.0 * degree;
  t.envelope = 0.02;
  t.stroke_ratio = 1.6;
  t.time_ratio = 1.1;
  const SynthesisedMechanism s = synthesise_four_bar(t);
  ASSERT_TRUE(s.found);
  const double c = 2e-5;
  const ClearanceCost cost = clearance_cost(s.transmission, c);
  const Links k = links_of(s.transmission);
  const double middle = centred_ground_angle(FourBar<double>::from(s.transmission));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double low = 1e9, high = -1e9, inner_low = 1e9, inner_high = -1e9, widest = 0.0;
  for (int n = 0; n < 720; ++n) {
    const double theta = two_pi * n / 720.0;
    // Along the coupler, both ways, as joints that all give way to one force.
    const Complex coupler = rocker_pin(k, theta) - std::polar(k.r, theta), e = coupler / std::abs(coupler);
    const double a = displaced_stroke(k, theta, c, middle, t.stroke_ratio, {e, e, e, -e});
    const double b = displaced_stroke(k, theta, c, middle, t.stroke_ratio, {-e, -e, -e, e});
    widest = std::max(widest, std::abs(a - b));
    low = std::min({low, a, b});
    high = std::max({high, a, b});
    inner_low = std::min(inner_low, std::max(a, b));
    inner_high = std::max(inner_high, std::min(a, b));
    for (int trial = 0; trial < 50; ++trial) {
      std::array<Complex, 4> by;
      for (Complex& x : by) x = std::polar(std::sqrt(unit(random)), two_pi * unit(random));
      const double x = displaced_stroke(k, theta, c, middle, t.stroke_ratio, by);
      EXPECT_LE(x, std::max(a, b) + 1e-5);
      EXPECT_GE(x, std::min(a, b) - 1e-5);
    }
  }
  EXPECT_NEAR((high - low) / cost.stroke_highest, 1.0, 1e-4);
  EXPECT_NEAR((inner_high - inner_low) / cost.stroke_lowest, 1.0, 1e-4);
  EXPECT_NEAR(widest / cost.play_highest, 1.0, 2e-3);
  EXPECT_LT(cost.play, cost.play_highest);
  EXPECT_GT(cost.stroke_highest, t.stroke);
  EXPECT_LT(cost.stroke_lowest, t.stroke);
  // To first order: all play over the rocker's lever.
  const ClearanceCost little = clearance_cost(s.transmission, 1e-9);
  EXPECT_NEAR(little.play / 1e-9, cost.play / c, 1e-2 * cost.play / c);
  EXPECT_EQ(clearance_cost(s.transmission, 0.0).play, 0.0);
  EXPECT_THROW(clearance_cost(s.transmission, 1e-3), ParameterError);
}

TEST(Synthesis, PlayOfASliderCrank) {
  TransmissionDesign<double> d;
  d.crank_radius = 2e-3;
  d.rod_length = 12e-3;
  d.hinge_offset = 2.5e-3;
  const double c = 1e-5;
  const ClearanceCost cost = clearance_cost(d, c);
  // At the dead centres all joints are in line: the slider is 5 c higher or lower.
  const auto reach = [&](double y) { return std::atan(y / 2.5e-3); };
  EXPECT_NEAR(cost.stroke_highest, 2.0 * reach(2e-3 + 5.0 * c), 1e-12);
  EXPECT_NEAR(cost.stroke_lowest, 2.0 * reach(2e-3 - 5.0 * c), 1e-12);
  const double cos_gamma = std::sqrt(1.0 - square(2.0 / 12.0));
  EXPECT_NEAR(cost.play, (6.0 / cos_gamma + 4.0) * c / 2.5e-3, 1e-2 * cost.play);
}

TEST(Synthesis, TargetsOutOfRangeAreRefused) {
  StrokeTarget t{};
  t.stroke = 1.0;
  t.envelope = 0.02;
  const auto refused = [](StrokeTarget target, auto change) {
    change(target);
    EXPECT_THROW(synthesise_four_bar(target), ParameterError);
  };
  EXPECT_TRUE(synthesise_four_bar(t).found);
  refused(t, [](StrokeTarget& x) { x.stroke = 0.0; });
  refused(t, [](StrokeTarget& x) { x.stroke = 7.0; });
  refused(t, [](StrokeTarget& x) { x.envelope = -1.0; });
  refused(t, [](StrokeTarget& x) { x.shortest = 0.03; });
  refused(t, [](StrokeTarget& x) { x.stroke_ratio = 0.0; });
  refused(t, [](StrokeTarget& x) { x.time_ratio = 0.9; });
  refused(t, [](StrokeTarget& x) { x.transmission_angle = 2.0; });
  t.stroke_ratio = 2.0;
  EXPECT_THROW(synthesise_slider_crank(t), ParameterError);
  t.stroke = 4.0;
  t.stroke_ratio = 1.0;
  EXPECT_FALSE(synthesise_four_bar(t).found);
  TransmissionDesign<double> direct;
  direct.type = TransmissionType::direct;
  EXPECT_THROW(mechanism_quality(direct), ParameterError);
}

}  // namespace
}  // namespace wingbeat

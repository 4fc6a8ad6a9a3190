#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "parts/expect_error.hpp"
#include "parts/outline.hpp"
#include "wingbeat/parts/planform.hpp"

namespace wingbeat {
namespace {

constexpr double R = 63e-3, c_0 = 25e-3;

/// integral over the wing of chord(x) (x + offset)^power dx by Simpson's rule in the angle of x = R sin(angle), in
/// which the elliptic tip is smooth.
template <class Chord>
double moment(const Chord& chord, double offset, int power) {
  constexpr int intervals = 2000;
  double sum = 0.0;
  for (int n = 0; n <= intervals; ++n) {
    const double angle = 0.5 * pi * n / intervals;
    const double x = R * std::sin(angle);
    const double weight = n == 0 || n == intervals ? 1.0 : (n % 2 == 1 ? 4.0 : 2.0);
    sum += weight * chord(x, angle) * std::pow(x + offset, power) * R * std::cos(angle);
  }
  return sum * 0.5 * pi / intervals / 3.0;
}

TEST(Planform, SemiEllipseWithoutOffsetHasItsClosedForm) {
  const auto m = one_wing_moments(outline_of(PlanformShape::semi_ellipse, 0.0, R, c_0));
  EXPECT_DOUBLE_EQ(m.s2, pi * c_0 * R * R * R / 16.0);
  EXPECT_DOUBLE_EQ(m.s3, 2.0 * c_0 * R * R * R * R / 15.0);
}

TEST(Planform, SemiEllipseWithOffsetAgreesWithQuadrature) {
  for (const double offset : {0.0, 2e-3, 8e-3, 30e-3}) {
    const auto m = one_wing_moments(outline_of(PlanformShape::semi_ellipse, offset, R, c_0));
    const auto chord = [](double, double angle) { return c_0 * std::cos(angle); };
    EXPECT_NEAR(m.s2, moment(chord, offset, 2), 1e-11 * m.s2);
    EXPECT_NEAR(m.s3, moment(chord, offset, 3), 1e-11 * m.s3);
  }
}

TEST(Planform, RectangleHasItsClosedForm) {
  for (const double d : {0.0, 8e-3}) {
    const auto m = one_wing_moments(outline_of(PlanformShape::rectangle, d, R, c_0));
    EXPECT_NEAR(m.s2, c_0 * (std::pow(R + d, 3) - std::pow(d, 3)) / 3.0, 1e-14 * m.s2);
    EXPECT_NEAR(m.s3, c_0 * (std::pow(R + d, 4) - std::pow(d, 4)) / 4.0, 1e-14 * m.s3);
  }
}

TEST(Planform, TabulatedRectangleIsTheRectangle) {
  for (const double d : {0.0, 8e-3}) {
    Planform<double> p = outline_of(PlanformShape::tabulated, d, R, c_0);
    p.chord_table = {{0.0, c_0}, {0.2 * R, c_0}, {R, c_0}};
    const auto m = one_wing_moments(p), exact = one_wing_moments(outline_of(PlanformShape::rectangle, d, R, c_0));
    EXPECT_NEAR(m.s2, exact.s2, 1e-14 * exact.s2);
    EXPECT_NEAR(m.s3, exact.s3, 1e-14 * exact.s3);
  }
}

TEST(Planform, TabulatedTriangleIsExact) {
  Planform<double> p = outline_of(PlanformShape::tabulated, 0.0, R, c_0);
  p.chord_table = {{0.0, c_0}, {R, 0.0}};
  const auto m = one_wing_moments(p);
  EXPECT_NEAR(m.s2, c_0 * std::pow(R, 3) / 12.0, 1e-14 * m.s2);
  EXPECT_NEAR(m.s3, c_0 * std::pow(R, 4) / 20.0, 1e-14 * m.s3);
}

TEST(Planform, TableThatStartsOutboardLeavesTheRootEmpty) {
  Planform<double> whole = outline_of(PlanformShape::rectangle, 0.0, R, c_0), inner = whole,
                   outer = outline_of(PlanformShape::tabulated, 0.0, R, c_0);
  inner.length = 0.25 * R;
  outer.chord_table = {{0.25 * R, c_0}, {R, c_0}};
  const auto a = one_wing_moments(whole), b = one_wing_moments(inner), c = one_wing_moments(outer);
  EXPECT_NEAR(c.s2, a.s2 - b.s2, 1e-14 * a.s2);
  EXPECT_NEAR(c.s3, a.s3 - b.s3, 1e-14 * a.s3);
}

TEST(Planform, TabulatedChordConvergesToTheSemiEllipse) {
  const auto exact = one_wing_moments(outline_of(PlanformShape::semi_ellipse, 5e-3, R, c_0));
  double before = 1.0;
  for (const int rows : {100, 200, 400, 800}) {
    Planform<double> p = outline_of(PlanformShape::tabulated, 5e-3, R, c_0);
    for (int n = 0; n <= rows; ++n) {
      const double x = double(n) / rows;
      p.chord_table.push_back({R * x, c_0 * std::sqrt(1.0 - x * x)});
    }
    const auto m = one_wing_moments(p);
    const double error = std::max(std::abs(m.s2 / exact.s2 - 1.0), std::abs(m.s3 / exact.s3 - 1.0));
    // The vertical tangent at the tip limits the order to 3/2.
    EXPECT_LT(error, 0.4 * before) << rows;
    before = error;
  }
  EXPECT_LT(before, 1e-4);
}

TEST(Planform, MomentsOfAllWingsCountThem) {
  const auto p = outline_of(PlanformShape::semi_ellipse, 3e-3, R, c_0);
  const auto one = one_wing_moments(p), four = chord_moments(p, 4.0);
  EXPECT_DOUBLE_EQ(four.s2, 4.0 * one.s2);
  EXPECT_DOUBLE_EQ(four.s3, 4.0 * one.s3);
}

TEST(Planform, MomentsGivenOutrightAreThoseOfAllWings) {
  Planform<double> p;
  p.s2 = 2.457e-6;
  p.s3 = 1.048e-7;
  const auto m = chord_moments(p, 2.0);
  EXPECT_EQ(m.s2, 2.457e-6);
  EXPECT_EQ(m.s3, 1.048e-7);
}

TEST(Planform, PaperVehiclesMomentsAreThoseOfItsEquivalentSemiEllipse) {
  const auto m = chord_moments(outline_of(PlanformShape::semi_ellipse, 0.0, R, c_0), 2.0);
  EXPECT_NEAR(m.s2, 2.457e-6, 0.01 * m.s2);
  EXPECT_NEAR(m.s3, 1.048e-7, 0.01 * m.s3);
}

/// Integrals over an outline whose lengths are each multiplied by `scale`, sampled between its rows: of chord^m r^n.
double scaled_moment(const Planform<double>& p, double scale, int chord_power, int radius_power) {
  std::vector<std::pair<double, double>> rows;  // where the chord is smooth in between
  if (p.shape == PlanformShape::tabulated) {
    for (const auto& [x, chord] : p.chord_table) rows.emplace_back(scale * x, scale * chord);
  } else {
    rows = {{0.0, scale * p.root_chord}, {scale * p.length, scale * p.root_chord}};
  }
  const double length = rows.back().first;
  const auto chord_at_distance = [&](double x) {
    if (p.shape == PlanformShape::rectangle) return scale * p.root_chord;
    if (p.shape == PlanformShape::semi_ellipse) {
      return scale * p.root_chord * std::sqrt(std::max(0.0, 1.0 - (x / length) * (x / length)));
    }
    std::size_t n = 1;
    while (n + 1 < rows.size() && rows[n].first < x) ++n;
    const auto [x0, c0] = rows[n - 1];
    const auto [x1, c1] = rows[n];
    return c0 + (c1 - c0) * (x - x0) / (x1 - x0);
  };
  double sum = 0.0;
  for (std::size_t n = 1; n < rows.size(); ++n) {
    // The midpoint rule in an angle, in which an elliptic tip is smooth.
    constexpr int intervals = 20000;
    const double from = std::asin(rows[n - 1].first / length), to = std::asin(rows[n].first / length);
    for (int k = 0; k < intervals; ++k) {
      const double angle = from + (to - from) * (k + 0.5) / intervals, x = length * std::sin(angle);
      sum += std::pow(chord_at_distance(x), chord_power) * std::pow(x + scale * p.hub_offset, radius_power) * length *
             std::cos(angle) * (to - from) / intervals;
    }
  }
  return sum;
}

TEST(Planform, TheScaleMultipliesAllLengthsOfTheOutline) {
  for (const PlanformShape shape : {PlanformShape::semi_ellipse, PlanformShape::rectangle, PlanformShape::tabulated}) {
    for (const double offset : {0.0, 7e-3}) {
      for (const double scale : {0.6, 1.0, 1.7}) {
        Planform<double> p = outline_of(shape, offset, R, c_0);
        if (shape == PlanformShape::tabulated)
          p.chord_table = {{2e-3, 20e-3}, {0.4 * R, c_0}, {0.7 * R, 18e-3}, {R, 2e-3}};
        p.scale = scale;
        const double N = 2.0;
        const auto expect = [&](double value, int m, int n) {
          const double integral = N * scaled_moment(p, scale, m, n);
          EXPECT_NEAR(value, integral, 1e-8 * integral) << name_of(shape) << " " << m << n;
        };
        expect(chord_moments(p, N).s2, 1, 2);
        expect(chord_moments(p, N).s3, 1, 3);
        expect(first_chord_moment(p, N), 1, 1);
        expect(squared_chord_moment(p, N), 2, 2);
        expect(N * wing_area(p), 1, 0);
        const PitchChordMoments<double> pitch = pitch_chord_moments(p, N);
        expect(pitch.s21, 2, 1);
        expect(pitch.s22, 2, 2);
        expect(pitch.s30, 3, 0);
        expect(pitch.s31, 3, 1);
        expect(pitch.s40, 4, 0);
        EXPECT_DOUBLE_EQ(length_of(p), scale * R);
        EXPECT_DOUBLE_EQ(hub_offset_of(p), scale * offset);
        Planform<double> unscaled = p;
        unscaled.scale = 1.0;
        EXPECT_NEAR(chord_at(p, 0.55), scale * chord_at(unscaled, 0.55), 1e-15);
      }
    }
  }
}

TEST(Planform, MomentsGivenOutrightGrowWithTheScale) {
  Planform<double> p;
  p.s2 = 2.457e-6, p.s3 = 1.048e-7, p.s22 = 4e-8;
  p.scale = 1.3;
  EXPECT_NEAR(chord_moments(p, 2.0).s2, std::pow(1.3, 4) * 2.457e-6, 1e-20);
  EXPECT_NEAR(chord_moments(p, 2.0).s3, std::pow(1.3, 5) * 1.048e-7, 1e-21);
  EXPECT_NEAR(squared_chord_moment(p, 2.0), std::pow(1.3, 5) * 4e-8, 1e-21);
}

TEST(Planform, RefusesShapesOutOfRange) {
  using P = Planform<double>;
  const P ellipse = outline_of(PlanformShape::semi_ellipse, 0.0, R, c_0);
  EXPECT_NO_THROW(validate(ellipse));
  EXPECT_EQ(refusal(ellipse, [](P& p) { p.length = 0.0; }), "wing.planform.length: must be > 0 [m], got 0");
  EXPECT_EQ(refusal(ellipse, [](P& p) { p.root_chord = -0.025; }),
            "wing.planform.root_chord: must be > 0 [m], got -0.025 (-25 mm)");
  EXPECT_EQ(refusal(ellipse, [](P& p) { p.hub_offset = -1e-3; }),
            "wing.planform.hub_offset: must be >= 0 [m], got -0.001 (-1 mm)");
  EXPECT_EQ(refusal(ellipse, [](P& p) { p.scale = 0.0; }), "wing.planform.scale: must be > 0 [1], got 0");
  EXPECT_EQ(refusal(P{}, [](P& p) { p.s2 = -1.0; }), "wing.planform.s2: must be >= 0 [m4], got -1");
  EXPECT_EQ(refusal(P{}, [](P& p) { p.s3 = std::nan(""); }), "wing.planform.s3: must be >= 0 [m5], got nan");

  const auto table_refusal = [](std::vector<std::pair<double, double>> rows) {
    return refusal(outline_of(PlanformShape::tabulated, 0.0, R, c_0), [&](P& p) { p.chord_table = rows; });
  };
  EXPECT_EQ(table_refusal({{0.0, 1.0}, {1.0, 0.0}}), "no error");
  EXPECT_EQ(table_refusal({{0.0, 1.0}}), "wing.planform.file: the chord table needs at least two rows");
  EXPECT_EQ(table_refusal({{0.0, 1.0}, {1.0, -1.0}}),
            "wing.planform.file: row 2 of the chord table must hold a distance and a chord >= 0");
  EXPECT_EQ(table_refusal({{-0.1, 1.0}, {1.0, 1.0}}),
            "wing.planform.file: row 1 of the chord table must hold a distance and a chord >= 0");
  EXPECT_EQ(table_refusal({{0.0, 1.0}, {1.0, 1.0}, {1.0, 0.5}}),
            "wing.planform.file: row 3 of the chord table must lie farther from the root than the row before it");
}

}  // namespace
}  // namespace wingbeat

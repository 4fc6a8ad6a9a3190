#include "wingbeat/parts/stroke_table.hpp"

#include <gtest/gtest.h>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {
namespace {

static_assert(Transmission<StrokeTable<double>, double>);
static_assert(Transmission<StrokeTable<Jet<2>>, Jet<2>>);

using Rows = std::vector<std::pair<double, double>>;

double law(double theta) { return 0.1 + 0.7 * std::sin(theta) + 0.1 * std::cos(2.0 * theta); }

Rows sampled(int count, double first = 0.0) {
  Rows rows;
  for (int n = 0; n < count; ++n) rows.emplace_back(first + two_pi * n / count, law(first + two_pi * n / count));
  return rows;
}

StrokeTable<double> table_of(Rows rows, double scale = 1.0) {
  return {std::make_shared<StrokeCurve>(std::move(rows)), scale, 8e-3};
}

CrankKinematics<double> at(const StrokeTable<double>& t, double theta) {
  return crank_kinematics(t, std::sin(theta), std::cos(theta));
}

std::string refusal_of(Rows rows) {
  try {
    table_of(std::move(rows));
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "";
}

// Of sixth order in the angle, fifth in the slope, fourth in the curvature.
TEST(StrokeTable, ConvergesToTheLawThatItSamples) {
  double before[3] = {};
  for (const int count : {20, 40, 80}) {
    const StrokeTable<double> t = table_of(sampled(count, 0.3));
    double off[3] = {};
    for (double theta = -1.0; theta < 7.0; theta += 0.013) {
      const CrankKinematics<double> k = at(t, theta);
      off[0] = std::max(off[0], std::abs(stroke_angle(k) - law(theta)));
      off[1] = std::max(off[1], std::abs(k.stroke_slope - 0.7 * std::cos(theta) + 0.2 * std::sin(2.0 * theta)));
      off[2] =
          std::max(off[2], std::abs(k.stroke_second_derivative + 0.7 * std::sin(theta) + 0.4 * std::cos(2.0 * theta)));
    }
    const double order[3] = {6.0, 5.0, 4.0};
    for (int n = 0; n < 3; ++n) {
      if (before[n] > 0.0) {
        EXPECT_NEAR(std::log2(before[n] / off[n]), order[n], 0.25) << n << " with " << count;
      }
      before[n] = off[n];
    }
  }
  EXPECT_LT(before[0], 1e-8);
}

TEST(StrokeTable, HasFourContinuousDerivativesAtEveryRow) {
  const Rows rows = sampled(12, 0.2);
  const StrokeTable<double> t = table_of(rows, 1.5);
  for (const auto& [theta, beta] : rows) {
    EXPECT_NEAR(stroke_angle(at(t, theta)), 1.5 * beta, 1e-14);
    // Differences to either side tell derivatives three and four; a jump would not fall with the step.
    const double h = 1e-3;
    const auto curve = [&t, here = theta](double by) { return at(t, here + by).stroke_second_derivative; };
    EXPECT_NEAR(curve(-1e-12), curve(1e-12), 1e-10);
    const double left = (curve(0.0) - curve(-h)) / h, right = (curve(h) - curve(0.0)) / h;
    EXPECT_NEAR(left, right, 5.0 * h);
    const double left2 = (curve(0.0) - 2.0 * curve(-h) + curve(-2.0 * h)) / (h * h);
    const double right2 = (curve(2.0 * h) - 2.0 * curve(h) + curve(0.0)) / (h * h);
    EXPECT_NEAR(left2, right2, 50.0 * h);
  }
}

TEST(StrokeTable, FrictionActsAtTheReferenceRadiusAndPowerIsConserved) {
  const StrokeTable<double> t = table_of(sampled(36));
  for (double theta = 0.0; theta < two_pi; theta += 0.1) {
    const CrankKinematics<double> k = at(t, theta);
    EXPECT_EQ(k.wing_jacobian, 8e-3);
    EXPECT_DOUBLE_EQ(k.crank_jacobian, 8e-3 * k.stroke_slope);
  }
}

TEST(StrokeTable, ReversalsAndAmplitude) {
  const StrokeTable<double> t = table_of(sampled(90, 0.1));
  const Reversals known = reversals(t), found = find_reversals(t);
  ASSERT_EQ(known.count, found.count);
  EXPECT_EQ(known.first_sign, found.first_sign);
  double high = -10.0, low = 10.0;
  for (std::size_t n = 0; n < known.count; ++n) {
    EXPECT_NEAR(known.angle[n], found.angle[n], 1e-13);
    high = std::max(high, stroke_angle(at(t, known.angle[n])));
    low = std::min(low, stroke_angle(at(t, known.angle[n])));
  }
  EXPECT_NEAR(stroke_amplitude(t), 0.5 * (high - low), 1e-14);
  EXPECT_NEAR(stroke_reach(t), std::max(high, -low), 1e-14);
  // Rows on the reversals themselves.
  EXPECT_EQ(reversals(table_of(sampled(360))).count, find_reversals(table_of(sampled(360))).count);
  // A reversal at crank angle zero itself is not listed, and the stroke begins with the sign after it.
  Rows cosine;
  for (int n = 0; n < 36; ++n) cosine.emplace_back(two_pi * n / 36, std::cos(two_pi * n / 36));
  const Reversals r = reversals(table_of(cosine));
  ASSERT_EQ(r.count, 1u);
  EXPECT_NEAR(r.angle[0], pi, 1e-12);
  EXPECT_EQ(r.first_sign, -1.0);
}

TEST(StrokeTable, DualNumbersAgreeWithDifferences) {
  using J = Jet<2>;
  const StrokeTable<double> t = table_of(sampled(30), 1.2);
  StrokeTable<J> dual = cast<J>(t);
  dual.scale.v[1] = 1.0;
  for (double theta = 0.07; theta < two_pi; theta += 0.31) {
    const J angle(theta, 0);
    const auto k = crank_kinematics(dual, J(sin(angle)), J(cos(angle)));
    const CrankKinematics<double> now = at(t, theta), before = at(t, theta - 1e-5), after = at(t, theta + 1e-5);
    EXPECT_NEAR(stroke_angle(k).v[0], now.stroke_slope, 1e-13);
    EXPECT_NEAR(k.stroke_slope.v[0], now.stroke_second_derivative, 1e-13);
    EXPECT_NEAR(k.stroke_second_derivative.v[0],
                (after.stroke_second_derivative - before.stroke_second_derivative) / 2e-5, 1e-6);
    EXPECT_NEAR(stroke_angle(k).v[1], stroke_angle(now) / 1.2, 1e-13);
  }
}

TEST(StrokeTable, RefusesWhatIsNoStroke) {
  EXPECT_EQ(refusal_of({{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}}), "transmission.stroke_table: needs at least four rows");
  EXPECT_EQ(
      refusal_of({{0.0, 0.0}, {1.0, 1.0}, {1.0, 0.0}, {2.0, 0.0}}),
      "transmission.stroke_table: row 3 of the stroke table must have a larger crank angle than the row before it");
  EXPECT_EQ(refusal_of({{0.0, 0.0}, {1.0, 1.0}, {3.0, 0.0}, {two_pi, 0.0}}),
            "transmission.stroke_table: row 4 of the stroke table is a full turn after the first: the table is "
            "periodic, leave it out");
  EXPECT_EQ(refusal_of({{0.0, 0.5}, {1.0, 0.5}, {3.0, 0.5}, {4.0, 0.5}}),
            "transmission.stroke_table: the stroke angle must vary over the turn");
  Rows noisy;
  for (int n = 0; n < 40; ++n) noisy.emplace_back(two_pi * n / 40, n % 2);
  EXPECT_EQ(
      refusal_of(noisy),
      "transmission.stroke_table: the stroke turns 39 times in a turn of the crank, at most 8 are allowed: smooth "
      "the table");
}

}  // namespace
}  // namespace wingbeat

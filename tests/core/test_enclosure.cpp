#include "wingbeat/core/enclosure.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "wingbeat/core/certain.hpp"

namespace wingbeat {
namespace {

/// With every operation; smooth but for kinks at zeros of the cosine.
template <class S>
S expression(const S& sine, const S& cosine) {
  using std::abs;
  using std::atan;
  using std::max;
  using std::sqrt;
  const S x = atan(S(3.0) * sine) + square(cosine) / (S(2.0) + sine);
  return sqrt(S(2.0) + x * cosine) - max(abs(cosine), S(0.3)) * inverse_of(S(1.5) - sine);
}

double at(double angle) { return expression(std::sin(angle), std::cos(angle)); }

Enclosure over(double from, double to) {
  const CircleArc arc = circle_arc(from, to);
  return expression(arc.sine, arc.cosine);
}

TEST(Enclosure, HoldsValuesAndSlopesOfEveryArgument) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(-7.0, 7.0), exponent(-8.0, 0.7);
  for (int n = 0; n < 2000; ++n) {
    const double from = angle(random), to = from + std::exp(std::log(10.0) * exponent(random));
    const Enclosure e = over(from, to);
    for (int k = 0; k < 10; ++k) {
      const double x = from + (to - from) * (k + 0.5) / 10.0, step = 1e-6;
      EXPECT_GE(at(x), e.value.low - 1e-14);
      EXPECT_LE(at(x), e.value.high + 1e-14);
      if (to - from < 4.0 * step) continue;
      const double slope = (at(x + step) - at(x - step)) / (2.0 * step);
      const Enclosure beside = over(from - step, to + step);
      EXPECT_GE(slope, beside.slope.low - 1e-8);
      EXPECT_LE(slope, beside.slope.high + 1e-8);
    }
  }
}

TEST(Enclosure, ShrinksWithItsRange) {
  for (const double x : {0.3, 1.0, 2.5, 4.0}) EXPECT_LT(over(x, x + 1e-6).value.width(), 1e-4);
}

TEST(Enclosure, OfAQuotientByZeroIsEverything) {
  const Enclosure all = Enclosure(1.0) / circle_arc(-0.1, 0.1).sine;
  EXPECT_EQ(all.value.low, -infinity);
  EXPECT_EQ(all.value.high, infinity);
  const Enclosure none = all * Enclosure(0.0);
  EXPECT_TRUE(none.value.contains(0.0));
}

/// A bump of the width 1e-5 that no grid would meet, at `peak`, over a slow wave.
struct Bump {
  double peak, height;
  double operator()(double x) const { return std::cos(x) + 2.0 - height / (1.0 + square((x - peak) * 1e5)); }
  Enclosure over(double from, double to) const {
    const Enclosure off({(from - peak) * 1e5, (to - peak) * 1e5}, Interval(1e5));
    return circle_arc(from, to).cosine + Enclosure(2.0) - Enclosure(height) / (Enclosure(1.0) + square(off));
  }
};

TEST(SignCuts, FindsBothEndsOfANarrowInterval) {
  const Bump f{1.2345678, 4.0};
  const auto cuts = sign_cuts(f, [&](double a, double b) { return f.over(a, b); }, 0.0, two_pi);
  ASSERT_EQ(cuts.size(), 2u);
  EXPECT_LT(cuts[0], f.peak);
  EXPECT_GT(cuts[1], f.peak);
  EXPECT_LT(cuts[1] - cuts[0], 3e-5);
  for (const double cut : cuts) EXPECT_NEAR(f(cut), 0.0, 1e-9);
}

TEST(SignCuts, NoneWhereTheBumpStaysClear) {
  const Bump f{1.2345678, 2.3};
  EXPECT_GT(f(f.peak), 0.0);
  EXPECT_TRUE(sign_cuts(f, [&](double a, double b) { return f.over(a, b); }, 0.0, two_pi).empty());
}

TEST(SignCuts, OfATouchingFunctionTheAngleWhereItTouches) {
  const auto f = [](double x) { return 1.0 - std::sin(x); };
  const auto cuts =
      sign_cuts(f, [](double a, double b) { return Enclosure(1.0) - circle_arc(a, b).sine; }, 0.0, two_pi);
  ASSERT_FALSE(cuts.empty());
  for (const double cut : cuts) EXPECT_NEAR(cut, 0.5 * pi, 1e-7);
}

TEST(LeastValue, IsExactBelowTheLimitAndCertainAboveIt) {
  const Bump f{4.321, 3.0};
  const auto enclose = [&](double a, double b) { return f.over(a, b); };
  const Minimum exact = least_value(f, enclose, 0.0, two_pi, 1.0, 1e-12, {0.0, f(0.0)});
  EXPECT_NEAR(exact.argument, f.peak, 1e-8);
  EXPECT_NEAR(exact.value, f(f.peak), 1e-8);  // over a range of 1e-8 the bump changes by as much
  const Minimum far = least_value(f, enclose, 0.0, two_pi, -2.0, 1e-12, {0.0, f(0.0)});
  EXPECT_GT(far.value, -2.0);
}

}  // namespace
}  // namespace wingbeat

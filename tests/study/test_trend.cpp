#include <gtest/gtest.h>

#include <cmath>

#include "wingbeat/study/trend.hpp"

namespace wingbeat {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(Trend, AMaximumInsideIsFoundBetweenTheSamples) {
  const TrendPeak peak = highest_along([](double x) { return 3.0 - (x - 1.234) * (x - 1.234); }, 0.0, 4.0);
  EXPECT_TRUE(peak.inside);
  EXPECT_NEAR(peak.argument, 1.234, 2e-4);
  EXPECT_NEAR(peak.value, 3.0, 1e-7);
}

TEST(Trend, AMaximumAtAnEndSaysSo) {
  const TrendPeak last = highest_along([](double x) { return x; }, 1.0, 2.0);
  EXPECT_FALSE(last.inside);
  EXPECT_DOUBLE_EQ(last.argument, 2.0);
  const TrendPeak first = highest_along([](double x) { return -x; }, 1.0, 2.0);
  EXPECT_FALSE(first.inside);
  EXPECT_DOUBLE_EQ(first.argument, 1.0);
}

TEST(Trend, ADipIsFoundThoughAnEndIsLower) {
  const auto curve = [](double x) { return x - 3.0 * std::exp(-(x - 2.0) * (x - 2.0)); };
  const TrendPeak dip = dip_along(curve, -3.0, 4.0);  // -3 at the lower end, about -1.08 in the dip
  EXPECT_TRUE(dip.inside);
  EXPECT_NEAR(dip.argument, 1.82827, 1e-3);
  EXPECT_LT(curve(-3.0), dip.value);
  EXPECT_FALSE(dip_along([](double x) { return x; }, 0.0, 1.0).inside);
}

TEST(Trend, PlacesWithoutAValueAreNoMaximum) {
  const TrendPeak edge = highest_along([](double x) { return x > 1.5 ? none : x; }, 1.0, 2.0);
  EXPECT_FALSE(edge.inside);
  EXPECT_NEAR(edge.argument, 1.5, 1e-9);
  const TrendPeak nowhere = highest_along([](double) { return none; }, 1.0, 2.0);
  EXPECT_TRUE(std::isnan(nowhere.argument));
  EXPECT_FALSE(nowhere.inside);
}

TEST(Trend, ACrossingIsFoundFromAbove) {
  // cos passes zero at pi/2 and 3 pi/2: the upper one counts.
  const double crossing = crossing_along([](double x) { return std::cos(x); }, 0.0, 0.0, 6.0);
  EXPECT_NEAR(crossing, 4.71238898038469, 1e-5);
  EXPECT_TRUE(std::isnan(crossing_along([](double x) { return x; }, -1.0, 0.0, 1.0)));
  EXPECT_TRUE(std::isnan(crossing_along([](double) { return none; }, 0.0, 0.0, 1.0)));
}

}  // namespace
}  // namespace wingbeat

#include "wingbeat/core/root.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace wingbeat {
namespace {

TEST(Bisect, EndsAtNeighbouringNumbers) {
  int asked = 0;
  const auto [before, after] = bisect(
      [&](double x) {
        ++asked;
        return x * x < 2.0;
      },
      0.0, 2.0);
  EXPECT_LT(before * before, 2.0);
  EXPECT_GE(after * after, 2.0);
  EXPECT_EQ(std::nextafter(before, 2.0), after);
  EXPECT_LE(asked, 54);
}

TEST(Bisect, GoesDownwardsAsWell) {
  const auto [before, after] = bisect([](double x) { return x >= 0.3; }, 1.0, -1.0);
  EXPECT_EQ(before, 0.3);
  EXPECT_EQ(after, std::nextafter(0.3, 0.0));
}

TEST(Bisect, EndsWhereItIsNarrowEnough) {
  int asked = 0;
  const auto [before, after] = bisect(
      [&](double x) {
        ++asked;
        return x < 0.7;
      },
      0.0, 1.0, [](const Bracket<double>& b) { return b.after - b.before <= 1.0 / 1024.0; });
  EXPECT_EQ(asked, 10);
  EXPECT_EQ(after - before, 1.0 / 1024.0);
  EXPECT_TRUE(before <= 0.7 && 0.7 <= after);
}

TEST(Bisect, LeavesEndsThatHoldNoNumberBetween) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto never = [](double) -> bool { throw "asked"; };
  EXPECT_EQ(bisect(never, 1.0, std::nextafter(1.0, 2.0)).before, 1.0);
  EXPECT_EQ(bisect(never, 1.0, 1.0).after, 1.0);
  EXPECT_TRUE(std::isnan(bisect(never, 0.0, nan).after));
}

TEST(SignChange, FindsRisingAndFallingZerosAndJumps) {
  EXPECT_NEAR(sign_change([](double x) { return std::cos(x); }, 0.0, 3.0), std::acos(0.0), 3e-16);
  EXPECT_NEAR(sign_change([](double x) { return -std::cos(x); }, 3.0, 0.0), std::acos(0.0), 3e-16);
  EXPECT_NEAR(sign_change([](double x) { return 1.0 / (x - 0.1); }, 0.0, 1.0), 0.1, 1e-16);
  EXPECT_NEAR(sign_change([](double x) { return std::pow(x - 0.3, 5.0); }, 0.0, 1.0), 0.3, 1e-16);
  EXPECT_NEAR(sign_change([](double x) { return x - 0.3; }, 0.0, 1.0, 1e-3), 0.3, 5e-4);
  EXPECT_NEAR(sign_change([](double x) { return x - 0.3; }, 1.0, 0.0, 1e-3), 0.3, 5e-4);
  EXPECT_NEAR(double(sign_change([](long double x) { return x * x - 2.0L; }, 1.0L, 2.0L) - std::sqrt(2.0L)), 0.0,
              2e-19);
}

TEST(FindZero, NeedsFewEvaluationsWhereTheFunctionIsSmooth) {
  int asked = 0;
  const auto f = [&](double x) {
    ++asked;
    return std::cos(x);
  };
  const auto [before, after] = find_zero(f, 0.0, std::cos(0.0), 3.0, std::cos(3.0), 4e-16);
  EXPECT_LE(asked, 12);
  EXPECT_LE(before, std::acos(0.0));
  EXPECT_GE(after, std::acos(0.0));
  EXPECT_LE(after - before, 1e-15);
}

TEST(FindZero, KeepsTheBracketOfHardFunctions) {
  // A zero of order nine, a kink, one at the very start, one that is met exactly.
  const auto bracketed = [](const auto& f, double a, double b, double zero) {
    const auto [before, after] = find_zero(f, a, f(a), b, f(b), 1e-12);
    EXPECT_LE(before, zero);
    EXPECT_GE(after, zero);
    EXPECT_LE(after - before, 1e-3);
  };
  bracketed([](double x) { return std::pow(0.25 - x, 9.0); }, 0.0, 1.0, 0.25);
  bracketed([](double x) { return x < 0.25 ? 1e-6 * (0.25 - x) : 1e6 * (0.25 - x); }, 0.0, 1.0, 0.25);
  bracketed([](double x) { return -x; }, 0.0, 1.0, 0.0);
  bracketed([](double x) { return 0.5 - x; }, 0.0, 1.0, 0.5);
}

}  // namespace
}  // namespace wingbeat

#include "wingbeat/core/minimise.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace wingbeat {
namespace {

TEST(Minimise, FindsTheFlatBottomOfASmoothFunction) {
  int asked = 0;
  const Minimum least = minimise(
      [&](double x) {
        ++asked;
        return std::cos(x);
      },
      2.0, 5.0, 1e-7);
  EXPECT_NEAR(least.argument, std::acos(-1.0), 1e-7);
  EXPECT_NEAR(least.value, -1.0, 1e-14);
  EXPECT_LE(asked, 15);
}

TEST(Minimise, FindsKinksAndEnds) {
  const Minimum kink = minimise([](double x) { return x < 0.3 ? 0.3 - x : 7.0 * (x - 0.3); }, 0.0, 1.0, 1e-9);
  EXPECT_NEAR(kink.argument, 0.3, 1e-8);
  EXPECT_NEAR(kink.value, 0.0, 1e-7);
  EXPECT_NEAR(minimise([](double x) { return x; }, 0.0, 1.0, 1e-9).argument, 0.0, 1e-8);
  EXPECT_NEAR(minimise([](double x) { return -x; }, 0.0, 1.0, 1e-9).argument, 1.0, 1e-8);
}

TEST(Minimise, EndsOnAConstant) {
  const Minimum any = minimise([](double) { return 4.0; }, -1.0, 1.0, 1e-9);
  EXPECT_EQ(any.value, 4.0);
  EXPECT_LT(std::abs(any.argument), 1.0);
}

}  // namespace
}  // namespace wingbeat

#include <gtest/gtest.h>

#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/solve/collocation.hpp"
#include "wingbeat/solve/implicit_step.hpp"
#include "wingbeat/solve/radau_collocation.hpp"

namespace wingbeat::solver {
namespace {

class Collocation : public testing::TestWithParam<int> {};

TEST_P(Collocation, NodesLieSymmetricallyWithBothEndsAmongThem) {
  const CollocationRule& rule = collocation_rule(GetParam());
  ASSERT_EQ(rule.intervals, GetParam());
  EXPECT_EQ(rule.node[0], 0.0);
  EXPECT_EQ(rule.node[rule.intervals], 1.0);
  for (int m = 1; m <= rule.intervals; ++m) {
    EXPECT_GT(rule.node[m], rule.node[m - 1]);
    EXPECT_NEAR(rule.node[m] + rule.node[rule.intervals - m], 1.0, 1e-15);
  }
}

TEST_P(Collocation, IntegratesPolynomialsUpToTwiceTheIntervalsLessOne) {
  const CollocationRule& rule = collocation_rule(GetParam());
  const auto error = [&](int power) {
    double sum = 0.0;
    for (int j = 0; j <= rule.intervals; ++j) sum += rule.weight[j] * std::pow(rule.node[j], power);
    return std::abs(sum - 1.0 / (power + 1));
  };
  for (int power = 0; power < 2 * rule.intervals; ++power) EXPECT_LT(error(power), 1e-14) << power;
  if (rule.intervals <= 8) {
    EXPECT_GT(error(2 * rule.intervals), 1e-12);
  }
}

TEST_P(Collocation, PolynomialsOfItsDegreeAreIntegratedDifferentiatedAndTakenApart) {
  const CollocationRule& rule = collocation_rule(GetParam());
  const int n = rule.intervals;
  for (int power = 0; power <= n; ++power) {
    for (int m = 0; m <= n; ++m) {
      double between = 0.0, slope = 0.0, value = 0.0;
      for (int j = 0; j <= n; ++j) {
        const double value_at_node = std::pow(rule.node[j], power);
        between += rule.between[m][j] * value_at_node;
        slope += rule.slope[m][j] * value_at_node;
        for (int k = 0; k <= n; ++k)
          value += rule.legendre[k][j] * value_at_node * std::legendre(unsigned(k), 2.0 * rule.node[m] - 1.0);
      }
      const auto integral = [&](double x) { return std::pow(x, power + 1) / (power + 1); };
      EXPECT_NEAR(between, m == 0 ? 0.0 : integral(rule.node[m]) - integral(rule.node[m - 1]), 1e-14);
      EXPECT_NEAR(slope, power == 0 ? 0.0 : power * std::pow(rule.node[m], power - 1), 1e-11);
      EXPECT_NEAR(value, std::pow(rule.node[m], power), 1e-13);
    }
  }
}

// y' = -y + cos x on [0, h], solved at the nodes by repeated substitution: at the end the error falls as h^(2 n + 1).
TEST(CollocationOrder, EndsOfSubintervalsAreOfTwiceTheOrder) {
  const CollocationRule& rule = collocation_rule(2);
  const auto error = [&](double h) {
    double y[3] = {1.0, 1.0, 1.0};
    for (int repeat = 0; repeat < 200; ++repeat) {
      for (int m = 1; m <= 2; ++m) {
        double sum = 0.0;
        for (int j = 0; j <= 2; ++j) sum += rule.between[m][j] * (std::cos(rule.node[j] * h) - y[j]);
        y[m] = y[m - 1] + h * sum;
      }
    }
    return std::abs(y[2] - 0.5 * (std::cos(h) + std::sin(h) + std::exp(-h)));
  };
  EXPECT_NEAR(std::log2(error(0.4) / error(0.2)), 5.0, 0.2);
  EXPECT_NEAR(std::log2(error(0.2) / error(0.1)), 5.0, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Each, Collocation, testing::Values(2, 4, 6, 8, 10, 12, 14, 16),
                         [](const auto& intervals) { return std::to_string(intervals.param); });

TEST(RadauCollocation, IntegratesPolynomialsUpToTwiceTheStagesLessTwo) {
  constexpr int n = 7;
  const RadauCollocation<n> rule = radau_collocation<n>();
  EXPECT_EQ(rule.c[n - 1], 1.0);
  const auto error = [&](int stage, int power) {
    double sum = 0.0;
    for (int j = 0; j < n; ++j) sum += rule.a[stage][j] * std::pow(rule.c[j], power);
    return std::abs(sum - std::pow(rule.c[stage], power + 1) / (power + 1));
  };
  for (int power = 0; power < 2 * n - 1; ++power) EXPECT_LT(error(n - 1, power), 1e-15) << power;
  EXPECT_GT(error(n - 1, 2 * n - 1), 1e-9);
  for (int stage = 0; stage < n; ++stage) {
    for (int power = 0; power < n; ++power) EXPECT_LT(error(stage, power), 1e-15) << stage << ' ' << power;
  }
}

TEST(RadauCollocation, WithFiveStagesIsTheImplicitStep) {
  const RadauCollocation<5> rule = radau_collocation<5>();
  const RadauTableau& tableau = radau_tableau();
  for (int j = 0; j < 5; ++j) {
    EXPECT_EQ(rule.c[j], tableau.c[j]);
    for (int l = 0; l < 5; ++l) EXPECT_EQ(rule.a[j][l], tableau.a[j][l]);
  }
}

}  // namespace
}  // namespace wingbeat::solver

// Tableau conditions and measured orders of both methods.
#include <gtest/gtest.h>

#include <cmath>

#include "solve/oscillators.hpp"

namespace wingbeat::solver {
namespace {

TEST(Dop853, RowsSumToTheirNodes) {
  for (int i = 0; i < dop853::stages; ++i) {
    double sum = 0.0;
    for (int j = 0; j < dop853::stages; ++j) {
      sum += dop853::a[i][j];
      if (j >= i) {
        EXPECT_EQ(dop853::a[i][j], 0.0);
      }
    }
    EXPECT_NEAR(sum, dop853::c[i], 2e-14) << "row " << i;
  }
}

TEST(Dop853, WeightsIntegratePolynomialsUpToTheirOrder) {
  for (int power = 0; power < dop853::order; ++power) {
    double sum = 0.0;
    for (int j = 0; j < dop853::stages; ++j) sum += dop853::b[j] * std::pow(dop853::c[j], power);
    EXPECT_NEAR(sum, 1.0 / (power + 1), 5e-15) << "power " << power;
  }
}

TEST(Dop853, ErrorWeightsVanishUpToTheEmbeddedOrder) {
  for (int power = 0; power < 5; ++power) {
    double third = 0.0, fifth = 0.0;
    for (int j = 0; j < dop853::stages; ++j) {
      third += dop853::e3[j] * std::pow(dop853::c[j], power);
      fifth += dop853::e5[j] * std::pow(dop853::c[j], power);
    }
    EXPECT_NEAR(fifth, 0.0, 1e-14) << "power " << power;
    if (power < 3) {
      EXPECT_NEAR(third, 0.0, 1e-14) << "power " << power;
    }
  }
}

TEST(RadauTableau, MeetsItsDefiningConditions) {
  const RadauTableau& t = radau_tableau();
  constexpr int s = RadauTableau::stages;
  EXPECT_EQ(t.c[s - 1], 1.0);
  for (int i = 0; i + 1 < s; ++i) {
    EXPECT_GT(t.c[i], 0.0);
    EXPECT_LT(t.c[i], t.c[i + 1]);
  }
  for (int power = 0; power < s; ++power) {
    for (int i = 0; i < s; ++i) {
      double sum = 0.0;
      for (int j = 0; j < s; ++j) sum += t.a[i][j] * std::pow(t.c[j], power);
      EXPECT_NEAR(sum, std::pow(t.c[i], power + 1) / (power + 1), 1e-15) << "stage " << i << " power " << power;
    }
  }
  for (int power = 0; power < RadauTableau::order; ++power) {
    double sum = 0.0;
    for (int j = 0; j < s; ++j) sum += t.a[s - 1][j] * std::pow(t.c[j], power);
    EXPECT_NEAR(sum, 1.0 / (power + 1), 1e-15) << "power " << power;
  }
  // The embedded formulas are of order 5, with a weight at the step's start, and of order 3.
  for (int power = 0; power < s; ++power) {
    double fifth = power == 0 ? t.start_weight : 0.0, third = 0.0;
    for (int j = 0; j < s; ++j) {
      fifth += (t.a[s - 1][j] + t.error5[j]) * std::pow(t.c[j], power);
      third += (t.a[s - 1][j] + t.error3[j]) * std::pow(t.c[j], power);
    }
    EXPECT_NEAR(fifth, 1.0 / (power + 1), 1e-14) << "power " << power;
    if (power < 3) {
      EXPECT_NEAR(third, 1.0 / (power + 1), 1e-14) << "power " << power;
    }
  }
  // On states off the step's start by h A k for rates k.
  for (int j = 0; j < s; ++j) {
    double third = 0.0, fifth = 0.0;
    for (int i = 0; i < s; ++i) {
      third += t.state_error3[i] * t.a[i][j];
      fifth += t.state_error5[i] * t.a[i][j];
    }
    EXPECT_NEAR(third, t.error3[j], 1e-14);
    EXPECT_NEAR(fifth, t.error5[j], 1e-14);
  }
}

template <std::size_t n>
double distance(const std::array<double, n>& a, const std::array<double, n>& b) {
  double highest = 0.0;
  for (std::size_t k = 0; k < n; ++k) highest = std::max(highest, std::abs(a[k] - b[k]));
  return highest;
}

struct KeplerErrors {
  double state, integrals;
};

/// Errors after half a revolution in steps of equal length.
KeplerErrors half_revolution(Method method, double e, int steps) {
  using System = Kepler<double>;
  const System system;
  System::State y = System::start(e);
  System::Quadrature q{};
  const double h = pi / steps;
  for (int n = 0; n < steps; ++n) {
    const auto first = system.rates<true>(n * h, y, {1.0});
    const auto result = take_step<true>(method, system, n * h, y, h, System::Signs{1.0}, first);
    EXPECT_TRUE(result.admissible);
    y = result.y;
    for (std::size_t k = 0; k < q.size(); ++k) q[k] += result.dq[k];
  }
  return {distance(y, System::opposite(e)), distance(q, {pi, pi / std::sqrt(1.0 - e * e), pi * (0.5 + 2.0 * e * e)})};
}

void expect_order(Method method, int steps, double order) {
  const KeplerErrors coarse = half_revolution(method, 0.0, steps), fine = half_revolution(method, 0.0, 2 * steps);
  ASSERT_GT(fine.state, 1e-13) << "rounding hides the order";
  EXPECT_NEAR(std::log2(coarse.state / fine.state), order, 0.3);
  EXPECT_GT(std::log2(coarse.integrals / fine.integrals), order - 0.3);
  // On an ellipse the error terms differ in size along the way: the mean over two halvings.
  const KeplerErrors rough = half_revolution(method, 0.2, steps), quarter = half_revolution(method, 0.2, 4 * steps);
  EXPECT_NEAR(0.5 * std::log2(rough.state / quarter.state), order, 1.0);
  EXPECT_GT(0.5 * std::log2(rough.integrals / quarter.integrals), order - 1.0);
}

TEST(Steps, ExplicitPairIsOfOrderEight) { expect_order(Method::explicit_pair, 8, 8.0); }
TEST(Steps, RadauIsOfOrderNine) { expect_order(Method::radau, 4, 9.0); }

/// Embedded error estimates of one step of length h.
template <class System>
StepResult<System> one_step(Method method, const System& system, const typename System::State& y, double h) {
  const typename System::Signs signs{1.0};
  return take_step<true>(method, system, 0.4, y, h, signs, system.template rates<true>(0.4, y, signs));
}

TEST(Steps, EmbeddedErrorsHaveTheirOrders) {
  const Kepler<double> system;
  const auto order = [&](Method method, double h, auto error) {
    const Kepler<double>::State y = {0.8, 0.3, -0.2, 1.1};
    return std::log2(error(one_step(method, system, y, h)) / error(one_step(method, system, y, 0.5 * h)));
  };
  const auto third = [](const auto& r) { return distance(r.error3, {}); };
  const auto fifth = [](const auto& r) { return distance(r.error5, {}); };
  const auto third_integral = [](const auto& r) { return std::abs(r.integral_error3[0]); };
  const auto fifth_integral = [](const auto& r) { return std::abs(r.integral_error5[0]); };
  EXPECT_NEAR(order(Method::explicit_pair, 0.1, third), 4.0, 0.4);
  EXPECT_NEAR(order(Method::explicit_pair, 0.1, third_integral), 4.0, 0.4);
  EXPECT_NEAR(order(Method::explicit_pair, 0.1, fifth), 6.0, 0.5);
  EXPECT_NEAR(order(Method::explicit_pair, 0.1, fifth_integral), 6.0, 0.5);
  EXPECT_NEAR(order(Method::radau, 0.1, third), 4.0, 0.4);
  EXPECT_NEAR(order(Method::radau, 0.1, third_integral), 4.0, 0.4);
  EXPECT_NEAR(order(Method::radau, 0.1, fifth), 6.0, 0.5);
  EXPECT_NEAR(order(Method::radau, 0.1, fifth_integral), 6.0, 0.5);
}

TEST(Steps, StepsWithAndWithoutIntegralsAreTheSame) {
  const Kepler<double> system;
  const Kepler<double>::State y = Kepler<double>::start(0.3);
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    const Kepler<double>::Signs signs{1.0};
    const auto with = take_step<true>(method, system, 0.0, y, 0.3, signs, system.rates<true>(0.0, y, signs));
    const auto without = take_step<false>(method, system, 0.0, y, 0.3, signs, system.rates<false>(0.0, y, signs));
    EXPECT_EQ(with.y, without.y);
    EXPECT_EQ(with.error5, without.error5);
  }
}

TEST(Steps, RadauFollowsAStiffSolutionInLargeSteps) {
  for (const double rate : {1e2, 1e6, 1e10}) {
    const StiffFollower<double> system(rate);
    // Far off the solution at first: a stable method forgets that at once.
    std::array<double, 1> y = {3.0};
    const int steps = 20;
    const double h = two_pi / steps;
    for (int n = 0; n < steps; ++n) {
      const auto result = implicit_step<false>(system, n * h, y, h, {1.0}, system.rates<false>(n * h, y, {1.0}));
      ASSERT_TRUE(result.admissible) << "rate " << rate << " step " << n;
      y = result.y;
      if (n > 3) {
        EXPECT_NEAR(y[0], std::cos((n + 1) * h), rate < 1e6 ? 1e-6 : 1e-9) << "rate " << rate;
      }
    }
    const auto last = implicit_step<true>(system, 0.0, {1.0}, h, {1.0}, system.rates<true>(0.0, {1.0}, {1.0}));
    EXPECT_LT(std::abs(last.error5[0]), 1e-5) << "the estimate must not be fooled by stiffness";
  }
}

TEST(Steps, RadauDampsWhatItCannotResolve) {
  // x' = -rate x as rate h grows: R(z) -> 0.
  const StiffFollower<double> system(1e8);
  const auto result =
      implicit_step<false>(system, 0.0, {1.0 + 1e3}, 0.1, {1.0}, system.rates<false>(0.0, {1.0 + 1e3}, {1.0}));
  ASSERT_TRUE(result.admissible);
  EXPECT_NEAR(result.y[0], std::cos(0.1), 1e-3);
}

TEST(Steps, LowestSwitchSeesADipBetweenTheEnds) {
  const DoubleCrossing<double> system(1.0, 0.4);
  const auto result = explicit_step<false>(system, 0.0, {0.0}, 2.0, {1.0}, system.rates<false>(0.0, {0.0}, {1.0}));
  EXPECT_LT(result.lowest[0], 0.0);
  const DoubleCrossing<double> shallow(1.0, 0.0);
  const auto none = explicit_step<false>(shallow, 0.0, {0.0}, 2.0, {1.0}, shallow.rates<false>(0.0, {0.0}, {1.0}));
  EXPECT_GE(none.lowest[0], 0.0);
}

/// x' = -1 with x > 0 only.
struct Sinking : TestSystem<double, 1> {
  bool admissible(const State& y) const { return y[0] > 0.0; }
  template <bool>
  Rates<Sinking> rates(double, const State&, const Signs&) const {
    return {{-1.0}, {1.0}, {1.0}};
  }
};

TEST(Steps, StepOutOfTheAdmissibleRegionSaysSo) {
  const Sinking system;
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    const auto first = system.rates<true>(0.0, {0.5}, {1.0});
    EXPECT_TRUE(take_step<true>(method, system, 0.0, {0.5}, 0.4, {1.0}, first).admissible);
    EXPECT_FALSE(take_step<true>(method, system, 0.0, {0.5}, 0.6, {1.0}, first).admissible);
  }
}

}  // namespace
}  // namespace wingbeat::solver

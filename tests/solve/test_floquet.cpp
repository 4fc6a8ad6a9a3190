// Products of step matrices, and multipliers of iterates whose steps do not resolve a decay.
#include <gtest/gtest.h>

#include <cmath>

#include "solve/oscillators.hpp"
#include "wingbeat/solve/floquet.hpp"

namespace wingbeat::solver {
namespace {

TEST(Floquet, ProductsNeitherOverflowNorUnderflow) {
  for (const double size : {1e-200, 1e200}) {
    MatrixProduct<2> product;
    for (int n = 0; n < 10; ++n) product.append({size, 0.0, size, 0.5 * size});
    EXPECT_NEAR(product.log_scale, 10.0 * std::log(size), 10.0);
    EXPECT_NEAR(product.log_determinant, 20.0 * std::log(size) + 10.0 * std::log(0.5), 1e-9);
    EXPECT_NEAR(spectral_radius(2, product.scaled.data()) * std::exp(product.log_scale - 10.0 * std::log(size)), 1.0,
                1e-12);
    // As many back again.
    for (int n = 0; n < 10; ++n) product.append({1.0 / size, 0.0, 0.0, 1.0 / size});
    EXPECT_NEAR(product.spectral_radius(), 1.0, 1e-10);
  }
}

TEST(Floquet, ComplexPairsHaveTheRootOfTheDeterminant) {
  MatrixProduct<2> product;
  const double c = 0.9 * std::cos(0.1), s = 0.9 * std::sin(0.1);
  for (int n = 0; n < 100; ++n) product.append({c, -s, s, c});
  EXPECT_NEAR(product.spectral_radius() / std::pow(0.9, 100), 1.0, 1e-10);
}

TEST(Floquet, SingularFactorsEndTheProduct) {
  MatrixProduct<2> product;
  product.append({0.0, 0.0, 0.0, 0.0});
  product.append({1e300, 0.0, 0.0, 1e300});
  EXPECT_EQ(product.spectral_radius(), 0.0);
  EXPECT_EQ(product.matrix()[0], 0.0);
}

TEST(Floquet, StepsBeyondStabilityDoNotGrow) {
  // At rest nothing is excited: steps of a twelfth of the period, on a decay that takes a hundredth of one.
  const StiffFollower<double> system(300.0);
  Iterate<StiffFollower<double>> iterate;
  iterate.steps.clear();
  constexpr int steps = 12;
  for (int n = 0; n < steps; ++n) {
    Step<StiffFollower<double>> step{};
    step.x = two_pi * n / steps;
    step.h = two_pi / steps;
    step.y = {std::cos(step.x)};
    step.signs.fill(1.0);
    step.first = system.template rates<false>(step.x, step.y, step.signs);
    iterate.steps.push_back(step);
  }
  iterate.end = iterate.steps.front().y;
  EXPECT_LT(monodromy_product(system, system.template cast<Jet<1>>(), iterate).spectral_radius(), 1e-6);
}

/// Two oscillators whose velocities are in a unit so small that the rates' derivatives are large numbers, although
/// nothing moves quickly.
template <class S>
struct OddUnits : TestSystem<S, 4> {
  using Base = TestSystem<S, 4>;
  static constexpr double unit = 1e-4;
  static constexpr std::array<double, 2> damping = {0.3, 0.8}, stiffness = {2.0, 5.0};
  static inline int evaluations = 0;

  template <class T>
  OddUnits<T> cast() const {
    return {};
  }
  typename Base::State error_scale(const typename Base::State&) const {
    return {S(1.0), S(1.0 / unit), S(1.0), S(1.0 / unit)};
  }
  template <bool quadratures>
  Rates<OddUnits> rates(const S& x, const typename Base::State& y, const typename Base::Signs&) const {
    using std::cos;
    ++evaluations;
    Rates<OddUnits> r;
    for (std::size_t n = 0; n < 2; ++n) {
      const S velocity = S(unit) * y[2 * n + 1];
      r.dy[2 * n] = velocity;
      r.dy[2 * n + 1] = (cos(x) - S(damping[n]) * velocity - S(stiffness[n]) * y[2 * n]) * S(1.0 / unit);
    }
    r.switches[0] = S(1.0);
    if constexpr (quadratures) r.dq[0] = S(1.0);
    return r;
  }
};

// The steps' own derivatives do: nothing needs to be solved along them.
TEST(Floquet, StepsThatResolveTheFlowAreKnownInAnyUnits) {
  const OddUnits<double> system;
  Iterate<OddUnits<double>> iterate;
  run_iterate<false>(system, {0.1, 0.0, -0.2, 0.0}, {.tolerance = 1e-11}, iterate);
  ASSERT_EQ(iterate.status, IterateStatus::complete);
  const double multiplier = std::exp(-0.5 * OddUnits<double>::damping[0] * two_pi);
  OddUnits<double>::evaluations = 0;
  EXPECT_NEAR(monodromy_product(system, system.cast<Jet<4>>(), iterate).spectral_radius(), multiplier,
              1e-10 * multiplier);
  EXPECT_EQ(OddUnits<double>::evaluations, 0);
}

}  // namespace
}  // namespace wingbeat::solver

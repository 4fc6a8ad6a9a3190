// Iterates of piecewise smooth systems: switches located, accuracy governed by the tolerance.
#include <gtest/gtest.h>

#include <cmath>

#include "solve/oscillators.hpp"
#include "wingbeat/solve/periodic.hpp"

namespace wingbeat::solver {
namespace {

/// The undamped bilinear oscillator from x = 0, v = 1: half periods pi / sqrt(k) of sines.
struct FreeBilinear {
  BilinearOscillator<double> system;
  std::vector<double> crossings;

  FreeBilinear() {
    system.length = 10.0;
    for (double t = pi, half = 0.5 * pi; t < 10.0; t += half, half = half < 2.0 ? pi : 0.5 * pi) crossings.push_back(t);
  }
  std::array<double, 2> at(double t) const {
    const double cycle = std::fmod(t, 1.5 * pi);
    if (cycle < pi) return {std::sin(cycle), std::cos(cycle)};
    return {-0.5 * std::sin(2.0 * (cycle - pi)), -std::cos(2.0 * (cycle - pi))};
  }
  /// Integral of |x| over an iterate.
  double integral() const {
    // Whole arcs hold 2 and 1/2; the iterate ends in the upper arc after two cycles.
    return 5.0 + 1.0 - std::cos(10.0 - 3.0 * pi);
  }
};

TEST(Iterate, SwitchesAreLocatedAndTheToleranceGovernsTheError) {
  const FreeBilinear free;
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-12}) {
      Iterate<BilinearOscillator<double>> iterate;
      run_iterate<true>(free.system, {0.0, 1.0}, {.method = method, .tolerance = tolerance}, iterate);
      ASSERT_EQ(iterate.status, IterateStatus::complete);
      ASSERT_EQ(iterate.switches.size(), free.crossings.size()) << "tolerance " << tolerance;
      for (std::size_t k = 0; k < free.crossings.size(); ++k) {
        EXPECT_NEAR(iterate.switches[k].x, free.crossings[k], 3.0 * detail::switch_tolerance(tolerance));
        EXPECT_EQ(iterate.switches[k].sign, 0u);
      }
      double integral = 0.0, covered = 0.0;
      for (const auto& step : iterate.steps) {
        EXPECT_NEAR(step.x, covered, 1e-13);
        covered = step.x + step.h;
        integral += step.dq[0];
        EXPECT_EQ(step.signs[0], free.at(step.x + 0.5 * step.h)[0] > 0.0 ? 1.0 : -1.0);
      }
      EXPECT_NEAR(covered, 10.0, 1e-13);
      const auto exact = free.at(10.0);
      const double allowed = 30.0 * tolerance + 2e-14;
      EXPECT_NEAR(iterate.end[0], exact[0], allowed) << "tolerance " << tolerance;
      EXPECT_NEAR(iterate.end[1], exact[1], allowed) << "tolerance " << tolerance;
      EXPECT_NEAR(integral, free.integral(), allowed) << "tolerance " << tolerance;
    }
  }
}

TEST(Iterate, ExpectedSwitchesAreUsedAgain) {
  FreeBilinear free;
  long calls = 0;
  free.system.calls = &calls;
  for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
    Iterate<BilinearOscillator<double>> iterate;
    const IterateOptions options{.tolerance = tolerance};
    run_iterate<false>(free.system, {0.0, 1.0}, options, iterate);
    const long first = std::exchange(calls, 0);
    run_iterate<false>(free.system, {0.0, 1.0}, options, iterate);
    const long second = std::exchange(calls, 0);
    EXPECT_LT(second, first) << "tolerance " << tolerance;
    ASSERT_EQ(iterate.switches.size(), free.crossings.size());
    EXPECT_NEAR(iterate.end[0], free.at(10.0)[0], 30.0 * tolerance + 2e-14);
    EXPECT_NEAR(iterate.end[1], free.at(10.0)[1], 30.0 * tolerance + 2e-14);
  }
}

TEST(Iterate, WrongExpectationsDoNoHarm) {
  const FreeBilinear free;
  for (const double tolerance : {1e-4, 1e-9}) {
    for (const double off : {-1.0, -0.1, -1e-3, 1e-3, 0.1, 1.0}) {
      Iterate<BilinearOscillator<double>> iterate;
      for (const double x : free.crossings) iterate.switches.push_back({x + off, 0});
      run_iterate<false>(free.system, {0.0, 1.0}, {.tolerance = tolerance}, iterate);
      ASSERT_EQ(iterate.status, IterateStatus::complete);
      EXPECT_EQ(iterate.switches.size(), free.crossings.size()) << "off by " << off;
      EXPECT_NEAR(iterate.end[0], free.at(10.0)[0], 30.0 * tolerance) << "off by " << off;
    }
  }
}

/// Iterates with and without integrals, the latter in longer steps: `missed` counts those that did not see both
/// crossings, `wrong` those that located two but ended wrong.
void expect_both_crossings(double half_width, bool quadratures) {
  int missed = 0, wrong = 0, count = 0;
  for (double centre = 1.0; centre < 5.2; centre += 0.0137, ++count) {
    const DoubleCrossing<double> system(centre, half_width);
    Iterate<DoubleCrossing<double>> iterate;
    if (quadratures) {
      run_iterate<true>(system, {0.0}, {.tolerance = 1e-8}, iterate);
    } else {
      run_iterate<false>(system, {0.0}, {.tolerance = 1e-8}, iterate);
    }
    ASSERT_EQ(iterate.status, IterateStatus::complete);
    if (iterate.switches.size() != 2) {
      ++missed;
      continue;
    }
    EXPECT_NEAR(iterate.switches[0].x, centre - half_width, 1e-3);
    EXPECT_NEAR(iterate.switches[1].x, centre + half_width, 1e-3);
    double integral = 0.0;
    for (const auto& step : iterate.steps) integral += step.dq[0];
    wrong += std::abs(iterate.end[0] - system.exact()) > 3e-7 ? 1 : 0;
    wrong += quadratures && std::abs(integral - system.exact()) > 3e-7 ? 1 : 0;
  }
  EXPECT_EQ(missed, 0) << "of " << count << " with half width " << half_width;
  EXPECT_EQ(wrong, 0) << "of " << count << " with half width " << half_width;
}

TEST(Iterate, TwoCrossingsWithinAStepAreFound) {
  // The solution is a polynomial: nothing but the switch itself shortens a step.
  for (const double half_width : {0.6, 0.3, 0.2}) expect_both_crossings(half_width, true);
  expect_both_crossings(0.6, false);
}

/// y' = |a| + |a b| with a = sin(t - 2), b = sin(t - 2 - gap): a b has the other sign for the gap behind or before a
/// zero of a.
template <class S>
struct NeighbouringZeros : TestSystem<S, 1, 1, 2> {
  using Base = TestSystem<S, 1, 1, 2>;
  double gap = 0.0;

  template <bool quadratures>
  Rates<NeighbouringZeros> rates(const S& t, const typename Base::State&, const typename Base::Signs& signs) const {
    const S a = std::sin(t - 2.0), b = std::sin(t - 2.0 - gap);
    Rates<NeighbouringZeros> r;
    r.dy = {signs[0] * a + signs[1] * a * b};
    r.switches = {a, a * b};
    if constexpr (quadratures) r.dq = r.dy;
    return r;
  }
  double exact() const { return 4.0 + pi * std::cos(gap) + 2.0 * std::abs(std::sin(gap) - gap * std::cos(gap)); }
};

TEST(Iterate, ZerosBesideThoseOfAnotherSwitchAreFound) {
  for (const double gap : {0.3, 0.1, 0.03, 0.01, 0.003, 0.001, -0.001, -0.003, -0.01, -0.03, -0.1, -0.3}) {
    NeighbouringZeros<double> system;
    system.gap = gap;
    for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11}) {
      Iterate<NeighbouringZeros<double>> iterate;
      for (int pass = 0; pass < 3; ++pass) {  // again with the switches that the iterate before expects
        run_iterate<true>(system, {0.0}, {.tolerance = tolerance}, iterate);
        ASSERT_EQ(iterate.status, IterateStatus::complete);
        EXPECT_NEAR(iterate.end[0], system.exact(), 10.0 * tolerance) << "gap " << gap << ", tolerance " << tolerance;
      }
    }
  }
}

TEST(Iterate, FixedNodesEndStepsAndFlipTheirSign) {
  const FixedNodeSystem<double> system;
  Iterate<FixedNodeSystem<double>> iterate;
  run_iterate<true>(system, {0.0}, {.tolerance = 1e-12}, iterate);
  ASSERT_EQ(iterate.status, IterateStatus::complete);
  EXPECT_NEAR(iterate.end[0], 4.0, 1e-12);
  EXPECT_TRUE(iterate.switches.empty());
  bool ends_there = false;
  for (const auto& step : iterate.steps) {
    EXPECT_EQ(step.signs[1], step.x + 0.5 * step.h < pi ? 1.0 : -1.0);
    ends_there = ends_there || std::abs(step.x - pi) < 1e-15;
  }
  EXPECT_TRUE(ends_there);
}

TEST(Iterate, SmoothIterateErrorFollowsTheTolerance) {
  const LinearOscillator<double> system(0.3, 2.0);
  // From a point of the steady orbit the iterate ends where it began.
  const std::array<double, 2> start = {system.cosine(), system.sine()};
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12}) {
    for (const Method method : {Method::explicit_pair, Method::radau}) {
      Iterate<LinearOscillator<double>> iterate;
      run_iterate<true>(system, start, {.method = method, .tolerance = tolerance}, iterate);
      ASSERT_EQ(iterate.status, IterateStatus::complete);
      EXPECT_NEAR(iterate.end[0], start[0], 10.0 * tolerance + 1e-14);
      EXPECT_NEAR(iterate.end[1], start[1], 10.0 * tolerance + 1e-14);
    }
  }
}

TEST(Iterate, StiffSystemNeedsTheImplicitMethod) {
  const StiffFollower<double> system(1e6);
  Iterate<StiffFollower<double>> iterate;
  run_iterate<true>(system, {1.0}, {.tolerance = 1e-8}, iterate);
  EXPECT_EQ(iterate.status, IterateStatus::too_many_steps);
  EXPECT_LT(iterate.stop, 0.1);
  Iterate<StiffFollower<double>> radau;
  run_iterate<true>(system, {1.0}, {.method = Method::radau, .tolerance = 1e-8}, radau);
  ASSERT_EQ(radau.status, IterateStatus::complete);
  EXPECT_LT(radau.steps.size(), 100u);
  EXPECT_NEAR(radau.end[0], 1.0, 1e-8);
}

/// x' = -1 with x > 0 only.
struct SinkingToABarrier : TestSystem<double, 1> {
  bool admissible(const State& y) const { return y[0] > 0.0; }
  template <bool>
  Rates<SinkingToABarrier> rates(double, const State&, const Signs&) const {
    return {{-1.0}, {1.0}, {1.0}};
  }
};

TEST(Iterate, BarrierIsReachedAndNamed) {
  Iterate<SinkingToABarrier> iterate;
  run_iterate<true>(SinkingToABarrier{}, {2.0}, {.tolerance = 1e-8}, iterate);
  EXPECT_EQ(iterate.status, IterateStatus::barrier);
  EXPECT_NEAR(iterate.stop, 2.0, 1e-9);
  EXPECT_LT(iterate.steps.size(), 100u);
}

/// x' = x^2, infinite at t = 1 from x = 1.
struct Explosion : TestSystem<double, 1> {
  template <bool>
  Rates<Explosion> rates(double, const State& y, const Signs&) const {
    return {{y[0] * y[0]}, {1.0}, {1.0}};
  }
};

TEST(Iterate, ExplosionEndsTheIterate) {
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    Iterate<Explosion> iterate;
    run_iterate<true>(Explosion{}, {1.0}, {.method = method, .tolerance = 1e-8}, iterate);
    EXPECT_NE(iterate.status, IterateStatus::complete);
    EXPECT_NEAR(iterate.stop, 1.0, 0.01);
  }
}

/// Rates that are no numbers from t = 2 on.
struct Undefined : TestSystem<double, 1> {
  template <bool>
  Rates<Undefined> rates(double t, const State&, const Signs&) const {
    return {{t < 2.0 ? 1.0 : std::nan("")}, {1.0}, {1.0}};
  }
};

TEST(Iterate, RatesThatAreNoNumbersEndTheIterate) {
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    Iterate<Undefined> iterate;
    run_iterate<true>(Undefined{}, {0.0}, {.method = method, .tolerance = 1e-8}, iterate);
    EXPECT_NE(iterate.status, IterateStatus::complete);
    EXPECT_LE(iterate.stop, 2.0);
  }
}

TEST(Iterate, SolutionInsideAStepIsAsAccurateAsTheIterate) {
  const FreeBilinear free;
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    Iterate<BilinearOscillator<double>> iterate;
    run_iterate<true>(free.system, {0.0, 1.0}, {.method = method, .tolerance = 1e-10}, iterate);
    for (double t = 0.0; t < 10.0; t += 0.0371) {
      const auto& step = step_at(iterate, t);
      EXPECT_LE(step.x, t);
      EXPECT_LE(t, step.x + step.h + 1e-12);
      const auto inside = evaluate_inside<false>(free.system, iterate, step, t);
      EXPECT_NEAR(inside.y[0], free.at(t)[0], 1e-8) << t;
      EXPECT_NEAR(inside.y[1], free.at(t)[1], 1e-8) << t;
    }
  }
}

TEST(Iterate, RepeatedStepsGiveTheSameIterate) {
  const FreeBilinear free;
  Iterate<BilinearOscillator<double>> iterate;
  run_iterate<true>(free.system, {0.0, 1.0}, {.tolerance = 1e-8}, iterate);
  std::array<double, 1> totals{};
  const auto end = repeat_iterate<true>(free.system, {0.0, 1.0}, iterate, &totals);
  EXPECT_NEAR(end[0], iterate.end[0], 1e-14);
  EXPECT_NEAR(end[1], iterate.end[1], 1e-14);
  EXPECT_NEAR(totals[0], free.integral(), 1e-6);
}

TEST(Iterate, MonodromyOfTheLinearOscillatorIsItsMatrixExponential) {
  const double c = 0.4, k = 1.7, period = two_pi;
  const LinearOscillator<double> system(c, k);
  const double decay = 0.5 * c, turn = std::sqrt(k - decay * decay);
  const double e = std::exp(-decay * period), cosine = std::cos(turn * period), sine = std::sin(turn * period) / turn;
  const double exact[] = {e * (cosine + decay * sine), e * sine, -e * k * sine, e * (cosine - decay * sine)};
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    Iterate<LinearOscillator<double>> iterate;
    run_iterate<false>(system, {0.3, -0.2}, {.method = method, .tolerance = 1e-11}, iterate);
    const auto matrix = monodromy(system, system.cast<Jet<2>>(), iterate);
    for (std::size_t n = 0; n < 4; ++n) EXPECT_NEAR(matrix[n], exact[n], 1e-9) << n;
  }
}

}  // namespace
}  // namespace wingbeat::solver

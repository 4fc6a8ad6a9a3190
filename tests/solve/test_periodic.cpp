// Periodic orbits of oscillators that are known in closed form or found by brute force.
#include <gtest/gtest.h>

#include <cmath>

#include "solve/oscillators.hpp"
#include "wingbeat/solve/periodic.hpp"

namespace wingbeat::solver {
namespace {

template <class System>
struct Found {
  PeriodicSummary summary;
  Iterate<System> iterate;
  std::array<double, std::tuple_size_v<typename System::State>> start() const { return iterate.steps.front().y; }
  double integral() const {
    double sum = 0.0;
    for (const auto& step : iterate.steps) sum += step.dq[0];
    return sum;
  }
};

template <class System>
Found<System> find(const System& system, const typename System::State& guess, const PeriodicOptions& options) {
  Found<System> found;
  found.summary = solve_periodic(system, guess, options, found.iterate);
  return found;
}

TEST(Periodic, LinearOscillatorHasItsClosedForm) {
  const double c = 0.7, k = 2.0;
  const LinearOscillator<double> system(c, k);
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
      const auto found = find(system, {0.0, 0.0}, {.tolerance = tolerance, .method = method});
      ASSERT_EQ(found.summary.status, PeriodicStatus::converged) << tolerance;
      EXPECT_LE(found.summary.residual, tolerance);
      EXPECT_EQ(found.summary.steps, int(found.iterate.steps.size()));
      EXPECT_NEAR(found.start()[0], system.cosine(), 3.0 * tolerance);
      EXPECT_NEAR(found.start()[1], system.sine(), 3.0 * tolerance);
      // Energy: what the damper takes is what the drive gives, pi a sin(phase) = pi times the sine amplitude.
      EXPECT_NEAR(found.integral(), pi * system.sine(), 10.0 * tolerance);
      EXPECT_NEAR(found.summary.floquet_multiplier_max, std::exp(-0.5 * c * two_pi), 10.0 * tolerance);
    }
  }
}

TEST(Periodic, OverdampedMultipliersAreReal) {
  const double c = 3.0, k = 1.25;
  const auto found = find(LinearOscillator<double>(c, k), {0.0, 0.0}, {.tolerance = 1e-10});
  ASSERT_EQ(found.summary.status, PeriodicStatus::converged);
  EXPECT_NEAR(found.summary.floquet_multiplier_max, std::exp(-0.5 * two_pi), 1e-9);
}

TEST(Periodic, SlowContractionIsOvercomeByNewton) {
  for (const double multiplier : {0.9, 0.99, 0.999}) {
    const double c = -std::log(multiplier) / pi;
    // Newton is trusted with steps of up to half the scale.
    const LinearOscillator<double> system(c, 2.9, 2.0);
    for (const double tolerance : {1e-5, 1e-10}) {
      const auto found = find(system, {0.0, 0.0}, {.tolerance = tolerance});
      ASSERT_EQ(found.summary.status, PeriodicStatus::converged) << multiplier << " " << describe(found.summary.status);
      EXPECT_GE(found.summary.newton_steps, 1);
      EXPECT_LE(found.summary.iterates, 15) << multiplier;
      // The orbit has 1 / (1 - multiplier) times the errors of an iterate, which are kept small accordingly.
      EXPECT_NEAR(found.start()[0], system.cosine(), 10.0 * tolerance);
      EXPECT_NEAR(found.start()[1], system.sine(), 10.0 * tolerance);
      EXPECT_NEAR(found.summary.floquet_multiplier_max, multiplier, 1e2 * tolerance);
    }
  }
}

TEST(Periodic, SlowContractionFromFarAwayIsNotTakenForAnOrbit) {
  // Too far for Newton, too slow for iterates: the search may give up, but must not accept an iterate that does not
  // close.
  const double c = -std::log(0.999) / pi;
  const LinearOscillator<double> system(c, 2.9);
  const auto found = find(system, {4.0, -3.0}, {.tolerance = 1e-6});
  EXPECT_LE(found.summary.iterates, 210);
  if (found.summary.status == PeriodicStatus::converged) {
    EXPECT_NEAR(found.start()[0], system.cosine(), 1e-2);
  } else {
    EXPECT_EQ(found.summary.status, PeriodicStatus::not_converged);
    EXPECT_GT(found.summary.residual, 1e-6);
  }
}

/// The state after many iterates by the classical Runge-Kutta method, written down here: slow, independent.
template <class System>
std::array<double, 2> brute_force(const System& system, std::array<double, 2> y, int iterates, int steps) {
  const auto slope = [&](double t, const std::array<double, 2>& state) {
    return system.template rates<false>(t, state, {state[0] >= 0.0 ? 1.0 : -1.0}).dy;
  };
  const auto moved = [](const std::array<double, 2>& state, double h, const std::array<double, 2>& k) {
    return std::array<double, 2>{state[0] + h * k[0], state[1] + h * k[1]};
  };
  const double h = two_pi / steps;
  for (int iterate = 0; iterate < iterates; ++iterate) {
    for (int n = 0; n < steps; ++n) {
      const double t = n * h;
      const auto k1 = slope(t, y), k2 = slope(t + 0.5 * h, moved(y, 0.5 * h, k1)),
                 k3 = slope(t + 0.5 * h, moved(y, 0.5 * h, k2)), k4 = slope(t + h, moved(y, h, k3));
      for (std::size_t s = 0; s < 2; ++s) y[s] += h / 6.0 * (k1[s] + 2.0 * k2[s] + 2.0 * k3[s] + k4[s]);
    }
  }
  return y;
}

TEST(Periodic, DuffingOscillatorAgreesWithBruteForce) {
  const Duffing<double> system;
  const auto reference = brute_force(system, {0.0, 0.0}, 25, 4000);
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
      const auto found = find(system, {0.0, 0.0}, {.tolerance = tolerance, .method = method});
      ASSERT_EQ(found.summary.status, PeriodicStatus::converged);
      EXPECT_NEAR(found.start()[0], reference[0], 10.0 * tolerance + 1e-11);
      EXPECT_NEAR(found.start()[1], reference[1], 10.0 * tolerance + 1e-11);
      // Liouville: the product of the multipliers is exp(-c T), so none exceeds one by far less.
      EXPECT_LT(found.summary.floquet_multiplier_max, 1.0);
      EXPECT_GE(found.summary.floquet_multiplier_max, std::exp(-0.5 * system.damping * two_pi) - 1e-3);
    }
  }
}

TEST(Periodic, BilinearOscillatorAgreesWithBruteForce) {
  BilinearOscillator<double> system;
  system.damping = 0.6;
  system.above = 1.5;
  system.below = 4.0;
  system.drive = 1.0;
  const auto reference = brute_force(system, {0.0, 0.0}, 25, 40000);
  for (const Method method : {Method::explicit_pair, Method::radau}) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      const auto found = find(system, {0.1, 0.0}, {.tolerance = tolerance, .method = method});
      ASSERT_EQ(found.summary.status, PeriodicStatus::converged);
      EXPECT_GE(found.iterate.switches.size(), 2u);
      EXPECT_NEAR(found.start()[0], reference[0], 10.0 * tolerance + 1e-9) << tolerance;
      EXPECT_NEAR(found.start()[1], reference[1], 10.0 * tolerance + 1e-9) << tolerance;
    }
  }
}

TEST(Periodic, BilinearMonodromyAgreesWithDifferencesOfTheIterate) {
  BilinearOscillator<double> system;
  system.damping = 0.6;
  system.above = 1.5;
  system.drive = 1.0;
  const auto found = find(system, {0.1, 0.0}, {.tolerance = 1e-11});
  ASSERT_EQ(found.summary.status, PeriodicStatus::converged);
  // The mesh is frozen for derivatives, yet the switches move with the start: continuity makes that no error.
  double matrix[4];
  const double h = 1e-4;
  for (int n = 0; n < 2; ++n) {
    std::array<double, 2> more = found.start(), less = found.start();
    more[std::size_t(n)] += h;
    less[std::size_t(n)] -= h;
    Iterate<BilinearOscillator<double>> up, down;
    run_iterate<false>(system, more, {.tolerance = 1e-13}, up);
    run_iterate<false>(system, less, {.tolerance = 1e-13}, down);
    matrix[n] = (up.end[0] - down.end[0]) / (2.0 * h);
    matrix[2 + n] = (up.end[1] - down.end[1]) / (2.0 * h);
  }
  EXPECT_NEAR(found.summary.floquet_multiplier_max, spectral_radius(2, matrix), 1e-6);
}

TEST(Periodic, StiffOrbitConvergesByRadau) {
  const StiffFollower<double> system(1e6);
  const auto by_explicit = find(system, {0.0}, {.tolerance = 1e-8});
  EXPECT_EQ(by_explicit.summary.status, PeriodicStatus::too_many_steps);
  EXPECT_STREQ(describe(by_explicit.summary.status), "an iterate needs more steps than allowed");
  for (const double tolerance : {1e-4, 1e-8, 1e-11}) {
    const auto found = find(system, {0.0}, {.tolerance = tolerance, .method = Method::radau});
    ASSERT_EQ(found.summary.status, PeriodicStatus::converged) << tolerance;
    EXPECT_NEAR(found.start()[0], 1.0, 3.0 * tolerance);
    EXPECT_NEAR(found.integral(), pi, 10.0 * tolerance);
    EXPECT_NEAR(found.summary.floquet_multiplier_max, 0.0, 1e-6);
  }
}

TEST(Periodic, StabilityIsOnlyComputedWhereAsked) {
  const auto found = find(LinearOscillator<double>(0.7, 2.0), {0.0, 0.0}, {.tolerance = 1e-6, .stability = false});
  EXPECT_EQ(found.summary.status, PeriodicStatus::converged);
  EXPECT_TRUE(std::isnan(found.summary.floquet_multiplier_max));
}

/// x' = slope, x > floor.
template <class S>
struct Drift : TestSystem<S, 1> {
  using Base = TestSystem<S, 1>;
  double slope = 1.0;
  explicit Drift(double rise) : slope(rise) {}
  template <class T>
  Drift<T> cast() const {
    return Drift<T>(slope);
  }
  bool admissible(const typename Base::State& y) const { return y[0] > S(0.0); }
  template <bool>
  Rates<Drift> rates(const S&, const typename Base::State&, const typename Base::Signs&) const {
    return {{S(slope)}, {S(1.0)}, {S(1.0)}};
  }
};

TEST(Periodic, IterateIntoTheBarrierIsReportedWithItsPlace) {
  const auto found = find(Drift<double>(-1.0), {2.5}, {.tolerance = 1e-6});
  EXPECT_EQ(found.summary.status, PeriodicStatus::barrier);
  EXPECT_NEAR(found.summary.stop, 2.5, 1e-6);
  EXPECT_EQ(found.summary.iterates, 1);
}

TEST(Periodic, SystemWithoutAnOrbitEndsWithinItsIterates) {
  const auto found = find(Drift<double>(0.05), {2.5}, {.tolerance = 1e-6, .max_iterates = 40});
  EXPECT_EQ(found.summary.status, PeriodicStatus::not_converged);
  EXPECT_LE(found.summary.iterates, 42);
  EXPECT_GT(found.summary.residual, 0.3);
}

TEST(Periodic, UnstableOscillatorDoesNotPassForAnOrbit) {
  // Negative damping: iterates diverge, but Newton may still find the (unstable) orbit; either way it must say the
  // truth.
  const LinearOscillator<double> system(-0.5, 2.0);
  const auto found = find(system, {0.0, 0.0}, {.tolerance = 1e-6});
  if (found.summary.status == PeriodicStatus::converged) {
    EXPECT_GT(found.summary.floquet_multiplier_max, 1.0);
    EXPECT_NEAR(found.start()[0], system.cosine(), 1e-3);
  }
}

}  // namespace
}  // namespace wingbeat::solver

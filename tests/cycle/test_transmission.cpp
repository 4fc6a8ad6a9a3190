// A transmission that is no slider-crank through orbit, metrics, peaks and gradient.
#include "wingbeat/parts/transmission.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/stroke_law.hpp"
#include "wingbeat/cycle/cycle_gradient.hpp"
#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/extremes.hpp"
#include "wingbeat/solve/periodic.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

static_assert(Transmission<SliderCrank<double>, double>);
static_assert(Transmission<SliderCrank<Jet<2>>, Jet<2>>);
static_assert(Transmission<StrokeLaw<double>, double>);
static_assert(Transmission<StrokeLaw<Jet<2>>, Jet<2>>);
static_assert(!Transmission<HingeSpring<double>, double>);

const StrokeLaw<double> lopsided = {0.6, 0.08, 0.4, 0.1, 12e-3};

TEST(Transmission, SliderCrankReversesAtItsDeadCentres) {
  for (const double mid_stroke : {18e-3, 20e-3, 21e-3}) {
    const SliderCrank<double> crank = {5e-3, 20e-3, 7e-3, mid_stroke};
    const Reversals known = reversals(crank), found = find_reversals(crank);
    ASSERT_EQ(found.count, 2u);
    EXPECT_EQ(known.count, 2u);
    EXPECT_EQ(known.first_sign, found.first_sign);
    for (std::size_t n = 0; n < 2; ++n) EXPECT_NEAR(found.angle[n], known.angle[n], 1e-14);
  }
}

TEST(Transmission, ReversalsAreWhereTheStrokeTurns) {
  for (double phase = 0.0; phase < two_pi; phase += 0.45) {
    StrokeLaw<double> law = lopsided;
    law.phase = phase;
    const Reversals r = reversals(law);
    ASSERT_EQ(r.count, 2u) << phase;
    const auto slope = [&](double theta) {
      return crank_kinematics(law, std::sin(theta), std::cos(theta)).stroke_slope;
    };
    EXPECT_EQ(r.first_sign, sign_of(slope(1e-9)));
    double sign = r.first_sign;
    for (std::size_t n = 0; n < r.count; ++n) {
      EXPECT_NEAR(slope(r.angle[n]), 0.0, 1e-14);
      EXPECT_EQ(sign_of(slope(r.angle[n] - 1e-6)), sign);
      EXPECT_EQ(sign_of(slope(r.angle[n] + 1e-6)), -sign);
      sign = -sign;
    }
  }
  // More than two.
  const StrokeLaw<double> wavy = {0.6, 1.5, 0.4, 0.0, 12e-3};
  EXPECT_EQ(reversals(wavy).count, 4u);
}

TEST(Transmission, StrokeLawIsConsistent) {
  for (const double theta : {0.3, 1.4, 2.9, 4.1, 5.8}) {
    using J = Jet<1>;
    const auto dual = crank_kinematics(cast<J>(lopsided), sin(J(theta, 0)), cos(J(theta, 0)));
    const auto k = crank_kinematics(lopsided, std::sin(theta), std::cos(theta));
    EXPECT_NEAR(stroke_angle(dual).v[0], k.stroke_slope, 1e-15);
    EXPECT_NEAR(dual.stroke_slope.v[0], k.stroke_second_derivative, 1e-15);
  }
  const Reversals r = reversals(lopsided);
  const auto beta = [&](double theta) {
    return stroke_angle(crank_kinematics(lopsided, std::sin(theta), std::cos(theta)));
  };
  EXPECT_NEAR(stroke_amplitude(lopsided), 0.5 * std::abs(beta(r.angle[0]) - beta(r.angle[1])), 1e-14);
}

template <int N>
struct Orbit {
  using System = CrankSystem<double, N, StrokeLawVehicle<double>>;
  RecordedCycle<System> recorded;
  solver::PeriodicSummary summary;
  Metrics<double> metrics;
};

template <int N>
Orbit<N> orbit_of(const StrokeLawVehicle<double>& v, double tolerance) {
  using System = typename Orbit<N>::System;
  const double no_load = no_load_speed(v);
  typename System::State guess{no_load};
  if constexpr (N == 2) guess[1] = v.voltage / circuit_resistance(v);
  Orbit<N> orbit{{System(v, guess, 1e-4 * no_load), {}}, {}, {}};
  guess[0] = 0.6 * no_load;
  if constexpr (N == 2) guess[1] = algebraic_current(v, v.voltage, guess[0]);
  orbit.summary = solver::solve_periodic(orbit.recorded.system, guess, {.tolerance = tolerance}, orbit.recorded.cycle);
  EXPECT_EQ(orbit.summary.status, solver::PeriodicStatus::converged) << describe(orbit.summary.status);
  const auto extremes = cycle_extremes(orbit.recorded.system, orbit.recorded.cycle, tolerance);
  orbit.metrics =
      cycle_metrics(v, cycle_integrals(orbit.recorded.cycle), extremes, orbit.summary.floquet_multiplier_max, {});
  return orbit;
}

void expect_same(const Metrics<double>& a, const Metrics<double>& b, double tolerance) {
  for (int m = 0; m < metric_count; ++m) {
    const double x = a.values[std::size_t(m)], y = b.values[std::size_t(m)];
    if (std::isnan(x) && std::isnan(y)) continue;
    // Nothing but rounding, beside the power that it is a difference of; and a multiplier is no metric of the cycle.
    if (Metric(m) == Metric::power_residual || Metric(m) == Metric::floquet_multiplier_max) continue;
    EXPECT_NEAR(x, y, tolerance * std::abs(y)) << metric_table()[std::size_t(m)].key;
  }
}

template <int N>
void expect_the_orbit_not_to_know_where_angles_start() {
  StrokeLawVehicle<double> v = stroke_law_vehicle(lopsided);
  if (N == 1) v.motor.armature_inductance = 0.0;
  const Orbit<N> orbit = orbit_of<N>(v, 1e-10);
  EXPECT_GT(orbit.metrics[Metric::frequency], 5.0);
  const EnergyAudit audit = energy_audit(orbit.metrics);
  EXPECT_NEAR(audit.imbalance, 0.0, 1e-9 * audit.electrical);
  EXPECT_NEAR(audit.residual, 0.0, 1e-14 * audit.electrical);
  // electronics_power() is of Vehicle alone.
  EXPECT_TRUE(std::isnan(orbit.metrics[Metric::power_electronics]));
  for (double phase = 0.0; phase < two_pi; phase += 0.45) {
    v.transmission.phase = phase;
    expect_same(orbit_of<N>(v, 1e-10).metrics, orbit.metrics, 2e-9);
  }
}
TEST(StrokeLawOrbit, DoesNotDependOnWhereTheCrankAngleIsCountedFrom) {
  expect_the_orbit_not_to_know_where_angles_start<1>();
  expect_the_orbit_not_to_know_where_angles_start<2>();
}

TEST(StrokeLawOrbit, IsWhatTheEquationsReachInTime) {
  const StrokeLawVehicle<double> v = stroke_law_vehicle(lopsided);
  const Orbit<2> orbit = orbit_of<2>(v, 1e-9);
  // The classical Runge-Kutta method with branches chosen on the spot, from rest until the cycle repeats.
  using State = std::array<double, 3>;
  const auto rates = [&](const State& y) -> State {
    const double s = std::sin(y[0]), c = std::cos(y[0]);
    const double stroke = sign_of(crank_kinematics(v.transmission, s, c).stroke_slope * y[1]);
    Mode<double> mode{stroke, 1.0, sign_of(y[1]), 1.0};
    Motion<double> m = motion_at(v, MotionState<double>{configuration_at(v, s, c), y[1], y[2], v.voltage}, mode);
    if (m.force_switch < 0.0) {
      mode.force = -1.0;
      m = motion_at(v, MotionState<double>{configuration_at(v, s, c), y[1], y[2], v.voltage}, mode);
    }
    return {y[1], m.crank_acceleration, m.inductive_voltage / v.motor.armature_inductance};
  };
  const double dt = 4e-6;
  State y = {0.0, 0.5 * no_load_speed(v), 0.1};
  double turn = two_pi, passed = 0.0, period = 0.0;
  for (int n = 0; n < 400000; ++n) {
    const auto moved = [&](const State& by, double h) {
      return State{y[0] + h * by[0], y[1] + h * by[1], y[2] + h * by[2]};
    };
    const State k1 = rates(y), k2 = rates(moved(k1, 0.5 * dt)), k3 = rates(moved(k2, 0.5 * dt)),
                k4 = rates(moved(k3, dt));
    State next;
    for (std::size_t j = 0; j < 3; ++j) next[j] = y[j] + dt / 6.0 * (k1[j] + 2.0 * (k2[j] + k3[j]) + k4[j]);
    if (next[0] >= turn) {
      const double crossed = dt * (n + (turn - y[0]) / (next[0] - y[0]));
      period = crossed - passed;
      passed = crossed;
      turn += two_pi;
    }
    y = next;
  }
  EXPECT_NEAR(1.0 / period, orbit.metrics[Metric::frequency], 1e-6 * orbit.metrics[Metric::frequency]);
}

TEST(StrokeLawOrbit, GradientAgreesWithDifferences) {
  const StrokeLawVehicle<double> v = stroke_law_vehicle(lopsided);
  const double tolerance = 1e-12;
  const Orbit<2> orbit = orbit_of<2>(v, tolerance);
  const auto parameters = []<class S>(StrokeLawVehicle<S>& vehicle) {
    return std::array{&vehicle.transmission.amplitude, &vehicle.transmission.second, &vehicle.transmission.radius,
                      &vehicle.spring.stiffness, &vehicle.motor.torque_constant};
  };
  auto jets = cast<GradientJet>(v);
  for (int k = 0; k < gradient_parameters; ++k) {
    GradientJet& p = *parameters(jets)[std::size_t(k)];
    p = gradient_seed(p.a, k);
  }
  CycleGradient<Orbit<2>::System> cycle(orbit.recorded, jets);
  ASSERT_TRUE(cycle.run());
  const auto gradient = cycle_metrics(jets, cycle.integrals(), cycle.extremes(), GradientJet(absent), {});
  for (int k = 0; k < gradient_parameters; ++k) {
    const auto metrics_at = [&](double by) {
      StrokeLawVehicle<double> moved = v;
      *parameters(moved)[std::size_t(k)] *= 1.0 + by;
      return orbit_of<2>(moved, tolerance).metrics;
    };
    const double h = 2e-4;
    const auto p1 = metrics_at(h), m1 = metrics_at(-h), p2 = metrics_at(2.0 * h), m2 = metrics_at(-2.0 * h);
    const double value = *parameters(const_cast<StrokeLawVehicle<double>&>(v))[std::size_t(k)];
    for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::power_friction,
                           Metric::power_aerodynamic, Metric::lift_mean, Metric::lift_peak, Metric::rod_force_peak,
                           Metric::stroke_amplitude, Metric::flapping_velocity_peak, Metric::crank_speed_min}) {
      const double difference = (8.0 * (p1[m] - m1[m]) - (p2[m] - m2[m])) / (12.0 * h);
      const double exact = gradient[m].v[gradient_first_slot + k] * value;
      EXPECT_NEAR(exact, difference, 1e-6 * (std::abs(orbit.metrics[m]) + std::abs(difference)))
          << metric_table()[std::size_t(m)].key << " by parameter " << k;
    }
  }
}

}  // namespace
}  // namespace wingbeat

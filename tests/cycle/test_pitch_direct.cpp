// A direct drive whose wings pitch on a hinge: closed forms, limits, energy balance, stops.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "cycle/pitch_phase.hpp"
#include "vehicle/pitching_vehicle.hpp"
#include "vehicle/recorded_impacts.hpp"
#include "vehicle/return_map_derivative.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/cycle/pitch_metrics.hpp"
#include "wingbeat/cycle/record.hpp"
#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/solve/periodic.hpp"

namespace wingbeat {
namespace {

using PitchSystem = PitchDirectSystem<double, 5>;
using Complex = std::complex<double>;

PitchSystem pitch_system(const Vehicle<double>& v) { return {v, {0.5, 60.0, 0.1, 0.5, 60.0}}; }

struct PitchOrbit {
  PitchSystem system;
  solver::Iterate<PitchSystem> cycle;
  solver::PeriodicSummary summary;

  double total(std::size_t which) const {
    double sum = 0.0;
    for (const auto& step : cycle.steps) sum += step.dq[which];
    return sum;
  }
  double total(Integral which) const { return total(std::size_t(which)); }
};

PitchOrbit pitch_orbit(const PitchSystem& system, double tolerance, const PitchSystem::State& guess = {},
                       solver::Method method = solver::Method::explicit_pair) {
  PitchOrbit orbit{system, {}, {}};
  const solver::PeriodicOptions options{.tolerance = tolerance, .method = method, .max_steps = 2000};
  orbit.summary = solver::solve_periodic(system, guess, options, orbit.cycle);
  EXPECT_EQ(orbit.summary.status, solver::PeriodicStatus::converged) << describe(orbit.summary.status);
  return orbit;
}

/// Everything that the supply gives, less where it goes, over the supply's.
double pitch_imbalance(const PitchOrbit& orbit) {
  const Motor<double>& m = orbit.system.vehicle.motor;
  const double given = orbit.total(Integral::electrical_work);
  const double taken = m.armature_resistance * orbit.total(Integral::current_square) +
                       m.viscous_damping * orbit.total(Integral::speed_square) + orbit.total(Integral::friction_work) +
                       orbit.total(Integral::aero_work) + orbit.total(PitchSystem::hinge_work);
  return (given - taken) / given;
}

// Small swings without air: three linear equations in complex amplitudes.
TEST(PitchDirect, SmallSwingsInVacuumAreTheComplexImpedances) {
  for (const double stiffness : {5e-5, 1e-3}) {
    Vehicle<double> vehicle = pitching_vehicle(stiffness, 1e-6, Condition::vacuum);
    PitchSystem system = pitch_system(vehicle);
    system.typical = {2e-7, 2e-5, 3e-8, 2e-7, 2e-5};
    const PitchOrbit orbit = pitch_orbit(system, 1e-10);
    const Vehicle<double>& v = vehicle;
    const double w = two_pi * v.drive_frequency, K = v.motor.torque_constant, N = v.wing_count;
    const Complex j(0.0, 1.0), Z = v.motor.armature_resistance + j * w * v.motor.armature_inductance;
    const Complex bb = -w * w * (v.motor.inertia + N * v.wing_inertia) + N * v.spring.stiffness +
                       j * w * (v.motor.viscous_damping + v.friction.damping + K * K / Z);
    const Complex pp =
        -w * w * vehicle.pitch.pitch_inertia + vehicle.pitch.hinge.stiffness + j * w * vehicle.pitch.hinge.damping;
    const Complex bp = -w * w * vehicle.pitch.mass_product;
    const Complex beta = K * v.voltage / Z / (bb - bp * bp / pp), psi = -bp / pp * beta;
    const Complex current = (v.voltage - K * j * w * beta) / Z;
    const double expected[] = {beta.imag(), (j * w * beta).imag(), current.imag(), psi.imag(), (j * w * psi).imag()};
    const double sizes[] = {std::abs(beta), w * std::abs(beta), std::abs(current), std::abs(psi), w * std::abs(psi)};
    const PitchMetrics m = pitch_metrics(system, orbit.cycle);
    EXPECT_NEAR(m.amplitude, std::abs(psi), 1e-8 * std::abs(psi));
    EXPECT_NEAR(m.phase, std::arg(psi / (-j * beta)), 1e-7);
    EXPECT_NEAR(m.angle_of_attack_max, 0.5 * pi, 2.0 * std::abs(psi));
    for (std::size_t n = 0; n < 5; ++n) {
      EXPECT_NEAR(orbit.cycle.steps.front().y[n], expected[n], 1e-8 * sizes[n]) << n << " at " << stiffness;
    }
  }
}

// Without damping a period turns each mode by its frequency: the trace of the return map is 2 sum cos(w_k T).
TEST(PitchDirect, ModesInVacuumHaveTheirClosedFormFrequencies) {
  Vehicle<double> v = pitching_vehicle(3e-4, 0.0, Condition::vacuum);
  v.motor.viscous_damping = v.friction.damping = v.pitch.hinge.damping = 0.0;
  v.motor.armature_inductance = 0.0;
  v.motor.armature_resistance = 1e12;
  using Undamped = PitchDirectSystem<double, 4>;
  const Undamped system{v, {1e-6, 1e-4, 1e-6, 1e-4}};
  solver::Iterate<Undamped> cycle;
  solver::run_iterate<true>(system, {1e-6, 0.0, 1e-6, 0.0}, {.tolerance = 1e-12, .max_steps = 5000}, cycle);
  ASSERT_EQ(cycle.status, solver::IterateStatus::complete);
  const auto M = solver::monodromy(system, system.cast<Jet<4>>(), cycle);

  const double bb = v.motor.inertia + v.wing_count * v.wing_inertia, bp = v.pitch.mass_product,
               pp = v.pitch.pitch_inertia;
  const double k = v.wing_count * v.spring.stiffness, k_psi = v.pitch.hinge.stiffness;
  const double a = bb * pp - bp * bp, b = bb * k_psi + pp * k, c = k * k_psi;
  const double root = std::sqrt(b * b - 4.0 * a * c), T = 1.0 / v.drive_frequency;
  const double w1 = std::sqrt((b - root) / (2.0 * a)), w2 = std::sqrt((b + root) / (2.0 * a));
  EXPECT_LT(w1, 0.99 * two_pi * 22.0);  // below either oscillator alone
  double trace = 0.0;
  for (std::size_t n = 0; n < 4; ++n) trace += M[5 * n];
  EXPECT_NEAR(trace, 2.0 * (std::cos(w1 * T) + std::cos(w2 * T)), 1e-9);
}

TEST(PitchDirect, EnergyBalanceClosesToTheToleranceAndAddedMassTakesNoMeanPower) {
  for (const double stiffness : {2e-4, 8e-4}) {
    Vehicle<double> v = pitching_vehicle(stiffness);
    double with_air = 0.0;
    for (const bool added_mass : {true, false}) {
      if (!added_mass) v.pitch.air = {};
      const PitchOrbit orbit = pitch_orbit(pitch_system(v), 1e-10);
      EXPECT_NEAR(pitch_imbalance(orbit), 0.0, 1e-10) << stiffness;
      EXPECT_GT(orbit.total(PitchSystem::hinge_work), 0.0);
      EXPECT_LT(orbit.summary.floquet_multiplier_max, 1.0);
      const double lift = orbit.total(Integral::lift);
      if (added_mass) with_air = lift;
      else EXPECT_GT(std::abs(with_air / lift - 1.0), 1e-3);
    }
    for (const double tolerance : {1e-4, 1e-7}) {
      EXPECT_NEAR(pitch_imbalance(pitch_orbit(pitch_system(pitching_vehicle(stiffness)), tolerance)), 0.0,
                  3.0 * tolerance);
    }
  }
}

// A hinge that hardly yields: a wing upright, 90 degrees of angle of attack, as under a law without pitching.
TEST(PitchDirect, StiffHingesAreTheLawWithoutPitching) {
  Vehicle<double> v = pitching_vehicle(1e-2);
  Vehicle<double> law = v;
  law.wings.pitch_coefficient = 0.0;
  law.wings.added_inertia = added_inertia_of(law.wings.air_density, v.pitch.moments.s22);
  // C_D of the normal-force set at 90 degrees.
  law.wings.coefficients.drag = {3.45, 0.0, 1.0, 0.0};
  using Law = DirectSystem<double, 3>;
  solver::Iterate<Law> cycle;
  const auto found = solver::solve_periodic(Law(law, {0.5, 60.0, 0.1}), {}, {.tolerance = 1e-9}, cycle);
  ASSERT_EQ(found.status, solver::PeriodicStatus::converged);
  const CycleIntegrals<double> expected = cycle_integrals(cycle);
  double before = 1.0;
  for (const double stiffness : {5e-3, 2e-2, 8e-2}) {
    v.pitch.hinge.stiffness = 2.0 * stiffness;
    v.pitch.hinge.damping = 0.2 * std::sqrt(2.0 * stiffness * v.pitch.pitch_inertia);
    const PitchOrbit orbit = pitch_orbit(pitch_system(v), 1e-9);
    double off = 0.0;
    for (const Integral which : {Integral::current_square, Integral::aero_work, Integral::speed_square}) {
      off = std::max(off, std::abs(orbit.total(which) / expected[std::size_t(which)] - 1.0));
    }
    EXPECT_LT(off, 0.35 * before) << stiffness;
    before = off;
  }
  EXPECT_LT(before, 1e-2);
}

TEST(PitchDirect, StopsHoldTheWingsAndTakeTheEnergyOfImpacts) {
  Vehicle<double> v = pitching_vehicle(2e-4);
  double largest = 0.0;
  for (const auto& step : pitch_orbit(pitch_system(v), 1e-8).cycle.steps)
    largest = std::max(largest, std::abs(step.y[PitchSystem::pitch]));
  set_stops(v.pitch.hinge, 0.7 * largest);
  for (const double tolerance : {1e-6, 1e-10}) {
    const PitchOrbit orbit = pitch_orbit(pitch_system(v), tolerance);
    int held = 0, impacts = 0;
    for (std::size_t n = 0; n < orbit.cycle.steps.size(); ++n) {
      const auto& step = orbit.cycle.steps[n];
      EXPECT_LE(std::abs(step.y[PitchSystem::pitch]), v.pitch.hinge.stop_high * (1.0 + 1e-9));
      held += step.signs[PitchSystem::held] < 0.0;
      EXPECT_TRUE(step.signs[PitchSystem::held] > 0.0 || step.y[PitchSystem::pitch + 1] == 0.0);
      if (n > 0) impacts += step.signs[PitchSystem::impacts] != orbit.cycle.steps[n - 1].signs[PitchSystem::impacts];
    }
    const PitchMetrics m = pitch_metrics(orbit.system, orbit.cycle);
    EXPECT_NEAR(m.amplitude, v.pitch.hinge.stop_high, 1e-12);
    EXPECT_NEAR(m.angle_of_attack_min, 0.5 * pi - v.pitch.hinge.stop_high, 1e-12);
    EXPECT_GT(held, 2);
    EXPECT_GE(impacts, 2);
    EXPECT_GT(impact_loss(orbit.system, orbit.cycle), 1e-4 * orbit.total(Integral::electrical_work));
    EXPECT_NEAR(pitch_imbalance(orbit), 0.0, 3.0 * tolerance);
    EXPECT_LT(orbit.summary.floquet_multiplier_max, 1.0);
  }
}

// The lift of the added mass is the rate of the air's momentum normal to the chord times -sin(psi): by parts, impacts
// included, its mean is that of the momentum times psi' cos(psi).
TEST(PitchDirect, MeanLiftHasTheImpulsesOfImpacts) {
  Vehicle<double> v = pitching_vehicle(2e-4);
  set_stops(v.pitch.hinge, 0.5);
  const PitchOrbit orbit = pitch_orbit(pitch_system(v), 1e-10);
  const PitchSystem& system = orbit.system;
  double expected = 0.0, without_impacts = 0.0;
  for (const auto& step : orbit.cycle.steps) {
    const auto end = solver::evaluate_inside<true>(system, orbit.cycle, step, step.x + step.h);
    without_impacts += end.dq[std::size_t(Integral::lift)];
    for (std::size_t k = 0; k < detail::gauss_nodes.size(); ++k) {
      const double x = step.x + 0.5 * (1.0 + detail::gauss_nodes[k]) * step.h;
      const auto y = solver::evaluate_inside<false>(system, orbit.cycle, step, x).y;
      const double velocity = step.signs[PitchSystem::held] < 0.0 ? 0.0 : y[PitchSystem::pitch + 1];
      const PitchState<double> state = pitch_state(y[PitchSystem::pitch], velocity, y[1]);
      const PitchAeroLoads<double> air = aero_loads(v.wings, v.pitch, state, sign_of(y[1]), sign_of(velocity));
      const double momentum = v.pitch.air.r * y[1] * state.cos_psi + v.pitch.air.p * velocity;
      const double lift = momentum * velocity * state.cos_psi - air.normal_force * state.sin_psi;
      expected += 0.5 * step.h * detail::gauss_weights[k] * lift / system.phase_rate();
    }
  }
  EXPECT_NEAR(orbit.total(Integral::lift), expected, 1e-6 * std::abs(expected));
  EXPECT_GT(std::abs(without_impacts - expected), 1e-3 * std::abs(expected));
}

TEST(PitchDirect, PhaseIsThatOfTheSolutionsOwnValues) {
  for (const solver::Method method : {solver::Method::explicit_pair, solver::Method::radau}) {
    for (const double stop : {infinity, 0.5}) {
      Vehicle<double> v = pitching_vehicle(2e-4);
      set_stops(v.pitch.hinge, stop);
      const PitchOrbit orbit = pitch_orbit(pitch_system(v), 1e-6, {}, method);
      const double own = phase_by_own_values(orbit.system, orbit.cycle);
      EXPECT_NEAR(pitch_metrics(orbit.system, orbit.cycle).phase, own, 5e-8) << int(method) << ", stop " << stop;
    }
  }
}

// The saltation matrix of impacts, against two iterates from starts a little apart.
TEST(PitchDirect, DerivativeOfTheReturnMapCrossesImpacts) {
  Vehicle<double> v = pitching_vehicle(2e-4);
  set_stops(v.pitch.hinge, 0.5);
  const PitchSystem system = pitch_system(v);
  const auto cycle =
      expect_return_map_derivative(system, {0.3, -20.0, 0.05, 0.1, 10.0}, {1e-4, 1e-2, 1e-4, 1e-4, 1e-2}, 3e-4);
  EXPECT_GT(impact_loss(system, cycle), 0.0);
}

}  // namespace
}  // namespace wingbeat

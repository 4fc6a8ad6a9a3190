// A crank whose wings pitch on a hinge: energy balance, the limit of a stiff hinge, stops, the return map's derivative.
#include <gtest/gtest.h>

#include <cmath>

#include "cycle/pitch_phase.hpp"
#include "vehicle/pitching_vehicle.hpp"
#include "vehicle/recorded_impacts.hpp"
#include "vehicle/return_map_derivative.hpp"
#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/cycle/pitch_metrics.hpp"
#include "wingbeat/cycle/record.hpp"
#include "wingbeat/cycle/recorded_cycle.hpp"
#include "wingbeat/solve/periodic.hpp"

namespace wingbeat {
namespace {

using PitchCrank = PitchCrankSystem<double, 4>;

PitchCrank pitch_crank(double stiffness, double stop = infinity, double friction_radius = 2.5e-3,
                       Formulation formulation = Formulation::virtual_work) {
  const Vehicle<double> hinged = pitching_vehicle(stiffness);
  Design<double> d = reference_design();
  d.transmission.formulation = formulation;
  d.friction.coefficient = friction_radius;
  Vehicle<double> v = resolve(d);
  v.wings = hinged.wings;
  v.pitch = hinged.pitch;
  set_stops(v.pitch.hinge, stop);
  return {v, {138.0, 0.1, 0.5, 60.0}, 1.0};
}

struct PitchCrankOrbit {
  solver::Iterate<PitchCrank> cycle;
  solver::PeriodicSummary summary;

  double total(std::size_t which) const {
    double sum = 0.0;
    for (const auto& step : cycle.steps) sum += step.dq[which];
    return sum;
  }
  double total(Integral which) const { return total(std::size_t(which)); }
};

PitchCrankOrbit crank_orbit(const PitchCrank& system, double tolerance,
                            solver::Method method = solver::Method::explicit_pair) {
  PitchCrankOrbit orbit;
  const PitchCrank::State guess{120.0, 0.1, 0.0, 0.0};
  orbit.summary =
      solver::solve_periodic(system, guess, {.tolerance = tolerance, .method = method, .max_steps = 2000}, orbit.cycle);
  EXPECT_EQ(orbit.summary.status, solver::PeriodicStatus::converged) << describe(orbit.summary.status);
  return orbit;
}

double crank_imbalance(const PitchCrank& system, const PitchCrankOrbit& orbit) {
  const Motor<double>& m = system.vehicle.motor;
  const double given = orbit.total(Integral::electrical_work);
  const double taken = m.armature_resistance * orbit.total(Integral::current_square) +
                       m.viscous_damping * orbit.total(Integral::speed_square) + orbit.total(Integral::friction_work) +
                       orbit.total(Integral::aero_work) + orbit.total(Integral::residual_work) +
                       orbit.total(PitchCrank::hinge_work);
  return (given - taken) / given;
}

TEST(PitchCrank, EnergyBalanceClosesToTheTolerance) {
  for (const Formulation formulation : {Formulation::virtual_work, Formulation::rod_force}) {
    for (const double tolerance : {1e-6, 1e-10}) {
      const PitchCrank system = pitch_crank(8e-4, infinity, 2.5e-3, formulation);
      const PitchCrankOrbit orbit = crank_orbit(system, tolerance);
      EXPECT_NEAR(crank_imbalance(system, orbit), 0.0, 3.0 * tolerance);
      EXPECT_LT(orbit.summary.floquet_multiplier_max, 1.0);
      if (formulation == Formulation::virtual_work) {
        EXPECT_NEAR(orbit.total(Integral::residual_work) / orbit.total(Integral::electrical_work), 0.0, 1e-13);
      }
    }
  }
}

TEST(PitchCrank, StiffHingesAreTheLawWithoutPitching) {
  Vehicle<double> law = pitch_crank(1e-2).vehicle;
  law.wings.pitch_coefficient = 0.0;
  law.wings.added_inertia = added_inertia_of(law.wings.air_density, pitch_crank(1e-2).vehicle.pitch.moments.s22);
  law.wings.coefficients.drag = {3.45, 0.0, 1.0, 0.0};  // C_N of the normal-force set at 90 degrees
  using Law = CrankSystem<double, 2>;
  solver::Iterate<Law> cycle;
  const auto found = solver::solve_periodic(Law(law, {120.0, 0.3}, 1.0), {120.0, 0.1}, {.tolerance = 1e-9}, cycle);
  ASSERT_EQ(found.status, solver::PeriodicStatus::converged);
  const CycleIntegrals<double> expected = cycle_integrals(cycle);
  double before = 1.0;
  for (const double stiffness : {5e-3, 2e-2, 8e-2}) {
    PitchCrank system = pitch_crank(stiffness);
    system.vehicle.pitch.hinge.damping = 0.2 * std::sqrt(2.0 * stiffness * system.vehicle.pitch.pitch_inertia);
    const PitchCrankOrbit orbit = crank_orbit(system, 1e-9);
    double off = 0.0;
    for (const Integral which : {Integral::time, Integral::current_square, Integral::aero_work}) {
      off = std::max(off, std::abs(orbit.total(which) / expected[std::size_t(which)] - 1.0));
    }
    EXPECT_LT(off, 0.35 * before) << stiffness;
    before = off;
  }
  EXPECT_LT(before, 1e-2);
}

TEST(PitchCrank, PhaseIsThatOfTheSolutionsOwnValues) {
  for (const solver::Method method : {solver::Method::explicit_pair, solver::Method::radau}) {
    for (const double stop : {infinity, 0.35}) {
      const PitchCrank system = pitch_crank(stop < 1.0 ? 2e-4 : 8e-4, stop);
      const PitchCrankOrbit orbit = crank_orbit(system, 1e-6, method);
      const double own = phase_by_own_values(system, orbit.cycle);
      EXPECT_NEAR(pitch_metrics(system, orbit.cycle).phase, own, 5e-8) << int(method) << ", stop " << stop;
    }
  }
}

TEST(PitchCrank, StopsHoldTheWingsAndTakeTheEnergyOfImpacts) {
  for (const double friction_radius : {0.0, 2.5e-3}) {
    const PitchCrank system = pitch_crank(2e-4, 0.35, friction_radius);
    const PitchCrankOrbit orbit = crank_orbit(system, 1e-10);
    int held = 0;
    for (const auto& step : orbit.cycle.steps) held += step.signs[PitchCrank::held] < 0.0;
    EXPECT_GT(held, 2);
    const PitchMetrics m = pitch_metrics(system, orbit.cycle);
    EXPECT_NEAR(m.amplitude, 0.35, 1e-12);
    EXPECT_NEAR(m.angle_of_attack_min, 0.5 * pi - 0.35, 1e-12);
    EXPECT_LT(std::abs(m.phase), 1.0);
    EXPECT_GT(impact_loss(system, orbit.cycle), 0.0);
    EXPECT_NEAR(crank_imbalance(system, orbit), 0.0, 3e-10);
    EXPECT_LT(orbit.summary.floquet_multiplier_max, 1.0);
  }
}

TEST(PitchCrank, DerivativeOfTheReturnMapCrossesImpacts) {
  const PitchCrank system = pitch_crank(2e-4, 0.35);
  const auto cycle = expect_return_map_derivative(system, {130.0, 0.1, 0.1, 10.0}, {2e-3, 1e-5, 1e-5, 1e-3}, 1e-3);
  EXPECT_GT(impact_loss(system, cycle), 0.0);
}

}  // namespace
}  // namespace wingbeat

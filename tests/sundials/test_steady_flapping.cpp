// The orbit solver on vehicles: known orbits, closed forms, energy balance, ways of not flapping.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vehicle/known_orbits.hpp"
#include "vehicle/random_vehicle.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/solve/iterate.hpp"
#include "wingbeat/solve/linear.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

using ::testing::HasSubstr;

constexpr double tightest = 1e-12;

/// Largest relative deviation of metrics, the residual power and the Floquet multiplier apart: these may be zero.
double largest_deviation(const Metrics<double>& a, const Metrics<double>& b, std::string* where = nullptr) {
  double largest = 0.0;
  for (int k = 0; k < metric_count; ++k) {
    if (Metric(k) == Metric::power_residual || Metric(k) == Metric::floquet_multiplier_max) continue;
    const double x = a.values[std::size_t(k)], y = b.values[std::size_t(k)];
    // An angle of attack near zero degrees has no meaningful relative error.
    const double scale = Metric(k) == Metric::angle_of_attack_min ? std::max(std::abs(x), 10.0) : std::abs(x);
    EXPECT_EQ(std::isnan(x), std::isnan(y)) << metric_table()[std::size_t(k)].key;
    if (std::isnan(x) || scale == 0.0) continue;
    const double deviation = std::abs(y - x) / scale;
    if (deviation > largest) {
      largest = deviation;
      if (where) *where = metric_table()[std::size_t(k)].key;
    }
  }
  return largest;
}

TEST(SteadyFlapping, ReproducesKnownOrbitsToTheToleranceAskedFor) {
  for (const KnownOrbit& known : known_orbits) {
    const Vehicle<double> vehicle = reference_vehicle(known.springs);
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, tightest}) {
      const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = tolerance});
      ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
      const auto near = [&](double value, double expected) {
        EXPECT_NEAR(value / expected, 1.0, tolerance) << "tolerance " << tolerance << ", springs " << known.springs;
      };
      const WaveformRow bottom = found.record.at(1.5 * pi);
      near(bottom.crank_speed, known.crank_speed);
      near(bottom.current, known.current);
      near(found.metrics[Metric::frequency], known.frequency);
      near(found.metrics[Metric::power_electrical], known.power_electrical);
      near(found.metrics[Metric::lift_mean], known.lift_mean);
      near(found.metrics[Metric::rod_force_mean], known.rod_force_mean);
      near(found.metrics[Metric::rod_force_peak], known.rod_force_peak);
    }
  }
}

TEST(SteadyFlapping, LocatesTheSignChangesOfTheRodForce) {
  for (const KnownOrbit& known : known_orbits) {
    const SteadyFlapping found = find_steady_flapping(reference_vehicle(known.springs), {.tolerance = tightest});
    for (const double kink : known.kinks) {
      EXPECT_LT(found.record.at(kink - 1e-5).rod_force * found.record.at(kink + 1e-5).rod_force, 0.0);
      EXPECT_NEAR(found.record.at(kink).rod_force, 0.0, 1e-9);
    }
  }
}

TEST(SteadyFlapping, TakesAFewCyclesFromACoarseGuess) {
  const SteadyFlapping found = find_steady_flapping(reference_vehicle(), {.tolerance = 1e-6});
  EXPECT_LE(found.summary.iterates, 6);
  EXPECT_LE(found.summary.residual, 1e-6);
  EXPECT_EQ(found.summary.newton_steps, 0);
  EXPECT_NEAR(found.metrics[Metric::floquet_multiplier_max], 9.7514e-5, 1e-8);
}

// docs/numerics.md quotes these numbers.
TEST(SteadyFlapping, StartsFromTheEnergyAtTheBalancedSpeed) {
  for (const bool springs : {false, true}) {
    const Vehicle<double> vehicle = reference_vehicle(springs);
    const OrbitGuess guess = guess_orbit(vehicle);
    const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = 1e-9});
    EXPECT_NEAR(guess.crank_speed / found.crank_speed - 1.0, springs ? 0.032 : 0.056, 5e-4);
    EXPECT_NEAR(guess.balanced.slowest / found.crank_speed - 1.0, springs ? 0.089 : 0.209, 5e-4);
    const double multiplier = found.metrics[Metric::floquet_multiplier_max];
    EXPECT_GT(guess.multiplier, 0.5 * multiplier);
    EXPECT_LT(guess.multiplier, 5.0 * multiplier);
  }
}

/// Near stall, without springs, the speed is what friction leaves of the motor's torque over its braking.
TEST(SteadyFlapping, CreepsNearStall) {
  Vehicle<double> vehicle = reference_vehicle();
  for (const double left : {1e-2, 3e-3}) {
    vehicle.motor.friction_torque = (1.0 - left) * stall_torque(vehicle);
    const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = 1e-6});
    ASSERT_EQ(found.status, FlappingStatus::flapping) << left;
    const Motor<double>& m = vehicle.motor;
    const double braking = m.torque_constant * m.torque_constant / circuit_resistance(vehicle) + m.viscous_damping;
    const double creep = left * stall_torque(vehicle) / braking;
    EXPECT_NEAR(found.metrics[Metric::frequency] * two_pi / creep, 1.0, 0.05) << left;
    EXPECT_LT(std::abs(found.metrics[Metric::power_residual]), 1e-6 * found.metrics[Metric::power_electrical]);
  }
}

TEST(SteadyFlapping, FloquetMultiplierIsThatOfTheCycleMapByDifferences) {
  const Vehicle<double> vehicle = reference_vehicle(true);
  const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = tightest});
  CrankSystem<double, 2> system{vehicle, {100.0, 1.0 / 3.0}, 1e-3};
  solver::Iterate<CrankSystem<double, 2>> cycle;
  solver::IterateOptions options{.tolerance = 1e-13};
  // The return map's derivative by central differences; its eigenvalues are a complex pair here.
  double matrix[4];
  const double size[2] = {1e-4 * found.crank_speed, 1e-4 * found.current};
  for (std::size_t column = 0; column < 2; ++column) {
    std::array<double, 2> ends[2];
    for (const int side : {0, 1}) {
      std::array<double, 2> y = {found.crank_speed, found.current};
      y[column] += (side == 0 ? -1.0 : 1.0) * size[column];
      solver::run_iterate<false>(system, y, options, cycle);
      ends[side] = cycle.end;
    }
    for (std::size_t row = 0; row < 2; ++row) {
      matrix[2 * row + column] = (ends[1][row] - ends[0][row]) / (2.0 * size[column]);
    }
  }
  EXPECT_NEAR(solver::spectral_radius(2, matrix) / found.metrics[Metric::floquet_multiplier_max], 1.0, 1e-4);
}

TEST(SteadyFlapping, WinglessSpeedIsTheClosedForm) {
  for (const double inductance : {29e-3, 1e-7, 0.0}) {
    Vehicle<double> vehicle = wingless_vehicle();
    vehicle.motor.armature_inductance = inductance;
    const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = tightest});
    ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
    const double omega = no_load_speed(vehicle.motor, vehicle.voltage);
    EXPECT_NEAR(found.metrics[Metric::frequency] * two_pi / omega, 1.0, 1e-11);
    EXPECT_NEAR(found.metrics[Metric::current_mean] / (vehicle.motor.viscous_damping * omega / 0.01), 1.0, 1e-10);
    EXPECT_EQ(found.metrics[Metric::lift_mean], 0.0);
    EXPECT_EQ(found.metrics[Metric::rod_force_peak], 0.0);
    EXPECT_TRUE(std::isnan(found.metrics[Metric::efficiency_mechanism]));
  }
}

TEST(SteadyFlapping, VacuumWithoutFrictionCostsMotorLossesOnly) {
  Vehicle<double> vehicle = reference_vehicle(true);
  vehicle.transmission.slider_crank.formulation = Formulation::virtual_work;
  vehicle.friction.radius = 0.0;
  vehicle.wings.air_density = 0.0;
  const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = tightest});
  ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
  const EnergyAudit audit = energy_audit(found.metrics);
  EXPECT_NEAR((audit.copper + audit.viscous) / audit.electrical, 1.0, 1e-11);
  EXPECT_EQ(audit.aerodynamic, 0.0);
  EXPECT_EQ(audit.friction, 0.0);
}

TEST(SteadyFlapping, EnergyBooksCloseAndTightenWithTheTolerance) {
  for (const bool springs : {false, true}) {
    for (const Formulation formulation : {Formulation::rod_force, Formulation::virtual_work}) {
      Vehicle<double> vehicle = reference_vehicle(springs);
      vehicle.transmission.slider_crank.formulation = formulation;
      for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, tightest}) {
        const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = tolerance});
        const EnergyAudit audit = energy_audit(found.metrics);
        EXPECT_LT(std::abs(audit.imbalance), tolerance * audit.electrical);
        if (formulation == Formulation::virtual_work) {
          EXPECT_LT(std::abs(audit.residual), 1e-15) << "virtual work conserves power identically";
        } else {
          EXPECT_GT(audit.residual, 0.05 * found.metrics[Metric::power_motor]) << "about a tenth of P_m";
          EXPECT_LT(audit.residual, 0.15 * found.metrics[Metric::power_motor]);
        }
      }
    }
  }
}

TEST(SteadyFlapping, MetricsOfRandomVehiclesMeetTheToleranceAskedFor) {
  std::mt19937_64 random(20220101);
  int flapping = 0, outside = 0;
  for (int n = 0; n < 400; ++n) {
    const Design<double> design = random_design(random);
    const Vehicle<double> vehicle = resolve(design);
    const SteadyOptions loose{.tolerance = 1e-6, .reporting = reporting_of(design)};
    const SteadyFlapping found = find_steady_flapping(vehicle, loose);
    SteadyOptions tight = loose;
    tight.tolerance = 1e-10;
    const SteadyFlapping reference = find_steady_flapping(vehicle, tight);
    ASSERT_EQ(found.status, reference.status) << "vehicle " << n;
    if (found.status != FlappingStatus::flapping) continue;
    ++flapping;
    std::string where;
    const double deviation = largest_deviation(reference.metrics, found.metrics, &where);
    EXPECT_LT(deviation, 1e-5) << "vehicle " << n << ", " << where;
    if (deviation > 1e-6) ++outside;
    const EnergyAudit audit = energy_audit(reference.metrics);
    EXPECT_LT(std::abs(audit.imbalance), 1e-9 * audit.electrical) << "vehicle " << n;
  }
  EXPECT_GT(flapping, 300);
  EXPECT_LE(outside, flapping / 100);
}

TEST(SteadyFlapping, StiffVehiclesApproachTheAlgebraicCurrent) {
  Vehicle<double> vehicle = reference_vehicle(true);
  vehicle.motor.armature_inductance = 0.0;
  const SteadyFlapping algebraic = find_steady_flapping(vehicle, {.tolerance = 1e-11});
  double before = 1.0;
  for (const double inductance : {1e-5, 1e-7, 1e-9}) {
    vehicle.motor.armature_inductance = inductance;
    const SteadyFlapping found = find_steady_flapping(vehicle, {.tolerance = 1e-11});
    ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
    const double apart = std::abs(found.metrics[Metric::power_copper] / algebraic.metrics[Metric::power_copper] - 1.0);
    EXPECT_LT(apart, 0.02 * before) << "first order in the inductance";
    before = apart;
  }
  EXPECT_LT(before, 1e-7);
}

TEST(SteadyFlapping, PeaksAreNotSamples) {
  for (const bool springs : {false, true}) {
    const SteadyFlapping found = find_steady_flapping(reference_vehicle(springs), {.tolerance = 1e-10});
    double lift = 0.0, force = 0.0, velocity = 0.0, current = 0.0, fastest = 0.0, slowest = 1e9;
    for (const WaveformRow& row : found.record.waveform(20001)) {
      lift = std::max(lift, row.lift);
      force = std::max(force, std::abs(row.rod_force));
      velocity = std::max(velocity, std::abs(row.flapping_velocity));
      current = std::max(current, row.current);
      fastest = std::max(fastest, row.crank_speed);
      slowest = std::min(slowest, row.crank_speed);
    }
    // Samples miss a peak from below, by the square of their distance.
    const auto peaks_above = [](double peak, double sample) {
      EXPECT_GE(peak, sample * (1.0 - 1e-10));
      EXPECT_LT(peak, sample * (1.0 + 1e-6));
    };
    peaks_above(found.metrics[Metric::lift_peak], lift);
    peaks_above(found.metrics[Metric::rod_force_peak], force);
    peaks_above(found.metrics[Metric::flapping_velocity_peak], velocity);
    peaks_above(found.metrics[Metric::current_peak], current);
    peaks_above(found.metrics[Metric::crank_speed_max], fastest);
    EXPECT_NEAR(found.metrics[Metric::crank_speed_min] / slowest, 1.0, 1e-6);
  }
}

TEST(SteadyFlapping, WaveformIsOneConsistentCycle) {
  const SteadyFlapping found = find_steady_flapping(reference_vehicle(true), {.tolerance = 1e-10});
  const std::vector<WaveformRow> rows = found.record.waveform(721);
  ASSERT_EQ(rows.size(), 721u);
  EXPECT_NEAR(rows.front().crank_angle, 0.0, 1e-12);
  EXPECT_NEAR(rows.back().crank_angle, two_pi, 1e-9);
  EXPECT_NEAR(rows.back().crank_speed, rows.front().crank_speed, 1e-7);
  double lift = 0.0;
  for (std::size_t n = 1; n < rows.size(); ++n) {
    const double dt = rows[n].time - rows[n - 1].time;
    EXPECT_NEAR(dt, found.record.period() / 720.0, 1e-12);
    lift += 0.5 * dt * (rows[n].lift + rows[n - 1].lift);
  }
  EXPECT_NEAR(lift / found.record.period() / found.metrics[Metric::lift_mean], 1.0, 1e-5);
}

TEST(NotFlapping, StalledByTheMotorsOwnFriction) {
  Vehicle<double> vehicle = reference_vehicle();
  vehicle.motor.friction_torque = 0.0034;
  const SteadyFlapping found = find_steady_flapping(vehicle);
  EXPECT_EQ(found.status, FlappingStatus::stalled);
  EXPECT_EQ(describe(found.evidence),
            "the motor never starts: its stall torque 0.003333 N m does not exceed the constant friction 0.0034 N m");
  for (const double value : found.metrics.values) EXPECT_TRUE(std::isnan(value));
  EXPECT_TRUE(found.record.empty());
}

TEST(NotFlapping, ZeroVoltageStalls) {
  Vehicle<double> vehicle = reference_vehicle();
  vehicle.voltage = 0.0;
  EXPECT_EQ(find_steady_flapping(vehicle).status, FlappingStatus::stalled);
}

TEST(NotFlapping, LockedBehindAStrongSpring) {
  Vehicle<double> vehicle = reference_vehicle(true);
  vehicle.spring.stiffness *= 10.0;
  const SteadyFlapping found = find_steady_flapping(vehicle, {}, start_up_in_time());
  EXPECT_EQ(found.status, FlappingStatus::locked) << describe(found.evidence);
  EXPECT_THAT(describe(found.evidence), HasSubstr("deg"));
  const SteadyFlapping by_statics = find_steady_flapping(vehicle);
  EXPECT_EQ(by_statics.status, FlappingStatus::locked) << describe(by_statics.evidence);
  const std::vector<LockInterval> locks = lock_intervals(vehicle);
  ASSERT_FALSE(locks.empty());
  for (const LockInterval& lock : locks) {
    EXPECT_NEAR(lock_margin(vehicle, lock.from), 0.0, 1e-9);
    EXPECT_NEAR(lock_margin(vehicle, lock.to), 0.0, 1e-9);
    EXPECT_GE(lock_margin(vehicle, lock.angle), 0.0);
  }
}

TEST(NotFlapping, JammedWithALightRotorAndStrongFriction) {
  Vehicle<double> vehicle = reference_vehicle();
  vehicle.motor.inertia = 2e-9;
  const SteadyFlapping found = find_steady_flapping(vehicle, {}, start_up_in_time());
  EXPECT_EQ(found.status, FlappingStatus::jammed) << describe(found.evidence);
  const SteadyFlapping by_statics = find_steady_flapping(vehicle);
  EXPECT_EQ(by_statics.status, FlappingStatus::jammed);
  EXPECT_THAT(describe(by_statics.evidence), HasSubstr("lose their unique solution at crank angle"));
}

TEST(NotFlapping, SaysSoWhereARotatingOrbitAndALockExist) {
  // Springs that the static motor torque cannot pass, but a turning crank can.
  Vehicle<double> vehicle = reference_vehicle(true);
  vehicle.motor.inertia *= 20.0;
  bool seen = false;
  for (double stiffness = 2e-3; stiffness < 8e-3 && !seen; stiffness *= 1.05) {
    vehicle.spring.stiffness = stiffness;
    if (!static_balance(vehicle).can_lock()) continue;
    const SteadyFlapping found = find_steady_flapping(vehicle, {}, start_up_in_time());
    const SteadyFlapping orbit_alone = find_steady_flapping(vehicle);
    if (orbit_alone.status != FlappingStatus::flapping) continue;
    seen = true;
    if (found.status == FlappingStatus::locked) {
      EXPECT_THAT(describe(found.evidence), HasSubstr("a rotating orbit at"));
    } else {
      EXPECT_THAT(describe(found.evidence), HasSubstr("the crank also locks at crank angles"));
    }
  }
  EXPECT_TRUE(seen);
}

// The independent check of everything: the orbit against time integration from rest by another library.
TEST(OrbitAgainstTransient, RandomVehiclesAgree) {
  std::mt19937_64 random(42);
  int flapping = 0, resting = 0;
  for (int n = 0; n < 220; ++n) {
    const Design<double> design = random_design(random);
    const Vehicle<double> vehicle = resolve(design);
    const Reporting reporting = reporting_of(design);
    const SteadyFlapping orbit =
        find_steady_flapping(vehicle, {.tolerance = 1e-8, .reporting = reporting}, start_up_in_time());
    TransientOptions options;
    options.tolerance = 2e-7;
    options.reporting = reporting;
    const TransientResult transient = simulate_start_up(vehicle, options);
    ASSERT_EQ(orbit.status, transient.status)
        << "vehicle " << n << ": " << describe(orbit.evidence) << " / " << describe(transient.evidence);
    ASSERT_TRUE(transient.settled) << "vehicle " << n << ": " << describe(transient.evidence);
    if (orbit.status != FlappingStatus::flapping) {
      ++resting;
      continue;
    }
    ++flapping;
    std::string where;
    EXPECT_LT(largest_deviation(orbit.metrics, *transient.metrics, &where), 1e-6) << "vehicle " << n << ", " << where;
  }
  EXPECT_GE(flapping, 180);
  EXPECT_GE(resting, 5);
}

}  // namespace
}  // namespace wingbeat

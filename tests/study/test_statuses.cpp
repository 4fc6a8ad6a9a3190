// One answer to "does it flap?": batched solver, orbit search and simulation in time give the same status and the same
// orbit, whatever the tolerance.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/wide_boxes.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

using ::testing::HasSubstr;

SteadyFlapping orbit_of(const Design<double>& design, double tolerance = 1e-6, bool stability = true) {
  return find_steady_flapping(resolve(design), {tolerance, stability, reporting_of(design)}, start_up_in_time());
}

EnsembleOutcome batched(const Design<double>& design, const EnsembleOptions& options = {}) {
  const EnsembleMember member{resolve(design), reporting_of(design)};
  EnsembleOutcome outcome;
  solve_ensemble({&member, 1}, options, start_up_in_time(), {&outcome, 1});
  return outcome;
}

/// A light rotor whose search for an orbit loses the crank at standstill.
Design<double> light_rotor() {
  Design<double> d = reference_design();
  d.supply.voltage = 3.6;
  d.motor.constants.torque_constant = 0.017;
  d.motor.constants.inertia = 4e-8;
  d.spring.stiffness = 0.006;
  return d;
}

Design<double> crank_near_the_rod() {
  Design<double> d = reference_design();
  d.supply.voltage = 20.0;
  d.motor.constants.armature_resistance = 3.0;
  d.transmission.formulation = Formulation::virtual_work;
  d.transmission.rod_length = 0.03;
  d.transmission.crank_radius = 0.027;
  d.wing.inertia = 6e-9;
  d.aerodynamics.pitch_coefficient = 0.02;
  d.friction.coefficient = 1e-4;
  return d;
}

/// Drag that falls again as the wings pitch over: several crank speeds balance the motor, and start-up reaches 47.2 Hz.
Design<double> several_orbits() {
  Design<double> d = reference_design();
  d.supply.voltage = 20.0;
  d.friction = {FrictionLaw::none, 0.0};
  d.transmission.formulation = Formulation::virtual_work;
  d.transmission.rod_length = 0.034;
  d.transmission.crank_radius = 0.022;
  d.transmission.hinge_offset = 0.009;
  Motor<double>& m = d.motor.constants;
  m.armature_resistance = 2.5;
  m.torque_constant = 0.005;
  m.inertia = 5e-6;
  m.viscous_damping = 1e-6;
  d.aerodynamics.pitch_coefficient = 0.008;
  return d;
}

TEST(Statuses, FlapsWhereStartUpFlaps) {
  const std::pair<Design<double>, double> known[] = {{light_rotor(), 11.08}, {crank_near_the_rod(), 77.25}};
  for (const auto& [design, frequency] : known) {
    RunOptions options;
    options.method = Method::transient;
    options.waveform_rows = 61;
    const RunResult in_time = run_design(design, options);
    ASSERT_EQ(in_time.status, FlappingStatus::flapping) << describe(in_time);
    EXPECT_NEAR(in_time.metrics[Metric::frequency], frequency, 0.005);
    options.method = Method::orbit;
    const RunResult orbit = run_design(design, options);
    ASSERT_EQ(orbit.status, FlappingStatus::flapping) << describe(orbit);
    for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::rod_force_peak}) {
      EXPECT_NEAR(orbit.metrics[m] / in_time.metrics[m], 1.0, 3e-6) << metric_info(m).key << ", " << describe(orbit);
    }
    ASSERT_EQ(orbit.cycle.size(), 61u);
    EXPECT_NEAR(orbit.cycle.back().time * orbit.metrics[Metric::frequency], 1.0, 1e-4);
    const EnsembleOutcome outcome = batched(design);
    ASSERT_EQ(outcome.status, FlappingStatus::flapping);
    EXPECT_GT(outcome.error_estimate, 0.0);
    EXPECT_NEAR(outcome.metrics[Metric::frequency] / in_time.metrics[Metric::frequency], 1.0, 3e-6);
  }
}

TEST(Statuses, ACrankThatStopsWithinEachTurnIsReportedFromItsSimulatedCycle) {
  // Number 22: friction holds the crank for a moment in every turn.
  const WideVehicle v = wide_vehicle(FarBox::crank_near_rod, 22);
  const SteadyFlapping found = orbit_of(v.design);
  ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
  ASSERT_TRUE(found.simulated);
  EXPECT_THAT(describe(found.evidence), HasSubstr("from its cycle simulated in time"));
  EXPECT_GE(found.simulated->error_estimate, 1e-6);
  EXPECT_LT(found.metrics[Metric::crank_speed_min], 1e-6);
  EXPECT_TRUE(found.record.empty());
}

TEST(Statuses, OfSeveralOrbitsTheOneReachedFromRest) {
  const Design<double> design = several_orbits();
  for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
    for (const bool stability : {true, false}) {
      const SteadyFlapping found = orbit_of(design, tolerance, stability);
      ASSERT_EQ(found.status, FlappingStatus::flapping) << describe(found.evidence);
      EXPECT_NEAR(found.metrics[Metric::frequency], 47.20, 0.05) << tolerance << ' ' << stability;
    }
  }
  for (const bool multipliers : {true, false}) {
    EnsembleOptions options;
    options.metrics[std::size_t(Metric::floquet_multiplier_max)] = multipliers;
    const EnsembleOutcome outcome = batched(design, options);
    ASSERT_EQ(outcome.status, FlappingStatus::flapping);
    EXPECT_NEAR(outcome.metrics[Metric::frequency], 47.20, 0.05);
  }
}

TEST(Statuses, HeavyRotorsSettleByExtrapolation) {
  Design<double> d = reference_design();
  d.motor.constants.inertia = 1e-3;
  RunOptions options;
  options.method = Method::transient;
  const RunResult in_time = run_design(d, options);
  ASSERT_EQ(in_time.status, FlappingStatus::flapping) << describe(in_time);
  EXPECT_LT(in_time.start_up->cycles, 1500);
  EXPECT_THAT(describe(in_time), HasSubstr("extrapolated"));
  const SteadyFlapping exact = orbit_of(d, 1e-9);
  EXPECT_NEAR(in_time.metrics[Metric::frequency] / exact.metrics[Metric::frequency], 1.0, 1e-5);
  // Towards a speed of balance omega' = -(omega - omega_0)/T: within 1 % of it after several T = J R/K^2.
  const double T = 1e-3 * 9.0 / square(0.01);
  EXPECT_GT(in_time.start_up->time_to_steady, 0.5 * T);
  EXPECT_LT(in_time.start_up->time_to_steady, 10.0 * T);
}

// The start of the current displaces the wings once; then springs and drive move them back by less every period.
TEST(Statuses, ADirectDriveThatCreepsToRestIsStalled) {
  Design<double> d = reference_design();
  d.supply = {.type = SupplyType::sine, .voltage = 1.9844533436247884, .frequency = 16.773896073575298};
  d.motor.constants = {.armature_resistance = 1.646658283204204,
                       .armature_inductance = 0.091134891193958179,
                       .torque_constant = 0.015141843001611133,
                       .inertia = 2.5490402520183034e-08,
                       .viscous_damping = 6.6429608616915956e-06};
  d.transmission = {};
  d.transmission.type = TransmissionType::direct;
  d.friction = {FrictionLaw::constant, 0.0031678920876149104};
  d.spring = {};
  d.spring.resonance = 15.218520998230197;
  d.wing.inertia = 8.2880590971944996e-08;
  d.wing.planform.s2 = 1.908383519405084e-06;
  d.wing.planform.s3 = 6.4543755204706724e-08;
  d.aerodynamics.pitch_coefficient = 0.0012220461864332736;
  RunOptions options;
  options.method = Method::transient;
  const RunResult in_time = run_design(d, options);
  EXPECT_EQ(in_time.status, FlappingStatus::stalled);
  EXPECT_THAT(describe(in_time), HasSubstr("creeps to rest near stroke angle"));
  EXPECT_LT(in_time.start_up->steps, 1000000);
  EXPECT_EQ(orbit_of(d).status, FlappingStatus::stalled);
  EXPECT_EQ(batched(d).status, FlappingStatus::stalled);
  d.friction.coefficient = 0.0030;  // below the greatest torque of the drive
  EXPECT_EQ(run_design(d, options).status, FlappingStatus::flapping);
}

TEST(Statuses, AMotorThatNeverStartsIsStalledEvenWhereItWouldJam) {
  Design<double> d = reference_design();
  d.motor.constants.inertia = 2e-9;  // jams where it stands
  RunOptions options;
  options.method = Method::transient;
  d.friction.coefficient = 6e-3;
  EXPECT_EQ(run_design(d, options).status, FlappingStatus::jammed);
  d.motor.constants.friction_torque = 3.4e-3;  // stall torque 3.33e-3 N m
  EXPECT_EQ(run_design(d, options).status, FlappingStatus::stalled);
  EXPECT_EQ(orbit_of(d).status, FlappingStatus::stalled);
  EXPECT_EQ(batched(d).status, FlappingStatus::stalled);
}

TEST(Statuses, AgreeOnWideVehicles) {
  constexpr std::uint32_t of_each = 8;
  int flapping = 0, others = 0;
  for (int box = 0; box < int(far_box_names.size()); ++box) {
    std::vector<EnsembleMember> members;
    std::vector<RunResult> orbits;
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t n = 1000; n < 1000 + of_each; ++n) {
      const WideVehicle v = wide_vehicle(FarBox(box), n);
      const bool direct = v.design.transmission.type == TransmissionType::direct;
      if (v.design.supply.type == SupplyType::sine && !direct) continue;
      RunOptions options;
      options.condition = v.condition;
      orbits.push_back(run_design(v.design, options));
      options.method = Method::transient;
      const RunResult in_time = run_design(v.design, options);
      EXPECT_EQ(orbits.back().status, in_time.status) << far_box_names[std::size_t(box)] << ' ' << n << ": "
                                                      << describe(orbits.back()) << " / " << describe(in_time);
      EXPECT_NE(in_time.status, FlappingStatus::undecided) << describe(in_time);
      (in_time.status == FlappingStatus::flapping ? flapping : others) += 1;
      if (in_time.status == FlappingStatus::flapping && v.design.supply.type != SupplyType::pwm) {
        EXPECT_NEAR(orbits.back().metrics[Metric::frequency] / in_time.metrics[Metric::frequency], 1.0, 1e-3);
      }
      members.push_back({resolve(v.design, v.condition), reporting_of(v.design)});
      numbers.push_back(n);
    }
    std::vector<EnsembleOutcome> outcomes(members.size());
    solve_ensemble(members, {}, start_up_in_time(), outcomes);
    for (std::size_t k = 0; k < outcomes.size(); ++k) {
      EXPECT_EQ(outcomes[k].status, orbits[k].status) << far_box_names[std::size_t(box)] << ' ' << numbers[k];
    }
  }
  EXPECT_GT(flapping, 40);
  EXPECT_GT(others, 5);
}

TEST(Statuses, DoNotDependOnTheTolerance) {
  for (const FarBox box : {FarBox::crank_near_rod, FarBox::near_jam, FarBox::strong_springs}) {
    for (std::uint32_t n = 2000; n < 2008; ++n) {
      const WideVehicle v = wide_vehicle(box, n);
      const FlappingStatus expected = orbit_of(v.design, 1e-6).status;
      for (const double tolerance : {1e-2, 1e-4, 1e-9, 1e-11}) {
        const SteadyFlapping found = orbit_of(v.design, tolerance);
        EXPECT_EQ(found.status, expected) << n << " at " << tolerance << ": " << describe(found.evidence);
      }
    }
  }
}

}  // namespace
}  // namespace wingbeat

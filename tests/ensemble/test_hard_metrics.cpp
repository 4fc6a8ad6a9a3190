// Metrics that errors of rounding, of a slow contraction or of a pitch that stands still would spoil, or whose error
// estimate would miss them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/case_design.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "vehicle/wide_boxes.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SteadyFlapping orbit_to(const Design<double>& design, double tolerance = 1e-6) {
  return find_steady_flapping(resolve(design), {.tolerance = tolerance}, start_up_in_time());
}

TEST(QuasiSteadyCurrent, BelowALagOfABillionth) {
  Vehicle<double> v = reference_vehicle();
  EXPECT_TRUE(has_current_state(v));
  v.motor.armature_inductance = 0.0;
  EXPECT_FALSE(has_current_state(v));
  v.motor.armature_inductance = 1e-15;
  EXPECT_FALSE(has_current_state(v));
  v.motor.armature_inductance *= 1.01 * quasi_steady_lag / electrical_lag(v);
  EXPECT_TRUE(has_current_state(v));
  // A supply that drives no current yet may drive one later.
  v.voltage = 0.0;
  v.motor.armature_inductance = 29e-3;
  EXPECT_TRUE(has_current_state(v));
}

TEST(QuasiSteadyCurrent, PeaksAreThoseWithoutInductance) {
  for (const char* name : {"peak-9", "peak-382", "peak-61", "peak-6"}) {
    Design<double> d = case_design(name);
    const SteadyFlapping with = orbit_to(d);
    d.motor.constants.armature_inductance = 0.0;
    const SteadyFlapping without = orbit_to(d);
    ASSERT_EQ(with.status, without.status) << name;
    if (with.status != FlappingStatus::flapping) continue;
    for (const Metric m : {Metric::current_peak, Metric::rod_force_peak, Metric::frequency}) {
      EXPECT_NEAR(with.metrics[m] / without.metrics[m], 1.0, 1e-9) << name << ' ' << metric_info(m).key;
    }
  }
}

// Without air, the stored energy is least where the rod force changes its sign: at a node, on either side of which
// rounding gives its slope another sign.
TEST(ReactivePower, OfBatchesHasTheExtremesAtNodes) {
  const WideVehicle w = wide_vehicle(FarBox::four_bar, 24);
  const EnsembleMember member{resolve(w.design, w.condition), reporting_of(w.design)};
  const double exact = find_steady_flapping(member.vehicle, {.tolerance = 1e-9}).metrics[Metric::power_reactive];
  ASSERT_GT(exact, 0.0);
  for (const double tolerance : {1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
    EnsembleOptions options;
    options.tolerance = tolerance;
    EnsembleOutcome batched;
    solve_ensemble({&member, 1}, options, start_up_in_time(), {&batched, 1});
    EXPECT_NEAR(batched.metrics[Metric::power_reactive], exact, tolerance * exact) << tolerance;
  }
}

TEST(QuasiSteadyCurrent, ForcesOfBatchesAreThoseOfTheOrbit) {
  const Design<double> d = case_design("peak-6");
  const EnsembleMember member{resolve(d), reporting_of(d)};
  EnsembleOutcome batched;
  solve_ensemble({&member, 1}, {}, start_up_in_time(), {&batched, 1});
  const SteadyFlapping exact = orbit_to(d, 1e-9);
  ASSERT_EQ(batched.status, FlappingStatus::flapping);
  EXPECT_NEAR(batched.metrics[Metric::rod_force_peak] / exact.metrics[Metric::rod_force_peak], 1.0, 1e-6);
}

/// A heavy rotor whose speed a cycle hardly returns, behind a current that does at once.
TEST(SlowContraction, IsSeenAndTheEstimateHolds) {
  const Design<double> d = case_design("tol-90");
  const SteadyFlapping found = orbit_to(d), exact = orbit_to(d, 1e-9);
  ASSERT_EQ(found.status, FlappingStatus::flapping);
  const double estimate = found.summary.error_estimate;
  EXPECT_LT(estimate, 2e-6);
  for (const Metric m : {Metric::power_loss, Metric::frequency, Metric::power_aerodynamic, Metric::efficiency_motor}) {
    EXPECT_NEAR(found.metrics[m] / exact.metrics[m], 1.0, estimate) << metric_info(m).key;
  }
  EXPECT_LT(std::abs(energy_audit(found.metrics).imbalance), 1e-6 * found.metrics[Metric::power_loss]);
}

TEST(SlowContraction, OfASimulationIsSaidWithItsError) {
  const Vehicle<double> v = resolve(case_design("p182"));
  const TransientResult in_time = simulate_start_up(v);
  ASSERT_EQ(in_time.status, FlappingStatus::flapping);
  const SteadyFlapping orbit = find_steady_flapping(v, {}, start_up_in_time());
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  const Metric loss = Metric::power_loss;
  const double off = std::abs((*in_time.metrics)[loss] / orbit.metrics[loss] - 1.0);
  EXPECT_LT(off, 2.0 * std::max(in_time.closure, 1e-6));
  if (in_time.closure > 1e-6) {
    EXPECT_THAT(describe(in_time.evidence), HasSubstr("of where they converge"));
  }
}

TEST(StandingPitch, HasNoPhaseAndDoesNotOverRotate) {
  const Vehicle<double> v = resolve(case_design("pitch-6"));
  const SteadyFlapping orbit = find_steady_flapping(v, {}, start_up_in_time());
  const TransientResult in_time = simulate_start_up(v);
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  ASSERT_TRUE(in_time.metrics);
  for (const Metrics<double>& metrics : {orbit.metrics, *in_time.metrics}) {
    EXPECT_LT(metrics[Metric::pitch_amplitude], 1e-4);
    EXPECT_TRUE(std::isnan(metrics[Metric::pitch_phase]));
  }
  EXPECT_EQ(orbit.evidence.over_rotation, 0.0);
  EXPECT_THAT(describe(orbit.evidence), Not(HasSubstr("over-rotate")));
  EXPECT_THAT(describe(in_time.evidence), Not(HasSubstr("over-rotate")));
}

}  // namespace
}  // namespace wingbeat

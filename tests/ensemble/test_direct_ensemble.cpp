// Direct drives in batches: against the scalar solver, closed forms and themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "ensemble/ensemble_comparison.hpp"
#include "vehicle/direct_design.hpp"
#include "vehicle/metrics_apart.hpp"
#include "wingbeat/cycle/direct_balance.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"

namespace wingbeat {
namespace {

/// Of all that batches take: in air, in vacuum and without wings, with and without springs, inductance, added mass.
std::vector<EnsembleMember> direct_members(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < count; ++n) {
    Design<double> d = smooth_direct_design(random);
    d.aerodynamics.added_mass = n % 3 == 1;
    if (n % 7 == 3) d.spring = {};
    // Where nothing takes power from the shaft, the motor's output is rounding.
    if (d.friction.law == FrictionLaw::none && (n % 13 == 5 || n % 17 == 7)) d.friction = {FrictionLaw::viscous, 1e-6};
    const Condition condition = n % 13 == 5 ? Condition::vacuum : n % 17 == 7 ? Condition::wingless : Condition::air;
    members.push_back(member_of(d, condition));
  }
  return members;
}

/// Wings whose drag falls with speed over part of the stroke, on a strong supply: every tenth has several responses.
Design<double> bistable_direct_design(std::mt19937_64& random) {
  Design<double> d = smooth_direct_design(random);
  d.aerodynamics.coefficients.drag = {1.0, -0.95, 2.0, 0.0};
  d.aerodynamics.pitch_coefficient *= std::uniform_real_distribution<>(1.0, 3.0)(random);
  d.motor.constants.torque_constant *= 0.3;
  d.motor.constants.viscous_damping *= 0.1;
  d.supply.voltage *= 10.0;
  return d;
}

/// Equal statuses, equal domains and, to that part of each, metrics.
void expect_agreement(const std::vector<EnsembleOutcome>& got, const std::vector<EnsembleOutcome>& expected,
                      double largest) {
  ASSERT_EQ(got.size(), expected.size());
  for (std::size_t n = 0; n < got.size(); ++n) {
    ASSERT_EQ(got[n].status, expected[n].status) << n;
    EXPECT_EQ(got[n].domain, expected[n].domain) << n;
    std::string where;
    EXPECT_LE(metrics_apart(got[n].metrics, expected[n].metrics, where), largest) << n << ' ' << where;
    for (int m = 0; m < metric_count; ++m) {
      EXPECT_EQ(std::isnan(got[n].metrics[Metric(m)]), std::isnan(expected[n].metrics[Metric(m)]))
          << n << ' ' << metric_info(Metric(m)).key;
    }
    const double multiplier = expected[n].metrics[Metric::floquet_multiplier_max];
    if (std::isnan(multiplier)) continue;
    EXPECT_NEAR(got[n].metrics[Metric::floquet_multiplier_max], multiplier, 1e-3 * multiplier + 1e-6) << n;
  }
}

int count_scalar(const std::vector<EnsembleOutcome>& outcomes) {
  return int(std::count_if(outcomes.begin(), outcomes.end(), [](const EnsembleOutcome& out) { return out.scalar; }));
}

TEST(DirectEnsemble, AgreesWithTheScalarSolver) {
  const std::vector<EnsembleMember> members = direct_members(240, 3);
  const auto expected = solve(members, {.tolerance = 1e-8, .scalar_only = true});
  for (const InstructionSet isa : available()) {
    const auto got = solve(members, {.tolerance = 1e-6, .isa = isa});
    expect_agreement(got, expected, 1.1e-6);
    EXPECT_LE(count_scalar(got), 2);
    for (const EnsembleOutcome& out : got) EXPECT_LE(out.error_estimate, 1e-6);
  }
}

TEST(DirectEnsemble, TightensToTheToleranceAskedFor) {
  const std::vector<EnsembleMember> members = direct_members(1000, 5);
  const auto tight = solve(members, {.tolerance = 1e-10});
  EXPECT_LE(count_scalar(tight), 2);
  for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9}) {
    const auto got = solve(members, {.tolerance = tolerance});
    EXPECT_EQ(count_scalar(got), 0) << tolerance;
    expect_agreement(got, tight, 3.0 * tolerance);
    int outside = 0;
    for (std::size_t n = 0; n < got.size(); ++n) {
      EXPECT_LE(got[n].error_estimate, tolerance) << n;
      std::string where;
      outside += metrics_apart(got[n].metrics, tight[n].metrics, where) > tolerance;
    }
    EXPECT_LE(outside, 1) << tolerance;
  }
}

TEST(DirectEnsemble, OutcomeDependsNeitherOnPlaceNorOnCompany) {
  std::vector<EnsembleMember> members = direct_members(300, 7);
  // Some that need more iterations and finer meshes or are left to the scalar solver, among them one that has several
  // responses, each of which costs a simulation.
  std::mt19937_64 random(8);
  for (int several = 0, n = 0; n < 60; ++n) {
    const EnsembleMember member = member_of(bistable_direct_design(random));
    several += direct_balance(member.vehicle).responses.size() > 1;
    if (several <= 1) members.push_back(member);
  }
  for (const InstructionSet isa : available()) expect_equal_in_any_batch(members, {.isa = isa});
}

TEST(DirectEnsemble, InstructionSetsAgree) {
  const std::vector<EnsembleMember> members = direct_members(400, 9);
  const auto base = solve(members, {.tolerance = 1e-10, .isa = InstructionSet::base});
  for (const InstructionSet isa : available()) {
    expect_agreement(solve(members, {.tolerance = 1e-10, .isa = isa}), base, 2e-10);
  }
}

TEST(DirectEnsemble, WithoutAirTheResponseIsTheComplexImpedances) {
  std::mt19937_64 random(14);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 200; ++n) {
    Design<double> d = smooth_direct_design(random);
    d.friction = {FrictionLaw::viscous, 2e-6};
    members.push_back(member_of(d, Condition::vacuum));
  }
  const auto outcomes = solve(members, {.tolerance = 1e-10});
  for (std::size_t n = 0; n < members.size(); ++n) {
    ASSERT_EQ(outcomes[n].status, FlappingStatus::flapping);
    EXPECT_FALSE(outcomes[n].scalar) << n;
    const Vehicle<double>& v = members[n].vehicle;
    const auto [speed, current] = linear_response(v);
    const Metrics<double>& m = outcomes[n].metrics;
    EXPECT_NEAR(m[Metric::stroke_amplitude] * two_pi * v.drive_frequency / std::abs(speed), 1.0, 1e-10) << n;
    EXPECT_NEAR(m[Metric::flapping_velocity_peak] / std::abs(speed), 1.0, 1e-10) << n;
    EXPECT_NEAR(m[Metric::current_peak] / std::abs(current), 1.0, 1e-10) << n;
    EXPECT_NEAR(m[Metric::current_rms] / std::abs(current), std::sqrt(0.5), 1e-10) << n;
    EXPECT_NEAR(m[Metric::power_electrical] / (0.5 * v.voltage * current.real()), 1.0, 1e-9) << n;
    // Wings and springs exchange the difference of two energies; near resonance it is small.
    const double omega_drive = two_pi * v.drive_frequency, stroke = std::abs(speed) / omega_drive;
    const double stiffness = v.spring.stiffness - v.wing_inertia * square(omega_drive);
    const double reactive = 2.0 * v.wing_count * std::abs(stiffness) * square(stroke) * v.drive_frequency;
    EXPECT_NEAR(m[Metric::power_reactive] / reactive, 1.0, 1e-11) << n;
    EXPECT_EQ(m[Metric::current_mean], 0.0);
    EXPECT_EQ(m[Metric::lift_mean], 0.0);
  }
}

TEST(DirectEnsemble, EnergyBalanceCloses) {
  const std::vector<EnsembleMember> members = direct_members(500, 11);
  for (const double tolerance : {1e-6, 1e-10}) {
    for (const EnsembleOutcome& out : solve(members, {.tolerance = tolerance})) {
      ASSERT_EQ(out.status, FlappingStatus::flapping);
      const EnergyAudit audit = energy_audit(out.metrics);
      EXPECT_LE(std::abs(audit.imbalance), tolerance * audit.electrical);
    }
  }
}

TEST(DirectEnsemble, StatusesAreThoseOfTheScalarSolver) {
  std::mt19937_64 random(13);
  std::vector<EnsembleMember> members;
  int several = 0, left_to_scalar = 0;
  for (int n = 0; n < 100; ++n) {
    Design<double> d = n % 2 == 0 ? bistable_direct_design(random) : random_direct_design(random, n % 10 == 1);
    if (n % 20 == 7) d.supply.voltage = 0.0;
    if (n % 20 == 9) d.friction = {FrictionLaw::constant, 1.0};
    members.push_back(member_of(d));
    const Vehicle<double>& v = members.back().vehicle;
    const std::size_t responses = direct_balance(v).responses.size();
    several += responses > 1;
    left_to_scalar += responses > 1 || has_pitch_stop(v.wings) || breakaway_torque(v) > 0.0;
  }
  EXPECT_GT(several, 2);
  const auto got = solve(members, {});
  const auto expected = solve(members, {.scalar_only = true});
  std::map<FlappingStatus, int> found;
  for (std::size_t n = 0; n < members.size(); ++n) {
    ASSERT_EQ(got[n].status, expected[n].status) << n << (got[n].scalar ? " scalar" : " batched");
    ++found[got[n].status];
    if (got[n].status != FlappingStatus::flapping) continue;
    std::string where;
    EXPECT_LE(metrics_apart(got[n].metrics, expected[n].metrics, where), 3e-6) << n << ' ' << where;
  }
  EXPECT_EQ(found[FlappingStatus::stalled], 10);
  EXPECT_LE(count_scalar(got), left_to_scalar + 10);
}

TEST(DirectEnsemble, ReportsTheMetricsAskedForAlone) {
  const std::vector<EnsembleMember> members = direct_members(40, 15);
  const auto all = solve(members, {});
  EnsembleOptions options;
  options.metrics.reset().set(std::size_t(Metric::lift_mean)).set(std::size_t(Metric::power_electrical));
  const auto some = solve(members, options);
  for (std::size_t n = 0; n < members.size(); ++n) {
    EXPECT_FALSE(some[n].scalar) << n;
    EXPECT_EQ(some[n].domain, all[n].domain) << n;
    for (int m = 0; m < metric_count; ++m) {
      EXPECT_EQ(std::isnan(some[n].metrics[Metric(m)]), !options.metrics[std::size_t(m)]) << metric_info(Metric(m)).key;
    }
  }
}

TEST(DirectEnsemble, WarmMotors) {
  std::mt19937_64 random(816);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 120; ++n) {
    Design<double> d = smooth_direct_design(random);
    d.motor.thermal.resistance_winding = uniform(5.0, 30.0);
    d.motor.thermal.resistance_case = uniform(10.0, 60.0);
    d.motor.thermal.ambient_temperature = uniform(263.0, 323.0);
    d.motor.thermal.magnet_temperature_coefficient = n % 2 == 0 ? 0.0 : -0.0015 * uniform(0.0, 1.0);
    members.push_back(member_of(d));
  }
  const auto got = solve(members, {});
  const auto expected = solve(members, {.scalar_only = true});
  int flapping = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    ASSERT_EQ(got[n].status, expected[n].status) << n;
    if (got[n].status != FlappingStatus::flapping) continue;
    ++flapping;
    EXPECT_FALSE(got[n].scalar) << n;
    std::string where;
    EXPECT_LE(metrics_apart(got[n].metrics, expected[n].metrics, where), 3e-6) << n << ' ' << where;
  }
  EXPECT_GT(flapping, 60);
}

}  // namespace
}  // namespace wingbeat

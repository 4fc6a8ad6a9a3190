#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "ensemble/ensemble_comparison.hpp"
#include "vehicle/known_orbits.hpp"
#include "vehicle/random_vehicle.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

/// Members of every kind: conditions, springs, formulations, friction laws, no or little inductance, and some that do
/// not flap.
std::vector<EnsembleMember> mixed_members(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < count; ++n) {
    const Condition condition = n % 11 == 0 ? Condition::wingless : n % 7 == 0 ? Condition::vacuum : Condition::air;
    members.push_back(member_of(n % 3 == 0   ? random_design(random, 1.6)
                                : n % 5 == 0 ? coreless_design(random)
                                             : box_design(random),
                                condition));
  }
  return members;
}

/// Box designs with an 0816-size motor between -10 and 50 degC.
std::vector<EnsembleMember> warm_members(int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < count; ++n) {
    Design<double> d = box_design(random);
    d.motor.thermal.resistance_winding = 10.0 + 20.0 * uniform(random);
    d.motor.thermal.resistance_case = 30.0 + 40.0 * uniform(random);
    d.motor.thermal.ambient_temperature = 263.0 + 60.0 * uniform(random);
    d.motor.thermal.magnet_temperature_coefficient = n % 2 == 0 ? 0.0 : -0.0015 * uniform(random);
    d.motor.thermal.winding_temperature_max = 360.0;
    members.push_back(member_of(d));
  }
  return members;
}

TEST(Ensemble, InternalResistanceAgreesWithTheScalarSolver) {
  std::mt19937_64 random(31);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 600; ++n) {
    members.push_back(member_of(n % 10 == 0 ? random_design(random, 1.5) : box_design(random)));
    Vehicle<double>& v = members.back().vehicle;
    if (n % 4 == 0) v.motor.armature_inductance = 0.0;
    v.source_resistance = v.motor.armature_resistance * std::uniform_real_distribution<>(0.0, 0.5)(random);
  }
  EnsembleOptions options;
  options.metrics.reset(std::size_t(Metric::floquet_multiplier_max));
  EnsembleOptions exact = options;
  exact.scalar_only = true;
  exact.tolerance = 1e-9;
  const auto expected = solve(members, exact);
  for (const InstructionSet isa : available()) {
    options.isa = isa;
    const auto got = solve(members, options);
    const auto [flapping, by_packs, outside] = agreement(got, expected, 1e-6, 3.0);
    EXPECT_GT(flapping, 400);
    EXPECT_GT(by_packs, flapping * 4 / 5);
    EXPECT_LE(outside, flapping / 50);
  }
}

TEST(Ensemble, SmallInductancesAgreeWithTheScalarSolver) {
  std::mt19937_64 random(37);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < many_members / 20; ++n) members.push_back(member_of(coreless_design(random)));
  const StartUp start_up = remembered_start_up();
  EnsembleOptions exact;
  exact.scalar_only = true;
  exact.tolerance = 1e-10;
  const auto expected = solve(members, exact, start_up);
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    EnsembleOptions options;
    options.tolerance = tolerance;
    const auto got = solve(members, options, start_up);
    const auto [flapping, by_packs, outside] = agreement(got, expected, tolerance, 20.0, tolerance <= 1e-6);
    EXPECT_GT(flapping, many_members / 30);
    EXPECT_LE(outside, flapping / 200 + 1) << tolerance;
    if (tolerance >= 1e-6) {
      EXPECT_GT(by_packs, flapping * 17 / 20) << tolerance;
    }
  }
}

TEST(Ensemble, AgreesWithTheScalarSolver) {
  std::mt19937_64 random(3);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < many_members; ++n) {
    members.push_back(member_of(n % 20 == 0 ? random_design(random, 1.5) : box_design(random)));
  }
  EnsembleOptions options;
  options.metrics.reset(std::size_t(Metric::floquet_multiplier_max));
  const StartUp start_up = remembered_start_up();
  const auto got = solve(members, options, start_up);
  EnsembleOptions exact = options;
  exact.scalar_only = true;
  exact.tolerance = 1e-8;
  const auto expected = solve(members, exact, start_up);
  std::map<std::string, int> by_metric;
  int flapping = 0, outside = 0, far_outside = 0, scalar = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    EXPECT_EQ(got[n].status, expected[n].status) << n;
    scalar += got[n].scalar;
    if (got[n].status != FlappingStatus::flapping || got[n].scalar) continue;
    ++flapping;
    EXPECT_LE(got[n].error_estimate, options.tolerance);
    std::string where;
    const double error = largest_error(got[n].metrics, expected[n].metrics, &where);
    if (error > options.tolerance) {
      ++outside;
      ++by_metric[where];
    }
    far_outside += error > 100.0 * options.tolerance;
  }
  EXPECT_GT(flapping, 9 * many_members / 10);
  EXPECT_LE(outside, flapping / 1000) << testing::PrintToString(by_metric);
  EXPECT_EQ(far_outside, 0);
  EXPECT_LT(scalar, many_members / 20);
  RecordProperty("outside", outside);
  RecordProperty("scalar", scalar);
}

TEST(Ensemble, ForceChangesSignJustBeforeADeadCentre) {
  // The last segment before the dead centre is shorter than the way that its start has to move.
  std::mt19937_64 random(20221);
  Design<double> design;
  for (int n = 0; n <= 3731; ++n) design = box_design(random);
  const std::vector<EnsembleMember> members = {member_of(design)};
  EnsembleOptions exact;
  exact.tolerance = 1e-11;
  exact.scalar_only = true;
  const auto scalar = solve(members, exact);
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    for (const InstructionSet isa : available()) {
      EnsembleOptions options;
      options.tolerance = tolerance;
      options.isa = isa;
      const auto found = solve(members, options);
      for (const Metric m : {Metric::power_friction, Metric::lift_mean, Metric::frequency}) {
        EXPECT_NEAR(found[0].metrics[m] / scalar[0].metrics[m], 1.0, tolerance) << metric_info(m).key;
      }
    }
  }
}

TEST(Ensemble, FineTolerancesSeldomNeedTheScalarSolver) {
  std::mt19937_64 random(29);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 1000; ++n) members.push_back(member_of(box_design(random)));
  EnsembleOptions options;
  options.tolerance = 1e-9;
  const auto outcomes = solve(members, options);
  const auto by_scalar = std::count_if(outcomes.begin(), outcomes.end(), [](const auto& o) { return o.scalar; });
  EXPECT_LE(by_scalar, 5);
}

TEST(Ensemble, FindsWhatDoesNotFlapAsTheScalarSolverDoes) {
  std::mt19937_64 random(17);
  std::vector<EnsembleMember> members;
  while (members.size() < std::size_t(many_members / 40)) {
    Design<double> d = random_design(random, 1.8);
    d.supply.voltage *= 0.4;
    members.push_back(member_of(d));
  }
  const StartUp start_up = remembered_start_up();
  const auto got = solve(members, {}, start_up);
  EnsembleOptions scalar;
  scalar.scalar_only = true;
  const auto expected = solve(members, scalar, start_up);
  std::map<FlappingStatus, int> found;
  for (std::size_t n = 0; n < members.size(); ++n) {
    EXPECT_EQ(got[n].status, expected[n].status) << n << (got[n].scalar ? " scalar" : " batched");
    ++found[got[n].status];
    if (got[n].status == FlappingStatus::flapping) continue;
    EXPECT_TRUE(std::isnan(got[n].error_estimate));
    for (const double value : got[n].metrics.values) EXPECT_TRUE(std::isnan(value));
  }
  for (const FlappingStatus status : {FlappingStatus::flapping, FlappingStatus::stalled, FlappingStatus::locked}) {
    EXPECT_GT(found[status], 2) << name_of(status);
  }
}

TEST(Ensemble, OutcomeDependsNeitherOnPlaceNorOnCompany) {
  const std::vector<EnsembleMember> members = mixed_members(700, 11);
  for (const InstructionSet isa : available()) {
    for (const double tolerance : {1e-6, 1e-9}) {  // the finer one moves nodes
      EnsembleOptions options;
      options.isa = isa;
      options.tolerance = tolerance;
      expect_equal_in_any_batch(members, options);
    }
  }
}

TEST(Ensemble, InstructionSetsAgree) {
  std::mt19937_64 random(23);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 400; ++n) members.push_back(member_of(box_design(random)));
  for (const double tolerance : {1e-6, 1e-10}) {
    EnsembleOptions options;
    options.tolerance = tolerance;
    options.metrics.reset(std::size_t(Metric::floquet_multiplier_max));
    options.isa = InstructionSet::base;
    const auto sse2 = solve(members, options);
    for (const InstructionSet isa : available()) {
      options.isa = isa;
      const auto other = solve(members, options);
      for (std::size_t n = 0; n < members.size(); ++n) {
        ASSERT_EQ(sse2[n].status, other[n].status);
        EXPECT_LE(largest_error(other[n].metrics, sse2[n].metrics), tolerance) << n;
      }
    }
  }
}

TEST(Ensemble, ReproducesKnownOrbits) {
  for (const KnownOrbit& known : known_orbits) {
    for (const InstructionSet isa : available()) {
      for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
        EnsembleOptions options;
        options.isa = isa;
        options.tolerance = tolerance;
        const EnsembleOutcome found = solve({{reference_vehicle(known.springs), {}}}, options).front();
        ASSERT_EQ(found.status, FlappingStatus::flapping);
        EXPECT_FALSE(found.scalar) << "tolerance " << tolerance << " springs " << known.springs;
        EXPECT_LE(found.error_estimate, tolerance);
        EXPECT_NEAR(found.metrics[Metric::frequency] / known.frequency, 1.0, tolerance);
        EXPECT_NEAR(found.metrics[Metric::power_electrical] / known.power_electrical, 1.0, tolerance);
        EXPECT_NEAR(found.metrics[Metric::lift_mean] / known.lift_mean, 1.0, tolerance);
        EXPECT_NEAR(found.metrics[Metric::rod_force_mean] / known.rod_force_mean, 1.0, tolerance);
        EXPECT_NEAR(found.metrics[Metric::rod_force_peak] / known.rod_force_peak, 1.0, tolerance);
      }
    }
  }
}

TEST(Ensemble, FloquetMultipliersAreGoodToThreeDigits) {
  std::mt19937_64 random(29);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 400; ++n) members.push_back(member_of(box_design(random)));
  const auto got = solve(members, {});
  EnsembleOptions exact;
  exact.scalar_only = true;
  exact.tolerance = 1e-11;
  const auto expected = solve(members, exact);
  for (std::size_t n = 0; n < members.size(); ++n) {
    if (expected[n].status != FlappingStatus::flapping) continue;
    const double multiplier = expected[n].metrics[Metric::floquet_multiplier_max];
    EXPECT_NEAR(got[n].metrics[Metric::floquet_multiplier_max], multiplier, 1e-3 * multiplier + 1e-6) << n;
  }
}

TEST(Ensemble, WinglessHasItsClosedForm) {
  std::mt19937_64 random(31);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 40; ++n) members.push_back(member_of(box_design(random), Condition::wingless));
  EnsembleOptions options;
  options.tolerance = 1e-9;
  const auto outcomes = solve(members, options);
  for (std::size_t n = 0; n < members.size(); ++n) {
    const Vehicle<double>& v = members[n].vehicle;
    ASSERT_EQ(outcomes[n].status, FlappingStatus::flapping);
    EXPECT_NEAR(outcomes[n].metrics[Metric::frequency] * two_pi / no_load_speed(v.motor, v.voltage), 1.0, 1e-9);
    EXPECT_EQ(outcomes[n].metrics[Metric::lift_mean], 0.0);
  }
}

// Where the wings feather far, lift rises and falls several times while the wing speeds up; its peak may lie anywhere.
TEST(Ensemble, PeakLiftOfWingsThatFeatherFar) {
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 400; ++n) {
    Design<double> d = reference_design();
    d.aerodynamics.pitch_coefficient = 20e-3 + 130e-3 * n / 399.0;
    members.push_back(member_of(d));
  }
  const std::vector<EnsembleOutcome> batched = solve(members, {.tolerance = 1e-6});
  int compared = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    const SteadyFlapping one =
        find_steady_flapping(members[n].vehicle, {.tolerance = 1e-9, .reporting = members[n].reporting});
    ASSERT_EQ(one.status, FlappingStatus::flapping) << n;
    compared += !batched[n].scalar;
    const double expected = one.metrics[Metric::lift_peak];
    EXPECT_NEAR(batched[n].metrics[Metric::lift_peak], expected, 3e-6 * std::abs(expected)) << n;
  }
  EXPECT_GT(compared, 200);
}

TEST(Ensemble, ReportsTheMetricsAskedForAlone) {
  EnsembleOptions options;
  options.metrics.reset();
  for (const Metric m : {Metric::lift_mean, Metric::rod_force_peak}) options.metrics.set(std::size_t(m));
  EnsembleMember loaded = member_of(reference_design());
  loaded.vehicle.load_torque = 2e-5;
  const auto outcomes = solve({member_of(reference_design()), loaded}, options);
  EXPECT_FALSE(outcomes[0].scalar);
  EXPECT_TRUE(outcomes[1].scalar) << "lanes know no load torque";
  for (const EnsembleOutcome& out : outcomes) {
    for (int k = 0; k < metric_count; ++k) {
      EXPECT_EQ(std::isnan(out.metrics.values[std::size_t(k)]), !options.metrics[std::size_t(k)]) << k;
    }
  }
}

TEST(Ensemble, RefusesOptionsOutOfRange) {
  const auto message = [](const EnsembleOptions& options) -> std::string {
    try {
      solve({}, options);
    } catch (const ParameterError& error) {
      return error.what();
    }
    return "";
  };
  EnsembleOptions options;
  options.tolerance = 0.5;
  EXPECT_THAT(message(options), testing::HasSubstr("tolerance"));
  EXPECT_EQ(message({}), "");
}

/// Motors that heat up: packs settle at the temperatures of the scalar solver, whatever they are solved with.
TEST(Ensemble, WarmMotors) {
  std::vector<EnsembleMember> members = warm_members(1500, 816);
  const StartUp start_up = start_up_in_time();
  const auto got = solve(members, {.tolerance = 1e-6}, start_up);
  int flapping = 0, by_packs = 0, too_hot = 0;
  for (std::size_t n = 0; n < members.size(); n += 5) {
    const SteadyFlapping expected =
        find_steady_flapping(members[n].vehicle, {.tolerance = 1e-9, .reporting = members[n].reporting}, start_up);
    ASSERT_EQ(got[n].status, expected.status) << n << " " << describe(expected.evidence);
    if (expected.status != FlappingStatus::flapping) continue;
    ++flapping;
    by_packs += !got[n].scalar;
    too_hot += got[n].domain[std::size_t(DomainLimit::winding_temperature)];
    EXPECT_EQ(got[n].domain, domain_of(members[n].vehicle, expected.metrics)) << n;
    for (int k = 0; k < metric_count; ++k) {
      const Metric m = Metric(k);
      if (m == Metric::floquet_multiplier_max || std::isnan(expected.metrics[m])) continue;
      EXPECT_NEAR(got[n].metrics[m], expected.metrics[m], 2e-6 * error_scale(expected.metrics, m))
          << n << " " << metric_info(m).key;
    }
  }
  EXPECT_GT(flapping, 250);
  EXPECT_GT(by_packs, 0.95 * flapping);
  EXPECT_GT(too_hot, 10);
  // Neither the neighbours nor their number matter.
  const auto alone = solve({members[7]}, {.tolerance = 1e-6}, start_up);
  EXPECT_TRUE(same_bits(alone[0], got[7]));
  // Metrics that were not asked for are absent, the domain is known all the same.
  const auto lift = solve(members, {.metrics = MetricSet().set(std::size_t(Metric::lift_mean))}, start_up);
  for (std::size_t n = 0; n < members.size(); ++n) {
    EXPECT_EQ(lift[n].domain, got[n].domain) << n;
    EXPECT_TRUE(std::isnan(lift[n].metrics[Metric::winding_temperature]));
  }
}

}  // namespace
}  // namespace wingbeat

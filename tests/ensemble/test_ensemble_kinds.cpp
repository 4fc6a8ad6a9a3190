#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "ensemble/ensemble_comparison.hpp"
#include "vehicle/kind_boxes.hpp"
#include "vehicle/random_vehicle.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

/// With the scalar solver's outcomes at 1e-10, for each instruction set here.
std::vector<Agreement> agreements(const std::vector<EnsembleMember>& members, double far) {
  EnsembleOptions exact;
  exact.scalar_only = true;
  exact.tolerance = 1e-10;
  const auto expected = solve(members, exact);
  std::vector<Agreement> all;
  for (const InstructionSet isa : available()) {
    EnsembleOptions options;
    options.isa = isa;
    all.push_back(agreement(solve(members, options), expected, 1e-6, far));
  }
  return all;
}

struct ByBoth {
  std::vector<EnsembleOutcome> batched, scalar;
};

/// Designs of a box at 1e-6, and by the scalar solver at 1e-9.
ByBoth by_both(KindBox box, int count) {
  const StartUp start_up = remembered_start_up();
  std::mt19937_64 random(41);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < count; ++n) members.push_back(member_of(kind_design(box, random)));
  EnsembleOptions exact;
  exact.scalar_only = true;
  exact.tolerance = 1e-9;
  return {solve(members, {}, start_up), solve(members, exact, start_up)};
}

/// Boxes of one kind of part each: how many of those that flap go to the scalar solver at most, in a hundred.
TEST(EnsembleKinds, EveryOneAgreesWithTheScalarSolver) {
  for (const auto& [box, scalars] : {std::pair{KindBox::tables, 3},
                                     {KindBox::pitch_stop, 4},
                                     {KindBox::small_inductance, 3},
                                     {KindBox::battery, 3},
                                     {KindBox::four_bar, 15},
                                     {KindBox::tabulated, 3},
                                     {KindBox::gear_loss, 6},
                                     {KindBox::heat, 3}}) {
    const ByBoth found = by_both(box, many_members / 80);
    const auto [flapping, by_packs, outside] = agreement(found.batched, found.scalar, 1e-6, 10.0, true);
    const std::string_view name = kind_box_names[std::size_t(box)];
    EXPECT_GT(flapping, many_members / 100) << name;
    EXPECT_GE(by_packs, flapping * (100 - scalars) / 100) << name;
    EXPECT_LE(outside, flapping / 100) << name;
  }
}

/// What drives the gearbox back depends on the friction that does not follow the load.
TEST(EnsembleKinds, GearLossesUnderEveryFrictionLaw) {
  const StartUp start_up = remembered_start_up();
  std::mt19937_64 random(20261127);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  for (const auto& [law, largest] : {std::pair{FrictionLaw::none, 0.0},
                                     {FrictionLaw::load_proportional, 3e-3},
                                     {FrictionLaw::viscous, 1e-5},
                                     {FrictionLaw::quadratic, 1e-7},
                                     {FrictionLaw::constant, 3e-4}}) {
    std::vector<EnsembleMember> members;
    for (int n = 0; n < many_members / 80; ++n) {
      Design<double> d = kind_design(KindBox::gear_loss, random);
      d.friction = {law, largest * uniform(0.01, 1.0)};
      // Without air, or without wings, what takes no power has means that are rounding.
      const bool load_free = law != FrictionLaw::none && law != FrictionLaw::load_proportional;
      Condition condition = Condition::air;
      if (n % 4 == 0 && load_free) condition = Condition::wingless;
      if (n % 4 == 1 && law != FrictionLaw::none) condition = Condition::vacuum;
      members.push_back({resolve(d, condition), reporting_of(d)});
    }
    EnsembleOptions exact;
    exact.scalar_only = true;
    exact.tolerance = 1e-9;
    const auto [flapping, by_packs, outside] =
        agreement(solve(members, {}, start_up), solve(members, exact, start_up), 1e-6, 10.0, true);
    EXPECT_GT(flapping, many_members / 200) << name_of(law);
    EXPECT_GT(by_packs, flapping / 2) << name_of(law);
    EXPECT_LE(outside, flapping / 50) << name_of(law);
  }
}

/// Lanes tell lock from slow flapping; few designs are left to the scalar solver: those of cranks that statics must
/// tell of, and a few more.
TEST(EnsembleKinds, NearStallStatusesAreThoseOfTheScalarSolver) {
  const ByBoth found = by_both(KindBox::near_stall, 256);
  const auto [flapping, by_packs, outside] = agreement(found.batched, found.scalar, 1e-6, 10.0, true);
  EXPECT_GT(flapping, 128);
  EXPECT_GE(by_packs, flapping * 95 / 100);
  EXPECT_LE(outside, flapping / 100);
  EXPECT_LE(std::count_if(found.batched.begin(), found.batched.end(), [](const auto& out) { return out.scalar; }), 16);
}

/// Cranks without springs that creep: neither a simulation's limits nor a search from the speed without load tell.
TEST(EnsembleKinds, CreepingCranksNeedNoSimulation) {
  std::mt19937_64 random(20225);
  for (int n = 0; n <= 325; ++n) {
    const Design<double> design = kind_design(KindBox::near_stall, random);
    if (n != 144 && n != 233 && n != 278 && n != 325) continue;
    const SteadyFlapping found = find_steady_flapping(resolve(design), {.tolerance = 1e-6});
    EXPECT_EQ(found.status, FlappingStatus::flapping) << n;
    EXPECT_LT(found.metrics[Metric::crank_speed_max], 0.02 * no_load_speed(resolve(design))) << n;
  }
}

/// The table with its knots off any equal steps.
std::shared_ptr<const CoefficientTable> unevenly(const CoefficientTable& table) {
  std::vector<double> alpha = table.alpha();
  for (std::size_t n = 1; n + 1 < alpha.size(); ++n) alpha[n] += 0.03 * std::sin(double(n)) * (alpha[1] - alpha[0]);
  return std::make_shared<const CoefficientTable>(alpha, table.lift(), table.drag());
}

/// Stops that wings just reach, stops beside tables, and added mass beside tables.
TEST(EnsembleKinds, BendsAgreeWithTheScalarSolver) {
  std::mt19937_64 random(43);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  std::vector<EnsembleMember> free, members;
  for (int n = 0; n < 160; ++n) free.push_back(member_of(box_design(random)));
  const auto reached = solve(free, {});
  const auto table = random_table(random), uneven = unevenly(*random_table(random));
  ASSERT_EQ(uneven->lookup().steps, 0);
  for (std::size_t n = 0; n < free.size(); ++n) {
    if (reached[n].status != FlappingStatus::flapping) continue;
    EnsembleMember m = free[n];
    const double lowest = reached[n].metrics[Metric::angle_of_attack_min] / degrees_per_radian;
    m.vehicle.wings.angle_of_attack_min = std::clamp(lowest + (n % 2 ? 0.3 : 1e-3) * uniform(-1.0, 1.0), 0.0, 1.5);
    if (n % 4 == 1) m.vehicle.wings.coefficients.table = n % 8 == 1 ? table : uneven;
    if (n % 4 == 3) {  // added mass knows no stop
      m.vehicle.wings.angle_of_attack_min = -infinity;
      m.vehicle.wings.coefficients.table = random_table(random);
      m.vehicle.wings.added_inertia = 0.3 * m.vehicle.wing_count * m.vehicle.wing_inertia;
    }
    members.push_back(m);
  }
  for (const auto& [flapping, by_packs, outside] : agreements(members, 10.0)) {
    EXPECT_GT(by_packs, flapping * 3 / 5);
    EXPECT_LE(outside, flapping / 50);
  }
}

/// Two of the benchmark's designs whose rod force has its peak where the wings reach their stop.
TEST(EnsembleKinds, PeaksOnBendsAgreeWithTheScalarSolver) {
  std::mt19937_64 random(20225);
  std::vector<EnsembleMember> members;
  for (int n = 0; n <= 7148; ++n) {
    const Design<double> design = kind_design(KindBox::pitch_stop, random);
    if (n == 2495 || n == 7148) members.push_back(member_of(design));
  }
  for (const auto& [flapping, by_packs, outside] : agreements(members, 1.0)) {
    EXPECT_EQ(by_packs, 2);
    EXPECT_EQ(outside, 0);
  }
}

/// Designs of the benchmark's boxes that were outside the tolerance: peaks that a change of speed moves much, where
/// speed is low or the motor is near its speed without load; a mean lift that almost cancels.
TEST(EnsembleKinds, SensitiveMetricsAreWithinTheTolerance) {
  const auto some_of = [](KindBox box, const std::vector<int>& numbers) {
    std::mt19937_64 random(20225);
    std::vector<EnsembleMember> members;
    for (int n = 0; n <= numbers.back(); ++n) {
      const Design<double> design = kind_design(box, random);
      if (std::binary_search(numbers.begin(), numbers.end(), n)) members.push_back(member_of(design));
    }
    return members;
  };
  std::vector<EnsembleMember> members = some_of(KindBox::coreless, {964, 3122, 6011, 6487});
  for (const EnsembleMember& m : some_of(KindBox::near_stall, {1376, 8546})) members.push_back(m);
  for (const EnsembleMember& m : some_of(KindBox::small_inductance, {929, 4062})) members.push_back(m);
  for (const auto& [flapping, by_packs, outside] : agreements(members, 1.0)) {
    EXPECT_EQ(flapping, int(members.size()));
    EXPECT_EQ(outside, 0);
  }
}

/// A design near stall whose crank all but stops, inside an implicit step: a part of that step is one that Newton's
/// method does not solve at once.
TEST(EnsembleKinds, ALeastSpeedInsideAnImplicitStepIsFound) {
  std::mt19937_64 random(20225);
  Design<double> design;
  for (int n = 0; n <= 9177; ++n) design = kind_design(KindBox::near_stall, random);
  SteadyOptions options;
  const double least =
      find_steady_flapping(resolve(design), options, start_up_in_time()).metrics[Metric::crank_speed_min];
  options.tolerance = 1e-8;
  const double exact =
      find_steady_flapping(resolve(design), options, start_up_in_time()).metrics[Metric::crank_speed_min];
  EXPECT_GT(exact, 0.05);
  EXPECT_NEAR(least, exact, 1e-5 * exact);
}

/// What lanes do not know of tables: an end below the angle of attack at the reversals.
TEST(EnsembleKinds, ShortTablesAreLeftToTheScalarSolver) {
  EnsembleMember m = member_of(reference_design());
  m.vehicle.wings.coefficients.table = std::make_shared<const CoefficientTable>(
      std::vector{0.0, 0.7, 1.4}, std::vector{0.2, 1.7, 0.4}, std::vector{0.4, 1.8, 3.4});
  EXPECT_TRUE(solve({m}, {})[0].scalar);
}

TEST(EnsembleKinds, OutcomeDependsNeitherOnPlaceNorOnCompany) {
  std::mt19937_64 random(47);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 240; ++n) {
    members.push_back(member_of(kind_design(KindBox(std::size_t(n) % kind_box_names.size()), random)));
  }
  for (const InstructionSet isa : available()) {
    EnsembleOptions options;
    options.isa = isa;
    expect_equal_in_any_batch(members, options);
  }
}

}  // namespace
}  // namespace wingbeat

// Masses that are stated for themselves, and the weight that follows.
#include <gtest/gtest.h>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

Design<double> itemised() {
  Design<double> d = reference_design();
  d.spring.stiffness = 1.377e-3;
  d.mass = 1.5e-3;
  d.masses = {0.8e-3, 0.6e-3, 5e-3, 0.05e-3};
  return d;
}

TEST(Masses, TheWholeIsTheSumOfWhatIsStated) {
  Design<double> d = itemised();
  EXPECT_DOUBLE_EQ(*total_mass(d), 1.5e-3 + 0.8e-3 + 0.6e-3 + 5e-3 * d.transmission.rod_length + 2.0 * 0.05e-3);
  d.spring = {};
  EXPECT_DOUBLE_EQ(*total_mass(d), 1.5e-3 + 0.8e-3 + 0.6e-3 + 5e-3 * d.transmission.rod_length);
  d.masses = {};
  EXPECT_EQ(total_mass(d), 1.5e-3);  // as in files that itemise nothing
  d.masses.motor = 1e-3;
  d.mass.reset();
  EXPECT_FALSE(total_mass(d));
}

TEST(Masses, LiftToWeightCountsThem) {
  const Design<double> d = itemised();
  const Metrics<double> m = run_design(d).metrics;
  EXPECT_DOUBLE_EQ(m[Metric::lift_to_weight], m[Metric::lift_mean] / (*total_mass(d) * standard_gravity));
  // The batched solver likewise.
  const EnsembleMember members[] = {{resolve(d), reporting_of(d)}};
  EnsembleOutcome outcomes[1];
  solve_ensemble(members, {}, start_up_in_time(), outcomes);
  EXPECT_NEAR(outcomes[0].metrics[Metric::lift_to_weight], m[Metric::lift_to_weight], 1e-5);
}

TEST(Masses, AreRefusedByNameWhereNegative) {
  const auto refused = [](auto change) -> std::string {
    Design<double> d = itemised();
    change(d.masses);
    try {
      validate(d);
    } catch (const ParameterError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refused([](auto& m) { m.supply = -1.0; }), "supply.mass: must be >= 0 [kg], got -1");
  EXPECT_EQ(refused([](auto& m) { m.motor = -1.0; }), "motor.mass: must be >= 0 [kg], got -1");
  EXPECT_EQ(refused([](auto& m) { m.rod_linear_density = -1.0; }),
            "transmission.rod_linear_density: must be >= 0 [kg/m], got -1");
  EXPECT_EQ(refused([](auto& m) { m.spring = -1.0; }), "spring.mass: must be >= 0 [kg], got -1");
  EXPECT_EQ(refused([](auto& m) { m.spring = 0.0; }), "accepted");
}

}  // namespace
}  // namespace wingbeat

// Masses that are stated for themselves, and the weight that follows.
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/vehicle/parameters.hpp"

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

Design<double> on_battery() {
  Design<double> d = reference_design();
  d.supply = {};
  d.supply.type = SupplyType::battery;
  d.supply.battery.cell_voltage = 3.7;
  d.supply.battery.internal_resistance = 1.0;
  d.supply.battery.capacity = 108.0;
  d.supply.battery.specific_energy = 160.0 * 3600.0;
  return d;
}

// The orbit does not depend on the capacity; what it weighs does.
TEST(Masses, ALargerBatteryCostsLiftOverWeight) {
  Design<double> d = on_battery();
  const double battery = 108.0 * 3.7 / (160.0 * 3600.0);
  EXPECT_DOUBLE_EQ(*total_mass(d), 3.34e-3 + battery);
  const SteadyFlapping found = find_steady_flapping(resolve(d), {.tolerance = 1e-10, .reporting = reporting_of(d)});
  ASSERT_EQ(found.status, FlappingStatus::flapping);
  Design<GradientJet> seeded = cast<GradientJet>(d);
  seeded.supply.battery.capacity = gradient_seed(108.0, 0);
  const OrbitGradient g = orbit_gradient(found, gradient_vehicle(seeded, Condition::air));
  const double expected = -found.metrics[Metric::lift_to_weight] * battery / 108.0 / *total_mass(d);
  EXPECT_NEAR(g.metrics[Metric::lift_to_weight].v[gradient_first_slot], expected, 1e-9 * std::abs(expected));
  EXPECT_EQ(g.metrics[Metric::lift_mean].v[gradient_first_slot], 0.0);
  d.supply.type = SupplyType::constant;  // no battery, whatever was said of one
  EXPECT_DOUBLE_EQ(*total_mass(d), 3.34e-3);
}

TEST(Masses, OfABatteryAreStatedOnce) {
  Design<double> d = on_battery();
  EXPECT_NO_THROW(validate(d));
  d.masses.supply = 1e-3;
  try {
    validate(d);
    FAIL() << "accepted";
  } catch (const ParameterError& error) {
    EXPECT_STREQ(error.what(),
                 "supply.specific_energy: gives the mass of the battery, which supply.mass states; give one of them");
  }
  set_parameter(d, "supply.specific_energy", 5e5);
  EXPECT_FALSE(d.masses.supply);
  set_parameter(d, "supply.mass", 1e-3);
  EXPECT_FALSE(d.supply.battery.specific_energy);
  EXPECT_DOUBLE_EQ(*total_mass(d), 4.34e-3);
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

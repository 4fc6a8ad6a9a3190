// The endurance as a metric of studies: a flight's, with derivatives, where it is asked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "study/battery_design.hpp"
#include "study/optimised_parameters.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/study/optimise.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

/// Derivatives of the endurance against central differences of whole flights.
void expect_derivatives(const Design<double>& d, std::initializer_list<const char*> keys, double tolerance,
                        double of_flight = 1e-10, bool of_hover = false) {
  std::vector<DesignParameter> parameters;
  for (const char* key : keys) parameters.push_back(design_parameter(key));
  const Endurance e = endurance_of(d, Condition::air, 1e-8, parameters, {of_hover, !of_hover, false});
  const std::vector<double>& found = of_hover ? e.hover_by_parameter : e.by_parameter;
  ASSERT_EQ(found.size(), parameters.size());
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const DesignParameter& p = parameters[k];
    const double x = p.value(d).value(), step = 2e-4 * x;
    const auto time = [&](double stated) {
      Design<double> other = d;
      p.set(other, stated);
      const EnduranceResult flight = simulate_discharge(other, {.tolerance = of_flight});
      return of_hover ? flight.hover_time() : flight.endurance();
    };
    const double expected = (time(x + step) - time(x - step)) / (2.0 * step);
    EXPECT_NEAR(found[k], expected, tolerance * std::abs(expected) + 1e-7 * e.time / x) << p.key;
  }
}

void expect_hover_derivatives(const Design<double>& d, std::initializer_list<const char*> keys, double tolerance,
                              double of_flight = 1e-10) {
  expect_derivatives(d, keys, tolerance, of_flight, true);
}

TEST(EnduranceMetric, IsTheTimeOfAFlight) {
  Design<double> d = hovering_design();
  for (const std::optional<double> cutoff : {std::optional<double>(), std::optional(2.7)}) {
    d.supply.battery.cutoff_voltage = cutoff;
    const double flight = simulate_discharge(d).endurance();
    EXPECT_NEAR(endurance_of(d, Condition::air, 1e-6).time, flight, 1e-6 * flight);
  }
  EXPECT_THROW(endurance_of(reference_design(), Condition::air, 1e-6), ParameterError);
}

TEST(EnduranceMetric, HoverIsTheTimeUntilLiftFallsBelowTheWeight) {
  Design<double> d = hovering_design();
  const EnduranceResult flight = simulate_discharge(d);
  ASSERT_TRUE(flight.hover_lost);
  EXPECT_EQ(flight.hover_time(), flight.hover_lost->time);
  EXPECT_LT(flight.hover_time(), 0.95 * flight.endurance());
  const Endurance e = endurance_of(d, Condition::air, 1e-6);
  EXPECT_NEAR(e.hover, flight.hover_time(), 1e-6 * flight.hover_time());
  EXPECT_NEAR(e.time, flight.endurance(), 1e-6 * flight.endurance());
  d.supply.battery.cells = 3.0;  // carries the weight to the end
  EXPECT_EQ(endurance_of(d, Condition::air, 1e-6).hover, endurance_of(d, Condition::air, 1e-6).time);
  d.supply.battery.cells = 1.0;
  const DesignParameter parameters[] = {design_parameter("spring.stiffness")};
  const Endurance never = endurance_of(d, Condition::air, 1e-6, parameters);
  EXPECT_EQ(never.hover, 0.0);
  EXPECT_GT(never.time, 0.0);
  EXPECT_TRUE(std::isnan(never.hover_by_parameter.at(0)));
  EXPECT_TRUE(std::isfinite(never.by_parameter.at(0)));
  d.mass.reset();
  EXPECT_TRUE(std::isnan(endurance_of(d, Condition::air, 1e-6).hover));
  EXPECT_STREQ(missing_key(Metric::hover, d), "vehicle.mass");
  EXPECT_STREQ(missing_key(Metric::hover, reference_design()), "supply.type = \"battery\"");
}

TEST(EnduranceMetric, DerivativesOfHover) {
  Design<double> d = hovering_design();
  expect_hover_derivatives(d,
                           {"supply.capacity", "supply.internal_resistance", "supply.charge", "spring.stiffness",
                            "motor.torque_constant", "transmission.hinge_offset", "vehicle.mass"},
                           1e-4);
  // A larger battery weighs more.
  d.supply.battery.specific_energy = 160.0 * 3600.0;
  *d.mass -= 0.5 * battery_mass(d.supply.battery).value();
  expect_hover_derivatives(d, {"supply.capacity", "supply.specific_energy"}, 1e-4);
}

TEST(EnduranceMetric, DerivativesOfHoverThatEndsWithTheBatteryOrTheDomain) {
  Design<double> kept = hovering_design();
  kept.mass = 1.5e-3;
  ASSERT_EQ(simulate_discharge(kept).hover, Hover::kept);
  expect_hover_derivatives(kept, {"spring.stiffness"}, 1e-4);
  Design<double> warm = hovering_design();
  MotorThermalDesign<double>& t = warm.motor.thermal;
  t.resistance_winding = t.resistance_case = 20.0;
  t.time_constant_winding = 3.0;
  t.time_constant_case = 60.0;
  t.winding_temperature_max = 60.0 + zero_celsius;
  warm.mass = 1.5e-3;
  const EnduranceResult leaves = simulate_discharge(warm, {.tolerance = 1e-8});
  ASSERT_EQ(leaves.hover, Hover::lost);
  EXPECT_NEAR(leaves.hover_lost->metrics[Metric::winding_temperature], 60.0, 1e-6);
  expect_hover_derivatives(warm, {"motor.armature_resistance"}, 1e-2, 1e-8);
}

TEST(EnduranceMetric, DerivativesOfAFlightToTheEnd) {
  expect_derivatives(hovering_design(),
                     {"supply.capacity", "supply.internal_resistance", "spring.stiffness", "motor.torque_constant",
                      "transmission.hinge_offset", "aerodynamics.air_density", "vehicle.mass"},
                     1e-4);
}

TEST(EnduranceMetric, DerivativesOfAFlightToTheCutoff) {
  Design<double> d = hovering_design();
  d.supply.battery.cutoff_voltage = 2.7;
  expect_derivatives(d,
                     {"supply.capacity", "supply.cutoff_voltage", "supply.internal_resistance", "supply.charge",
                      "spring.stiffness", "motor.armature_resistance"},
                     1e-4);
}

TEST(EnduranceMetric, DerivativesOfAFlightAtOneVoltage) {
  Design<double> d = hovering_design();
  d.supply.battery.discharge_curve.clear();
  d.supply.battery.cell_voltage = 3.0;
  d.supply.battery.charge = 0.8;
  expect_derivatives(d, {"supply.cell_voltage", "supply.capacity", "supply.charge", "wing.inertia"}, 1e-4);
  const Endurance e = endurance_of(d, Condition::air, 1e-8);
  const double current = run_design(d, {.tolerance = 1e-10}).metrics[Metric::current_mean];
  EXPECT_NEAR(e.time, 0.8 * 108.0 / current, 1e-8 * e.time);
}

TEST(EnduranceMetric, DerivativesWhereTheMotorWarmsUpOrTheCrankStops) {
  Design<double> warm = hovering_design();
  MotorThermalDesign<double>& t = warm.motor.thermal;
  t.resistance_winding = t.resistance_case = 20.0;
  expect_derivatives(warm, {"supply.internal_resistance", "spring.stiffness"}, 1e-4);  // settled
  t.time_constant_winding = 3.0;
  t.time_constant_case = 60.0;
  expect_derivatives(warm, {"spring.stiffness"}, 1e-3, 1e-8);

  Design<double> stops = hovering_design();
  stops.friction = {FrictionLaw::constant, 2e-3};
  stops.supply.battery.discharge_curve = {{0.0, 0.5}, {1.0, 3.0}};
  ASSERT_EQ(simulate_discharge(stops).end, EnduranceEnd::stops);
  expect_derivatives(stops, {"supply.capacity", "friction.torque"}, 1e-3);
}

TEST(EnduranceMetric, NothingThatNeverStartsHasDerivatives) {
  Design<double> d = hovering_design();
  d.supply.battery.internal_resistance = 500.0;
  d.motor.constants.friction_torque = 1e-3;
  const DesignParameter parameters[] = {design_parameter("supply.capacity")};
  const Endurance e = endurance_of(d, Condition::air, 1e-6, parameters);
  EXPECT_EQ(e.time, 0.0);
  EXPECT_TRUE(std::isnan(e.by_parameter.at(0)));
}

TEST(EnduranceMetric, IsComputedWhereItIsAskedFor) {
  EXPECT_FALSE(all_metrics()[std::size_t(Metric::endurance)]);
  EXPECT_FALSE(all_metrics()[std::size_t(Metric::hover)]);
  const Design<double> d = hovering_design();
  const double time = simulate_discharge(d).endurance(), hover = simulate_discharge(d).hover_time();
  EXPECT_TRUE(std::isnan(run_design(d).metrics[Metric::hover]));
  EXPECT_NEAR(run_design(d, {.endurance = true}).metrics[Metric::hover], hover, 1e-5 * hover);
  EXPECT_TRUE(std::isnan(run_design(d).metrics[Metric::endurance]));
  EXPECT_NEAR(run_design(d, {.endurance = true}).metrics[Metric::endurance], time, 1e-5 * time);
  EXPECT_TRUE(std::isnan(run_design(reference_design(), {.endurance = true}).metrics[Metric::endurance]));
  EXPECT_STREQ(missing_key(Metric::endurance, reference_design()), "supply.type = \"battery\"");
  EXPECT_EQ(missing_key(Metric::endurance, d), nullptr);

  DesignPointOptions options;
  EXPECT_TRUE(std::isnan(design_point(d, options, {}, start_up_in_time()).metrics[Metric::endurance]));
  options.flight = {true, true, false};
  const DesignPoint point = design_point(d, options, {}, start_up_in_time());
  EXPECT_NEAR(point.metrics[Metric::endurance], time, 1e-5 * time);
  EXPECT_NEAR(point.metrics[Metric::hover], hover, 1e-5 * hover);
}

// Lift does not depend on the capacity: the largest battery that the vehicle carries has a closed form.
TEST(EnduranceMetric, TheLargestBatteryThatTheVehicleCarries) {
  OptimiseStudy study;
  study.design = hovering_design();
  study.design.mass = 2.5e-3;
  study.design.supply.battery.specific_energy = 160.0 * 3600.0;
  study.objective = Metric::endurance;
  study.maximise = true;
  study.parameters = {between("supply.capacity", 20.0, 1000.0)};
  study.constraints = {{Metric::lift_to_weight, true, 1.0}};
  study.starts = 2;
  study.screen = 16;
  const OptimiseResult r = optimise(study, start_up_in_time());
  ASSERT_EQ(r.outcome, OptimiseResult::Outcome::found);
  const double lift = r.point.metrics[Metric::lift_mean];
  const double largest =
      (lift / standard_gravity - 2.5e-3) * 160.0 * 3600.0 / mean_open_circuit_voltage(study.design.supply.battery);
  EXPECT_NEAR(r.parameters.at(0) / largest, 1.0, 1e-5);
  ASSERT_FALSE(r.active.empty());
  EXPECT_EQ(r.active[0].name, "lift_to_weight >= 1");
  EXPECT_NEAR(r.point.metrics[Metric::endurance] / simulate_discharge(r.design).endurance(), 1.0, 1e-6);
}

}  // namespace
}  // namespace wingbeat

// Flight to the end of a battery: closed forms, energy accounts by other ways, and the moments that end it.
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/study/endurance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "study/battery_design.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

/// Antiderivative of the open-circuit voltage by exact Gauss quadrature of each cubic.
double chemical_energy(const Battery<double>& b, double from, double to) {
  double sum = 0.0;
  for (std::size_t k = 1; k < b.discharge_curve.size(); ++k) {
    const double low = std::max(to, b.discharge_curve[k - 1].first), high = std::min(from, b.discharge_curve[k].first);
    if (!(high > low)) continue;
    for (const double node : {-1.0 / std::sqrt(3.0), 1.0 / std::sqrt(3.0)}) {
      sum += 0.5 * (high - low) * open_circuit_voltage(b, 0.5 * (low + high) + 0.5 * (high - low) * node);
    }
  }
  return b.capacity * sum;
}

TEST(Endurance, EnergyAtTheTerminalsIsChemicalEnergyLessTheInternalLoss) {
  const Design<double> d = hovering_design();
  const EnduranceResult r = simulate_discharge(d);
  ASSERT_EQ(r.end, EnduranceEnd::empty) << describe(r);
  const EnduranceRow& last = r.rows.back();
  const double chemical = chemical_energy(d.supply.battery, 1.0, 0.0);
  EXPECT_NEAR(last.energy_electrical, chemical - last.energy_internal, 1e-9 * chemical);
  EXPECT_GT(last.energy_internal, 0.01 * chemical);
}

// The integral of P_e over time by Simpson's rule between the rows of the curve, from runs of their own.
TEST(Endurance, EnergyIsTheIntegralOfPowerByAnIndependentQuadrature) {
  const Design<double> d = hovering_design();
  const EnduranceResult r = simulate_discharge(d);
  const auto& curve = d.supply.battery.discharge_curve;
  double energy = 0.0, time = 0.0;
  for (std::size_t k = 1; k < curve.size(); ++k) {
    constexpr int pieces = 40;
    const double width = curve[k].first - curve[k - 1].first;
    for (int n = 0; n <= 2 * pieces; ++n) {
      Design<double> here = d;
      here.supply.battery.charge = n == 2 * pieces ? curve[k].first : curve[k - 1].first + width * n / (2 * pieces);
      const Metrics<double> m = run_design(here, {.tolerance = 1e-11}).metrics;
      const double weight = (n == 0 || n == 2 * pieces ? 1.0 : n % 2 ? 4.0 : 2.0) * width / (6.0 * pieces);
      const double duration = weight * d.supply.battery.capacity / m[Metric::current_mean];
      time += duration;
      energy += duration * m[Metric::power_electrical];
    }
  }
  EXPECT_NEAR(r.rows.back().energy_electrical, energy, 1e-9 * energy);
  EXPECT_NEAR(r.endurance(), time, 1e-9 * time);
}

TEST(Endurance, HalvesWithTheCapacity) {
  Design<double> d = hovering_design();
  const EnduranceResult whole = simulate_discharge(d);
  d.supply.battery.capacity *= 0.5;
  const EnduranceResult half = simulate_discharge(d);
  EXPECT_DOUBLE_EQ(half.endurance(), 0.5 * whole.endurance());
  ASSERT_TRUE(whole.hover_lost && half.hover_lost);
  EXPECT_DOUBLE_EQ(half.hover_lost->time, 0.5 * whole.hover_lost->time);
  EXPECT_DOUBLE_EQ(half.hover_lost->charge, whole.hover_lost->charge);
}

// Wingless at a constant voltage: i = v b / (K^2 + (R_a + R_i) b) to the end.
TEST(Endurance, WinglessClosedForm) {
  Design<double> d = reference_design();
  d.supply.type = SupplyType::battery;
  d.supply.battery.cell_voltage = 3.7;
  d.supply.battery.internal_resistance = 2.0;
  d.supply.battery.capacity = 180.0;
  d.supply.battery.charge = 0.75;
  const EnduranceResult r = simulate_discharge(d, {.condition = Condition::wingless});
  const Motor<double>& m = d.motor.constants;
  const double i = 3.7 * m.viscous_damping / (square(m.torque_constant) + 11.0 * m.viscous_damping);
  EXPECT_NEAR(r.endurance(), 0.75 * 180.0 / i, 1e-9 * r.endurance());
  EXPECT_NEAR(r.rows.back().energy_electrical, 0.75 * 180.0 * (3.7 - 2.0 * i), 1e-9 * r.rows.back().energy_electrical);
  EXPECT_NEAR(r.rows.back().energy_internal, 0.75 * 180.0 * 2.0 * i, 1e-9 * r.rows.back().energy_electrical);
  EXPECT_EQ(r.end, EnduranceEnd::empty);
}

// Without damping and friction a wingless motor at a linear voltage draws nothing; with damping i is linear in the
// charge, and time is a logarithm: dt = Q ds / (c (a + s)).
TEST(Endurance, LinearCurveGivesALogarithm) {
  Design<double> d = reference_design();
  d.supply.type = SupplyType::battery;
  Battery<double>& b = d.supply.battery;
  b.discharge_curve = {{0.0, 3.0}, {1.0, 4.0}};
  b.internal_resistance = 2.0;
  b.capacity = 100.0;
  const EnduranceResult r = simulate_discharge(d, {.condition = Condition::wingless});
  const Motor<double>& m = d.motor.constants;
  const double per_volt = m.viscous_damping / (square(m.torque_constant) + 11.0 * m.viscous_damping);
  EXPECT_NEAR(r.endurance(), 100.0 / per_volt * std::log(4.0 / 3.0), 1e-9 * r.endurance());
}

// A measured curve of thousands of rows costs no more orbits than its two ends.
TEST(Endurance, ManyRowsOfADischargeCurveCostNoOrbits) {
  Design<double> d = hovering_design();
  Battery<double>& b = d.supply.battery;
  b.discharge_curve = {{0.0, 2.9}, {1.0, 3.6}};
  const EnduranceResult few = simulate_discharge(d);
  b.discharge_curve.clear();
  for (int n = 0; n <= 2000; ++n) b.discharge_curve.emplace_back(n / 2000.0, 2.9 + 0.7 * n / 2000.0);
  const EnduranceResult many = simulate_discharge(d);
  EXPECT_NEAR(many.endurance(), few.endurance(), 1e-9 * few.endurance());
  EXPECT_NEAR(many.rows.back().lift_impulse, few.rows.back().lift_impulse, 1e-9 * few.rows.back().lift_impulse);
  EXPECT_LT(few.evaluations, 400);
  EXPECT_LT(many.evaluations, 400);

  // Rows with curvature: the curve of the vehicle above, sampled, against the cubics themselves.
  const Design<double> smooth = hovering_design();
  for (int n = 0; n <= 2000; ++n) {
    b.discharge_curve[std::size_t(n)].second = 0.5 * open_circuit_voltage(smooth.supply.battery, n / 2000.0);
  }
  const EnduranceResult sampled = simulate_discharge(d), exact = simulate_discharge(smooth);
  EXPECT_NEAR(sampled.endurance(), exact.endurance(), 1e-6 * exact.endurance());
  EXPECT_LT(sampled.evaluations, 1000);
}

TEST(Endurance, HoverIsLostWhereLiftEqualsWeight) {
  const Design<double> d = hovering_design();
  const EnduranceResult r = simulate_discharge(d);
  ASSERT_EQ(r.hover, Hover::lost);
  const EnduranceRow& lost = *r.hover_lost;
  EXPECT_GT(lost.charge, 0.05);
  EXPECT_LT(lost.charge, 0.95);
  Design<double> there = d;
  there.supply.battery.charge = lost.charge;
  const RunResult run = run_design(there, {.tolerance = 1e-10});
  EXPECT_NEAR(run.metrics[Metric::lift_to_weight], 1.0, 1e-9);
  EXPECT_NEAR(run.metrics[Metric::voltage], lost.metrics[Metric::voltage], 1e-9);
  EXPECT_NEAR(run.metrics[Metric::current_mean], lost.metrics[Metric::current_mean], 1e-9);
  EXPECT_NEAR(lost.metrics[Metric::voltage], lost.open_circuit_voltage - 0.8 * lost.metrics[Metric::current_mean],
              1e-12);
  // Before it the vehicle rises, after it sinks, and the rows go on in time.
  for (std::size_t n = 1; n < r.rows.size(); ++n) {
    EXPECT_GT(r.rows[n].time, r.rows[n - 1].time);
    EXPECT_LT(r.rows[n].charge, r.rows[n - 1].charge);
    EXPECT_EQ(r.rows[n].metrics[Metric::lift_to_weight] > 1.0 + 1e-9, r.rows[n].time < lost.time) << n;
  }
}

TEST(Endurance, HoverNeverKeptAndUnknown) {
  Design<double> d = hovering_design();
  d.supply.battery.cells = 1.0;
  EXPECT_EQ(simulate_discharge(d).hover, Hover::never);
  d.supply.battery.cells = 3.0;
  EXPECT_EQ(simulate_discharge(d).hover, Hover::kept);
  d.mass.reset();
  EXPECT_EQ(simulate_discharge(d).hover, Hover::unknown);
}

TEST(Endurance, CutoffEndsTheFlight) {
  Design<double> d = hovering_design();
  d.supply.battery.cutoff_voltage = 2.7;
  const EnduranceResult r = simulate_discharge(d);
  ASSERT_EQ(r.end, EnduranceEnd::cutoff);
  EXPECT_NEAR(r.rows.back().metrics[Metric::voltage], 5.4, 1e-9);
  EXPECT_GT(r.rows.back().charge, 0.0);
  EXPECT_THAT(describe(r), testing::HasSubstr("falls to the cut-off voltage, 5.4 V in all"));
  ASSERT_TRUE(r.cutoff_voltage);
  EXPECT_DOUBLE_EQ(*r.cutoff_voltage, 5.4);
  // The account closes up to there, too.
  const double chemical = chemical_energy(d.supply.battery, 1.0, r.rows.back().charge);
  EXPECT_NEAR(r.rows.back().energy_electrical + r.rows.back().energy_internal, chemical, 1e-9 * chemical);
  d.supply.battery.cutoff_voltage = 4.0;
  const EnduranceResult none = simulate_discharge(d);
  EXPECT_EQ(none.end, EnduranceEnd::cutoff);
  EXPECT_EQ(none.endurance(), 0.0);
  EXPECT_THAT(describe(none), testing::HasSubstr("from the start"));
}

// Constant friction: the crank turns while K i exceeds it.
TEST(Endurance, EndsWhereTheCrankStops) {
  Design<double> d = reference_design();
  d.friction = {FrictionLaw::constant, 2e-3};
  d.supply.type = SupplyType::battery;
  Battery<double>& b = d.supply.battery;
  b.discharge_curve = {{0.0, 1.0}, {1.0, 4.0}};
  b.internal_resistance = 1.0;
  b.capacity = 100.0;
  const EnduranceResult r = simulate_discharge(d, {.condition = Condition::wingless});
  ASSERT_EQ(r.end, EnduranceEnd::stops) << describe(r);
  EXPECT_NEAR(r.rows.back().open_circuit_voltage, 2e-3 * 10.0 / 0.01, 2e-2);
  EXPECT_THAT(describe(r), testing::HasSubstr("no longer turns the crank"));
}

TEST(Endurance, SaysWhyItDoesNotStart) {
  Design<double> d = hovering_design();
  d.supply.battery.internal_resistance = 500.0;
  d.motor.constants.friction_torque = 1e-3;
  const EnduranceResult r = simulate_discharge(d);
  EXPECT_EQ(r.end, EnduranceEnd::never_starts);
  EXPECT_EQ(r.status, FlappingStatus::stalled);
  EXPECT_TRUE(r.rows.empty());
  EXPECT_EQ(r.endurance(), 0.0);
  EXPECT_EQ(r.first_charge, 1.0);
  EXPECT_DOUBLE_EQ(r.first_voltage, 7.2);
  EXPECT_EQ(r.evidence.kind, StatusEvidence::Kind::weak_motor);
  EXPECT_EQ(r.evidence.friction_torque, breakaway_torque(resolve(d)));
  EXPECT_THAT(describe(r),
              testing::HasSubstr("the battery cannot start the vehicle at a charge of 1 (7.2 V without load)"));
}

// On a battery of twice the charge and half the resistance each of two motors flies as one does on its own.
TEST(Endurance, SeveralMotorsShareTheBattery) {
  for (const bool warms_up : {false, true}) {
    Design<double> one = hovering_design();
    if (warms_up) {
      MotorThermalDesign<double>& t = one.motor.thermal;
      t.resistance_winding = t.resistance_case = 20.0;
      t.time_constant_winding = 3.0;
      t.time_constant_case = 60.0;
    }
    Design<double> two = one;
    two.motors = 2.0;
    *two.mass *= 2.0;
    two.supply.battery.capacity *= 2.0;
    two.supply.battery.internal_resistance *= 0.5;
    const EnduranceResult a = simulate_discharge(one), b = simulate_discharge(two);
    EXPECT_NEAR(b.endurance() / a.endurance(), 1.0, 1e-7);
    ASSERT_TRUE(a.hover_lost && b.hover_lost);
    EXPECT_NEAR(b.hover_lost->time / a.hover_lost->time, 1.0, 1e-6);
    const EnduranceRow &last = b.rows.back(), &of_one = a.rows.back();
    EXPECT_NEAR(last.energy_internal / of_one.energy_internal, 2.0, 1e-6);
    EXPECT_NEAR(last.energy_electrical / of_one.energy_electrical, 2.0, 1e-6);
    EXPECT_NEAR(last.lift_impulse / of_one.lift_impulse, 2.0, 1e-6);
    const double chemical = chemical_energy(two.supply.battery, 1.0, 0.0);
    EXPECT_NEAR(last.energy_electrical + last.energy_internal, chemical, 1e-8 * chemical);
    if (!warms_up) continue;
    EXPECT_NEAR(last.metrics[Metric::winding_temperature], of_one.metrics[Metric::winding_temperature], 1e-5);
  }
}

TEST(Endurance, EmptyFromTheStart) {
  Design<double> d = hovering_design();
  d.supply.battery.charge = 0.0;
  const EnduranceResult r = simulate_discharge(d);
  EXPECT_EQ(r.end, EnduranceEnd::empty);
  EXPECT_EQ(r.endurance(), 0.0);
  EXPECT_EQ(describe(r), "the battery is empty from the start");
}

TEST(Endurance, RefusesOtherSuppliesAndOptions) {
  EXPECT_THROW(simulate_discharge(reference_design()), ParameterError);
  EXPECT_THROW(simulate_discharge(hovering_design(), {.tolerance = 1e-12}), ParameterError);
  EXPECT_THROW(simulate_discharge(hovering_design(), {.intervals = 0}), ParameterError);
}

TEST(Endurance, ShippedDesignCannotHoverOnOneCell) {
  const Design<double> d = read_design(std::filesystem::path(WINGBEAT_DATA) / "designs" / "friction2022-battery.toml");
  const EnduranceResult r = simulate_discharge(d);
  EXPECT_EQ(r.hover, Hover::never);
  EXPECT_GT(r.endurance(), 300.0);
  EXPECT_LT(r.endurance(), 900.0);
}

}  // namespace
}  // namespace wingbeat

// The domain of validity (model.md section 7): each limit for itself, on either side.
#include <gtest/gtest.h>

#include <cmath>

#include "reference_vehicle.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

/// Metrics of a cycle well inside.
Metrics<double> ordinary_metrics() {
  Metrics<double> m;
  m.values.fill(absent);
  m[Metric::power_electrical] = 1.0;
  m[Metric::power_motor] = 0.3;
  m[Metric::power_aerodynamic] = 0.1;
  m[Metric::power_residual] = 0.02;
  m[Metric::angle_of_attack_min] = 60.0;
  m[Metric::stroke_amplitude] = 0.7;
  m[Metric::flapping_velocity_peak] = 100.0;
  return m;
}

std::string domain_with(Metric metric, double value, const Vehicle<double>& vehicle = reference_vehicle()) {
  Metrics<double> m = ordinary_metrics();
  m[metric] = value;
  return name_of(domain_of(vehicle, m));
}

Vehicle<double> in(Condition condition) { return resolve(reference_design(), condition); }

TEST(Domain, OrdinaryCycleIsInside) {
  EXPECT_TRUE(domain_of(reference_vehicle(), ordinary_metrics()).none());
  EXPECT_EQ(name_of(domain_of(reference_vehicle(), ordinary_metrics())), "inside");
  EXPECT_TRUE(domain_evidence(reference_vehicle(), ordinary_metrics()).empty());
  EXPECT_EQ(describe(std::span<const DomainEvidence>{}), "");
}

TEST(Domain, AngleOfAttack) {
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, 0.0), "inside");
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, -1e-6), "angle_of_attack");
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, -1276.0), "angle_of_attack");
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, std::nan("")), "angle_of_attack");
  // Without air no coefficient is used.
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, -103.0, in(Condition::vacuum)), "inside");
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, -103.0, in(Condition::wingless)), "inside");
}

TEST(Domain, TableNarrowsTheRangeAndDoesNotWidenIt) {
  const double deg = pi / 180.0;
  const auto with_table = [&](double from, double to) {
    Vehicle<double> v = reference_vehicle();
    v.wings.coefficients.table =
        std::make_shared<CoefficientTable>(std::vector<double>{from * deg, 0.5 * (from + to) * deg, to * deg},
                                           std::vector<double>{0.1, 1.0, 0.1}, std::vector<double>{0.4, 2.0, 3.4});
    return v;
  };
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, 20.0, with_table(10.0, 90.0)), "inside");
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, 9.0, with_table(10.0, 90.0)), "angle_of_attack");
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, -5.0, with_table(-30.0, 120.0)), "angle_of_attack");
  // Every cycle passes 90 deg at its reversals.
  EXPECT_EQ(domain_with(Metric::angle_of_attack_min, 60.0, with_table(10.0, 80.0)), "angle_of_attack");
}

TEST(Domain, StrokeOfTheTanLaw) {
  const auto with_offset = [](double offset, double mid_stroke = 20e-3) {
    Vehicle<double> v = reference_vehicle();
    v.transmission.slider_crank.hinge_offset = offset;
    v.transmission.slider_crank.mid_stroke_height = mid_stroke;
    return v;
  };
  const double at_85 = 5e-3 / std::tan(85.0 * pi / 180.0);
  EXPECT_EQ(domain_with(Metric::stroke_amplitude, 0.7, with_offset(1.0001 * at_85)), "inside");
  EXPECT_EQ(domain_with(Metric::stroke_amplitude, 0.7, with_offset(0.9999 * at_85)), "stroke");
  // One end alone: 5 mm of crank about a middle 10 mm below it gives 45 deg on the mean, but 88 deg at the top.
  EXPECT_EQ(domain_with(Metric::stroke_amplitude, 0.7, with_offset(0.5e-3, 10e-3)), "stroke");
  EXPECT_EQ(domain_with(Metric::stroke_amplitude, 0.7, wingless_vehicle()), "inside");
}

TEST(Domain, StrokeOfADirectDrive) {
  Vehicle<double> v = reference_vehicle();
  v.transmission = {};
  v.transmission.type = TransmissionType::direct;
  EXPECT_EQ(domain_with(Metric::stroke_amplitude, 100.0 / degrees_per_radian, v), "inside");
  EXPECT_EQ(domain_with(Metric::stroke_amplitude, 181.0 / degrees_per_radian, v), "stroke");
}

TEST(Domain, FormulationResidual) {
  EXPECT_EQ(domain_with(Metric::power_residual, 0.05), "inside");
  EXPECT_EQ(domain_with(Metric::power_residual, 0.0501), "formulation_residual");
  EXPECT_EQ(domain_with(Metric::power_residual, -0.0501), "formulation_residual");
}

TEST(Domain, Efficiencies) {
  EXPECT_EQ(domain_with(Metric::power_aerodynamic, 0.3), "inside");
  EXPECT_EQ(domain_with(Metric::power_aerodynamic, 0.301), "mechanism_efficiency");
  EXPECT_EQ(domain_with(Metric::power_aerodynamic, -0.01), "mechanism_efficiency");
  EXPECT_EQ(domain_with(Metric::power_motor, 1.01), "motor_efficiency");
  EXPECT_EQ(domain_with(Metric::power_motor, -0.2), "mechanism_efficiency, motor_efficiency");
  // Wings in vacuum without friction: nothing passes the mechanism.
  Metrics<double> m = ordinary_metrics();
  m[Metric::power_aerodynamic] = m[Metric::power_motor] = m[Metric::power_residual] = 0.0;
  EXPECT_TRUE(domain_of(in(Condition::vacuum), m).none());
}

TEST(Domain, InputPower) {
  EXPECT_EQ(domain_with(Metric::power_electrical, 0.0), "input_power");
  EXPECT_EQ(domain_with(Metric::power_electrical, -0.5), "input_power");
  EXPECT_EQ(domain_with(Metric::power_electrical, std::nan("")), "input_power");
  // Efficiencies of 306 % and 3.4e+06: next to no input.
  EXPECT_EQ(domain_with(Metric::power_electrical, 1e-7), "formulation_residual, motor_efficiency");
}

TEST(Domain, FlowSpeed) {
  const double radius = 1.048e-7 / 2.457e-6;
  EXPECT_EQ(domain_with(Metric::flapping_velocity_peak, 102.9 / radius), "inside");
  EXPECT_EQ(domain_with(Metric::flapping_velocity_peak, 103.1 / radius), "flow_speed");
  EXPECT_EQ(domain_with(Metric::flapping_velocity_peak, 103.1 / radius, in(Condition::vacuum)), "inside");
}

TEST(Domain, SentenceNamesTheNumbers) {
  Metrics<double> m = ordinary_metrics();
  m[Metric::angle_of_attack_min] = -103.2;
  m[Metric::power_residual] = -0.123;
  EXPECT_EQ(name_of(domain_of(reference_vehicle(), m)), "angle_of_attack, formulation_residual");
  EXPECT_EQ(describe(domain_evidence(reference_vehicle(), m)),
            "the angle of attack falls to -103.2 deg (the coefficients hold from 0 to 90 deg); the formulation "
            "fails to conserve 12.3 % of the input power (at most 5 %)");
}

TEST(Domain, EvidenceIsEachLimitWithItsValueAndBounds) {
  using Quantity = DomainEvidence::Quantity;
  const double radius = 1.048e-7 / 2.457e-6;
  Metrics<double> m = ordinary_metrics();
  m[Metric::angle_of_attack_min] = -103.2;
  m[Metric::power_residual] = -0.123;
  m[Metric::power_motor] = 1.25;
  m[Metric::power_aerodynamic] = -0.25;
  m[Metric::flapping_velocity_peak] = 120.0 / radius;
  const DomainEvidence expected[] = {
      {DomainLimit::angle_of_attack, Quantity::angle_of_attack_min, -103.2, 0.0, 90.0},
      {DomainLimit::formulation_residual, Quantity::residual_share, 0.123, 0.0, 0.05},
      {DomainLimit::mechanism_efficiency, Quantity::mechanism_efficiency, -0.2, 0.0, 1.0},
      {DomainLimit::motor_efficiency, Quantity::motor_efficiency, 1.25, 0.0, 1.0},
      {DomainLimit::flow_speed, Quantity::flow_speed, 120.0, 0.0, 103.0},
  };
  const std::vector<DomainEvidence> found = domain_evidence(reference_vehicle(), m);
  ASSERT_EQ(found.size(), std::size(expected));
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].limit, expected[k].limit) << k;
    EXPECT_EQ(found[k].quantity, expected[k].quantity) << k;
    EXPECT_DOUBLE_EQ(found[k].value, expected[k].value) << k;
    EXPECT_DOUBLE_EQ(found[k].lowest, expected[k].lowest) << k;
    EXPECT_DOUBLE_EQ(found[k].highest, expected[k].highest) << k;
  }
  EXPECT_EQ(
      describe(found),
      "the angle of attack falls to -103.2 deg (the coefficients hold from 0 to 90 deg); the formulation fails to "
      "conserve 12.3 % of the input power (at most 5 %); the mechanism efficiency is -20 % (0 to 100 %); the motor "
      "efficiency is 125 % (0 to 100 %); the wings reach 120 m/s (incompressible flow to 103 m/s)");
}

TEST(Domain, EvidenceOfOtherDrivesAndWithoutPower) {
  using Quantity = DomainEvidence::Quantity;
  const auto only = [](const Vehicle<double>& v, const Metrics<double>& m) {
    const std::vector<DomainEvidence> rows = domain_evidence(v, m);
    EXPECT_EQ(rows.size(), 1u) << describe(rows);
    return rows.at(0);
  };
  Metrics<double> m = ordinary_metrics();
  m[Metric::power_electrical] = -0.5;
  const DomainEvidence input = only(reference_vehicle(), m);
  EXPECT_EQ(input.quantity, Quantity::input_power);
  EXPECT_EQ(input.value, -0.5);
  EXPECT_EQ(describe(std::span(&input, 1)), "the input power is -0.5 W (positive where the motor drives)");

  Design<double> direct = reference_design();
  direct.transmission = {};
  direct.transmission.type = TransmissionType::direct;
  direct.supply = {SupplyType::sine, 3.0, 22.0, 1.0};
  direct.friction = {FrictionLaw::none, 0.0};
  m = ordinary_metrics();
  m[Metric::stroke_amplitude] = 200.0 / degrees_per_radian;
  const DomainEvidence amplitude = only(resolve(direct), m);
  EXPECT_EQ(amplitude.limit, DomainLimit::stroke);
  EXPECT_EQ(amplitude.quantity, Quantity::stroke_amplitude);
  EXPECT_DOUBLE_EQ(amplitude.value, 200.0);
  EXPECT_EQ(amplitude.highest, 180.0);
  EXPECT_EQ(describe(std::span(&amplitude, 1)), "the stroke amplitude is 200 deg (at most 180 deg)");
}

TEST(Domain, RodForceWarnsAboveOnePerCent) {
  Metrics<double> m = ordinary_metrics();
  const std::optional<double> share = notable_residual(reference_vehicle(), m);
  ASSERT_TRUE(share);
  EXPECT_DOUBLE_EQ(*share, 0.02);
  EXPECT_EQ(residual_warning(*share),
            "the formulation rod-force fails to conserve 2 % of the input power; virtual-work conserves it");
  m[Metric::power_residual] = -0.0099;
  EXPECT_FALSE(notable_residual(reference_vehicle(), m));
}

TEST(Domain, SlopesAgreeWithDifferences) {
  Metrics<double> m = ordinary_metrics(), slopes;
  slopes.values.fill(0.0);
  const Metric moved[] = {Metric::power_electrical, Metric::power_motor,         Metric::power_aerodynamic,
                          Metric::power_residual,   Metric::angle_of_attack_min, Metric::flapping_velocity_peak};
  double rate = 0.3;
  for (const Metric which : moved) slopes[which] = rate *= -1.3;
  const DomainExcess found = domain_excess_slopes(reference_vehicle(), m, slopes);
  constexpr double h = 1e-6;
  Metrics<double> up = m, down = m;
  for (const Metric which : moved) {
    up[which] += h * slopes[which];
    down[which] -= h * slopes[which];
  }
  const DomainExcess above = domain_excess(reference_vehicle(), up), below = domain_excess(reference_vehicle(), down);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double difference = (above[k] - below[k]) / (2.0 * h);
    EXPECT_NEAR(found[k], difference, 1e-6 * std::max(1.0, std::abs(difference))) << domain_limit_table()[k].key;
  }
}

TEST(Domain, OrbitAndTransientAgree) {
  Design<double> design = reference_design();
  for (const double voltage : {3.0, 20.0}) {
    design.supply.voltage = voltage;
    const Vehicle<double> vehicle = resolve(design);
    const RunResult orbit = run_design(design);
    RunOptions in_time;
    in_time.method = Method::transient;
    const RunResult transient = run_design(design, in_time);
    EXPECT_EQ(name_of(domain_of(vehicle, orbit.metrics)), voltage == 3.0 ? "inside" : "angle_of_attack");
    EXPECT_EQ(domain_of(vehicle, orbit.metrics), domain_of(vehicle, transient.metrics));
  }
}

/// Without friction and with a formulation that conserves, the mechanism efficiency is 1: no error of the solution, not
/// even at the loosest tolerance, may put it outside.
TEST(Domain, PerfectMechanismIsInsideAtAnyTolerance) {
  Design<double> design = reference_design();
  design.friction = {};
  design.transmission.formulation = Formulation::virtual_work;
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-6, 1e-9}) {
    RunOptions options;
    options.tolerance = tolerance;
    const RunResult r = run_design(design, options);
    EXPECT_NEAR(r.metrics[Metric::efficiency_mechanism], 1.0, efficiency_slack) << tolerance;
    EXPECT_EQ(name_of(domain_of(resolve(design), r.metrics)), "inside") << tolerance;
  }
}

}  // namespace
}  // namespace wingbeat

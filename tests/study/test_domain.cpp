// The domain of validity (model.md section 7): each limit for itself, on either side.
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/reference_vehicle.hpp"
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

/// A direct drive with wings of that shape, so many of them on so many motors.
Design<double> direct_design_with(const Planform<double>& planform, double motors, double wings) {
  Design<double> d = reference_design();
  d.transmission = {};
  d.transmission.type = TransmissionType::direct;
  d.supply = {SupplyType::sine, 3.0, 22.0, 1.0};
  d.friction = {FrictionLaw::none, 0.0};
  d.motors = motors;
  d.wing.count = wings;
  d.wing.planform = planform;
  return d;
}

Planform<double> paper_ellipse(double hub_offset = 0.0) {
  Planform<double> p{PlanformShape::semi_ellipse, 63e-3, 25e-3};
  p.hub_offset = hub_offset;
  return p;
}

TEST(Domain, StrokeOfADirectDrive) {
  const auto domain_at = [](double amplitude_deg, const Design<double>& d) {
    Metrics<double> m = ordinary_metrics();
    m[Metric::stroke_amplitude] = amplitude_deg / degrees_per_radian;
    m[Metric::reynolds_number] = 5000.0;
    return name_of(domain_of(resolve(d), m));
  };
  // A wing alone may turn until it is back at its own start.
  const Planform<double> moments = reference_design().wing.planform;
  EXPECT_EQ(domain_at(179.0, direct_design_with(moments, 1.0, 1.0)), "inside");
  EXPECT_EQ(domain_at(181.0, direct_design_with(moments, 1.0, 1.0)), "stroke");
  // Two on one body meet at 90 deg, whether one motor drives both or each its own.
  for (const auto& [motors, wings] : {std::pair{1.0, 2.0}, {2.0, 1.0}, {2.0, 2.0}}) {
    EXPECT_EQ(domain_at(89.9, direct_design_with(moments, motors, wings)), "inside");
    EXPECT_EQ(domain_at(90.1, direct_design_with(moments, motors, wings)), "stroke");
    EXPECT_EQ(domain_at(171.7, direct_design_with(moments, motors, wings)), "stroke");
  }
  // Shoulders apart leave room: the tips, 70 mm from the hinges, meet 10 deg beyond.
  Planform<double> apart = paper_ellipse(7e-3);
  apart.shoulder_distance = 2.0 * 70e-3 * std::sin(10.0 / degrees_per_radian);
  EXPECT_EQ(domain_at(99.9, direct_design_with(apart, 1.0, 2.0)), "inside");
  EXPECT_EQ(domain_at(100.1, direct_design_with(apart, 1.0, 2.0)), "stroke");
  apart.shoulder_distance = 0.15;
  EXPECT_EQ(domain_at(179.0, direct_design_with(apart, 1.0, 2.0)), "inside");
  EXPECT_EQ(domain_at(181.0, direct_design_with(apart, 1.0, 2.0)), "stroke");
  // Wings meet without air as well, and not where there are none.
  Metrics<double> m = ordinary_metrics();
  m[Metric::stroke_amplitude] = 171.7 / degrees_per_radian;
  EXPECT_EQ(name_of(domain_of(resolve(direct_design_with(moments, 1.0, 2.0), Condition::vacuum), m)), "stroke");
  EXPECT_EQ(name_of(domain_of(resolve(direct_design_with(moments, 1.0, 2.0), Condition::wingless), m)), "inside");
  const std::vector<DomainEvidence> rows = domain_evidence(resolve(direct_design_with(moments, 1.0, 2.0)), m);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].quantity, DomainEvidence::Quantity::wings_meet);
  EXPECT_NEAR(rows[0].highest, 90.0, 1e-12);
  EXPECT_EQ(describe(rows), "the stroke angle reaches 171.7 deg (two wings on one body meet at 90 deg)");
}

TEST(Domain, StrokeOfATableTurnsWingsIntoEachOther) {
  Design<double> d = reference_design();
  d.transmission = {};
  d.transmission.type = TransmissionType::tabulated;
  const std::vector<std::pair<double, double>> rows = {{0.0, 0.0}, {1.5, 1.0}, {3.0, 0.1}, {4.5, -1.0}};
  d.transmission.table = {std::make_shared<const StrokeCurve>(rows), 1.0, 6e-3};
  d.friction = {FrictionLaw::none, 0.0};
  const auto domain_scaled = [&](double to_deg, double wings) {
    Design<double> changed = d;
    changed.wing.count = wings;
    changed.transmission.table.scale = to_deg / (degrees_per_radian * stroke_reach(transmission_of(d.transmission)));
    return name_of(domain_of(resolve(changed), ordinary_metrics()));
  };
  EXPECT_EQ(domain_scaled(89.0, 2.0), "inside");
  EXPECT_EQ(domain_scaled(91.0, 2.0), "stroke");
  EXPECT_EQ(domain_scaled(171.7, 2.0), "stroke");
  EXPECT_EQ(domain_scaled(171.7, 1.0), "inside");
}

TEST(Domain, ReynoldsNumber) {
  const auto domain_at = [](double Re, const Design<double>& d, Condition condition = Condition::air) {
    Metrics<double> m = ordinary_metrics();
    m[Metric::reynolds_number] = Re;
    return name_of(domain_of(resolve(d, condition), m));
  };
  Design<double> d = direct_design_with(paper_ellipse(), 1.0, 2.0);
  EXPECT_EQ(domain_at(101.0, d), "inside");
  EXPECT_EQ(domain_at(99.0, d), "reynolds_number");
  EXPECT_EQ(domain_at(25900.0, d), "inside");
  EXPECT_EQ(domain_at(26100.0, d), "reynolds_number");
  EXPECT_EQ(domain_at(std::nan(""), d), "reynolds_number");
  EXPECT_EQ(domain_at(1.0, d, Condition::vacuum), "inside");
  EXPECT_EQ(domain_at(1.0, d, Condition::wingless), "inside");
  d.aerodynamics.coefficients_name = "normal-force-robofly";
  EXPECT_EQ(domain_at(99.0, d), "reynolds_number");
  // A vehicle's own coefficients hold where it says so.
  for (const char* own : {"custom", "table"}) {
    Design<double> other = d;
    other.aerodynamics.coefficients_name = own;
    EXPECT_EQ(domain_at(0.1, other), "inside");
    EXPECT_EQ(domain_at(1e6, other), "inside");
    other.aerodynamics.reynolds_number_min = 20.0;
    other.aerodynamics.reynolds_number_max = 300.0;
    EXPECT_EQ(domain_at(19.0, other), "reynolds_number");
    EXPECT_EQ(domain_at(200.0, other), "inside");
    EXPECT_EQ(domain_at(301.0, other), "reynolds_number");
  }
  // Of moments without a shape there is no chord to take it of.
  d.wing.planform = reference_design().wing.planform;
  EXPECT_EQ(domain_at(1.0, d), "inside");
  EXPECT_EQ(domain_at(std::nan(""), d), "inside");

  Metrics<double> m = ordinary_metrics();
  m[Metric::reynolds_number] = 0.42;
  const std::vector<DomainEvidence> rows = domain_evidence(resolve(direct_design_with(paper_ellipse(), 1.0, 2.0)), m);
  EXPECT_EQ(describe(rows), "the Reynolds number is 0.42 (the coefficients hold from 100 to 26000)");
}

/// Of the model wing of Dickinson, Lehmann and Sane (1999): 0.25 m long, of 0.0167 m2, 160 deg at 0.168 Hz in oil of
/// 115 cSt give their 136.
TEST(Domain, ReynoldsNumberIsThatOfThePublishedModelWing) {
  Planform<double> p{PlanformShape::rectangle, 0.25, 0.0167 / 0.25};
  const double mean_speed = 2.0 * (160.0 / degrees_per_radian) * 0.168;
  EXPECT_NEAR(reynolds_number_per_speed(p, 1.15e-4) * mean_speed, 136.0, 1.0);
  const Planform<double> ellipse = paper_ellipse(7e-3);
  EXPECT_NEAR(reynolds_number_per_speed(ellipse, 1.5e-5), 0.25 * pi * 25e-3 * 70e-3 / 1.5e-5, 1e-9);
}

TEST(Domain, ReynoldsNumberOfACycle) {
  Design<double> d = reference_design();
  d.wing.planform = paper_ellipse();
  const RunResult r = run_design(d);
  const double amplitude = r.metrics[Metric::stroke_amplitude], f = r.metrics[Metric::frequency];
  EXPECT_NEAR(r.metrics[Metric::reynolds_number], 0.25 * pi * 25e-3 * 63e-3 / 1.5e-5 * 4.0 * amplitude * f, 1e-6);
  EXPECT_EQ(name_of(r.domain), "inside");
  EXPECT_TRUE(std::isnan(run_design(reference_design()).metrics[Metric::reynolds_number]));
  // A wing of 0.2 mm flaps in the equations; the coefficients know nothing of it.
  d.wing.planform.length = 0.2e-3;
  d.wing.planform.root_chord = 0.08e-3;
  const RunResult tiny = run_design(d);
  EXPECT_EQ(tiny.status, FlappingStatus::flapping);
  EXPECT_TRUE(tiny.domain[std::size_t(DomainLimit::reynolds_number)]) << tiny.metrics[Metric::reynolds_number];
}

TEST(Domain, WindingTemperature) {
  Design<double> d = reference_design();
  d.motor.thermal.resistance_winding = 20.0;
  d.motor.thermal.resistance_case = 48.0;
  const auto domain_at = [&](double degc) { return domain_with(Metric::winding_temperature, degc, resolve(d)); };
  EXPECT_EQ(domain_at(124.9), "inside");
  EXPECT_EQ(domain_at(125.1), "winding_temperature");
  EXPECT_EQ(domain_at(446.0), "winding_temperature");
  d.motor.thermal.winding_temperature_max = 155.0 + zero_celsius;
  EXPECT_EQ(domain_at(154.0), "inside");
  EXPECT_EQ(domain_at(156.0), "winding_temperature");
  EXPECT_EQ(domain_with(Metric::winding_temperature, 446.0), "inside");  // of a motor that keeps its constants
  Metrics<double> m = ordinary_metrics();
  m[Metric::winding_temperature] = 446.0;
  EXPECT_DOUBLE_EQ(hot_winding(resolve(d), m).value_or(0.0), 446.0);
  EXPECT_FALSE(hot_winding(reference_vehicle(), m));
  EXPECT_EQ(winding_warning(446.0, 125.0),
            "the winding heats up to 446 degC, above motor.winding_temperature_max = 125 degC");
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
  direct.wing.count = 1.0;
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

TEST(Domain, LiftOfTheAddedMassWarnsAboveFivePerCent) {
  Metrics<double> m = ordinary_metrics();
  m[Metric::lift_added_mass_share] = absent;
  EXPECT_FALSE(notable_added_mass_lift(m));
  m[Metric::lift_added_mass_share] = 0.0499;
  EXPECT_FALSE(notable_added_mass_lift(m));
  m[Metric::lift_added_mass_share] = -0.0512;
  EXPECT_EQ(notable_added_mass_lift(m), -0.0512);
  EXPECT_EQ(added_mass_warning(0.2132, 0.0),
            "21.3 % of the mean lift comes from added mass, since none of its force along the chord counts; with "
            "pitch.leading_edge_suction = 1 it has no mean lift");
  EXPECT_EQ(added_mass_warning(0.12, 0.4),
            "12 % of the mean lift comes from added mass, since 40 % of its force along the chord counts; with "
            "pitch.leading_edge_suction = 1 it has no mean lift");
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

// Searches, optima, fronts and samples keep to the domain of validity, unless extrapolation is asked for.
#include <gmock/gmock.h>

#include <cmath>

#include "study/optimised_parameters.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/study/optimise.hpp"
#include "wingbeat/study/pareto.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/tolerance.hpp"

extern "C" const wingbeat::Evolve wingbeat_evolution_module;

namespace wingbeat {
namespace {

Design<double> with_springs() { return read_design(std::string(WINGBEAT_DATA) + "/designs/friction2022-springs.toml"); }

/// The reference vehicle from 1 to 100 V, where the angle of attack falls far below zero.
std::vector<EnsembleMember> up_to_100_volts() {
  std::vector<EnsembleMember> members;
  for (Design<double> d : {with_springs(), read_design(std::string(WINGBEAT_DATA) + "/designs/friction2022.toml")}) {
    for (int n = 1; n <= 100; n += 3) {
      d.supply.voltage = n;
      members.push_back({resolve(d), reporting_of(d)});
    }
  }
  return members;
}

TEST(DomainOfEnsembles, BatchedAndScalarAgreeWhicheverMetricsAreWanted) {
  const std::vector<EnsembleMember> members = up_to_100_volts();
  EnsembleOptions scalar;
  scalar.scalar_only = true;
  EnsembleOptions few;
  few.metrics = MetricSet().set(std::size_t(Metric::power_electrical)).set(std::size_t(Metric::lift_mean));
  std::vector<EnsembleOutcome> exact(members.size()), batched(members.size()), narrow(members.size());
  solve_ensemble(members, scalar, start_up_in_time(), exact);
  solve_ensemble(members, {}, start_up_in_time(), batched);
  solve_ensemble(members, few, start_up_in_time(), narrow);
  int outside = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    EXPECT_EQ(narrow[n].status, exact[n].status) << n;
    if (exact[n].status != FlappingStatus::flapping) {
      EXPECT_TRUE(exact[n].domain.none());
      continue;
    }
    EXPECT_EQ(batched[n].domain, exact[n].domain) << n;
    EXPECT_EQ(narrow[n].domain, exact[n].domain) << n;
    EXPECT_TRUE(std::isnan(narrow[n].metrics[Metric::angle_of_attack_min]));
    outside += exact[n].domain.any();
  }
  EXPECT_GT(outside, 20);
  EXPECT_LT(outside, int(members.size()) - 5);
}

/// Small and large wings in thick and thin air, and direct drives about the stroke at which their wings meet: the
/// limits of the wings themselves.
TEST(DomainOfEnsembles, LimitsOfTheWingsAreTheSameInBatches) {
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 24; ++n) {
    Design<double> d = with_springs();
    d.wing.planform = {PlanformShape::semi_ellipse, 63e-3, 25e-3};
    d.aerodynamics.kinematic_viscosity = 1e-6 * std::pow(1e3, n / 23.0);
    members.push_back({resolve(d), reporting_of(d)});
  }
  for (int n = 0; n < 24; ++n) {
    Design<double> d = read_design(std::string(WINGBEAT_DATA) + "/designs/direct-drive.toml");
    d.wing.count = n % 3 == 0 ? 1.0 : 2.0;
    d.supply.voltage = 1.0 + 0.5 * n;
    members.push_back({resolve(d), reporting_of(d)});
  }
  EnsembleOptions scalar, few;
  scalar.scalar_only = true;
  few.metrics = MetricSet().set(std::size_t(Metric::lift_mean));
  std::vector<EnsembleOutcome> exact(members.size()), batched(members.size()), narrow(members.size());
  solve_ensemble(members, scalar, start_up_in_time(), exact);
  solve_ensemble(members, {}, start_up_in_time(), batched);
  solve_ensemble(members, few, start_up_in_time(), narrow);
  int by_reynolds = 0, by_stroke = 0, inside = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    ASSERT_EQ(exact[n].status, FlappingStatus::flapping) << n;
    EXPECT_EQ(batched[n].domain, exact[n].domain) << n;
    EXPECT_EQ(narrow[n].domain, exact[n].domain) << n;
    const double Re = exact[n].metrics[Metric::reynolds_number];
    EXPECT_EQ(std::isnan(Re), n >= 24);
    if (n < 24) {
      EXPECT_NEAR(batched[n].metrics[Metric::reynolds_number] / Re, 1.0, 1e-6) << n;
    }
    by_reynolds += exact[n].domain[std::size_t(DomainLimit::reynolds_number)];
    by_stroke += exact[n].domain[std::size_t(DomainLimit::stroke)];
    inside += exact[n].domain.none();
  }
  EXPECT_GT(by_reynolds, 3);
  EXPECT_GT(by_stroke, 3);
  EXPECT_GT(inside, 5);
}

/// The limits of the wings as constraints of an optimum: the largest stroke of two wings that one motor swings, and the
/// lowest Reynolds number of ever smaller ones.
TEST(DomainOfOptima, WingsMeetAndCoefficientsEnd) {
  OptimiseStudy study;
  study.design = read_design(std::string(WINGBEAT_DATA) + "/designs/direct-drive.toml");
  study.parameters = {between("supply.amplitude", 1.0, 12.0)};
  study.objective = Metric::stroke_amplitude;
  study.maximise = true;
  study.starts = 2;
  study.screen = 32;
  const OptimiseResult stroke = optimise(study, start_up_in_time());
  ASSERT_EQ(stroke.outcome, OptimiseResult::Outcome::found);
  EXPECT_LE(degrees_per_radian * stroke.point.metrics[Metric::stroke_amplitude], 90.0);
  EXPECT_NEAR(degrees_per_radian * stroke.point.metrics[Metric::stroke_amplitude], 90.0, 0.01);
  ASSERT_FALSE(stroke.active.empty());
  EXPECT_EQ(stroke.active[0].name, "domain: stroke <= 90 deg");

  study.design = with_springs();
  study.design.transmission.formulation = Formulation::virtual_work;
  study.design.wing.planform = {PlanformShape::semi_ellipse, 20e-3, 8e-3};
  study.parameters = {between("wing.planform.length", 2e-3, 30e-3)};
  study.objective = Metric::reynolds_number;
  study.maximise = false;
  const OptimiseResult small = optimise(study, start_up_in_time());
  ASSERT_EQ(small.outcome, OptimiseResult::Outcome::found);
  EXPECT_GE(small.point.metrics[Metric::reynolds_number], 100.0);
  EXPECT_NEAR(small.point.metrics[Metric::reynolds_number], 100.0, 0.1);
  ASSERT_FALSE(small.active.empty());
  EXPECT_EQ(small.active[0].name, "domain: reynolds_number from 100 to 26000");
}

TEST(DomainOfOptima, MostLiftSitsOnTheEdgeAndSaysSo) {
  OptimiseStudy study;
  study.design = with_springs();
  study.parameters = {between("supply.voltage", 1.0, 100.0)};
  study.objective = Metric::lift_mean;
  study.maximise = true;
  study.starts = 3;
  study.screen = 64;
  study.allow_extrapolation = true;
  const OptimiseResult free = optimise(study, start_up_in_time());
  study.allow_extrapolation = false;
  const OptimiseResult kept = optimise(study, start_up_in_time());
  ASSERT_EQ(free.outcome, OptimiseResult::Outcome::found);
  ASSERT_EQ(kept.outcome, OptimiseResult::Outcome::found);
  EXPECT_TRUE(kept.point.domain.none());
  EXPECT_GT(kept.screen.outside, 30u);
  EXPECT_GE(free.point.metrics[Metric::lift_mean], kept.point.metrics[Metric::lift_mean] * (1.0 - 1e-6));
  EXPECT_EQ(free.screen.outside, 0u);
}

TEST(DomainOfOptima, LeastAngleOfAttackEndsAtZero) {
  OptimiseStudy study;
  study.design = with_springs();
  study.parameters = {between("supply.voltage", 1.0, 100.0)};
  study.objective = Metric::angle_of_attack_min;
  study.starts = 2;
  study.screen = 64;
  const OptimiseResult r = optimise(study, start_up_in_time());
  ASSERT_EQ(r.outcome, OptimiseResult::Outcome::found);
  EXPECT_NEAR(r.point.metrics[Metric::angle_of_attack_min], 0.0, 2e-3);
  EXPECT_GE(r.point.metrics[Metric::angle_of_attack_min], 0.0);
  ASSERT_EQ(r.active.size(), 1u);
  EXPECT_EQ(r.active[0].name, "domain: angle_of_attack >= 0 deg");
  EXPECT_TRUE(r.active[0].domain);
}

/// The smooth limits as constraints: their gradients against differences.
TEST(DomainOfOptima, SlopesOfTheLimitsAreThoseOfDifferences) {
  const Design<double> design = with_springs();
  const std::vector<DesignParameter> parameters = {design_parameter("supply.voltage"),
                                                   design_parameter("transmission.crank_radius")};
  const DesignPointOptions options{Condition::air, std::nullopt, 1e-10, true};
  const DesignPoint point = design_point(design, options, parameters, start_up_in_time());
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double x = *parameters[k].value(design), h = 1e-4 * x;
    Design<double> up = design, down = design;
    parameters[k].set(up, x + h);
    parameters[k].set(down, x - h);
    const DesignPoint above = design_point(up, options, {}, start_up_in_time());
    const DesignPoint below = design_point(down, options, {}, start_up_in_time());
    for (const DomainLimit limit :
         {DomainLimit::angle_of_attack, DomainLimit::formulation_residual, DomainLimit::mechanism_efficiency,
          DomainLimit::motor_efficiency, DomainLimit::flow_speed}) {
      const std::size_t l = std::size_t(limit);
      const double difference = (above.domain_excess[l] - below.domain_excess[l]) / (2.0 * h);
      EXPECT_NEAR(point.domain_slopes[k][l], difference, 1e-4 * std::abs(difference)) << k << " " << l;
    }
  }
}

TEST(DomainOfOptima, NothingInsideIsSaidSo) {
  OptimiseStudy study;
  study.design = with_springs();
  study.parameters = {between("supply.voltage", 60.0, 100.0)};
  study.starts = 2;
  study.screen = 32;
  const OptimiseResult r = optimise(study, start_up_in_time());
  EXPECT_EQ(r.outcome, OptimiseResult::Outcome::infeasible);
  EXPECT_THAT(describe(nothing_found(study, r)),
              testing::StartsWith("designs flap, but none inside the model's domain and within every constraint was "
                                  "found; 32 of 32 that flap are outside the model's domain"));
  EXPECT_EQ(r.screen.outside, 32u);
  EXPECT_EQ(r.screen.beyond[std::size_t(DomainLimit::angle_of_attack)], 32u);
  study.parameters.clear();
  study.design.supply.voltage = 60.0;
  EXPECT_THAT(describe(nothing_found(study, optimise(study, start_up_in_time()))),
              testing::StartsWith("the design flaps, but not inside the model's domain"));
}

TEST(DomainOfFronts, NoDesignOfAFrontIsOutside) {
  ParetoStudy study;
  study.vehicles = {{"", with_springs()}};
  study.objectives = {{Metric::lift_mean, true, {}}, {Metric::power_electrical, false, {}}};
  study.parameters = {between("supply.voltage", 1.0, 100.0), between("spring.stiffness", 0.0, 5e-3)};
  study.evolution.population = 16;
  study.evolution.generations = 6;
  study.screen = 64;
  const ParetoResult kept = pareto_front(study, wingbeat_evolution_module, start_up_in_time());
  ASSERT_EQ(kept.outcome, ParetoResult::Outcome::found);
  for (const ParetoDesign& d : kept.front) {
    EXPECT_TRUE(d.domain.none());
    EXPECT_GE(d.metrics[Metric::angle_of_attack_min], 0.0);
  }
  study.allow_extrapolation = true;
  const ParetoResult free = pareto_front(study, wingbeat_evolution_module, start_up_in_time());
  ASSERT_EQ(free.outcome, ParetoResult::Outcome::found);
  EXPECT_LT(kept.front.front().metrics[Metric::power_electrical], 100.0);
  EXPECT_GT(kept.screen.outside, 0u);
}

TEST(DomainOfTolerance, SamplesOutsideNeitherHoverNorCount) {
  ToleranceStudy study;
  study.design = with_springs();
  study.parameters = {{design_parameter("supply.voltage"), {DistributionKind::uniform, 0.0, 1.0, 3.0, 20.0}, false}};
  study.count = 128;
  study.indices = false;
  const SweepColumns columns = solve_sweep(tolerance_sweep(study));
  const ToleranceResult kept = assess_tolerance(study, columns, start_up_in_time());
  study.allow_extrapolation = true;
  const ToleranceResult free = assess_tolerance(study, columns, start_up_in_time());
  EXPECT_GT(kept.outside.share, 0.2);
  EXPECT_EQ(kept.outside.count, free.outside.count);
  EXPECT_EQ(kept.beyond[std::size_t(DomainLimit::angle_of_attack)], kept.outside.count);
  ASSERT_TRUE(kept.hover && free.hover);
  std::uint64_t hovering = 0, all = 0;
  for (std::size_t n = 0; n < columns.status.size(); ++n) {
    const bool lifts = columns.metrics[std::size_t(Metric::lift_to_weight)][n] >= 1.0;
    all += lifts;
    hovering += lifts && columns.domain[n] == 0;
  }
  EXPECT_EQ(kept.hover->count, hovering);
  EXPECT_EQ(free.hover->count, all);
  EXPECT_LT(hovering, all);
  EXPECT_GE(kept.find("angle_of_attack_min_deg")->min, 0.0);
  EXPECT_LT(free.find("angle_of_attack_min_deg")->min, 0.0);
}

TEST(DomainOfEndurance, NoHoverIsClaimedOutside) {
  Design<double> d = with_springs();
  d.mass = 1e-3;
  d.supply.type = SupplyType::battery;
  Battery<double>& b = d.supply.battery;
  b.cells = 4.0;
  b.discharge_curve = {{0.0, 2.4}, {0.5, 3.0}, {1.0, 3.6}};
  b.internal_resistance = 0.4;
  b.capacity = 108.0;
  EnduranceOptions options;
  options.intervals = 8;
  options.tolerance = 1e-5;
  const EnduranceResult kept = simulate_discharge(d, options);
  ASSERT_FALSE(kept.rows.empty());
  EXPECT_TRUE(kept.rows.front().domain.any());
  EXPECT_GE(kept.rows.front().metrics[Metric::lift_to_weight], 1.0);
  EXPECT_EQ(kept.hover, Hover::outside);
  EXPECT_TRUE(kept.rows.back().domain.none());
  options.allow_extrapolation = true;
  EXPECT_EQ(simulate_discharge(d, options).hover, Hover::kept);
}

}  // namespace
}  // namespace wingbeat

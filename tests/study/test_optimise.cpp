#include "study/optimised_parameters.hpp"
#include "wingbeat/study/optimise.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

OptimiseStudy study_of(std::vector<OptimisedParameter> parameters) {
  OptimiseStudy study;
  study.design = read_design(std::string(WINGBEAT_DATA) + "/designs/friction2022-springs.toml");
  study.parameters = std::move(parameters);
  study.starts = 4;
  study.screen = 256;
  return study;
}

/// Least power of all designs of a grid that flap within the constraints.
double best_of_grid(const OptimiseStudy& study, std::size_t each) {
  Sweep sweep;
  for (const OptimisedParameter& p : study.parameters) {
    SweepAxis axis;
    axis.count = each;
    SweptQuantity q;
    q.key = p.parameter.key;
    q.set = p.parameter.set;
    for (std::size_t n = 0; n < each; ++n) {
      q.values.push_back(p.lower + (p.upper - p.lower) * double(n) / double(each - 1));
    }
    axis.quantities.push_back(q);
    sweep.axes.push_back(axis);
  }
  sweep.variants.push_back({study.design, Condition::air, true});
  sweep.variant_stride.assign(sweep.axes.size(), 0);
  const SweepColumns columns = solve_sweep(sweep);
  double best = HUGE_VAL;
  for (std::size_t n = 0; n < columns.status.size(); ++n) {
    bool good = columns.status[n] == 0;
    for (const MetricConstraint& c : study.constraints) {
      const double x = columns.metrics[std::size_t(c.metric)][n];
      good = good && (c.at_least ? x >= c.limit : x <= c.limit);
    }
    if (good) best = std::min(best, columns.metrics[std::size_t(study.objective)][n]);
  }
  return best;
}

TEST(Optimise, FindsTheOptimumOfADenseSweep) {
  OptimiseStudy study = study_of({between("supply.voltage", 3.0, 8.0), between("spring.stiffness", 0.0, 4e-3)});
  study.constraints = {{Metric::lift_to_weight, true, 1.0}};
  const OptimiseResult r = optimise(study, start_up_in_time());
  ASSERT_EQ(r.outcome, OptimiseResult::Outcome::found);
  const double power = r.point.metrics[Metric::power_electrical];
  EXPECT_NEAR(r.point.metrics[Metric::lift_to_weight], 1.0, 1e-5);
  const double grid = best_of_grid(study, 71);
  EXPECT_LE(power, grid * (1.0 + 1e-6));
  EXPECT_GE(power, grid * 0.98);  // the grid's best lies up to a step of 0.07 V beyond the limit
  EXPECT_EQ(r.same, r.starts);
  ASSERT_FALSE(r.active.empty());
  EXPECT_EQ(r.active[0].name, "lift_to_weight >= 1");

  // What a tighter limit costs is what the report says.
  const double sensitivity = r.active[0].sensitivity;
  study.constraints[0].limit = 1.002;
  const double tighter = optimise(study, start_up_in_time()).point.metrics[Metric::power_electrical];
  EXPECT_NEAR((tighter / power - 1.0) / 0.002, sensitivity, 0.02 * sensitivity);
}

TEST(Optimise, MaximumInsideTheBounds) {
  OptimiseStudy study = study_of({between("transmission.crank_radius", 3e-3, 12e-3)});
  study.objective = Metric::efficiency_system;
  study.maximise = true;
  const OptimiseResult r = optimise(study, start_up_in_time());
  ASSERT_EQ(r.outcome, OptimiseResult::Outcome::found);
  study.objective = Metric::power_electrical;
  const auto efficiency = [&](double radius) {
    Design<double> d = study.design;
    d.transmission.crank_radius = radius;
    return design_point(d, study.options, {}, start_up_in_time()).metrics[Metric::efficiency_system];
  };
  const double best = r.parameters[0], value = r.point.metrics[Metric::efficiency_system];
  for (const double radius : {0.98 * best, 1.02 * best, 4e-3, 6e-3, 9e-3}) {
    EXPECT_LT(efficiency(radius), value) << radius;
  }
  // The ends of the flat range are 0.1 % worse.
  ASSERT_EQ(r.directions.size(), 1U);
  EXPECT_FALSE(r.directions[0].flat);
  EXPECT_NEAR(efficiency(r.directions[0].from[0]), value * (1.0 - flat_loss), 2e-5 * value);
  EXPECT_NEAR(efficiency(r.directions[0].to[0]), value * (1.0 - flat_loss), 2e-5 * value);
  EXPECT_TRUE(r.active.empty());
}

TEST(Optimise, AFlatDirectionIsReportedFlat) {
  // The mass changes nothing but the weight, which nothing asks for.
  OptimiseStudy study =
      study_of({between("vehicle.mass", 2e-3, 5e-3), between("transmission.crank_radius", 3e-3, 12e-3)});
  study.objective = Metric::efficiency_system;
  study.maximise = true;
  const OptimiseResult r = optimise(study, start_up_in_time());
  ASSERT_EQ(r.outcome, OptimiseResult::Outcome::found);
  ASSERT_EQ(r.directions.size(), 2U);
  EXPECT_TRUE(r.directions[0].flat);
  EXPECT_NEAR(r.directions[0].curvature, 0.0, 1e-6);
  EXPECT_NEAR(std::min(r.directions[0].from[0], r.directions[0].to[0]), 2e-3, 1e-9);
  EXPECT_NEAR(std::max(r.directions[0].from[0], r.directions[0].to[0]), 5e-3, 1e-9);
  EXPECT_FALSE(r.directions[1].flat);
  EXPECT_GT(r.directions[1].curvature, 0.01);
}

TEST(Optimise, AFlatDirectionUnderAConstraint) {
  // The power depends on neither: a vehicle that lifts its weight is as good as any other that does.
  OptimiseStudy study = study_of({between("vehicle.mass", 2e-3, 5e-3), between("wing.planform.s2", 2e-6, 6e-6)});
  study.design.supply.voltage = 5.0;
  study.constraints = {{Metric::lift_to_weight, true, 1.0}};
  const OptimiseResult r = optimise(study, start_up_in_time());
  ASSERT_EQ(r.outcome, OptimiseResult::Outcome::found);
  ASSERT_FALSE(r.directions.empty());
  EXPECT_TRUE(r.directions[0].flat);
}

TEST(Optimise, SaysThatNothingFlaps) {
  const OptimiseStudy study = study_of({between("supply.voltage", 0.1, 0.6)});
  const OptimiseResult r = optimise(study, start_up_in_time());
  EXPECT_EQ(r.outcome, OptimiseResult::Outcome::nothing_flaps);
  EXPECT_EQ(describe(nothing_found(study, r)), "none of 256 designs within the bounds flaps: 256 locked");
  EXPECT_EQ(r.screen.status[std::size_t(SweepStatus::locked)], 256U);
}

TEST(Optimise, SaysThatNothingIsFeasible) {
  OptimiseStudy study = study_of({between("supply.voltage", 2.0, 4.0)});
  study.constraints = {{Metric::lift_to_weight, true, 1.0}};
  const OptimiseResult r = optimise(study, start_up_in_time());
  EXPECT_EQ(r.outcome, OptimiseResult::Outcome::infeasible);
  EXPECT_EQ(r.screen.feasible, 0U);
  EXPECT_EQ(r.screen.violated[0], r.screen.status[0]);
  EXPECT_NEAR(r.screen.closest[0], 0.62, 0.01);  // at 4 V; see wingbeat run
}

TEST(Optimise, DependsNeitherOnThreadsNorOnTheirOrder) {
  OptimiseStudy study =
      study_of({between("supply.voltage", 2.0, 8.0), between("transmission.rod_length", 0.015, 0.04)});
  study.constraints = {{Metric::lift_to_weight, true, 1.0}};
  const OptimiseResult a = optimise(study, start_up_in_time());
  const OptimiseResult b = optimise(study, start_up_in_time(), [](std::size_t count, const auto& act) {
    while (count > 0) act(--count);
  });
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(a.evaluations, b.evaluations);
}

TEST(Optimise, AHeldFrequencyGivesTheVoltage) {
  OptimiseStudy study = study_of({between("spring.stiffness", 0.0, 4e-3)});
  study.options.hold = Hold{Held::frequency, 22.0};
  const OptimiseResult r = optimise(study, start_up_in_time());
  ASSERT_EQ(r.outcome, OptimiseResult::Outcome::found);
  const RunResult run = run_design(r.design);
  EXPECT_NEAR(run.metrics[Metric::frequency], 22.0, 1e-4);
  EXPECT_NEAR(run.metrics[Metric::power_electrical], r.point.metrics[Metric::power_electrical], 1e-5);
  Design<double> plain = study.design;
  plain.spring = {};
  EXPECT_LT(run.metrics[Metric::power_electrical],
            run_design(plain, {.frequency = 22.0}).metrics[Metric::power_electrical]);
}

// At a held lift the voltage is no parameter: the same optimum as with it, and the lift as a constraint.
TEST(Optimise, AHeldLiftIsOneParameterAndOneConstraintLess) {
  OptimiseStudy held =
      study_of({between("spring.stiffness", 0.0, 4e-3), between("transmission.crank_radius", 3e-3, 8e-3)});
  held.design.mass = 0.0022;
  OptimiseStudy constrained = held;
  constrained.parameters.push_back(between("supply.voltage", 2.0, 8.0));
  constrained.constraints = {{Metric::lift_to_weight, true, 1.0}};
  held.options.hold = Hold{Held::lift_to_weight, 1.0};
  const OptimiseResult a = optimise(held, start_up_in_time()), b = optimise(constrained, start_up_in_time());
  ASSERT_EQ(a.outcome, OptimiseResult::Outcome::found);
  ASSERT_EQ(b.outcome, OptimiseResult::Outcome::found);
  EXPECT_NEAR(a.point.metrics[Metric::lift_to_weight], 1.0, 1e-7);
  const double power = b.point.metrics[Metric::power_electrical];
  EXPECT_NEAR(a.point.metrics[Metric::power_electrical], power, 1e-5 * power);
  EXPECT_NEAR(run_design(a.design).metrics[Metric::lift_to_weight], 1.0, 1e-6);
}

}  // namespace
}  // namespace wingbeat

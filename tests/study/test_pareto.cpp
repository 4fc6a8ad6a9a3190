#include "study/optimised_parameters.hpp"
#include "wingbeat/study/pareto.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/study/run.hpp"

extern "C" const wingbeat::Evolve wingbeat_evolution_module;

namespace wingbeat {
namespace {

TEST(Front, HypervolumeOfBoxes) {
  EXPECT_DOUBLE_EQ(hypervolume(std::vector<ObjectivePoint>{{1, 2}}, {3, 3}), 2.0);
  EXPECT_DOUBLE_EQ(hypervolume(std::vector<ObjectivePoint>{{2, 1}, {1, 2}, {1, 2}, {4, 0}, {2, 2}}, {3, 3}), 3.0);
  EXPECT_DOUBLE_EQ(hypervolume(std::vector<ObjectivePoint>{{3, 3}}, {3, 3}), 0.0);
  EXPECT_DOUBLE_EQ(hypervolume(std::vector<ObjectivePoint>{{0, 0, 0}}, {1, 2, 3}), 6.0);
  // Three boxes that overlap pairwise and all together: by inclusion and exclusion.
  const std::vector<ObjectivePoint> boxes = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}};
  EXPECT_DOUBLE_EQ(hypervolume(boxes, {3, 3, 3}), 3 * 6.0 - 3 * 2.0 + 1.0);
}

TEST(Front, HypervolumeOfASphere) {
  // The octant x^2 + y^2 + z^2 = 1 dominates the cube but for an eighth of the ball.
  std::vector<ObjectivePoint> points;
  const int n = 120;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double theta = 0.5 * std::numbers::pi * i / n, phi = 0.5 * std::numbers::pi * j / n;
      points.push_back(
          {1.0 - std::sin(theta) * std::cos(phi), 1.0 - std::sin(theta) * std::sin(phi), 1.0 - std::cos(theta)});
    }
  }
  EXPECT_NEAR(hypervolume(points, {1, 1, 1}), std::numbers::pi / 6.0, 0.01);
  EXPECT_LT(hypervolume(points, {1, 1, 1}), std::numbers::pi / 6.0);
}

TEST(Front, OnlyWhatNoOtherDominates) {
  const std::vector<ObjectivePoint> points = {{1, 3}, {2, 2}, {2, 3}, {3, 1}, {2, 2}, {1, 4}};
  EXPECT_THAT(nondominated(points), testing::ElementsAre(0, 1, 3));
  EXPECT_FALSE(dominates({1, 1}, {1, 1}));
  EXPECT_TRUE(dominates({1, 1}, {1, 2}));
  EXPECT_FALSE(dominates({0, 3}, {1, 2}));
}

TEST(Front, EndsKneeAndEvenSteps) {
  // Two straight pieces that meet at (0.2, 0.2).
  std::vector<ObjectivePoint> points;
  for (int n = 0; n <= 40; ++n) points.push_back({0.2 * n / 40.0, 1.0 - 0.8 * n / 40.0});
  for (int n = 1; n <= 40; ++n) points.push_back({0.2 + 0.8 * n / 40.0, 0.2 - 0.2 * n / 40.0});
  const FrontPicks picks = pick_designs(points, 5);
  EXPECT_THAT(picks.ends, testing::ElementsAre(0, 80));
  EXPECT_EQ(picks.knee, 40U);
  EXPECT_THAT(picks.even, testing::ElementsAre(0, 20, 40, 60, 80));
  // A front that is one point.
  const FrontPicks one = pick_designs(std::vector<ObjectivePoint>{{1, 2}}, 5);
  EXPECT_THAT(one.even, testing::ElementsAre(0));
  const FrontPicks three =
      pick_designs(std::vector<ObjectivePoint>{{0, 1, 1}, {1, 0, 1}, {1, 1, 0}, {0.5, 0.5, 0.5}}, 4);
  EXPECT_THAT(three.even, testing::ElementsAre(0, 1, 2, 3));
}

/// All points that an evolution asks for, with their objectives.
struct Trace {
  std::vector<ObjectivePoint> objectives;
  std::vector<double> points;
  std::size_t calls = 0;
};

Trace trace(EvolutionMethod method, EvolutionProblem problem,
            const std::function<ObjectivePoint(std::span<const double>)>& f, unsigned generations = 250) {
  Trace t;
  const std::size_t n = problem.dimensions();
  problem.evaluate = [&](std::span<const double> points, std::span<double> values) {
    ++t.calls;
    for (std::size_t i = 0; i * n < points.size(); ++i) {
      t.objectives.push_back(f(points.subspan(i * n, n)));
      std::copy(t.objectives.back().begin(), t.objectives.back().end(), values.begin() + std::ptrdiff_t(i * 2));
    }
    t.points.insert(t.points.end(), points.begin(), points.end());
  };
  const ScrambledSobol sobol(n, 1);
  std::vector<double> points, values(2 * 200);
  for (std::uint64_t i = 0; i < 200; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      const double u = sobol(i, k);
      points.push_back(k < problem.continuous ? u : std::floor(u * double(problem.choices[k - problem.continuous])));
    }
  }
  problem.evaluate(points, values);
  wingbeat_evolution_module(problem, {method, 100, generations, 1}, points, values);
  return t;
}

class Methods : public testing::TestWithParam<EvolutionMethod> {};

TEST_P(Methods, FindTheFrontOfZdt1) {
  // Zitzler, Deb and Thiele, Evol. Comput. 8(2), 2000: the front is f2 = 1 - sqrt(f1), of hypervolume 2/3 within (1,
  // 1).
  EvolutionProblem problem;
  problem.continuous = 10;
  const Trace t = trace(GetParam(), problem, [](std::span<const double> x) {
    double g = 1.0;
    for (std::size_t k = 1; k < x.size(); ++k) g += 9.0 * x[k] / double(x.size() - 1);
    return ObjectivePoint{x[0], g * (1.0 - std::sqrt(x[0] / g))};
  });
  EXPECT_EQ(t.objectives.size(), 200U + 100U * 250U);
  EXPECT_GT(hypervolume(t.objectives, {1.0, 1.0}), 2.0 / 3.0 - 0.005);
  EXPECT_LT(hypervolume(t.objectives, {1.0, 1.0}), 2.0 / 3.0);
  if (GetParam() == EvolutionMethod::nsga2) {
    EXPECT_EQ(t.calls, 251U);  // a generation at once
  }
}

TEST_P(Methods, WholeNumbersStayWhole) {
  EvolutionProblem problem;
  problem.continuous = 1;
  problem.choices = {3, 7};
  bool whole = true;
  const auto f = [&](std::span<const double> x) {
    whole = whole && x[1] == std::floor(x[1]) && x[1] >= 0 && x[1] <= 2 && x[2] == std::floor(x[2]) && x[2] <= 6;
    const double away = std::abs(x[1] - 1.0) + std::abs(x[2] - 5.0);
    return ObjectivePoint{x[0] + away, 1.0 - x[0] + away};
  };
  const Trace t = trace(GetParam(), problem, f, 40);
  EXPECT_TRUE(whole);
  EXPECT_GT(hypervolume(t.objectives, {1.0, 1.0}), 0.48);
  EXPECT_EQ(trace(GetParam(), problem, f, 40).points, t.points);  // the seed alone decides
}

/// Lift against power over voltage and spring stiffness.
ParetoStudy lift_against_power() {
  ParetoStudy study;
  study.vehicles = {{"", read_design(std::string(WINGBEAT_DATA) + "/designs/friction2022-springs.toml")}};
  study.objectives = {{Metric::lift_mean, true, 0.0}, {Metric::power_electrical, false, 4.0}};
  study.parameters = {between("supply.voltage", 2.0, 7.0), between("spring.stiffness", 0.0, 5e-3)};
  study.constraints = {{Metric::current_peak, false, 0.4}, {Metric::stroke_amplitude, false, 1.0}};
  study.screen = 256;
  study.evolution.population = 80;
  study.evolution.generations = 60;
  return study;
}

std::vector<ObjectivePoint> objectives_of(const ParetoResult& r) {
  std::vector<ObjectivePoint> points;
  for (const ParetoDesign& d : r.front) {
    points.push_back({-d.metrics[Metric::lift_mean], d.metrics[Metric::power_electrical]});
  }
  return points;
}

TEST_P(Methods, DominateAtLeastWhatADenseSweepDoes) {
  ParetoStudy study = lift_against_power();
  study.evolution.method = GetParam();
  const ParetoResult r = pareto_front(study, wingbeat_evolution_module, start_up_in_time());
  ASSERT_EQ(r.outcome, ParetoResult::Outcome::found);

  Sweep sweep;
  const std::size_t each = 71;
  for (const OptimisedParameter& p : study.parameters) {
    SweptQuantity q;
    q.set = p.parameter.set;
    for (std::size_t n = 0; n < each; ++n) {
      q.values.push_back(p.lower + (p.upper - p.lower) * double(n) / double(each - 1));
    }
    sweep.axes.push_back({"axis", each, {q}, false, {}, {}});
  }
  sweep.variants.push_back({study.vehicles[0].design, Condition::air, true});
  sweep.variant_stride.assign(2, 0);
  const SweepColumns columns = solve_sweep(sweep);
  std::vector<ObjectivePoint> grid;
  const auto metric = [&](Metric m, std::size_t n) { return columns.metrics[std::size_t(m)][n]; };
  for (std::size_t n = 0; n < columns.status.size(); ++n) {
    if (columns.status[n] != 0 || metric(Metric::current_peak, n) > 0.4 || metric(Metric::stroke_amplitude, n) > 1.0) {
      continue;
    }
    grid.push_back({-metric(Metric::lift_mean, n), metric(Metric::power_electrical, n)});
  }
  ASSERT_GT(grid.size(), 500U);
  ASSERT_LT(grid.size(), each * each - 500U);  // the constraints bite
  const double swept = hypervolume(grid, {0.0, 4.0});
  EXPECT_GE(r.hypervolume, swept);
  EXPECT_LT(r.hypervolume, 1.05 * swept);
  RecordProperty("front", std::to_string(r.hypervolume));
  RecordProperty("sweep", std::to_string(swept));

  // Feasible, and none dominated.
  for (const ParetoDesign& d : r.front) {
    EXPECT_LE(d.metrics[Metric::current_peak], 0.4);
    EXPECT_LE(d.metrics[Metric::stroke_amplitude], 1.0);
  }
  const auto points = objectives_of(r);
  EXPECT_EQ(nondominated(points).size(), points.size());
  EXPECT_DOUBLE_EQ(hypervolume(points, {0.0, 4.0}), r.hypervolume);
  // Evolution never loses what it had.
  EXPECT_EQ(r.history.size(), 61U);
  EXPECT_TRUE(std::is_sorted(r.history.begin(), r.history.end()));
  EXPECT_GT(r.history.back(), r.history.front());
}

INSTANTIATE_TEST_SUITE_P(Evolution, Methods, testing::Values(EvolutionMethod::nsga2, EvolutionMethod::moead),
                         [](const auto& m) { return m.param == EvolutionMethod::nsga2 ? "Nsga2" : "Moead"; });

TEST(Pareto, TheStudyAloneDecides) {
  ParetoStudy study = lift_against_power();
  study.evolution.generations = 10;
  const ParetoResult a = pareto_front(study, wingbeat_evolution_module, start_up_in_time());
  const ParetoResult b =
      pareto_front(study, wingbeat_evolution_module, start_up_in_time(), [](std::size_t count, const auto& act) {
        while (count > 0) act(--count);
      });
  ASSERT_EQ(a.front.size(), b.front.size());
  for (std::size_t n = 0; n < a.front.size(); ++n) EXPECT_EQ(a.front[n].parameters, b.front[n].parameters);
  EXPECT_EQ(a.hypervolume, b.hypervolume);
  EXPECT_EQ(a.evaluated.size(), 256U + 10U * 80U);
}

TEST(Pareto, DesignsRunAsTheyWereFound) {
  ParetoStudy study = lift_against_power();
  study.screen = 64;
  study.evolution.population = 16;
  study.evolution.generations = 3;
  study.hold = Hold{Held::frequency, 20.0};
  study.parameters = {between("transmission.crank_radius", 3e-3, 8e-3), between("spring.stiffness", 0.0, 5e-3)};
  const ParetoResult r = pareto_front(study, wingbeat_evolution_module, start_up_in_time());
  ASSERT_EQ(r.outcome, ParetoResult::Outcome::found);
  for (const std::size_t n : {r.picks.ends[0], r.picks.ends[1], r.picks.knee}) {
    const Metrics<double> m = run_design(vehicle_of(study, r.front[n])).metrics;
    EXPECT_NEAR(m[Metric::frequency], 20.0, 1e-5);
    for (const Metric metric : {Metric::lift_mean, Metric::power_electrical, Metric::current_peak}) {
      EXPECT_NEAR(m[metric], r.front[n].metrics[metric], 1e-6 * std::abs(m[metric]));
    }
  }
}

TEST(Pareto, ChoosesFromListsAndVehicles) {
  ParetoStudy study = lift_against_power();
  study.vehicles.push_back(study.vehicles[0]);
  study.vehicles[1].name = "leaky";  // the same motor with more resistance and friction: never better
  study.vehicles[1].design.motor.constants.armature_resistance *= 1.3;
  study.vehicles[1].design.motor.constants.viscous_damping *= 2.0;
  study.parameters = {between("supply.voltage", 2.0, 7.0)};
  study.choices = {{design_parameter("spring.stiffness"), {0.0, 1e-3, 3e-3}}};
  study.evolution.generations = 15;
  const ParetoResult r = pareto_front(study, wingbeat_evolution_module, start_up_in_time());
  ASSERT_EQ(r.outcome, ParetoResult::Outcome::found);
  const auto leaky = [](const std::vector<ParetoDesign>& designs) {
    return std::count_if(designs.begin(), designs.end(), [](const ParetoDesign& d) { return d.vehicle == 1; });
  };
  EXPECT_GT(leaky(r.evaluated), 100);
  EXPECT_LT(double(leaky(r.front)), 0.05 * double(r.front.size()));  // in gaps between voltages that were tried
  for (const ParetoDesign& d : r.front) {
    EXPECT_THAT(study.choices[0].values, testing::Contains(d.parameters[1]));
  }
}

TEST(Pareto, SaysThatNothingFlapsOrFits) {
  ParetoStudy study = lift_against_power();
  study.parameters = {between("supply.voltage", 0.1, 0.6)};
  const ParetoResult none = pareto_front(study, wingbeat_evolution_module, start_up_in_time());
  EXPECT_EQ(none.outcome, ParetoResult::Outcome::nothing_flaps);
  EXPECT_THAT(describe(nothing_found(study, none)),
              testing::StartsWith("none of 256 designs within the bounds flaps: "));
  study = lift_against_power();
  study.constraints = {{Metric::lift_to_weight, true, 9.0}};
  study.evolution.generations = 3;
  const ParetoResult heavy = pareto_front(study, wingbeat_evolution_module, start_up_in_time());
  EXPECT_EQ(heavy.outcome, ParetoResult::Outcome::infeasible);
  EXPECT_TRUE(heavy.front.empty());
  EXPECT_EQ(heavy.screen.violated[0], heavy.screen.status[0]);
}

}  // namespace
}  // namespace wingbeat

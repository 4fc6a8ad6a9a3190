#include "wingbeat/study/sweep.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/sweep_gradients.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

SweptQuantity number_of(const char* key, std::vector<double> values) {
  SweptQuantity q;
  q.key = q.name = key;
  q.set = numeric_parameter<double>(key).set;
  q.values = std::move(values);
  return q;
}

/// Springs off and on by voltage by crank radius; one crank is longer than the rod.
Sweep small_sweep() {
  Sweep sweep;
  SweptQuantity springs;
  springs.kind = SweptQuantity::Kind::choice;
  springs.key = springs.name = "springs";
  springs.labels = {"off", "on"};
  sweep.axes.push_back({"springs", 2, {springs}, false, {}, {}});
  sweep.axes.push_back({"voltage", 3, {number_of("supply.voltage", {0.2, 3.0, 5.0})}, false, {}, {}});
  sweep.axes.push_back({"crank", 3, {number_of("transmission.crank_radius", {4e-3, 5e-3, 25e-3})}, false, {}, {}});
  SweepVariant off{reference_design(), Condition::air, false}, on = off;
  on.springs = true;
  on.design.spring.stiffness = off.design.spring.stiffness = 1.377e-3;
  sweep.variants = {off, on};
  sweep.variant_stride = {1, 0, 0};
  return sweep;
}

TEST(Sweep, LastAxisVariesFastest) {
  const Sweep sweep = small_sweep();
  ASSERT_EQ(sweep.size(), 18U);
  EXPECT_EQ(places(sweep, 0), (std::vector<std::uint64_t>{0, 0, 0}));
  EXPECT_EQ(places(sweep, 5), (std::vector<std::uint64_t>{0, 1, 2}));
  EXPECT_EQ(places(sweep, 17), (std::vector<std::uint64_t>{1, 2, 2}));
  const SweepDesign d = design_at(sweep, 13);
  EXPECT_EQ(d.design.supply.voltage, 3.0);
  EXPECT_EQ(d.design.transmission.crank_radius, 5e-3);
  EXPECT_EQ(d.design.spring.stiffness, 1.377e-3);
  EXPECT_FALSE(design_at(sweep, 4).design.spring.stiffness);
}

TEST(Sweep, EachDesignIsWhatARunOfItGives) {
  const Sweep sweep = small_sweep();
  SweepColumns columns;
  columns.resize(18, sweep.options.metrics.count());
  SweepSolver(sweep, start_up_in_time()).solve(columns, 0, 18);
  for (std::uint64_t n = 0; n < 18; ++n) {
    const SweepDesign d = design_at(sweep, n);
    if (n % 3 == 2) {
      EXPECT_EQ(SweepStatus(columns.status[n]), SweepStatus::invalid);
      EXPECT_TRUE(std::isnan(columns.error_estimate[n]));
      continue;
    }
    const RunResult run = run_design(d.design);
    EXPECT_EQ(int(columns.status[n]), int(run.status)) << n;
    for (int m = 0; m < metric_count; ++m) {
      if (!sweep.options.metrics[std::size_t(m)]) continue;  // the last, which is asked for by name
      const double a = columns.metrics[std::size_t(m)][n], b = run.metrics.values[std::size_t(m)];
      if (std::isnan(b)) EXPECT_TRUE(std::isnan(a)) << metric_table()[std::size_t(m)].key;
      // Batches give multipliers to three digits (docs/numerics.md).
      else
        EXPECT_NEAR(a, b, Metric(m) == Metric::floquet_multiplier_max ? 1e-3 * b + 1e-6 : 1e-5 * std::abs(b) + 1e-9)
            << metric_table()[std::size_t(m)].key;
    }
  }
}

TEST(Sweep, HowItIsDividedDoesNotMatter) {
  const Sweep sweep = small_sweep();
  SweepColumns whole, parts;
  whole.resize(18, std::size_t(metric_count));
  parts.resize(18, std::size_t(metric_count));
  SweepSolver(sweep, start_up_in_time()).solve(whole, 0, 18);
  SweepSolver one(sweep, start_up_in_time()), other(sweep, start_up_in_time());
  other.solve(parts, 11, 18);
  one.solve(parts, 4, 11);
  other.solve(parts, 0, 4);
  EXPECT_EQ(whole.status, parts.status);
  EXPECT_EQ(whole.recomputed, parts.recomputed);
  for (std::size_t m = 0; m < 28; ++m) {
    for (std::size_t n = 0; n < 18; ++n) {
      const double a = whole.metrics[m][n], b = parts.metrics[m][n];
      EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

TEST(Sweep, GradientsAreThoseOfItsDesigns) {
  Sweep sweep = small_sweep();
  sweep.options.tolerance = 1e-9;
  const std::vector<DesignParameter> parameters = {design_parameter("friction.radius"),
                                                   design_parameter("supply.voltage")};
  const std::array metrics = {Metric::lift_mean, Metric::current_peak};
  const std::array<std::uint64_t, 5> designs = {17, 4, 13, 10, 3};
  double share = 0.0;
  const std::vector<double> found =
      sweep_gradients(sweep, designs, metrics, parameters, start_up_in_time(), {}, [&](double now) { share = now; });
  EXPECT_EQ(share, 1.0);
  ASSERT_EQ(found.size(), 20u);
  const double* number = found.data();
  for (const std::uint64_t n : designs) {
    const bool flaps = n == 4 || n == 13 || n == 3;
    DesignPointOptions options;
    options.tolerance = 1e-9;
    const DesignPoint point = design_point(design_at(sweep, n).design, options, parameters, start_up_in_time());
    EXPECT_EQ(point.status == SweepStatus::flapping, flaps) << n;
    for (const Metric m : metrics) {
      for (std::size_t k = 0; k < parameters.size(); ++k, ++number) {
        if (flaps) EXPECT_EQ(*number, point.gradients[k][std::size_t(m)]);
        else EXPECT_TRUE(std::isnan(*number));
      }
    }
  }
}

TEST(Sweep, FrequenciesThatCannotBeHeldSaySo) {
  Design<double> design = reference_design();
  design.spring.stiffness = 1.377e-3;
  design.motor.constants.inertia = 1e-6;
  Sweep sweep;
  SweptQuantity frequency;
  frequency.kind = SweptQuantity::Kind::held;
  frequency.key = frequency.name = "frequency";
  frequency.values = {5.0, 22.0};  // locked below 7 Hz
  SweptQuantity law;
  law.kind = SweptQuantity::Kind::choice;
  law.labels = {"load-proportional", "quadratic"};
  sweep.hold = Hold{Held::frequency};
  sweep.axes.push_back({"law", 2, {law}, false, {}, {}});
  sweep.axes.push_back({"frequency", 2, {frequency}, false, {}, {}});
  sweep.variants = {{design, Condition::air, true}, {reference_design(), Condition::air, true}};
  sweep.variants[1].design.friction = {FrictionLaw::quadratic, 1e-4};  // slower up to the highest voltage
  sweep.variant_stride = {1, 0};
  sweep.options.metrics = MetricSet().set(std::size_t(Metric::voltage)).set(std::size_t(Metric::frequency));
  SweepColumns columns;
  columns.resize(4, 2);
  SweepSolver(sweep, start_up_in_time()).solve(columns, 0, 4);
  EXPECT_EQ(SweepStatus(columns.status[0]), SweepStatus::locked);
  EXPECT_EQ(SweepStatus(columns.status[1]), SweepStatus::flapping);
  EXPECT_EQ(SweepStatus(columns.status[3]), SweepStatus::unreached);
  EXPECT_STREQ(name_of(SweepStatus(columns.status[3])), "unreached");
  EXPECT_TRUE(std::isnan(columns.metrics[0][0]));
  EXPECT_TRUE(std::isnan(columns.metrics[0][3]));
  EXPECT_NEAR(columns.metrics[1][1], 22.0, 22e-6);
  RunOptions options;
  options.frequency = 22.0;
  EXPECT_NEAR(columns.metrics[0][1] / run_design(design, options).metrics[Metric::voltage], 1.0, 2e-6);
}

}  // namespace
}  // namespace wingbeat

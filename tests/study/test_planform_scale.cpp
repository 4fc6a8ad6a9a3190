// wing.planform.scale: against wings that `wingbeat scale` makes, derivatives, batches.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "study/held_differences.hpp"
#include "vehicle/hinged_design.hpp"
#include "vehicle/metrics_apart.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/scaling.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

/// The outline of the tutorials' wing on the paper's vehicle.
Design<double> tabulated_design() {
  Design<double> d = reference_design();
  d.wing.planform = {};
  d.wing.planform.shape = PlanformShape::tabulated;
  d.wing.planform.hub_offset = 4e-3;
  d.wing.planform.chord_table = {{0.0, 25e-3}, {20e-3, 24e-3}, {40e-3, 19e-3}, {55e-3, 10e-3}, {63e-3, 0.0}};
  return d;
}

/// Metrics of a run of the design with that scale, and of one with wings that scaled() made.
void expect_as_scaled(const Design<double>& d, double factor) {
  Design<double> by_key = d;
  ASSERT_TRUE(numeric_parameter<double>("wing.planform.scale").set(by_key, factor));
  ScaledDesign made = scaled(d, factor, ScaledPart::wing);
  // Wings that are stated by their material have the same film, spar and ribs at any size.
  made.design.wing.areal_density = d.wing.areal_density;
  made.design.wing.spar_density = d.wing.spar_density;
  made.design.wing.rib_density = d.wing.rib_density;
  try {
    validate(by_key);
  } catch (const ParameterError& error) {
    EXPECT_THROW(validate(made.design), ParameterError) << error.what();
    return;
  }
  // Every number of the equations of motion.
  std::vector<double> ours, theirs;
  Vehicle<double> of_key = resolve(by_key), of_made = resolve(made.design);
  for_each_number(of_key, [&](const double& x) { ours.push_back(x); });
  for_each_number(of_made, [&](const double& x) { theirs.push_back(x); });
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t n = 0; n < ours.size(); ++n) {
    const bool same = ours[n] == theirs[n] || (std::isnan(ours[n]) && std::isnan(theirs[n]));
    EXPECT_TRUE(same || std::abs(ours[n] - theirs[n]) <= 1e-13 * std::abs(theirs[n])) << n << ": " << ours[n];
  }
  const RunResult a = run_design(by_key, {.tolerance = 1e-9}), b = run_design(made.design, {.tolerance = 1e-9});
  ASSERT_EQ(a.status, b.status) << describe(a) << " / " << describe(b);
  if (a.status != FlappingStatus::flapping) return;
  std::string where;
  EXPECT_LT(worst_metric(a.metrics, b.metrics, where), 1e-5) << where;
}

TEST(PlanformScale, IsThatOfScaledWings) {
  int compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(WINGBEAT_DATA) / "designs")) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const Design<double> d = read_design(entry.path());
    const bool sine_crank = d.supply.type == SupplyType::sine && d.transmission.type != TransmissionType::direct;
    if (sine_crank) continue;
    for (const double factor : {0.8, 1.15}) expect_as_scaled(d, factor), ++compared;
  }
  EXPECT_GT(compared, 10);
  for (const double factor : {0.8, 1.15}) {
    expect_as_scaled(tabulated_design(), factor);
    expect_as_scaled(hinged_design(3e-4), factor);
  }
}

TEST(PlanformScale, OneChangesNoBit) {
  for (Design<double> d : {reference_design(), tabulated_design(), hinged_design(3e-4)}) {
    const RunResult before = run_design(d);
    d.wing.planform.scale = 1.0;
    d.wing.scale_inertia = !d.wing.areal_density;
    const RunResult after = run_design(d);
    for (int m = 0; m < metric_count; ++m) {
      const double x = before.metrics.values[std::size_t(m)], y = after.metrics.values[std::size_t(m)];
      EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << metric_info(Metric(m)).key;
    }
  }
}

TEST(PlanformScale, InertiaFollowsOrStays) {
  Design<double> d = tabulated_design();
  d.wing.planform.scale = 1.2;
  EXPECT_NEAR(resolve(d).wing_inertia / (7.205e-8 * std::pow(1.2, 5)), 1.0, 1e-14);
  d.wing.scale_inertia = false;
  EXPECT_EQ(resolve(d).wing_inertia, 7.205e-8);
  EXPECT_NO_THROW(validate(d));
  // Of a film and a spar, by sums over strips of the larger outline.
  d.wing.areal_density = 17e-3;
  d.wing.spar_density = 0.6e-3;
  EXPECT_THROW(validate(d), ParameterError);
  d.wing.scale_inertia = true;
  EXPECT_NO_THROW(validate(d));
  double inertia = 0.0;
  constexpr int strips = 300000;
  const double length = 1.2 * 63e-3, width = length / strips;
  const auto& rows = d.wing.planform.chord_table;
  for (int n = 0; n < strips; ++n) {
    const double x = (n + 0.5) * width, r = x + 1.2 * 4e-3, stated = x / 1.2;
    std::size_t k = 1;
    while (rows[k].first < stated) ++k;
    const auto [x0, c0] = rows[k - 1];
    const auto [x1, c1] = rows[k];
    const double chord = 1.2 * (c0 + (c1 - c0) * (stated - x0) / (x1 - x0));
    inertia += (17e-3 * chord + 0.6e-3) * r * r * width;
  }
  EXPECT_NEAR(resolve(d).wing_inertia / inertia, 1.0, 1e-8);
}

TEST(PlanformScale, DerivativesAgreeWithDifferences) {
  const std::vector<const char*> keys{"wing.planform.scale"};
  const std::vector<Metric> metrics{Metric::frequency, Metric::power_electrical, Metric::lift_mean,
                                    Metric::current_peak, Metric::flapping_velocity_peak};
  DesignPointOptions options;
  options.tolerance = 1e-10;
  Design<double> drawn = tabulated_design();
  drawn.wing.areal_density = 17e-3;
  drawn.wing.spar_density = 0.6e-3;
  Design<double> moments = reference_design();
  moments.wing.planform.scale = 0.9;
  Design<double> added = tabulated_design();
  added.wing.planform.scale = 1.1;
  added.aerodynamics.added_mass = true;
  for (const Design<double>& d : {tabulated_design(), drawn, moments, added}) {
    expect_held_derivatives(d, options, keys, metrics, 2e-6);
  }
  Design<double> hinged = hinged_design(3e-4);
  hinged.wing.planform.scale = 1.05;
  expect_held_derivatives(hinged, options, keys, {Metric::power_electrical, Metric::lift_mean}, 5e-6);
  options.hold = Hold{Held::lift, 0.01};
  expect_held_derivatives(tabulated_design(), options, keys, {Metric::power_electrical, Metric::voltage}, 5e-6);
}

TEST(PlanformScale, BatchesGiveWhatTheScalarSolverGives) {
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 24; ++n) {
    Design<double> d = tabulated_design();
    d.wing.planform.scale = 0.7 + 0.025 * n;
    members.push_back({resolve(d), reporting_of(d)});
  }
  std::vector<EnsembleOutcome> outcomes(members.size());
  EnsembleOptions options;
  options.tolerance = 1e-8;
  solve_ensemble(members, options, start_up_in_time(), outcomes);
  int batched = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    const SteadyFlapping one =
        find_steady_flapping(members[n].vehicle, {.tolerance = 1e-9, .reporting = members[n].reporting});
    ASSERT_EQ(outcomes[n].status, one.status) << n;
    if (one.status != FlappingStatus::flapping) continue;
    batched += !outcomes[n].scalar;
    for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::lift_mean, Metric::rod_force_peak}) {
      EXPECT_NEAR(outcomes[n].metrics[m] / one.metrics[m], 1.0, 1e-7) << n << " " << metric_info(m).key;
    }
  }
  EXPECT_GT(batched, has_packs ? 15 : -1);
}

}  // namespace
}  // namespace wingbeat

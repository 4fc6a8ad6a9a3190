// Every identity among the powers of a cycle, of vehicles of all kinds, by every method.
#include "vehicle/power_identities.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/hinged_design.hpp"
#include "vehicle/metrics_apart.hpp"
#include "vehicle/rungs.hpp"
#include "wingbeat/cycle/thermal_equilibrium.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

constexpr double tolerance = 1e-6;

/// The vehicle that the metrics are of: its motor as warm as they say.
Vehicle<double> as_warm_as(const Vehicle<double>& v, const Metrics<double>& m) {
  if (!heats_up(v.thermal)) return v;
  return with_motor_at(v, {m[Metric::winding_temperature] + zero_celsius, m[Metric::case_temperature] + zero_celsius});
}

void expect_identities(const Vehicle<double>& v, const Metrics<double>& m, bool constant_voltage = true) {
  // Temperatures of the last search for an equilibrium are known to its tolerance alone.
  const double of_metrics = heats_up(v.thermal) ? 10.0 * tolerance : tolerance;
  EXPECT_EQ(violated_power_identities(as_warm_as(v, m), m, of_metrics, constant_voltage), "");
}

/// By orbit, simulation and batch; how many of them flapped.
int expect_identities_of(const Design<double>& design) {
  validate(design);
  const Vehicle<double> v = resolve(design);
  int flaps = 0;
  const bool pwm = design.supply.type == SupplyType::pwm;
  for (const Method method : {Method::orbit, Method::transient}) {
    SCOPED_TRACE(name_of(method));
    const RunResult r = run_design(design, {.method = method, .tolerance = tolerance});
    if (r.status != FlappingStatus::flapping) continue;
    ++flaps;
    if (method == Method::orbit || !pwm) expect_identities(v, r.metrics);
  }
  SCOPED_TRACE("batch");
  const EnsembleMember member{v, {}};
  EnsembleOutcome outcome;
  solve_ensemble(std::span(&member, 1), {.tolerance = tolerance}, start_up_in_time(), std::span(&outcome, 1));
  if (outcome.status == FlappingStatus::flapping) {
    ++flaps;
    expect_identities(v, outcome.metrics);
  }
  return flaps;
}

TEST(PowerIdentities, HoldOnEveryTransmissionWithEveryFurtherPart) {
  int flaps = 0;
  for (const FarBox box : {FarBox::friction_laws, FarBox::four_bar, FarBox::tabulated, FarBox::direct}) {
    for (const Rung rung : {Rung::none, Rung::all, Rung::pitch}) {
      for (std::uint32_t n = 0; n < 3; ++n) {
        SCOPED_TRACE(std::string(far_box_names[std::size_t(box)]) + " " + std::string(rung_names[std::size_t(rung)]) +
                     " " + std::to_string(n));
        Design<double> d = wide_vehicle(box, n, 32).design;
        add_rung(d, rung, n, 32);
        flaps += expect_identities_of(d);
      }
    }
  }
  EXPECT_GT(flaps, 50);
}

TEST(PowerIdentities, HoldOverImpactsOnStops) {
  int flaps = 0;
  for (std::uint32_t n = 0; n < 12; ++n) {
    SCOPED_TRACE(n);
    Design<double> d = random_hinged_crank(n, 5);
    d.pitch.stop = 0.1 + 0.03 * n;
    if (n % 3 == 0) d.motor.gear_efficiency = 0.7;
    if (n % 4 == 0) d.motors = 2.0;
    flaps += expect_identities_of(d);
  }
  std::mt19937_64 random(6);
  for (int n = 0; n < 4; ++n) {
    SCOPED_TRACE(n);
    flaps += expect_identities_of(random_hinged_design(random, true));
  }
  EXPECT_GT(flaps, 30);
}

TEST(PowerIdentities, HoldOnOtherSupplies) {
  int flaps = 0;
  for (std::uint32_t n = 0; n < 8; ++n) {
    SCOPED_TRACE(n);
    const Design<double> d = wide_vehicle(FarBox::supplies, n, 33).design;
    if (d.supply.type != SupplyType::sine) flaps += expect_identities_of(d);
  }
  EXPECT_GT(flaps, 8);
}

Design<double> design_of_case(const char* name) {
  return read_design(std::string(WINGBEAT_CASES "/") + name + ".toml");
}

TEST(PowerIdentities, HoldWhereTheRotorWorksInImpacts) {
  for (const char* name : {"motor-power-222", "motor-power-195", "slow-orbit-901-0"}) {
    SCOPED_TRACE(name);
    const Design<double> d = design_of_case(name);
    const RunResult r = run_design(d, {.tolerance = tolerance});
    ASSERT_EQ(r.status, FlappingStatus::flapping);
    expect_identities(resolve(d), r.metrics);
    EXPECT_LT(r.metrics[Metric::efficiency_motor], 1.0);
  }
}

TEST(PowerIdentities, StopsTakeNoNegativePower) {
  const Design<double> d = design_of_case("p103");
  for (const Method method : {Method::orbit, Method::transient}) {
    const RunResult r = run_design(d, {.method = method, .tolerance = tolerance});
    ASSERT_EQ(r.status, FlappingStatus::flapping);
    EXPECT_GT(r.metrics[Metric::power_hinge], 0.0);
    expect_identities(resolve(d), r.metrics);
  }
}

TEST(PowerIdentities, AnImpactThatTurnsTheGearTorqueOverCountsOnce) {
  const Design<double> d = design_of_case("hinge-41");
  RunResult by[2];
  for (const Method method : {Method::orbit, Method::transient}) {
    RunResult& r = by[int(method)];
    r = run_design(d, {.method = method, .tolerance = tolerance});
    ASSERT_EQ(r.status, FlappingStatus::flapping);
    expect_identities(resolve(d), r.metrics);
  }
  const double hinge = by[1].metrics[Metric::power_hinge];
  EXPECT_NEAR(by[0].metrics[Metric::power_hinge], hinge, 1e-3 * hinge);
  std::string where;
  EXPECT_LT(metrics_apart(by[0].metrics, by[1].metrics, where), 1e-5) << where;
}

}  // namespace
}  // namespace wingbeat

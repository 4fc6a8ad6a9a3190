// Every identity among the powers of a cycle, of vehicles of all kinds, by every method.
#include "vehicle/power_identities.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/hinged_design.hpp"
#include "vehicle/kind_boxes.hpp"
#include "vehicle/metrics_apart.hpp"
#include "vehicle/model_options.hpp"
#include "wingbeat/cycle/thermal_equilibrium.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
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
  std::mt19937_64 random(32);
  int flaps = 0;
  for (const ModelOption option : {ModelOption::none, ModelOption::gear, ModelOption::heat, ModelOption::all}) {
    SCOPED_TRACE(model_option_names[std::size_t(option)]);
    for (std::uint32_t n = 0; n < 2; ++n) {
      Design<double> crank = box_design(random), direct = smooth_direct_design(random);
      crank.motors = direct.motors = double(n + 1);
      for (Design<double>* d : {&crank, &direct}) {
        add_model_option(*d, option, n, 32);
        flaps += expect_identities_of(*d);
      }
    }
  }
  EXPECT_GT(flaps, 30);
  flaps = 0;
  for (const FarBox box : {FarBox::four_bar, FarBox::tabulated}) {
    Design<double> d = box_design(random);
    d.transmission = wide_vehicle(box, 1, 32).design.transmission;
    d.friction = {FrictionLaw::load_proportional, 5e-4};
    d.motor.gear_efficiency = 0.8;
    flaps += expect_identities_of(d);
  }
  EXPECT_GT(flaps, 2);
}

// The motor's own friction is no part of what comes out of the gearbox, on either drive.
TEST(PowerIdentities, HoldWithAMotorThatHasFrictionOfItsOwn) {
  std::mt19937_64 random(34);
  int flaps = 0;
  for (std::uint32_t n = 0; n < 4; ++n) {
    SCOPED_TRACE(n);
    Design<double> crank = box_design(random), direct = smooth_direct_design(random);
    add_model_option(crank, n % 2 == 0 ? ModelOption::all : ModelOption::none, n, 34);
    if (n % 2 == 1) crank.friction = direct.friction = {FrictionLaw::none, 0.0};
    for (Design<double>* d : {&crank, &direct}) {
      const MotorDesign<double>& m = d->motor;
      const double stall = m.constants.torque_constant * d->supply.voltage / m.constants.armature_resistance;
      d->motor.constants.friction_torque = 0.05 * stall;
      flaps += expect_identities_of(*d);
    }
  }
  EXPECT_GT(flaps, 14);
}

TEST(PowerIdentities, HoldOverImpactsOnStops) {
  int flaps = 0;
  for (std::uint32_t n = 0; n < 8; ++n) {
    SCOPED_TRACE(n);
    Design<double> d = random_hinged_crank(n, 5);
    d.pitch.stop = 0.1 + 0.05 * n;
    if (n % 3 == 0) d.motor.gear_efficiency = 0.7;
    if (n % 4 == 0) d.motors = 2.0;
    flaps += expect_identities_of(d);
  }
  std::mt19937_64 random(6);
  for (int n = 0; n < 3; ++n) {
    SCOPED_TRACE(n);
    flaps += expect_identities_of(random_hinged_design(random, true));
  }
  EXPECT_GT(flaps, 15);
}

TEST(PowerIdentities, HoldOnOtherSupplies) {
  std::mt19937_64 random(33);
  int flaps = 0;
  for (const KindBox box : {KindBox::battery, KindBox::pwm}) {
    SCOPED_TRACE(kind_box_names[std::size_t(box)]);
    for (int n = 0; n < 2; ++n) flaps += expect_identities_of(kind_design(box, random));
  }
  EXPECT_GT(flaps, 6);
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

// An impact after which the gear torque changes its sign had been met twice in one place. The hinge power is that of
// the simulation in time.
TEST(PowerIdentities, AnImpactThatTurnsTheGearTorqueOverCountsOnce) {
  const Design<double> d = design_of_case("hinge-41");
  const RunResult r = run_design(d, {.tolerance = 1e-5});
  ASSERT_EQ(r.status, FlappingStatus::flapping);
  const EnergyAudit audit = energy_audit(r.metrics);
  EXPECT_LT(std::abs(audit.imbalance), 1e-3 * audit.hinge);
  EXPECT_NEAR(audit.hinge, 1.30998e-5, 1e-8 * audit.electrical);
  expect_identities(resolve(d), r.metrics);
}

}  // namespace
}  // namespace wingbeat

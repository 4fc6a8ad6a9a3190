// Several motors on one supply, each with its transmission and wings: against one motor with its share of the source.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/cycle/static_balance.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

/// Whether a metric is the sum of what several motors have.
bool is_sum(Metric m) {
  switch (m) {
    case Metric::current_mean:
    case Metric::current_peak:
    case Metric::current_rms:
    case Metric::power_electrical:
    case Metric::power_motor:
    case Metric::power_motor_reference:
    case Metric::power_friction:
    case Metric::power_aerodynamic:
    case Metric::power_reactive:
    case Metric::power_copper:
    case Metric::power_viscous:
    case Metric::power_motor_friction:
    case Metric::power_gear:
    case Metric::power_loss:
    case Metric::power_residual:
    case Metric::lift_mean:
    case Metric::lift_peak: return true;
    default: return false;
  }
}

/// A design of so many motors, and what each of them sees: through a source of its own it is as if the current of the
/// others passed its resistance as well. The mass is shared, too.
Design<double> together(Design<double> d, double motors) {
  d.motors = motors;
  return d;
}
Design<double> share_of(Design<double> d, double motors) {
  d.supply.battery.internal_resistance *= motors;
  if (d.mass) *d.mass /= motors;
  return d;
}

void expect_sums(const Metrics<double>& all, const Metrics<double>& one, double motors, double tolerance,
                 const std::string& which) {
  for (int k = 0; k < metric_count; ++k) {
    const Metric m = Metric(k);
    const double factor = is_sum(m) ? motors : 1.0;
    EXPECT_EQ(std::isnan(all[m]), std::isnan(one[m])) << which << ' ' << metric_info(m).key;
    if (std::isnan(all[m])) continue;
    double scale = factor * error_scale(one, m);
    if (m == Metric::floquet_multiplier_max) scale = 1.0;
    if (m == Metric::crank_speed_min) scale = one[Metric::crank_speed_max];
    EXPECT_NEAR(all[m], factor * one[m], tolerance * scale) << which << ' ' << metric_info(m).key;
  }
}

Design<double> on_battery(Design<double> d) {
  const double voltage = d.supply.voltage;
  d.supply = {};
  d.supply.type = SupplyType::battery;
  d.supply.battery.cell_voltage = voltage;
  d.supply.battery.internal_resistance = 0.2 * d.motor.constants.armature_resistance;
  d.supply.battery.capacity = 180.0;
  return d;
}

TEST(Motors, AreOneOfTheSumOfTheirCurrentsAndTorques) {
  Design<double> d = reference_design();
  d.motor.gear_ratio = 4.0;
  d.motor.gear_damping = 1e-7;
  d.friction = {FrictionLaw::quadratic, 2e-8};
  d.motors = 3.0;
  const Vehicle<double> v = resolve(d);
  d.motors = 1.0;
  const Vehicle<double> one = resolve(d);
  EXPECT_EQ(v.motors, 3.0);
  EXPECT_DOUBLE_EQ(v.motor.armature_resistance, one.motor.armature_resistance / 3.0);
  EXPECT_DOUBLE_EQ(v.motor.armature_inductance, one.motor.armature_inductance / 3.0);
  EXPECT_EQ(v.motor.torque_constant, one.motor.torque_constant);
  EXPECT_DOUBLE_EQ(v.motor.inertia, 3.0 * one.motor.inertia);
  EXPECT_DOUBLE_EQ(v.motor.viscous_damping, 3.0 * one.motor.viscous_damping);
  EXPECT_DOUBLE_EQ(v.friction.quadratic, 3.0 * one.friction.quadratic);
  EXPECT_DOUBLE_EQ(v.wing_count, 6.0);
  EXPECT_EQ(v.wing_inertia, one.wing_inertia);
  EXPECT_DOUBLE_EQ(v.wings.s2, 3.0 * one.wings.s2);
  EXPECT_DOUBLE_EQ(v.wings.s3, 3.0 * one.wings.s3);
  EXPECT_DOUBLE_EQ(no_load_speed(v), no_load_speed(one));
  EXPECT_DOUBLE_EQ(stall_torque(v), 3.0 * stall_torque(one));
}

TEST(Motors, OfRandomVehiclesOnABatteryAreAsManyWithAShareOfItsResistance) {
  std::mt19937_64 random(141);
  int flapping = 0, not_flapping = 0;
  for (int n = 0; n < 40; ++n) {
    Design<double> d = on_battery(n % 2 ? box_design(random) : random_design(random, 1.5));
    if (n % 4 == 3) d.motor.gear_efficiency = 0.8;
    d.mass = 3e-3;
    const double motors = 2.0 + n % 3;
    const RunResult all = run_design(together(d, motors), {.tolerance = 1e-9});
    const RunResult one = run_design(share_of(d, motors), {.tolerance = 1e-9});
    ASSERT_EQ(all.status, one.status) << n << ": " << describe(all) << " / " << describe(one);
    if (all.status != FlappingStatus::flapping) {
      ++not_flapping;
      continue;
    }
    ++flapping;
    EXPECT_EQ(all.domain, one.domain) << n;
    expect_sums(all.metrics, one.metrics, motors, 1e-7, "vehicle " + std::to_string(n));
    const EnergyAudit audit = energy_audit(all.metrics);
    EXPECT_LT(std::abs(audit.imbalance / audit.electrical), 1e-7) << n;
  }
  EXPECT_GT(flapping, 25);
}

TEST(Motors, InTimeAndInPacksAsByOrbit) {
  Design<double> d = on_battery(reference_design());
  d.spring.stiffness = 1.377e-3;
  d.motors = 2.0;
  const RunResult orbit = run_design(d, {.tolerance = 1e-8, .waveform_rows = 181});
  const RunResult time = run_design(d, {.method = Method::transient, .tolerance = 1e-8, .waveform_rows = 181});
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  ASSERT_EQ(time.status, FlappingStatus::flapping);
  for (int k = 0; k < metric_count; ++k) {
    const Metric m = Metric(k);
    if (m == Metric::floquet_multiplier_max || std::isnan(orbit.metrics[m])) continue;
    EXPECT_NEAR(time.metrics[m], orbit.metrics[m], 1e-6 * error_scale(orbit.metrics, m)) << metric_info(m).key;
  }
  const EnsembleMember members[] = {{resolve(d), reporting_of(d)}};
  EnsembleOutcome outcomes[1];
  solve_ensemble(members, {}, start_up_in_time(), outcomes);
  for (const Metric m :
       {Metric::frequency, Metric::current_mean, Metric::current_peak, Metric::lift_mean, Metric::lift_to_weight,
        Metric::rod_force_peak, Metric::rod_force_mean, Metric::power_electrical}) {
    EXPECT_NEAR(outcomes[0].metrics[m] / orbit.metrics[m], 1.0, 1e-5) << metric_info(m).key;
  }
  // Waveforms: the sums, but for the force of one rod; the terminals see the current of both in the source.
  const RunResult one = run_design(share_of(
                                       [&] {
                                         Design<double> single = d;
                                         single.motors = 1.0;
                                         return single;
                                       }(),
                                       2.0),
                                   {.method = Method::transient, .tolerance = 1e-8, .waveform_rows = 181});
  const double R_i = d.supply.battery.internal_resistance;
  double highest = 0.0, strongest = 0.0;
  for (const RunResult* result : {&orbit, &time}) {
    ASSERT_EQ(result->cycle.size(), one.cycle.size());
    for (std::size_t n = 0; n < one.cycle.size(); ++n) {
      const WaveformRow &a = result->cycle[n], &b = one.cycle[n];
      EXPECT_NEAR(a.current, 2.0 * b.current, 1e-4 * one.metrics[Metric::current_peak]) << n;
      EXPECT_NEAR(a.lift, 2.0 * b.lift, 1e-3 * one.metrics[Metric::lift_peak]) << n;
      EXPECT_NEAR(a.rod_force, b.rod_force, 1e-3 * one.metrics[Metric::rod_force_peak]) << n;
      EXPECT_NEAR(a.voltage, 3.0 - R_i * a.current, 1e-12);
      highest = std::max(highest, a.current);
      strongest = std::max(strongest, std::abs(a.rod_force));
    }
  }
  EXPECT_NEAR(highest / orbit.metrics[Metric::current_peak], 1.0, 1e-2);
  EXPECT_NEAR(strongest / orbit.metrics[Metric::rod_force_peak], 1.0, 1e-2);
  ASSERT_TRUE(time.start_up && one.start_up);
  EXPECT_NEAR(time.start_up->inrush_current / one.start_up->inrush_current, 2.0, 1e-5);
}

TEST(Motors, OfADirectDriveSwingInPhase) {
  std::mt19937_64 random(142);
  for (int n = 0; n < 12; ++n) {
    Design<double> d = random_direct_design(random, n % 2 == 1);
    const RunResult all = run_design(together(d, 2.0), {.tolerance = 1e-9});
    const RunResult one = run_design(d, {.tolerance = 1e-9});
    ASSERT_EQ(all.status, one.status) << n << ": " << describe(all) << " / " << describe(one);
    if (all.status != FlappingStatus::flapping) continue;
    Metrics<double> half = one.metrics;
    half[Metric::lift_to_weight] *= 2.0;  // the mass is not shared
    expect_sums(all.metrics, half, 2.0, 1e-7, "direct drive " + std::to_string(n));
  }
}

TEST(Motors, EachHeatsUpByItsOwnLosses) {
  Design<double> d = on_battery(reference_design());
  d.motor.thermal.resistance_winding = 20.0;
  d.motor.thermal.resistance_case = 48.0;
  d.motor.thermal.winding_temperature_max = 360.0;
  const RunResult all = run_design(together(d, 2.0), {.tolerance = 1e-8});
  const RunResult one = run_design(share_of(d, 2.0), {.tolerance = 1e-8});
  ASSERT_EQ(all.status, FlappingStatus::flapping);
  EXPECT_GT(one.metrics[Metric::winding_temperature], 40.0);
  expect_sums(all.metrics, one.metrics, 2.0, 1e-7, "warm");
}

// Derivatives of sums are sums of derivatives; that of a rod's force is one rod's.
TEST(Motors, HaveTheDerivativesOfOne) {
  for (const bool warm : {false, true}) {
    Design<double> d = on_battery(reference_design());
    if (warm) d.motor.thermal.resistance_winding = d.motor.thermal.resistance_case = 20.0;
    const auto gradient_of = [](const Design<double>& varied) {
      Design<GradientJet> seeded = cast<GradientJet>(varied);
      seeded.motor.constants.torque_constant = gradient_seed(varied.motor.constants.torque_constant, 0);
      seeded.wing.planform.s2 = gradient_seed(varied.wing.planform.s2, 1);
      const SteadyFlapping found =
          find_steady_flapping(resolve(varied), {.tolerance = 1e-10, .reporting = reporting_of(varied)});
      EXPECT_EQ(found.status, FlappingStatus::flapping);
      return orbit_gradient(found, gradient_vehicle(seeded, Condition::air));
    };
    const OrbitGradient all = gradient_of(together(d, 3.0)), one = gradient_of(share_of(d, 3.0));
    for (int k = 0; k < metric_count; ++k) {
      const Metric m = Metric(k);
      for (const Eigen::Index slot : {gradient_first_slot + 0, gradient_first_slot + 1}) {
        const double factor = is_sum(m) ? 3.0 : 1.0, b = factor * one.metrics[m].v[slot];
        if (std::isnan(b)) continue;
        EXPECT_NEAR(all.metrics[m].v[slot], b, 1e-5 * std::abs(b)) << metric_info(m).key << " by " << slot;
      }
    }
  }
}

TEST(Motors, AreSearchedForAsOneVehicle) {
  Design<double> d = reference_design();
  const RunResult one = run_design(d, {.lift = 0.008}), all = run_design(together(d, 2.0), {.lift = 0.016});
  ASSERT_TRUE(one.search && all.search);
  EXPECT_EQ(all.search->outcome, FrequencyOutcome::reached);
  EXPECT_NEAR(all.search->voltage / one.search->voltage, 1.0, 1e-5);
  EXPECT_NEAR(all.metrics[Metric::lift_mean], 0.016, 1e-7);
  const RunResult at_20 = run_design(together(d, 2.0), {.frequency = 20.0});
  EXPECT_NEAR(at_20.search->voltage / run_design(d, {.frequency = 20.0}).search->voltage, 1.0, 1e-5);
}

TEST(Motors, WeighAsManyTimesWhatIsStatedOfOne) {
  Design<double> d = reference_design();
  d.spring.stiffness = 1.377e-3;
  d.mass = 1.5e-3;
  d.masses = {0.8e-3, 0.6e-3, 5e-3, 0.05e-3};
  d.motors = 2.0;
  EXPECT_DOUBLE_EQ(*total_mass(d), 1.5e-3 + 0.8e-3 + 2.0 * (0.6e-3 + 5e-3 * d.transmission.rod_length + 2.0 * 0.05e-3));
}

TEST(Motors, AreAWholeNumber) {
  for (const double motors : {0.0, 1.5, -1.0}) {
    try {
      validate(together(reference_design(), motors));
      FAIL() << "accepted";
    } catch (const ParameterError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("vehicle.motors: must be a whole number >= 1")) << motors;
    }
  }
}

}  // namespace
}  // namespace wingbeat

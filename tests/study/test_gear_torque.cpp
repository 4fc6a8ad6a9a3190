// The torque behind the gearbox: against the waveform's rows, the motor's side of the gearbox, and differences.
#include "wingbeat/study/gear_torque.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "study/optimised_parameters.hpp"
#include "vehicle/direct_design.hpp"
#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat::gear_torque_tests {
namespace {

Design<double> geared() {
  Design<double> d = reference_design();
  d.motor.gear_ratio = 10.0;
  d.motor.gear_efficiency = d.motor.constants.gear_efficiency = 0.8;
  d.motor.constants = {9.0, 1e-3, 1e-3, 1.5e-9, 1e-8, 1e-5, 0.8};
  d.motor.gear_inertia = 1e-8;
  d.spring.stiffness = 1.377e-3;
  return d;
}

struct Sampled {
  double rms = 0.0, peak = 0.0;
};
Sampled sampled(const std::vector<WaveformRow>& rows, const std::vector<double>& torque) {
  Sampled s;
  for (std::size_t n = 1; n < rows.size(); ++n) {
    s.rms += torque[n] * torque[n] / double(rows.size() - 1);
    s.peak = std::max(s.peak, std::abs(torque[n]));
  }
  s.rms = std::sqrt(s.rms);
  return s;
}

TEST(GearTorque, IsThatOfTheWaveformAndOfTheMotorsSide) {
  const Design<double> d = geared();
  const SteadyFlapping orbit = find_steady_flapping(resolve(d), {.tolerance = 1e-9});
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  const GearTorque torque = gear_torque(orbit);
  const std::vector<WaveformRow> rows = orbit.record.waveform(8001);
  std::vector<double> behind, by_motor;
  // What the rotor leaves of the motor's torque, times the efficiency where the motor drives.
  const double n = 10.0, K = n * 1e-3, b = n * n * 1e-8, T_c = n * 1e-5, J = 1e-8 + n * n * 1.5e-9;
  const double step = rows[1].time - rows[0].time;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    behind.push_back(rows[k].motor_torque);
    const std::size_t up = k + 1 < rows.size() ? k + 1 : 1, down = k > 0 ? k - 1 : rows.size() - 2;
    const double slope = (rows[up].crank_speed - rows[down].crank_speed) / (2.0 * step);
    const double before = K * rows[k].current - b * rows[k].crank_speed - T_c - J * slope;
    by_motor.push_back(before > 0.0 ? 0.8 * before : before / 0.8);
  }
  const Sampled of_rows = sampled(rows, behind), of_motor = sampled(rows, by_motor);
  EXPECT_NEAR(torque.rms / of_rows.rms, 1.0, 1e-4);
  EXPECT_NEAR(torque.peak / of_rows.peak, 1.0, 1e-5);
  EXPECT_NEAR(torque.rms / of_motor.rms, 1.0, 1e-3);
  EXPECT_NEAR(torque.peak / of_motor.peak, 1.0, 1e-3);
  EXPECT_GT(torque.peak, 1.2 * torque.rms);
  // The peak of the motor's own torque is less: the rotor's inertia carries the crank over the peaks.
  EXPECT_LT(K * orbit.metrics[Metric::current_peak], torque.peak);
}

TEST(GearTorque, IsThatOfOneMotor) {
  Design<double> d = geared();
  const GearTorque one = gear_torque(find_steady_flapping(resolve(d), {.tolerance = 1e-8}));
  d.motors = 3.0;
  const GearTorque each = gear_torque(find_steady_flapping(resolve(d), {.tolerance = 1e-8}));
  EXPECT_NEAR(each.rms / one.rms, 1.0, 1e-6);
  EXPECT_NEAR(each.peak / one.peak, 1.0, 1e-6);
}

TEST(GearTorque, HasTheDerivativesOfDifferences) {
  const Design<double> d = geared();
  const auto torque_of = [](const Design<double>& varied) {
    return gear_torque(find_steady_flapping(resolve(varied), {.tolerance = 1e-10}));
  };
  std::vector<DesignParameter> parameters;
  for (const char* key : {"supply.voltage", "spring.stiffness", "motor.gear_ratio", "wing.inertia"}) {
    parameters.push_back(between(key, 0.0, 1.0).parameter);
  }
  const SteadyFlapping orbit = find_steady_flapping(resolve(d), {.tolerance = 1e-10});
  const std::vector<GearTorque> slopes = gear_torque_slopes(d, Condition::air, orbit, parameters, Held::voltage);
  ASSERT_EQ(slopes.size(), parameters.size());
  const GearTorque here = torque_of(d);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double x = *parameters[k].value(d), step = 1e-4 * x;
    Design<double> up = d, down = d;
    parameters[k].set(up, x + step);
    parameters[k].set(down, x - step);
    const GearTorque above = torque_of(up), below = torque_of(down);
    EXPECT_NEAR(slopes[k].rms * x, (above.rms - below.rms) / (2.0 * step) * x, 1e-4 * here.rms) << parameters[k].key;
    EXPECT_NEAR(slopes[k].peak * x, (above.peak - below.peak) / (2.0 * step) * x, 2e-4 * here.peak)
        << parameters[k].key;
  }
}

TEST(GearTorque, OfADirectDriveIsThatOfItsShaft) {
  Design<double> d = direct_design();
  const SteadyFlapping orbit = find_steady_flapping(resolve(d), {.tolerance = 1e-9});
  ASSERT_EQ(orbit.status, FlappingStatus::flapping);
  const GearTorque torque = gear_torque(orbit);
  const std::vector<WaveformRow> rows = orbit.record.waveform(8001);
  std::vector<double> behind;
  for (const WaveformRow& row : rows) behind.push_back(row.motor_torque);
  const Sampled of_rows = sampled(rows, behind);
  EXPECT_NEAR(torque.rms / of_rows.rms, 1.0, 1e-4);
  EXPECT_NEAR(torque.peak / of_rows.peak, 1.0, 1e-5);
}

TEST(GearTorque, IsAbsentWhereNothingFlaps) {
  Design<double> d = geared();
  d.supply.voltage = 0.0;
  EXPECT_TRUE(std::isnan(gear_torque(find_steady_flapping(resolve(d))).rms));
}

// With a limit on the torque the voltage rises until the torque is at it, and that is said.
TEST(GearTorque, HoldsAnOptimum) {
  OptimiseStudy study;
  study.design = geared();
  study.objective = Metric::lift_mean;
  study.maximise = true;
  study.parameters = {between("supply.voltage", 1.0, 4.0)};
  study.starts = 3;
  study.screen = 64;
  study.allow_extrapolation = true;
  const OptimiseResult free = optimise(study, start_up_in_time());
  ASSERT_EQ(free.outcome, OptimiseResult::Outcome::found);
  const GearTorque at_free = gear_torque(find_steady_flapping(resolve(free.design), {.tolerance = 1e-8}));
  for (const bool peak : {false, true}) {
    OptimiseStudy limited = study;
    if (peak) limited.gear_torque.peak = 0.6 * at_free.peak;
    else limited.gear_torque.continuous = 0.6 * at_free.rms;
    const OptimiseResult r = optimise(limited, start_up_in_time());
    ASSERT_EQ(r.outcome, OptimiseResult::Outcome::found);
    EXPECT_LT(r.parameters[0], free.parameters[0]);
    const GearTorque found = gear_torque(find_steady_flapping(resolve(r.design), {.tolerance = 1e-8}));
    EXPECT_NEAR(peak ? found.peak / (0.6 * at_free.peak) : found.rms / (0.6 * at_free.rms), 1.0, 1e-4);
    ASSERT_FALSE(r.active.empty());
    EXPECT_EQ(r.active[0].name.substr(0, 10), peak ? "peak torqu" : "continuous");
    EXPECT_GT(r.active[0].sensitivity, 0.0);
  }
}

}  // namespace
}  // namespace wingbeat::gear_torque_tests

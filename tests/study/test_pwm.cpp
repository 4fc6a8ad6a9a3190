// Switching supplies: ripple and mean current against the averaged model, and the duty for a commanded lift.
#include <gtest/gtest.h>

#include <cmath>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

Design<double> pwm_design(double voltage, double frequency, double duty) {
  Design<double> d = reference_design();
  d.supply = {SupplyType::pwm, voltage, frequency, duty};
  return d;
}

// v d (1 - d) / (L_a f), the ripple of a resistance-free inductance, with an error of second order in 1/f.
TEST(Pwm, RippleApproachesItsClosedFormAsTheFrequencyGrows) {
  double error_before = 0.0;
  for (const double frequency : {500.0, 2000.0, 8000.0}) {
    for (const double duty : {0.3, 0.6}) {
      const Design<double> d = pwm_design(5.0, frequency, duty);
      const RunResult r = run_design(d, {.method = Method::transient});
      ASSERT_EQ(r.status, FlappingStatus::flapping) << describe(r);
      ASSERT_TRUE(r.start_up->current_ripple);
      const double L = d.motor.constants.armature_inductance, R = d.motor.constants.armature_resistance;
      const double expected = 5.0 * duty * (1.0 - duty) / (L * frequency);
      const double error = std::abs(*r.start_up->current_ripple / expected - 1.0);
      // (R T / L)^2 / 12 to first order, from v/R (1 - e^-dT/tau)(1 - e^-(1-d)T/tau) / (1 - e^-T/tau).
      EXPECT_LT(error, 0.2 * square(R / (L * frequency)) + 1e-6) << frequency << ' ' << duty;
      if (duty == 0.6) {
        if (frequency > 500.0) {
          EXPECT_LT(error, 0.2 * error_before);
        }
        error_before = error;
      }
    }
  }
}

// The swing of the current within a flapping cycle is many times the ripple, and must not count as such.
TEST(Pwm, RippleLeavesTheFlappingCycleOut) {
  const RunResult r = run_design(pwm_design(5.0, 20000.0, 0.6), {.method = Method::transient});
  ASSERT_TRUE(r.start_up->current_ripple);
  const double swing = r.metrics[Metric::current_peak] - r.metrics[Metric::current_mean];
  EXPECT_GT(swing, 5.0 * *r.start_up->current_ripple);
}

TEST(Pwm, WithoutInductanceTheCurrentSwitchesByItsFullHeight) {
  Design<double> d = pwm_design(5.0, 2000.0, 0.7);
  d.motor.constants.armature_inductance = 0.0;
  const RunResult r = run_design(d, {.method = Method::transient});
  ASSERT_TRUE(r.start_up->current_ripple) << describe(r);
  EXPECT_NEAR(*r.start_up->current_ripple, 5.0 / 9.0, 0.02 * 5.0 / 9.0);
}

TEST(Pwm, NoRippleWithoutSwitching) {
  EXPECT_EQ(run_design(pwm_design(3.0, 1000.0, 1.0), {.method = Method::transient}).start_up->current_ripple, 0.0);
  EXPECT_FALSE(run_design(reference_design(), {.method = Method::transient}).start_up->current_ripple);
}

TEST(Pwm, MeanCurrentApproachesTheAveragedModel) {
  double before = 1.0;
  for (const double frequency : {200.0, 1000.0, 5000.0}) {
    const Design<double> d = pwm_design(5.0, frequency, 0.6);
    const RunResult averaged = run_design(d);
    const RunResult switched = run_design(d, {.method = Method::transient});
    const double error =
        std::abs(switched.metrics[Metric::current_mean] / averaged.metrics[Metric::current_mean] - 1.0);
    EXPECT_LT(error, frequency == 200.0 ? 3e-2 : frequency == 1000.0 ? 3e-3 : 3e-4) << frequency;
    EXPECT_LT(error, before);
    before = error;
  }
}

TEST(Pwm, DutyForALift) {
  Design<double> d = pwm_design(6.0, 10000.0, 0.0);  // the duty given does not matter
  const RunResult r = run_design(d, {.lift = 20e-3});
  ASSERT_EQ(r.status, FlappingStatus::flapping) << describe(r);
  EXPECT_NEAR(r.metrics[Metric::lift_mean], 20e-3, 1e-6 * 20e-3);
  EXPECT_EQ(r.design.supply.voltage, 6.0);
  EXPECT_NEAR(r.design.supply.duty, r.metrics[Metric::voltage] / 6.0, 1e-12);
  EXPECT_GT(r.design.supply.duty, 0.5);
  EXPECT_LT(r.design.supply.duty, 1.0);
  // The duty found lifts as much when the supply really switches.
  const RunResult switched = run_design(r.design, {.method = Method::transient});
  EXPECT_NEAR(switched.metrics[Metric::lift_mean], 20e-3, 2e-3 * 20e-3);
}

TEST(Pwm, VoltageForALift) {
  const RunResult r = run_design(reference_design(), {.tolerance = 1e-9, .lift = 20e-3});
  EXPECT_NEAR(r.metrics[Metric::lift_mean], 20e-3, 1e-9 * 20e-3);
  EXPECT_EQ(r.design.supply.voltage, r.metrics[Metric::voltage]);
}

TEST(Pwm, LiftOutOfReach) {
  try {
    run_design(pwm_design(4.0, 10000.0, 0.5), {.lift = 30e-3});
    FAIL() << "accepted";
  } catch (const ParameterError& e) {
    EXPECT_EQ(e.key(), "supply.voltage");
    EXPECT_EQ(e.reason(),
              "0.03 N of lift takes 5.492 V on average, more than the 4 V that the supply gives at a "
              "duty of 1");
  }
  const RunResult unreachable = run_design(reference_design(), {.lift = 10.0});
  EXPECT_EQ(unreachable.search->outcome, FrequencyOutcome::too_high);
  EXPECT_NE(describe(unreachable).find("10 N cannot be reached inside the domain of validity: it lifts 0.06"),
            std::string::npos)
      << describe(unreachable);
  // Just below the peak over the voltage, which lies between the voltages tried first, a lift can be reached.
  double peak = 0.0;
  for (double v = 9.0; v < 12.0; v += 0.05) {
    Design<double> d = reference_design();
    d.supply.voltage = v;
    peak = std::max(peak, run_design(d).metrics[Metric::lift_mean]);
  }
  const RunResult top = run_design(reference_design(), {.lift = 0.9999 * peak});
  ASSERT_EQ(top.search->outcome, FrequencyOutcome::reached) << describe(top);
  EXPECT_NEAR(top.metrics[Metric::lift_mean], 0.9999 * peak, 1e-6 * peak);
  EXPECT_EQ(run_design(reference_design(), {.lift = 1.001 * peak}).search->outcome, FrequencyOutcome::too_high);
  Design<double> held = reference_design();
  held.motor.constants.friction_torque = 1.0;
  const RunResult high = run_design(held, {.lift = 20e-3});
  ASSERT_EQ(high.search->outcome, FrequencyOutcome::reached) << describe(high);
  EXPECT_GT(high.metrics[Metric::voltage], 9.0 / 0.01);  // R_a T_c / K, where the motor starts at all
  Design<double> jams = reference_design();
  jams.motor.constants.inertia = 1e-9;
  jams.friction.coefficient = 5e-3;
  const RunResult never = run_design(jams, {.lift = 20e-3});
  EXPECT_EQ(never.status, FlappingStatus::jammed);
  EXPECT_EQ(never.search->outcome, FrequencyOutcome::never_flaps);
  EXPECT_THROW(run_design(reference_design(), {.frequency = 20.0, .lift = 20e-3}), ParameterError);
  EXPECT_THROW(run_design(reference_design(), {.lift = -1.0}), ParameterError);
}

}  // namespace
}  // namespace wingbeat

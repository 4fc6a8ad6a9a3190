// What the reproduced figures are computed from.
#include <gmock/gmock.h>

#include <cmath>

#include "wingbeat/report/energy_flow.hpp"
#include "wingbeat/reproduction/claims.hpp"
#include "wingbeat/study/reproduction.hpp"

namespace wingbeat {
namespace {

const ForEach one_by_one = [](std::size_t count, const std::function<void(std::size_t)>& act) {
  for (std::size_t n = 0; n < count; ++n) act(n);
};

RunResult tight(const Design<double>& design) {
  RunOptions options;
  options.tolerance = 1e-9;
  return run_design(design, options);
}

SpringPair pair() {
  const PublishedFile file = read_published(WINGBEAT_DATA "/published/friction2022.toml");
  return {file.designs.at("spring_off"), file.designs.at("spring_on")};
}

const Reproduction& computed() {
  static const Reproduction r = reproduce(pair(), {.coarse = true}, one_by_one);
  return r;
}

TEST(Reproduction, EnergyFlowsClose) {
  ASSERT_EQ(computed().at_frequency.size(), 4U);
  for (const CycleCase& c : computed().at_frequency) {
    const EnergyFlow f = energy_flow(energy_audit(c.run.metrics));
    double after_motor = f.supply, after_transmission = f.motor_output;
    for (const EnergyBranch& b : f.motor) after_motor -= b.power;
    for (const EnergyBranch& b : f.transmission) after_transmission -= b.power;
    EXPECT_NEAR(after_motor, f.motor_output, 1e-12 * f.supply);
    EXPECT_NEAR(after_transmission, f.air, 1e-7 * f.supply);
    // A constant friction of the motor aside, which this one lacks, it is the motor output of eq (16).
    EXPECT_NEAR(f.motor_output, c.run.metrics[Metric::power_motor], 1e-7 * f.supply);
    const double residual = f.transmission[1].power;
    if (c.flapping_case.formulation == Formulation::virtual_work) EXPECT_NEAR(residual, 0.0, 1e-9 * f.supply);
    else EXPECT_GT(residual, 0.02 * f.supply);
  }
}

TEST(Reproduction, WhatWingsAndSpringsStoreComesBack) {
  for (const auto* cycles : {&computed().at_frequency, &computed().at_voltage}) {
    for (const CycleCase& c : *cycles) {
      const auto& rows = c.run.cycle;
      double net = 0.0, magnitude = 0.0;
      for (std::size_t n = 1; n < rows.size(); ++n) {
        const double dt = rows[n].time - rows[n - 1].time;
        net += 0.5 * dt * (c.stored_power[n] + c.stored_power[n - 1]);
        magnitude += 0.5 * dt * (std::abs(c.stored_power[n]) + std::abs(c.stored_power[n - 1]));
      }
      const double period = rows.back().time;
      EXPECT_NEAR(net, 0.0, 1e-3 * magnitude);  // of 91 rows by trapezoids
      EXPECT_NEAR(magnitude / period, c.run.metrics[Metric::power_reactive], 0.01 * magnitude / period);
    }
  }
}

TEST(Reproduction, ScansAgreeWithSingleRuns) {
  const Reproduction& r = computed();
  for (const CycleCase& cycle : r.at_frequency) {
    for (const TrendCurve& curve : r.frequency.curves) {
      if (!(curve.flapping_case == cycle.flapping_case)) continue;
      for (std::size_t n = 0; n < r.frequency.axis.size(); ++n) {
        if (r.frequency.axis[n] != r.options.frequency) continue;
        for (const Metric m : {Metric::power_electrical, Metric::lift_mean, Metric::rod_force_peak}) {
          EXPECT_NEAR(curve.metrics[n][m] / cycle.run.metrics[m], 1.0, 1e-6);
        }
      }
    }
  }
}

TEST(Reproduction, EachLawIsCalibratedToTheFrequency) {
  const Design<double> design = pair()[0];
  for (const FrictionLaw law : compared_friction_laws) {
    const CalibratedLaw c = calibrate_friction(design, law, 21.7);
    EXPECT_EQ(c.calibrated, law != FrictionLaw::none);
    if (law == FrictionLaw::none) {
      EXPECT_GT(c.frequency, 26.0);
    } else {
      EXPECT_NEAR(c.frequency, 21.7, 1e-7);
      Design<double> with = design;
      with.friction = {law, c.coefficient};
      EXPECT_NEAR(tight(with).metrics[Metric::frequency], 21.7, 1e-6);
    }
  }
  // Faster than the vehicle is without any friction: no coefficient will do.
  EXPECT_FALSE(calibrate_friction(design, FrictionLaw::viscous, 30.0).calibrated);
}

TEST(Reproduction, MoreDragCanStandInForFriction) {
  Design<double> design = pair()[0];
  design.friction = {FrictionLaw::none, 0.0};
  const double factor = calibrate_drag(design, 21.7);
  EXPECT_NEAR(factor, 2.26, 5e-3);
  EXPECT_NEAR(tight(with_drag_factor(design, factor)).metrics[Metric::frequency], 21.7, 1e-6);
  EXPECT_EQ(resolve(with_drag_factor(design, factor)).wings.s2, resolve(design).wings.s2);
  EXPECT_FALSE(std::isfinite(calibrate_drag(design, 30.0)));  // faster than with the drag as it is
}

TEST(Reproduction, OnlyLoadProportionalFrictionAnswersToTheForce) {
  const Design<double> design = pair()[0];
  const double stiffness = *pair()[1].spring.stiffness;
  for (const FrictionLaw law : compared_friction_laws) {
    Design<double> d = design;
    d.friction = {law, calibrate_friction(design, law, 21.7).coefficient};
    const LossCurve curve = loss_along_stiffness(d, 22.0, stiffness, 3);
    const double off = curve.metrics.front()[Metric::power_friction], on = curve.metrics.back()[Metric::power_friction];
    if (law == FrictionLaw::load_proportional) EXPECT_LT(on, 0.7 * off);
    else EXPECT_NEAR(on, off, 0.05 * off);  // the crank turns more evenly: the mean of omega^3 falls a little
  }
}

TEST(Reproduction, TheBestConstantLoadOfAMotorHasAClosedForm) {
  const Motor<double> m = resolve(pair()[0]).motor;
  const double x = m.torque_constant * m.torque_constant / (m.armature_resistance * m.viscous_damping);
  const double root = std::sqrt(1.0 + x);
  EXPECT_NEAR(best_constant_load_efficiency(m, 3.0), (root - 1.0) / (root + 1.0), 1e-7);
}

}  // namespace
}  // namespace wingbeat

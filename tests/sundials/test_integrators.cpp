// SUNDIALS and the project's own steps give the same start-up: status, metrics, events.
#include <gtest/gtest.h>

#include "vehicle/any_start.hpp"
#include "vehicle/pitching_vehicle.hpp"
#include "vehicle/wide_design.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {
namespace {

using Event = TransientEvent::Kind;

TransientResult simulated(const Vehicle<double>& vehicle, TransientOptions options, TimeIntegrator integrator) {
  options.integrator = integrator;
  return simulate_start_up(vehicle, options);
}

TEST(Integrators, AgreeInWideBoxes) {
  for (std::size_t box = 0; box < wide_boxes.size(); ++box) {
    std::mt19937_64 random(11);
    for (int n = 0; n < 15;) {
      Vehicle<double> vehicle;
      try {
        vehicle = resolve(wide_design(WideBox(box), random));
      } catch (const ParameterError&) {
        continue;
      }
      const TransientResult theirs = simulated(vehicle, {}, TimeIntegrator::sundials);
      const TransientResult ours = simulated(vehicle, {}, TimeIntegrator::own_steps);
      SCOPED_TRACE(testing::Message() << wide_boxes[box] << " " << n << ": " << describe(theirs.evidence) << "; "
                                      << describe(ours.evidence));
      EXPECT_EQ(ours.status, theirs.status);
      EXPECT_EQ(ours.settled, theirs.settled);
      ASSERT_EQ(ours.metrics.has_value(), theirs.metrics.has_value());
      if (ours.metrics) {
        EXPECT_LE(metrics_apart(*ours.metrics, *theirs.metrics), 1e-6);
      }
      if (ours.lock_angle && theirs.lock_angle) {
        EXPECT_NEAR(*ours.lock_angle, *theirs.lock_angle, 1e-3);
      }
      ++n;
    }
  }
}

// Beside what every vehicle has, the work of the hinges and Fourier parts of both angles are integrated.
TEST(Integrators, AgreeOnPitchingDirectDrives) {
  std::mt19937_64 random(17);
  for (int n = 0; n < 4; ++n) {
    const Vehicle<double> vehicle = random_pitching_vehicle(random, false);
    const TransientResult theirs = simulated(vehicle, {}, TimeIntegrator::sundials);
    const TransientResult ours = simulated(vehicle, {}, TimeIntegrator::own_steps);
    SCOPED_TRACE(testing::Message() << n << ": " << describe(theirs.evidence) << "; " << describe(ours.evidence));
    EXPECT_EQ(ours.status, theirs.status);
    ASSERT_TRUE(ours.metrics && theirs.metrics);
    for (const Metric m : {Metric::power_electrical, Metric::lift_mean, Metric::power_hinge, Metric::pitch_phase}) {
      EXPECT_NEAR((*ours.metrics)[m], (*theirs.metrics)[m], 1e-6 * std::abs((*theirs.metrics)[m])) << int(m);
    }
  }
}

// Every friction law, pwm supplies, starts in motion and at any angle.
TEST(Integrators, AgreeOnAnyStart) {
  int compared = 0;
  for (unsigned seed = 100; seed < 140; ++seed) {
    const auto [vehicle, options] = any_start(seed);
    const TransientResult theirs = simulated(vehicle, options, TimeIntegrator::sundials);
    const TransientResult ours = simulated(vehicle, options, TimeIntegrator::own_steps);
    SCOPED_TRACE(testing::Message() << "seed " << seed << ": " << describe(theirs.evidence) << "; "
                                    << describe(ours.evidence));
    if (theirs.steps > options.max_steps || ours.steps > options.max_steps) continue;
    EXPECT_EQ(ours.status, theirs.status);
    ++compared;
    if (!ours.metrics || !theirs.metrics) continue;
    // Over cycles that share no period with the supply, averages depend on the phase.
    const double close = options.supply ? 2e-2 : 1e-6;
    for (const Metric m : {Metric::frequency, Metric::power_electrical, Metric::rod_force_peak}) {
      EXPECT_NEAR((*ours.metrics)[m], (*theirs.metrics)[m], close * std::abs((*theirs.metrics)[m])) << int(m);
    }
  }
  EXPECT_GE(compared, 32);
}

TEST(Integrators, SineSuppliesAgree) {
  for (const double frequency : {5.0, 22.0, 150.0}) {
    TransientOptions options;
    options.supply = Supply<double>{SupplyType::sine, 3.0, frequency, 1.0};
    const TransientResult theirs = simulated(reference_vehicle(true), options, TimeIntegrator::sundials);
    const TransientResult ours = simulated(reference_vehicle(true), options, TimeIntegrator::own_steps);
    EXPECT_EQ(ours.status, theirs.status) << describe(ours.evidence) << "; " << describe(theirs.evidence);
  }
}

TEST(Integrators, EventsAgree) {
  Vehicle<double> sticking = reference_vehicle();
  sticking.motor.friction_torque = 3.3e-3;
  Vehicle<double> locking = reference_vehicle();
  locking.spring.stiffness = 0.02;
  Vehicle<double> jamming = reference_vehicle();
  jamming.motor.inertia = 1e-9;
  jamming.friction.radius = 3e-3;
  for (const Vehicle<double>& vehicle : {reference_vehicle(), reference_vehicle(true), sticking, locking, jamming}) {
    TransientOptions options;
    options.tolerance = 1e-9;
    const TransientResult theirs = simulated(vehicle, options, TimeIntegrator::sundials);
    const TransientResult ours = simulated(vehicle, options, TimeIntegrator::own_steps);
    EXPECT_EQ(ours.status, theirs.status) << describe(ours.evidence) << "; " << describe(theirs.evidence);
    const std::size_t events = std::min(ours.events.size(), theirs.events.size());
    EXPECT_GT(events, 0u);
    for (std::size_t k = 0; k < events; ++k) {
      EXPECT_EQ(ours.events[k].kind, theirs.events[k].kind) << k;
      EXPECT_NEAR(ours.events[k].time, theirs.events[k].time, 1e-7 * theirs.events[k].time + 1e-9) << k;
      EXPECT_NEAR(ours.events[k].crank_angle, theirs.events[k].crank_angle, 1e-6) << k;
    }
    EXPECT_NEAR(ours.inrush_current, theirs.inrush_current, 1e-7 * theirs.inrush_current);
  }
}

TEST(Integrators, JudgeAlikeNearLocking) {
  int flapping = 0, others = 0;
  for (int n = 0; n < 15; ++n) {
    for (const double stiffness : {1e-3, 3e-3, 6e-3}) {
      for (const double crank_radius : {4e-3, 6e-3, 8e-3}) {
        Design<double> design = reference_design();
        design.supply.voltage = 0.6 + 0.3 * n;
        design.spring.stiffness = stiffness;
        design.transmission.crank_radius = crank_radius;
        const Vehicle<double> vehicle = resolve(design);
        const auto assessed = [&](TimeIntegrator integrator) {
          return find_steady_flapping(vehicle, {}, start_up_in_time(1e-6, integrator)).status;
        };
        const FlappingStatus status = assessed(TimeIntegrator::sundials);
        EXPECT_EQ(assessed(TimeIntegrator::own_steps), status) << n << " " << stiffness << " " << crank_radius;
        ++(status == FlappingStatus::flapping ? flapping : others);
      }
    }
  }
  EXPECT_GT(flapping, 30);
  EXPECT_GT(others, 30);
}

}  // namespace
}  // namespace wingbeat

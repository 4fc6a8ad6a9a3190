// The models in time, stepped to any moment and back, without a decision.
#include "time/event_loop.hpp"

#include <gtest/gtest.h>

#include "time/time_model.hpp"
#include "vehicle/random_vehicle.hpp"

namespace wingbeat {
namespace {

using detail::TimeModel, detail::step_to, detail::StepOutcome;

Supply<double> constant(double voltage) { return {SupplyType::constant, voltage, 0.0, 1.0}; }

TimeModel started(const Vehicle<double>& vehicle, const Supply<double>& supply = {}) {
  TimeModel model(vehicle, supply);
  model.start({});
  return model;
}

/// The samples of a recorded start-up by its own steps, met by steps to each of their moments.
template <class Compare>
void meets(TimeModel model, const Vehicle<double>& vehicle, TransientOptions options, double until,
           const Compare& compare) {
  options.tolerance = 1e-8;
  options.record = true;
  options.record_interval = 7e-4;
  options.integrator = TimeIntegrator::own_steps;
  const TransientResult recorded = simulate_start_up(vehicle, options);
  int compared = 0;
  for (const TransientSample& s : recorded.samples) {
    if (s.time == 0.0 || s.time > until) continue;
    ASSERT_EQ(step_to(model, s.time, 1e-10), StepOutcome::reached) << s.time;
    EXPECT_EQ(model.now.t, s.time);
    compare(model, s);
    ++compared;
  }
  EXPECT_GT(compared, 10) << describe(recorded.evidence);
}

void crank_meets(const Vehicle<double>& vehicle, const Supply<double>& supply, double until) {
  TransientOptions options;
  options.supply = supply;
  meets(started(vehicle, supply), vehicle, options, until, [](const TimeModel& model, const TransientSample& s) {
    // Under a sine a standstill is recorded to the end of the 64th of a period within which it ends.
    if (model.supply.type == SupplyType::sine && s.crank_speed == 0.0) return;
    EXPECT_NEAR(model.now.moving.angle, s.crank_angle, 1e-6) << s.time;
    EXPECT_NEAR(model.now.moving.speed, s.crank_speed, 1e-4) << s.time;
    EXPECT_NEAR(model.now.moving.current, s.current, 1e-6) << s.time;
  });
}

TEST(Simulation, MeetsStartUpAtEveryMoment) {
  Vehicle<double> sticking = reference_vehicle();
  sticking.motor.friction_torque = 3.3e-3;
  Vehicle<double> swinging = reference_vehicle();  // back and forth until the springs hold it
  swinging.spring.stiffness = 0.02;
  Vehicle<double> direct_current = reference_vehicle(true);
  direct_current.motor.armature_inductance = 0.0;
  for (const Vehicle<double>& v : {reference_vehicle(), reference_vehicle(true), sticking, swinging, direct_current}) {
    crank_meets(v, constant(3.0), 0.2);
  }
  crank_meets(reference_vehicle(true), {SupplyType::pwm, 4.0, 493.0, 0.75}, 0.1);
  crank_meets(direct_current, {SupplyType::pwm, 4.0, 493.0, 0.75}, 0.1);
  crank_meets(swinging, {SupplyType::sine, 3.0, 22.0, 1.0}, 0.1);
}

TEST(Simulation, MeetsStartUpOfDirectDrives) {
  std::mt19937_64 random(4);
  for (int n = 0; n < 12; ++n) {
    const Vehicle<double> v = resolve(random_direct_design(random, n % 2 == 1));
    TimeModel model = started(v);
    const double speed = model.speed_scale, stroke = model.angle_scale, current = model.current_scale;
    meets(model, v, {}, 0.1, [&](const TimeModel& now, const TransientSample& s) {
      EXPECT_NEAR(now.now.moving.angle, s.crank_angle, 1e-6 * stroke) << n << " " << s.time;
      EXPECT_NEAR(now.now.moving.speed, s.crank_speed, 1e-5 * speed) << n << " " << s.time;
      EXPECT_NEAR(now.now.moving.current, s.current, 1e-5 * current) << n << " " << s.time;
    });
  }
}

TEST(Simulation, ComesBackToTheSameBits) {
  Vehicle<double> swinging = reference_vehicle();
  swinging.spring.stiffness = 0.02;
  swinging.motor.friction_torque = 1e-4;
  for (const Supply<double>& supply :
       {constant(3.0), Supply<double>{SupplyType::pwm, 4.0, 500.0, 0.75}, {SupplyType::sine, 3.0, 22.0, 1.0}}) {
    for (const Vehicle<double>& v : {reference_vehicle(true), swinging}) {
      TimeModel model = started(v, supply);
      ASSERT_EQ(step_to(model, 0.0313, 1e-8), StepOutcome::reached);
      const TimeModel::State saved = model.now;
      TimeModel::State reached[2];
      for (TimeModel::State& state : reached) {
        model.now = saved;
        ASSERT_EQ(step_to(model, 0.05, 1e-8), StepOutcome::reached);
        ASSERT_EQ(step_to(model, 0.08, 1e-8), StepOutcome::reached);
        state = model.now;
      }
      EXPECT_EQ(reached[0].moving.angle, reached[1].moving.angle);
      EXPECT_EQ(reached[0].moving.speed, reached[1].moving.speed);
      EXPECT_EQ(reached[0].moving.current, reached[1].moving.current);
      EXPECT_EQ(reached[0].switches, reached[1].switches);
    }
  }
  std::mt19937_64 random(9);
  for (int n = 0; n < 8; ++n) {
    TimeModel model = started(resolve(random_direct_design(random, n % 2 == 1)));
    ASSERT_EQ(step_to(model, 0.0313, 1e-8), StepOutcome::reached);
    const TimeModel::State saved = model.now;
    ASSERT_EQ(step_to(model, 0.08, 1e-8), StepOutcome::reached);
    const TimeModel::State first = model.now;
    model.now = saved;
    ASSERT_EQ(step_to(model, 0.08, 1e-8), StepOutcome::reached);
    EXPECT_EQ(model.now.moving.angle, first.moving.angle);
    EXPECT_EQ(model.now.moving.speed, first.moving.speed);
    EXPECT_EQ(model.now.moving.current, first.moving.current);
  }
}

TEST(Simulation, StandsWhereFrictionHolds) {
  Vehicle<double> v = reference_vehicle();
  v.motor.friction_torque = 3.4e-3;  // above the stall torque
  TimeModel model = started(v, constant(3.0));
  ASSERT_EQ(step_to(model, 1.0, 1e-8), StepOutcome::reached);
  EXPECT_TRUE(model.now.stuck);
  EXPECT_EQ(model.now.moving.angle, 0.0);
  EXPECT_NEAR(model.now.moving.current, 3.0 / 9.0, 1e-9);
}

TEST(Simulation, EndsWhereItJams) {
  Vehicle<double> v = reference_vehicle();
  v.motor.inertia = 1e-9;
  v.friction.radius = 3e-3;
  TimeModel model = started(v, constant(3.0));
  EXPECT_EQ(step_to(model, 1.0, 1e-8), StepOutcome::ended);
  EXPECT_LT(model.now.t, 1.0);
  const TransientResult r = simulate_start_up(v);
  ASSERT_EQ(r.status, FlappingStatus::jammed);
  EXPECT_NEAR(model.now.moving.angle, r.end_crank_angle, 1e-6);
}

TEST(Simulation, MotorTooHotToHaveAFieldStands) {
  Design<double> design = reference_design();
  design.motor.thermal.resistance_winding = 20.0;
  design.motor.thermal.resistance_case = 48.0;
  design.motor.thermal.magnet_temperature_coefficient = -1e-3;
  const Vehicle<double> hot = with_motor_at(resolve(design), {1500.0, 1400.0});
  ASSERT_EQ(hot.motor.torque_constant, 0.0);
  TransientOptions options;
  options.supply = constant(3.0);
  const TransientResult result = simulate_start_up(hot, options);
  EXPECT_EQ(result.status, FlappingStatus::stalled);
  EXPECT_TRUE(result.settled);
  EXPECT_EQ(result.evidence.torque, 0.0);
}

}  // namespace
}  // namespace wingbeat

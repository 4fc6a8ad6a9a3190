// A direct drive with wings that pitch in time: against the orbit, with and without stops; energy of a free swing.
#include <gtest/gtest.h>

#include <random>

#include "time/event_loop.hpp"
#include "time/time_model.hpp"
#include "vehicle/pitching_vehicle.hpp"
#include "vehicle/recorded_impacts.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/solve/periodic.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

std::array<double, max_unknowns> state_of(const detail::TimeModel& model) {
  std::array<double, max_unknowns> y{};
  model.unknowns(y.data());
  return y;
}

using detail::TimeModel, detail::step_to, detail::StepOutcome;

// From rest, through every impact, to the orbit that the search finds without it.
TEST(PitchingInTime, ReachesTheOrbitFromRest) {
  using System = PitchDirectSystem<double, 5>;
  for (const double stop : {infinity, 0.5}) {
    Vehicle<double> v = pitching_vehicle(2e-4);
    set_stops(v.pitch.hinge, stop);
    const System system{v, {0.5, 60.0, 0.1, 0.5, 60.0}};
    solver::Iterate<System> cycle;
    const auto found = solver::solve_periodic(system, {}, {.tolerance = 1e-10, .max_steps = 2000}, cycle);
    ASSERT_EQ(found.status, solver::PeriodicStatus::converged) << describe(found.status);

    TimeModel model(v, {});
    model.start({});
    constexpr int periods = 30;
    ASSERT_EQ(step_to(model, periods * model.time_scale, 1e-11), StepOutcome::reached);
    const double sizes[] = {0.5, 60.0, 0.1, 0.5, 60.0};
    for (std::size_t n = 0; n < 5; ++n) {
      EXPECT_NEAR(state_of(model)[n], cycle.steps.front().y[n], 1e-6 * sizes[n]) << n << ", stop " << stop;
    }
    // One more period, by what each says that impacts take.
    const double before = model.now.impact_loss;
    ASSERT_EQ(step_to(model, (periods + 1) * model.time_scale, 1e-11), StepOutcome::reached);
    EXPECT_EQ(before > 0.0, stop < infinity);
    EXPECT_NEAR(model.now.impact_loss - before, impact_loss(system, cycle), 1e-6 * before);
  }
}

// Friction that holds the wings on a shaft at rest does not hold them any more at once as the shaft sets off: what it
// would have to exceed jumps with the acceleration.
TEST(PitchingInTime, FrictionLetsGoOfTheWingsAsTheCrankSetsOff) {
  const Vehicle<double> hinged = pitching_vehicle(2e-4);
  Vehicle<double> v = resolve(reference_design());
  v.wings = hinged.wings;
  v.pitch = hinged.pitch;
  v.pitch.hinge.friction = 1e-9;
  v.motor.armature_inductance = 0.0;
  Vehicle<double> without = v;
  without.pitch.hinge.friction = 0.0;
  TimeModel model(v, {SupplyType::constant, v.voltage, 0.0, 1.0}), frictionless(without, model.supply);
  const double soon = 0.02 * model.time_scale;
  for (TimeModel* m : {&model, &frictionless}) {
    m->start({});
    ASSERT_EQ(step_to(*m, soon, 1e-9, TimeIntegrator::automatic), StepOutcome::reached);
  }
  EXPECT_FALSE(model.now.held);
  ASSERT_GT(std::abs(frictionless.now.moving.pitch_angle), 1e-5);
  EXPECT_NEAR(model.now.moving.pitch_angle / frictionless.now.moving.pitch_angle, 1.0, 1e-3);
}

TEST(PitchingInTime, ReachesTheOrbitsOfRandomVehicles) {
  using System = PitchDirectSystem<double, 5>;
  std::mt19937_64 random(2611);
  int stopped = 0;
  for (int n = 0; n < 60; ++n) {
    const Vehicle<double> v = random_pitching_vehicle(random, n % 2 == 1);
    validate(v.pitch, v.wing_count * v.wing_inertia);
    const System system{v, {0.5, 60.0, 0.1, 0.5, 60.0}};
    solver::Iterate<System> cycle;
    const auto found = solver::solve_periodic(system, {}, {.tolerance = 1e-9, .max_steps = 2000}, cycle);
    ASSERT_EQ(found.status, solver::PeriodicStatus::converged) << n << ": " << describe(found.status);
    stopped += impact_loss(system, cycle) > 0.0;
    // What is left of the start after so many periods is a ten-millionth.
    const double periods = std::ceil(std::max(20.0, std::log(1e-7) / std::log(found.floquet_multiplier_max)));
    TimeModel model(v, {});
    model.start({});
    ASSERT_EQ(step_to(model, periods * model.time_scale, 1e-10), StepOutcome::reached) << n;
    const double sizes[] = {0.5, 60.0, 0.1, 0.5, 60.0};
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_NEAR(state_of(model)[k], cycle.steps.front().y[k], 1e-6 * sizes[k]) << "vehicle " << n << ", state " << k;
    }
  }
  EXPECT_GE(stopped, 10);
}

// No supply, no damping, no air: a free swing keeps its energy, to what impacts take of it.
TEST(PitchingInTime, FreeSwingKeepsItsEnergy) {
  for (const double stop : {infinity, 0.6}) {
    Vehicle<double> v = pitching_vehicle(2e-4, 0.0, Condition::vacuum);
    v.motor.viscous_damping = v.friction.damping = v.pitch.hinge.damping = 0.0;
    v.motor.armature_inductance = 0.0;
    v.motor.armature_resistance = 1e15;
    set_stops(v.pitch.hinge, stop);
    TimeModel model(v, {});
    model.start({0.8, 0.0, 0.0, 0.3, 100.0});
    const double before = model.stored_energy();
    ASSERT_EQ(step_to(model, 3.0 * model.time_scale, 1e-12), StepOutcome::reached);
    EXPECT_NEAR(model.stored_energy() + model.now.impact_loss, before, 1e-9 * before);
    EXPECT_EQ(model.now.impact_loss > 0.0, stop < infinity);
  }
}

// Bit-identical from a saved state.
TEST(PitchingInTime, RepeatsFromASavedState) {
  Vehicle<double> v = pitching_vehicle(2e-4);
  set_stops(v.pitch.hinge, 0.5);
  TimeModel model(v, {});
  model.start({});
  ASSERT_EQ(step_to(model, 2.3 * model.time_scale, 1e-9), StepOutcome::reached);
  const TimeModel::State saved = model.now;
  ASSERT_EQ(step_to(model, 4.7 * model.time_scale, 1e-9), StepOutcome::reached);
  const auto first = state_of(model);
  const double first_loss = model.now.impact_loss;
  model.now = saved;
  ASSERT_EQ(step_to(model, 4.7 * model.time_scale, 1e-9), StepOutcome::reached);
  EXPECT_EQ(state_of(model), first);
  EXPECT_EQ(model.now.impact_loss, first_loss);
}

}  // namespace
}  // namespace wingbeat

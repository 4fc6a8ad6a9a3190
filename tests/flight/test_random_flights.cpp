// Vehicles drawn at random: each is trimmed, and what the trim claims is seen in the simulation of the flight.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "flight/flight_vehicles.hpp"
#include "wingbeat/flight/stability.hpp"

namespace wingbeat {
namespace {

/// A vehicle with body, wings and drive up to a fifth larger or smaller than that of the name.
Design<double> random_flyer(const char* name, std::mt19937_64& random) {
  Design<double> d = flying_design(name);
  const auto vary = [&](double& x, double part) { x *= 1.0 + std::uniform_real_distribution<>(-part, part)(random); };
  vary(*d.mass, 0.1);
  vary(*d.body.inertia_roll, 0.1), vary(*d.body.inertia_pitch, 0.1), vary(*d.body.inertia_yaw, 0.1);
  vary(d.body.shoulder_above, 0.5), vary(d.body.shoulder_aside, 0.3);
  d.body.shoulder_ahead = std::uniform_real_distribution<>(-5e-4, 5e-4)(random);
  d.body.stroke_plane_tilt = std::uniform_real_distribution<>(-0.1, 0.1)(random);
  vary(d.wing.inertia, 0.1), vary(d.motor.constants.armature_resistance, 0.1);
  vary(d.motor.constants.torque_constant, 0.1);
  vary(d.aerodynamics.pitch_coefficient, 0.1);
  vary(d.friction.coefficient, 0.2);
  d.body.drag_area_forward = std::uniform_real_distribution<>(0.0, 1e-3)(random);
  d.body.tail.area = std::uniform_real_distribution<>(1e-4, 1e-3)(random);
  d.body.tail.behind = 0.05;
  d.body.fin.area = 5e-4;
  d.body.fin.behind = 0.05;
  return d;
}

/// Mean accelerations over ten wingbeats of the body held, from where the trim has the drives.
Triple held_acceleration(const FlightVehicle& v, const TrimResult& t) {
  FlightSimulation held(v, {.tolerance = 1e-9, .frozen = true});
  held.command(t.controls);
  std::vector<Coordinates<double>> drives;
  for (const DriveCycle& cycle : t.flight->cycles) drives.push_back(cycle.start);
  const BodyState body = steady_body(t.condition, t.roll, t.pitch);
  held.start(body, drives);
  const double span = 10.0 * t.flight->cycles[0].period;
  held.step_to(span);
  BodyLoads mean;
  for (std::size_t k = 0; k < 3; ++k) {
    mean.force[k] = held.totals().force[k] / span, mean.moment[k] = held.totals().moment[k] / span;
  }
  return mean_acceleration(v.body, body, mean).linear;
}

TEST(RandomFlights, AreInTrimAsTheSimulationHasIt) {
  std::mt19937_64 random(20785);
  for (int n = 0; n < 20; ++n) {
    const char* name = n % 2 == 0 ? "friction2022" : "x-wing";
    const Design<double> d = random_flyer(name, random);
    ASSERT_NO_THROW(validate(d)) << n;
    AveragedFlight flight(flight_vehicle(d));
    const double speed = n % 4 < 2 ? 0.0 : 0.3;
    const TrimResult t = trim(flight, {.speed = speed});
    ASSERT_TRUE(t.status == TrimStatus::trimmed || t.status == TrimStatus::beyond_controls) << n << ' ' << t.detail;
    for (const double a : held_acceleration(flight.vehicle(), t)) EXPECT_NEAR(a, 0.0, 1e-5 * standard_gravity) << n;
  }
}

TEST(RandomFlights, LinearModelsAreDifferencesOfTheSimulation) {
  std::mt19937_64 random(20786);
  for (int n = 0; n < 2; ++n) {
    Design<double> d = random_flyer("friction2022", random);
    // Drag of the body about rest has a slope over a step that it does not have at rest.
    d.body.drag_area_forward = 0.0;
    d.body.tail = {}, d.body.fin = {};
    AveragedFlight flight(flight_vehicle(d), {.tolerance = 1e-11});
    const TrimResult t = trim(flight, {});
    ASSERT_TRUE(t.flight) << n;
    const std::optional<FlightLinearModel> model = linear_flight(flight, t);
    ASSERT_TRUE(model) << n;
    // Heave and surge: the drive settles in the simulation by itself, in time.
    const BodyState body = steady_body({}, t.roll, t.pitch);
    const auto settled = [&](std::size_t axis, double by) {
      BodyState moved = body;
      moved.velocity[axis] += by;
      FlightSimulation held(flight.vehicle(), {.tolerance = 1e-10, .frozen = true});
      held.command(t.controls);
      held.start(moved, {t.flight->cycles[0].start});
      const double start = t.flight->cycles[0].start.angle;
      // Whole turns by the crank itself: a mean between two passages of the start's angle.
      constexpr int turns = 41;
      double T = 0.0;
      FlightTotals before;
      for (int turn = 1; turn <= turns; ++turn) {
        double next = held.time() + 0.999 * t.flight->cycles[0].period;
        for (int iteration = 0; iteration < 40; ++iteration) {
          FlightSimulation ahead = held;
          ahead.step_to(next);
          const Coordinates<double> there = ahead.state().drives[0];
          const double gap = start + two_pi * turn - there.angle;
          if (std::abs(gap) < 1e-12) break;
          next += gap / there.speed;
        }
        if (turn == turns) before = held.totals(), T = next - held.time();
        held.step_to(next);
      }
      BodyLoads mean;
      for (std::size_t k = 0; k < 3; ++k) {
        mean.force[k] = (held.totals().force[k] - before.force[k]) / T;
        mean.moment[k] = (held.totals().moment[k] - before.moment[k]) / T;
      }
      return mean_acceleration(flight.vehicle().body, moved, mean);
    };
    const double R = flight.vehicle().drives[0].vehicle.wings.wake.strips.at.back().radius;
    const double step = 1e-3 * two_pi * t.frequency * R;
    for (const std::size_t axis : {std::size_t(0), std::size_t(2)}) {
      const MeanAcceleration high = settled(axis, step), low = settled(axis, -step);
      const auto column = model->A.col(Eigen::Index(axis));
      const double size = column.head<3>().cwiseAbs().maxCoeff();
      EXPECT_NEAR((high.linear[axis] - low.linear[axis]) / (2.0 * step), column[Eigen::Index(axis)], 1e-6 * size) << n;
    }
  }
}

TEST(RandomFlights, SidesThatDifferAreTrimmedByDifferentControls) {
  const Design<double> both = flying_design("purdue");
  Design<double> right = both, left = both;
  right.motor.constants.armature_resistance *= 1.04;
  left.wing.inertia *= 1.02;
  AveragedFlight flight(flight_vehicle(both, &right, &left));
  const TrimResult t = trim(flight, {});
  ASSERT_EQ(t.status, TrimStatus::trimmed) << t.detail;
  EXPECT_GT(std::abs(t.controls[FlightControl::voltage_difference]), 0.01);
  for (const double a : t.angular_acceleration) EXPECT_NEAR(a, 0.0, 0.2);
  for (const double a : held_acceleration(flight.vehicle(), t)) EXPECT_NEAR(a, 0.0, 1e-5 * standard_gravity);
}

}  // namespace
}  // namespace wingbeat

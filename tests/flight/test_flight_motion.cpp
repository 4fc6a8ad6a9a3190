// Body and wings in time: closed forms, what is conserved, symmetries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "flight/flight_vehicles.hpp"
#include "wingbeat/flight/simulation.hpp"
#include "wingbeat/flight/wing_reaction.hpp"

namespace wingbeat {
namespace {

using testing::DoubleNear;
using testing::Pointwise;

constexpr double g = standard_gravity;

FlightVehicle without_air(FlightVehicle v) {
  for (FlightDrive& drive : v.drives) drive.vehicle.wings.air_density = 0.0;
  v.body.air_density = 0.0;
  return v;
}

TEST(FlightMotion, FallsAsGravityHasIt) {
  FlightSimulation flight(without_air(flying("friction2022")));
  flight.command({});
  BodyState thrown;
  thrown.velocity = {1.0, 0.5, -2.0};
  thrown.rates = {3.0, 0.0, 0.0};
  flight.start(thrown);
  ASSERT_TRUE(flight.step_to(0.8));
  const Triple place = flight.state().body.position;
  EXPECT_NEAR(place[0], 0.8, 1e-9);
  EXPECT_NEAR(place[1], 0.4, 1e-9);
  EXPECT_NEAR(place[2], 0.5 * g * 0.64 - 1.6, 1e-9);
  EXPECT_NEAR(euler_angles(flight.state().body.attitude)[0], 2.4, 1e-9);
}

TEST(FlightMotion, DragHoldsTheFallBack) {
  FlightVehicle v = without_air(flying("friction2022"));
  v.body.air_density = 1.2;
  v.body.drag_area = {0.0, 0.0, 2e-3};
  FlightSimulation flight(v, {.tolerance = 1e-10});
  flight.command({});
  flight.start({});
  ASSERT_TRUE(flight.step_to(1.5));
  const double terminal = std::sqrt(2.0 * v.body.mass * g / (1.2 * 2e-3));
  EXPECT_NEAR(flight.state().body.velocity[2], terminal * std::tanh(1.5 * g / terminal), 1e-9);
  EXPECT_NEAR(flight.state().body.position[2], terminal * terminal / g * std::log(std::cosh(1.5 * g / terminal)), 1e-9);
}

TEST(FlightMotion, ATorqueFreeBodyKeepsEnergyAndAngularMomentum) {
  FlightVehicle v = without_air(flying("friction2022"));
  v.body.inertia_product = 1e-7;
  FlightSimulation flight(v, {.tolerance = 1e-10, .gravity = 0.0});
  flight.command({});
  BodyState tumbling;
  tumbling.rates = {4.0, 9.0, -6.0};
  flight.start(tumbling);
  const double energy = body_energy(v.body, tumbling, 0.0);
  const Triple momentum = to_earth(tumbling.attitude, inertia_times(v.body, tumbling.rates));
  ASSERT_TRUE(flight.step_to(2.0));
  const BodyState now = flight.state().body;
  EXPECT_NEAR(body_energy(v.body, now, 0.0), energy, 1e-8 * energy);
  const Triple later = to_earth(now.attitude, inertia_times(v.body, now.rates));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(later[k], momentum[k], 1e-8 * std::abs(momentum[1]));
}

TEST(FlightMotion, WingsWithMassKeepMomentumAndEnergyInVacuum) {
  const FlightVehicle v = lossless_vehicle();
  FlightSimulation flight(v, {.tolerance = 1e-10, .gravity = 0.0});
  flight.command({});
  BodyState moving;
  moving.velocity = {0.3, -0.2, 0.1};
  moving.rates = {3.0, -2.0, 4.0};
  Coordinates<double> right, left;
  right.angle = 0.7, right.speed = 20.0, left.angle = -0.4, left.speed = -60.0;
  flight.start(moving, {right, left});
  const auto momenta = [&] {
    const FlightState s = flight.state();
    std::vector<const OnsetFlow*> flows;
    std::vector<StrokeOnBody> strokes;
    for (std::size_t n = 0; n < 2; ++n) {
      flows.push_back(&v.drives[n].flow);
      strokes.push_back({s.drives[n].angle, s.drives[n].speed, 0.0, 0.0});
    }
    BodyLoads p = momentum_with_wings(v, flows, strokes, s.body);
    const Triple linear = to_earth(s.body.attitude, p.force);
    Triple angular = to_earth(s.body.attitude, p.moment);
    const Triple of_place = cross(s.body.position, linear);
    for (std::size_t k = 0; k < 3; ++k) angular[k] += of_place[k];
    return std::pair{linear, angular};
  };
  const double energy = flight.stored_energy();
  const auto [linear, angular] = momenta();
  ASSERT_TRUE(flight.step_to(0.3));
  EXPECT_NEAR(flight.stored_energy(), energy, 1e-8 * energy);
  const auto [linear_after, angular_after] = momenta();
  EXPECT_THAT(linear_after, Pointwise(DoubleNear(1e-10), linear));
  EXPECT_THAT(angular_after, Pointwise(DoubleNear(1e-11), angular));
  // The body is shaken: its own velocity is not that of the start.
  EXPECT_GT(std::abs(flight.state().body.rates[2] - 4.0), 0.1);
}

TEST(FlightMotion, TheMirrorImageFliesAsTheMirrorImage) {
  for (const char* name : flying_names) {
    BodyState body;
    body.velocity = {0.4, 0.3, -0.2};
    body.rates = {2.0, -1.0, 1.5};
    body.attitude = attitude_of({0.2, 0.1, 0.3});
    FlightSimulation flight(flying(name), {.tolerance = 1e-9}), mirror(flying(name), {.tolerance = 1e-9});
    flight.start(body);
    mirror.start(mirrored(body));
    ASSERT_TRUE(flight.step_to(0.1));
    ASSERT_TRUE(mirror.step_to(0.1));
    const BodyState expected = mirrored(flight.state().body), found = mirror.state().body;
    EXPECT_THAT(found.velocity, Pointwise(DoubleNear(1e-6), expected.velocity)) << name;
    EXPECT_THAT(found.rates, Pointwise(DoubleNear(1e-4), expected.rates)) << name;
    EXPECT_THAT(found.position, Pointwise(DoubleNear(1e-7), expected.position)) << name;
  }
}

TEST(FlightMotion, WindIsMotionTheOtherWay) {
  for (const char* name : flying_names) {
    const Triple wind = {-0.8, 0.5, 0.2};
    FlightSimulation in_wind(flying(name), {.tolerance = 1e-9}), moving(flying(name), {.tolerance = 1e-9});
    in_wind.blow([&](double, const Triple&) { return wind; });
    BodyState body;
    body.attitude = attitude_of({0.1, -0.2, 0.4});
    in_wind.start(body);
    BodyState against = body;
    against.velocity = to_body(body.attitude, {-wind[0], -wind[1], -wind[2]});
    moving.start(against);
    ASSERT_TRUE(in_wind.step_to(0.12));
    ASSERT_TRUE(moving.step_to(0.12));
    const BodyState a = in_wind.state().body, b = moving.state().body;
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a.position[k] - wind[k] * 0.12, b.position[k], 1e-7) << name;
    EXPECT_THAT(a.rates, Pointwise(DoubleNear(1e-4), b.rates)) << name;
  }
}

TEST(FlightMotion, EnergyBalances) {
  for (const char* name : flying_names) {
    FlightSimulation flight(flying(name), {.tolerance = 1e-8});
    flight.start({});
    const double before = flight.stored_energy();
    ASSERT_TRUE(flight.step_to(0.15));
    const FlightTotals& t = flight.totals();
    const double gained = flight.stored_energy() - before;
    const double left = t.electrical - t.motor - t.friction - t.stops - t.wing_air - t.residual + t.body_air - gained;
    EXPECT_NEAR(left, 0.0, 1e-6 * t.electrical) << name;
    EXPECT_GT(t.electrical, 0.0);
  }
}

// Under the pitch law the air turns standing wings otherwise to either side, so that the crank may neither stay nor go
// for a side that is looked at alone.
TEST(FlightMotion, ACrankWithoutVoltageFallsOnABodyThatTumbles) {
  for (const double tolerance : {1e-8, 1e-6, 1e-4}) {
    for (const Triple& rates : {Triple{}, Triple{15.0, -9.0, 4.0}}) {
      FlightSimulation flight(flying("friction2022"), {.tolerance = tolerance});
      flight.command({});
      BodyState thrown;
      thrown.rates = rates;
      flight.start(thrown);
      ASSERT_TRUE(flight.step_to(0.5)) << tolerance;
      EXPECT_GT(flight.state().body.position[2], 0.2);
    }
  }
}

TEST(FlightMotion, WingMassLeavesTheBalanceClosed) {
  Design<double> d = flying_design("friction2022");
  d.body.wing_mass = 0.05e-3;
  d.body.wing_centre = 25e-3;
  FlightSimulation flight(flight_vehicle(d), {.tolerance = 1e-8});
  BodyState body;
  body.rates = {1.0, 2.0, 3.0};
  flight.start(body);
  const double before = flight.stored_energy();
  ASSERT_TRUE(flight.step_to(0.1));
  const FlightTotals& t = flight.totals();
  const double gained = flight.stored_energy() - before;
  EXPECT_NEAR(t.electrical - t.motor - t.friction - t.wing_air - t.residual + t.body_air - gained, 0.0,
              1e-6 * t.electrical);
}

TEST(FlightMotion, CopiesGoTheirOwnWay) {
  FlightSimulation flight(flying("friction2022"));
  ASSERT_TRUE(flight.step_to(0.05));
  FlightSimulation copy = flight;
  ASSERT_TRUE(flight.step_to(0.08));
  const Triple ahead = flight.state().body.velocity;
  EXPECT_EQ(copy.time(), 0.05);
  ASSERT_TRUE(copy.step_to(0.08));
  EXPECT_EQ(copy.state().body.velocity, ahead);
}

TEST(FlightMotion, RefusesWhatIsNoFlight) {
  EXPECT_THROW(FlightSimulation(flying("friction2022"), {.tolerance = 1.0}), ParameterError);
  FlightSimulation flight(flying("friction2022"));
  EXPECT_THROW(flight.step_to(-1.0), ParameterError);
  FlightControls controls;
  controls[FlightControl::voltage] = absent;
  EXPECT_THROW(flight.command(controls), ParameterError);
  BodyState nowhere;
  nowhere.velocity[0] = absent;
  EXPECT_THROW(flight.start(nowhere), ParameterError);
}

}  // namespace
}  // namespace wingbeat

// Controllers and flights by a plan.
#include "wingbeat/flight/fly.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "flight/flight_vehicles.hpp"

namespace wingbeat {
namespace {

TEST(RiccatiEquation, RegulatorOfADoubleIntegratorIsKnown) {
  LinearPlant plant{Eigen::MatrixXd::Zero(2, 2), Eigen::MatrixXd::Zero(2, 1)};
  plant.A(0, 1) = 1.0;
  plant.B(1, 0) = 1.0;
  const Eigen::MatrixXd Q = Eigen::MatrixXd::Identity(2, 2), R = Eigen::MatrixXd::Identity(1, 1);
  const auto found = continuous_regulator(plant, Q, R);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->K(0, 0), 1.0, 1e-9);
  EXPECT_NEAR(found->K(0, 1), std::sqrt(3.0), 1e-9);
  EXPECT_LT(found->residual, 1e-12);
  // Sampled fast, the discrete regulator is the continuous one.
  const double step = 1e-4;
  const auto fast = discrete_regulator(sampled(plant, step), step * Q, step * R);
  ASSERT_TRUE(fast);
  EXPECT_NEAR(fast->K(0, 0), 1.0, 1e-3);
  EXPECT_NEAR(fast->K(0, 1), std::sqrt(3.0), 1e-3);
  EXPECT_LT(fast->residual, 1e-10);
}

TEST(RiccatiEquation, WhatNothingStabilisesHasNoRegulator) {
  LinearPlant plant{Eigen::MatrixXd::Identity(1, 1), Eigen::MatrixXd::Zero(1, 1)};
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
  EXPECT_FALSE(continuous_regulator(plant, one, one));
  EXPECT_FALSE(discrete_regulator({2.0 * one, 0.0 * one}, one, one));
}

TEST(RiccatiEquation, SampledModelsAreExact) {
  Eigen::MatrixXd A(2, 2), B(2, 1);
  A << 0.0, 30.0, -30.0, 0.0;
  B << 0.0, 1.0;
  const LinearPlant s = sampled({A, B}, 0.1);
  EXPECT_NEAR(s.A(0, 0), std::cos(3.0), 1e-12);
  EXPECT_NEAR(s.A(0, 1), std::sin(3.0), 1e-12);
  EXPECT_NEAR(s.B(0, 0), (1.0 - std::cos(3.0)) / 30.0, 1e-12);
  EXPECT_NEAR(s.B(1, 0), std::sin(3.0) / 30.0, 1e-12);
}

TEST(FlightPath, SmoothSegmentsRestAtTheirEnds) {
  const std::vector<Waypoint> path = {{1.0, {0.0, 0.0, 0.0}, 0.0}, {3.0, {2.0, 0.0, -1.0}, 1.0}};
  const FlightReference middle = reference_at(path, PathInterpolation::smooth, 2.0);
  EXPECT_DOUBLE_EQ(middle.position[0], 1.0);
  EXPECT_DOUBLE_EQ(middle.velocity[0], 2.0 * 1.875 / 2.0);
  EXPECT_DOUBLE_EQ(middle.yaw, 0.5);
  EXPECT_EQ(reference_at(path, PathInterpolation::smooth, 0.0).position[0], 0.0);
  EXPECT_EQ(reference_at(path, PathInterpolation::smooth, 9.0).position[2], -1.0);
  EXPECT_DOUBLE_EQ(reference_at(path, PathInterpolation::linear, 1.5).velocity[2], -0.5);
}

TEST(FlightWind, TurbulenceHasTheDeviationAndTheSeedDecides) {
  WindPlan plan;
  plan.deviation = 0.3;
  plan.time_constant = 0.2;
  const double duration = 2000.0;
  const auto wind = wind_of(plan, duration), same = wind_of(plan, duration);
  plan.seed = 2;
  const auto other = wind_of(plan, duration);
  double square_sum = 0.0;
  int count = 0;
  for (double t = 5.0; t < duration; t += 0.1, ++count) square_sum += std::pow(wind(t, {})[0], 2);
  EXPECT_NEAR(std::sqrt(square_sum / count), 0.3, 0.015);
  EXPECT_EQ(wind(7.3, {}), same(7.3, {}));
  EXPECT_NE(wind(7.3, {}), other(7.3, {}));
}

FlightPlan rough_hover(ControllerType type) {
  FlightPlan plan;
  plan.duration = 2.5;
  plan.controller.type = type;
  plan.sensors.position = 0.002;
  plan.sensors.velocity = 0.02;
  plan.sensors.attitude = 0.01;
  plan.sensors.rates = 0.1;
  plan.wind.deviation = 0.1;
  plan.wind.time_constant = 0.5;
  plan.wind.gusts = {{1.0, 0.8, {0.3, 0.15, 0.0}}};
  return plan;
}

TEST(FlightByPlan, FlapperHoversByEachControllerInGusts) {
  const FlightVehicle vehicle = flight_vehicle(flying_design("friction2022"));
  for (const ControllerType type : {ControllerType::lqr, ControllerType::pid}) {
    const FlightRecord flight = fly(vehicle, rough_hover(type));
    EXPECT_EQ(flight.outcome, FlightOutcome::completed) << name_of(type) << ": " << flight.detail;
    EXPECT_LT(flight.error.horizontal_max, 0.5) << name_of(type);
    EXPECT_LT(flight.error.vertical_max, 0.2) << name_of(type);
    EXPECT_LT(std::abs(flight.energy.residual), 1e-4 * flight.energy.electrical) << name_of(type);
    EXPECT_LT(std::abs(flight.energy.body_residual), 1e-4 * flight.energy.electrical) << name_of(type);
    if (type != ControllerType::lqr) continue;
    EXPECT_LT(flight.design.riccati_residual, 1e-9);
    EXPECT_LT(flight.design.spectral_radius, 1.0);
    const FlightRecord again = fly(vehicle, rough_hover(type));
    ASSERT_EQ(flight.rows.size(), again.rows.size());
    EXPECT_EQ(flight.rows.back().position, again.rows.back().position);
  }
}

// Integrals that stopped where rounding had it drove such flights apart by a tenth of a millimetre.
TEST(FlightByPlan, FlightsFromStartsThatHardlyDifferStayTogether) {
  const FlightVehicle vehicle = flight_vehicle(flying_design("friction2022"));
  FlightPlan plan;
  plan.duration = 2.0;
  const FlightRecord flight = fly(vehicle, plan);
  plan.disturbance.velocity[0] = 1e-14;
  const FlightRecord other = fly(vehicle, plan);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(flight.rows.back().position[k], other.rows.back().position[k], 1e-9);
  }
}

TEST(FlightByPlan, FlapperWithoutAControllerTipsOver) {
  FlightPlan plan = rough_hover(ControllerType::none);
  plan.duration = 10.0;
  const FlightRecord flight = fly(flight_vehicle(flying_design("friction2022")), plan);
  EXPECT_EQ(flight.outcome, FlightOutcome::crashed);
  EXPECT_THAT(flight.detail, testing::HasSubstr("tips over"));
  EXPECT_LT(flight.end, 5.0);
}

TEST(FlightByPlan, FreeFallEndsOnTheGroundInTime) {
  Design<double> design = flying_design("friction2022");
  design.aerodynamics.air_density = 1e-9;
  FlightPlan plan;
  plan.start = FlightStart::rest;
  plan.controller.type = ControllerType::none;
  plan.held = FlightControls{};
  plan.height = 1.0;
  plan.ground = 0.0;
  const FlightRecord flight = fly(flight_vehicle(design), plan);
  EXPECT_EQ(flight.outcome, FlightOutcome::crashed);
  EXPECT_NEAR(flight.end, std::sqrt(2.0 / standard_gravity), 1e-6);
}

TEST(FlightByPlan, BandwidthsAndGainsGivenAreTaken) {
  const FlightVehicle vehicle = flight_vehicle(flying_design("friction2022"));
  FlightPlan plan;
  plan.duration = 0.05;
  plan.controller.type = ControllerType::pid;
  plan.controller.bandwidths.rates = 30.0;
  plan.controller.gains[std::size_t(FlightAxis::yaw)].proportional = 0.005;
  const FlightRecord flight = fly(vehicle, plan);
  const ControllerDesign& d = flight.design;
  EXPECT_EQ(d.rates, 30.0);
  EXPECT_DOUBLE_EQ(d.attitude, 12.0);  // each loop 2.5 times slower than the one within
  EXPECT_EQ(*d.loops[std::size_t(FlightAxis::yaw)].proportional, 0.005);
  AveragedFlight averaged(vehicle, {.tolerance = 1e-8});
  const TrimResult found = trim(averaged, {});
  const auto linear = linear_flight(averaged, found);
  ASSERT_TRUE(linear);
  // Pitch by the mean stroke angle, the second control.
  EXPECT_NEAR(*d.loops[std::size_t(FlightAxis::pitch)].proportional * linear->B(4, 1), 30.0, 0.01);
}

TEST(FlightByPlan, WhatNoControlSteersIsSaid) {
  Design<double> design = flying_design("friction2022");
  design.body.control.incidence_difference.reset();
  FlightPlan plan;
  plan.duration = 0.05;
  const FlightRecord flight = fly(flight_vehicle(design), plan);
  EXPECT_THAT(flight.design.uncontrolled, testing::ElementsAre(testing::HasSubstr("no control of roll")));
}

TEST(FlightByPlan, RefusesWhatIsOutOfRange) {
  FlightPlan plan;
  plan.sensors.delay = -1.0;
  EXPECT_THROW(validate(plan), ParameterError);
  plan = {};
  plan.ground = 0.0;
  EXPECT_THROW(validate(plan), ParameterError);
  plan = {};
  plan.path = {{1.0, {}, 0.0}, {1.0, {}, 0.0}};
  EXPECT_THROW(validate(plan), ParameterError);
}

}  // namespace
}  // namespace wingbeat

// Flight averaged over the wingbeat: against the orbit search, whose equations in a flow it does not share the way of;
// trim and modes against the whole flight.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <memory>
#include <utility>

#include "flight/flight_vehicles.hpp"
#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/flight/stability.hpp"

namespace wingbeat {
namespace {

FlightControls at_voltage(double voltage) {
  FlightControls controls;
  controls[FlightControl::voltage] = voltage;
  return controls;
}

/// The orbit of the first drive on a body in this motion.
SteadyFlapping orbit_in(const FlightVehicle& v, const SteadyMotion& motion) {
  Vehicle<double> vehicle = v.drives[0].vehicle;
  OnsetFlow flow = v.drives[0].flow;
  flow.velocity = motion.velocity, flow.rates = motion.rates;
  vehicle.wings.flow = std::make_shared<OnsetFlow>(flow);
  return find_steady_flapping(vehicle, {.tolerance = 1e-8});
}

TEST(AveragedFlight, IsTheOrbitsMeanAtRestAndInMotion) {
  for (const auto& [name, lifting_span] : {std::pair{"friction2022", 1.0}, {"friction2022", 0.9}, {"purdue", 0.9}}) {
    Design<double> design = flying_design(name);
    design.aerodynamics.lifting_span = lifting_span;
    if (lifting_span < 1.0) {
      design.wing.planform = {.shape = PlanformShape::semi_ellipse, .length = 0.07, .root_chord = 0.026};
    }
    const FlightVehicle v = flight_vehicle(design);
    for (const SteadyMotion& motion : {SteadyMotion{}, SteadyMotion{{0.6, 0.3, -0.4}, {2.0, -3.0, 1.0}}}) {
      AveragedFlight flight(v);
      const std::optional<MeanFlight> mean = flight.at(at_voltage(v.stated_voltage), motion);
      ASSERT_TRUE(mean) << name;
      const SteadyFlapping orbit = orbit_in(v, motion);
      ASSERT_EQ(orbit.status, FlappingStatus::flapping) << name;
      const Metrics<double>& m = orbit.metrics;
      const DriveCycle& cycle = mean->cycles[0];
      EXPECT_NEAR(1.0 / cycle.period, m[Metric::frequency], 2e-6 * m[Metric::frequency]) << name;
      EXPECT_NEAR(-cycle.mean.force[2], m[Metric::lift_mean], 5e-6 * m[Metric::lift_mean]) << name;
      EXPECT_NEAR(cycle.electrical, m[Metric::power_electrical], 5e-6 * m[Metric::power_electrical]) << name;
      EXPECT_NEAR(cycle.aerodynamic, m[Metric::power_aerodynamic], 5e-6 * m[Metric::power_aerodynamic]) << name;
    }
  }
}

TEST(AveragedFlight, StripsAtRestAreTheClosedForm) {
  const FlightVehicle v = flying("friction2022");
  BladeElement<double> in_flow = v.drives[0].vehicle.wings, plain = in_flow;
  plain.flow = nullptr;
  for (const double velocity : {-60.0, -3.0, 0.1, 45.0, 200.0}) {
    const double stroke = velocity < 0.0 ? -1.0 : 1.0;
    const AeroLoads<double> a = aero_loads(in_flow, velocity, stroke, 1.0, 1.0, 0.3);
    const AeroLoads<double> b = aero_loads(plain, velocity, stroke, 1.0);
    EXPECT_NEAR(a.lift, b.lift, 1e-9 * std::abs(b.lift) + 1e-18);
    EXPECT_NEAR(a.moment, b.moment, 1e-9 * std::abs(b.moment) + 1e-20);
  }
}

TEST(AveragedFlight, StripsHaveExactDerivatives) {
  using D = Jet<2>;
  OnsetFlow flow = flying("x-wing").drives[0].flow;
  flow.velocity = {1.0, 0.4, -0.7}, flow.rates = {3.0, 2.0, -4.0};
  BladeElement<double> wings = flying("x-wing").drives[0].vehicle.wings;
  wings.flow = std::make_shared<OnsetFlow>(flow);
  const BladeElement<D> dual = cast<D>(wings);
  constexpr double h = 1e-6;
  for (const double velocity : {-40.0, 5.0, 80.0}) {
    const double stroke = velocity < 0.0 ? -1.0 : 1.0;
    const AeroLoads<D> exact = aero_loads(dual, D(velocity, 0), D(stroke), D(1.0), D(1.0), D(0.2, 1));
    const auto loads = [&](double v, double angle) { return aero_loads(wings, v, stroke, 1.0, 1.0, angle); };
    const double by_velocity = (loads(velocity + h, 0.2).moment - loads(velocity - h, 0.2).moment) / (2.0 * h);
    const double by_angle = (loads(velocity, 0.2 + h).lift - loads(velocity, 0.2 - h).lift) / (2.0 * h);
    EXPECT_NEAR(exact.moment.v[0], by_velocity, 1e-6 * std::abs(by_velocity));
    EXPECT_NEAR(exact.lift.v[1], by_angle, 1e-6 * std::abs(by_angle) + 1e-9);
  }
}

TEST(AveragedFlight, CoefficientsTurnRoundWithTheChord) {
  const ForceCoefficients<double> c = translational_2022();
  for (const double alpha : {0.3, 0.7}) {
    const LiftAndDrag<double> straight = coefficients_all_round(c, alpha),
                              turned = coefficients_all_round(c, pi - alpha);
    EXPECT_NEAR(turned.lift, -straight.lift, 1e-12);
    EXPECT_NEAR(turned.drag, straight.drag, 1e-12);
  }
  const double before = coefficients_all_round(c, 0.5 * pi - 1e-9).lift,
               after = coefficients_all_round(c, 0.5 * pi + 1e-9).lift;
  EXPECT_NEAR(before, after, 1e-7);
}

TEST(Trim, BringsAllMeanAccelerationsToZeroAndTheWholeFlightAbout) {
  for (const char* name : {"friction2022", "x-wing"}) {
    AveragedFlight flight(flying(name));
    const TrimResult hover = trim(flight, {});
    ASSERT_EQ(hover.status, TrimStatus::trimmed) << name << ": " << hover.detail;
    for (const double a : hover.acceleration) EXPECT_NEAR(a, 0.0, 1e-5 * standard_gravity) << name;
    // A second of the frozen flight.
    FlightSimulation held(flight.vehicle(), {.frozen = true});
    held.command(hover.controls);
    held.start(steady_body({}, hover.roll, hover.pitch), {hover.flight->cycles[0].start});
    const double T = hover.flight->cycles[0].period;
    ASSERT_TRUE(held.step_to(10.0 * T));
    const double weight = flight.vehicle().body.mass * standard_gravity;
    const Triple force = to_earth(held.state().body.attitude, held.totals().force);
    EXPECT_NEAR(-force[2] / (10.0 * T), weight, 2e-5 * weight) << name;
    EXPECT_NEAR(force[0] / (10.0 * T), 0.0, 2e-5 * weight) << name;
  }
}

TEST(Trim, ForwardFlightClimbAndTurn) {
  AveragedFlight flight(flying("friction2022"));
  const TrimResult hover = trim(flight, {});
  const TrimResult fast = trim(flight, {.speed = 0.5}, {}, &hover);
  ASSERT_EQ(fast.status, TrimStatus::trimmed) << fast.detail;
  EXPECT_LT(fast.pitch, hover.pitch - 0.05);  // nose down, forwards
  const TrimResult climbs = trim(flight, {.climb = 0.3}, {}, &hover);
  ASSERT_EQ(climbs.status, TrimStatus::trimmed) << climbs.detail;
  EXPECT_GT(climbs.power, hover.power);
  const TrimResult turns = trim(flight, {.speed = 0.4, .turn_rate = 1.0}, {}, &fast);
  ASSERT_EQ(turns.status, TrimStatus::trimmed) << turns.detail;
  EXPECT_GT(turns.roll, 0.02);  // into the turn
}

TEST(Trim, SaysWhatItCannotDo) {
  Design<double> d = flying_design("friction2022");
  d.mass = 10e-3;
  AveragedFlight heavy(flight_vehicle(d));
  const TrimResult result = trim(heavy, {});
  EXPECT_NE(result.status, TrimStatus::trimmed);
  EXPECT_FALSE(result.detail.empty());

  Design<double> uncontrolled = flying_design("friction2022");
  uncontrolled.body.control = {};
  uncontrolled.body.shoulder_ahead = 2e-3;
  AveragedFlight flight(flight_vehicle(uncontrolled));
  const TrimResult nose_up = trim(flight, {});
  EXPECT_EQ(nose_up.status, TrimStatus::untrimmable);
  EXPECT_THAT(nose_up.detail, testing::HasSubstr("a moment of pitch remains"));
}

TEST(Stability, TheLinearModelIsThatOfTheAveragedFlight) {
  AveragedFlight flight(flying("friction2022"));
  const TrimResult hover = trim(flight, {});
  const std::optional<FlightLinearModel> model = linear_flight(flight, hover);
  ASSERT_TRUE(model);
  // Independent of its steps: one-sided differences over a hundredth, extrapolated.
  const BodyState body = steady_body({}, hover.roll, hover.pitch);
  const auto surge = [&](double u) {
    BodyState moved = body;
    moved.velocity[0] += u;
    const MeanFlight mean = *flight.at(hover.controls, motion_of(moved));
    return mean_acceleration(flight.vehicle().body, moved, mean.loads);
  };
  const double h = 2e-2;
  const double coarse = (surge(h).linear[0] - surge(-h).linear[0]) / (2.0 * h);
  const double fine = (surge(0.5 * h).linear[0] - surge(-0.5 * h).linear[0]) / h;
  const double expected = (4.0 * fine - coarse) / 3.0;
  EXPECT_NEAR(model->A(0, 0), expected, 1e-4 * std::abs(expected));
  EXPECT_NEAR(model->A(0, 7), -standard_gravity * std::cos(hover.pitch), 1e-5);
}

TEST(Stability, DragOfTheBodyHasNoSlopeAtRestAndItsOwnInFlight) {
  Design<double> bare = flying_design("friction2022"), dragging = bare;
  dragging.body.drag_area_forward = dragging.body.drag_area_sideways = dragging.body.drag_area_vertical = 1e-3;
  dragging.body.tail.area = 1e-3, dragging.body.tail.behind = 0.05;
  const auto model_of = [](const Design<double>& design, double speed) {
    AveragedFlight flight(flight_vehicle(design));
    const TrimResult steady = trim(flight, {.speed = speed});
    return linear_flight(flight, steady).value();
  };
  const FlightMatrix difference = model_of(dragging, 0.0).A - model_of(bare, 0.0).A;
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-5);  // 1.8 over the wings' steps

  // In flight the force is smooth: over any step.
  AveragedFlight flight(flight_vehicle(dragging));
  const TrimResult steady = trim(flight, {.speed = 0.5});
  const FlightLinearModel model = linear_flight(flight, steady).value();
  const BodyState body = steady_body({.speed = 0.5}, steady.roll, steady.pitch);
  const auto surge = [&](double u) {
    BodyState moved = body;
    moved.velocity[0] += u;
    return mean_acceleration(flight.vehicle().body, moved, flight.at(steady.controls, motion_of(moved))->loads)
        .linear[0];
  };
  const double h = 0.02, coarse = (surge(h) - surge(-h)) / (2.0 * h), fine = (surge(0.5 * h) - surge(-0.5 * h)) / h;
  EXPECT_NEAR(model.A(0, 0), (4.0 * fine - coarse) / 3.0, 1e-5 * std::abs(coarse));
}

TEST(Stability, WindActsAsTheMotionThroughTheAirDoes) {
  AveragedFlight flight(flying("friction2022"));
  const TrimResult turn = trim(flight, {.speed = 0.3, .turn_rate = 0.5});
  ASSERT_TRUE(turn.flies()) << turn.detail;
  const std::optional<FlightLinearModel> model = linear_flight(flight, turn);
  ASSERT_TRUE(model);
  // The air moves, the body as before.
  const BodyState body = steady_body(turn.condition, turn.roll, turn.pitch);
  const auto blown = [&](std::size_t axis, double wind) {
    BodyState through_air = body;
    through_air.velocity[axis] -= wind;
    return mean_acceleration(flight.vehicle().body, body, flight.at(turn.controls, motion_of(through_air))->loads);
  };
  constexpr double gust = 5e-3;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const MeanAcceleration high = blown(axis, gust), low = blown(axis, -gust);
    const auto column = model->W.col(Eigen::Index(axis));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR((high.linear[k] - low.linear[k]) / (2.0 * gust), column[Eigen::Index(k)],
                  1e-3 * column.head<3>().cwiseAbs().maxCoeff());
      EXPECT_NEAR((high.angular[k] - low.angular[k]) / (2.0 * gust), column[Eigen::Index(k + 3)],
                  1e-3 * column.segment<3>(3).cwiseAbs().maxCoeff());
    }
    EXPECT_EQ(column[6], 0.0);
    EXPECT_EQ(column[7], 0.0);
  }
}

TEST(Stability, AveragingAndFloquetTheoryAgreeWhereTheBodyIsSlow) {
  AveragedFlight flight(flying("x-wing"));
  const TrimResult hover = trim(flight, {});
  const StabilityResult found = flight_stability(flight, hover);
  ASSERT_TRUE(found.periodic) << found.periodic_detail;
  ASSERT_GE(found.modes.size(), 5u);
  for (const FlightMode& mode : found.modes) {
    ASSERT_TRUE(mode.averaged && mode.floquet);
    EXPECT_LT(std::abs(*mode.floquet - *mode.averaged), 0.15 * std::abs(*mode.averaged) + 0.3) << mode.shape;
  }
  EXPECT_GT(found.modes.front().averaged->real(), 0.0);
}

TEST(Stability, FloquetExponentsDoNotDependOnTheStepsTolerance) {
  const FlightVehicle bumblebee = flight_vehicle(read_design(WINGBEAT_DATA "/designs/insects/bumblebee.toml", {}));
  std::vector<FlightMode> modes[2];
  for (const auto& [n, tolerance] : {std::pair{0, 1e-8}, {1, 1e-9}}) {
    AveragedFlight flight(bumblebee, {.tolerance = tolerance});
    const StabilityResult found = flight_stability(flight, trim(flight, {}));
    ASSERT_TRUE(found.periodic) << found.periodic_detail;
    modes[n] = found.modes;
  }
  ASSERT_EQ(modes[0].size(), modes[1].size());
  for (std::size_t n = 0; n < modes[0].size(); ++n) {
    if (!modes[1][n].floquet) continue;
    ASSERT_TRUE(modes[0][n].floquet);
    const std::complex<double> loose = *modes[0][n].floquet, tight = *modes[1][n].floquet;
    EXPECT_LT(std::abs(loose - tight), 2e-3 * std::abs(tight)) << tight << ' ' << modes[1][n].shape;
  }
}

TEST(Stability, ParametersMoveTheLeastStableMode) {
  Design<double> d = flying_design("friction2022");
  const std::vector<ModeSensitivity> all =
      mode_sensitivities(d, {}, {}, {"body.inertia_pitch", "body.shoulder_above", "wing.inertia"});
  ASSERT_EQ(all.size(), 3u);
  const auto slope_by = [&](std::string_view key) {
    for (const ModeSensitivity& s : all) {
      if (s.parameter == key) return s.slope;
    }
    return absent;
  };
  EXPECT_TRUE(std::isfinite(slope_by("body.inertia_pitch")));
  EXPECT_LT(slope_by("body.inertia_pitch"), 0.0);  // heavier to turn: slower to diverge
}

}  // namespace
}  // namespace wingbeat

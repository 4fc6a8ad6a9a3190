// FMUs of vehicles with a body: against flights in time, themselves, and what is conserved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "fmu/body_variables.hpp"
#include "fmu/dependencies.hpp"
#include "fmu/instance.hpp"
#include "vehicle/direct_design.hpp"
#include "vehicle/hinged_design.hpp"
#include "wingbeat/flight/simulation.hpp"

namespace wingbeat::fmu {
namespace {

Design<double> on_a_body(Design<double> d) {
  d.mass = 3.3e-3;
  d.body.inertia_roll = 6e-7, d.body.inertia_pitch = 5e-7, d.body.inertia_yaw = 3e-7;
  d.body.shoulder_aside = 6e-3, d.body.shoulder_above = 8e-3, d.body.shoulder_ahead = 1e-3;
  d.body.drag_area_forward = 1e-4;
  d.body.tail.area = 2e-4, d.body.tail.behind = 3e-2;
  d.body.control.mean_stroke_angle = 0.2, d.body.control.stroke_plane_difference = 0.2;
  d.wing.planform = {};
  d.wing.planform.shape = PlanformShape::semi_ellipse;
  d.wing.planform.length = 62.8e-3, d.wing.planform.root_chord = 25.2e-3;
  return d;
}

/// A crank, the same with wings that have mass, two direct drives whose wings pitch.
std::vector<Design<double>> body_designs() {
  Design<double> massive = on_a_body(reference_design()), two = on_a_body(hinged_design(1e-3));
  massive.body.wing_mass = 5e-5;
  massive.body.wing_centre = 2e-2;
  two.motors = 2.0;
  two.wing.count = 1.0;
  return {on_a_body(reference_design()), massive, two};
}

std::size_t reference(const Design<double>& design, const std::string& name) {
  for (const Variable& v : variables_of(design)) {
    if (v.name == name) return v.reference();
  }
  ADD_FAILURE() << "no variable " << name;
  return 0;
}

/// Values set by name, then initialised.
struct Flown {
  Flown(const Design<double>& d, const std::vector<std::pair<std::string, double>>& values) : design(d), one(d) {
    for (const auto& [name, value] : values) EXPECT_TRUE(one.set_real(reference(d, name), value)) << name;
    one.initialise(0.0);
  }
  double get(const std::string& name) const { return *one.real(reference(design, name)); }

  Design<double> design;
  Instance one;
};

const std::vector<std::pair<std::string, double>> thrown = {{"solver_tolerance", 1e-11},
                                                            {"initial_body_velocity_x", 0.4},
                                                            {"initial_body_velocity_y", -0.2},
                                                            {"initial_body_velocity_z", 0.3},
                                                            {"initial_body_pitch", 0.2},
                                                            {"initial_body_yaw", -0.4},
                                                            {"initial_body_rate_x", 2.0},
                                                            {"initial_body_rate_z", -1.0},
                                                            {"wind_x", 0.5},
                                                            {"wind_y", 0.3},
                                                            {"wind_z", -0.2},
                                                            {"mean_stroke_angle", 0.1},
                                                            {"stroke_plane_difference", -0.05},
                                                            {"initial_body_position_z", -1.0}};

BodyState body_of(const Flown& flown) {
  BodyState body;
  std::size_t k = 0;
  BodyState::each(body, [&](double& x) { x = flown.get(body_state_rows[k++].name); });
  return body;
}

/// What a flight of the library does from the same start.
FlightSimulation flight_of(const Design<double>& design) {
  FlightSimulation flight(flight_vehicle(design), {.tolerance = 1e-11});
  FlightControls controls;
  controls[FlightControl::voltage] = flight.vehicle().stated_voltage;
  controls[FlightControl::mean_stroke_angle] = 0.1;
  controls[FlightControl::stroke_plane_difference] = -0.05;
  flight.command(controls);
  flight.blow([](double, const Triple&) { return Triple{0.5, 0.3, -0.2}; });
  BodyState body;
  body.velocity = {0.4, -0.2, 0.3};
  body.attitude = attitude_of({0.0, 0.2, -0.4});
  body.rates = {2.0, 0.0, -1.0};
  body.position[2] = -1.0;
  flight.start(body);
  return flight;
}

// Flights of cranks with kinked friction change by 1e-6 from a tolerance of 1e-10 to 1e-11, FMU or not; those of direct
// drives by 1e-11 at first, and more as the body tumbles.
TEST(FmuBody, FliesAsFlightsDo) {
  constexpr double times[] = {0.013, 0.15, 0.3};
  for (const Design<double>& design : body_designs()) {
    const bool direct = design.transmission.type == TransmissionType::direct;
    const double errors[] = {direct ? 1e-11 : 5e-7, direct ? 1e-10 : 5e-6, direct ? 1e-8 : 5e-6};
    Flown flown(design, thrown);
    FlightSimulation flight = flight_of(design);
    for (std::size_t n = 0; n < std::size(times); ++n) {
      const double time = times[n], error = errors[n];
      ASSERT_EQ(flown.one.step_to(time), StepResult::reached);
      ASSERT_TRUE(flight.step_to(time));
      const BodyState body = flight.state().body;
      std::size_t k = 0;
      BodyState::each(body, [&](const double& x) {
        EXPECT_NEAR(flown.get(body_state_rows[k].name), x, error * (1.0 + std::abs(x)))
            << body_state_rows[k].name << " at " << time;
        ++k;
      });
      const BodyLoads loads = flight.loads();
      EXPECT_NEAR(flown.get("body_force_z"), loads.force[2], 10.0 * error * (1e-2 + std::abs(loads.force[2])));
      EXPECT_NEAR(flown.get("body_moment_x"), loads.moment[0], 10.0 * error * (1e-3 + std::abs(loads.moment[0])));
    }
    EXPECT_GT(std::abs(flown.get("body_position_x")), 1e-2);
  }
}

TEST(FmuBody, RatesAreThoseOfItsSteps) {
  for (const Design<double>& design : body_designs()) {
    Flown flown(design, thrown);
    ASSERT_EQ(flown.one.step_to(0.0513), StepResult::reached);
    const std::vector<double> before = flown.one.states(), rates = flown.one.rates();
    constexpr double h = 1e-7;
    ASSERT_EQ(flown.one.step_to(0.0513 + h), StepResult::reached);
    const std::vector<double> after = flown.one.states(), later = flown.one.rates();
    ASSERT_EQ(rates.size(), before.size());
    for (std::size_t n = 0; n < rates.size(); ++n) {
      EXPECT_NEAR((after[n] - before[n]) / h, 0.5 * (rates[n] + later[n]), 1e-5 * std::abs(rates[n]) + 1e-6) << n;
    }
  }
}

TEST(FmuBody, TheAirsWorkIsTheBodysEnergy) {
  Flown flown(body_designs()[0], thrown);
  const FlightVehicle vehicle = flight_vehicle(flown.design);
  ASSERT_EQ(flown.one.step_to(0.2), StepResult::reached);
  const double before = body_energy(vehicle.body, body_of(flown), standard_gravity);
  constexpr int steps = 2000;
  constexpr double h = 0.05 / steps;
  double work = 0.0, turnover = 0.0, power = flown.get("power_body");
  for (int n = 0; n < steps; ++n) {
    ASSERT_EQ(flown.one.step_to(0.2 + (n + 1) * h), StepResult::reached);
    const double next = flown.get("power_body");
    work += 0.5 * h * (power + next);
    turnover += 0.5 * h * (std::abs(power) + std::abs(next));
    power = next;
  }
  EXPECT_NEAR(body_energy(vehicle.body, body_of(flown), standard_gravity) - before, work, 1e-5 * turnover);
  EXPECT_GT(turnover, 1e-5);
}

TEST(FmuBody, WindIsMotion) {
  for (const Design<double>& design : body_designs()) {
    const std::vector<std::pair<std::string, double>> still = {{"solver_tolerance", 1e-11},
                                                               {"initial_body_velocity_x", 0.5}};
    Flown moves(design, still), blown(design, {{"solver_tolerance", 1e-11}, {"wind_x", -0.5}});
    ASSERT_EQ(moves.one.step_to(0.1), StepResult::reached);
    ASSERT_EQ(blown.one.step_to(0.1), StepResult::reached);
    EXPECT_NEAR(moves.get("body_position_x") - 0.05, blown.get("body_position_x"), 1e-9);
    EXPECT_NEAR(moves.get("body_pitch"), blown.get("body_pitch"), 1e-8);
    EXPECT_NEAR(moves.get("body_force_x"), blown.get("body_force_x"), 1e-7);
  }
}

TEST(FmuBody, StatesComeBackBitForBit) {
  for (const Design<double>& design : body_designs()) {
    Flown flown(design, thrown);
    Instance other(design);
    ASSERT_EQ(flown.one.step_to(0.05), StepResult::reached);
    const std::string state = flown.one.save();
    ASSERT_EQ(flown.one.step_to(0.1), StepResult::reached);
    other.restore(state);
    ASSERT_EQ(other.step_to(0.1), StepResult::reached);
    EXPECT_EQ(other.states(), flown.one.states());
    Design<double> bodyless = design;
    bodyless.body = {};
    Instance drive(bodyless);
    EXPECT_THROW(drive.restore(state), std::runtime_error);
    const std::vector<double> here = flown.one.states();
    EXPECT_EQ(flown.one.step_to(100.0, 2000), StepResult::too_much);
    EXPECT_EQ(flown.one.states(), here);
    EXPECT_EQ(flown.one.time(), 0.1);
  }
}

TEST(FmuBody, NothingDependsOnWhatIsNotDeclared) {
  for (const Design<double>& design : body_designs()) {
    Flown flown(design, thrown);
    ASSERT_EQ(flown.one.step_to(0.0637), StepResult::reached);
    std::vector<std::size_t> unknowns, knowns;
    for (const Variable& v : variables_of(design)) {
      if (v.kind == VariableKind::derivative || v.kind == VariableKind::output) unknowns.push_back(v.reference());
      if (v.kind == VariableKind::state || v.kind == VariableKind::input) knowns.push_back(v.reference());
    }
    const std::vector<double> states = flown.one.states();
    int found = 0;
    for (const std::size_t known : knowns) {
      const std::vector<double> slopes = flown.one.directional(unknowns, {{known, 1.0}});
      for (std::size_t k = 0; k < unknowns.size(); ++k) {
        const auto declared = dependencies_of(design, unknowns[k]);
        if (std::find(declared.begin(), declared.end(), known) == declared.end()) {
          EXPECT_EQ(slopes[k], 0.0) << unknowns[k] << " by " << known;
        } else if (slopes[k] != 0.0) {
          ++found;
        }
      }
    }
    EXPECT_GT(found, 200);
    EXPECT_EQ(flown.one.states(), states) << "a direction changes nothing";
  }
}

TEST(FmuBody, DerivativesOfTheBodyAreThoseOfItsEquations) {
  Flown flown(body_designs()[0], thrown);
  ASSERT_EQ(flown.one.step_to(0.0637), StepResult::reached);
  const auto slope = [&](const char* unknown, const char* known) {
    return flown.one.directional({reference(flown.design, unknown)}, {{reference(flown.design, known), 1.0}})[0];
  };
  // Of the quaternion, which is half of it times (0, W).
  EXPECT_NEAR(slope("der(state_body_attitude_1)", "state_body_rate_x"), 0.5 * flown.get("state_body_attitude_0"), 1e-9);
  // The force over the mass; wind from ahead is as motion ahead.
  const double by_velocity = slope("body_force_x", "state_body_velocity_z");
  EXPECT_NE(by_velocity, 0.0);
  EXPECT_NEAR(slope("der(state_body_velocity_x)", "state_body_velocity_z"),
              by_velocity / 3.3e-3 - flown.get("state_body_rate_y"), 1e-6 * std::abs(by_velocity) / 3.3e-3 + 1e-6);
}

TEST(FmuBody, WithoutItNothingIsThere) {
  Design<double> design = body_designs()[2];
  design.body = {};
  for (const Variable& v : variables_of(design)) {
    EXPECT_NE(v.side, body_side) << v.name;
    EXPECT_EQ(v.name.find("wind"), std::string::npos);
  }
  reference(design, "roll_moment");
  reference(design, "hinge_offset");
}

}  // namespace
}  // namespace wingbeat::fmu

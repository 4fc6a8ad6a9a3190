// The cycle-to-cycle model against the time model, against the derivatives of the orbit, and against itself in
// continuous time.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "vehicle/direct_design.hpp"
#include "vehicle/hinged_design.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/linear_model.hpp"
#include "wingbeat/time/simulation.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

SteadyFlapping accurate(const Vehicle<double>& vehicle) {
  const SteadyFlapping orbit = find_steady_flapping(vehicle, {.tolerance = 1e-12, .stability = false});
  EXPECT_EQ(orbit.status, FlappingStatus::flapping);
  return orbit;
}

/// One cycle in time from a state, in the order of CycleMap::states.
struct CycleInTime {
  Eigen::VectorXd end;
  double frequency;
};
CycleInTime cycle_in_time(const Vehicle<double>& vehicle, const CycleMap& map, const Eigen::VectorXd& start) {
  SimulationOptions options;
  options.tolerance = 1e-12;
  for (std::size_t n = 0; n < map.states.size(); ++n) {
    const std::string& name = map.states[n].name;
    double& place = name == "crank_speed" || name == "flapping_velocity" ? options.speed
                    : name == "stroke_angle"                             ? options.angle
                    : name == "pitch_angle"                              ? options.pitch_angle
                    : name == "pitch_velocity"                           ? options.pitch_velocity
                                                                         : options.current;
    place = start[Eigen::Index(n)];
  }
  const bool crank = map.states.front().name == "crank_speed";
  Simulation flight(vehicle, {SupplyType::constant, vehicle.voltage}, options);
  flight.step_to(crank ? 1.0 : 1.0 / vehicle.drive_frequency,
                 crank ? StepOptions{TransientEvent::Kind::revolution} : StepOptions{});
  const std::vector<std::string> names = flight.state_names();
  const std::vector<double> now = flight.state();
  Eigen::VectorXd end(start.size());
  for (std::size_t n = 0; n < map.states.size(); ++n) {
    const auto index = std::find(names.begin(), names.end(), map.states[n].name) - names.begin();
    end[Eigen::Index(n)] = now[std::size_t(index)];
  }
  return {end, 1.0 / flight.time()};
}

Vehicle<double> with_input(Vehicle<double> vehicle, const std::string& name, double change) {
  if (name == "voltage") vehicle.voltage += change;
  if (name == "load_torque") vehicle.load_torque += change;
  if (name == "frequency") vehicle.drive_frequency += change;
  if (name == "spring_stiffness") vehicle.spring.stiffness += change;
  return vehicle;
}

/// A, B and the row of C and D that is the frequency, each column as a part of what the largest changes by.
void expect_map_of_time_model(const Design<double>& design, double tolerance) {
  const Vehicle<double> vehicle = resolve(design);
  const CycleMap map = cycle_map(accurate(vehicle), vehicle, design.supply);
  ASSERT_FALSE(map.states.empty());
  Eigen::VectorXd start(map.states.size()), size(map.states.size());
  for (Eigen::Index n = 0; n < start.size(); ++n) start[n] = map.states[std::size_t(n)].value;
  size = start.cwiseAbs();
  const Eigen::MatrixXd scaled_a = size.cwiseInverse().asDiagonal() * map.a * size.asDiagonal();
  const double torque = vehicle.motor.torque_constant * vehicle.voltage / circuit_resistance(vehicle);
  const auto compare = [&](const Eigen::VectorXd& exact, const CycleInTime& less, const CycleInTime& more, double step,
                           double unit, const std::string& what) {
    const Eigen::VectorXd difference = (more.end - less.end) / (2.0 * step) * unit;
    const Eigen::VectorXd error = size.cwiseInverse().asDiagonal() * (difference - exact * unit);
    const double largest = (size.cwiseInverse().asDiagonal() * difference).lpNorm<Eigen::Infinity>();
    EXPECT_LT(error.lpNorm<Eigen::Infinity>(), tolerance * (largest + 1e-2)) << what;
  };
  const bool crank = map.states.front().name == "crank_speed";
  const auto frequency = Eigen::Index(map.outputs.size()) - 1;
  for (Eigen::Index n = 0; n < start.size(); ++n) {
    const double step = 1e-5 * size[n];
    Eigen::VectorXd moved = start;
    moved[n] = start[n] - step;
    const CycleInTime less = cycle_in_time(vehicle, map, moved);
    moved[n] = start[n] + step;
    const CycleInTime more = cycle_in_time(vehicle, map, moved);
    compare(map.a.col(n), less, more, step, size[n], map.states[std::size_t(n)].name);
    if (!crank) continue;
    EXPECT_NEAR(map.c(frequency, n) * size[n], (more.frequency - less.frequency) / (2.0 * step) * size[n],
                tolerance * more.frequency);
  }
  for (Eigen::Index k = 0; k < map.b.cols(); ++k) {
    const CycleSignal& input = map.inputs[std::size_t(k)];
    const double unit = input.name == "load_torque" ? torque : input.value, step = 1e-5 * unit;
    const CycleInTime less = cycle_in_time(with_input(vehicle, input.name, -step), map, start);
    const CycleInTime more = cycle_in_time(with_input(vehicle, input.name, step), map, start);
    compare(map.b.col(k), less, more, step, unit, input.name);
    if (!crank) continue;
    EXPECT_NEAR(map.d(frequency, k) * unit, (more.frequency - less.frequency) / (2.0 * step) * unit,
                tolerance * more.frequency);
  }
}

TEST(CycleMap, IsThatOfTheTimeModel) {
  Design<double> crank = reference_design();
  expect_map_of_time_model(crank, 2e-6);
  crank.motor.constants.armature_inductance = 0.0;
  expect_map_of_time_model(crank, 2e-6);
  Design<double> direct = direct_design();
  direct.spring.stiffness = resolve(direct).spring.stiffness;
  direct.spring.resonance.reset();
  expect_map_of_time_model(direct, 2e-6);
  expect_map_of_time_model(hinged_design(1e-3), 2e-6);
}

TEST(CycleMap, ClosesToTheDerivativesOfTheOrbit) {
  for (const bool pwm : {false, true}) {
    Design<double> design = reference_design();
    if (pwm) design.supply = {SupplyType::pwm, 4.0, 20e3, 0.75};
    const Vehicle<double> vehicle = resolve(design);
    const SteadyFlapping orbit = accurate(vehicle);
    const LinearModel model = linear_model_of(cycle_map(orbit, vehicle, design.supply));
    GradientVehicle seeded{cast<GradientJet>(vehicle)};
    seeded.vehicle.load_torque = gradient_seed(0.0, 0);
    const OrbitGradient g = orbit_gradient(orbit, seeded);
    const CycleMap& map = model.map;
    for (std::size_t k = 0; k < map.outputs.size(); ++k) {
      const std::string& name = map.outputs[k].name;
      if (name == "crank_speed_mean") continue;
      const Metric metric = name == "lift_mean"          ? Metric::lift_mean
                            : name == "power_electrical" ? Metric::power_electrical
                            : name == "current_mean"     ? Metric::current_mean
                            : name == "frequency"        ? Metric::frequency
                                                         : Metric::power_aerodynamic;
      const auto& slopes = g.metrics[metric].v;
      EXPECT_NEAR(map.outputs[k].value, orbit.metrics[metric], 1e-12 * orbit.metrics[metric]) << name;
      const double by_voltage = slopes[gradient_voltage_slot] * (pwm ? design.supply.voltage : 1.0);
      EXPECT_NEAR(model.steady_gain(Eigen::Index(k), 0), by_voltage, 1e-9 * std::abs(by_voltage)) << name;
      const double by_load = slopes[gradient_first_slot];
      EXPECT_NEAR(model.steady_gain(Eigen::Index(k), 1), by_load, 1e-9 * std::abs(by_load)) << name;
    }
  }
}

/// The mean lift of each cycle, and its frequency, while the voltage is held.
std::vector<std::pair<double, double>> cycles_in_time(Simulation& flight, int count) {
  std::vector<std::pair<double, double>> means;
  WaveformRow row = flight.now();
  double start = row.time, lift = 0.0;
  while (int(means.size()) < count) {
    constexpr double step = 2e-5;
    const auto events = flight.step_to(flight.time() + step, {TransientEvent::Kind::revolution});
    const WaveformRow next = flight.now();
    lift += 0.5 * (row.lift + next.lift) * (next.time - row.time);
    row = next;
    if (!events.empty() && events.back().kind == TransientEvent::Kind::revolution) {
      means.emplace_back(lift / (row.time - start), 1.0 / (row.time - start));
      start = row.time;
      lift = 0.0;
    }
  }
  return means;
}

TEST(LinearModel, PredictsAStepOfVoltage) {
  // From 1 % below the voltage of the operating point to 1 % above it; within 1 % of the change, cycle by cycle.
  const Design<double> design = reference_design();
  const Linearisation linearisation = linearise(design, {}, 20);
  ASSERT_TRUE(linearisation.model);
  const LinearModel& model = *linearisation.model;
  const Vehicle<double> vehicle = resolve(design);
  constexpr double part = 0.02;
  Vehicle<double> below = vehicle;
  below.voltage *= 1.0 - 0.5 * part;
  const SteadyFlapping from = accurate(below);
  SimulationOptions start;
  start.speed = from.crank_speed;
  start.current = from.current;
  start.tolerance = 1e-9;
  Simulation flight(vehicle, {SupplyType::constant, below.voltage}, start);
  flight.command(vehicle.voltage * (1.0 + 0.5 * part));
  const auto means = cycles_in_time(flight, 12);
  const Eigen::MatrixXd& response = model.step_responses[0];
  const auto frequency = Eigen::Index(model.map.outputs.size()) - 1;
  const double step = part * vehicle.voltage;
  const double lift_change = step * model.steady_gain(0, 0), change = step * model.steady_gain(frequency, 0);
  for (std::size_t k = 0; k < means.size(); ++k) {
    const double lift = means[k].first - from.metrics[Metric::lift_mean];
    const double faster = means[k].second - from.metrics[Metric::frequency];
    EXPECT_NEAR(step * response(Eigen::Index(k), 0), lift, 0.01 * lift_change) << "cycle " << k;
    EXPECT_NEAR(step * response(Eigen::Index(k), frequency), faster, 0.01 * change) << "cycle " << k;
  }
  EXPECT_GT(lift_change, 0.02 * linearisation.orbit.metrics[Metric::lift_mean]);
}

/// What a continuous model gives, held inputs and outputs sampled every T.
Eigen::MatrixXd sampled(const ContinuousModel& model, double period, Eigen::Index input, Eigen::Index cycles) {
  const Eigen::Index n = model.a.rows();
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(n + 1, n + 1);
  both.topLeftCorner(n, n) = model.a * period;
  both.topRightCorner(n, 1) = model.b.col(input) * period;
  const Eigen::MatrixXd over_a_cycle = both.exp();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n + 1);
  x[n] = 1.0;
  Eigen::MatrixXd response(cycles, model.c.rows());
  for (Eigen::Index k = 0; k < cycles; ++k) {
    response.row(k) = (model.c * x.head(n) + model.d.col(input)).transpose();
    x = over_a_cycle * x;
  }
  return response;
}

TEST(LinearModel, IsTheSameInContinuousTime) {
  // A complex pair and a real mode, none of them settled: the same response exactly.
  CycleMap map;
  map.period = 0.05;
  map.states = {{"one", "1", 1.0}, {"two", "1", 1e-3}, {"three", "1", 50.0}};
  map.inputs = {{"u", "1", 0.0}};
  map.outputs = {{"y", "1", 0.0}, {"z", "1", 0.0}};
  map.a.resize(3, 3);
  map.a << 0.7, 80.0, 0.01, -1e-3, 0.6, 1e-5, 2.0, 30.0, 0.3;
  map.b = Eigen::Vector3d(0.3, 1e-3, 5.0);
  map.c.resize(2, 3);
  map.c << 1.0, 2.0, 0.1, 0.0, 500.0, -0.2;
  map.d = Eigen::Vector2d(0.1, 0.0);
  const LinearModel model = linear_model_of(map, 40);
  ASSERT_EQ(model.continuous.states.size(), 3u);
  EXPECT_EQ(model.modes.size(), 2u);
  const Eigen::MatrixXd response = sampled(model.continuous, map.period, 0, 41);
  EXPECT_LT((response - model.step_responses[0]).cwiseAbs().maxCoeff(), 1e-11 * response.cwiseAbs().maxCoeff());
  EXPECT_NEAR(response(40, 0), model.steady_gain(0, 0), 1e-3);
}

TEST(LinearModel, LeavesWhatSettlesWithinACycleOut) {
  Design<double> design = reference_design();
  design.motor.constants.inertia = 3e-5;  // or its speed, too, would settle within a cycle
  const Linearisation linearisation = linearise(design);
  ASSERT_TRUE(linearisation.model);
  const LinearModel& model = *linearisation.model;
  ASSERT_EQ(model.continuous.states.size(), 1u);
  EXPECT_EQ(model.continuous.states[0].name, "crank_speed");
  EXPECT_NEAR(-1.0 / model.continuous.a(0, 0), model.modes[0].time_constant, 1e-9 * model.modes[0].time_constant);
  EXPECT_NEAR(std::abs(model.modes[0].multiplier), linearisation.orbit.metrics[Metric::floquet_multiplier_max], 1e-7);
  const Eigen::MatrixXd response = sampled(model.continuous, model.map.period, 0, 600);
  for (Eigen::Index k = 0; k < model.steady_gain.rows(); ++k) {
    const double steady = model.steady_gain(k, 0);
    EXPECT_NEAR(response(599, k), steady, 1e-6 * std::abs(steady)) << model.map.outputs[std::size_t(k)].name;
  }
}

TEST(LinearModel, ALoadLeavesTheMeansOfASymmetricalDrive) {
  const Linearisation linearisation = linearise(direct_design());
  ASSERT_TRUE(linearisation.model);
  ASSERT_EQ(linearisation.model->map.inputs[1].name, "load_torque");
  EXPECT_EQ(linearisation.model->steady_gain(0, 1), 0.0);  // lift
  EXPECT_NE(linearisation.model->map.d(0, 1), 0.0);        // of its first cycle
  EXPECT_GT(linearisation.model->steady_gain(0, 0), 0.0);
}

TEST(LinearModel, IsNoneWhereNothingFlaps) {
  Design<double> design = reference_design();
  design.supply.voltage = 0.0;
  const Linearisation linearisation = linearise(design);
  EXPECT_EQ(linearisation.operating_point.status, FlappingStatus::stalled);
  EXPECT_FALSE(linearisation.model);
}

TEST(LoadTorque, EnsemblesLeaveItToTheScalarSolver) {
  Vehicle<double> loaded = resolve(reference_design());
  std::array<EnsembleMember, 2> members = {{{loaded, {}}, {loaded, {}}}};
  loaded.load_torque = members[1].vehicle.load_torque = 2e-5;
  std::array<EnsembleOutcome, 2> outcomes;
  solve_ensemble(members, {}, start_up_in_time(), outcomes);
  EXPECT_EQ(outcomes[0].scalar, !has_packs);
  EXPECT_TRUE(outcomes[1].scalar);
  const double frequency = accurate(loaded).metrics[Metric::frequency];
  EXPECT_NEAR(outcomes[1].metrics[Metric::frequency], frequency, 1e-6 * frequency);
  EXPECT_LT(frequency, 0.999 * outcomes[0].metrics[Metric::frequency]);
}

}  // namespace
}  // namespace wingbeat

// What the binary of an FMU runs, in this process: tests/fmu has the binary itself, its numbers and its functions.
#include <gtest/gtest.h>

#include <cmath>

#include "fmu/dependencies.hpp"
#include "fmu/instance.hpp"
#include "vehicle/direct_design.hpp"
#include "vehicle/hinged_design.hpp"

namespace wingbeat::fmu {
namespace {

std::vector<Design<double>> fmu_designs() {
  Design<double> pwm = reference_design(), stopped = hinged_design(1e-3);
  pwm.supply = {SupplyType::pwm, 4.0, 2e3, 0.75};
  stopped.pitch.stop = 0.4;
  Design<double> two_cranks = reference_design(), two_shafts = stopped;
  two_cranks.motors = two_shafts.motors = 2.0;
  return {reference_design(), pwm, direct_design(), hinged_design(1e-3), stopped, two_cranks, two_shafts};
}

/// Every output that there is, and the held means.
std::vector<double> all_outputs(const Instance& instance) {
  std::vector<double> values;
  for (const Variable& v : variables_of(instance.design())) {
    if (v.causality == "output" && v.kind != VariableKind::count) values.push_back(*instance.real(v.reference()));
  }
  return values;
}

TEST(FmuInstance, StatesComeBackBitForBit) {
  for (const Design<double>& design : fmu_designs()) {
    Instance one(design), other(design);
    one.initialise(0.0);
    ASSERT_EQ(one.step_to(0.11), StepResult::reached);
    const std::string state = one.save();
    ASSERT_EQ(one.step_to(0.2), StepResult::reached);
    other.restore(state);
    ASSERT_EQ(other.step_to(0.2), StepResult::reached);
    EXPECT_EQ(all_outputs(other), all_outputs(one));
    EXPECT_EQ(other.states(), one.states());
    EXPECT_THROW(other.restore(state.substr(0, state.size() - 1)), std::runtime_error);
    EXPECT_THROW(other.restore(state + "x"), std::runtime_error);
  }
}

TEST(FmuInstance, DerivativesAreThoseOfDifferences) {
  for (const Design<double>& design : fmu_designs()) {
    Instance one(design);
    one.initialise(0.0);
    ASSERT_EQ(one.step_to(0.1437), StepResult::reached);
    std::vector<std::size_t> unknowns;
    for (const Variable& v : variables_of(design)) {
      if (v.kind == VariableKind::derivative || v.kind == VariableKind::output) unknowns.push_back(v.reference());
    }
    const auto values = [&] {
      std::vector<double> found;
      for (const std::size_t reference : unknowns) found.push_back(*one.real(reference));
      return found;
    };
    std::vector<std::size_t> knowns;
    for (const Variable& v : variables_of(design)) {
      if (v.kind == VariableKind::state) knowns.push_back(v.reference());
    }
    const std::vector<double> states = one.states(), here = values();
    ASSERT_EQ(knowns.size(), states.size());
    for (std::size_t state = 0; state < states.size(); ++state) {
      const std::size_t known = knowns[state];
      const std::vector<double> exact = one.directional(unknowns, {{known, 1.0}});
      const double size = std::max(std::abs(states[state]), 1e-2), step = 1e-5 * size;
      std::vector<double> moved = states;
      moved[state] = states[state] + step;
      one.set_states(moved.data());
      const std::vector<double> more = values();
      moved[state] = states[state] - step;
      one.set_states(moved.data());
      const std::vector<double> less = values();
      one.set_states(states.data());
      for (std::size_t k = 0; k < unknowns.size(); ++k) {
        const double difference = (more[k] - less[k]) / (2.0 * step);
        EXPECT_NEAR(exact[k], difference, 1e-5 * (std::abs(exact[k]) + std::abs(here[k]) / size) + 1e-9)
            << unknowns[k] << " by " << known;
        const auto declared = dependencies_of(design, unknowns[k]);
        if (std::find(declared.begin(), declared.end(), known) == declared.end()) {
          EXPECT_EQ(exact[k], 0.0);
        }
      }
    }
  }
}

TEST(FmuInstance, ChangesOfInputsAndParametersCount) {
  Instance one(reference_design());
  one.initialise(0.0);
  ASSERT_EQ(one.step_to(0.5), StepResult::reached);
  const std::size_t frequency = reference_of(VariableKind::mean, std::size_t(MeanId::frequency));
  const double before = *one.real(frequency);
  EXPECT_TRUE(one.set_real(reference_of(VariableKind::input, std::size_t(InputId::voltage)), 3.3));
  ASSERT_EQ(one.step_to(1.0), StepResult::reached);
  EXPECT_GT(*one.real(frequency), 1.05 * before);
  for (const Variable& v : variables_of(one.design())) {
    if (v.name != "friction_radius") continue;
    EXPECT_TRUE(one.set_real(v.reference(), 4e-3));
    EXPECT_FALSE(one.set_real(v.reference(), -1.0));
  }
  const double fast = *one.real(frequency);
  ASSERT_EQ(one.step_to(1.5), StepResult::reached);
  EXPECT_LT(*one.real(frequency), fast);
}

double mean_of(const Instance& instance, MeanId which) {
  return *instance.real(reference_of(VariableKind::mean, std::size_t(which)));
}
Status status_of(const Instance& instance) {
  return Status(*instance.whole(reference_of(VariableKind::count, std::size_t(CountId::status))));
}
int cycles_of(const Instance& instance) {
  return *instance.whole(reference_of(VariableKind::count, std::size_t(CountId::cycles)));
}
bool drive_at(Instance& instance, double voltage) {
  return instance.set_real(reference_of(VariableKind::input, std::size_t(InputId::voltage)), voltage);
}

TEST(FmuInstance, ACrankThatRunsOutStandsAndCountsInBothDirections) {
  Instance one(reference_design());
  one.initialise(0.0);
  EXPECT_EQ(status_of(one), Status::starting);
  ASSERT_EQ(one.step_to(0.5), StepResult::reached);
  EXPECT_EQ(status_of(one), Status::flapping);
  const double frequency = mean_of(one, MeanId::frequency), lift = mean_of(one, MeanId::lift);
  const int cycles = cycles_of(one);
  EXPECT_TRUE(drive_at(one, 0.0));
  ASSERT_EQ(one.step_to(1.5), StepResult::reached);
  EXPECT_EQ(status_of(one), Status::standing);
  for (const MeanId mean : {MeanId::frequency, MeanId::lift, MeanId::current, MeanId::power_electrical}) {
    EXPECT_EQ(mean_of(one, mean), 0.0);
  }
  EXPECT_TRUE(drive_at(one, -3.0));
  ASSERT_EQ(one.step_to(1.52), StepResult::reached);
  EXPECT_EQ(status_of(one), Status::starting);
  EXPECT_EQ(mean_of(one, MeanId::lift), 0.0);
  ASSERT_EQ(one.step_to(2.5), StepResult::reached);
  EXPECT_EQ(status_of(one), Status::flapping);
  EXPECT_GT(cycles_of(one), cycles + 10);
  // The linkage is not the same the other way round, but near.
  EXPECT_NEAR(mean_of(one, MeanId::frequency), frequency, 0.2 * frequency);
  EXPECT_NEAR(mean_of(one, MeanId::lift), lift, 0.4 * lift);
  EXPECT_TRUE(drive_at(one, 3.0));
  ASSERT_EQ(one.step_to(3.5), StepResult::reached);
  EXPECT_NEAR(mean_of(one, MeanId::frequency), frequency, 1e-5 * frequency);
}

TEST(FmuInstance, WithoutVoltageItStandsFromTheStart) {
  Instance one(reference_design());
  EXPECT_TRUE(drive_at(one, 0.0));
  one.initialise(0.0);
  ASSERT_EQ(one.step_to(0.1), StepResult::reached);
  EXPECT_EQ(status_of(one), Status::standing);
  EXPECT_EQ(cycles_of(one), 0);
}

TEST(FmuInstance, AStepOfTooMuchWorkIsLeftOut) {
  for (const Design<double>& design : fmu_designs()) {
    Instance one(design);
    one.initialise(0.0);
    ASSERT_EQ(one.step_to(0.01), StepResult::reached);
    const std::vector<double> states = one.states();
    EXPECT_EQ(one.step_to(100.0, 2000), StepResult::too_much);
    EXPECT_EQ(one.time(), 0.01);
    EXPECT_EQ(one.states(), states);
    EXPECT_EQ(one.step_to(0.011), StepResult::reached);
  }
}

TEST(FmuInstance, RatesJumpWhereSmoothPiecesEnd) {
  Design<double> pwm = reference_design();
  pwm.supply = {SupplyType::pwm, 4.0, 2e3, 0.75};
  Instance one(pwm);
  one.initialise(0.0);
  one.handle_events();
  const double edge = one.next_event();
  ASSERT_EQ(one.step_to(0.999 * edge), StepResult::reached);
  one.set_time(edge);
  const std::vector<double> states = one.states(), rates = one.rates();
  one.handle_events();
  EXPECT_EQ(one.states(), states);
  EXPECT_NE(one.rates(), rates);
}

TEST(FmuInstance, OfTwoDrivesTheMomentsAreThoseOfTheirLifts) {
  Design<double> design = reference_design();
  design.motors = 2.0;
  Instance two(design);
  two.initialise(0.0);
  const std::size_t voltage = std::size_t(InputId::voltage);
  EXPECT_TRUE(two.set_real(reference_of(VariableKind::input, voltage, 1), 3.3));
  EXPECT_FALSE(two.set_real(reference_of(VariableKind::input, voltage), 3.0));
  ASSERT_EQ(two.step_to(0.3137), StepResult::reached);
  const auto output = [&](OutputId which, std::size_t side = 0) {
    return *two.real(reference_of(VariableKind::output, std::size_t(which), side));
  };
  const BladeElement<double> wings = resolve(design).wings;
  const double r = wings.s3 / wings.s2;
  double roll = 0.0, pitch = 0.0, yaw = 0.0, lift = 0.0;
  for (const std::size_t side : {1, 2}) {
    const double sign = side == 1 ? 1.0 : -1.0, beta = output(OutputId::stroke_angle, side);
    lift += output(OutputId::lift, side);
    roll += sign * output(OutputId::lift, side) * r * std::cos(beta);
    pitch += output(OutputId::lift, side) * r * std::sin(beta);
    yaw -= sign * output(OutputId::drag_moment, side);
  }
  EXPECT_NE(roll, 0.0);
  EXPECT_DOUBLE_EQ(output(OutputId::lift), lift);
  EXPECT_DOUBLE_EQ(output(OutputId::roll_moment), roll);
  EXPECT_DOUBLE_EQ(output(OutputId::pitch_moment), pitch);
  EXPECT_DOUBLE_EQ(output(OutputId::yaw_moment), yaw);
}

}  // namespace
}  // namespace wingbeat::fmu

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
  return {reference_design(), pwm, direct_design(), hinged_design(1e-3), stopped};
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
    ASSERT_TRUE(one.step_to(0.11));
    const std::string state = one.save();
    ASSERT_TRUE(one.step_to(0.2));
    other.restore(state);
    ASSERT_TRUE(other.step_to(0.2));
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
    ASSERT_TRUE(one.step_to(0.1437));
    std::vector<std::size_t> unknowns;
    for (const Variable& v : variables_of(design)) {
      if (v.kind == VariableKind::derivative || v.kind == VariableKind::output) unknowns.push_back(v.reference());
    }
    const auto values = [&] {
      std::vector<double> found;
      for (const std::size_t reference : unknowns) found.push_back(*one.real(reference));
      return found;
    };
    const std::vector<double> at = one.states(), here = values();
    for (std::size_t state = 0; state < at.size(); ++state) {
      const std::size_t known = reference_of(VariableKind::state, state);
      const std::vector<double> exact = one.directional(unknowns, {{known, 1.0}});
      const double size = std::max(std::abs(at[state]), 1e-2), step = 1e-5 * size;
      std::vector<double> moved = at;
      moved[state] = at[state] + step;
      one.set_states(moved.data());
      const std::vector<double> more = values();
      moved[state] = at[state] - step;
      one.set_states(moved.data());
      const std::vector<double> less = values();
      one.set_states(at.data());
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
  ASSERT_TRUE(one.step_to(0.5));
  const std::size_t frequency = reference_of(VariableKind::mean, std::size_t(MeanId::frequency));
  const double before = *one.real(frequency);
  EXPECT_TRUE(one.set_real(reference_of(VariableKind::input, std::size_t(InputId::voltage)), 3.3));
  ASSERT_TRUE(one.step_to(1.0));
  EXPECT_GT(*one.real(frequency), 1.05 * before);
  for (const Variable& v : variables_of(one.design())) {
    if (v.name != "friction_radius") continue;
    EXPECT_TRUE(one.set_real(v.reference(), 4e-3));
    EXPECT_FALSE(one.set_real(v.reference(), -1.0));
  }
  const double fast = *one.real(frequency);
  ASSERT_TRUE(one.step_to(1.5));
  EXPECT_LT(*one.real(frequency), fast);
}

}  // namespace
}  // namespace wingbeat::fmu

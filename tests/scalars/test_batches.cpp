// Batches against plain numbers, lane by lane, across every threshold of the equations.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scalars/arch/packs.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/ensemble/instruction_set.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

using lanes::Case;
constexpr int outputs = instant_size + step_size;

struct InstructionSet {
  const char* name;
  void (*evaluate)(const Case*, int, double*);
  int (*check_select)();
  void (*functions)(const double*, int, double*);
};

void PrintTo(const InstructionSet& set, std::ostream* out) { *out << set.name; }

/// Those that this processor can run.
std::vector<InstructionSet> instruction_sets() {
  std::vector<InstructionSet> sets = {{"base", lanes::evaluate_base, lanes::check_select_base, lanes::functions_base}};
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    sets.push_back({"avx2", lanes::evaluate_avx2, lanes::check_select_avx2, lanes::functions_avx2});
  }
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) {
    sets.push_back({"avx512", lanes::evaluate_avx512, lanes::check_select_avx512, lanes::functions_avx512});
  }
#endif
  return sets;
}

class Batches : public testing::TestWithParam<InstructionSet> {
 protected:
  void expect_packs_as_scalars(const std::vector<Case>& cases);
};

/// Numbers of one case by plain doubles.
std::array<double, outputs> scalar_outputs(const Case& c) {
  const auto numbers_at = instant<double>(
      c.vehicle, {std::sin(c.theta), std::cos(c.theta), c.omega, c.current, c.voltage, c.force, c.force});
  const auto step = crank_step<double>(c.vehicle, c.theta, {120.0 + std::abs(c.omega), c.current}, 0.1,
                                       {c.force, 1.0, 1.0, 1.0, 1.0});
  std::array<double, outputs> out;
  std::copy(numbers_at.begin(), numbers_at.end(), out.begin());
  std::copy(step.begin(), step.end(), out.begin() + instant_size);
  return out;
}

void Batches::expect_packs_as_scalars(const std::vector<Case>& cases) {
  std::vector<double> got(cases.size() * outputs);
  GetParam().evaluate(cases.data(), int(cases.size()), got.data());
  // Sums of terms that cancel keep the rounding of their terms: the typical size of an output stands for those.
  std::array<double, outputs> typical{};
  std::vector<std::array<double, outputs>> expected;
  for (const Case& c : cases) {
    expected.push_back(scalar_outputs(c));
    for (int n = 0; n < outputs; ++n) {
      typical[std::size_t(n)] += std::abs(expected.back()[std::size_t(n)]) / double(cases.size());
    }
  }
  constexpr std::size_t step = std::size_t(instant_size) + 2;
  typical[residual_at] += typical[motor_work_at];
  typical[step + std::size_t(Integral::residual_work)] += typical[step + std::size_t(Integral::motor_work)];
  for (std::size_t c = 0; c < cases.size(); ++c) {
    for (std::size_t n = 0; n < outputs; ++n) {
      const double value = expected[c][n];
      // The weights of a step are up to forty times what they add up to.
      const double rounding = n < instant_size ? 2e-14 : 2e-13;
      EXPECT_NEAR(got[c * outputs + n], value, rounding * (std::abs(value) + typical[n]))
          << "case " << c << " output " << n << " at theta " << cases[c].theta << " omega " << cases[c].omega;
    }
  }
}

enum class Inductance { some, none };

/// A vehicle of any friction law, condition and spring; formulation and coefficients as given.
Vehicle<double> mixed_vehicle(std::mt19937_64& random, Formulation formulation, Inductance inductance) {
  for (;;) {
    Design<double> d = random_design(random, 1.4);
    d.transmission.formulation = formulation;
    d.motor.constants.armature_inductance = inductance == Inductance::some ? 29e-3 : 0.0;
    const int condition = std::uniform_int_distribution<int>(0, 5)(random);
    Vehicle<double> v = resolve(d, condition == 0   ? Condition::wingless
                                   : condition == 1 ? Condition::vacuum
                                                    : Condition::air);
    v.source_resistance = 0.2 * v.motor.armature_resistance;
    // Near a jam rounding grows without bound.
    double least = 1.0;
    for (double theta = 0.0; theta < two_pi; theta += 0.05) {
      const auto k = crank_kinematics(v.transmission, std::sin(theta), std::cos(theta));
      for (const double s : {1.0, -1.0}) least = std::min(least, effective_inertia(v, k, s) / v.motor.inertia);
      if (k.wing_jacobian < 0.3 * v.transmission.slider_crank.hinge_offset) least = 0.0;
    }
    if (least > 0.5) return v;
  }
}

std::vector<Case> mixed_cases(Formulation formulation, Inductance inductance, int count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Case> cases;
  for (int n = 0; n < count; ++n) {
    Case c{mixed_vehicle(random, formulation, inductance),
           two_pi * unit(random),
           300.0 * (unit(random) - 0.3),
           unit(random) - 0.4,
           5.0 * unit(random),
           unit(random) < 0.5 ? 1.0 : -1.0};
    // Every kind of threshold, so that neighbouring lanes lie on different sides of it.
    switch (n % 8) {
      case 1: c.omega = 0.0; break;
      case 2: c.omega = unit(random) < 0.5 ? 1e-200 : -1e-200; break;
      case 3: c.theta = 0.5 * pi; break;
      case 4: c.theta = 1.5 * pi; break;
      case 5: {
        // Rod force zero: the force switch is linear in the current.
        Case still = c;
        still.current = 0.0;
        const double s0 = scalar_outputs(still)[9];
        still.current = 1.0;
        const double s1 = scalar_outputs(still)[9];
        if (std::abs(s1 - s0) > 0.1 * std::abs(s0)) c.current = -s0 / (s1 - s0);
        break;
      }
      case 6:
        c.omega = 0.0;
        c.current = 0.0;
        c.theta = 0.5 * pi;
        break;
      default: break;
    }
    cases.push_back(c);
  }
  return cases;
}

TEST_P(Batches, SelectTakesTheRightLanes) { EXPECT_EQ(GetParam().check_select(), 0); }

TEST_P(Batches, MixedVehiclesAgreeWithScalars) {
  for (const Formulation formulation : {Formulation::rod_force, Formulation::virtual_work}) {
    for (const Inductance inductance : {Inductance::some, Inductance::none}) {
      expect_packs_as_scalars(mixed_cases(formulation, inductance, 403));
    }
  }
}

TEST_P(Batches, ElementaryFunctionsKeepTheirErrors) {
  std::mt19937_64 random(5);
  for (const double reach : {1e-8, 0.5, 1.5707963267948966, 8.0, 30.0}) {
    std::vector<double> x(4096), out;
    for (double& value : x) value = std::uniform_real_distribution<double>(-reach, reach)(random);
    out.resize(x.size() * lanes::function_count);
    GetParam().functions(x.data(), int(x.size()), out.data());
    for (std::size_t n = 0; n < x.size(); ++n) {
      const double* got = out.data() + n * lanes::function_count;
      const double a = std::abs(x[n]) + 1e-3;
      // Of the argument's multiple of pi, the low part is left out.
      const double reduced = 1e-15 + 4e-17 * std::abs(x[n]);
      EXPECT_NEAR(got[0], std::sin(x[n]), reduced) << x[n];
      EXPECT_NEAR(got[1], std::cos(x[n]), reduced) << x[n];
      EXPECT_NEAR(got[2], std::atan(x[n]), 6e-16 * std::abs(std::atan(x[n]))) << x[n];
      EXPECT_NEAR(got[3] * a, 1.0, 5e-16) << x[n];
      EXPECT_NEAR(got[4] / std::sqrt(a), 1.0, 5e-16) << x[n];
      EXPECT_NEAR(got[5] * std::sqrt(a), 1.0, 5e-16) << x[n];
      EXPECT_EQ(got[6], std::nearbyint(x[n]));
      if (std::abs(x[n]) > 1.5707963267948966) continue;
      EXPECT_NEAR(got[7], std::sin(x[n]), 9e-16 * std::abs(x[n])) << x[n];
      EXPECT_NEAR(got[8], std::cos(x[n]), 3e-16) << x[n];
    }
  }
}

TEST_P(Batches, SpringsInSomeLanesOnly) {
  std::vector<Case> cases = mixed_cases(Formulation::virtual_work, Inductance::some, 64);
  for (std::size_t n = 0; n < cases.size(); ++n) cases[n].vehicle.spring.stiffness = n % 3 == 0 ? 1.4e-3 : 0.0;
  expect_packs_as_scalars(cases);
  for (Case& c : cases) c.vehicle.spring.stiffness = 0.0;
  expect_packs_as_scalars(cases);
}

TEST_P(Batches, IncompleteLastBatchLeavesNothingBehind) {
  std::vector<Case> cases = mixed_cases(Formulation::rod_force, Inductance::some, 9);
  for (int count = 1; count <= 9; ++count) {
    expect_packs_as_scalars(std::vector<Case>(cases.begin(), cases.begin() + count));
  }
}

INSTANTIATE_TEST_SUITE_P(Each, Batches, testing::ValuesIn(instruction_sets()),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace wingbeat

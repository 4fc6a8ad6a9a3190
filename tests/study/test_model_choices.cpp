// Choices of model in tolerance studies.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/study/tolerance.hpp"

namespace wingbeat {
namespace {

Design<double> vehicle_named(const std::string& name) {
  return read_design(std::string(WINGBEAT_DATA) + "/designs/" + name + ".toml");
}

UncertainParameter uniform(const char* key, double lower, double upper) {
  UncertainParameter p;
  p.parameter = design_parameter(key);
  p.distribution = {DistributionKind::uniform, 0.0, 1.0, lower, upper};
  return p;
}

ModelChoice choice_of(const std::string& name, const std::vector<double>& weights) {
  ModelChoice choice;
  choice.name = name;
  for (const double weight : weights) {
    choice.alternatives.push_back({name + std::to_string(choice.alternatives.size()), weight});
  }
  return choice;
}

std::size_t metrics_before(const ToleranceStudy& study, Metric metric) {
  std::size_t column = 0;
  for (int m = 0; m < int(metric); ++m) column += study.options.metrics[std::size_t(m)];
  return column;
}

/// Without wings and friction the frequency is the speed without load over 2 pi: proportional to the voltage, by a
/// factor that depends on the motor's damping.
struct WithoutWings {
  ToleranceStudy study;
  std::vector<double> factor;  ///< frequency over voltage, by alternative [Hz/V]

  explicit WithoutWings(const std::vector<double>& weights) {
    study.design = vehicle_named("friction2022");
    study.design.friction = {};
    study.design.friction.law = FrictionLaw::none;
    study.condition = Condition::wingless;
    study.options.metrics.reset();
    study.options.metrics.set(std::size_t(Metric::frequency));
    study.parameters.push_back(uniform("supply.voltage", 2.0, 4.0));
    study.choices.push_back(choice_of("damping", weights));
    for (std::size_t a = 0; a < weights.size(); ++a) {
      Design<double> d = study.design;
      const double damping = 3e-6 * double(1 + 3 * a);
      d.motor.constants.viscous_damping = damping;
      const double k = *design_parameter("motor.torque_constant").value(d);
      const double r = *design_parameter("motor.armature_resistance").value(d);
      factor.push_back(k / (k * k + r * damping) / (2.0 * std::numbers::pi));
      study.combinations.push_back(d);
    }
    study.design = study.combinations[study.choices[0].likeliest()];
  }
};

ToleranceResult result_of(const ToleranceStudy& study) {
  return assess_tolerance(study, solve_sweep(tolerance_sweep(study)), start_up_in_time());
}

TEST(ModelChoices, MomentsAndIndicesInClosedForm) {
  WithoutWings known({3.0, 1.0});
  known.study.count = 4096;
  known.study.resamples = 50;
  const ToleranceResult result = result_of(known.study);
  EXPECT_EQ(result.vehicles, 4U * 4096U);
  ASSERT_EQ(result.status[0].count, 8192U);
  const ToleranceOutput& f = *result.find("frequency_hz");

  // f = V c with V and c independent.
  const double voltage = 3.0, voltage_variance = 1.0 / 3.0;
  const double c = 0.75 * known.factor[0] + 0.25 * known.factor[1];
  const double c_squared = 0.75 * std::pow(known.factor[0], 2) + 0.25 * std::pow(known.factor[1], 2);
  const double c_variance = c_squared - c * c;
  const double by_voltage = voltage_variance * c * c, by_choice = voltage * voltage * c_variance;
  const double together = voltage_variance * c_variance, variance = by_voltage + by_choice + together;
  EXPECT_NEAR(f.mean, voltage * c, 1e-3 * f.mean);
  EXPECT_NEAR(f.deviation, std::sqrt(variance), 1e-3 * f.deviation);
  ASSERT_EQ(f.choices.size(), 1U);
  for (std::size_t a = 0; a < 2; ++a) {
    const ConditionalMoments& m = f.choices[0].alternatives[a];
    EXPECT_EQ(m.count, a == 0 ? 6144U : 2048U);
    EXPECT_NEAR(m.mean, voltage * known.factor[a], 2e-3 * m.mean) << a;
    EXPECT_NEAR(m.deviation, std::sqrt(voltage_variance) * known.factor[a], 5e-3 * m.deviation) << a;
  }
  EXPECT_NEAR(f.choices[0].difference, voltage * (known.factor[0] - known.factor[1]), 2e-3 * f.mean);
  EXPECT_NEAR(f.deviation_by_parameters, std::sqrt(voltage_variance * c_squared), 2e-3 * f.deviation);

  ASSERT_EQ(f.indices->inputs.size(), 2U);
  EXPECT_NEAR(f.indices->inputs[0].first, by_voltage / variance, 0.01);
  EXPECT_NEAR(f.indices->inputs[1].first, by_choice / variance, 0.01);
  EXPECT_NEAR(f.indices->inputs[0].total, (by_voltage + together) / variance, 0.01);
  EXPECT_NEAR(f.indices->inputs[1].total, (by_choice + together) / variance, 0.01);

  // The linear prediction is that of the first alternative, by the voltage alone.
  EXPECT_NEAR(f.linear_mean, voltage * known.factor[0], 1e-6 * f.mean);
  EXPECT_NEAR(f.linear_deviation, std::sqrt(voltage_variance) * known.factor[0], 1e-6 * f.mean);
  ASSERT_EQ(f.linear_share.size(), 2U);
  EXPECT_DOUBLE_EQ(f.linear_share[0], 1.0);
  EXPECT_TRUE(std::isnan(f.linear_share[1]));
}

TEST(ModelChoices, AChoiceAloneHasAllTheVariance) {
  WithoutWings known({1.0, 1.0, 2.0});
  known.study.parameters.clear();
  known.study.design.supply.voltage = 3.0;
  for (Design<double>& d : known.study.combinations) d.supply.voltage = 3.0;
  known.study.count = 256;
  const ToleranceResult result = result_of(known.study);
  const ToleranceOutput& f = *result.find("frequency_hz");
  EXPECT_NEAR(f.mean, 3.0 * (0.25 * known.factor[0] + 0.25 * known.factor[1] + 0.5 * known.factor[2]), 1e-6 * f.mean);
  EXPECT_NEAR(f.choices[0].difference, 3.0 * (known.factor[0] - known.factor[2]), 1e-6 * f.mean);
  EXPECT_NEAR(f.deviation_by_parameters, 0.0, 1e-6 * f.mean);
  EXPECT_NEAR(f.indices->inputs[0].total, 1.0, 0.05);
}

TEST(ModelChoices, SharesFollowTheWeights) {
  for (const ToleranceMethod method : {ToleranceMethod::sobol, ToleranceMethod::monte_carlo}) {
    WithoutWings known({1.0, 5.0, 2.0});
    known.study.method = method;
    known.study.count = 2048;
    EXPECT_EQ(known.study.choices[0].likeliest(), 1U);
    EXPECT_DOUBLE_EQ(known.study.choices[0].share(2), 0.25);
    std::vector<double> counts(3, 0.0);
    const auto combinations = drawn_combinations(known.study);
    for (std::size_t n = 0; n < 4096; ++n) ++counts[combinations[n]];
    for (std::size_t a = 0; a < 3; ++a) {
      const double share = known.study.choices[0].share(a);
      // Four standard deviations of a binomial distribution; the Sobol sequence is exact.
      const double off = method == ToleranceMethod::sobol ? 0.0 : 4.0 * std::sqrt(4096.0 * share * (1.0 - share));
      EXPECT_NEAR(counts[a], 4096.0 * share, off) << a;
    }
  }
}

TEST(ModelChoices, ParametersHaveTheSameSamplesWithAndWithoutChoices) {
  for (const ToleranceMethod method : {ToleranceMethod::sobol, ToleranceMethod::monte_carlo}) {
    WithoutWings known({1.0, 1.0});
    known.study.method = method;
    known.study.count = 128;
    known.study.parameters.push_back(uniform("motor.inertia", 1e-7, 2e-7));
    ToleranceStudy alone = known.study;
    alone.choices.clear();
    alone.combinations.clear();
    const Sweep with = tolerance_sweep(known.study), without = tolerance_sweep(alone);
    EXPECT_EQ(with.size(), 5U * 128U);
    EXPECT_EQ(without.size(), 4U * 128U);
    for (std::size_t q = 0; q < 2; ++q) {
      for (std::size_t n = 0; n < 4 * 128; ++n) {
        ASSERT_EQ(with.axes[0].quantities[q].values[n], without.axes[0].quantities[q].values[n]);
      }
    }
  }
}

TEST(ModelChoices, EveryVehicleHasItsAlternatives) {
  WithoutWings known({1.0, 1.0});
  ToleranceStudy& study = known.study;
  study.count = 64;
  study.choices.push_back(choice_of("inertia", {1.0, 1.0, 2.0}));
  const std::vector<Design<double>> damped = study.combinations;
  study.combinations.clear();
  for (const Design<double>& d : damped) {
    for (const double inertia : {1e-7, 2e-7, 3e-7}) {
      study.combinations.push_back(d);
      study.combinations.back().motor.constants.inertia = inertia;
    }
  }
  EXPECT_EQ(combination_count(study.choices), 6U);
  const auto inputs = factors(study);
  ASSERT_EQ(inputs.size(), 3U);
  EXPECT_EQ(inputs[2].name, "inertia");
  EXPECT_EQ(inputs[2].choice, 1U);
  const Sweep sweep = tolerance_sweep(study);
  const auto drawn = drawn_combinations(study);
  ASSERT_EQ(drawn.size(), 5U * 64U);
  const auto of_choice = [&](std::size_t n, std::size_t k) { return alternative_in(study.choices, drawn[n], k); };
  for (std::size_t n = 0; n < drawn.size(); ++n) {
    const Design<double> d = design_at(sweep, n).design;
    EXPECT_DOUBLE_EQ(d.motor.constants.inertia, 1e-7 * double(1 + of_choice(n, 1)));
    EXPECT_DOUBLE_EQ(d.motor.constants.viscous_damping, 3e-6 * double(1 + 3 * of_choice(n, 0)));
  }
  // A with one factor of B after the other.
  for (std::size_t n = 0; n < 64; ++n) {
    EXPECT_EQ(drawn[2 * 64 + n], drawn[n]);
    EXPECT_EQ(of_choice(3 * 64 + n, 0), of_choice(64 + n, 0));
    EXPECT_EQ(of_choice(3 * 64 + n, 1), of_choice(n, 1));
    EXPECT_EQ(of_choice(4 * 64 + n, 0), of_choice(n, 0));
    EXPECT_EQ(of_choice(4 * 64 + n, 1), of_choice(64 + n, 1));
  }
}

TEST(ModelChoices, VariancesWithinAndBetweenAlternativesAddUp) {
  ToleranceStudy study;
  study.design = vehicle_named("friction2022-springs");
  study.design.supply.voltage = 5.5;
  study.count = 128;
  study.resamples = 50;
  study.parameters.push_back(uniform("friction.radius", 2.2e-3, 2.8e-3));
  study.choices = {choice_of("formulation", {1.0, 1.0}), choice_of("mass", {3.0, 1.0})};
  for (const Formulation formulation : {Formulation::rod_force, Formulation::virtual_work}) {
    for (const double mass : {3.3e-3, 3.6e-3}) {
      study.combinations.push_back(study.design);
      study.combinations.back().transmission.formulation = formulation;
      study.combinations.back().mass = mass;
    }
  }
  const ToleranceResult result = result_of(study);
  const ToleranceOutput& lift = *result.find("lift_to_weight");
  ASSERT_EQ(lift.choices.size(), 2U);
  for (const ChoiceEffect& effect : lift.choices) {
    double squares = 0.0;
    std::uint64_t count = 0;
    for (const ConditionalMoments& m : effect.alternatives) {
      squares += double(m.count - 1) * m.deviation * m.deviation + double(m.count) * std::pow(m.mean - lift.mean, 2);
      count += m.count;
    }
    EXPECT_EQ(count, 256U);
    EXPECT_NEAR(squares / 255.0, lift.deviation * lift.deviation, 1e-10 * lift.deviation);
  }
  // The mass is in the weight alone: the same lift over another weight.
  const auto& by_mass = lift.choices[1].alternatives;
  EXPECT_NEAR(by_mass[0].mean / by_mass[1].mean, 3.6 / 3.3, 2e-3);
  EXPECT_NEAR(result.find("frequency_hz")->choices[1].difference, 0.0, 2e-3 * result.find("frequency_hz")->mean);
  EXPECT_EQ(result.find("frequency_hz")->indices->inputs[2].total, 0.0);
  EXPECT_LT(lift.deviation_by_parameters, lift.deviation);

  ASSERT_TRUE(result.hover);
  for (const auto& alternatives : result.choices) {
    std::uint64_t hover = 0, flapping = 0, count = 0;
    for (const AlternativeSamples& samples : alternatives) {
      hover += samples.hover->count;
      flapping += samples.flapping.count;
      count += samples.count;
    }
    EXPECT_EQ(hover, result.hover->count);
    EXPECT_EQ(flapping, result.status[0].count);
    EXPECT_EQ(count, 256U);
  }
}

TEST(ModelChoices, EqualAlternativesAreWorthNothing) {
  ToleranceStudy study;
  study.design = vehicle_named("friction2022-springs");
  study.count = 128;
  study.resamples = 100;
  study.parameters.push_back(uniform("friction.radius", 2.2e-3, 2.8e-3));
  study.choices = {choice_of("same", {1.0, 1.0})};
  study.combinations = {study.design, study.design};
  const ToleranceResult result = result_of(study);
  const ToleranceOutput& lift = *result.find("lift_mean_n");
  const SobolIndex& index = lift.indices->inputs[1];
  EXPECT_EQ(index.total, 0.0);
  EXPECT_LE(index.first_lower, 0.0);
  EXPECT_GE(index.first_upper, 0.0);
  EXPECT_LT(lift.choices[0].difference, 0.05 * lift.deviation);
  EXPECT_NEAR(lift.deviation_by_parameters, lift.deviation, 0.02 * lift.deviation);
}

TEST(ModelChoices, DrivesOfDifferentKindsAreSolvedAsAlone) {
  ToleranceStudy study;
  study.design = vehicle_named("friction2022-springs");
  study.count = 8;
  study.indices = false;
  study.parameters.push_back(uniform("vehicle.mass", 3e-3, 4e-3));
  study.choices = {choice_of("kind", {1.0, 1.0, 1.0, 1.0})};
  study.combinations = {study.design, vehicle_named("two-wing-direct"), vehicle_named("two-wing-four-bar"),
                        vehicle_named("pitch-hinge-crank")};
  const Sweep sweep = tolerance_sweep(study);
  const SweepColumns columns = solve_sweep(sweep);
  const auto drawn = drawn_combinations(study);
  const std::size_t column = metrics_before(study, Metric::lift_mean);
  std::vector<int> seen(4, 0);
  for (std::size_t n = 0; n < 8; ++n) {
    ++seen[drawn[n]];
    const DesignPoint alone = design_point(design_at(sweep, n).design, {}, {}, start_up_in_time());
    ASSERT_EQ(columns.status[n], std::int8_t(alone.status)) << drawn[n];
    ASSERT_EQ(alone.status, SweepStatus::flapping) << drawn[n];
    const double lift = alone.metrics[Metric::lift_mean];
    EXPECT_NEAR(columns.metrics[column][n], lift, 1e-5 * std::abs(lift)) << drawn[n];
  }
  EXPECT_THAT(seen, testing::Each(2));
}

}  // namespace
}  // namespace wingbeat

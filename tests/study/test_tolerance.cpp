#include "wingbeat/study/tolerance.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/run/sweep_run.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---- Distributions

/// Integral of x^k over the quantiles, by Gauss-like midpoints that crowd towards both ends.
double moment(const Distribution& d, int k) {
  constexpr int n = 20000;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double s = (i + 0.5) / n;
    const double u = s * s * (3.0 - 2.0 * s), weight = 6.0 * s * (1.0 - s) / n;
    sum += weight * std::pow(d.quantile(u), k);
  }
  return sum;
}

TEST(Distribution, MomentsAreThoseOfTheQuantiles) {
  const Distribution cases[] = {{DistributionKind::normal, 2.0, 0.3},
                                {DistributionKind::normal, 2.0, 0.3, 1.9, infinity},
                                {DistributionKind::normal, 2.0, 0.3, 3.0, 4.0},
                                {DistributionKind::normal, -1.0, 2.0, -5.0, -3.0},
                                {DistributionKind::lognormal, 2.0, 0.4},
                                {DistributionKind::lognormal, 2.0, 0.4, 1.0, 2.5},
                                {DistributionKind::uniform, 0.0, 1.0, -1.0, 3.0}};
  for (const Distribution& d : cases) {
    const double mean = moment(d, 1), variance = moment(d, 2) - mean * mean;
    EXPECT_NEAR(d.mean(), mean, 2e-5 * std::abs(mean));
    EXPECT_NEAR(d.variance(), variance, 5e-4 * variance);
  }
}

TEST(Distribution, QuantilesStayWithinTheBoundsAndFollowTheDistributionFunction) {
  const Distribution d{DistributionKind::normal, 0.0, 1.0, 6.0, 8.0};  // far out in the tail
  for (const double u : {1e-9, 0.1, 0.5, 0.9, 1.0 - 1e-9}) {
    const double x = d.quantile(u);
    EXPECT_GE(x, 6.0);
    EXPECT_LE(x, 8.0);
    const double inside =
        (normal_probability(-6.0) - normal_probability(-x)) / (normal_probability(-6.0) - normal_probability(-8.0));
    EXPECT_NEAR(inside, u, 1e-6);
  }
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
}

// ---- Sobol indices

SobolIndices indices_of(const std::function<double(const std::vector<double>&)>& f, std::size_t inputs, int rows,
                        bool sobol, std::uint64_t seed) {
  std::function<double(std::uint64_t, std::size_t)> u = PseudoRandom{seed};
  if (sobol) u = ScrambledSobol(2 * inputs, seed);
  std::vector<double> a, b;
  std::vector<std::vector<double>> mixed(inputs);
  for (int n = 0; n < rows; ++n) {
    std::vector<double> x(inputs), y(inputs);
    for (std::size_t i = 0; i < inputs; ++i) {
      x[i] = u(std::uint64_t(n), i);
      y[i] = u(std::uint64_t(n), inputs + i);
    }
    a.push_back(f(x));
    b.push_back(f(y));
    for (std::size_t i = 0; i < inputs; ++i) {
      std::vector<double> z = x;
      z[i] = y[i];
      mixed[i].push_back(f(z));
    }
  }
  return sobol_indices(a, b, mixed, 200, seed);
}

double ishigami(const std::vector<double>& u) {
  constexpr double pi = std::numbers::pi;
  const auto x = [&](std::size_t i) { return pi * (2.0 * u[i] - 1.0); };
  return std::sin(x(0)) + 7.0 * std::pow(std::sin(x(1)), 2) + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
}

TEST(SobolIndices, OfIshigamisFunction) {
  constexpr double pi = std::numbers::pi;
  const double p4 = std::pow(pi, 4), p8 = p4 * p4;
  const double v1 = 0.5 * std::pow(1.0 + 0.1 * p4 / 5.0, 2), v2 = 49.0 / 8.0, v13 = 0.01 * p8 * 8.0 / 225.0;
  const double v = v1 + v2 + v13;
  const SobolIndices s = indices_of(ishigami, 3, 8192, true, 7);
  EXPECT_NEAR(s.variance, v, 0.01 * v);
  EXPECT_NEAR(s.inputs[0].first, v1 / v, 0.01);
  EXPECT_NEAR(s.inputs[1].first, v2 / v, 0.01);
  EXPECT_NEAR(s.inputs[2].first, 0.0, 0.01);
  EXPECT_NEAR(s.inputs[0].total, (v1 + v13) / v, 0.01);
  EXPECT_NEAR(s.inputs[1].total, v2 / v, 0.01);
  EXPECT_NEAR(s.inputs[2].total, v13 / v, 0.01);
}

TEST(SobolIndices, OfTheGFunction) {
  const std::vector<double> a = {0.0, 1.0, 4.5, 9.0, 99.0, 99.0};
  const auto g = [&](const std::vector<double>& u) {
    double product = 1.0;
    for (std::size_t i = 0; i < a.size(); ++i) product *= (std::abs(4.0 * u[i] - 2.0) + a[i]) / (1.0 + a[i]);
    return product;
  };
  double all = 1.0;
  for (const double ai : a) all *= 1.0 + 1.0 / (3.0 * std::pow(1.0 + ai, 2));
  const double v = all - 1.0;
  const SobolIndices s = indices_of(g, a.size(), 8192, true, 3);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double vi = 1.0 / (3.0 * std::pow(1.0 + a[i], 2));
    EXPECT_NEAR(s.inputs[i].first, vi / v, 0.015) << i;
    EXPECT_NEAR(s.inputs[i].total, vi * all / (1.0 + vi) / v, 0.015) << i;
  }
}

TEST(SobolIndices, IntervalsCoverTheTruth) {
  // Independent rows, for which the bootstrap is made: 95 % of the intervals should hold the truth.
  constexpr double pi = std::numbers::pi;
  const double p4 = std::pow(pi, 4), v1 = 0.5 * std::pow(1.0 + 0.1 * p4 / 5.0, 2), v2 = 49.0 / 8.0;
  const double v13 = 0.01 * p4 * p4 * 8.0 / 225.0, v = v1 + v2 + v13;
  int first = 0, total = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const SobolIndex s = indices_of(ishigami, 3, 500, false, 1000 + std::uint64_t(trial)).inputs[0];
    first += s.first_lower <= v1 / v && v1 / v <= s.first_upper;
    total += s.total_lower <= (v1 + v13) / v && (v1 + v13) / v <= s.total_upper;
  }
  EXPECT_GE(first, 88);
  EXPECT_GE(total, 88);
}

TEST(SobolIndices, RowsWithoutAValueAreLeftOut) {
  const double nan = absent;
  const std::vector<double> a = {1.0, nan, 3.0, 4.0}, b = {2.0, 1.0, nan, 0.0};
  const std::vector<std::vector<double>> mixed = {{1.5, 1.0, 1.0, 2.0}};
  EXPECT_EQ(sobol_indices(a, b, mixed, 0, 1).rows, 2U);
  EXPECT_TRUE(std::isnan(sobol_indices(std::span(a).first(2), std::span(b).first(2), mixed, 10, 1).inputs[0].first));
}

// ---- A design with its gradient

Design<double> flapper(double voltage) {
  Design<double> d = read_design(std::string(WINGBEAT_DATA) + "/designs/friction2022-springs.toml");
  d.supply.voltage = voltage;
  return d;
}

/// The first of the keys is not varied where something is held.
void expect_central_differences(const Design<double>& d, std::span<const std::optional<Hold>> holds,
                                std::span<const char* const> keys) {
  std::vector<DesignParameter> parameters;
  for (const char* key : keys) parameters.push_back(design_parameter(key));
  for (const std::optional<Hold>& held : holds) {
    DesignPointOptions options;
    options.tolerance = 1e-11;
    options.hold = held;
    const DesignPoint point = design_point(d, options, parameters, {});
    ASSERT_EQ(point.status, SweepStatus::flapping);
    for (std::size_t k = held ? 1 : 0; k < parameters.size(); ++k) {
      const double x = *parameters[k].value(d), step = 1e-4 * x;
      const auto moved = [&](double by) {
        Design<double> other = d;
        parameters[k].set(other, x + by);
        return design_point(other, options, {}, {}).metrics;
      };
      const auto far_up = moved(2.0 * step), up = moved(step), down = moved(-step), far_down = moved(-2.0 * step);
      for (const Metric m : {Metric::voltage, Metric::lift_mean, Metric::lift_to_weight, Metric::power_electrical,
                             Metric::rod_force_peak}) {
        const double slope = (8.0 * (up[m] - down[m]) - (far_up[m] - far_down[m])) / (12.0 * step);
        const double scale = std::abs(point.metrics[m]) / x;
        if (m == Metric::rod_force_peak && !drive_of(d).rotates) continue;
        EXPECT_NEAR(point.gradients[k][std::size_t(m)], slope, 1e-6 * scale)
            << parameters[k].key << " " << metric_info(m).key << " " << (held ? int(held->held) : 0);
      }
    }
  }
}

TEST(DesignPoint, GradientsAgreeWithCentralDifferences) {
  const std::optional<Hold> holds[] = {std::nullopt, Hold{Held::frequency, 30.0}, Hold{Held::lift, 0.02},
                                       Hold{Held::lift_to_weight, 1.0}};
  const char* const of_crank[] = {"supply.voltage", "friction.radius", "vehicle.mass"};
  expect_central_differences(flapper(5.0), holds, of_crank);
  Design<double> direct = read_design(std::string(WINGBEAT_DATA) + "/designs/two-wing-direct.toml");
  const std::optional<Hold> lifts[] = {Hold{Held::lift, 0.004}, Hold{Held::lift_to_weight, 0.5}};
  const char* const of_direct[] = {"supply.amplitude", "motor.armature_resistance", "vehicle.mass"};
  expect_central_differences(direct, lifts, of_direct);
}

TEST(DesignPoint, SaysWhyAVehicleDoesNotFlap) {
  const DesignPoint locked = design_point(flapper(0.8), {}, {}, start_up_in_time());
  EXPECT_EQ(locked.status, SweepStatus::locked);
  EXPECT_THAT(describe(locked), testing::HasSubstr("crank angle"));
  Design<double> bad = flapper(3.0);
  bad.motor.constants.inertia = -1.0;
  const DesignPoint invalid = design_point(bad, {}, {}, {});
  EXPECT_EQ(invalid.status, SweepStatus::invalid);
  EXPECT_THAT(describe(invalid), testing::HasSubstr("motor.inertia"));
}

// ---- Studies of a vehicle

ToleranceStudy study_of(double voltage, double spread) {
  ToleranceStudy study;
  study.design = flapper(voltage);
  study.count = 512;
  study.resamples = 100;
  for (const auto& [key, relative] : {std::pair{"friction.radius", spread},
                                      {"motor.armature_resistance", spread},
                                      {"wing.inertia", spread},
                                      {"vehicle.mass", 0.5 * spread}}) {
    UncertainParameter p;
    p.parameter = design_parameter(key);
    const double x = *p.parameter.value(study.design);
    p.distribution = {DistributionKind::normal, x, relative * x};
    study.parameters.push_back(p);
  }
  return study;
}

ToleranceResult result_of(const ToleranceStudy& study) {
  return assess_tolerance(study, solve_sweep(tolerance_sweep(study)), start_up_in_time());
}

TEST(Tolerance, SmallScatterIsPredictedByTheGradient) {
  const ToleranceStudy study = study_of(5.3, 0.01);
  const ToleranceResult result = result_of(study);
  EXPECT_EQ(result.vehicles, 6U * 512U);
  EXPECT_EQ(result.status[0].count, 1024U);
  for (const char* name : {"lift_to_weight", "power_electrical_w", "frequency_hz", "rod_force_mean_n"}) {
    const ToleranceOutput& o = *result.find(name);
    EXPECT_NEAR(o.mean, o.linear_mean, 0.05 * o.deviation) << name;
    EXPECT_NEAR(o.deviation, o.linear_deviation, 0.03 * o.deviation) << name;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(o.indices->inputs[i].total, o.linear_share[i], 0.05) << name << i;
    }
  }
  ASSERT_TRUE(result.hover);
  EXPECT_GT(result.linear_hover, 0.01);
  EXPECT_LT(result.linear_hover, 0.99);
  EXPECT_NEAR(result.hover->share, result.linear_hover, 0.02);
  EXPECT_NEAR(result.find("hovers")->mean, result.hover->share, 1e-12);
  // The mass counts in the weight and nowhere else.
  EXPECT_DOUBLE_EQ(result.find("power_electrical_w")->linear_share[3], 0.0);
  EXPECT_DOUBLE_EQ(result.find("power_electrical_w")->indices->inputs[3].total, 0.0);
}

TEST(Tolerance, MonteCarloAndSobolAgree) {
  ToleranceStudy study = study_of(5.3, 0.05);
  study.indices = false;
  study.count = 2048;
  const ToleranceResult sobol = result_of(study);
  study.method = ToleranceMethod::monte_carlo;
  const ToleranceResult plain = result_of(study);
  EXPECT_EQ(plain.vehicles, 2048U);
  EXPECT_FALSE(plain.find("lift_to_weight")->indices);
  const ToleranceOutput &a = *sobol.find("lift_to_weight"), &b = *plain.find("lift_to_weight");
  EXPECT_NE(a.mean, b.mean);
  EXPECT_NEAR(a.mean, b.mean, 4.0 * a.deviation / std::sqrt(2048.0));
  EXPECT_NEAR(a.deviation, b.deviation, 0.08 * a.deviation);
  EXPECT_LE(plain.hover->lower, sobol.hover->share);
  EXPECT_GE(plain.hover->upper, sobol.hover->share);
}

TEST(Tolerance, VehiclesThatDoNotFlapAreCounted) {
  ToleranceStudy study = study_of(1.1, 0.3);  // near the voltage at which the springs hold the crank
  const ToleranceResult result = result_of(study);
  std::uint64_t all = 0;
  for (const Probability& p : result.status) all += p.count;
  EXPECT_EQ(all, 1024U);
  const std::uint64_t flapping = result.status[0].count;
  EXPECT_GT(flapping, 0U);
  EXPECT_LT(flapping, 1024U);
  EXPECT_GT(result.status[std::size_t(SweepStatus::locked)].count, 0U);
  ASSERT_TRUE(result.find("flaps"));
  EXPECT_NEAR(result.find("flaps")->mean, double(flapping) / 1024.0, 1e-12);
  EXPECT_LT(result.find("power_electrical_w")->indices->rows, 512U);
  EXPECT_EQ(result.find("flaps")->indices->rows, 512U);
}

TEST(Tolerance, AtAHeldWeightAllThatReachItHover) {
  ToleranceStudy study = study_of(5.0, 0.05);
  study.indices = false;
  study.hold = Hold{Held::lift_to_weight, 1.0};
  study.options.metrics.set(std::size_t(Metric::lift_to_weight)).set(std::size_t(Metric::voltage));
  const ToleranceResult result = result_of(study);
  ASSERT_TRUE(result.hover);
  EXPECT_GT(result.status[0].count, 256U);
  EXPECT_EQ(result.hover->count + result.outside.count, result.status[0].count);
  EXPECT_TRUE(std::isnan(result.linear_hover));
  const ToleranceOutput *lift = result.find("lift_to_weight"), *voltage = result.find("voltage_v");
  ASSERT_TRUE(lift && voltage);
  EXPECT_NEAR(lift->mean, 1.0, 1e-6);
  EXPECT_LT(lift->deviation, 1e-6);
  EXPECT_NEAR(voltage->deviation / voltage->linear_deviation, 1.0, 0.1);
}

TEST(Tolerance, CorrelatedParametersFollowTheirCovariance) {
  ToleranceStudy study = study_of(5.0, 0.02);
  study.parameters.resize(3);
  const double s0 = study.parameters[0].distribution.spread, s2 = study.parameters[2].distribution.spread;
  study.parameters[0].correlated = study.parameters[2].correlated = true;
  study.covariance = {{s0 * s0, -0.8 * s0 * s2}, {-0.8 * s0 * s2, s2 * s2}};
  study.covariance_name = "fitted";
  study.count = 4096;
  ASSERT_EQ(factors(study).size(), 2U);
  EXPECT_EQ(factors(study)[0].name, "fitted");
  const Sweep sweep = tolerance_sweep(study);
  EXPECT_EQ(sweep.size(), 4U * 4096U);
  const auto &x = sweep.axes[0].quantities[0].values, &y = sweep.axes[0].quantities[2].values;
  double sxy = 0.0, sxx = 0.0, syy = 0.0;
  for (std::size_t n = 0; n < 8192; ++n) {
    const double dx = x[n] - study.parameters[0].distribution.centre;
    const double dy = y[n] - study.parameters[2].distribution.centre;
    sxy += dx * dy;
    sxx += dx * dx;
    syy += dy * dy;
  }
  EXPECT_NEAR(sxy / std::sqrt(sxx * syy), -0.8, 0.005);
  EXPECT_NEAR(std::sqrt(sxx / 8192.0), s0, 0.01 * s0);
  // The mixed sample takes both from B, and the third parameter from A.
  for (const std::size_t n : {0U, 17U}) {
    EXPECT_EQ(x[2 * 4096 + n], x[4096 + n]);
    EXPECT_EQ(y[2 * 4096 + n], y[4096 + n]);
    EXPECT_EQ(sweep.axes[0].quantities[1].values[2 * 4096 + n], sweep.axes[0].quantities[1].values[n]);
  }
  const auto covariance = parameter_covariance(study);
  EXPECT_DOUBLE_EQ(covariance[0][2], study.covariance[0][1]);
  EXPECT_DOUBLE_EQ(covariance[0][1], 0.0);
}

TEST(Tolerance, CorrelationsNamedPairByPair) {
  ToleranceStudy study = study_of(5.0, 0.05);
  study.parameters.resize(4);
  Distribution& logarithmic = study.parameters[2].distribution;
  logarithmic.kind = DistributionKind::lognormal;
  logarithmic.spread = 0.3;
  study.correlations = {{0, 2, 0.6}, {3, 2, -0.5}};
  study.count = 4096;
  const auto inputs = factors(study);
  ASSERT_EQ(inputs.size(), 2U);
  EXPECT_EQ(inputs[0].parameters, (std::vector<std::size_t>{0, 2, 3}));
  EXPECT_EQ(inputs[1].parameters, (std::vector<std::size_t>{1}));
  EXPECT_TRUE(is_correlated(study, 2));
  EXPECT_FALSE(is_correlated(study, 1));

  // Samples have the covariance that the linear prediction takes, and 0 for the pair that is not named.
  const Sweep sweep = tolerance_sweep(study);
  const auto covariance = parameter_covariance(study);
  const auto sampled = [&](std::size_t i, std::size_t j) {
    const auto &x = sweep.axes[0].quantities[i].values, &y = sweep.axes[0].quantities[j].values;
    double sum = 0.0;
    for (std::size_t n = 0; n < 8192; ++n) {
      sum += (x[n] - study.parameters[i].distribution.mean()) * (y[n] - study.parameters[j].distribution.mean());
    }
    return sum / 8192.0;
  };
  for (const auto& [i, j] : {std::pair(0, 2), std::pair(2, 3), std::pair(0, 3), std::pair(0, 1), std::pair(2, 2)}) {
    const double scale = std::sqrt(covariance[i][i] * covariance[j][j]);
    EXPECT_NEAR(sampled(i, j), covariance[i][j], 0.01 * scale) << i << j;
  }
  EXPECT_EQ(covariance[0][3], 0.0);
  const double s0 = study.parameters[0].distribution.spread;
  EXPECT_NEAR(covariance[0][2], 0.6 * s0 * 0.3 * logarithmic.mean(), 1e-12 * covariance[2][2]);

  study.correlations = {{0, 2, 0.9}, {2, 3, 0.9}, {0, 3, -0.9}};
  EXPECT_THROW(tolerance_sweep(study), ParameterError);
}

TEST(Tolerance, IntervalsOfProbabilities) {
  const Probability none = probability_of(0, 100);
  EXPECT_DOUBLE_EQ(none.lower, 0.0);
  EXPECT_NEAR(none.upper, 0.0370, 5e-5);  // Wilson's interval: z^2 / (n + z^2)
  const Probability half = probability_of(50, 100);
  EXPECT_NEAR(half.lower, 0.4038, 5e-5);
  EXPECT_NEAR(half.upper, 0.5962, 5e-5);
}

}  // namespace
}  // namespace wingbeat

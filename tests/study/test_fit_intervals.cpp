// Intervals of bench fits under each loss: what they are made of. How often they hold the truth:
// scripts/check-coverage.
#include <gmock/gmock.h>

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "study/coverage_bench.hpp"
#include "study/fit_loss.hpp"
#include "wingbeat/report/fit_report.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;

const CoverageBench& coverage_bench() {
  static const CoverageBench bench;
  return bench;
}

/// The first `count` values of the current alone, and the friction radius.
BenchFit short_fit(std::size_t count, Loss loss) {
  BenchFit fit = coverage_bench().fit(loss, StatedDeviations::estimated, 0.0, 3);
  fit.logs[0].columns.resize(1);
  fit.logs[0].rows.resize(count);
  for (BenchRow& row : fit.logs[0].rows) row.values.resize(1);
  fit.parameters.resize(1);
  fit.parameters[0].start = 2.5e-3;
  fit.design.aerodynamics.pitch_coefficient = 5e-3;
  return fit;
}

std::string refusal(const BenchFit& fit) {
  try {
    fit_bench(fit);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(FitIntervals, HoldTheTruthWhereALossAndItsScaleComeFromTheSameResiduals) {
  // Of 60, intervals half as wide as they should be hold 40, a third as wide 29.
  for (const Loss loss : {Loss::huber, Loss::cauchy}) {
    for (const double outliers : {0.0, 0.05}) {
      if (loss == Loss::huber && outliers > 0.0) continue;
      int inside = 0, all = 0;
      double squares = 0.0;
      for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        BenchFit fit = coverage_bench().fit(loss, StatedDeviations::estimated, outliers, seed);
        fit.profiles = false;
        const FitResult r = fit_bench(fit);
        ASSERT_EQ(r.parameters.size(), 2U);
        for (std::size_t k = 0; k < 2; ++k) {
          const FittedParameter& p = r.parameters[k];
          const double truth = coverage_bench().truth(fit.parameters[k]);
          inside += truth >= p.lower_95 && truth <= p.upper_95;
          ++all;
        }
        const double speed = r.estimated_deviations.at({true, {}, WaveformQuantity::crank_speed});
        squares += std::pow(speed / coverage_bench().deviation(1), 2) / 30.0;
      }
      EXPECT_GE(inside, 53) << name_of(loss) << " of " << all;
      // Outliers count as 1.5 deviations each.
      EXPECT_NEAR(std::sqrt(squares), outliers > 0.0 ? 1.12 : 1.0, 0.1) << name_of(loss);
    }
  }
}

TEST(FitIntervals, ProfileAndStandardErrorAgreeUnderEveryLoss) {
  for (const Loss loss : {Loss::none, Loss::huber, Loss::soft_l1, Loss::cauchy}) {
    const FitResult r = fit_bench(coverage_bench().fit(loss, StatedDeviations::estimated, 0.0, 5));
    const FittedParameter& p = r.parameters[0];
    EXPECT_NEAR((p.profile_upper_95 - p.profile_lower_95) / (p.upper_95 - p.lower_95), 1.0, 0.2) << name_of(loss);
  }
}

TEST(FitIntervals, FollowStudentsDistributionDownToOneDegreeOfFreedom) {
  for (const std::size_t count : {3U, 5U, 9U}) {
    const FitResult r = fit_bench(short_fit(count, Loss::none));
    const double expected = boost::math::quantile(boost::math::students_t(double(count) - 1.0), 0.975);
    EXPECT_NEAR(r.parameters[0].quantile_95, expected, 0.02 * expected) << count;
    EXPECT_NEAR(r.parameters[0].profile_rise_95, expected * expected, 0.04 * expected * expected) << count;
  }
}

TEST(FitIntervals, AreRefusedWhereTooFewValuesShowTheScatter) {
  EXPECT_THAT(
      refusal(short_fit(5, Loss::cauchy)),
      HasSubstr("deviation.instantaneous current: cannot be \"estimated\": beside the fitted parameters its values "
                "leave 4.0 degrees of freedom, and intervals hold from 8 on; state it, or measure more"));
  BenchFit fit = coverage_bench().fit(Loss::none, StatedDeviations::estimated, 0.0, 3);
  fit.logs[0].rows.resize(5);
  EXPECT_THAT(refusal(fit), HasSubstr("and intervals hold from 6 on"));
  fit = short_fit(5, Loss::huber);
  fit.deviations[fit.logs[0].columns[0]] = {Deviation::Kind::absolute, coverage_bench().deviation(0)};
  EXPECT_THAT(refusal(fit), HasSubstr("fit.loss: huber takes the scatter from the residuals"));
  fit.loss = Loss::none;
  EXPECT_EQ(refusal(fit), "accepted");
  for (const double scale : {0.5, 8.0}) {
    fit = coverage_bench().fit(Loss::cauchy, StatedDeviations::estimated, 0.0, 3);
    fit.loss_scale = scale;
    EXPECT_THAT(refusal(fit), HasSubstr("fit.loss_scale: must lie between 1 and 4"));
  }
}

// A loss that bounds residuals bounds what chi square can reach as well.
TEST(FitIntervals, AMisfitIsSeenThroughARobustLoss) {
  for (const Loss loss : {Loss::huber, Loss::cauchy}) {
    BenchFit fit = coverage_bench().fit(loss, StatedDeviations::absolute, 0.0, 4);
    fit.loss_scale = 1.0;
    fit.profiles = false;
    for (BenchRow& row : fit.logs[0].rows) row.values[0] *= 1000.0;
    const FitResult wrong = fit_bench(fit);
    EXPECT_TRUE(wrong.misfit) << name_of(loss);
    const FitResult right = fit_bench(coverage_bench().fit(loss, StatedDeviations::absolute, 0.05, 4));
    EXPECT_FALSE(right.misfit) << name_of(loss);
    EXPECT_GT(right.p_value, 1e-6);
  }
}

TEST(FitIntervals, CountedSquaresHaveTheMeanOfNormalNoise) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  double sum = 0.0, squares = 0.0;
  const int count = 200000;
  for (int n = 0; n < count; ++n) {
    const double s = counted_square(Loss::cauchy, normal(random));
    sum += s / count;
    squares += s * s / count;
  }
  EXPECT_NEAR(sum, 1.0, 0.01);
  EXPECT_NEAR(2.0 / (squares - sum * sum), counted_information(Loss::cauchy), 0.05);
  for (const Loss loss : {Loss::none, Loss::huber, Loss::soft_l1, Loss::cauchy}) {
    for (const double r : {-4.0, -0.7, 0.3, 2.5}) {
      const double step = 1e-5;
      const LossAt middle = loss_at(loss, 1.5, r), up = loss_at(loss, 1.5, r + step),
                   down = loss_at(loss, 1.5, r - step);
      EXPECT_NEAR(2.0 * middle.psi, (up.rho - down.rho) / (2.0 * step), 1e-6) << name_of(loss);
      EXPECT_NEAR(middle.slope, (up.psi - down.psi) / (2.0 * step), 1e-6) << name_of(loss);
    }
  }
}

// A small parameter, uncertain by more than its size, stands for the same torque as another: neither its number nor
// that of the other is known as if it were not there.
TEST(FitIntervals, WhatIsLeftFreeWidensTheRest) {
  BenchFit fit = coverage_bench().fit(Loss::none, StatedDeviations::absolute, 0.0, 6);
  fit.profiles = false;
  const FittedParameter alone = fit_bench(fit).parameters[0];
  fit.parameters.push_back(free_parameter("motor.friction_torque", 0.0, 1e-3, 1e-4));
  const FitResult beside = fit_bench(fit);
  EXPECT_EQ(beside.parameters[2].undetermined, Undetermined::free_with_others);
  ASSERT_TRUE(beside.parameters[0].value);
  EXPECT_GT(beside.parameters[0].standard_error, 2.0 * alone.standard_error);
  // What its bounds say of it, they say of the other, too.
  fit.parameters.back().upper = 1e-4;
  const double bounded = fit_bench(fit).parameters[0].standard_error;
  EXPECT_GT(bounded, 1.3 * alone.standard_error);
  EXPECT_LT(bounded, 0.8 * beside.parameters[0].standard_error);
}

}  // namespace
}  // namespace wingbeat

#include "wingbeat/study/own_search.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "study/optimised_parameters.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

OptimiseStudy own_study() {
  OptimiseStudy study;
  study.design = read_design(std::string(WINGBEAT_DATA) + "/designs/friction2022-springs.toml");
  study.parameters = {between("supply.voltage", 3.0, 8.0), between("spring.stiffness", 0.0, 4e-3)};
  study.starts = 2;
  study.screen = 32;
  return study;
}

/// Power, and what lacks of a lift of `least` [N].
OwnTerms power_at_lift(double least, bool differentiated) {
  OwnTerms terms;
  terms.constraints = 1;
  terms.evaluate = [=](const Design<double>&, const DesignPoint& point) {
    OwnTerm power{point.metrics[Metric::power_electrical], differentiated};
    power.by_metric[std::size_t(Metric::power_electrical)] = 1.0;
    OwnTerm lift{1.0 - point.metrics[Metric::lift_mean] / least, differentiated};
    lift.by_metric[std::size_t(Metric::lift_mean)] = -1.0 / least;
    return std::vector{power, lift};
  };
  return terms;
}

TEST(OwnSearch, FindsTheOptimumByMetrics) {
  OptimiseStudy study = own_study();
  const double least = 0.03;
  for (const bool differentiated : {true, false}) {
    const OwnOptimum own = optimise_own(study, power_at_lift(least, differentiated), start_up_in_time());
    OptimiseStudy same = study;
    same.constraints = {{Metric::lift_mean, true, least}};
    const OptimiseResult found = optimise(same, start_up_in_time());
    ASSERT_EQ(own.outcome, OptimiseResult::Outcome::found);
    EXPECT_EQ(own.gradients, differentiated);
    const double tolerance = differentiated ? 1e-6 : 1e-4;
    EXPECT_NEAR(own.objective / found.point.metrics[Metric::power_electrical], 1.0, tolerance);
    EXPECT_EQ(own.design.supply.voltage, own.parameters[0]);
    if (differentiated) {
      EXPECT_NEAR(own.parameters[0] / found.parameters[0], 1.0, 1e-4);
    }
  }
}

TEST(OwnSearch, WhatATermThrowsGoesOn) {
  OptimiseStudy study = own_study();
  OwnTerms terms = power_at_lift(0.03, true);
  int calls = 0;
  // In the screening, and in a search.
  for (const int last : {5, 40}) {
    calls = 0;
    OwnTerms throwing = terms;
    throwing.evaluate = [&](const Design<double>& design, const DesignPoint& point) {
      if (++calls == last) throw std::logic_error("mine");
      return terms.evaluate(design, point);
    };
    EXPECT_THROW(optimise_own(study, throwing, start_up_in_time()), std::logic_error);
    EXPECT_EQ(calls, last);
  }
  OwnTerms fickle = terms;
  calls = 0;
  fickle.evaluate = [&](const Design<double>& design, const DesignPoint& point) {
    auto found = terms.evaluate(design, point);
    found[0].differentiated = ++calls < 40;
    return found;
  };
  EXPECT_THROW(optimise_own(study, fickle, start_up_in_time()), ParameterError);
}

}  // namespace
}  // namespace wingbeat

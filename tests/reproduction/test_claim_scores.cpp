// What the statements of the 2022 friction paper add up to: the headline, friction laws, rivals without friction.
#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "reproduction/assessed_paper.hpp"

namespace wingbeat {
namespace {

using enum StatementOutcome;

TEST(Claims, TheHeadlineCountsPredictionsOnly) {
  const Assessment& a = assessment();
  const Score s = a.score("");
  EXPECT_EQ(s.statements, 32);
  EXPECT_EQ(s.reproduced, 14);
  EXPECT_EQ(s.depends, 10);
  EXPECT_EQ(s.not_reproduced, 8);
  EXPECT_EQ(s.met, (std::array<int, variant_count>{22, 16, 17}));
  int counted = 0;
  for (const Claim& c : a.claims) {
    counted += c.counted();
    EXPECT_TRUE(c.basis == Basis::predicted || !c.counted()) << c.statement;
  }
  EXPECT_EQ(counted, s.statements + a.score(readings[0]).statements + a.score(readings[1]).statements);
  // A looser tolerance meets more, a tighter one fewer.
  EXPECT_LT(a.score("", Scoring::printed, 0.02).met[0], s.met[0]);
  EXPECT_GT(a.score("", Scoring::printed, 0.10).met[0], s.met[0]);
  // With changes as ratios more are met, in each variant.
  const Score ratios = a.score("", Scoring::ratios);
  EXPECT_EQ(ratios.met[0], s.met[0] + 3);
  EXPECT_EQ(ratios.met[1], s.met[1] + 3);
  EXPECT_EQ(ratios.met[2], s.met[2] + 3);
}

TEST(Claims, FrictionLawsAreScoredWithoutCalibratedValues) {
  for (const LawPrediction& p : assessment().laws) {
    EXPECT_EQ(p.tests.size(), 7U);
    EXPECT_EQ(p.seen.size(), 2U);  // frequency at 3 V and peak lift at 22 Hz, with springs
    double squares = 0.0;
    for (const std::size_t n : p.tests) {
      EXPECT_EQ(p.comparison.values[n].published.basis, Basis::predicted);
      squares += std::pow(p.comparison.values[n].deviation, 2.0);
    }
    EXPECT_NEAR(p.rms, std::sqrt(squares / 7.0), 1e-12);
    EXPECT_EQ(p.law.calibrated, p.rival != 0) << rivals[p.rival].name;
    if (p.variant != 0) continue;
    if (p.rival == load_proportional_rival) {
      EXPECT_NEAR(p.rms, 0.081, 1e-3);
      EXPECT_NEAR(p.rms_of_ratios, 0.035, 1e-3);
    } else {
      EXPECT_GT(p.rms, 0.48) << rivals[p.rival].name;
      EXPECT_GT(p.rms_of_ratios, 0.11) << rivals[p.rival].name;
    }
  }
  const Claim& best = claim("friction law that");
  EXPECT_EQ(best.outcome, reproduced);
  EXPECT_TRUE(best.within[recalibrated]);
}

TEST(Claims, MoreDragInPlaceOfFrictionIsNoAnswer) {
  const LawPrediction& p = assessment().laws[1];
  ASSERT_TRUE(rivals[p.rival].own_drag);
  EXPECT_NEAR(p.drag_factor, 2.26, 5e-3);
  // It meets the frequency without springs; springs then raise the input, where they are published to lower it.
  for (const ComparedValue& c : p.comparison.values) {
    if (c.published.metric == Metric::frequency && c.published.design == "spring_off") {
      EXPECT_NEAR(c.computed, 21.7, 1e-6);
    }
    if (c.published.metric != Metric::power_electrical) continue;
    EXPECT_EQ(c.published.published, -0.18);
    EXPECT_NEAR(c.computed, 0.06, 5e-3);
  }
}

TEST(Claims, WithoutFrictionTheInputIsHalf) {
  Design<double> design = paper().designs.at("spring_off");
  const double with = run_design(design, {.frequency = 22.0}).metrics[Metric::power_electrical];
  design.friction = {FrictionLaw::none, 0.0};
  const double without =
      run_design(design, {.frequency = 22.0, .allow_extrapolation = true}).metrics[Metric::power_electrical];
  EXPECT_NEAR(with, 0.544, 5e-4);
  EXPECT_NEAR(without, 0.274, 5e-4);
}

TEST(Claims, OneThatHoldsInOneFormulationDependsOnIt) {
  PublishedFile file = paper();
  file.trends.clear();
  std::erase_if(file.values, [](const PublishedValue& v) { return v.basis == Basis::calibrated; });
  const Assessment a = assess(file, [](std::size_t count, const std::function<void(std::size_t)>& act) {
    for (std::size_t n = 0; n < count; ++n) act(n);
  });
  ASSERT_EQ(a.claims.size(), file.values.size());
  EXPECT_TRUE(a.laws.empty());
  EXPECT_TRUE(a.calibrations.empty());  // no two peak lifts are left to calibrate to
  EXPECT_EQ(a.variants, 2U);
  EXPECT_EQ(a.claims[0].outcome, depends_on_formulation);
}

}  // namespace
}  // namespace wingbeat

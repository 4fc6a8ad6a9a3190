// What is said of each statement of the 2022 friction paper: its number, its outcome, and the counts of the headline.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/reproduction/claims.hpp"
#include "wingbeat/run/parallel.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;
using enum StatementOutcome;

const PublishedFile& paper() {
  static const PublishedFile file = read_published(WINGBEAT_DATA "/published/friction2022.toml");
  return file;
}

/// Assessed once, at its first use.
const Assessment& assessment() {
  static const Assessment a = assess(paper(), [](std::size_t count, const std::function<void(std::size_t)>& act) {
    for_each_in_parallel(count, act, 0);
  });
  return a;
}

const Claim& claim(const std::string& beginning) {
  for (const Claim& c : assessment().claims) {
    if (c.statement.rfind(beginning, 0) == 0) return c;
  }
  ADD_FAILURE() << "no statement begins with: " << beginning;
  static const Claim none{};
  return none;
}

TEST(Claims, EveryStatementHasAnOutcomeInBothFormulations) {
  for (const Claim& c : assessment().claims) {
    EXPECT_NE(c.outcome, no_published_value) << c.statement;
    for (std::size_t f = 0; f < variant_count; ++f) {
      EXPECT_FALSE(c.ours_text[f].empty()) << c.statement;
      EXPECT_NE(c.ours_text[f], "-") << c.statement;
    }
    if (c.outcome == not_checkable) {
      EXPECT_FALSE(c.reason.empty()) << c.statement;
      continue;
    }
    const int met = c.within[0] + c.within[1];
    EXPECT_EQ(c.outcome, met == 2 ? reproduced : met == 1 ? depends_on_formulation : not_reproduced) << c.statement;
  }
}

TEST(Claims, OneToleranceHoldsForAllNumbers) {
  EXPECT_EQ(paper().tolerance, 0.05);
  for (const Claim& c : assessment().claims) {
    if (!std::isfinite(c.tolerance)) continue;
    EXPECT_EQ(c.tolerance, 0.05) << c.statement;
    if (!c.reason.empty()) continue;
    for (std::size_t f = 0; f < variant_count; ++f) {
      EXPECT_EQ(c.within[f], std::abs(c.ours[f] / *c.published - 1.0) <= 0.05) << c.statement;
    }
  }
}

TEST(Claims, PublishedNumbersKeepTheDigitsOfThePaper) {
  EXPECT_EQ(claim("mean electrical input power").published_text, "0.82");
  EXPECT_EQ(claim("springs raise the electrical input").published_text, "17 Hz");
  EXPECT_EQ(claim("peak lift with springs").published_text, "26.0 mN");
  EXPECT_EQ(claim("gain in system efficiency").published_text, "4.7 percentage points");
  EXPECT_EQ(claim("at 5 V no crank without springs").published_text, "below 32.8 mN");
}

TEST(Claims, TheLeastReactivePowerIsFarBelowThePublishedFrequency) {
  const Claim& c = claim("with springs the mean absolute reactive power");
  EXPECT_NEAR(c.ours[0], 17.2, 0.1);
  EXPECT_EQ(*c.published, 22.0);
  EXPECT_EQ(c.outcome, not_reproduced);
  EXPECT_TRUE(c.counted());
}

TEST(Claims, MotorOutputMinusFrictionIsTheAerodynamicPowerByVirtualWorkOnly) {
  const Claim& c = claim("motor output minus friction");
  EXPECT_NEAR(c.ours[0], 79.19 / 64.17, 2e-4);
  EXPECT_NEAR(c.ours[1], 1.0, 1e-6);
  EXPECT_NEAR(c.ours[recalibrated], 1.0, 1e-6);
  EXPECT_EQ(c.outcome, depends_on_formulation);
  EXPECT_THAT(c.ours_text[0], HasSubstr("79.19 mW against 64.17 mW"));
}

TEST(Claims, TheGainInSystemEfficiencyIsAPrediction) {
  const Claim& c = claim("gain in system efficiency");
  EXPECT_TRUE(c.counted());
  EXPECT_NEAR(c.ours[0], 0.0468, 5e-5);
  EXPECT_TRUE(c.within[0]);
  EXPECT_FALSE(c.within[1]);
}

TEST(Claims, TheMotorsThirtyPerCentIsMeantInTheFlapper) {
  EXPECT_NEAR(claim("motor efficiency in the flapper").ours[0], 0.321, 5e-4);
  const Claim& better = claim("springs improve the motor efficiency");
  EXPECT_NEAR(better.ours[0], 0.330 - 0.321, 5e-4);
  EXPECT_EQ(better.outcome, reproduced);
  EXPECT_EQ(claim("efficiency that the motor's maker states").outcome, not_checkable);
}

TEST(Claims, ErrorsOfThePaperAreFlagged) {
  const Claim& rise = claim("peak lift is raised by springs");
  EXPECT_EQ(*rise.published, 0.399);
  EXPECT_NEAR(26.0 / 18.3 - 1.0, 0.421, 5e-4);
  EXPECT_THAT(rise.erratum, HasSubstr("42.1 %"));
  EXPECT_FALSE(rise.counted());
  EXPECT_THAT(claim("the springs resonate").erratum, HasSubstr("N m/rad is meant"));
  EXPECT_EQ(claim("the springs resonate").where, "section 4");
  EXPECT_THAT(claim("lift that carries the vehicle").where, HasSubstr("section 5"));
}

TEST(Claims, SectionFiveSupportsTheStrokeHeld) {
  const Score hinge = assessment().score(readings[0]), stroke = assessment().score(readings[1]);
  EXPECT_EQ(hinge.statements, 7);
  EXPECT_EQ(stroke.statements, 7);
  EXPECT_NEAR(hinge.rms_crank_radius, 0.38, 0.01);
  EXPECT_NEAR(stroke.rms_crank_radius, 0.15, 0.01);
  EXPECT_GT(stroke.met[0], hinge.met[0]);
  const std::string lift = "maximum mean lift at 5 V over crank radii 3 to 14 mm, with springs, ";
  EXPECT_NEAR(claim(lift + "stroke").ours[0], 34.7e-3, 5e-5);
  EXPECT_TRUE(claim(lift + "stroke").within[0]);
  EXPECT_NEAR(claim(lift + "hinge").ours[0], 33.0e-3, 1e-4);
  EXPECT_FALSE(claim(lift + "hinge").within[0]);
  EXPECT_NEAR(claim("crank radius of maximum system efficiency at 3 V, with springs, stroke").ours[0], 9.8e-3, 1e-4);
  for (const char* reading : readings) {
    const Claim& none = claim(std::string("at 5 V no crank without springs carries the weight: maximum mean lift over "
                                          "crank radii 3 to 14 mm, ") +
                              reading);
    EXPECT_TRUE(none.within[0]);
    EXPECT_FALSE(none.within[1]);
  }
}

TEST(Claims, WhatIsOutsideTheDomainSaysSo) {
  const Claim& lift = claim("maximum mean lift at 5 V over crank radii 3 to 14 mm, with springs, stroke");
  EXPECT_TRUE(lift.outside[0]);  // a residual of 6.7 % of the input
  EXPECT_FALSE(lift.outside[1]);
  EXPECT_THAT(lift.ours_text[0], HasSubstr("outside the domain, residual 6.7 %"));
  // Wings that pitch four times as much turn past the stroke plane with every crank, where the extrapolated
  // coefficients give 11.6 mN at 14 mm and -127 deg: no maximum is taken of that.
  PublishedFile file = paper();
  file.values.clear();
  std::erase_if(file.trends, [](const PublishedTrend& t) {
    return t.kind != PublishedTrend::Kind::peak || !t.hold_stroke || t.voltage != 5.0;
  });
  ASSERT_EQ(file.trends.size(), 2U);
  for (auto& [name, design] : file.designs) design.aerodynamics.pitch_coefficient *= 4.0;
  const Assessment a = assess(file, [](std::size_t count, const std::function<void(std::size_t)>& act) {
    for (std::size_t n = 0; n < count; ++n) act(n);
  });
  for (const Claim& c : a.claims) {
    EXPECT_FALSE(std::isfinite(c.ours[1])) << c.ours_text[1];
    EXPECT_EQ(c.ours_text[1], "none flaps inside the domain");
    EXPECT_FALSE(c.within[1]);
  }
}

TEST(Claims, RangesOfBestEfficiencyAreThoseOfThePublishedWidth) {
  const Claim &without = claim("range of best system efficiency without springs, crank of Table 2"),
              &with = claim("range of best system efficiency with springs, crank of Table 2");
  EXPECT_NEAR(without.ours[0] - 3.5, 10.9, 0.1);
  EXPECT_NEAR(with.ours[0] - 3.5, 18.6, 0.1);
  EXPECT_EQ(*with.published, 21.5);
  EXPECT_GT(without.deviation[1], 0.4);
}

TEST(Claims, ChordMomentsFollowFromTheTwoPeakLifts) {
  ASSERT_EQ(assessment().calibrations.size(), 2U);
  const MomentCalibration &rod = assessment().calibrations[0], &work = assessment().calibrations[1];
  EXPECT_TRUE(rod.met);
  EXPECT_NEAR(rod.s2 / 2.457e-6, 1.0, 2e-3);  // of the vehicle file
  EXPECT_NEAR(rod.s3 / 1.048e-7, 1.0, 4e-3);
  EXPECT_NEAR(rod.lift_peak[0] / 18.3e-3, 1.0, 1e-5);
  EXPECT_NEAR(rod.lift_peak[1] / 26.0e-3, 1.0, 1e-5);
  // virtual-work cannot have both peaks: the ratio of the two is highest at this S_3.
  EXPECT_FALSE(work.met);
  EXPECT_NEAR(work.s3, 1.543e-7, 5e-10);
  EXPECT_NEAR(work.lift_peak[0] / 18.3e-3 * work.lift_peak[1] / 26.0e-3, 1.0, 1e-6);
  EXPECT_LT(work.lift_peak[1] / work.lift_peak[0], 26.0 / 18.3);
  const SpringPair pair{paper().designs.at("spring_off"), paper().designs.at("spring_on")};
  for (const double factor : {0.9, 1.1}) {
    MomentCalibration other = work;
    other.s3 *= factor;
    double peaks[2];
    for (std::size_t n = 0; n < 2; ++n) {
      peaks[n] = run_design(with_moments(pair[n], other), {.frequency = 22.0}).metrics[Metric::lift_peak];
    }
    EXPECT_LT(peaks[1] / peaks[0], work.lift_peak[1] / work.lift_peak[0]) << factor;
  }
}

TEST(Claims, VirtualWorkIsNoBetterWithItsOwnCalibration) {
  const Assessment& a = assessment();
  EXPECT_NEAR(a.rms_of_predicted_values(0), 0.038, 1e-3);
  EXPECT_NEAR(a.rms_of_predicted_values(1), 0.088, 1e-3);
  EXPECT_NEAR(a.rms_of_predicted_values(recalibrated), 0.172, 2e-3);
}

TEST(Claims, TheHeadlineCountsPredictionsOnly) {
  const Assessment& a = assessment();
  const Score s = a.score("");
  EXPECT_EQ(s.statements, 24);
  EXPECT_EQ(s.reproduced, 10);
  EXPECT_EQ(s.depends, 10);
  EXPECT_EQ(s.not_reproduced, 4);
  EXPECT_EQ(s.met, (std::array<int, variant_count>{18, 12, 13}));
  int counted = 0;
  for (const Claim& c : a.claims) {
    counted += c.counted();
    EXPECT_TRUE(c.basis == Basis::predicted || !c.counted()) << c.statement;
  }
  EXPECT_EQ(counted, s.statements + a.score(readings[0]).statements + a.score(readings[1]).statements);
  // A looser tolerance meets more, a tighter one fewer.
  EXPECT_LT(a.score("", 0.02).met[0], s.met[0]);
  EXPECT_GT(a.score("", 0.10).met[0], s.met[0]);
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
  }
  const Claim& best = claim("friction law that");
  EXPECT_EQ(best.outcome, reproduced);
  EXPECT_TRUE(best.within[recalibrated]);
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

std::string refusal(const std::string& entry) {
  const std::string text =
      "title = 't'\nsource = 's'\n[designs]\na = 'a.toml'\n[[value]]\nvoltage = '3 V'\nmetric = "
      "'lift_mean_n'\ndesign = 'a'\npublished = '9 mN'\ntolerance = 0.1\n" +
      entry;
  try {
    parse_published(text, "x.toml",
                    [](const std::string&) { return read_design(WINGBEAT_DATA "/designs/friction2022.toml"); });
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Published, EntriesThatMeanNothingAreRefused) {
  EXPECT_EQ(refusal(""), "");
  const std::string trend = "[[trend]]\nstatement = 'x'\nwhere = 'y'\nbasis = 'predicted'\n";
  EXPECT_THAT(refusal("[[value]]\nvoltage = '3 V'\nmetric = 'lift_mean_n'\ndesign = 'a'\npublished = '9 mN'\n"),
              HasSubstr("tolerance: missing here, and the file states none for all"));
  EXPECT_THAT(refusal("[[value]]\nvoltage = '3 V'\nmetric = 'lift_mean_n'\ndesign = 'a'\npublished = '9 mm'\n"),
              HasSubstr("published"));
  EXPECT_THAT(refusal(trend + "kind = 'sum'\n"), HasSubstr("must be one of crossing, peak-at"));
  EXPECT_THAT(refusal(trend + "kind = 'change'\ndesign = 'a'\nmetric = 'lift_mean_n'\nvoltage = '3 V'\n"),
              HasSubstr("need a ratio"));
  EXPECT_THAT(refusal(trend + "kind = 'value'\ndesign = 'a'\nmetric = 'lift_mean_n'\n"),
              HasSubstr("give one of voltage and frequency"));
  EXPECT_THAT(
      refusal(trend + "kind = 'best-range'\ndesign = 'a'\nmetric = 'efficiency_system'\nfrom = '8 Hz'\nto = '30 "
                      "Hz'\npublished = ['17 Hz', '10 Hz']\ntolerance = 0.1\n"),
      HasSubstr("the second frequency must be above the first"));
  EXPECT_THAT(refusal(trend + "kind = 'weight'\ndesign = 'a'\nbound = 'below'\n"),
              HasSubstr("tolerance and bound belong to it"));
  EXPECT_THAT(refusal(trend + "kind = 'weight'\ndesign = 'a'\nmetric = 'lift_mean_n'\n"), HasSubstr("unknown key"));
}

}  // namespace
}  // namespace wingbeat

// What is said of each statement of the 2022 friction paper: its number, its outcome, and the counts of the headline.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "reproduction/assessed_paper.hpp"
#include "reproduction/statement_answers.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/files/tolerance_file.hpp"
#include "wingbeat/run/sweep_run.hpp"

namespace wingbeat {
namespace {

using testing::HasSubstr;
using enum StatementOutcome;

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
  EXPECT_EQ(claim("mean electrical input power").published_text, "-18 %");
  EXPECT_EQ(claim("mean electrical input power").digits, 0.005);
  EXPECT_EQ(claim("springs raise the electrical input").published_text, "about 17 Hz");
  EXPECT_EQ(claim("springs raise the electrical input").digits, 1.0);
  EXPECT_NEAR(claim("mean lift, change by springs at 3 V").digits, 0.0005, 1e-15);
  EXPECT_NEAR(claim("peak lift with springs").digits, 0.05e-3, 1e-15);
  EXPECT_NEAR(claim("motor efficiency in the flapper").digits, 0.05, 1e-15);  // 30 % is three tens
  EXPECT_EQ(claim("range of best system efficiency without springs, crank of Table 2").digits, 0.5);
  EXPECT_EQ(claim("peak lift with springs").published_text, "26.0 mN");
  EXPECT_EQ(claim("gain in system efficiency").published_text, "4.7 percentage points");
  EXPECT_EQ(claim("at 5 V no crank without springs").published_text, "below 32.8 mN");
}

TEST(Claims, TheLeastReactivePowerDependsOnHowItIsRead) {
  const Claim& c = claim("with springs the mean absolute reactive power is least");
  EXPECT_NEAR(c.ours[0], 17.2, 0.1);
  EXPECT_EQ(*c.published, 22.0);
  EXPECT_EQ(c.outcome, not_reproduced);
  EXPECT_TRUE(c.counted());
  // The dip is a minimum of a part of the range alone: the lower end of the range lies lower.
  EXPECT_EQ(c.window, "8.000 Hz to 30.00 Hz");
  EXPECT_THAT(c.ours_text[0], HasSubstr("12.83 mW at 8.000 Hz"));
  const Claim& share = claim("with springs the mean absolute reactive power, as a share");
  EXPECT_NEAR(share.ours[0], 21.5, 0.6);
  EXPECT_FALSE(share.counted());
  // Springs raise it at low frequency.
  EXPECT_EQ(claim("springs raise the mean absolute reactive power").outcome, reproduced);
  EXPECT_THAT(claim("springs raise the mean absolute reactive power").ours_text[0], HasSubstr("equal at 14.8"));
}

TEST(Claims, EverySearchNamesItsWindow) {
  int searched = 0;
  for (const PublishedTrend& t : paper().trends) {
    if (!(t.to > t.from) || t.kind == PublishedTrend::Kind::saturates) continue;
    ++searched;
    EXPECT_THAT(claim(t.statement).window, HasSubstr(" to ")) << t.statement;
  }
  EXPECT_GT(searched, 25);
}

TEST(Claims, EveryNumberCarriesItsDomainStatus) {
  int outside = 0;
  for (const Claim& c : assessment().claims) {
    for (std::size_t f = 0; f < variant_count; ++f) {
      const bool table = c.basis == Basis::given && c.statement.rfind("initial guesses", 0) != 0;
      const bool none = !std::isfinite(c.ours[f]) && c.ours_text[f] == "none flaps inside the domain";
      if (table || none || c.ours_text[f] == "not computed") {
        EXPECT_EQ(domain_text(c, f), "no cycle") << c.statement;
      } else {
        EXPECT_TRUE(std::isfinite(c.residual[f])) << c.statement << ", " << variant_name(f);
      }
      EXPECT_EQ(c.outside[f], c.residual[f] > formulation_residual_max);
      // What is outside says so where the number stands.
      EXPECT_EQ(c.outside[f], c.ours_text[f].find("outside the domain, residual") != std::string::npos) << c.statement;
      outside += c.outside[f];
      const bool conserves_power = f > 0;
      EXPECT_FALSE(conserves_power && c.outside[f]) << c.statement;
    }
  }
  EXPECT_GT(outside, 0);
}

TEST(Claims, TheAnswerStatesWhichOfItsNumbersAreOutsideTheDomain) {
  const TitleAnswer &rod = assessment().answers[0], &work = assessment().answers[1];
  EXPECT_NEAR(work.without, 0.236, 5e-4);
  EXPECT_NEAR(work.with, 0.414, 5e-4);
  EXPECT_FALSE(work.outside);
  EXPECT_NEAR(rod.without, 0.274, 5e-4);
  EXPECT_NEAR(rod.with, 0.544, 5e-4);
  EXPECT_TRUE(rod.outside);
  EXPECT_NEAR(rod.residual_without, 0.0622, 1e-4);
  EXPECT_LT(rod.residual_with, formulation_residual_max);
  // The program itself refuses it without --allow-extrapolation.
  Design<double> design = paper().designs.at("spring_off");
  design.friction = {FrictionLaw::none, 0.0};
  const RunResult refused = run_design(design, {.frequency = 22.0});
  ASSERT_TRUE(refused.search.has_value());
  EXPECT_NE(refused.search->outcome, FrequencyOutcome::reached);
}

TEST(Claims, TheChordMomentsAreCalibratedInsideTheDomain) {
  const SpringPair pair{paper().designs.at("spring_off"), paper().designs.at("spring_on")};
  for (const MomentCalibration& c : assessment().calibrations) {
    for (const Design<double>& design : pair) {
      EXPECT_TRUE(run_design(with_moments(design, c), {.frequency = 22.0}).domain.none()) << name_of(c.formulation);
    }
  }
}

TEST(Claims, ChangesAreScoredAsThePaperPrintsThem) {
  const Claim& c = claim("mean magnitude of the rod force, change by springs at 3 V");
  EXPECT_EQ(*c.published, -0.33);
  EXPECT_NEAR(c.ours[0], 0.6982 - 1.0, 5e-5);
  EXPECT_NEAR(c.deviation[0], -0.3018 / -0.33 - 1.0, 2e-4);
  EXPECT_NEAR(c.ratio_deviation[0], 0.6982 / 0.67 - 1.0, 2e-4);
  EXPECT_FALSE(c.met(0, Scoring::printed, 0.05));
  EXPECT_TRUE(c.met(0, Scoring::ratios, 0.05));
  EXPECT_FALSE(c.met(0, Scoring::digits, 0.05));
  int changes = 0;
  for (const PublishedValue& v : paper().values) changes += v.change;
  EXPECT_EQ(changes, 6);
}

TEST(Claims, MotorOutputMinusFrictionIsTheAerodynamicPowerByVirtualWorkOnly) {
  const Claim& c = claim("motor output minus friction");
  EXPECT_NEAR(c.ours[0], 79.19 / 64.17, 2e-4);
  EXPECT_NEAR(c.ours[1], 1.0, 1e-6);
  EXPECT_NEAR(c.ours[recalibrated], 1.0, 1e-6);
  EXPECT_EQ(c.outcome, depends_on_formulation);
  EXPECT_THAT(c.ours_text[0], HasSubstr("79.19 mW against 64.17 mW"));
}

TEST(Claims, WhatSpringsDoInGeneral) {
  const Claim& system = claim("springs raise the system efficiency in general");
  EXPECT_EQ(system.outcome, reproduced);
  EXPECT_THAT(system.ours_text[0], HasSubstr("higher in "));
  EXPECT_THAT(system.ours_text[0], HasSubstr("equal at 1"));  // not below 11 to 13 Hz
  EXPECT_EQ(claim("springs raise the mechanism efficiency in general").outcome, reproduced);
  const Claim& tuned = claim("springs still lower the electrical input above the frequency they are tuned to");
  EXPECT_EQ(tuned.outcome, reproduced);
  EXPECT_THAT(tuned.ours_text[0], HasSubstr("664."));
  EXPECT_THAT(tuned.ours_text[0], HasSubstr("instead of 869."));
  EXPECT_TRUE(claim("above 17 Hz springs raise the mean lift").within[0]);
  EXPECT_NEAR(claim("above 17 Hz springs raise the losses").ours[0], -0.106, 5e-4);
  EXPECT_FALSE(claim("above 17 Hz springs raise the losses").within[0]);
  EXPECT_NEAR(claim("change of the losses by springs at 22 Hz").ours[0], -0.236, 5e-4);
}

TEST(Claims, LossesGrowFromWinglessOverVacuumToAir) {
  EXPECT_EQ(claim("losses are least without wings").outcome, reproduced);
  EXPECT_EQ(claim("friction loss is least without wings").outcome, reproduced);
  EXPECT_EQ(claim("most of the electrical input is lost").outcome, reproduced);
  // Read in the other order it does not hold.
  PublishedFile file = paper();
  file.values.clear();
  std::erase_if(file.trends,
                [](const PublishedTrend& t) { return t.kind != PublishedTrend::Kind::ordered_conditions; });
  ASSERT_EQ(file.trends.size(), 2U);
  for (PublishedTrend& t : file.trends) t.metric = Metric::crank_speed_min;
  const Assessment a = assess(file, [](std::size_t count, const std::function<void(std::size_t)>& act) {
    for (std::size_t n = 0; n < count; ++n) act(n);
  });
  EXPECT_EQ(a.claims[0].outcome, not_reproduced) << a.claims[0].ours_text[0];
}

TEST(Claims, OnlySpringsAndNineMillimetresAreSaidToHover) {
  const std::string seven =
      "at 5 V only springs and a crank of 9 mm carry the weight: mean lift with springs and a "
      "crank of 7 mm, ";
  EXPECT_NEAR(claim(seven + "stroke held").ours[0], 33.14e-3, 5e-6);
  EXPECT_FALSE(claim(seven + "stroke held").within[0]);
  EXPECT_NEAR(claim(seven + "hinge offset held").ours[0], 32.86e-3, 5e-6);
  EXPECT_TRUE(claim(seven + "hinge offset held").outside[0]);
  EXPECT_TRUE(claim("at 5 V springs and a crank of 9 mm carry the weight: mean lift, stroke held").within[0]);
}

TEST(Claims, WhatCannotBeCheckedSaysWhy) {
  const Claim& wording = claim("the model captures the dynamics");
  EXPECT_EQ(wording.outcome, not_checkable);
  EXPECT_THAT(wording.reason, HasSubstr("not available"));
  EXPECT_THAT(claim("flapping frequency without springs at 3 V, as first stated").erratum, HasSubstr("later 21.7 Hz"));
  EXPECT_NEAR(claim("gain in system efficiency by springs at 22 Hz, read as a relative change").ours[0], 0.396, 2e-3);
}

TEST(Claims, IntervalsAreThoseOfTheProgramsOwnTolerance) {
  // The study as a user would run it.
  const ToleranceStudy study = read_tolerance_study(WINGBEAT_DATA "/studies/tolerance-friction2022.toml");
  std::size_t listed = 0;
  for (const UncertainPublished& u : paper().uncertain) {
    if (u.key == "spring.stiffness") continue;  // the vehicle has no springs
    ASSERT_LT(listed, study.parameters.size());
    const UncertainParameter& p = study.parameters[listed++];
    EXPECT_EQ(p.parameter.key, u.key);
    EXPECT_NEAR(p.distribution.spread / p.distribution.centre, u.relative_deviation, 1e-12) << u.key;
  }
  EXPECT_EQ(listed, study.parameters.size());
  const SweepColumns columns = solve_sweep(tolerance_sweep(study));
  const ToleranceResult result = assess_tolerance(study, columns, start_up_in_time());
  const ToleranceOutput* input = result.find("power_electrical_w");
  ASSERT_TRUE(input);
  // Seven dimensions there, six here: other points of the sequence, the same distribution.
  const TitleAnswer& rod = assessment().answers[0];
  EXPECT_NEAR(rod.with_interval.low, input->p025, 0.015 * rod.with);
  EXPECT_NEAR(rod.with_interval.high, input->p975, 0.015 * rod.with);
  EXPECT_LT(rod.change_interval.low, rod.change);
  EXPECT_GT(rod.change_interval.high, rod.change);
  EXPECT_LT(rod.change_interval.high, -0.3);  // friction matters whatever the parameters
  // Friction alone, a tenth more or less.
  Design<double> design = paper().designs.at("spring_off");
  const double radius = design.friction.coefficient;
  for (const auto& [factor, watt] : {std::pair(0.9, 0.513), std::pair(1.1, 0.575)}) {
    design.friction.coefficient = factor * radius;
    EXPECT_NEAR(run_design(design, {.frequency = 22.0}).metrics[Metric::power_electrical], watt, 5e-4);
  }
  // A change has an interval of its own, narrower than those of its two powers together.
  const Claim& change = claim("mean electrical input power, change by springs at 22 Hz");
  EXPECT_LT(change.interval[0].high - change.interval[0].low,
            (rod.with_interval.high - rod.with_interval.low) / rod.with);
  EXPECT_LT(change.interval[0].low, change.ours[0]);
  EXPECT_GT(change.interval[0].high, change.ours[0]);
}

// The interval of a searched number against searches of the whole window, one for each end of each deviation.
TEST(Claims, IntervalsOfSearchedNumbersAreThoseOfSearchesSolvedAnew) {
  using Kind = PublishedTrend::Kind;
  std::set<Kind> seen;
  SolvedPoints points;
  for (std::size_t n = 0; n < paper().trends.size(); ++n) {
    const PublishedTrend& t = paper().trends[n];
    const Claim& c = assessment().claims[paper().values.size() + n];
    if (!is_searched(t) || !std::isfinite(c.interval[0].low) || !seen.insert(t.kind).second) continue;
    EXPECT_TRUE(c.searched);
    double squares = 0.0;
    for (const UncertainPublished& u : paper().uncertain) {
      std::array<double, 2> ends{};
      for (const int end : {0, 1}) {
        PublishedFile file = paper();
        const DesignParameter parameter = design_parameter(u.key);
        for (auto& [name, design] : file.designs) {
          const auto value = parameter.value(design);
          if (value && *value > 0.0) parameter.set(design, *value * (1.0 + (2 * end - 1) * u.relative_deviation));
        }
        ends[std::size_t(end)] = answer_to(file, t, points).value;
      }
      squares += std::pow(0.5 * (ends[1] - ends[0]), 2.0);
    }
    const double half = 1.96 * std::sqrt(squares);
    EXPECT_NEAR(0.5 * (c.interval[0].high - c.interval[0].low), half, 0.01 * half) << t.statement;
    EXPECT_NEAR(0.5 * (c.interval[0].high + c.interval[0].low), c.ours[0], 1e-9 * std::abs(c.ours[0])) << t.statement;
  }
  EXPECT_EQ(seen, (std::set<Kind>{Kind::peak_at, Kind::trough_at, Kind::peak, Kind::crossing, Kind::best_range}));
  // At an end of the window an optimum has no interval, the largest lift there has.
  const Claim& radius = claim("crank radius of maximum mean lift at 3 V, with springs, stroke held");
  EXPECT_TRUE(std::isfinite(radius.interval[0].low));
  EXPECT_FALSE(std::isfinite(radius.interval[1].low));
  EXPECT_NEAR(radius.ours[1], 14e-3, 1e-6);
}

TEST(Claims, TheDragOfTheRivalHasAnInterval) {
  for (const LawPrediction& p : assessment().laws) {
    const bool drag = rivals[p.rival].own_drag && p.variant != recalibrated && p.law.calibrated;
    EXPECT_EQ(std::isfinite(p.drag_interval.low), drag);
    if (!drag) continue;
    EXPECT_LT(p.drag_interval.low, p.drag_factor - 0.05);
    EXPECT_GT(p.drag_interval.high, p.drag_factor + 0.05);
    EXPECT_LT(p.input_change_interval.low, p.input_change_interval.high);
  }
}

TEST(Claims, WithoutUncertainParametersThereAreNoIntervals) {
  PublishedFile file = paper();
  file.uncertain.clear();
  std::erase_if(file.trends, [](const PublishedTrend& t) { return t.kind != PublishedTrend::Kind::best_friction_law; });
  const Assessment a = assess(file, [](std::size_t count, const std::function<void(std::size_t)>& act) {
    for (std::size_t n = 0; n < count; ++n) act(n);
  });
  EXPECT_EQ(a.samples, 0U);
  EXPECT_FALSE(std::isfinite(a.answers[0].with_interval.low));
  EXPECT_NEAR(a.answers[0].with, 0.544, 5e-4);
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
  EXPECT_EQ(hinge.statements, 9);
  EXPECT_EQ(stroke.statements, 9);
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
  EXPECT_NEAR(a.rms_of_predicted_values(0, Scoring::ratios), 0.038, 1e-3);
  EXPECT_NEAR(a.rms_of_predicted_values(1, Scoring::ratios), 0.088, 1e-3);
  EXPECT_NEAR(a.rms_of_predicted_values(recalibrated, Scoring::ratios), 0.172, 2e-3);
  EXPECT_LT(a.rms_of_predicted_values(0), a.rms_of_predicted_values(1));
  EXPECT_LT(a.rms_of_predicted_values(1), a.rms_of_predicted_values(recalibrated));
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
  EXPECT_THAT(refusal("[[value]]\nvoltage = '3 V'\nmetric = 'lift_mean_n'\ndesign = 'a'\nchange = '9 %'\n"
                      "tolerance = 0.1\n"),
              HasSubstr("applies only to a ratio, instead of published"));
  EXPECT_THAT(refusal("[[uncertain]]\nkey = 'friction.radius'\nrelative_deviation = 0.4\nwhy = 'w'\n"),
              HasSubstr("must lie between 0 and 0.3"));
  EXPECT_THAT(refusal("[[uncertain]]\nkey = 'friction.colour'\nrelative_deviation = 0.1\nwhy = 'w'\n"),
              HasSubstr("friction.colour"));
  EXPECT_THAT(refusal(trend + "kind = 'wording'\n"), HasSubstr("why there is nothing to compute"));
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

// What searches, runs, points and flights found, in words.
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/study/run.hpp"

#include <gtest/gtest.h>

namespace wingbeat {
namespace {

using Finding = SearchFinding::Kind;
using VoltagePoint = SearchFinding::VoltagePoint;

const DomainEvidence falls{DomainLimit::angle_of_attack, DomainEvidence::Quantity::angle_of_attack_min, -5.0, 0.0,
                           90.0};
const StatusEvidence stalls{.kind = StatusEvidence::Kind::weak_motor, .torque = 0.001, .friction_torque = 0.002};

SearchFinding finding(Finding kind, Sought sought, SearchRange range = SearchRange::domain) {
  SearchFinding f;
  f.kind = kind;
  f.sought = sought;
  f.target = sought == Sought::lift ? 0.05 : 60.0;
  f.range = range;
  return f;
}

/// The sentence, which says "inside the domain of validity" exactly where the finding does.
std::string said(const SearchFinding& f) {
  const std::string text = describe(f);
  EXPECT_EQ(f.inside_domain_only(), text.find("inside the domain of validity") != std::string::npos) << text;
  return text;
}

TEST(DescribeSearch, Frequency) {
  const auto finding_of = [](Finding kind, SearchRange range = SearchRange::domain) {
    return finding(kind, Sought::frequency, range);
  };
  SearchFinding f = finding_of(Finding::reached);
  f.evidence = {.kind = StatusEvidence::Kind::orbit, .frequency = 60.0};
  EXPECT_EQ(said(f), "steady flapping at 60 Hz");
  f = finding_of(Finding::never_flaps);
  f.last_voltage = 12.5;
  f.status = FlappingStatus::stalled;
  f.evidence = stalls;
  EXPECT_EQ(
      said(f),
      "it flaps at no voltage up to 12.5 V; there it is stalled: the motor never starts: its stall torque 0.001 N "
      "m does not exceed the constant friction 0.002 N m");
  f = finding_of(Finding::out_of_range);
  f.point = VoltagePoint{9.0, 55.0};
  f.limits = {falls};
  EXPECT_EQ(said(f),
            "60 Hz cannot be reached inside the domain of validity: at 9 V, where it flaps at 55 Hz, the angle of "
            "attack falls to -5 deg (the coefficients hold from 0 to 90 deg)");
  f.max_point = VoltagePoint{8.0, 50.0};
  EXPECT_EQ(said(f),
            "60 Hz cannot be reached inside the domain of validity: at 9 V, where it flaps at 55 Hz, the angle of "
            "attack falls to -5 deg (the coefficients hold from 0 to 90 deg); inside it flaps at 50 Hz at most, at 8 "
            "V");
  f = finding_of(Finding::out_of_range, SearchRange::extrapolation);
  f.point = VoltagePoint{9.0, 55.0};
  EXPECT_EQ(said(f),
            "60 Hz cannot be reached: at 9 V, where it flaps at 55 Hz, the angle of attack falls below -360 deg");
  f = finding_of(Finding::beyond_any_voltage);
  f.stroke_amplitude = 50.0 / degrees_per_radian;
  f.highest_frequency = 41.0;
  EXPECT_EQ(said(f),
            "60 Hz cannot be reached inside the domain of validity: at a stroke amplitude of 50 deg, whatever the "
            "voltage, wings that flap at more than 41 Hz pass an angle of attack of 0 deg or Mach 0.3");
  f.range = SearchRange::extrapolation;
  EXPECT_EQ(said(f),
            "60 Hz cannot be reached in the range that is searched: at a stroke amplitude of 50 deg, whatever the "
            "voltage, wings that flap at more than 41 Hz pass an angle of attack of -360 deg or Mach 3");
  f = finding_of(Finding::jumps);
  f.point = VoltagePoint{9.0, 61.0};
  f.min_point = VoltagePoint{9.0, 40.0};
  EXPECT_EQ(said(f), "at 9 V the flapping frequency jumps from 40 Hz to 61 Hz: 60 Hz in between cannot be held");
  f = finding_of(Finding::too_low_at_first);
  f.point = VoltagePoint{0.5, 61.0};
  EXPECT_EQ(said(f), "60 Hz cannot be reached: at 0.5 V, the lowest voltage tried, it flaps at 61 Hz already");
  f = finding_of(Finding::too_low_at_onset);
  f.point = VoltagePoint{0.5, 61.0};
  f.evidence = stalls;
  EXPECT_EQ(said(f),
            "60 Hz cannot be reached: from rest it flaps only above 0.5 V, and there at 61 Hz already; below, it is "
            "stalled (the motor never starts: its stall torque 0.001 N m does not exceed the constant friction 0.002 N "
            "m)");
  f = finding_of(Finding::too_high);
  f.last_voltage = 20.0;
  f.max_point = VoltagePoint{12.0, 58.0};
  EXPECT_EQ(said(f), "60 Hz cannot be reached: up to 20 V it flaps at 58 Hz at most, at 12 V");
}

TEST(DescribeSearch, Lift) {
  const auto finding_of = [](Finding kind, SearchRange range = SearchRange::domain) {
    return finding(kind, Sought::lift, range);
  };
  EXPECT_EQ(said(finding_of(Finding::no_wings_in_air)),
            "0.05 N cannot be reached: without wings in air there is no lift");
  SearchFinding f = finding_of(Finding::out_of_range);
  f.point = VoltagePoint{9.0, 0.04};
  f.limits = {falls};
  EXPECT_EQ(said(f),
            "0.05 N cannot be reached inside the domain of validity: it leaves it at every voltage at which it flaps; "
            "at 9 V the angle of attack falls to -5 deg (the coefficients hold from 0 to 90 deg)");
  f.min_point = VoltagePoint{1.0, 0.01};
  f.max_point = VoltagePoint{8.0, 0.045};
  EXPECT_EQ(said(f),
            "0.05 N cannot be reached inside the domain of validity: at 9 V, where it lifts so much, the angle of "
            "attack falls to -5 deg (the coefficients hold from 0 to 90 deg); inside it lifts from 0.01 N, at 1 V, to "
            "0.045 N, at 8 V");
  f = finding_of(Finding::jumps);
  f.point = VoltagePoint{9.0, 0.06};
  f.min_point = VoltagePoint{9.0, 0.04};
  EXPECT_EQ(said(f), "at 9 V the mean lift jumps from 0.04 N to 0.06 N: 0.05 N in between cannot be held");
  f = finding_of(Finding::too_low_at_first, SearchRange::extrapolation);
  f.point = VoltagePoint{0.5, 0.06};
  EXPECT_EQ(said(f), "0.05 N cannot be reached: at 0.5 V, the lowest voltage tried, it lifts 0.06 N already");
  f = finding_of(Finding::too_low_at_onset);
  f.point = VoltagePoint{0.5, 0.06};
  f.evidence = stalls;
  EXPECT_EQ(said(f),
            "0.05 N cannot be reached inside the domain of validity: from rest it flaps only above 0.5 V, and there "
            "lifts 0.06 N already; below, it is stalled (the motor never starts: its stall torque 0.001 N m does not "
            "exceed the constant friction 0.002 N m)");
  f = finding_of(Finding::too_high);
  f.max_point = VoltagePoint{12.0, 0.045};
  f.last_voltage = 20.0;
  EXPECT_EQ(said(f),
            "0.05 N cannot be reached inside the domain of validity: it lifts 0.045 N at most, at 12 V (voltages up to "
            "20 V)");
  f.limits = {falls};
  f.full_duty_voltage = 6.0;
  EXPECT_EQ(said(f),
            "0.05 N cannot be reached inside the domain of validity: it lifts 0.045 N at most, at 12 V; at 20 V the "
            "angle of attack falls to -5 deg (the coefficients hold from 0 to 90 deg); a duty of 1 gives 6 V");
}

TEST(DescribeRun, PwmSuppliesAndSearches) {
  RunResult r;
  r.evidence = {.kind = StatusEvidence::Kind::orbit, .frequency = 17.0};
  EXPECT_EQ(describe(r), "steady flapping at 17 Hz");
  r.mean_voltage = 2.5;
  EXPECT_EQ(describe(r), "steady flapping at 17 Hz; the orbit sees the mean voltage of the pwm supply, 2.5 V");
  r.search.emplace();
  r.search->outcome = FrequencyOutcome::reached;
  r.search->finding = finding(Finding::reached, Sought::lift);
  r.design.supply.duty = 0.625;
  EXPECT_EQ(describe(r),
            "steady flapping at 17 Hz; the orbit sees the mean voltage of the pwm supply, 2.5 V, at a duty of 0.625");
  r.search->outcome = FrequencyOutcome::too_high;
  r.search->finding = finding(Finding::no_wings_in_air, Sought::lift);
  EXPECT_EQ(describe(r), "0.05 N cannot be reached: without wings in air there is no lift");
}

TEST(DescribeEndurance, EveryEnd) {
  EnduranceResult r;
  const std::string no_mass = "the vehicle file gives no mass, so that hover is unknown; ";
  r.end = EnduranceEnd::never_starts;
  r.evidence = stalls;
  r.first_charge = 0.75;
  r.first_voltage = 7.2;
  EXPECT_EQ(
      describe(r),
      "the battery cannot start the vehicle at a charge of 0.75 (7.2 V without load): the motor never starts: its "
      "stall torque 0.001 N m does not exceed the constant friction 0.002 N m");
  r.rows.resize(1);
  EnduranceRow& last = r.rows.back();
  last.terminal_voltage = 5.25;
  r.cutoff_voltage = 5.4;
  r.end = EnduranceEnd::empty;
  EXPECT_EQ(describe(r), "the battery is empty from the start");
  r.end = EnduranceEnd::cutoff;
  EXPECT_EQ(describe(r),
            "the terminal voltage of 5.25 V is not above the cut-off voltage, 5.4 V in all, from the start");
  last.time = 120.0;
  last.charge = 0.125;
  EXPECT_EQ(
      describe(r),
      no_mass + "the terminal voltage falls to the cut-off voltage, 5.4 V in all, after 120 s, at a charge of 0.125");
  r.end = EnduranceEnd::empty;
  EXPECT_EQ(describe(r), no_mass + "the battery is empty after 120 s");
  r.hover = Hover::kept;
  EXPECT_EQ(describe(r), "it hovers until the flight ends; the battery is empty after 120 s");
  r.hover = Hover::never;
  last.metrics[Metric::lift_to_weight] = 0.5;
  EXPECT_EQ(describe(r), "it does not hover: lift is 0.5 of the weight at the start; the battery is empty after 120 s");
  r.hover = Hover::unknown;
  r.end = EnduranceEnd::stops;
  EXPECT_EQ(
      describe(r),
      no_mass + "after 120 s, at a charge of 0.125 and 5.25 V at the terminals, the battery no longer turns the crank");
  r.end = EnduranceEnd::bridge;
  last.metrics[Metric::voltage] = 5.25;
  EXPECT_EQ(describe(r),
            no_mass +
                "the battery's terminal voltage falls to the amplitude of the bridge's sine, 5.25 V, after 120 s, at a "
                "charge of 0.125");
  last.time = 0.0;
  last.terminal_voltage = 5.0;
  EXPECT_EQ(describe(r), "under load the battery gives the bridge 5 V, less than the amplitude of its sine, 5.25 V");
  last.terminal_voltage = absent;
  last.metrics[Metric::power_electrical] = 2.0;
  EXPECT_EQ(describe(r), "the battery cannot give the 2 W that the bridge takes from it");
}

}  // namespace
}  // namespace wingbeat

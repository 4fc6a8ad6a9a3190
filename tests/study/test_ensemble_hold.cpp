#include "wingbeat/study/ensemble_hold.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "vehicle/kind_boxes.hpp"
#include "vehicle/random_vehicle.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

struct Results {
  std::vector<EnsembleOutcome> outcomes;
  std::vector<FrequencyOutcome> reached;
};

Results held(std::vector<EnsembleMember> members, const std::vector<Hold>& holds, const EnsembleOptions& options) {
  Results results{std::vector<EnsembleOutcome>(members.size()), std::vector<FrequencyOutcome>(members.size())};
  solve_ensemble_held(members, holds, options, start_up_in_time(), results.outcomes, results.reached);
  return results;
}

Results frequencies_of(std::vector<EnsembleMember> members, const std::vector<double>& frequencies,
                       const EnsembleOptions& options) {
  std::vector<Hold> holds;
  for (const double f : frequencies) holds.push_back({Held::frequency, f});
  return held(std::move(members), holds, options);
}

TEST(EnsembleHold, FindsTheVoltagesThatTheSearchOfOneFinds) {
  std::mt19937_64 random(20261121);
  std::uniform_real_distribution<double> frequency(8.0, 30.0);
  std::vector<EnsembleMember> members;
  std::vector<double> frequencies;
  for (int n = 0; n < 80; ++n) {
    const Design<double> design = random_design(random, 1.5);
    members.push_back({resolve(design), reporting_of(design)});
    frequencies.push_back(frequency(random));
  }
  EnsembleOptions options;
  const Results results = frequencies_of(members, frequencies, options);
  int reached = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    const FrequencySearch one = find_voltage_for_frequency(members[n].vehicle, frequencies[n], {}, start_up_in_time());
    ASSERT_EQ(results.reached[n], one.outcome) << n << ": " << describe(one.finding);
    const EnsembleOutcome& out = results.outcomes[n];
    if (one.outcome != FrequencyOutcome::reached) {
      EXPECT_EQ(out.status, one.status);
      EXPECT_TRUE(std::isnan(out.metrics[Metric::frequency]));
      continue;
    }
    ++reached;
    EXPECT_EQ(out.status, FlappingStatus::flapping);
    EXPECT_NEAR(out.metrics[Metric::frequency] / frequencies[n], 1.0, 1e-6);
    EXPECT_NEAR(out.metrics[Metric::voltage] / one.voltage, 1.0, 2e-6);
  }
  EXPECT_GT(reached, 50);
}

TEST(EnsembleHold, NeighboursDoNotMatter) {
  std::mt19937_64 random(7);
  std::vector<EnsembleMember> members;
  for (int n = 0; n < 12; ++n) members.push_back({resolve(random_design(random, 1.3)), {}});
  const std::vector<double> frequencies(members.size(), 18.0);
  const Results together = frequencies_of(members, frequencies, {});
  for (std::size_t n = 0; n < members.size(); ++n) {
    const Results alone = frequencies_of({members[n]}, {18.0}, {});
    EXPECT_EQ(alone.reached[0], together.reached[n]);
    for (int m = 0; m < metric_count; ++m) {
      const double a = alone.outcomes[0].metrics.values[std::size_t(m)];
      const double b = together.outcomes[n].metrics.values[std::size_t(m)];
      EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << metric_table()[std::size_t(m)].key;
    }
  }
}

/// Every batch's answer against the search of one, for lifts of all sizes from those below the onset to those that no
/// voltage yields.
void expect_lifts_of_one_by_one(const std::vector<EnsembleMember>& members, const std::vector<Hold>& holds, int reached,
                                int refused) {
  const Results results = held(members, holds, {});
  int found = 0, not_found = 0, scalar = 0;
  for (std::size_t n = 0; n < members.size(); ++n) {
    SteadyOptions steady;
    steady.reporting = members[n].reporting;
    const FrequencySearch one = find_voltage(members[n].vehicle, holds[n], steady, start_up_in_time());
    const bool yields = one.outcome == FrequencyOutcome::reached;
    const EnsembleOutcome& out = results.outcomes[n];
    ASSERT_EQ(results.reached[n] == FrequencyOutcome::reached, yields) << n << ": " << describe(one.finding);
    EXPECT_EQ(out.status, yields ? FlappingStatus::flapping : one.status) << n << ": " << describe(one.finding);
    scalar += out.scalar;
    (yields ? found : not_found) += 1;
    if (!yields) {
      EXPECT_TRUE(std::isnan(out.metrics[Metric::lift_mean])) << n;
      continue;
    }
    EXPECT_NEAR(out.metrics[Metric::lift_mean] / held_lift(holds[n], members[n].reporting), 1.0, 1e-6) << n;
    // A lift near its peak hardly changes with the voltage.
    Vehicle<double> beside = members[n].vehicle;
    beside.voltage = 1.001 * one.voltage;
    const double more = find_steady_flapping(beside, {}, start_up_in_time()).metrics[Metric::lift_mean];
    const double slope = (more / out.metrics[Metric::lift_mean] - 1.0) / 0.001;
    EXPECT_NEAR(out.metrics[Metric::voltage] / one.voltage, 1.0, 2e-6 / std::min(std::abs(slope), 1.0)) << n;
  }
  EXPECT_GE(found, reached);
  EXPECT_GE(not_found, refused);
  // Most are what batches are for.
  EXPECT_LT(scalar, int(members.size()) / 2);
}

TEST(EnsembleHold, FindsTheLiftsThatTheSearchOfOneFinds) {
  std::mt19937_64 random(20261126);
  std::uniform_real_distribution<double> log_lift(std::log(1e-3), std::log(0.5));
  std::vector<EnsembleMember> members;
  std::vector<Hold> holds;
  for (int n = 0; n < 80; ++n) {
    const Design<double> design = random_design(random, 1.5);
    members.push_back({resolve(design), reporting_of(design)});
    holds.push_back({Held::lift, std::exp(log_lift(random))});
  }
  expect_lifts_of_one_by_one(members, holds, 40, 8);
}

// Among them many whose lift has its peak just below or above the weight.
TEST(EnsembleHold, FindsTheLiftsOfAMapOverWingLengthAndGearRatio) {
  Design<double> d = read_design(std::filesystem::path(WINGBEAT_DATA) / "designs" / "two-wing-four-bar.toml");
  std::vector<EnsembleMember> members;
  std::vector<Hold> holds;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      d.wing.planform.length = 60e-3 + 4e-3 * i;
      d.motor.gear_ratio = 6.0 + 1.5 * j;
      members.push_back({resolve(d), reporting_of(d)});
      holds.push_back({Held::lift_to_weight, 1.0});
    }
  }
  expect_lifts_of_one_by_one(members, holds, 70, 10);
}

TEST(EnsembleHold, SettlesLiftsNextToTheLargestByBatches) {
  std::vector<EnsembleMember> members;
  std::vector<Hold> holds;
  std::vector<double> shares;
  for (const double C : {3e-3, 5e-3, 8e-3}) {
    Design<double> d = reference_design();
    d.aerodynamics.pitch_coefficient = C;
    const Vehicle<double> v = resolve(d);
    // The largest lift over voltages 0.1 % apart: less than the peak by no more than 1e-5 of it.
    std::vector<EnsembleMember> voltages;
    for (double voltage = 1.0; voltage < 30.0; voltage *= 1.001) {
      voltages.push_back({v, {}});
      voltages.back().vehicle.voltage = voltage;
    }
    std::vector<EnsembleOutcome> lifts(voltages.size());
    solve_ensemble(voltages, {.tolerance = 1e-8}, start_up_in_time(), lifts);
    double largest = 0.0;
    for (const EnsembleOutcome& out : lifts) {
      const bool inside = out.metrics[Metric::angle_of_attack_min] > 0.0;
      if (inside) largest = std::max(largest, out.metrics[Metric::lift_mean]);
    }
    for (const double share : {0.5, 0.9, 0.99, 0.999, 1.001, 1.01, 1.1, 2.0}) {
      members.push_back({v, {}});
      holds.push_back({Held::lift, share * largest});
      shares.push_back(share);
    }
  }
  const Results results = held(members, holds, {});
  for (std::size_t n = 0; n < members.size(); ++n) {
    EXPECT_EQ(results.reached[n] == FrequencyOutcome::reached, shares[n] < 1.0) << n << " " << shares[n];
    EXPECT_EQ(results.outcomes[n].status, FlappingStatus::flapping) << n;
    EXPECT_FALSE(has_packs && results.outcomes[n].scalar) << n << " " << shares[n];
    if (shares[n] > 1.0) continue;
    EXPECT_NEAR(results.outcomes[n].metrics[Metric::lift_mean] / holds[n].value, 1.0, 1e-6) << n;
  }
}

TEST(EnsembleHold, FindsTheLiftThatCarriesTheWeightOfEveryKindOfCrank) {
  std::mt19937_64 random(37);
  for (const KindBox box : {KindBox::tables, KindBox::pitch_stop, KindBox::pwm, KindBox::four_bar, KindBox::tabulated,
                            KindBox::gear_loss}) {
    SCOPED_TRACE(std::string(kind_box_names[std::size_t(box)]));
    std::vector<EnsembleMember> members;
    std::vector<Hold> holds;
    for (int n = 0; n < 12; ++n) {
      Design<double> design = kind_design(box, random);
      design.mass = 0.0011 + 0.0004 * n;
      members.push_back({resolve(design), reporting_of(design)});
      holds.push_back({Held::lift_to_weight, 1.0});
    }
    expect_lifts_of_one_by_one(members, holds, 3, 0);
  }
}

TEST(EnsembleHold, FindsThePowersThatTheSearchOfOneFinds) {
  std::mt19937_64 random(372);
  std::uniform_real_distribution<double> log_power(std::log(0.02), std::log(3.0));
  for (const KindBox box :
       {KindBox::reference, KindBox::pwm, KindBox::four_bar, KindBox::gear_loss, KindBox::coreless}) {
    SCOPED_TRACE(std::string(kind_box_names[std::size_t(box)]));
    std::vector<EnsembleMember> members;
    std::vector<Hold> holds;
    for (int n = 0; n < 20; ++n) {
      const Design<double> design = kind_design(box, random);
      members.push_back({resolve(design), reporting_of(design)});
      holds.push_back({Held::power, std::exp(log_power(random))});
    }
    const Results results = held(members, holds, {});
    int reached = 0;
    for (std::size_t n = 0; n < members.size(); ++n) {
      const FrequencySearch one = find_voltage(members[n].vehicle, holds[n], {}, start_up_in_time());
      ASSERT_EQ(results.reached[n] == FrequencyOutcome::reached, one.outcome == FrequencyOutcome::reached)
          << n << ": " << describe(one.finding);
      if (one.outcome != FrequencyOutcome::reached) continue;
      ++reached;
      EXPECT_NEAR(results.outcomes[n].metrics[Metric::power_electrical] / holds[n].value, 1.0, 1e-6);
      EXPECT_NEAR(results.outcomes[n].metrics[Metric::voltage] / one.voltage, 1.0, 2e-6);
    }
    EXPECT_GE(reached, 8);
  }
}

TEST(EnsembleHold, LiftsOfDirectDrivesAndWingsOnHingesAreSoughtOneByOne) {
  for (const char* name : {"two-wing-direct.toml", "pitch-hinge-crank.toml"}) {
    SCOPED_TRACE(name);
    const Design<double> design = read_design(std::string(WINGBEAT_DATA) + "/designs/" + name);
    const std::vector<EnsembleMember> members(2, {resolve(design), reporting_of(design)});
    const std::vector<Hold> holds = {{Held::lift, 0.005}, {Held::lift, 50.0}};
    const Results results = held(members, holds, {});
    EXPECT_EQ(results.reached[0], FrequencyOutcome::reached);
    EXPECT_NEAR(results.outcomes[0].metrics[Metric::lift_mean], 0.005, 5e-9);
    EXPECT_NE(results.reached[1], FrequencyOutcome::reached);
  }
}

TEST(EnsembleHold, RefusesLiftsThatAreNone) {
  std::vector<EnsembleMember> members = {{reference_vehicle(), {}}, {reference_vehicle(), {}}};
  EXPECT_THROW(held(members, {{Held::lift, 1.0}, {Held::lift, -1.0}}, {}), ParameterError);
  EXPECT_THROW(held(members, {{Held::lift, 1.0}, {Held::lift_to_weight, 1.0}}, {}), ParameterError);  // no mass
  EXPECT_THROW(held(members, {{Held::lift, 1.0}, {Held::frequency, 20.0}}, {}), ParameterError);
}

TEST(EnsembleHold, RefusesFrequenciesThatAreNone) {
  std::vector<EnsembleMember> members = {{reference_vehicle(), {}}};
  EXPECT_THROW(frequencies_of(members, {0.0}, {}), ParameterError);
  EXPECT_THROW(frequencies_of(members, {absent}, {}), ParameterError);
}

}  // namespace
}  // namespace wingbeat

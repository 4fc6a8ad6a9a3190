#include "wingbeat/study/ensemble_frequency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "vehicle/random_vehicle.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat {
namespace {

struct Results {
  std::vector<EnsembleOutcome> outcomes;
  std::vector<FrequencyOutcome> reached;
};

Results frequencies_of(std::vector<EnsembleMember> members, const std::vector<double>& frequencies,
                       const EnsembleOptions& options) {
  Results results{std::vector<EnsembleOutcome>(members.size()), std::vector<FrequencyOutcome>(members.size())};
  solve_ensemble_at_frequency(members, frequencies, options, start_up_in_time(), results.outcomes, results.reached);
  return results;
}

TEST(EnsembleFrequency, FindsTheVoltagesThatTheSearchOfOneFinds) {
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

TEST(EnsembleFrequency, NeighboursDoNotMatter) {
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

TEST(EnsembleFrequency, RefusesFrequenciesThatAreNone) {
  std::vector<EnsembleMember> members = {{reference_vehicle(), {}}};
  EXPECT_THROW(frequencies_of(members, {0.0}, {}), ParameterError);
  EXPECT_THROW(frequencies_of(members, {absent}, {}), ParameterError);
}

}  // namespace
}  // namespace wingbeat

// What tests of the batched solver share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {

inline EnsembleMember member_of(const Design<double>& design, Condition condition = Condition::air) {
  return {resolve(design, condition), reporting_of(design)};
}

inline std::vector<EnsembleOutcome> solve(const std::vector<EnsembleMember>& members, const EnsembleOptions& options,
                                          const StartUp& start_up = start_up_in_time()) {
  std::vector<EnsembleOutcome> outcomes(members.size());
  solve_ensemble(members, options, start_up, outcomes);
  return outcomes;
}

inline std::vector<InstructionSet> available() {
  std::vector<InstructionSet> sets;
  for (const auto& [name, isa] : instruction_sets) {
    if (is_available(isa)) sets.push_back(isa);
  }
  return sets;
}

inline bool same_bits(const EnsembleOutcome& a, const EnsembleOutcome& b) {
  return a.status == b.status && a.scalar == b.scalar &&
         std::memcmp(&a.error_estimate, &b.error_estimate, sizeof(double)) == 0 &&
         std::memcmp(&a.metrics, &b.metrics, sizeof a.metrics) == 0;
}

/// Solves members again, shuffled and in runs of odd lengths: no outcome depends on its position or its batch.
inline void expect_equal_in_any_batch(const std::vector<EnsembleMember>& members, const EnsembleOptions& options) {
  const auto together = solve(members, options);
  std::vector<std::size_t> order(members.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  std::mt19937_64 random(5);
  std::shuffle(order.begin(), order.end(), random);
  for (std::size_t start = 0, length = 1; start < order.size(); start += length, length = (3 * length + 2) % 61 + 1) {
    std::vector<EnsembleMember> some;
    for (std::size_t n = start; n < std::min(start + length, order.size()); ++n) some.push_back(members[order[n]]);
    const auto alone = solve(some, options);
    for (std::size_t n = 0; n < some.size(); ++n) {
      EXPECT_TRUE(same_bits(alone[n], together[order[start + n]])) << "member " << order[start + n];
    }
  }
}

/// Members of a comparison that is to show one in a thousand.
#ifdef WINGBEAT_SANITIZED
inline constexpr int many_members = 8000;
#else
inline constexpr int many_members = 20000;
#endif

/// Start-up in time, asked once per vehicle: both solvers of a comparison share its answers.
inline StartUp remembered_start_up() {
  auto known = std::make_shared<std::map<std::vector<double>, StartUpOutcome>>();
  return [known, assess = start_up_in_time()](const Vehicle<double>& v, const Arrival&) {
    std::vector<double> key;
    for_each_number(v, [&](double x) { key.push_back(std::isnan(x) ? -infinity : x); });
    const auto [entry, is_new] = known->try_emplace(key);
    if (is_new) entry->second = assess(v, {});
    return entry->second;
  };
}

/// What an error of a metric is measured by: the metric, but for those that may vanish.
inline double scale_of(Metric metric, const Metrics<double>& m) {
  if (metric == Metric::power_residual) return std::abs(m[Metric::power_motor]);
  if (metric == Metric::angle_of_attack_min) return 90.0;
  return std::abs(m[metric]);
}

/// Largest relative error of the metrics, the Floquet multiplier aside; infinite where only one of two is absent.
inline double largest_error(const Metrics<double>& got, const Metrics<double>& expected, std::string* where = nullptr) {
  double largest = 0.0;
  for (int k = 0; k < metric_count; ++k) {
    const Metric metric = Metric(k);
    if (metric == Metric::floquet_multiplier_max) continue;
    if (std::isnan(got[metric]) != std::isnan(expected[metric])) return INFINITY;
    const double difference = std::abs(got[metric] - expected[metric]);
    if (!(difference > largest * scale_of(metric, expected))) continue;
    largest = difference / scale_of(metric, expected);
    if (where) *where = metric_table()[std::size_t(k)].key;
  }
  return largest;
}

/// What a comparison of outcomes counts.
struct Agreement {
  int flapping = 0, by_packs = 0, outside = 0;
};

/// Counts what flaps, and whose metrics are outside the tolerance; all states must be equal, and no error beyond `far`
/// tolerances. With `multipliers` these must be good to three digits.
inline Agreement agreement(const std::vector<EnsembleOutcome>& got, const std::vector<EnsembleOutcome>& expected,
                           double tolerance, double far, bool multipliers = false) {
  Agreement found;
  for (std::size_t n = 0; n < got.size(); ++n) {
    EXPECT_EQ(got[n].status, expected[n].status) << n;
    if (expected[n].status != FlappingStatus::flapping) continue;
    ++found.flapping;
    found.by_packs += !got[n].scalar;
    std::string where;
    const double error = largest_error(got[n].metrics, expected[n].metrics, &where);
    EXPECT_LT(error, far * tolerance) << n << ' ' << where << " at " << tolerance;
    const double multiplier = expected[n].metrics[Metric::floquet_multiplier_max];
    const double off = std::abs(got[n].metrics[Metric::floquet_multiplier_max] - multiplier);
    found.outside += error > tolerance || (multipliers && off > 2e-3 * multiplier + 1e-6);
  }
  return found;
}

}  // namespace wingbeat

// What tests of the batched solver share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/study/run.hpp"

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

/// Solves members again, shuffled and in runs of odd lengths: no outcome depends on place or company.
inline void expect_no_company(const std::vector<EnsembleMember>& members, const EnsembleOptions& options) {
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

}  // namespace wingbeat

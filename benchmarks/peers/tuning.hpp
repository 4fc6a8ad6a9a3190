// How accurate answers are, and the loosest setting of a method that is accurate enough.
#pragma once

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "peers/equations.hpp"

namespace wingbeat::peers {

inline constexpr double goal = 1e-6;              // lift error that every method is to reach at the median
inline constexpr double high_goal = 10.0 * goal;  // and at the 99th percentile

// Processor time, so that other programs count as little as they can.
inline double seconds_of(const std::function<void()>& f) {
  const std::clock_t start = std::clock();
  f();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

struct Answers {
  std::vector<Steady> got, exact;
  double seconds = 0.0;  // per answer
};

struct Errors {
  double median, high, worst, others;
  int failed = 0;
};

inline double quantile(const std::vector<double>& sorted, double q) {
  return sorted.empty() ? absent : sorted[std::size_t(std::ceil(q * double(sorted.size() - 1)))];
}

inline Errors errors_of(const Answers& answers) {
  Errors e{};
  std::vector<double> lift;
  for (std::size_t n = 0; n < answers.got.size(); ++n) {
    const Steady& got = answers.got[n];
    const Steady& exact = answers.exact[n];
    if (!std::isfinite(got.lift)) {
      ++e.failed;
      continue;
    }
    lift.push_back(std::abs(got.lift / exact.lift - 1.0));
    e.others =
        std::max({e.others, std::abs(got.power / exact.power - 1.0), std::abs(got.frequency / exact.frequency - 1.0)});
  }
  std::sort(lift.begin(), lift.end());
  e.median = quantile(lift, 0.5);
  e.high = quantile(lift, 0.99);
  e.worst = lift.empty() ? absent : lift.back();
  return e;
}

struct Rival {
  std::string name;
  std::string missing;  // why it cannot be run; empty if it can
  std::string setting;  // printf format of what is tuned
  std::vector<double> ladder;
  int rounds;  // of timing, the median counts
  std::function<Answers(double)> solve;
};

struct Row {
  Answers answers;
  Errors errors;
  double setting;
};

inline Row tuned(const Rival& rival) {
  Row row;
  for (const double setting : rival.ladder) {
    row.setting = setting;
    row.answers = rival.solve(setting);
    row.errors = errors_of(row.answers);
    const bool few_failures = row.errors.failed * 20 < int(row.answers.got.size());
    if (few_failures && row.errors.median <= goal && row.errors.high <= high_goal) break;
  }
  return row;
}

inline std::vector<double> tolerances() {
  std::vector<double> list;
  for (int n = 16; n <= 40; ++n) list.push_back(std::pow(10.0, -0.25 * n));
  return list;
}

}  // namespace wingbeat::peers

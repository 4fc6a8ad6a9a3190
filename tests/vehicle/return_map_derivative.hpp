// The derivative of a return map against differences, for tests.
#pragma once

#include <gtest/gtest.h>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/solve/floquet.hpp"
#include "wingbeat/solve/iterate.hpp"

namespace wingbeat {

/// Expects the monodromy matrix of the iterate from `start` to be what central differences with the steps `h` say, to
/// `tolerance` of the step of each row. Returns that iterate.
template <class System>
solver::Iterate<System> expect_return_map_derivative(const System& system, const typename System::State& start,
                                                     const typename System::State& h, double tolerance) {
  constexpr std::size_t n = std::tuple_size_v<typename System::State>;
  const auto cycle_from = [&](const typename System::State& y) {
    solver::Iterate<System> cycle;
    solver::run_iterate<true>(system, y, {.tolerance = 1e-12, .max_steps = 5000}, cycle);
    EXPECT_EQ(cycle.status, solver::IterateStatus::complete);
    return cycle;
  };
  const auto cycle = cycle_from(start);
  const auto M = solver::monodromy(system, system.template cast<Jet<int(n)>>(), cycle);
  for (std::size_t column = 0; column < n; ++column) {
    typename System::State lower = start, upper = start;
    lower[column] -= h[column];
    upper[column] += h[column];
    const auto a = cycle_from(lower), b = cycle_from(upper);
    for (std::size_t row = 0; row < n; ++row) {
      const double difference = (b.end[row] - a.end[row]) / (2.0 * h[column]);
      EXPECT_NEAR(M[n * row + column] * h[column], difference * h[column], tolerance * h[row]) << row << ", " << column;
    }
  }
  return cycle;
}

}  // namespace wingbeat

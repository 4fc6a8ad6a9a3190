// The screening of a study of the best design: where local searches start.
#pragma once

#include "study/optimise_problem.hpp"
#include "wingbeat/study/for_each.hpp"

namespace wingbeat::detail {

/// Solves a Sobol sequence of designs; their coordinates, the most promising first.
std::vector<Vector> screened(const OptimiseProblem& problem, const StartUp& start_up, const ForEach& for_each,
                             ScreenCounts& counts);

/// Promising designs that are not each other's neighbours.
std::vector<Vector> spread(const std::vector<Vector>& ranked, std::size_t count);

}  // namespace wingbeat::detail

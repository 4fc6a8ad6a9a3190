// The stages of a bench fit that a comparison of friction laws takes as well.
#pragma once

#include <functional>
#include <string>

#include "wingbeat/study/bench_fit.hpp"
#include "wingbeat/study/for_each.hpp"

namespace wingbeat {

using FitProgress = std::function<void(const std::string&)>;  ///< called by one thread at a time

/// Throws ParameterError for what cannot be fitted.
void check_fit(const BenchFit& fit);

/// With the bench's supply, whose voltage the logs state, in the place of a battery, which weighs all the same.
BenchFit on_bench_supply(BenchFit fit);

/// For intervals relative deviations follow the predictions, and a fit is refused where intervals could not be what
/// they say. For a comparison of models with each other they stay those of the measured values.
enum class FitPurpose { intervals, comparison };

/// As fit_bench.
FitResult run_fit(const BenchFit& fit, FitPurpose purpose, const FitProgress& progress, const ForEach& for_each);

}  // namespace wingbeat

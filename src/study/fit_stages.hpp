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

/// As fit_bench; `reweight` lets relative deviations follow the predictions.
FitResult run_fit(const BenchFit& fit, bool reweight, const FitProgress& progress, const ForEach& for_each);

}  // namespace wingbeat

// One run of members through the solvers, their motors and the air as their vehicles have them.
#pragma once

#include <span>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/ensemble/ensemble.hpp"

namespace wingbeat {

/// Solves the members that `takes` says are to be.
void run_ensemble(std::span<const EnsembleMember> members, const EnsembleOptions& options, const StartUp& start_up,
                  std::span<EnsembleOutcome> outcomes, bool (*takes)(const Vehicle<double>&));

/// Makes what is not wanted absent.
void keep_wanted(const MetricSet& wanted, Metrics<double>& metrics);

}  // namespace wingbeat

// Many vehicles, each held at a flapping frequency by its voltage.
#pragma once

#include <span>
#include <vector>

#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/frequency_search.hpp"

namespace wingbeat {

/// As solve_ensemble, with the voltage of each member replaced by the one at which it flaps at its frequency [Hz];
/// Metric::voltage holds it. Where there is none, `reached` says why, the outcome has the status of FrequencySearch and
/// no metrics. The range is SearchRange::extrapolation: whether a cycle lies inside the domain of validity is for the
/// caller to assess, as at a held voltage. All members of a call are searched together by batches;
/// find_voltage_for_frequency settles the rest. The members' voltages are changed. Throws as solve_ensemble does, and
/// ParameterError unless every frequency is > 0.
void solve_ensemble_at_frequency(std::span<EnsembleMember> members, std::span<const double> frequencies,
                                 const EnsembleOptions& options, const StartUp& start_up,
                                 std::span<EnsembleOutcome> outcomes, std::span<FrequencyOutcome> reached);

}  // namespace wingbeat

// Many vehicles, each held at a flapping frequency, a lift or an electrical power by its voltage.
#pragma once

#include <span>

#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/hold.hpp"

namespace wingbeat {

/// As solve_ensemble, with the voltage of each member replaced by the one that find_voltage() finds for its Hold, to
/// within the tolerance; Metric::voltage has it. Where there is none, `reached` is not FrequencyOutcome::reached, and
/// the outcome has the status of FrequencySearch and no metrics. Which of the outcomes beside `reached` it is may
/// differ from the search of one where a lift is refused. At a held frequency, whether a cycle lies inside the domain
/// of validity is for the caller to assess, as at a held voltage.
///
/// All members of a call are searched together by batches; find_voltage() settles what they cannot: wings on hinges and
/// direct drives, where a lift or a power is held, and lifts that a lower voltage may yield as well. The members'
/// voltages are changed. Throws as solve_ensemble does, and ParameterError unless every value is > 0 and all hold a
/// frequency, all a lift or all a power.
void solve_ensemble_held(std::span<EnsembleMember> members, std::span<const Hold> holds, const EnsembleOptions& options,
                         const StartUp& start_up, std::span<EnsembleOutcome> outcomes,
                         std::span<FrequencyOutcome> reached);

}  // namespace wingbeat

// Many vehicles, each with the C_alpha that leads to an angle of attack at mid-stroke.
#pragma once

#include <span>

#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/study/hold.hpp"

namespace wingbeat::detail {

/// As solve_ensemble_held(), or without holds solve_ensemble(), with the C_alpha of each member that has a number in
/// `angles` [rad] replaced by the one that leads to this least angle of attack, to within the tolerance; the others,
/// NaN, keep theirs. Members are searched together by batches; what batches leave, find_pitch_coefficient() settles
/// one by one. A member for which there is no such C_alpha flaps, with a `reached` that is not
/// FrequencyOutcome::reached and without metrics. The members' voltages and C_alpha are changed.
void solve_ensemble_at_angles(std::span<EnsembleMember> members, std::span<const double> angles,
                              std::span<const Hold> holds, const EnsembleOptions& options, const StartUp& start_up,
                              std::span<EnsembleOutcome> outcomes, std::span<FrequencyOutcome> reached);

}  // namespace wingbeat::detail

// C_alpha from the angle of attack that the wings are to have at mid-stroke.
#pragma once

#include "wingbeat/study/run.hpp"

namespace wingbeat::detail {

/// run_design() without options.angle_of_attack, with the C_alpha that leads to it. Where no run with a trial flaps, or
/// reaches what else is asked for, that run. Throws ParameterError where the wings do not follow the pitch law alone,
/// and where no C_alpha leads there.
RunResult run_at_angle_of_attack(Design<double> design, RunOptions options);

}  // namespace wingbeat::detail

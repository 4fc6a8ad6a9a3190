// C_alpha from the angle of attack that the wings have at mid-stroke.
#pragma once

#include <functional>
#include <string>

#include "wingbeat/study/frequency_search.hpp"
#include "wingbeat/study/run.hpp"

namespace wingbeat::detail {

/// How a search for C_alpha ended.
enum class PitchOutcome {
  found,
  no_angle,    ///< a trial has no angle of attack: it does not flap, or not as asked
  left_range,  ///< the angle falls below the coefficients' range before what else is asked for is reached
  impossible   ///< no C_alpha leads to the angle
};

struct PitchSearch {
  PitchOutcome outcome;
  double pitch_coefficient;  ///< found [s]
};

/// What a trial gives where the angle of attack falls below the coefficients' range.
inline constexpr double below_range = -1.0;

/// Finds the C_alpha with which angle_with(C_alpha), the least angle of attack of a cycle [deg], is the one wanted
/// [deg], to a share of the tolerance; begins at `given` [s] where that is > 0. A trial gives below_range where its
/// C_alpha is too large, and NaN where there is none.
PitchSearch find_pitch_coefficient(double given, double wanted, double tolerance,
                                   const std::function<double(double)>& angle_with);

/// Whether a search for a voltage ended where the angle of attack falls below the coefficients' range.
bool leaves_angle_range(const SearchFinding& finding);

/// What is said where no C_alpha leads to an angle of attack [rad].
std::string no_pitch_coefficient(double angle);

/// The design with a C_alpha that was found [s] in place of the angle of attack that it states.
Design<double> with_pitch_coefficient(Design<double> design, double found);

/// run_design() where an angle of attack is asked for, by options.angle_of_attack or else by the design, with the
/// C_alpha that leads to it. Where no run with a trial flaps, or reaches what else is asked for, that run. Throws
/// ParameterError where the wings do not follow the pitch law alone, and where no C_alpha leads there.
RunResult run_at_angle_of_attack(Design<double> design, RunOptions options);

}  // namespace wingbeat::detail

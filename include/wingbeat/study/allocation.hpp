// Static maps for control allocation: mean lift and mean body moments over what commands the drives.
//
// Axes as in study/body_derivatives.hpp: roll moment L positive with the right wing down, pitch M with the nose up, yaw
// N with the nose to the right. The air's forces act at the centre of pressure r = S_3 / S_2 from the stroke axis.
#pragma once

#include <string>
#include <vector>

#include "wingbeat/study/linear_model.hpp"

namespace wingbeat {

enum class AllocationInput {
  voltage,               ///< of both sides alike [V]
  differential_voltage,  ///< of the left side less that of the right: each has half of it [V]; needs vehicle.motors = 2
  bias_voltage,          ///< added to a direct drive's sine, on both sides [V]
  split_cycle,  ///< delta: the positive half of a direct drive's sine takes (1 + delta)/2 of the period on the right
                ///< and (1 - delta)/2 on the left, with its mean taken out [1]; needs vehicle.motors = 2
  split_cycle_cosine  ///< delta: the same of the half of the voltage that falls from peak to trough, as of a cosine [1]
};
template <>
inline constexpr std::pair<const char*, AllocationInput> names_of<AllocationInput>[] = {
    {"voltage", AllocationInput::voltage},
    {"differential_voltage", AllocationInput::differential_voltage},
    {"bias_voltage", AllocationInput::bias_voltage},
    {"split_cycle", AllocationInput::split_cycle},
    {"split_cycle_cosine", AllocationInput::split_cycle_cosine}};

inline const char* unit_of(AllocationInput input) {
  return input == AllocationInput::split_cycle || input == AllocationInput::split_cycle_cosine ? "1" : "V";
}

/// Means of a settled cycle; absent where it does not flap there.
struct AllocationPoint {
  double input;      ///< [V] or [1]
  double lift;       ///< of all wings [N]
  double roll;       ///< L [N m]
  double pitch;      ///< M [N m]
  double yaw;        ///< N [N m]
  double frequency;  ///< of a differential voltage that of the left side [Hz]
};

/// A quantity of the maps: its name, unit, and what it is.
struct AllocationColumn {
  const char* name;
  const char* unit;
  const char* meaning;
  double AllocationPoint::* member;
};
inline constexpr AllocationColumn allocation_columns[] = {
    {"lift", "N", "mean lift", &AllocationPoint::lift},
    {"roll_moment", "N m", "mean roll moment, positive with the right wing down", &AllocationPoint::roll},
    {"pitch_moment", "N m", "mean pitch moment, positive with the nose up", &AllocationPoint::pitch},
    {"yaw_moment", "N m", "mean yaw moment, positive with the nose to the right", &AllocationPoint::yaw},
    {"frequency", "Hz", "flapping frequency", &AllocationPoint::frequency}};

struct AllocationMap {
  AllocationInput input;
  std::vector<AllocationPoint> points;
  AllocationPoint slope;  ///< by the input at the operating point, exact derivatives [.../V or .../1]
  /// The slope from two pairs of points around the operating point, one and two steps away, by Richardson's
  /// extrapolation, and what that may be off by: how far the slopes of both pairs are apart, times the step their
  /// curvatures, and the tolerance of the points. The step is that of the map. Where the slope is further off, the map
  /// has a kink or jumps between its points, which no error estimate from them alone can show (a map that is odd about
  /// the operating point has kinks on both sides alike): then the step is halved, for each quantity by itself, up to 8
  /// times.
  AllocationPoint slope_of_points, slope_of_points_error, slope_of_points_step;
};

/// What a map has of slopes, as it is named outside the program.
struct AllocationSlope {
  const char* name;
  const char* meaning;
  AllocationPoint AllocationMap::* member;
  bool of_input = false;  ///< in the unit of the input, not per unit of it
};
inline constexpr AllocationSlope allocation_slopes[] = {
    {"slope", "at the operating point, exact", &AllocationMap::slope},
    {"slope_of_points", "at the operating point, from points around it", &AllocationMap::slope_of_points},
    {"slope_of_points_error", "estimated error of slope_of_points", &AllocationMap::slope_of_points_error},
    {"slope_of_points_step", "distance of the points behind slope_of_points", &AllocationMap::slope_of_points_step,
     true}};

/// The maps that the vehicle has, in the order of AllocationInput, about an operating point that flaps: voltages from
/// half to 1.3 times its own, differences up to half of it, biases up to a fifth, splits up to 0.3. A pwm supply's
/// voltage is its mean. The motor stays at the temperatures of the operating point, as in the linear model.
std::vector<AllocationMap> allocation_maps(const Linearisation& linearisation, double hinge_offset = 0.0);

/// The maps of a vehicle whose sides differ, each linearised as a vehicle of its own at the same voltage (TwoSides).
std::vector<AllocationMap> allocation_maps(const Linearisation& left, const Linearisation& right, double hinge_offset);

/// Points of one map. Inputs other than a voltage are symmetrical about 0, which is in their midst; none without a
/// linear model.
std::vector<AllocationPoint> allocation_points(const Linearisation& linearisation, AllocationInput which,
                                               const std::vector<double>& inputs, double hinge_offset = 0.0);

}  // namespace wingbeat

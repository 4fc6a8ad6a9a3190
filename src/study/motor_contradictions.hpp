// Where a data sheet contradicts itself.
#pragma once

#include <string>
#include <vector>

#include "study/motor_data.hpp"

namespace wingbeat::detail {

/// One way to a constant.
struct Estimate {
  std::string source;
  double value;
  double deviation;  ///< relative
};

/// Adds the pairs of ways to one constant that do not agree.
void find_contradictions(const std::string& constant_name, const std::string& unit,
                         const std::vector<Estimate>& estimates, std::vector<Contradiction>& out);

/// Compares the independent ways to resistance, torque constant and constant friction [N m], of which the fit gave the
/// last; torques are `torque_factor` times what the motor gives.
void compare_ways(const MotorDatasheet& sheet, double friction_torque, double torque_factor,
                  std::vector<Contradiction>& out);

/// Where the sheet contradicts itself grossly: takes back the constants concerned and says why.
void refuse_contradictions(const std::vector<Datum>& data, MotorIdentification& result);

/// "no load speed" of "no_load_speed"

}  // namespace wingbeat::detail

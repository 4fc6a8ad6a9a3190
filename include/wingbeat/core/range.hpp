// What a number may be: bounds that are checked, and their words for messages and references.
#pragma once

#include <cmath>
#include <limits>
#include <string_view>

#include "wingbeat/core/math.hpp"

namespace wingbeat {

/// What a parameter may be: of a number the bounds [SI], of a choice or a text the words alone.
struct ParameterRange {
  std::string_view text;      ///< "> 0", "none, viscous or constant"
  const char* expected = "";  ///< "must be > 0", for messages
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool above_lower = false;  ///< the lower bound itself is not allowed
  bool below_upper = false;  ///< nor the upper one
  bool whole = false;        ///< whole numbers only

  bool holds(double x) const {
    return (above_lower ? x > lower : x >= lower) && (below_upper ? x < upper : x <= upper) &&
           (!whole || x == std::floor(x));
  }
};

namespace range {

inline constexpr double endless = std::numeric_limits<double>::infinity();
inline constexpr ParameterRange any{"any", "must be finite"};
inline constexpr ParameterRange positive{"> 0", "must be > 0", 0.0, endless, true};
inline constexpr ParameterRange not_negative{">= 0", "must be >= 0", 0.0};
inline constexpr ParameterRange zero_to_one{"0 to 1", "must lie between 0 and 1", 0.0, 1.0};
inline constexpr ParameterRange efficiency{"> 0, <= 1", "must be > 0 and <= 1", 0.0, 1.0, true};
inline constexpr ParameterRange acute{"> 0, < pi/2", "must lie between 0 and pi/2", 0.0, pi / 2.0, true, true};
inline constexpr ParameterRange zero_to_acute{">= 0, < pi/2", "must be >= 0 and < pi/2", 0.0, pi / 2.0, false, true};
inline constexpr ParameterRange below_straight{"> 0, < pi", "must be > 0 and < pi", 0.0, pi, true, true};
inline constexpr ParameterRange above_minus_straight{"< 0, > -pi", "must be < 0 and > -pi", -pi, 0.0, true, true};
inline constexpr ParameterRange within_right_angle{
    "> -pi/2, < pi/2", "must lie between -pi/2 and pi/2", -pi / 2.0, pi / 2.0, true, true};
inline constexpr ParameterRange count{
    "whole number >= 1", "must be a whole number >= 1", 1.0, endless, false, false, true};
inline constexpr ParameterRange at_most_thousand{
    "whole number, 0 to 1000", "must be a whole number from 0 to 1000", 0.0, 1000.0, false, false, true};

}  // namespace range

/// A number as vehicle files and messages name it.
struct ParameterKey {
  const char* path;  ///< "motor.torque_constant"
  const char* unit;  ///< SI unit, "1" for a plain number
  ParameterRange range;
};

/// Throws ParameterError unless the value [SI] is finite and in its range.
void require(const ParameterKey& key, double value);

}  // namespace wingbeat

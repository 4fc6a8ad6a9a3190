// What moves in a vehicle.
#pragma once

#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

/// What moves. Of a direct drive the shaft angle is the stroke angle; what a vehicle does not have is 0.
template <Scalar S>
struct Coordinates {
  S angle = S(0.0);           ///< theta, or beta of a direct drive [rad]
  S speed = S(0.0);           ///< its rate omega [rad/s]
  S current = S(0.0);         ///< i [A]; without inductance it follows from the voltage instead
  S pitch_angle = S(0.0);     ///< psi [rad]
  S pitch_velocity = S(0.0);  ///< psi' [rad/s]
  S twist_angle = S(0.0);     ///< tau [rad]
  S twist_velocity = S(0.0);  ///< tau' [rad/s]
  S tip = S(0.0);             ///< x of a piezo behind a compliant transmission [m]
  S tip_velocity = S(0.0);    ///< x' [m/s]
};

}  // namespace wingbeat

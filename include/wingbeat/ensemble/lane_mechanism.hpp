// The transmissions of a block of vehicles on SIMD lanes, and how their strokes divide a turn of the crank.
#pragma once

#include <array>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/any_transmission.hpp"

namespace wingbeat {

/// The upward and the downward stroke of a turn, in plain numbers. The upward one begins at middle[0] - reach[0], which
/// is > -2 pi and <= 0.
struct HalfTurns {
  std::array<double, 2> middle;  ///< crank angle in the middle of either stroke [rad]
  std::array<double, 2> reach;   ///< from there to its ends [rad]
  // Of a table:
  const StrokeCurve* curve;
  double curve_start;      ///< crank angle of the first row [rad]
  double curve_amplitude;  ///< half the peak-to-peak stroke angle [rad]
};

/// Whether a turn is one upward and one downward stroke, which half_turns() are.
bool has_half_turns(const AnyTransmission<double>& t);
HalfTurns half_turns(const AnyTransmission<double>& t);

/// The transmissions of lanes, all of one type.
template <Scalar S>
struct LaneMechanism {
  const AnyTransmission<S>& transmission;
  bool is_slider_crank;
  CrankGeometry<S> slider;                   ///< of slider-cranks
  std::array<S, 2> middle = {}, reach = {};  ///< as HalfTurns

  explicit LaneMechanism(const AnyTransmission<S>& t)
      : transmission(t),
        is_slider_crank(t.type == TransmissionType::slider_crank),
        slider(geometry_of(t.slider_crank)),
        middle{S(0.0), S(pi)},
        reach{S(slider_crank_dead_centre), S(slider_crank_dead_centre)} {}

  /// At a crank angle [rad].
  CrankKinematics<S> kinematics(const S& angle) const {
    if (is_slider_crank) return crank_kinematics(slider, S(sin(angle)), S(cos(angle)));
    return kinematics_of_others(angle);
  }
  // Out of the way of slider-cranks: a call in the midst of an evaluation costs registers.
  [[gnu::noinline]] CrankKinematics<S> kinematics_of_others(const S& angle) const {
    if (transmission.type == TransmissionType::tabulated) return kinematics_at_angle(transmission.tabulated, angle);
    return crank_kinematics(transmission, S(sin(angle)), S(cos(angle)));
  }
};

}  // namespace wingbeat

// What lanes can tell of statics from the crank angles that they look at.
#pragma once

#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// Distance of the crank angles, multiples of it, at which lanes look whether a crank could lock [rad], and the share
/// of the stall torque that they hold back.
inline constexpr double lane_angle_spacing = pi / 16.0, lane_torque_margin = 0.05;

/// Whether what lanes hold back covers what lies between their crank angles: in this family of slider-cranks the torque
/// of springs and friction there exceeds that at the angles beside it by less. Of others statics must tell.
inline bool lanes_see_locks(const Vehicle<double>& v) {
  if (v.transmission.type != TransmissionType::slider_crank || has_gear_loss(v.motor)) return false;
  const SliderCrank<double>& c = v.transmission.slider_crank;
  const double obliquity = c.crank_radius / c.rod_length;
  const double reach = std::abs(c.rod_length - c.mid_stroke_height) + c.crank_radius;
  return c.crank_radius <= 1.25 * c.hinge_offset && obliquity <= 0.5 && reach <= 2.0 * c.crank_radius &&
         v.friction.radius <= c.crank_radius &&
         (c.formulation == Formulation::virtual_work ||
          std::sqrt(1.0 - square(obliquity)) - obliquity * reach / c.hinge_offset >= 0.3);
}

}  // namespace wingbeat

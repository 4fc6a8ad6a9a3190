// Rows of the parameter table: body, tail and fin, what can be moved.
#pragma once

#include <array>
#include <string>

#include "vehicle/parameter_access.hpp"
#include "wingbeat/parts/body.hpp"

namespace wingbeat::detail {

template <Scalar S>
constexpr auto body_rows() {
  using D = Design<S>;
  return std::array{
      number<S>(row(body_key::inertia_pitch, "none: no flight",
                    "I_yy, y to the right; given, with the other two, the vehicle can fly: trim, stability, fly"),
                [](auto& d) -> auto& { return d.body.inertia_pitch; }),
      number<S, BodyGiven>(row(body_key::inertia_roll, "required",
                               "I_xx, moment of inertia of the whole vehicle about "
                               "its centre of mass, x forward"),
                           [](auto& d) -> auto& { return d.body.inertia_roll; }),
      number<S, BodyGiven>(row(body_key::inertia_yaw, "required", "I_zz, z down"),
                           [](auto& d) -> auto& { return d.body.inertia_yaw; }),
      number<S, BodyGiven>(row(body_key::inertia_product, "0 kg m2", "I_xz, integral of x z dm"),
                           [](auto& d) -> auto& { return d.body.inertia_product; }),
      number<S, BodyGiven>(row(body_key::shoulder_ahead, "0 m", "stroke axes ahead of the centre of mass"),
                           [](auto& d) -> auto& { return d.body.shoulder_ahead; }),
      number<S, BodyGiven>(row(body_key::shoulder_aside, "0 m", "stroke axis of either side from the middle plane"),
                           [](auto& d) -> auto& { return d.body.shoulder_aside; }),
      number<S, BodyGiven>(row(body_key::shoulder_above, "0 m", "stroke planes above the centre of mass"),
                           [](auto& d) -> auto& { return d.body.shoulder_above; }),
      number<S, BodyGiven>(row(body_key::stroke_plane_tilt, "0 rad", "stroke planes against the body, nose up"),
                           [](auto& d) -> auto& { return d.body.stroke_plane_tilt; }),
      number<S, BodyGiven>(row(body_key::mean_stroke_angle, "0 rad", "of the span at stroke angle 0, forwards"),
                           [](auto& d) -> auto& { return d.body.mean_stroke_angle; }),
      text<S, BodyGiven>({"body.opposed",
                          "",
                          {"true or false"},
                          "false",
                          "of each two wings on one side, one flaps against the other"},
                         [](const D& d) {
                           if (!BodyGiven::holds(d)) return std::string();
                           return std::string(d.body.opposed ? "true" : "false");
                         }),
      number<S, BodyGiven>(row(body_key::wing_mass, "none: wings without mass to the body",
                               "mass of one wing; given, the inertia of the flapping acts on the body"),
                           [](auto& d) -> auto& { return d.body.wing_mass; }),
      number<S, WingMassGiven>(row(body_key::wing_centre, "required", "centre of mass of a wing from its stroke axis"),
                               [](auto& d) -> auto& { return d.body.wing_centre; }),
      number<S, BodyGiven>(row(body_key::drag_area_forward, "0 m2", "C_D A of the body that moves along x"),
                           [](auto& d) -> auto& { return d.body.drag_area_forward; }),
      number<S, BodyGiven>(row(body_key::drag_area_sideways, "0 m2", "C_D A along y"),
                           [](auto& d) -> auto& { return d.body.drag_area_sideways; }),
      number<S, BodyGiven>(row(body_key::drag_area_vertical, "0 m2", "C_D A along z"),
                           [](auto& d) -> auto& { return d.body.drag_area_vertical; }),
      number<S, BodyGiven>(row(body_key::drag_below, "0 m", "where that drag acts, below the centre of mass"),
                           [](auto& d) -> auto& { return d.body.drag_below; }),
      number<S, BodyGiven>(row(body_key::tail_area, "none", "flat plate, horizontal"),
                           [](auto& d) -> auto& { return d.body.tail.area; }),
      number<S, TailGiven>(row(body_key::tail_behind, "0 m", "its centre behind the centre of mass"),
                           [](auto& d) -> auto& { return d.body.tail.behind; }),
      number<S, TailGiven>(row(body_key::tail_below, "0 m", "its centre below the centre of mass"),
                           [](auto& d) -> auto& { return d.body.tail.below; }),
      number<S, TailGiven>(row(body_key::tail_coefficient, "2", "force normal to the plate over sin(angle of attack)"),
                           [](auto& d) -> auto& { return d.body.tail.coefficient; }),
      number<S, BodyGiven>(row(body_key::fin_area, "none", "flat plate, upright"),
                           [](auto& d) -> auto& { return d.body.fin.area; }),
      number<S, FinGiven>(row(body_key::fin_behind, "0 m", "its centre behind the centre of mass"),
                          [](auto& d) -> auto& { return d.body.fin.behind; }),
      number<S, FinGiven>(row(body_key::fin_below, "0 m", "its centre below the centre of mass"),
                          [](auto& d) -> auto& { return d.body.fin.below; }),
      number<S, FinGiven>(row(body_key::fin_coefficient, "2", "force normal to the plate over sin(angle of attack)"),
                          [](auto& d) -> auto& { return d.body.fin.coefficient; }),
      number<S, BodyGiven>(
          row(body_key::control_stroke, "none: fixed", "largest deflection, to either side, of the mean stroke angle"),
          [](auto& d) -> auto& { return d.body.control.mean_stroke_angle; }),
      number<S, BodyGiven>(row(body_key::control_plane, "none: fixed",
                               "largest tilt of the stroke planes, right nose up, left nose down"),
                           [](auto& d) -> auto& { return d.body.control.stroke_plane_difference; }),
      number<S, BodyGiven>(row(body_key::control_incidence, "none: fixed",
                               "largest turn of the pitch of the wings, right up, left down"),
                           [](auto& d) -> auto& { return d.body.control.incidence_difference; }),
      number<S, BodyGiven>(row(body_key::control_voltage, "none", "largest voltage, or amplitude, of a drive"),
                           [](auto& d) -> auto& { return d.body.control.voltage_max; })};
}

}  // namespace wingbeat::detail

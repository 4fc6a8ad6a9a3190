#include "wingbeat/parts/mechanism_pose.hpp"

#include <algorithm>

namespace wingbeat {
namespace {

MechanismPose pose_of(const SliderCrank<double>& c, double crank_angle, double stroke_angle, double wing_length) {
  const PlanePoint axis{}, pin = on_circle(axis, c.crank_radius, crank_angle);
  const PlanePoint slider{0.0, slider_height(c, std::sin(crank_angle), std::cos(crank_angle))};
  const PlanePoint right{c.hinge_offset, c.mid_stroke_height}, left{-c.hinge_offset, c.mid_stroke_height};
  // The slider lifts the inner ends of the wings, so that the wings beyond the hinges go down.
  return {{{"axis", axis, true},
           {"pin", pin},
           {"slider", slider},
           {"hinge", right, true},
           {"tip", on_circle(right, wing_length, -stroke_angle)},
           {"left_hinge", left, true},
           {"left_tip", on_circle(left, wing_length, pi + stroke_angle)}},
          {{LinkRole::wing, "hinge", "tip"},
           {LinkRole::wing, "left_hinge", "left_tip"},
           {LinkRole::lever, "slider", "hinge"},
           {LinkRole::lever, "slider", "left_hinge"},
           {LinkRole::rod, "pin", "slider"},
           {LinkRole::crank, "axis", "pin"}}};
}

MechanismPose pose_of(const FourBar<double>& f, double crank_angle, double stroke_angle, double wing_length) {
  const PlanePoint axis{}, hinge{f.ground_length, 0.0};
  return {{{"axis", axis, true},
           {"pin", on_circle(axis, f.crank_radius, crank_angle)},
           {"rocker", on_circle(hinge, f.rocker_length, f.ground_angle + stroke_angle / f.stroke_ratio)},
           {"hinge", hinge, true},
           {"tip", on_circle(hinge, wing_length, stroke_angle)}},
          {{LinkRole::ground, "axis", "hinge"},
           {LinkRole::wing, "hinge", "tip"},
           {LinkRole::rocker, "hinge", "rocker"},
           {LinkRole::rod, "pin", "rocker"},
           {LinkRole::crank, "axis", "pin"}}};
}

/// A scheme, of a stroke that a table gives and of transmissions whose joints nothing says.
template <class Other>
MechanismPose pose_of(const Other&, double crank_angle, double stroke_angle, double wing_length) {
  const PlanePoint axis{}, hinge{0.83 * wing_length, 0.0};
  return {{{"axis", axis, true},
           {"pin", on_circle(axis, 0.3 * wing_length, crank_angle)},
           {"hinge", hinge, true},
           {"tip", on_circle(hinge, wing_length, stroke_angle)}},
          {{LinkRole::ground, "axis", "hinge"}, {LinkRole::wing, "hinge", "tip"}, {LinkRole::crank, "axis", "pin"}}};
}

}  // namespace

const PlanePoint& MechanismPose::at(std::string_view joint) const {
  return std::find_if(joints.begin(), joints.end(), [&](const Joint& j) { return j.name == joint; })->position;
}

MechanismPose pose_of(const AnyTransmission<double>& t, double crank_angle, double stroke_angle, double wing_length) {
  if (t.type == TransmissionType::direct) {
    return {{{"hinge", {}, true}, {"tip", on_circle({}, wing_length, stroke_angle)}},
            {{LinkRole::wing, "hinge", "tip"}}};
  }
  return visit(t, [&](const auto& of_type) { return pose_of(of_type, crank_angle, stroke_angle, wing_length); });
}

MechanismPose pose_of(const AnyTransmission<double>& t, double crank_angle, double wing_length) {
  const double beta = stroke_angle(crank_kinematics(t, std::sin(crank_angle), std::cos(crank_angle)));
  return pose_of(t, crank_angle, beta, wing_length);
}

double drawn_wing_length(const AnyTransmission<double>& t) {
  if (t.type == TransmissionType::slider_crank) return 1.2 * t.slider_crank.rod_length;
  if (t.type == TransmissionType::four_bar) return 0.9 * (t.four_bar.ground_length + t.four_bar.rocker_length);
  return 1.0;
}

}  // namespace wingbeat

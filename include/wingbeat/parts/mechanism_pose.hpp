// Where the joints of a mechanism are at an angle, for whoever draws it: figures, pages that move.
#pragma once

#include <cmath>
#include <string_view>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/parts/any_transmission.hpp"

namespace wingbeat {

/// A point of the stroke plane, x to the right, y upwards [m].
struct PlanePoint {
  double x = 0.0, y = 0.0;
};

/// The point at that angle [rad] of a circle.
inline PlanePoint on_circle(const PlanePoint& centre, double radius, double angle) {
  return {centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
}

enum class LinkRole {
  ground,  ///< between two fixed joints
  wing,
  lever,  ///< from the slider to a hinge
  rocker,
  rod,  ///< connecting rod or coupler
  crank
};
template <>
inline constexpr std::pair<const char*, LinkRole> names_of<LinkRole>[] = {
    {"ground", LinkRole::ground}, {"wing", LinkRole::wing}, {"lever", LinkRole::lever},
    {"rocker", LinkRole::rocker}, {"rod", LinkRole::rod},   {"crank", LinkRole::crank}};

/// A mechanism at one instant, its links in the order in which they are drawn.
struct MechanismPose {
  struct Joint {
    std::string_view name;  ///< "axis", "pin", "slider", "rocker", "hinge", "tip", "left_hinge", "left_tip"
    PlanePoint position;
    bool fixed = false;
  };
  struct Link {
    LinkRole role;
    std::string_view from, to;  ///< joints
  };
  std::vector<Joint> joints;
  std::vector<Link> links;

  /// The joint of that name, which the mechanism has.
  const PlanePoint& at(std::string_view joint) const;
};

/// The mechanism at a crank angle, the crank's axis at the origin, its wings at a stroke angle [rad] and `wing_length`
/// long. Of a stroke that a table gives, and of a direct drive, which has no crank, it is a scheme of its hinge and one
/// wing; the crank of the table is 0.3 wing lengths.
MechanismPose pose_of(const AnyTransmission<double>& transmission, double crank_angle, double stroke_angle,
                      double wing_length);

/// That pose at the stroke angle that belongs to the crank angle; not of a direct drive.
MechanismPose pose_of(const AnyTransmission<double>& transmission, double crank_angle, double wing_length);

/// A length of wings [m] that suits a drawing of the mechanism, in which they are cut; 1 of a scheme.
double drawn_wing_length(const AnyTransmission<double>& transmission);

}  // namespace wingbeat

#include "wingbeat/study/body_derivatives.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/cycle_instants.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/parts/planform.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using Eigen::Vector3d;

/// Lift and drag coefficient with their slopes by the angle of attack.
struct Coefficients {
  Jet<1> lift, drag;
};

class Wings {
 public:
  explicit Wings(const Vehicle<double>& vehicle)
      : pitching_(pitches(vehicle)), wings_(cast<Jet<1>>(vehicle.wings)), hinged_(cast<Jet<1>>(vehicle.pitch)) {}

  Coefficients at(double angle_of_attack) const {
    const Jet<1> alpha(angle_of_attack, 0);
    if (!pitching_) return {lift_coefficient(wings_.coefficients, alpha), drag_coefficient(wings_.coefficients, alpha)};
    const Jet<1> normal = normal_force_coefficient(wings_, hinged_, alpha);
    return {normal * cos(alpha), normal * sin(alpha)};
  }

 private:
  bool pitching_;
  BladeElement<Jet<1>> wings_;
  PitchingWings<Jet<1>> hinged_;
};

/// S_1 of all wings [m3]; absent where only moments are given.
double first_moment(const Design<double>& design, const Vehicle<double>& vehicle) {
  if (!(vehicle.wings.s2 > 0.0)) return 0.0;
  if (design.wing.planform.shape == PlanformShape::moments) return absent;
  return first_chord_moment(design.wing.planform, vehicle.wing_count);
}

/// A factor times a moment that may be absent: what does not need it is not.
double times(double factor, double moment) { return factor == 0.0 ? 0.0 : factor * moment; }

/// Of one side, +1 right or -1 left, at one instant, by unit body motions; moments S_n of that side.
BodyDerivatives side_derivatives(double side, double beta, double beta_dot, const Coefficients& c, double air_density,
                                 const std::array<double, 3>& moments, double hinge_offset) {
  const Vector3d root(0.0, side * hinge_offset, 0.0);
  const Vector3d span(std::sin(beta), side * std::cos(beta), 0.0), along(std::cos(beta), -side * std::sin(beta), 0.0);
  const Vector3d down = Vector3d::UnitZ();
  const double s = sign_of(beta_dot), scale = air_density * std::abs(beta_dot);
  const double lift_slope = 0.5 * (c.lift.v[0] + c.drag.a), drag_slope = 0.5 * (c.lift.a - c.drag.v[0]);
  BodyDerivatives result;
  for (int motion = 0; motion < 6; ++motion) {
    const Vector3d unit = Vector3d::Unit(motion % 3);
    // dV = gained[0] + gained[1] r
    const Vector3d gained[2] = {motion < 3 ? unit : unit.cross(root).eval(),
                                motion < 3 ? Vector3d::Zero().eval() : unit.cross(span).eval()};
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
    for (int power = 0; power < 2; ++power) {
      const double forward = s * along.dot(gained[power]), sinks = down.dot(gained[power]);
      const Vector3d per_moment = scale * ((c.drag.a * -forward + drag_slope * sinks) * s * along -
                                           (c.lift.a * forward + lift_slope * sinks) * down);
      const Vector3d about_root = root.cross(per_moment), about_span = span.cross(per_moment);
      for (int axis = 0; axis < 3; ++axis) {
        force[axis] += times(per_moment[axis], moments[std::size_t(power)]);
        moment[axis] += times(about_root[axis], moments[std::size_t(power)]) +
                        times(about_span[axis], moments[std::size_t(power) + 1]);
      }
    }
    result.col(motion) << force, moment;
  }
  return result;
}

}  // namespace

BodyDerivatives body_derivatives(const Design<double>& design, const Vehicle<double>& vehicle, const CycleRecord& cycle,
                                 double hinge_offset) {
  const Wings wings(vehicle);
  const std::array<double, 3> half = {0.5 * first_moment(design, vehicle), 0.5 * vehicle.wings.s2,
                                      0.5 * vehicle.wings.s3};
  BodyDerivatives mean = BodyDerivatives::Zero();
  for (const auto& [row, weight] : cycle_instants(cycle)) {
    const Coefficients c = wings.at(row.angle_of_attack_deg / degrees_per_radian);
    for (const double side : {1.0, -1.0}) {
      mean += weight * side_derivatives(side, row.stroke_angle, row.flapping_velocity, c, vehicle.wings.air_density,
                                        half, hinge_offset);
    }
  }
  return mean;
}

}  // namespace wingbeat

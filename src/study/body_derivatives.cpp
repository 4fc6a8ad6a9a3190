#include "wingbeat/study/body_derivatives.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/cycle_instants.hpp"
#include "wingbeat/parts/planform.hpp"
#include "wingbeat/parts/strip_force.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using Eigen::Vector3d;

/// By what the force on a strip changes with its velocity, of a strip that flaps at 1 m/s.
using StripJet = Jet<2>;
StripForce<StripJet> at_unit_speed(const Vehicle<StripJet>& v, double angle_of_attack) {
  return strip_force<StripJet>(v.wings, v.pitch, pitches(v), StripJet(angle_of_attack), StripJet(1.0, 0),
                               StripJet(0.0, 1));
}

/// S_1 of all wings [m3]; absent where only moments are given.
double first_moment(const Design<double>& design, const Vehicle<double>& vehicle) {
  if (!(vehicle.wings.s2 > 0.0)) return 0.0;
  if (design.wing.planform.shape == PlanformShape::moments) return absent;
  return first_chord_moment(design.wing.planform, vehicle.wing_count);
}

/// A factor times a moment that may be absent: what does not need it is not.
double times(double factor, double moment) { return factor == 0.0 ? 0.0 : factor * moment; }

/// Of one side, +1 right or -1 left, at one instant, by unit body motions; moments S_n of that side.
BodyDerivatives side_derivatives(double side, double beta, double beta_dot, const StripForce<StripJet>& c,
                                 double air_density, const std::array<double, 3>& moments, double hinge_offset) {
  const Vector3d root(0.0, side * hinge_offset, 0.0);
  const Vector3d span(std::sin(beta), side * std::cos(beta), 0.0), along(std::cos(beta), -side * std::sin(beta), 0.0);
  const Vector3d down = Vector3d::UnitZ();
  const double s = sign_of(beta_dot), scale = 0.5 * air_density * std::abs(beta_dot);
  BodyDerivatives result;
  for (int motion = 0; motion < 6; ++motion) {
    const Vector3d unit = Vector3d::Unit(motion % 3);
    // dV = gained[0] + gained[1] r
    const Vector3d gained[2] = {motion < 3 ? unit : unit.cross(root).eval(),
                                motion < 3 ? Vector3d::Zero().eval() : unit.cross(span).eval()};
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
    for (int power = 0; power < 2; ++power) {
      const double forward = s * along.dot(gained[power]), sinks = down.dot(gained[power]);
      const double ahead = c.ahead.v[0] * forward + c.ahead.v[1] * sinks;
      const double up = c.up.v[0] * forward + c.up.v[1] * sinks;
      const Vector3d per_moment = scale * (ahead * s * along - up * down);
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
  const BladeElement<double>& air = vehicle.wings;
  // Their strips differ from those here, which one angle of attack and the chord moments describe.
  if (acts_by_strips(air) || has_induced_velocity(air.wake) || claps(air.clap) || is_given(air.tabulated))
    return BodyDerivatives::Constant(absent);
  const auto wings = cast<StripJet>(vehicle);
  const std::array<double, 3> half = {0.5 * first_moment(design, vehicle), 0.5 * vehicle.wings.s2,
                                      0.5 * vehicle.wings.s3};
  BodyDerivatives mean = BodyDerivatives::Zero();
  for (const auto& [row, weight, phase] : cycle_instants(cycle)) {
    const StripForce<StripJet> c = at_unit_speed(wings, row.angle_of_attack_deg / degrees_per_radian);
    for (const double side : {1.0, -1.0}) {
      mean += weight * side_derivatives(side, row.stroke_angle, row.flapping_velocity, c, vehicle.wings.air_density,
                                        half, hinge_offset);
    }
  }
  return mean;
}

}  // namespace wingbeat

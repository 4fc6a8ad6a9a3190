// Bounds over ranges of the crank angle of what decides where a crank stands and jams (static_balance.hpp).
#pragma once

#include "wingbeat/core/enclosure.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {

/// Stroke angle and levers over a range of crank angles.
struct KinematicBounds {
  Enclosure stroke_angle;   ///< beta [rad]
  Enclosure stroke_slope;   ///< B1 [1]
  Enclosure wing_jacobian;  ///< g [m]
  Enclosure lever_ratio;    ///< h / g [1]
};

KinematicBounds kinematic_bounds(const SliderCrank<double>& c, double from, double to);
KinematicBounds kinematic_bounds(const FourBar<double>& f, double from, double to);
KinematicBounds kinematic_bounds(const StrokeTable<double>& t, double from, double to);
/// Of any other transmission, which conserves power, by interval arithmetic.
template <class Other>
KinematicBounds kinematic_bounds(const Other& t, double from, double to) {
  const CircleArc arc = circle_arc(from, to);
  const CrankKinematics<Enclosure> k = crank_kinematics(cast<Enclosure>(t), arc.sine, arc.cosine);
  return {wingbeat::stroke_angle(k), k.stroke_slope, k.wing_jacobian, k.stroke_slope};
}

/// Of one vehicle with wings, over crank angles from `from` to `to` [rad], at most a turn apart.
class StaticBounds {
 public:
  explicit StaticBounds(const Vehicle<double>& vehicle) : v_(vehicle) {}

  /// StandingTorques::high and low [N m].
  Enclosure high(double from, double to) const;
  Enclosure low(double from, double to) const;
  /// min_inertia() [kg m2].
  Enclosure min_inertia(double from, double to) const;
  /// g [m].
  Enclosure wing_jacobian(double from, double to) const { return kinematics(from, to).wing_jacobian; }
  /// uniqueness() [1].
  Enclosure uniqueness(double from, double to) const;

 private:
  KinematicBounds kinematics(double from, double to) const;
  /// Torque of the load on the mechanism, without friction [N m], and of its friction.
  struct Torques {
    Enclosure load, friction;
  };
  Torques torques(double from, double to) const;
  Enclosure before_gear(const Enclosure& load) const;
  Enclosure min_inertia(const KinematicBounds& k) const;

  const Vehicle<double>& v_;
};

}  // namespace wingbeat::detail

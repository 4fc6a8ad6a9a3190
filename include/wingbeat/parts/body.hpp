// The body that wings carry: a rigid body with tail, fin and drag areas, six degrees of freedom; model.md section 18.
//
// Axes as in flight dynamics: x forward, y to the right, z down, origin at the centre of mass.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "wingbeat/core/members.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/onset_flow.hpp"

namespace wingbeat {

/// A flat plate that is fixed to the body.
template <Scalar S>
struct PlateDesign {
  std::optional<S> area;   ///< [m2]
  S behind = S(0);         ///< of its centre, from the centre of mass [m]
  S below = S(0);          ///< [m]
  S coefficient = S(2.0);  ///< of the force normal to the plate over the sine of the angle of attack [1]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.area, self.behind, self.below, self.coefficient);
  }
};

/// What can be moved beside the voltage of a drive: largest deflections to either side; none unless given.
template <Scalar S>
struct ControlDesign {
  std::optional<S> mean_stroke_angle;        ///< of all wings, forwards [rad]
  std::optional<S> stroke_plane_difference;  ///< right plane nose up, left nose down [rad]
  std::optional<S> incidence_difference;  ///< pitch of the right wings under the pitch law up, of the left down [rad]
  std::optional<S> voltage_max;           ///< of drive or amplitude [V]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.mean_stroke_angle, self.stroke_plane_difference, self.incidence_difference, self.voltage_max);
  }
};

/// [body]: there as soon as the moments of inertia are given.
template <Scalar S>
struct BodyDesign {
  std::optional<S> inertia_roll;   ///< I_xx of the whole vehicle about its centre of mass [kg m2]
  std::optional<S> inertia_pitch;  ///< I_yy [kg m2]
  std::optional<S> inertia_yaw;    ///< I_zz [kg m2]
  S inertia_product = S(0);        ///< I_xz = integral x z dm [kg m2]
  S shoulder_ahead = S(0);         ///< stroke axes from the centre of mass [m]
  S shoulder_aside = S(0);         ///< stroke axis of either side from the middle plane [m]
  S shoulder_above = S(0);         ///< stroke planes above the centre of mass [m]
  S stroke_plane_tilt = S(0);      ///< nose up [rad]
  S mean_stroke_angle = S(0);      ///< of the span at stroke angle 0, forwards [rad]
  bool opposed = false;            ///< of each two wings on one side, one flaps against the other
  std::optional<S> wing_mass;      ///< of one wing [kg]; given, the inertia of the wings acts on the body
  S wing_centre = S(0);            ///< centre of mass of a wing from the stroke axis [m]
  S drag_area_forward = S(0);      ///< C_D A of motion along x [m2]
  S drag_area_sideways = S(0);     ///< along y [m2]
  S drag_area_vertical = S(0);     ///< along z [m2]
  S drag_below = S(0);             ///< where it acts, below the centre of mass [m]
  PlateDesign<S> tail = {};        ///< [body.tail], normal to z
  PlateDesign<S> fin = {};         ///< [body.fin], normal to y
  ControlDesign<S> control = {};   ///< [body.control]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.inertia_roll, self.inertia_pitch, self.inertia_yaw, self.inertia_product, self.shoulder_ahead,
               self.shoulder_aside, self.shoulder_above, self.stroke_plane_tilt, self.mean_stroke_angle, self.opposed,
               self.wing_mass, self.wing_centre, self.drag_area_forward, self.drag_area_sideways,
               self.drag_area_vertical, self.drag_below, self.tail, self.fin, self.control);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace body_key {
inline constexpr ParameterKey inertia_roll{"body.inertia_roll", "kg m2", range::positive};
inline constexpr ParameterKey inertia_pitch{"body.inertia_pitch", "kg m2", range::positive};
inline constexpr ParameterKey inertia_yaw{"body.inertia_yaw", "kg m2", range::positive};
inline constexpr ParameterKey inertia_product{"body.inertia_product", "kg m2", range::any};
inline constexpr ParameterKey shoulder_ahead{"body.shoulder_ahead", "m", range::any};
inline constexpr ParameterKey shoulder_aside{"body.shoulder_aside", "m", range::not_negative};
inline constexpr ParameterKey shoulder_above{"body.shoulder_above", "m", range::any};
inline constexpr ParameterKey stroke_plane_tilt{"body.stroke_plane_tilt", "rad", range::any};
inline constexpr ParameterKey mean_stroke_angle{"body.mean_stroke_angle", "rad", range::any};
inline constexpr ParameterKey wing_mass{"body.wing_mass", "kg", range::positive};
inline constexpr ParameterKey wing_centre{"body.wing_centre", "m", range::positive};
inline constexpr ParameterKey drag_area_forward{"body.drag_area_forward", "m2", range::not_negative};
inline constexpr ParameterKey drag_area_sideways{"body.drag_area_sideways", "m2", range::not_negative};
inline constexpr ParameterKey drag_area_vertical{"body.drag_area_vertical", "m2", range::not_negative};
inline constexpr ParameterKey drag_below{"body.drag_below", "m", range::any};
inline constexpr ParameterKey tail_area{"body.tail.area", "m2", range::positive};
inline constexpr ParameterKey tail_behind{"body.tail.behind", "m", range::any};
inline constexpr ParameterKey tail_below{"body.tail.below", "m", range::any};
inline constexpr ParameterKey tail_coefficient{"body.tail.coefficient", "1", range::positive};
inline constexpr ParameterKey fin_area{"body.fin.area", "m2", range::positive};
inline constexpr ParameterKey fin_behind{"body.fin.behind", "m", range::any};
inline constexpr ParameterKey fin_below{"body.fin.below", "m", range::any};
inline constexpr ParameterKey fin_coefficient{"body.fin.coefficient", "1", range::positive};
inline constexpr ParameterKey control_stroke{"body.control.mean_stroke_angle", "rad", range::positive};
inline constexpr ParameterKey control_plane{"body.control.stroke_plane_difference", "rad", range::positive};
inline constexpr ParameterKey control_incidence{"body.control.incidence_difference", "rad", range::positive};
inline constexpr ParameterKey control_voltage{"body.control.voltage_max", "V", range::positive};
}  // namespace body_key

/// Force [N] and moment about the centre of mass [N m], in body axes.
struct BodyLoads {
  Triple force{}, moment{};
};

/// A force at a place from the centre of mass.
inline void add_force(const Triple& place, const Triple& force, BodyLoads& loads) {
  const Triple moment = cross(place, force);
  for (std::size_t k = 0; k < 3; ++k) loads.force[k] += force[k], loads.moment[k] += moment[k];
}

/// A flat plate in body axes.
struct Plate {
  Triple place{}, normal{};
  double area = 0.0;         ///< [m2]
  double coefficient = 2.0;  ///< [1]
};

/// A rigid body in air.
struct Body {
  double mass = 0.0;                                                                         ///< [kg]
  double inertia_roll = 0.0, inertia_pitch = 0.0, inertia_yaw = 0.0, inertia_product = 0.0;  ///< [kg m2]
  Triple drag_area{};                                                                        ///< [m2]
  double drag_below = 0.0;                                                                   ///< [m]
  std::array<Plate, 2> plates{};
  double air_density = 0.0;  ///< [kg/m3]
};

/// Where the body is and how it moves. Earth axes: x north, y east, z down.
struct BodyState {
  Triple velocity{};                                   ///< V of the centre of mass, in body axes [m/s]
  Triple rates{};                                      ///< W = (p, q, r) [rad/s]
  std::array<double, 4> attitude{1.0, 0.0, 0.0, 0.0};  ///< q from body to earth axes, of length 1
  Triple position{};                                   ///< in earth axes [m]

  template <class Self, class Use>
  static void each(Self& self, const Use& use) {
    for (auto& x : self.velocity) use(x);
    for (auto& x : self.rates) use(x);
    for (auto& x : self.attitude) use(x);
    for (auto& x : self.position) use(x);
  }
};
inline constexpr std::size_t body_state_count = 13;

/// A vector of body axes in earth axes, and the other way; of an attitude of any length > 0.
Triple to_earth(const std::array<double, 4>& attitude, const Triple& v);
Triple to_body(const std::array<double, 4>& attitude, const Triple& v);

/// Roll, pitch and yaw [rad], turned in the order yaw, pitch, roll.
Triple euler_angles(const std::array<double, 4>& attitude);
std::array<double, 4> attitude_of(const Triple& euler_angles);

/// \f$I W\f$ and \f$I^{-1} M\f$.
Triple inertia_times(const Body& body, const Triple& W);
Triple inertia_solve(const Body& body, const Triple& M);

/// What the air does to body, tail and fin that move against it with the velocity of the centre of mass and the rates
/// given. Of a plate of the normal n: \f$F = -\tfrac12 \rho\, C A\, |v| (v \cdot n)\, n\f$.
BodyLoads plate_loads(const Body& body, const Triple& velocity, const Triple& rates);

/// Rates of all of a state under loads beside gravity g [m/s2]; model.md section 18.
/// \f[
/// m (\dot V + W \times V) = F + m R^\mathsf{T} g, \qquad I \dot W + W \times I W = M, \qquad
/// \dot q = \tfrac12 q \otimes (0, W)
/// \f]
BodyState body_rates(const Body& body, const BodyState& state, const BodyLoads& loads, double gravity);

/// Kinetic and potential energy over the height of the origin [J].
double body_energy(const Body& body, const BodyState& state, double gravity);

}  // namespace wingbeat

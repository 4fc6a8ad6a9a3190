// What the air does to a strip of a wing that moves with any velocity, whoever moves it; model.md sections 3 and 12.
#pragma once

#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/parts/pitching_wings.hpp"

namespace wingbeat {

/// Of a strip over \f$\tfrac12 \rho\, c\, \mathrm{d}r\f$ [m2/s2]: in the stroke plane, in the direction in which it
/// flaps, and upwards, normal to that plane.
template <Scalar S>
struct StripForce {
  S ahead, up;
};

/// Lift and drag coefficient [1] at an angle of attack [rad]; of wings on hinges the components of their normal force.
template <Scalar S>
struct StripCoefficients {
  S lift, drag;
};
template <Scalar S>
StripCoefficients<S> strip_coefficients(const BladeElement<S>& w, const PitchingWings<S>& p, bool on_hinges,
                                        const S& alpha) {
  using std::cos;
  using std::sin;
  if (!on_hinges) return {lift_coefficient(w.coefficients, alpha), drag_coefficient(w.coefficients, alpha)};
  const S normal = normal_force_coefficient(w, p, alpha);
  return {normal * cos(alpha), normal * sin(alpha)};
}

/// The force without rotation and added mass on a strip that moves with u > 0 ahead and w downwards [m/s], its chord
/// inclined by alpha [rad] to the stroke plane. Its lift is normal to the velocity \f$V = (u, w)\f$, its drag against
/// it; where w = 0 they are those of aero_loads().
/// \f[
/// \varphi = \arctan\frac{w}{u}, \qquad F_\mathrm{up} = V^2 \left( C_\mathrm{L}(\alpha + \varphi) \cos\varphi
/// + C_\mathrm{D}(\alpha + \varphi) \sin\varphi \right), \qquad F_\mathrm{ahead} = V^2 \left(
/// C_\mathrm{L}(\alpha + \varphi) \sin\varphi - C_\mathrm{D}(\alpha + \varphi) \cos\varphi \right)
/// \f]
template <Scalar S>
StripForce<S> strip_force(const BladeElement<S>& wings, const PitchingWings<S>& hinged, bool on_hinges, const S& alpha,
                          const S& u, const S& w) {
  using std::atan;
  using std::cos;
  using std::sin;
  const S phi = atan(S(w / u)), square_of_speed = square(u) + square(w), c = cos(phi), s = sin(phi);
  const StripCoefficients<S> coefficient = strip_coefficients(wings, hinged, on_hinges, S(alpha + phi));
  return {square_of_speed * (coefficient.lift * s - coefficient.drag * c),
          square_of_speed * (coefficient.lift * c + coefficient.drag * s)};
}

}  // namespace wingbeat

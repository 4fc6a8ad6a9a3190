// What a transmission is to the rest: stroke angle and levers at a crank angle, and where the stroke reverses; model.md
// sections 2 and 12. slider_crank.hpp is one; anything that satisfies the concept at the end flaps like it.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

/// Position of a transmission and its levers at one crank angle theta. Friction acts on the internal force F, the rod
/// force of a slider-crank. The stroke angle is beta = stroke_offset + arctan(tan_stroke): a law that knows the tangent
/// leaves the arc tangent to those who need the angle, one that knows the angle puts it into the offset. The wings'
/// motion follows the crank's, and F turns the wings with the moment \f$F g\f$ and loads the crank with the torque
/// \f$F h\f$ (eqs 1, 5, 21; model.md section 2):
/// \f[
/// \dot\beta = B_1 \omega, \qquad \ddot\beta = B_1 \dot\omega + B_2 \omega^2, \qquad
/// F h \omega = F g \dot\beta \iff h = g B_1
/// \f]
template <Scalar S>
struct CrankKinematics {
  S stroke_offset;             ///< [rad]; 0 of a slider-crank
  S tan_stroke;                ///< tangent of the stroke angle, less the offset [1]
  S stroke_slope;              ///< \f$B_1 = \mathrm{d}\beta/\mathrm{d}\theta\f$ [1]
  S stroke_second_derivative;  ///< \f$B_2 = \mathrm{d}^2\beta/\mathrm{d}\theta^2\f$ [1]
  S wing_jacobian;             ///< g: moment on all wings per unit of F [m]
  S crank_jacobian;            ///< h: torque on the crank per unit of F [m]; h = g B1 conserves power

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.stroke_offset, self.tan_stroke, self.stroke_slope, self.stroke_second_derivative,
               self.wing_jacobian, self.crank_jacobian);
  }
};

/// Stroke angle beta [rad]. Apart from the kinematics because only springs and reports need it.
template <Scalar S>
S stroke_angle(const CrankKinematics<S>& k) {
  using std::atan;
  return k.stroke_offset + atan(k.tan_stroke);
}

/// The key that slider-cranks and four-bars share; what it is compared with, their validate() knows.
inline constexpr ParameterKey crank_radius_key{
    "transmission.crank_radius", "m", {"> 0, < every other link", "must be > 0", 0.0, range::endless, true}};

/// The crank angles at which the stroke velocity of a turning crank changes its sign.
struct Reversals {
  static constexpr std::size_t max_count = 8;
  std::array<double, max_count> angle{};  ///< [rad], growing, > 0 and < 2 pi; a reversal at 0 itself is not listed
  std::size_t count = 0;
  double first_sign = 1.0;  ///< of d beta / d theta, from crank angle 0 to the first of them
};

/// The reversals of any transmission, from the sign of d beta / d theta on a grid of crank angles and by bisection: for
/// those without a closed form. Only the first Reversals::max_count are found.
template <class T>
Reversals find_reversals(const T& transmission) {
  constexpr int grid = 720;
  const auto slope = [&](double theta) {
    return crank_kinematics(transmission, std::sin(theta), std::cos(theta)).stroke_slope;
  };
  Reversals found;
  const double start = 1e-9;
  double before = start;
  found.first_sign = sign_of(slope(start));
  double sign = found.first_sign;
  for (int n = 1; n <= grid && found.count < Reversals::max_count; ++n) {
    const double here = n < grid ? two_pi * n / grid : two_pi - start;
    if (sign_of(slope(here)) != sign) {
      found.angle[found.count++] =
          bisect([&](double theta) { return sign_of(slope(theta)) == sign; }, before, here).after;
      sign = -sign;
    }
    before = here;
  }
  return found;
}

/// A transmission of the scalar S. All functions are found beside its type:
///
///   crank_kinematics(t, sin_theta, cos_theta)  at the crank angle with that sine and cosine
///   reversals(t), validate(t)                  of a transmission of plain numbers
///   stroke_amplitude(t)                        half the peak-to-peak stroke angle [rad]
///   typical_stroke_slope(t)                    size of d beta / d theta over a turn [1], for scales
///   typical_lever(t)                           size of g [m]: beside it a lever counts as lost
///   typical_crank_lever(t)                     size of h over a turn [m], for scales
///   stroke_reach(t)                            of plain numbers: largest stroke angle to either side [rad]
template <class T, class S>
concept Transmission = requires(const T& t, const S& x) {
  { crank_kinematics(t, x, x) } -> std::same_as<CrankKinematics<S>>;
  { stroke_amplitude(t) } -> std::convertible_to<S>;
  { typical_stroke_slope(t) } -> std::convertible_to<S>;
  { typical_lever(t) } -> std::convertible_to<S>;
  { typical_crank_lever(t) } -> std::convertible_to<S>;
} && (!std::same_as<S, double> || requires(const T& t) {
                         { reversals(t) } -> std::same_as<Reversals>;
                         { stroke_reach(t) } -> std::same_as<double>;
                         validate(t);
                       });

}  // namespace wingbeat

// Four-bar linkage: a crank drives a rocker through a coupler, the rocker swings the wings, itself or through a gear
// pair or string; docs/model.md section 8.
#pragma once

#include <cmath>
#include <string_view>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/transmission.hpp"

namespace wingbeat {

/// Keys, units and ranges; the table of parameters has them from here.
namespace four_bar_key {
inline constexpr ParameterKey coupler_length{"transmission.coupler_length", "m", range::positive};
inline constexpr ParameterKey rocker_length{"transmission.rocker_length", "m", range::positive};
inline constexpr ParameterKey ground_length{"transmission.ground_length", "m", range::positive};
inline constexpr ParameterKey stroke_ratio{"transmission.stroke_ratio", "1", range::positive};
inline constexpr ParameterKey ground_angle{"transmission.ground_angle", "rad", range::any};
}  // namespace four_bar_key

/// Crank axis at the origin, rocker axis at d on the x axis, the rocker pointing to y > 0. The crank angle theta is
/// measured from the line of the two axes and grows with rotation. Loop closure with the angles \f$\varphi\f$ of the
/// rocker and \f$\chi\f$ of the coupler, and stroke angle (model.md section 8):
/// \f[
/// d + p\, e^{\mathrm{i}\varphi} = r_\mathrm{c} e^{\mathrm{i}\theta} + l\, e^{\mathrm{i}\chi}, \qquad
/// \beta = n_\mathrm{s} (\varphi - \varphi_\mathrm{mid})
/// \f]
template <Scalar S>
struct FourBar {
  S crank_radius = S(0);    ///< r_c [m], > 0, the shortest link
  S coupler_length = S(0);  ///< l [m], > 0
  S rocker_length = S(0);   ///< p [m], > 0
  S ground_length = S(0);   ///< d, crank axis to rocker axis [m], > 0
  S stroke_ratio = S(1);    ///< n_s, turning angle of the wings over that of the rocker [1], > 0
  S ground_angle = S(0);    ///< phi_mid, from the ground link to the rocker at stroke angle zero [rad]

  static constexpr std::string_view keys[] = {crank_radius_key.path,
                                              four_bar_key::coupler_length.path,
                                              four_bar_key::rocker_length.path,
                                              four_bar_key::ground_length.path,
                                              four_bar_key::stroke_ratio.path,
                                              four_bar_key::ground_angle.path};
  /// From a TransmissionDesign.
  template <class Design>
  static FourBar from(const Design& d) {
    FourBar f{d.crank_radius, d.coupler_length, d.rocker_length, d.ground_length, d.stroke_ratio};
    f.ground_angle = d.ground_angle ? *d.ground_angle : centred_ground_angle(f);
    return f;
  }

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.crank_radius, self.coupler_length, self.rocker_length, self.ground_length, self.stroke_ratio,
               self.ground_angle);
  }
};

/// Least transmission angle between coupler and rocker, and least distance from 180 deg [deg]: beyond, the coupler has
/// hardly a lever.
inline constexpr double transmission_angle_min_deg = 5.0;

/// Refuses what has no crank that turns (Grashof), and a transmission angle beyond its bounds.
void validate(const FourBar<double>& f);

/// Kinematics at a crank angle given by its sine and cosine. The internal force F is the coupler's, with the levers g
/// on the wings and h on the crank at the transmission angle \f$\mu\f$. A prime is a derivative by \f$\theta\f$.
/// \f[
/// \begin{aligned}
/// \mu &= \varphi - \chi, \qquad g = \frac{p \sin\mu}{n_\mathrm{s}}, \qquad h = r_\mathrm{c} \sin(\theta - \chi) \cr
/// \varphi' &= \frac{h}{p \sin\mu}, \qquad B_1 = n_\mathrm{s} \varphi' = \frac{h}{g}, \qquad
/// B_2 = n_\mathrm{s} \frac{h' - \varphi' (p \sin\mu)'}{p \sin\mu}
/// \end{aligned}
/// \f]
template <Scalar S>
CrankKinematics<S> crank_kinematics(const FourBar<S>& f, const S& sin_theta, const S& cos_theta) {
  using std::atan;
  const S r_c = f.crank_radius, l = f.coupler_length, p = f.rocker_length, n_s = f.stroke_ratio;
  // From the rocker's axis to the crank pin, and the triangle of that diagonal, rocker and coupler.
  const S w_x = r_c * cos_theta - f.ground_length, w_y = r_c * sin_theta;
  const S diagonal2 = square(w_x) + square(w_y);
  const S along = (diagonal2 + square(p) - square(l)) / (S(2.0) * p);
  // Heron's form, exact where rocker and ground are long.
  const S product = (square(S(p + l)) - diagonal2) * (diagonal2 - square(S(p - l)));
  const S across = root_of(product).value / (S(2.0) * p);
  const S per_diagonal2 = inverse_of(diagonal2);
  const S cos_phi = (w_x * along + w_y * across) * per_diagonal2;
  const S sin_phi = (w_y * along - w_x * across) * per_diagonal2;
  // Coupler from crank pin to rocker pin, l e^(i chi).
  const S u_x = p * cos_phi - w_x, u_y = p * sin_phi - w_y;

  // Loop closure: phi' = h / (p sin mu), numerator and denominator times l.
  const S l_h = r_c * (sin_theta * u_x - cos_theta * u_y);
  const S l_p_sin_mu = p * (sin_phi * u_x - cos_phi * u_y);
  const S per_l_p_sin_mu = inverse_of(l_p_sin_mu);
  const S slope = l_h * per_l_p_sin_mu;
  const S du_x = r_c * sin_theta - p * slope * sin_phi, du_y = p * slope * cos_phi - r_c * cos_theta;
  const S dl_h = r_c * (cos_theta * u_x + sin_theta * u_y + sin_theta * du_x - cos_theta * du_y);
  const S dl_p_sin_mu = p * (slope * (cos_phi * u_x + sin_phi * u_y) + sin_phi * du_x - cos_phi * du_y);
  const S per_l = inverse_of(l);

  CrankKinematics<S> k;
  k.stroke_offset = n_s * (S(0.5 * pi) - atan(S(cos_phi * inverse_of(sin_phi))) - f.ground_angle);
  k.tan_stroke = S(0.0);
  k.stroke_slope = n_s * slope;
  k.stroke_second_derivative = n_s * (dl_h - slope * dl_p_sin_mu) * per_l_p_sin_mu;
  k.wing_jacobian = l_p_sin_mu * per_l / n_s;
  k.crank_jacobian = l_h * per_l;
  return k;
}

/// The rocker's angles phi [rad] where its swing ends, with crank and coupler stretched out (+) and folded over (-).
/// \f[
/// \varphi_\pm = \pi - \arccos\frac{d^2 + p^2 - (l \pm r_\mathrm{c})^2}{2\, d\, p}
/// \f]
template <Scalar S>
struct RockerEnds {
  S stretched, folded;
};

template <Scalar S>
RockerEnds<S> rocker_ends(const FourBar<S>& f) {
  using std::atan;
  const S d = f.ground_length, p = f.rocker_length;
  // pi less the angle at the rocker's axis of the triangle with the side `reach` opposite.
  const auto angle_beyond = [&](const S& reach) {
    const S cosine = (square(d) + square(p) - square(reach)) / (S(2.0) * d * p);
    return S(S(pi) - S(2.0) * atan(root_of(S((S(1.0) - cosine) / (S(1.0) + cosine))).value));
  };
  return {angle_beyond(S(f.coupler_length + f.crank_radius)), angle_beyond(S(f.coupler_length - f.crank_radius))};
}

/// \f$\varphi_\mathrm{mid} = \tfrac12 (\varphi_+ + \varphi_-)\f$ [rad], which centres the stroke at zero.
template <Scalar S>
S centred_ground_angle(const FourBar<S>& f) {
  const RockerEnds<S> ends = rocker_ends(f);
  return S(0.5) * (ends.stretched + ends.folded);
}

Reversals reversals(const FourBar<double>& f);

/// Half the peak-to-peak stroke angle, \f$\tfrac12 n_\mathrm{s} (\varphi_- - \varphi_+)\f$ [rad].
template <Scalar S>
S stroke_amplitude(const FourBar<S>& f) {
  const RockerEnds<S> ends = rocker_ends(f);
  return S(0.5) * f.stroke_ratio * (ends.folded - ends.stretched);
}

/// Largest stroke angle to either side, \f$n_\mathrm{s} \max_\pm |\varphi_\pm - \varphi_\mathrm{mid}|\f$ [rad].
inline double stroke_reach(const FourBar<double>& f) {
  const RockerEnds<double> ends = rocker_ends(f);
  return f.stroke_ratio * std::fmax(std::abs(ends.folded - f.ground_angle), std::abs(ends.stretched - f.ground_angle));
}

/// \f$n_\mathrm{s} r_\mathrm{c} / p\f$, B1 where crank and rocker are perpendicular to the coupler [1].
template <Scalar S>
S typical_stroke_slope(const FourBar<S>& f) {
  return f.stroke_ratio * f.crank_radius / f.rocker_length;
}

/// g where rocker and coupler are perpendicular, \f$p / n_\mathrm{s}\f$ [m].
template <Scalar S>
S typical_lever(const FourBar<S>& f) {
  return f.rocker_length / f.stroke_ratio;
}

/// h where crank and coupler are perpendicular, \f$r_\mathrm{c}\f$ [m].
template <Scalar S>
S typical_crank_lever(const FourBar<S>& f) {
  return f.crank_radius;
}

}  // namespace wingbeat

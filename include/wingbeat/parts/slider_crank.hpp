// Slider-crank mechanism: crank, rod, vertical slider and wing hinge; model.md sections 1 and 2, eqs (1, 5, 21).
#pragma once

#include <cmath>
#include <string_view>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/transmission.hpp"
#include "wingbeat/parts/transmission_type.hpp"

namespace wingbeat {

/// Keys, units and ranges; the table of parameters has them from here.
namespace slider_crank_key {
inline constexpr ParameterKey rod_length{
    "transmission.rod_length",
    "m",
    {"> crank_radius", "must be longer than the crank radius", 0.0, range::endless, true}};
inline constexpr ParameterKey hinge_offset{"transmission.hinge_offset", "m", range::positive};
inline constexpr ParameterKey mid_stroke_height{"transmission.mid_stroke_height", "m", range::any};
inline constexpr ParameterKey stroke_amplitude{"transmission.stroke_amplitude", "rad", range::acute};
}  // namespace slider_crank_key

/// The hinge offset H [m] that gives a stroke amplitude \f$\beta_\mathrm{max}\f$ [rad] with the mid-stroke at
/// \f$y_0 = l\f$.
/// \f[
/// H = \frac{r_\mathrm{c}}{\tan\beta_\mathrm{max}}
/// \f]
template <Scalar S>
S hinge_offset_for(const S& amplitude, const S& crank_radius) {
  using std::tan;
  return crank_radius / tan(amplitude);
}

/// Geometry of the mechanism. The crank angle theta is measured from the horizontal and grows with rotation. The rod is
/// at \f$\gamma\f$ from the vertical, the slider at the height y over the crank axis (model.md section 1):
/// \f[
/// \sin\gamma = \frac{r_\mathrm{c}}{l} \cos\theta, \qquad y = r_\mathrm{c} \sin\theta + l \cos\gamma, \qquad
/// \tan\beta = \frac{y - y_0}{H}
/// \f]
template <Scalar S>
struct SliderCrank {
  S crank_radius = S(0);       ///< r_c [m], > 0, < l
  S rod_length = S(0);         ///< l [m], > r_c
  S hinge_offset = S(0);       ///< H, horizontal distance slider to wing hinge [m], > 0
  S mid_stroke_height = S(0);  ///< y_0, slider height over the crank axis at stroke angle zero [m]; l unless given
  Formulation formulation = Formulation::rod_force;

  static constexpr std::string_view keys[] = {
      crank_radius_key.path, slider_crank_key::rod_length.path, slider_crank_key::hinge_offset.path,
      slider_crank_key::stroke_amplitude.path, slider_crank_key::mid_stroke_height.path};
  /// From a TransmissionDesign that states the hinge offset or the stroke amplitude.
  template <class Design>
  static SliderCrank from(const Design& d) {
    const S H = d.hinge_offset ? *d.hinge_offset : hinge_offset_for<S>(*d.stroke_amplitude, d.crank_radius);
    return {d.crank_radius, d.rod_length, H, d.mid_stroke_height ? *d.mid_stroke_height : d.rod_length, d.formulation};
  }

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.crank_radius, self.rod_length, self.hinge_offset, self.mid_stroke_height, self.formulation);
  }
};

inline void validate(const SliderCrank<double>& c) {
  namespace key = slider_crank_key;
  require(crank_radius_key, c.crank_radius);
  require(c.rod_length > c.crank_radius, key::rod_length.path, key::rod_length.range.expected, key::rod_length.unit,
          c.rod_length);
  require(key::hinge_offset, c.hinge_offset);
  require(key::mid_stroke_height, c.mid_stroke_height);
}

/// A slider-crank with the quotients that its kinematics needs at every crank angle.
template <Scalar S>
struct CrankGeometry {
  SliderCrank<S> crank;
  S rod_ratio;         ///< r_c / l [1]
  S per_hinge_offset;  ///< 1 / H [1/m]
};

template <Scalar S>
CrankGeometry<S> geometry_of(const SliderCrank<S>& c) {
  return {c, c.crank_radius / c.rod_length, S(1.0) / c.hinge_offset};
}

/// Kinematics at a crank angle given by its sine and cosine. A prime is a derivative by \f$\theta\f$; g as under
/// Formulation (eqs 1, 5; model.md section 2).
/// \f[
/// \begin{aligned}
/// y' &= r_\mathrm{c} (\cos\theta + \sin\theta \tan\gamma), \qquad
/// y'' = r_\mathrm{c} \left( \cos\theta \tan\gamma - \sin\theta
/// - \frac{r_\mathrm{c}}{l} \frac{\sin^2\theta}{\cos^3\gamma} \right) \cr
/// B_1 &= \frac{\mathrm{d}\beta}{\mathrm{d}\theta} = \frac{y'}{H} \cos^2\beta, \qquad
/// B_2 = \frac{\mathrm{d}^2\beta}{\mathrm{d}\theta^2} = \frac{y''}{H} \cos^2\beta - 2 \tan\beta\, B_1^2 \cr
/// h &= y' \cos\gamma = r_\mathrm{c} (\sin\theta \sin\gamma + \cos\theta \cos\gamma)
/// \end{aligned}
/// \f]
template <Scalar S>
CrankKinematics<S> crank_kinematics(const CrankGeometry<S>& geometry, const S& sin_theta, const S& cos_theta) {
  const SliderCrank<S>& c = geometry.crank;
  const S r_c = c.crank_radius;
  const S H = c.hinge_offset;
  const S ratio = geometry.rod_ratio;
  const S per_H = geometry.per_hinge_offset;
  const S sin_gamma = ratio * cos_theta;
  const S cos2_gamma = S(1.0) - sin_gamma * sin_gamma;
  const Root<S> root = root_of(cos2_gamma);
  const S cos_gamma = root.value;
  const S sec_gamma = root.inverse;
  const S tan_gamma = sin_gamma * sec_gamma;

  const S y = r_c * sin_theta + c.rod_length * cos_gamma;
  const S dy = r_c * (cos_theta + sin_theta * tan_gamma);
  const S ddy = r_c * (cos_theta * tan_gamma - sin_theta - ratio * square(sin_theta) * sec_gamma * square(sec_gamma));

  const S tan_beta = (y - c.mid_stroke_height) * per_H;
  const S sec2_beta = S(1.0) + square(tan_beta);
  const S cos2_beta = inverse_of(sec2_beta);

  CrankKinematics<S> k;
  k.stroke_offset = S(0.0);
  k.tan_stroke = tan_beta;
  k.stroke_slope = dy * per_H * cos2_beta;
  k.stroke_second_derivative = ddy * per_H * cos2_beta - S(2.0) * tan_beta * square(k.stroke_slope);
  k.wing_jacobian =
      c.formulation == Formulation::rod_force ? H * (sin_gamma * tan_beta + cos_gamma) : H * cos_gamma * sec2_beta;
  k.crank_jacobian = cos_gamma * dy;
  return k;
}

template <Scalar S>
CrankKinematics<S> crank_kinematics(const SliderCrank<S>& c, const S& sin_theta, const S& cos_theta) {
  return crank_kinematics(geometry_of(c), sin_theta, cos_theta);
}

/// The slider's height over the crank axis [m], \f$y = r_\mathrm{c} \sin\theta + l \cos\gamma\f$.
template <Scalar S>
S slider_height(const SliderCrank<S>& c, const S& sin_theta, const S& cos_theta) {
  const S sin_gamma = c.crank_radius / c.rod_length * cos_theta;
  return c.crank_radius * sin_theta + c.rod_length * root_of(S(S(1.0) - sin_gamma * sin_gamma)).value;
}

/// Crank angle of the upper dead centre; the lower one is at the same angle below the horizontal [rad].
inline constexpr double slider_crank_dead_centre = 0.5 * pi;

/// The dead centres: dy/dtheta = 0, as long as the rod is longer than the crank.
inline Reversals reversals(const SliderCrank<double>&) {
  return {{slider_crank_dead_centre, two_pi - slider_crank_dead_centre}, 2, 1.0};
}

/// B1 at mid-stroke, \f$r_\mathrm{c} / H\f$ [1].
template <Scalar S>
S typical_stroke_slope(const SliderCrank<S>& c) {
  return c.crank_radius / c.hinge_offset;
}

/// g at mid-stroke but for the rod's obliquity, H [m].
template <Scalar S>
S typical_lever(const SliderCrank<S>& c) {
  return c.hinge_offset;
}

/// h at mid-stroke, r_c [m].
template <Scalar S>
S typical_crank_lever(const SliderCrank<S>& c) {
  return c.crank_radius;
}

/// Largest stroke angle to either side [rad].
/// \f[
/// \max_\pm \left| \arctan\frac{l \pm r_\mathrm{c} - y_0}{H} \right|
/// \f]
inline double stroke_reach(const SliderCrank<double>& c) {
  const double top = std::atan((c.rod_length + c.crank_radius - c.mid_stroke_height) / c.hinge_offset);
  const double bottom = std::atan((c.rod_length - c.crank_radius - c.mid_stroke_height) / c.hinge_offset);
  return std::fmax(std::abs(top), std::abs(bottom));
}

/// Half the peak-to-peak stroke angle [rad], between the dead centres.
/// \f[
/// \frac12 \left( \arctan\frac{l + r_\mathrm{c} - y_0}{H} - \arctan\frac{l - r_\mathrm{c} - y_0}{H} \right)
/// \f]
template <Scalar S>
S stroke_amplitude(const SliderCrank<S>& c) {
  using std::atan;
  const S top = atan((c.rod_length + c.crank_radius - c.mid_stroke_height) / c.hinge_offset);
  const S bottom = atan((c.rod_length - c.crank_radius - c.mid_stroke_height) / c.hinge_offset);
  return S(0.5) * (top - bottom);
}

}  // namespace wingbeat

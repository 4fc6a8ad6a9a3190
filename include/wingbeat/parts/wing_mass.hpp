// Mass properties of a wing from its drawing: a membrane behind a straight leading edge that carries a spar, and ribs.
#pragma once

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/planform.hpp"

namespace wingbeat {

/// What a wing is made of. Glue counts in the areal density, spread over the membrane.
template <Scalar S>
struct WingMaterial {
  S areal_density = S(0);  ///< sigma of the membrane [kg/m2], > 0
  S spar_density = S(0);   ///< lambda, mass of the leading-edge spar over its length, from root to tip [kg/m], >= 0
  S rib_density = S(0);    ///< lambda_r, mass of a rib over its length, from leading to trailing edge [kg/m], >= 0
  S rib_count = S(0);      ///< n_r, ribs along the chord that part the length into n_r + 1 equal bays

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.areal_density, self.spar_density, self.rib_density, self.rib_count);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace wing_material_key {
inline constexpr ParameterKey areal_density{"wing.areal_density", "kg/m2", range::positive};
inline constexpr ParameterKey spar_density{"wing.spar_density", "kg/m", range::not_negative};
inline constexpr ParameterKey rib_density{"wing.rib_density", "kg/m", range::not_negative};
inline constexpr ParameterKey rib_count{"wing.rib_count", "1", range::at_most_thousand};
}  // namespace wing_material_key

/// Of one wing. r is the distance from the flapping hinge, x that behind the axis about which the wing pitches.
template <Scalar S>
struct WingMass {
  S mass;           ///< \f$m\f$ [kg]
  S inertia;        ///< \f$J_\mathrm{w} = \int r^2\,\mathrm{d}m\f$ about the flapping hinge [kg m2]
  S pitch_inertia;  ///< \f$I_\psi = \int x^2\,\mathrm{d}m\f$ about the pitch axis [kg m2]
  S mass_product;   ///< \f$P = \int r x\,\mathrm{d}m\f$ [kg m2]
};

/// Mass properties of one wing of that outline; not for planforms given by moments, which have none. With the hub
/// offset d and ribs at \f$r_n = d + n R/(n_\mathrm{r} + 1)\f$, n = 1 to n_r (model.md section 14):
/// \f[
/// \begin{aligned}
/// m &= \sigma \int c\,\mathrm{d}r + \lambda R + \sum_n \lambda_\mathrm{r}\, c(r_n) \cr
/// J_\mathrm{w} &= \sigma \int c\, r^2\,\mathrm{d}r + \lambda\, \frac{(R + d)^3 - d^3}{3}
/// + \sum_n \lambda_\mathrm{r}\, c(r_n)\, r_n^2 \cr
/// I_\psi &= \frac{\sigma}{3} \int c^3\,\mathrm{d}r + \sum_n \lambda_\mathrm{r} \frac{c(r_n)^3}{3}
/// - \hat x_0 m_{30} + \hat x_0^2 \left( m_{30} + \lambda \int c^2\,\mathrm{d}r \right) \cr
/// P &= \frac{\sigma}{2} \int c^2 r\,\mathrm{d}r + \sum_n \lambda_\mathrm{r} \frac{c(r_n)^2 r_n}{2}
/// - \hat x_0 \left( m_{21} + \lambda \int c\, r\,\mathrm{d}r \right) \cr
/// m_{30} &= \sigma \int c^3\,\mathrm{d}r + \sum_n \lambda_\mathrm{r}\, c(r_n)^3, \qquad
/// m_{21} = \sigma \int c^2 r\,\mathrm{d}r + \sum_n \lambda_\mathrm{r}\, c(r_n)^2 r_n
/// \end{aligned}
/// \f]
/// where the pitch axis is straight, at the part \f$\hat x_0\f$ of the chord behind the leading edge.
template <Scalar S>
WingMass<S> wing_mass(const WingMaterial<S>& material, const Planform<S>& p, const S& axis = S(0.0)) {
  const S& sigma = material.areal_density;
  const S& lambda = material.spar_density;
  const S d = hub_offset_of(p);
  const S R = length_of(p);
  const S tip = d + R;
  const PitchChordMoments<S> s = pitch_chord_moments(p, S(1.0));
  WingMass<S> wing{sigma * wing_area(p) + lambda * R,
                   sigma * one_wing_moments(p).s2 + lambda * (tip * tip * tip - d * d * d) / S(3.0),
                   sigma * s.s30 / S(3.0), S(0.5) * sigma * s.s21};
  S m30 = sigma * s.s30, m21 = sigma * s.s21;
  const double bays = value_of(material.rib_count) + 1.0;
  for (double n = 1.0; n < bays; n += 1.0) {
    const S c = chord_at(p, n / bays), r = d + S(n / bays) * R, rib = material.rib_density * c;
    wing.mass = wing.mass + rib;
    wing.inertia = wing.inertia + rib * r * r;
    wing.pitch_inertia = wing.pitch_inertia + rib * c * c / S(3.0);
    wing.mass_product = wing.mass_product + S(0.5) * rib * c * r;
    m30 = m30 + rib * square(c);
    m21 = m21 + rib * c * r;
  }
  wing.pitch_inertia = wing.pitch_inertia - axis * m30 + square(axis) * (m30 + lambda * chord_square(p));
  wing.mass_product = wing.mass_product - axis * (m21 + lambda * first_chord_moment(p, S(1.0)));
  return wing;
}

}  // namespace wingbeat

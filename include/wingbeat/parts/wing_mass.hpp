// Mass moments of a wing made of a membrane and a leading-edge spar; model.md section 12.
#pragma once

#include "wingbeat/parts/planform.hpp"

namespace wingbeat {

/// Of ONE wing about its hinge and its leading-edge axis.
template <Scalar S>
struct WingMass {
  S mass;           ///< [kg]
  S inertia;        ///< J_w = integral r^2 dm [kg m2]
  S pitch_inertia;  ///< I_psi = integral x^2 dm [kg m2]
  S mass_product;   ///< P = integral r x dm [kg m2]
};

/// Of a planform that has a shape, its leading edge straight: a membrane of `areal_density` sigma [kg/m2] from the axis
/// to x = c, and a thin spar of `spar_density` [kg/m] along the axis, from root to tip. J_w = sigma S_2 + spar, I_psi =
/// sigma S_30 / 3, P = sigma S_21 / 2.
template <Scalar S>
WingMass<S> wing_mass(const Planform<S>& p, const S& areal_density, const S& spar_density) {
  const bool table = p.shape == PlanformShape::tabulated;
  const S root = p.hub_offset + (table ? S(p.chord_table.front().first) : S(0.0));
  const S tip = p.hub_offset + (table ? S(p.chord_table.back().first) : p.length);
  const S s2 = one_wing_moments(p).s2;
  const PitchChordMoments<S> s = pitch_chord_moments(p, S(1.0));
  return {areal_density * wing_area(p) + spar_density * (tip - root),
          areal_density * s2 + spar_density * (tip * tip * tip - root * root * root) / S(3.0),
          areal_density * s.s30 / S(3.0), S(0.5) * areal_density * s.s21};
}

}  // namespace wingbeat

// Mass properties of a wing from its drawing: a membrane behind a straight leading edge that carries a spar.
#pragma once

#include <cmath>
#include <cstddef>
#include <utility>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/planform.hpp"

namespace wingbeat {

/// What a wing is made of. Ribs and glue count in the areal density, spread over the membrane.
template <Scalar S>
struct WingMaterial {
  S areal_density = S(0);  ///< sigma of the membrane [kg/m2], > 0
  S spar_density = S(0);   ///< lambda, mass of the leading-edge spar over its length, from root to tip [kg/m], >= 0

  template <class Self, class Use>
  static constexpr auto members(Self& of, const Use& use) {
    return use(of.areal_density, of.spar_density);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace wing_material_key {
inline constexpr ParameterKey areal_density{"wing.areal_density", "kg/m2", range::positive};
inline constexpr ParameterKey spar_density{"wing.spar_density", "kg/m", range::not_negative};
}  // namespace wing_material_key

/// Of one wing. r is the distance from the flapping hinge, x that behind the leading edge, about which the wing
/// pitches.
template <Scalar S>
struct WingMass {
  S mass;           ///< [kg]
  S inertia;        ///< J_w = integral r^2 dm about the flapping hinge [kg m2]
  S pitch_inertia;  ///< I_psi = integral x^2 dm about the leading edge [kg m2]
  S mass_product;   ///< P = integral r x dm [kg m2]
};

namespace detail {

/// Integrals over the wing of c, c r^2, c^3 and c^2 r by r.
template <Scalar S>
struct MassIntegrals {
  S c, c_r2, c3, c2_r;
};

/// Of a shape: the planform's own scale times pure numbers q_k = integral of the k-th power of c/c_0 over u = x/R, and
/// its moments by u: {q_1, q_1 u, q_1 u^2, q_2, q_2 u, q_3}.
template <Scalar S>
MassIntegrals<S> mass_integrals(const S& c_0, const S& R, const S& d, const double (&q)[6]) {
  return {q[0] * c_0 * R, c_0 * R * (q[2] * R * R + 2.0 * q[1] * R * d + q[0] * d * d), q[5] * c_0 * c_0 * c_0 * R,
          c_0 * c_0 * R * (q[4] * R + q[3] * d)};
}

}  // namespace detail

/// Mass properties of one wing of that outline; not for planforms given by moments, which have none.
template <Scalar S>
WingMass<S> wing_mass(const WingMaterial<S>& material, const Planform<S>& p) {
  const S d = p.hub_offset;
  S R = p.length;
  const S c_0 = p.chord_ratio ? S(*p.chord_ratio * p.length) : p.root_chord;
  detail::MassIntegrals<S> m;
  switch (p.shape) {
    case PlanformShape::semi_ellipse:
      m = detail::mass_integrals<S>(c_0, R, d, {pi / 4.0, 1.0 / 3.0, pi / 16.0, 2.0 / 3.0, 0.25, 3.0 * pi / 16.0});
      break;
    case PlanformShape::rectangle:
      m = detail::mass_integrals<S>(c_0, R, d, {1.0, 0.5, 1.0 / 3.0, 1.0, 0.5, 1.0});
      break;
    default:
      m = {S(0.0), S(0.0), S(0.0), S(0.0)};
      R = p.chord_table.empty() ? S(0.0) : S(p.chord_table.back().first);
      for (std::size_t row = 1; row < p.chord_table.size(); ++row) {
        const auto [x0, c0] = p.chord_table[row - 1];
        const auto [x1, c1] = p.chord_table[row];
        // Of third degree where the chord is linear: three-point Gauss is exact.
        const double half = 0.5 * (x1 - x0), mid = 0.5 * (x0 + x1);
        constexpr double node = 0.77459666924148337704;  // sqrt(3/5)
        for (const auto& [at, weight] : {std::pair{-node, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {node, 5.0 / 9.0}}) {
          const double x = mid + half * at, c = c0 + (c1 - c0) * (x - x0) / (x1 - x0), w = weight * half;
          const S r = S(x) + d;
          m.c = m.c + S(w * c);
          m.c_r2 = m.c_r2 + S(w * c) * square(r);
          m.c3 = m.c3 + S(w * c * c * c);
          m.c2_r = m.c2_r + S(w * c * c) * r;
        }
      }
  }
  const S& sigma = material.areal_density;
  const S& lambda = material.spar_density;
  const S tip = d + R;
  return {sigma * m.c + lambda * R, sigma * m.c_r2 + lambda * (tip * tip * tip - d * d * d) / 3.0, sigma * m.c3 / 3.0,
          sigma * m.c2_r / 2.0};
}

}  // namespace wingbeat

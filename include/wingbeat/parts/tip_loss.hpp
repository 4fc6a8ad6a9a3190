// Loss of lift at the tips of wings: beyond a part of the span the air equalises the pressures of both sides, and the
// wing has its profile drag alone, as blades of rotors are modelled; model.md section 17.
#pragma once

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/planform.hpp"

namespace wingbeat {

/// The parts of all wings' chord moments that lie beyond \f$B (R + d)\f$, and what drag they have; 0 without tip loss.
template <Scalar S>
struct TipLoss {
  S s2 = S(0);            ///< of S_2 [m4]
  S s3 = S(0);            ///< of S_3 [m5]
  S s22 = S(0);           ///< of S_22 [m5]
  S profile_drag = S(0);  ///< C_D at an angle of attack of 0 [1]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.s2, self.s3, self.s22, self.profile_drag);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace tip_loss_key {
inline constexpr ParameterKey lifting_span{"aerodynamics.lifting_span", "1", range::efficiency};
}  // namespace tip_loss_key

namespace detail {

/// Nodes on 0 to 1 and weights of Gauss's rule, on either side of the middle.
inline constexpr double gauss_16_node[] = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                           0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                           0.9445750230732326, 0.9894009349916499};
inline constexpr double gauss_16_weight[] = {0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
                                             0.1495959888165767, 0.1246289712555339, 0.0951585116824928,
                                             0.0622535239386479, 0.0271524594117541};

/// Calls visit(node, weight) for the 16 nodes of Gauss's rule on 0 to 1.
template <class Visit>
void visit_gauss_16(const Visit& visit) {
  for (int k = 7; k >= 0; --k) visit(0.5 - 0.5 * gauss_16_node[k], 0.5 * gauss_16_weight[k]);
  for (int k = 0; k < 8; ++k) visit(0.5 + 0.5 * gauss_16_node[k], 0.5 * gauss_16_weight[k]);
}

/// Calls visit(width, chord, x), x from the root [m], at the nodes of a quadrature over the scaled outline from the
/// part `from` of its length to the tip: of a semi-ellipse in the angle in which its chord is smooth.
template <Scalar S, class Visit>
void visit_outer(const Planform<S>& p, const S& from, const Visit& visit) {
  using std::acos;
  using std::cos;
  using std::sin;
  const S R = length_of(p);
  if (p.shape == PlanformShape::tabulated) {
    const auto& rows = p.chord_table;
    const S start = from * S(rows.back().first);
    for (std::size_t n = 1; n < rows.size(); ++n) {
      const double x0 = rows[n - 1].first, c0 = rows[n - 1].second, x1 = rows[n].first;
      if (!(value_of(start) < x1)) continue;
      const S lower = value_of(start) > x0 ? start : S(x0);
      const double slope = (rows[n].second - c0) / (x1 - x0);
      visit_gauss_16([&](double node, double weight) {
        const S x = lower + S(node) * (S(x1) - lower);
        visit(S(p.scale * weight * (S(x1) - lower)), S(p.scale * (S(c0) + S(slope) * (x - S(x0)))), S(p.scale * x));
      });
    }
    return;
  }
  const S c_0 = root_chord_of(p);
  const bool elliptic = p.shape == PlanformShape::semi_ellipse;
  if (elliptic && value_of(from) >= 1.0) return;
  // x = R cos(phi): the width R sin(phi) d(phi) meets the chord c_0 sin(phi).
  const S width = elliptic ? S(acos(from)) : S(S(1.0) - from);
  visit_gauss_16([&](double node, double weight) {
    if (elliptic) {
      const S phi = width * S(node);
      visit(S(R * width * S(weight) * sin(phi)), S(c_0 * sin(phi)), S(R * cos(phi)));
    } else {
      visit(S(R * width * S(weight)), c_0, S(R * (from + width * S(node))));
    }
  });
}

}  // namespace detail

/// The tip loss of `count` wings of an outline that has a shape, of whose distance from hinge to tip the part B lifts.
template <Scalar S>
TipLoss<S> tip_loss(const Planform<S>& p, const S& count, const S& B, const S& profile_drag) {
  TipLoss<S> tip;
  tip.profile_drag = profile_drag;
  const S R = length_of(p), d = hub_offset_of(p);
  const S from = (B * (R + d) - d) / R;
  detail::visit_outer(p, value_of(from) > 0.0 ? from : S(0.0), [&](const S& width, const S& chord, const S& x) {
    const S r = x + d, area = count * width * chord, second = area * r * r;
    tip.s2 = tip.s2 + second;
    tip.s3 = tip.s3 + second * r;
    tip.s22 = tip.s22 + second * chord;
  });
  return tip;
}

}  // namespace wingbeat

// Torsion of a wing along its span, linear from root to tip, and the strips that a twisting wing is made of; model.md
// section 16.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/parts/planform.hpp"

namespace wingbeat {

/// Strips of an outline: nodes and weights of a quadrature along the span, on which its length and reference chord have
/// the measure 1.
struct SpanStrips {
  std::vector<double> position;  ///< distance from the root over the length
  std::vector<double> chord;     ///< over the reference chord
  std::vector<double> weight;    ///< width over the length
};

/// The wing has at the distance xR from its root the pitch \f$\psi + x \tau\f$.
template <Scalar S>
struct WingTorsion {
  /// Lanes have no wings that twist.
  using Strips = std::conditional_t<ScalarTraits<S>::reads_tables, std::shared_ptr<const SpanStrips>, std::nullptr_t>;

  S stiffness = S(0);   ///< k_tau of all wings [N m/rad]; 0: they do not twist
  S damping = S(0);     ///< c_tau of all wings [N m s/rad], >= 0
  S length = S(0);      ///< R [m]
  S chord = S(0);       ///< reference chord of the strips [m]
  S hub_offset = S(0);  ///< hinge to root [m]
  S count = S(0);       ///< wings
  Strips strips = nullptr;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.stiffness, self.damping, self.length, self.chord, self.hub_offset, self.count, self.strips);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace torsion_key {
inline constexpr ParameterKey stiffness{"wing.torsion.stiffness", "N m/rad", range::positive};
inline constexpr ParameterKey damping{"wing.torsion.damping", "N m s/rad", range::not_negative};
}  // namespace torsion_key

template <Scalar S>
bool twists(const WingTorsion<S>& t) {
  return value_of(t.stiffness) > 0.0;
}

/// Part of the length at which the pitch of a twisting wing is reported.
inline constexpr double reported_station = 0.7;

/// Strips of an outline that has a shape: 8 nodes of Gauss's rule, of a semi-ellipse in \f$\arcsin x\f$, in which its
/// chord is smooth; of a table 3 between each two of its rows, exact for what is of fifth degree there.
inline std::shared_ptr<const SpanStrips> span_strips(PlanformShape shape,
                                                     const std::vector<std::pair<double, double>>& chord_table) {
  auto strips = std::make_shared<SpanStrips>();
  const auto add = [&](double position, double chord, double weight) {
    strips->position.push_back(position);
    strips->chord.push_back(chord);
    strips->weight.push_back(weight);
  };
  if (shape == PlanformShape::tabulated) {
    const double length = chord_table.back().first;
    detail::visit_table(chord_table,
                        [&](double weight, double chord, double x) { add(x / length, chord, weight / length); });
    return strips;
  }
  constexpr double nodes[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr double weights[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  for (int k = 0; k < 4; ++k) {
    for (const double side : {-1.0, 1.0}) {
      const double part = 0.5 * (1.0 + side * nodes[k]), weight = 0.5 * weights[k];
      if (shape == PlanformShape::rectangle) {
        add(part, 1.0, weight);
        continue;
      }
      const double angle = 0.5 * pi * part, cosine = std::cos(angle);
      add(std::sin(angle), cosine, 0.5 * pi * weight * cosine);
    }
  }
  return strips;
}

/// The torsion of `count` wings of an outline that has a shape, each of that stiffness [N m/rad] and damping
/// [N m s/rad].
template <Scalar S>
WingTorsion<S> wing_torsion(const Planform<S>& p, const S& count, const S& stiffness, const S& damping) {
  const bool tabulated = p.shape == PlanformShape::tabulated;
  return {count * stiffness,
          count * damping,
          length_of(p),
          tabulated ? p.scale : detail::root_chord_of(p),
          hub_offset_of(p),
          count,
          span_strips(p.shape, p.chord_table)};
}

/// One strip of all wings together.
template <Scalar S>
struct WingStrip {
  S station;  ///< x, distance from the root over the length [1]
  S s2, s3;   ///< its part of the chord moments S_2 [m4] and S_3 [m5]
  PitchChordMoments<S> moments;
};

template <Scalar S>
WingStrip<S> strip_of(const WingTorsion<S>& t, std::size_t k) {
  const S x(t.strips->position[k]);
  const S r = t.hub_offset + x * t.length, c = t.chord * S(t.strips->chord[k]);
  const S width = t.count * t.length * S(t.strips->weight[k]);
  const S area = c * width, c2 = c * area, c3 = c * c2;
  return {x, area * r * r, area * r * r * r, {c2 * r, c2 * r * r, c3, c3 * r, c3 * c}};
}

}  // namespace wingbeat

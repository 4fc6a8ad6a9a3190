// Wing planforms and the chord moments that blade elements need: two of them under the pitch law (model.md section 3,
// eqs 2, 3), those of higher powers of the chord for added mass and for pitch as a degree of freedom (sections 10, 12).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

enum class PlanformShape { semi_ellipse, rectangle, tabulated, moments };
template <>
inline constexpr std::pair<const char*, PlanformShape> names_of<PlanformShape>[] = {
    {"semi-ellipse", PlanformShape::semi_ellipse},
    {"rectangle", PlanformShape::rectangle},
    {"tabulated", PlanformShape::tabulated},
    {"moments", PlanformShape::moments}};

/// One wing's outline. Lengths run from the wing root; the hub offset shifts the root away from the hinge. At the
/// distance x from the root a semi-ellipse has the chord \f$c(x) = c_0 \sqrt{1 - (x/R)^2}\f$, a rectangle \f$c_0\f$.
/// All lengths but the distance between the shoulders are multiplied by the scale, given moments \f$S_{mn}\f$ by its
/// power m + n + 1.
template <Scalar S>
struct Planform {
  PlanformShape shape = PlanformShape::moments;
  S length = S(0);      ///< R, root to tip [m], > 0
  S root_chord = S(0);  ///< c_0 [m], > 0
  S hub_offset = S(0);  ///< hinge to wing root [m], >= 0
  /// Tabulated chord: (distance from the root [m], chord [m]), at least two rows, distances growing; linear between.
  std::vector<std::pair<double, double>> chord_table = {};
  S s2 = S(0);                        ///< moments given outright: S_2 of all wings [m4], >= 0
  S s3 = S(0);                        ///< moments given outright: S_3 of all wings [m5], >= 0
  std::optional<S> chord_ratio = {};  ///< c_0 / R [1], > 0; given, root_chord follows from the length
  std::optional<S> s22 = {};          ///< moments given outright: S_22 of all wings [m5], >= 0
  S shoulder_distance = S(0);         ///< between the hinges of two wings that share a body [m], >= 0
  S scale = S(1);                     ///< s, multiplies lengths and chords [1], > 0

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.shape, self.length, self.root_chord, self.hub_offset, self.chord_table, self.s2, self.s3,
               self.chord_ratio, self.s22, self.shoulder_distance, self.scale);
  }
};

/// Moments of the chord that the pitch law needs, \f$S_2\f$ [m4] and \f$S_3\f$ [m5], r measured from the hinge (eqs
/// 2-4).
/// \f[
/// S_n = N_\mathrm{w} \int c\, r^n\,\mathrm{d}r
/// \f]
template <Scalar S>
struct ChordMoments {
  S s2;
  S s3;
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace planform_key {
inline constexpr ParameterKey length{"wing.planform.length", "m", range::positive};
inline constexpr ParameterKey root_chord{"wing.planform.root_chord", "m", range::positive};
inline constexpr ParameterKey chord_ratio{"wing.planform.chord_ratio", "1", range::positive};
inline constexpr ParameterKey hub_offset{"wing.planform.hub_offset", "m", range::not_negative};
inline constexpr ParameterKey shoulder_distance{"wing.planform.shoulder_distance", "m", range::not_negative};
inline constexpr ParameterKey scale{"wing.planform.scale", "1", range::positive};
inline constexpr ParameterKey s2{"wing.planform.s2", "m4", range::not_negative};
inline constexpr ParameterKey s3{"wing.planform.s3", "m5", range::not_negative};
inline constexpr ParameterKey s22{"wing.planform.s22", "m5", range::not_negative};
}  // namespace planform_key

void validate(const Planform<double>& planform);

namespace detail {

/// Moments about the hinge from moments m_n = integral c x^n dx about the root: r = x + offset, expanded.
template <Scalar S>
ChordMoments<S> shift_moments(const S& m0, const S& m1, const S& m2, const S& m3, const S& d) {
  return {m2 + S(2.0) * d * m1 + d * d * m0, m3 + S(3.0) * d * m2 + S(3.0) * d * d * m1 + d * d * d * m0};
}

/// Calls visit(weight, chord, x) at the points of a quadrature over a tabulated wing, x from the root. Between rows the
/// chord is linear, so that three-point Gauss is exact for what is of fifth degree in chord and distance together.
template <class Visit>
void visit_table(const std::vector<std::pair<double, double>>& table, const Visit& visit) {
  for (std::size_t row = 1; row < table.size(); ++row) {
    const auto [x0, c0] = table[row - 1];
    const auto [x1, c1] = table[row];
    const double half = 0.5 * (x1 - x0), mid = 0.5 * (x0 + x1);
    constexpr double node = 0.77459666924148337704;  // sqrt(3/5)
    for (const auto& [share, weight] : {std::pair{-node, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {node, 5.0 / 9.0}}) {
      const double x = mid + half * share;
      visit(weight * half, c0 + (c1 - c0) * (x - x0) / (x1 - x0), x);
    }
  }
}

/// visit_table() of the scaled outline.
template <Scalar S, class Visit>
void visit_outline(const Planform<S>& p, const Visit& visit) {
  visit_table(p.chord_table, [&](double weight, double chord, double x) {
    visit(S(p.scale * weight), S(p.scale * chord), S(p.scale * x));
  });
}

/// c_0 of the scaled outline [m].
template <Scalar S>
S root_chord_of(const Planform<S>& p) {
  return p.scale * (p.chord_ratio ? S(*p.chord_ratio * p.length) : p.root_chord);
}

}  // namespace detail

/// R of the scaled outline [m], of a planform that has a shape.
template <Scalar S>
S length_of(const Planform<S>& p) {
  return p.scale *
         (p.shape == PlanformShape::tabulated && !p.chord_table.empty() ? S(p.chord_table.back().first) : p.length);
}

/// Distance from the hinge to the root of the scaled outline [m].
template <Scalar S>
S hub_offset_of(const Planform<S>& p) {
  return p.scale * p.hub_offset;
}

namespace detail {

/// Moments m_n = integral c x^n dx of ONE wing about its root, n = 0 to 3; `moments` holds the moments of all wings and
/// is not for this function. Semi-ellipse: c = c_0 sqrt(1 - (x/R)^2).
template <Scalar S>
std::array<S, 4> root_moments(const Planform<S>& p) {
  const S R = length_of(p);
  const S c_0 = detail::root_chord_of(p);
  if (p.shape == PlanformShape::semi_ellipse) {
    return {pi / 4.0 * c_0 * R, c_0 * R * R / 3.0, pi / 16.0 * c_0 * R * R * R, 2.0 / 15.0 * c_0 * R * R * R * R};
  }
  if (p.shape == PlanformShape::rectangle) {
    return {c_0 * R, c_0 * R * R / 2.0, c_0 * R * R * R / 3.0, c_0 * R * R * R * R / 4.0};
  }
  std::array<S, 4> m{S(0.0), S(0.0), S(0.0), S(0.0)};
  detail::visit_outline(p, [&](const S& weight, const S& chord, const S& x) {
    S power = weight * chord;
    for (S& moment : m) {
      moment = moment + power;
      power = power * x;
    }
  });
  return m;
}

}  // namespace detail

/// Chord moments of ONE wing about the hinge; of a planform that has a shape. With the hub offset d and the moments
/// \f$m_n\f$ about the root:
/// \f[
/// \int c\, r^2\,\mathrm{d}r = m_2 + 2 d\, m_1 + d^2 m_0, \qquad
/// \int c\, r^3\,\mathrm{d}r = m_3 + 3 d\, m_2 + 3 d^2 m_1 + d^3 m_0
/// \f]
/// Of a semi-ellipse and of a rectangle these are
/// \f[
/// (m_0, m_1, m_2, m_3) = c_0 \left( \tfrac{\pi}{4} R, \tfrac13 R^2, \tfrac{\pi}{16} R^3, \tfrac{2}{15} R^4 \right),
/// \qquad c_0 \left( R, \tfrac12 R^2, \tfrac13 R^3, \tfrac14 R^4 \right)
/// \f]
template <Scalar S>
ChordMoments<S> one_wing_moments(const Planform<S>& p) {
  const std::array<S, 4> m = detail::root_moments(p);
  return detail::shift_moments<S>(m[0], m[1], m[2], m[3], hub_offset_of(p));
}

/// \f$S_1 = N_\mathrm{w} \int c\, r\,\mathrm{d}r\f$ [m3] of all `count` wings, of a planform that has a shape.
template <Scalar S>
S first_chord_moment(const Planform<S>& p, const S& count) {
  const std::array<S, 4> m = detail::root_moments(p);
  return count * (m[1] + hub_offset_of(p) * m[0]);
}

/// S_2 [m4] and S_3 [m5] of all `count` wings.
template <Scalar S>
ChordMoments<S> chord_moments(const Planform<S>& p, const S& count) {
  if (p.shape == PlanformShape::moments) {
    const S area = square(p.scale), fourth = square(area);
    return {fourth * p.s2, fourth * p.scale * p.s3};
  }
  const ChordMoments<S> one = one_wing_moments(p);
  return {count * one.s2, count * one.s3};
}

/// S_22 [m5] of all `count` wings, which added mass needs (model.md section 10); 0 where moments are given without it.
/// Of semi-ellipse and rectangle with the hub offset d:
/// \f[
/// \begin{aligned}
/// S_{22} = N_\mathrm{w} \int c^2 r^2\,\mathrm{d}r
/// &= N_\mathrm{w} c_0^2 R \left( \tfrac{2}{15} R^2 + \tfrac12 d R + \tfrac23 d^2 \right) && \text{semi-ellipse} \cr
/// &= N_\mathrm{w} c_0^2 R \left( \tfrac13 R^2 + d R + d^2 \right) && \text{rectangle}
/// \end{aligned}
/// \f]
template <Scalar S>
S squared_chord_moment(const Planform<S>& p, const S& count) {
  if (p.shape == PlanformShape::moments) return p.s22 ? S(square(square(p.scale)) * p.scale * *p.s22) : S(0.0);
  const S R = length_of(p), d = hub_offset_of(p);
  const S c2 = square(detail::root_chord_of(p));
  // Moments of c^2 about the root, shifted to the hinge: q_2 + 2 d q_1 + d^2 q_0.
  if (p.shape == PlanformShape::semi_ellipse) {
    return count * c2 * R * (S(2.0 / 15.0) * R * R + S(0.5) * d * R + S(2.0 / 3.0) * d * d);
  }
  if (p.shape == PlanformShape::rectangle) return count * c2 * R * (R * R / 3.0 + d * R + d * d);
  S sum(0.0);
  detail::visit_outline(
      p, [&](const S& weight, const S& chord, const S& x) { sum = sum + weight * chord * chord * square(S(x + d)); });
  return count * sum;
}

/// Chord [m] at this part of the length from the root, of a planform that has a shape.
template <Scalar S>
S chord_at(const Planform<S>& p, double part) {
  if (p.shape == PlanformShape::semi_ellipse) return detail::root_chord_of(p) * S(std::sqrt(1.0 - part * part));
  if (p.shape == PlanformShape::rectangle) return detail::root_chord_of(p);
  const auto& rows = p.chord_table;
  const double x = part * rows.back().first;
  const auto next =
      std::lower_bound(rows.begin() + 1, rows.end() - 1, x,
                       [](const std::pair<double, double>& row, double station) { return row.first < station; });
  const auto [x0, c0] = *(next - 1);
  return p.scale * (c0 + (next->second - c0) * (x - x0) / (next->first - x0));
}

/// Area of one wing [m2], of a planform that has a shape: \f$\int c\,\mathrm{d}x\f$, of a semi-ellipse
/// \f$\tfrac{\pi}{4} c_0 R\f$, of a rectangle \f$c_0 R\f$.
template <Scalar S>
S wing_area(const Planform<S>& p) {
  if (p.shape == PlanformShape::tabulated) {
    S area(0.0);
    detail::visit_outline(p, [&](const S& weight, const S& chord, const S&) { area = area + weight * chord; });
    return area;
  }
  const S rectangle = detail::root_chord_of(p) * length_of(p);
  return p.shape == PlanformShape::semi_ellipse ? S(S(0.25 * pi) * rectangle) : rectangle;
}

/// \f$\int c^2\,\mathrm{d}r\f$ [m3] of one wing, of a planform that has a shape: of a semi-ellipse
/// \f$\tfrac23 c_0^2 R\f$, of a rectangle \f$c_0^2 R\f$.
template <Scalar S>
S chord_square(const Planform<S>& p) {
  if (p.shape == PlanformShape::tabulated) {
    S sum(0.0);
    detail::visit_outline(p, [&](const S& weight, const S& chord, const S&) { sum = sum + weight * square(chord); });
    return sum;
  }
  const S rectangle = square(detail::root_chord_of(p)) * length_of(p);
  return p.shape == PlanformShape::semi_ellipse ? S(S(2.0 / 3.0) * rectangle) : rectangle;
}

/// Moments of higher powers of the chord, r measured from the hinge: what pitch as a degree of freedom needs (model.md
/// section 12).
/// \f[
/// S_{mn} = N_\mathrm{w} \int c^m r^n\,\mathrm{d}r
/// \f]
template <Scalar S>
struct PitchChordMoments {
  S s21 = S(0);  ///< [m4], >= 0
  S s22 = S(0);  ///< [m5], >= 0
  S s30 = S(0);  ///< [m4], >= 0
  S s31 = S(0);  ///< [m5], >= 0
  S s40 = S(0);  ///< [m5], >= 0

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.s21, self.s22, self.s30, self.s31, self.s40);
  }
};

/// Chord moments of all `count` wings for pitch, of a planform that has a shape. Of a semi-ellipse with the hub offset
/// d:
/// \f[
/// \begin{aligned}
/// S_{21} &= N_\mathrm{w} c_0^2 R \left( \tfrac14 R + \tfrac23 d \right), &
/// S_{30} &= \tfrac{3 \pi}{16} N_\mathrm{w} c_0^3 R, \cr
/// S_{31} &= N_\mathrm{w} c_0^3 R \left( \tfrac15 R + \tfrac{3 \pi}{16} d \right), &
/// S_{40} &= \tfrac{8}{15} N_\mathrm{w} c_0^4 R
/// \end{aligned}
/// \f]
template <Scalar S>
PitchChordMoments<S> pitch_chord_moments(const Planform<S>& p, const S& count) {
  const S R = length_of(p), d = hub_offset_of(p);
  PitchChordMoments<S> moments;
  moments.s22 = squared_chord_moment(p, count);
  if (p.shape == PlanformShape::tabulated) {
    detail::visit_outline(p, [&](const S& weight, const S& chord, const S& x) {
      const S c2 = weight * chord * chord, c3 = c2 * chord;
      moments.s21 = moments.s21 + c2 * (x + d);
      moments.s30 = moments.s30 + c3;
      moments.s31 = moments.s31 + c3 * (x + d);
      moments.s40 = moments.s40 + c3 * chord;
    });
  } else {
    const S c = detail::root_chord_of(p), c2 = c * c, c3 = c2 * c;
    const bool elliptic = p.shape == PlanformShape::semi_ellipse;
    moments.s21 = c2 * R * (elliptic ? S(0.25 * R + 2.0 / 3.0 * d) : S(0.5 * R + d));
    moments.s30 = c3 * R * S(elliptic ? 3.0 / 16.0 * pi : 1.0);
    moments.s31 = c3 * R * (elliptic ? S(0.2 * R + 3.0 / 16.0 * pi * d) : S(0.5 * R + d));
    moments.s40 = c3 * c * R * S(elliptic ? 8.0 / 15.0 : 1.0);
  }
  moments.s21 = count * moments.s21;
  moments.s30 = count * moments.s30;
  moments.s31 = count * moments.s31;
  moments.s40 = count * moments.s40;
  return moments;
}

}  // namespace wingbeat

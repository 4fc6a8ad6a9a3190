// Any transmission by its measured or computed stroke law beta(theta): a table; docs/model.md section 8.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/members.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/transmission.hpp"

namespace wingbeat {

/// Stroke angle against crank angle over a turn as a periodic spline of degree five with four continuous derivatives. A
/// cubic one would do for the kinematics, but its third derivative jumps at the rows, where the rod force, which holds
/// the second, would then have corners. From a row at \f$\theta_0\f$ to the next:
/// \f[
/// \beta_\mathrm{table}(\theta) = \sum_{k=0}^{5} c_k (\theta - \theta_0)^k
/// \f]
class StrokeCurve {
 public:
  /// Rows (crank angle, stroke angle) [rad], crank angles strictly growing within less than 2 pi; at least four. Throws
  /// ParameterError naming the row.
  explicit StrokeCurve(std::vector<std::pair<double, double>> rows);

  struct Piece {
    double x0;                          ///< where it begins, as position()
    std::array<double, 6> coefficient;  ///< of 1, t ... t^5 [rad], t = position - x0
  };
  /// A crank angle [rad] of any turn, counted from the first row: 0 to 2 pi.
  double position(double theta) const { return wrap_angle(theta - rows_.front().first); }
  [[gnu::pure]] const Piece& piece(double position) const;
  /// Where a piece ends, as position().
  double end_of(const Piece& piece) const { return &piece == &pieces_.back() ? two_pi : (&piece + 1)->x0; }

  const std::vector<std::pair<double, double>>& rows() const { return rows_; }
  double high() const { return high_; }  ///< [rad]
  double low() const { return low_; }    ///< [rad]
  /// Where the stroke velocity changes sign.
  const Reversals& reversals() const { return reversals_; }

 private:
  std::vector<std::pair<double, double>> rows_;
  std::vector<Piece> pieces_;
  double high_ = 0.0, low_ = 0.0;
  Reversals reversals_;
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace stroke_table_key {
inline constexpr ParameterKey scale{"transmission.stroke_scale", "1", range::positive};
inline constexpr ParameterKey reference_radius{"transmission.reference_radius", "m", range::positive};
}  // namespace stroke_table_key

/// What SIMD lanes, which read no tables by themselves, know of their designs' curves.
template <Scalar S>
struct LaneCurves {
  const StrokeCurve* of_lane[std::size_t(ScalarTraits<S>::lanes)];
  S start;      ///< crank angle of the first row [rad]
  S amplitude;  ///< half the peak-to-peak stroke angle [rad]

  LaneCurves(std::nullptr_t = nullptr) {}  // NOLINT: of lanes without
};

/// A curve times a scale \f$s\f$. Friction acts on the reaction to the wings' moment at the radius r_ref, with levers
/// that conserve power (model.md section 8).
/// \f[
/// \beta = s\, \beta_\mathrm{table}(\theta), \qquad g = r_\mathrm{ref}, \qquad h = r_\mathrm{ref} B_1
/// \f]
template <Scalar S>
struct StrokeTable {
  using Curve = std::conditional_t<ScalarTraits<S>::reads_tables, std::shared_ptr<const StrokeCurve>, LaneCurves<S>>;

  Curve curve = nullptr;
  S scale = S(1);             ///< multiplies the table's stroke angles [1], > 0
  S reference_radius = S(0);  ///< r_ref [m], > 0

  static constexpr std::string_view keys[] = {stroke_table_key::scale.path, stroke_table_key::reference_radius.path};
  /// From a TransmissionDesign.
  template <class Design>
  static StrokeTable from(const Design& d) {
    return d.table;
  }

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.curve, self.scale, self.reference_radius);
  }
};

void validate(const StrokeTable<double>& t);

/// Kinematics at a crank angle given by its sine and cosine. Lanes take kinematics_at_angle().
template <Scalar S>
CrankKinematics<S> crank_kinematics(const StrokeTable<S>& t, const S& sin_theta, const S& cos_theta) {
  CrankKinematics<S> k{S(0.0), S(0.0), S(0.0), S(0.0), t.reference_radius, S(0.0)};
  if constexpr (ScalarTraits<S>::reads_tables) {
    const double s = value_of(sin_theta), c = value_of(cos_theta);
    const double position = t.curve->position(std::atan2(s, c));
    const StrokeCurve::Piece& p = t.curve->piece(position);
    // The first derivative of the angle is that of its sine and cosine.
    const S x = S(position - p.x0) + (sin_theta - S(s)) * S(c) - (cos_theta - S(c)) * S(s);
    S beta(p.coefficient[5]), slope(0.0), half_curve(0.0);  // by Horner's scheme
    for (std::size_t n = 5; n-- > 0;) {
      half_curve = half_curve * x + slope;
      slope = slope * x + beta;
      beta = beta * x + S(p.coefficient[n]);
    }
    k.stroke_offset = t.scale * beta;
    k.stroke_slope = t.scale * slope;
    k.stroke_second_derivative = t.scale * S(2.0) * half_curve;
    k.crank_jacobian = t.reference_radius * k.stroke_slope;
  }
  return k;
}

/// Kinematics of lanes' curves, each on its own piece, at a crank angle [rad].
template <Scalar S>
CrankKinematics<S> kinematics_at_angle(const StrokeTable<S>& t, const S& theta)
  requires(!ScalarTraits<S>::reads_tables)
{
  constexpr std::size_t lanes = std::size_t(ScalarTraits<S>::lanes);
  alignas(64) double position[lanes], coefficient[6][lanes];
  const S from_start = theta - t.curve.start;
  S(from_start - S(two_pi) * nearest_whole(S(from_start * S(1.0 / two_pi) - S(0.5)))).store(position);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const StrokeCurve::Piece& p = t.curve.of_lane[lane]->piece(position[lane]);
    position[lane] -= p.x0;
    for (std::size_t n = 0; n < 6; ++n) coefficient[n][lane] = p.coefficient[n];
  }
  const S x = S::load(position);
  S beta = S::load(coefficient[5]), slope(0.0), half_curve(0.0);  // by Horner's scheme
  for (int n = 4; n >= 0; --n) {
    half_curve = half_curve * x + slope;
    slope = slope * x + beta;
    beta = beta * x + S::load(coefficient[n]);
  }
  const S B_1 = t.scale * slope;
  return {t.scale * beta, S(0.0), B_1, t.scale * S(2.0) * half_curve, t.reference_radius, t.reference_radius * B_1};
}

inline Reversals reversals(const StrokeTable<double>& t) { return t.curve->reversals(); }

/// Half the peak-to-peak stroke angle [rad].
template <Scalar S>
S stroke_amplitude(const StrokeTable<S>& t) {
  if constexpr (ScalarTraits<S>::reads_tables) return S(0.5) * t.scale * S(t.curve->high() - t.curve->low());
  else return t.scale * t.curve.amplitude;
}

/// Largest stroke angle to either side [rad].
inline double stroke_reach(const StrokeTable<double>& t) {
  return t.scale * std::fmax(std::abs(t.curve->high()), std::abs(t.curve->low()));
}

/// The amplitude: d beta / d theta of a sine of that amplitude [1].
template <Scalar S>
S typical_stroke_slope(const StrokeTable<S>& t) {
  return stroke_amplitude(t);
}
template <Scalar S>
S typical_lever(const StrokeTable<S>& t) {
  return t.reference_radius;
}
template <Scalar S>
S typical_crank_lever(const StrokeTable<S>& t) {
  return t.reference_radius * stroke_amplitude(t);
}

}  // namespace wingbeat

// Wings in the air that they have set in motion downwards: the induced velocity of an actuator disc over the swept
// area, one number for the cycle; model.md section 17.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/planform.hpp"
#include "wingbeat/parts/tip_loss.hpp"

namespace wingbeat {

/// A strip of all wings together.
template <Scalar S>
struct WakeStrip {
  S radius = S(0);  ///< r from the hinge [m]
  S area = S(0);    ///< c dr of all wings [m2]
  S chord = S(0);   ///< c [m]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.radius, self.area, self.chord);
  }
};

inline constexpr std::size_t wake_strip_count = 16;

/// The strips that lift, nodes of a quadrature along the span.
template <Scalar S>
struct WakeStrips {
  static constexpr bool off_lanes = true;  ///< no numbers of a vehicle on lanes, which point to them
  std::array<WakeStrip<S>, wake_strip_count> at;

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    auto& a = self.at;
    return use(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11], a[12], a[13], a[14], a[15]);
  }
};

template <Scalar S>
struct InducedVelocity {
  S velocity = S(0);    ///< v_i, downwards [m/s], >= 0: that of the cycle, which is found around the orbit
  S share = S(0);       ///< \f$\kappa\f$ of the momentum theory's that counts [1], 0 to 1
  S sector = S(0);      ///< swept area over the stroke amplitude, \f$N_\mathrm{w} (R + d)^2\f$ [m2/rad]
  S swept_area = S(0);  ///< A_0 where it is stated [m2]; else 0
  /// On lanes those of the block, where any has a wake.
  std::conditional_t<ScalarTraits<S>::reads_tables, WakeStrips<S>, const WakeStrips<S>*> strips{};

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.velocity, self.share, self.sector, self.swept_area, self.strips);
  }
};

template <Scalar S>
const WakeStrips<S>& strips_of(const InducedVelocity<S>& w) {
  if constexpr (ScalarTraits<S>::reads_tables) return w.strips;
  else return *w.strips;
}

/// Keys, units and ranges; the table of parameters has them from here.
namespace induced_velocity_key {
inline constexpr ParameterKey share{"aerodynamics.induced_velocity", "1", range::zero_to_one};
inline constexpr ParameterKey swept_area{"aerodynamics.swept_area", "m2", range::positive};
}  // namespace induced_velocity_key

template <Scalar S>
bool has_induced_velocity(const InducedVelocity<S>& w) {
  return value_of(w.share) > 0.0;
}

/// v_i [m/s] of a mean lift L [N] and a stroke amplitude [rad] in air of that density [kg/m3]; 0 of a lift that is not
/// upwards. Each wing sweeps a sector of twice the stroke amplitude.
/// \f[
/// v_\mathrm{i} = \kappa \sqrt{\frac{L}{2 \rho A_0}}, \qquad A_0 = N_\mathrm{w} \hat\beta (R + d)^2
/// \f]
template <Scalar S>
S induced_velocity_of(const InducedVelocity<S>& w, const S& air_density, const S& lift, const S& stroke_amplitude) {
  using std::sqrt;
  const S area = select<S>(w.swept_area > S(0.0), w.swept_area, S(w.sector * stroke_amplitude));
  const auto rises = lift > S(0.0);
  const S root = sqrt(S(select<S>(rises, lift, S(1e-300)) / (S(2.0) * air_density * area)));
  return select<S>(rises, S(w.share * root), S(0.0));
}

/// The air at a strip: the speed of the wing against it, and by how much the angle of attack falls.
/// \f[
/// U^2 = (r \dot\beta)^2 + v_\mathrm{i}^2, \qquad \varphi = \arctan\frac{v_\mathrm{i}}{r |\dot\beta|}
/// \f]
template <Scalar S>
struct StripFlow {
  S square_of_speed;  ///< U^2 [m2/s2]
  S inflow_angle;     ///< phi [rad], 0 to pi/2
  S cosine, sine;     ///< of phi; 0 where there is no flow
};
template <Scalar S>
StripFlow<S> strip_flow(const S& induced_velocity, const WakeStrip<S>& strip, const S& stroke_speed) {
  using std::atan;
  using std::sqrt;
  const S u = strip.radius * stroke_speed;
  // Of lanes some may have no induced velocity.
  const S v = induced_velocity + S(1e-300);
  const S square_of_speed = square(u) + square(induced_velocity);
  const S per_speed = S(1.0) / sqrt(S(square_of_speed + S(1e-300)));
  return {square_of_speed, S(0.5 * pi) - atan(S(u / v)), u * per_speed, induced_velocity * per_speed};
}

namespace detail {

/// Of a tabulated outline, of which this lists distances from the root and chords: nodes of Gauss's rule for the chord
/// as the weight, in the variable \f$\sqrt{x}\f$. Radius from the root, area of one wing.
std::array<WakeStrip<double>, wake_strip_count> tabulated_strips(const std::vector<std::pair<double, double>>& rows);

}  // namespace detail

/// Strips of `count` wings of an outline that has a shape, from the root to the part `to` of its length; of a tabulated
/// one, to the tip. They are closer to each other towards the root, where the inflow angle varies most.
template <Scalar S>
WakeStrips<S> wake_strips(const Planform<S>& p, const S& count, const S& to) {
  using std::asin;
  using std::cos;
  using std::sin;
  WakeStrips<S> strips;
  const S d = hub_offset_of(p);
  std::size_t n = 0;
  if (p.shape == PlanformShape::tabulated) {
    for (const WakeStrip<double>& one : detail::tabulated_strips(p.chord_table)) {
      strips.at[n++] = {d + p.scale * S(one.radius), count * square(p.scale) * S(one.area), p.scale * S(one.chord)};
    }
    return strips;
  }
  const S R = length_of(p), c_0 = detail::root_chord_of(p);
  const bool elliptic = p.shape == PlanformShape::semi_ellipse;
  // x = R sin(t) of a semi-ellipse, whose chord is c_0 cos(t) there.
  // At the tip itself the angle's slope is infinite, and the chord 0.
  const bool whole = value_of(to) >= 1.0;
  const S end = !elliptic ? to : whole ? S(0.5 * pi) : S(asin(to));
  detail::visit_gauss_16([&](double node, double weight) {
    const S t = end * S(node * node), dt = end * S(2.0 * node * weight);
    if (elliptic) {
      const S chord = c_0 * cos(t);
      strips.at[n++] = {d + R * sin(t), count * chord * R * cos(t) * dt, chord};
    } else {
      strips.at[n++] = {d + R * t, count * c_0 * R * dt, c_0};
    }
  });
  return strips;
}

}  // namespace wingbeat

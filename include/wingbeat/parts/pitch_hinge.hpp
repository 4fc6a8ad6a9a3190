// Elastic hinge along the leading edge, about which a wing pitches; model.md section 12.
#pragma once

#include <cmath>
#include <utility>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

/// Where the force of translation acts, over the chord.
enum class CentreOfPressure {
  fourier,  ///< Whitney and Wood, J. Fluid Mech. 660, 2010
  chen      ///< Chen and others, IROS 2016
};
template <>
inline constexpr std::pair<const char*, CentreOfPressure> names_of<CentreOfPressure>[] = {
    {"whitney-2010", CentreOfPressure::fourier}, {"chen-2016", CentreOfPressure::chen}};

/// At rest at pitch angle psi = 0, where the chord is normal to the stroke plane. psi is positive where the trailing
/// edge is ahead in the direction of a positive stroke velocity.
template <Scalar S>
struct PitchHinge {
  S stiffness = S(0);  ///< k_psi [N m/rad], >= 0
  S damping = S(0);    ///< c_psi [N m s/rad], >= 0
  /// psi goes no lower and no higher [rad], -pi < stop_low < 0 < stop_high < pi; infinite where there are no stops, 0
  /// where there is no hinge
  S stop_low = S(-infinity), stop_high = S(infinity);
  S friction = S(0);  ///< T_psi, constant friction of the joint [N m], >= 0

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.stiffness, self.damping, self.stop_low, self.stop_high, self.friction);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace pitch_key {
inline constexpr ParameterKey stiffness{"pitch.stiffness", "N m/rad", range::not_negative};
inline constexpr ParameterKey damping{"pitch.damping", "N m s/rad", range::not_negative};
inline constexpr ParameterKey stop{"pitch.stop", "rad", range::below_straight};
inline constexpr ParameterKey stop_low{"pitch.stop_low", "rad", range::above_minus_straight};
inline constexpr ParameterKey stop_high{"pitch.stop_high", "rad", range::below_straight};
inline constexpr ParameterKey friction{"pitch.friction", "N m", range::not_negative};
}  // namespace pitch_key

inline void validate(const PitchHinge<double>& h) {
  require(pitch_key::stiffness, h.stiffness);
  require(pitch_key::damping, h.damping);
  const bool alike = h.stop_low == -h.stop_high;
  const ParameterKey& high = alike ? pitch_key::stop : pitch_key::stop_high;
  if (h.stop_high != infinity && h.stop_high != 0.0) require(high, h.stop_high);
  if (!alike) require(pitch_key::stop_low, h.stop_low);
  require(pitch_key::friction, h.friction);
}

/// True where there is no hinge: what is left of the pitch is torsion.
template <Scalar S>
bool is_clamped(const PitchHinge<S>& h) {
  return value_of(h.stop_high) == 0.0;
}
template <Scalar S>
bool has_stop(const PitchHinge<S>& h) {
  return std::isfinite(value_of(h.stop_high)) && !is_clamped(h);
}
template <Scalar S>
void set_stops(PitchHinge<S>& h, const S& to_either_side) {
  h.stop_low = -to_either_side;
  h.stop_high = to_either_side;
}
/// Which stop is nearer at a pitch angle: -1 or +1.
template <Scalar S>
double side_of_stop(const PitchHinge<S>& h, const S& psi) {
  const double middle = has_stop(h) ? 0.5 * (value_of(h.stop_low) + value_of(h.stop_high)) : 0.0;
  return value_of(psi) >= middle ? 1.0 : -1.0;
}
/// The pitch angle of that stop [rad].
template <Scalar S>
S nearer_stop(const PitchHinge<S>& h, const S& psi) {
  return side_of_stop(h, psi) > 0.0 ? h.stop_high : h.stop_low;
}
/// How far wings may pitch to the side of the farther stop, and to that of the closer one [rad], > 0.
template <Scalar S>
S farther_stop(const PitchHinge<S>& h) {
  return value_of(h.stop_high) >= -value_of(h.stop_low) ? h.stop_high : S(-h.stop_low);
}
template <Scalar S>
S closer_stop(const PitchHinge<S>& h) {
  return value_of(h.stop_high) <= -value_of(h.stop_low) ? h.stop_high : S(-h.stop_low);
}
template <Scalar S>
bool has_friction(const PitchHinge<S>& h) {
  return value_of(h.friction) > 0.0;
}
template <Scalar S>
bool is_at_stop(const PitchHinge<S>& h, const S& psi) {
  const double side = side_of_stop(h, psi);
  return has_stop(h) && side * value_of(psi) >= side * value_of(nearer_stop(h, psi)) * (1.0 - 1e-9);
}

/// Positive while wings at rest stay so [N m], `moment` M being what presses them towards a positive psi: between
/// \f$\pm T_\psi\f$, at a stop while they do not leave it. To which side they leave: leaving_side().
template <Scalar S>
S holding_margin(const PitchHinge<S>& h, const S& psi, const S& moment) {
  using std::abs;
  if (!is_at_stop(h, psi)) return h.friction - abs(moment);
  return h.friction + (value_of(psi) > 0.0 ? S(moment) : S(-moment));
}
template <Scalar S>
S leaving_side(const PitchHinge<S>& h, const S& psi, const S& moment) {
  return is_at_stop(h, psi) ? S(-sign_of(psi)) : sign_of(moment);
}

/// The hinges of `count` wings as one, of stiffness \f$N_\mathrm{w} k_\psi\f$, damping \f$N_\mathrm{w} c_\psi\f$ and
/// friction \f$N_\mathrm{w} T_\psi\f$.
template <Scalar S>
PitchHinge<S> hinges_together(const PitchHinge<S>& one, const S& count) {
  return {count * one.stiffness, count * one.damping, one.stop_low, one.stop_high, count * one.friction};
}

template <Scalar S>
struct PitchHingeLoads {
  S moment;  ///< [N m], opposes a positive psi
  S energy;  ///< [J]
  S loss;    ///< [W]
};

/// The loads at pitch angle psi [rad] and its velocity psi' [rad/s], without the reaction of a stop: moment, elastic
/// energy and loss (model.md section 12). `turn` is the sign of psi', 0 of wings that are held.
/// \f[
/// M_\mathrm{h} = k_\psi \psi + c_\psi \dot\psi + T_\psi \operatorname{sign}\dot\psi, \qquad
/// E_\mathrm{h} = \tfrac12 k_\psi \psi^2, \qquad P_\mathrm{h} = c_\psi \dot\psi^2 + T_\psi |\dot\psi|
/// \f]
template <Scalar S>
PitchHingeLoads<S> hinge_loads(const PitchHinge<S>& h, const S& psi, const S& velocity, const S& turn = S(0.0)) {
  const S friction = h.friction * turn;
  return {h.stiffness * psi + h.damping * velocity + friction, S(0.5) * h.stiffness * square(psi),
          h.damping * square(velocity) + friction * velocity};
}

}  // namespace wingbeat

// Elastic hinge along the leading edge, about which a wing pitches; model.md section 12.
#pragma once

#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

/// At rest at pitch angle psi = 0, where the chord is normal to the stroke plane. psi is positive where the trailing
/// edge is ahead in the direction of a positive stroke velocity.
template <Scalar S>
struct PitchHinge {
  S stiffness = S(0);    ///< k_psi [N m/rad], >= 0
  S damping = S(0);      ///< c_psi [N m s/rad], >= 0
  S stop = S(infinity);  ///< psi_max: |psi| goes no further [rad], > 0, < pi; infinite where there is no stop

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.stiffness, self.damping, self.stop);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace pitch_key {
inline constexpr ParameterKey stiffness{"pitch.stiffness", "N m/rad", range::not_negative};
inline constexpr ParameterKey damping{"pitch.damping", "N m s/rad", range::not_negative};
inline constexpr ParameterKey stop{"pitch.stop", "rad", range::below_straight};
}  // namespace pitch_key

inline void validate(const PitchHinge<double>& h) {
  require(pitch_key::stiffness, h.stiffness);
  require(pitch_key::damping, h.damping);
  if (h.stop != infinity) require(pitch_key::stop, h.stop);
}

template <Scalar S>
bool has_stop(const PitchHinge<S>& h) {
  return std::isfinite(value_of(h.stop));
}

/// The hinges of `count` wings as one, of stiffness \f$N_\mathrm{w} k_\psi\f$ and damping \f$N_\mathrm{w} c_\psi\f$.
template <Scalar S>
PitchHinge<S> hinges_together(const PitchHinge<S>& one, const S& count) {
  return {count * one.stiffness, count * one.damping, one.stop};
}

template <Scalar S>
struct PitchHingeLoads {
  S moment;  ///< [N m], opposes a positive psi
  S energy;  ///< [J]
  S loss;    ///< [W]
};

/// The loads at pitch angle psi [rad] and its velocity psi' [rad/s], without the reaction of a stop: moment, elastic
/// energy and loss (model.md section 12).
/// \f[
/// M_\mathrm{h} = k_\psi \psi + c_\psi \dot\psi, \qquad E_\mathrm{h} = \tfrac12 k_\psi \psi^2, \qquad
/// P_\mathrm{h} = c_\psi \dot\psi^2
/// \f]
template <Scalar S>
PitchHingeLoads<S> hinge_loads(const PitchHinge<S>& h, const S& psi, const S& velocity) {
  return {h.stiffness * psi + h.damping * velocity, S(0.5) * h.stiffness * square(psi), h.damping * square(velocity)};
}

}  // namespace wingbeat

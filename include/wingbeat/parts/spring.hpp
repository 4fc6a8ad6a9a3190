// Torsional spring at each wing hinge; model.md eqs (21, 22).
#pragma once

#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

template <Scalar S>
struct HingeSpring {
  S stiffness = S(0);   ///< k of ONE hinge spring [N m/rad], >= 0
  S rest_angle = S(0);  ///< \f$\beta_0\f$, stroke angle at which it is at rest [rad]; 0 of a crank's

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.stiffness, self.rest_angle);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace spring_key {
inline constexpr ParameterKey stiffness{"spring.stiffness", "N m/rad", range::not_negative};
inline constexpr ParameterKey rest_angle{"spring.rest_angle", "rad", range::within_right_angle};
}  // namespace spring_key

inline void validate(const HingeSpring<double>& s) {
  require(spring_key::stiffness, s.stiffness);
  require(spring_key::rest_angle, s.rest_angle);
}

template <Scalar S>
struct SpringLoads {
  S moment;  ///< [N m], returns the wing to the rest angle
  S energy;  ///< [J]
};

/// Moment and energy of ONE hinge spring at the stroke angle \f$\beta\f$ [rad] (eq 21):
/// \f[
/// M_\mathrm{s} = k (\beta - \beta_0), \qquad E_\mathrm{s} = \tfrac12 k (\beta - \beta_0)^2
/// \f]
template <Scalar S>
SpringLoads<S> spring_loads(const HingeSpring<S>& s, const S& beta) {
  const S bent = beta - s.rest_angle;
  return {s.stiffness * bent, S(0.5) * s.stiffness * square(bent)};
}

/// Stiffness k [N m/rad] that makes a wing of inertia J_w [kg m2] resonate at f_s [Hz] (eq 22). A direct drive swings
/// its rotor too: there the inertia on one spring is \f$J/N_\mathrm{w} + J_\mathrm{w}\f$.
/// \f[
/// k = J_\mathrm{w} (2 \pi f_\mathrm{s})^2
/// \f]
template <Scalar S>
S stiffness_for_resonance(const S& wing_inertia, const S& resonance) {
  return wing_inertia * square(S(two_pi) * resonance);
}

/// The frequency [Hz] at which an inertia [kg m2] resonates on a spring [N m/rad]: eq (22) solved for it.
/// \f[
/// f_\mathrm{s} = \frac{1}{2 \pi} \sqrt{k / J_\mathrm{w}}
/// \f]
template <Scalar S>
S resonance_of(const S& inertia, const S& stiffness) {
  using std::sqrt;
  return sqrt(stiffness / inertia) / S(two_pi);
}

}  // namespace wingbeat

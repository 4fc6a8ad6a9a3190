// Torsional spring at each wing hinge, at rest at stroke angle zero; model.md eqs (21, 22).
#pragma once

#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

template <Scalar S>
struct HingeSpring {
  S stiffness = S(0);  ///< k of ONE hinge spring [N m/rad], >= 0

  template <class Self, class Use>
  static constexpr auto members(Self& of, const Use& use) {
    return use(of.stiffness);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace spring_key {
inline constexpr ParameterKey stiffness{"spring.stiffness", "N m/rad", range::not_negative};
}  // namespace spring_key

inline void validate(const HingeSpring<double>& s) { require(spring_key::stiffness, s.stiffness); }

template <Scalar S>
struct SpringLoads {
  S moment;  ///< k beta [N m], returns the wing to stroke angle zero
  S energy;  ///< k beta^2 / 2 [J]
};

template <Scalar S>
SpringLoads<S> spring_loads(const HingeSpring<S>& s, const S& beta) {
  return {s.stiffness * beta, S(0.5) * s.stiffness * square(beta)};
}

/// Stiffness k = J_w (2 pi f_s)^2 [N m/rad] that makes a wing of inertia J_w [kg m2] resonate at f_s [Hz] (eq 22). A
/// direct drive swings its rotor too: there the inertia on one spring is J/N_w + J_w.
template <Scalar S>
S stiffness_for_resonance(const S& wing_inertia, const S& resonance) {
  return wing_inertia * square(S(two_pi) * resonance);
}

/// The frequency [Hz] at which an inertia [kg m2] resonates on a spring [N m/rad].
template <Scalar S>
S resonance_of(const S& inertia, const S& stiffness) {
  using std::sqrt;
  return sqrt(stiffness / inertia) / S(two_pi);
}

}  // namespace wingbeat

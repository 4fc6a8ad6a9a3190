// Friction of the transmission as a torque on the crank that opposes rotation; model.md section 2, eq (6).
#pragma once

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

enum class FrictionLaw { none, load_proportional, viscous, quadratic, constant };
template <>
inline constexpr std::pair<const char*, FrictionLaw> names_of<FrictionLaw>[] = {
    {"none", FrictionLaw::none},
    {"load-proportional", FrictionLaw::load_proportional},
    {"viscous", FrictionLaw::viscous},
    {"quadratic", FrictionLaw::quadratic},
    {"constant", FrictionLaw::constant}};

/// All laws side by side, the unused coefficients zero: a batch may mix laws, and a sum of laws is legal.
template <Scalar S>
struct Friction {
  S radius = S(0);     ///< mu r_e: T_f = mu r_e |F| sign(omega), load-proportional [m], >= 0
  S damping = S(0);    ///< b_f: T_f = b_f omega [N m s/rad], >= 0
  S quadratic = S(0);  ///< c_f: T_f = c_f omega |omega| [N m s2/rad2], >= 0
  S torque = S(0);     ///< T_c: T_f = T_c sign(omega) [N m], >= 0

  template <class Self, class Use>
  static constexpr auto members(Self& of, const Use& use) {
    return use(of.radius, of.damping, of.quadratic, of.torque);
  }
};

inline void validate(const Friction<double>& f) {
  require(f.radius >= 0.0, "friction.radius", "must be >= 0", "m", f.radius);
  require(f.damping >= 0.0, "friction.damping", "must be >= 0", "N m s/rad", f.damping);
  require(f.quadratic >= 0.0, "friction.coefficient", "must be >= 0", "N m s2/rad2", f.quadratic);
  require(f.torque >= 0.0, "friction.torque", "must be >= 0", "N m", f.torque);
}

/// The part of the friction torque [N m] that does not depend on the rod force, at crank speed omega turning in
/// `direction` (+-1).
template <Scalar S>
S load_free_friction(const Friction<S>& f, const S& omega, const S& direction) {
  return direction * f.torque + f.damping * omega + direction * f.quadratic * square(omega);
}

/// The load-proportional part of the friction torque, mu r_e |F| sign(omega) [N m] (eq 6).
template <Scalar S>
S load_friction(const Friction<S>& f, const S& rod_force_magnitude, const S& direction) {
  return direction * f.radius * rod_force_magnitude;
}

}  // namespace wingbeat

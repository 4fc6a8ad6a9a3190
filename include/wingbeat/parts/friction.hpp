// Friction of the transmission as a torque on the crank that opposes rotation; model.md section 2, eq (6).
#pragma once

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/names.hpp"
#include "wingbeat/core/range.hpp"
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

/// Keys, units and ranges; the table of parameters has them from here.
namespace friction_key {
inline constexpr ParameterKey radius{"friction.radius", "m", range::not_negative};
inline constexpr ParameterKey damping{"friction.damping", "N m s/rad", range::not_negative};
inline constexpr ParameterKey quadratic{"friction.coefficient", "N m s2/rad2", range::not_negative};
inline constexpr ParameterKey torque{"friction.torque", "N m", range::not_negative};
}  // namespace friction_key

inline void validate(const Friction<double>& f) {
  require(friction_key::radius, f.radius);
  require(friction_key::damping, f.damping);
  require(friction_key::quadratic, f.quadratic);
  require(friction_key::torque, f.torque);
}

/// The friction of `count` equal transmissions that move in phase, against their common speed: what follows the load
/// follows the sum of their rod forces.
template <Scalar S>
Friction<S> side_by_side(const Friction<S>& f, const S& count) {
  return {f.radius, f.damping * count, f.quadratic * count, f.torque * count};
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

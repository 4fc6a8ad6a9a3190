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

/// All laws side by side, the unused coefficients zero: a batch may mix laws, and a sum of laws is legal. The torque of
/// the mechanism's friction on the crank opposes rotation, F being the rod force [N] (eq 6; model.md section 2):
/// \f[
/// T_\mathrm{f} = \left( \mu r_\mathrm{e} |F| + T_\mathrm{c} \right) \operatorname{sign}\omega + b_\mathrm{f}\, \omega
/// + c_\mathrm{f}\, \omega |\omega|
/// \f]
template <Scalar S>
struct Friction {
  S radius = S(0);     ///< \f$\mu r_\mathrm{e}\f$, load-proportional [m], >= 0
  S damping = S(0);    ///< \f$b_\mathrm{f}\f$, viscous [N m s/rad], >= 0
  S quadratic = S(0);  ///< \f$c_\mathrm{f}\f$ [N m s2/rad2], >= 0
  S torque = S(0);     ///< \f$T_\mathrm{c}\f$, constant [N m], >= 0

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.radius, self.damping, self.quadratic, self.torque);
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

/// The coefficient of a law; of none there is none.
template <Scalar S>
S* coefficient_of(Friction<S>& f, FrictionLaw law) {
  switch (law) {
    case FrictionLaw::none: break;
    case FrictionLaw::load_proportional: return &f.radius;
    case FrictionLaw::viscous: return &f.damping;
    case FrictionLaw::quadratic: return &f.quadratic;
    case FrictionLaw::constant: return &f.torque;
  }
  return nullptr;
}
/// Its key; null of none.
constexpr const ParameterKey* key_of(FrictionLaw law) {
  switch (law) {
    case FrictionLaw::none: break;
    case FrictionLaw::load_proportional: return &friction_key::radius;
    case FrictionLaw::viscous: return &friction_key::damping;
    case FrictionLaw::quadratic: return &friction_key::quadratic;
    case FrictionLaw::constant: return &friction_key::torque;
  }
  return nullptr;
}

/// The friction of `count` equal transmissions that move in phase, against their common speed: what follows the load
/// follows the sum of their rod forces (model.md section 13). For M of them:
/// \f[
/// \mu r_\mathrm{e}, \qquad M b_\mathrm{f}, \qquad M c_\mathrm{f}, \qquad M T_\mathrm{c}
/// \f]
template <Scalar S>
Friction<S> side_by_side(const Friction<S>& f, const S& count) {
  return {f.radius, f.damping * count, f.quadratic * count, f.torque * count};
}

/// The part of the friction torque [N m] that does not depend on the rod force, at crank speed omega turning in
/// `direction` s (+-1), omega having the sign s or being 0.
/// \f[
/// T_\mathrm{l} = s\, T_\mathrm{c} + b_\mathrm{f}\, \omega + s\, c_\mathrm{f}\, \omega^2
/// \f]
template <Scalar S>
S load_free_friction(const Friction<S>& f, const S& omega, const S& direction) {
  return direction * f.torque + f.damping * omega + direction * f.quadratic * square(omega);
}

/// The load-proportional part of the friction torque [N m] (eq 6), `direction` being the sign of omega.
/// \f[
/// T_\mathrm{f} = \mu r_\mathrm{e} |F| \operatorname{sign}\omega
/// \f]
template <Scalar S>
S load_friction(const Friction<S>& f, const S& rod_force_magnitude, const S& direction) {
  return direction * f.radius * rod_force_magnitude;
}

/// The coefficient with which a law by itself takes a torque [N m] at that crank speed [rad/s] and rod force [N]; all
/// positive.
inline double coefficient_for(FrictionLaw law, double torque, double omega, double rod_force) {
  Friction<double> unit;
  double* coefficient = coefficient_of(unit, law);
  if (!coefficient) return 0.0;
  *coefficient = 1.0;
  return torque / (load_free_friction(unit, omega, 1.0) + load_friction(unit, rod_force, 1.0));
}

}  // namespace wingbeat

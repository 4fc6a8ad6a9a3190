// Limits of flapping wings that no equation of motion knows: where two wings on one body meet, and the Reynolds numbers
// for which force coefficients hold; docs/domain.md.
#pragma once

#include <cmath>
#include <limits>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/planform.hpp"

namespace wingbeat {

template <Scalar S>
struct WingLimits {
  /// Reynolds number over the mean of |beta'| [s/rad]; not a number without air and of wings without a shape.
  S reynolds_number_per_speed = S(std::numeric_limits<double>::quiet_NaN());
  S reynolds_number_min = S(0);                                        ///< for which the coefficients hold [1]
  S reynolds_number_max = S(std::numeric_limits<double>::infinity());  ///< the same
  /// Stroke angle to either side at which two wings on one body meet [rad]; infinite where none do.
  S stroke_max = S(std::numeric_limits<double>::infinity());

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.reynolds_number_per_speed, self.reynolds_number_min, self.reynolds_number_max, self.stroke_max);
  }
};

namespace wing_limits_key {
inline constexpr ParameterKey kinematic_viscosity{"aerodynamics.kinematic_viscosity", "m2/s", range::positive};
inline constexpr ParameterKey reynolds_number_min{"aerodynamics.reynolds_number_min", "1", range::not_negative};
inline constexpr ParameterKey reynolds_number_max{"aerodynamics.reynolds_number_max", "1", range::positive};
}  // namespace wing_limits_key

/// What the mean of |beta'| makes, by this factor [s/rad], the Reynolds number of the mean chord \f$\overline{c}\f$ at
/// the mean speed of the tip (Ellington, Phil. Trans. R. Soc. Lond. B 305, 1984); not a number without a shape. With
/// the hub offset d:
/// \f[
/// \frac{\mathrm{Re}}{\overline{|\dot\beta|}} = \frac{\overline{c}\, (R + d)}{\nu}, \qquad
/// \overline{c} = \frac1R \int c\,\mathrm{d}r
/// \f]
template <Scalar S>
S reynolds_number_per_speed(const Planform<S>& p, const S& kinematic_viscosity) {
  if (p.shape == PlanformShape::moments) return S(std::numeric_limits<double>::quiet_NaN());
  const S R = length_of(p);
  return wing_area(p) / R * (R + hub_offset_of(p)) / kinematic_viscosity;
}

/// Where the tips of two wings meet in the plane between them [rad]: 90 deg, and by as much more as the shoulders leave
/// room for; infinite where the wings are too short to meet. Wings without a shape are taken to meet at 90 deg. With
/// the shoulder distance b and the hub offset d:
/// \f[
/// \beta_\mathrm{meet} = \frac{\pi}{2} + \arcsin\frac{b}{2 (R + d)}
/// \f]
template <Scalar S>
S stroke_where_wings_meet(const Planform<S>& p) {
  using std::asin;
  if (p.shape == PlanformShape::moments) return S(0.5 * pi);
  const S room = p.shoulder_distance / (S(2.0) * (length_of(p) + hub_offset_of(p)));
  if (!(value_of(room) < 1.0)) return S(std::numeric_limits<double>::infinity());
  return S(0.5 * pi) + asin(room);
}

}  // namespace wingbeat

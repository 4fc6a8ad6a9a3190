// Wings that meet at a reversal and peel apart, with more force while they are close; model.md section 17.
#pragma once

#include <cmath>
#include <limits>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

/// Wings that swing away from the reversal \f$\beta_\mathrm{r}\f$ at which they are close to each other. The 70 %
/// station of a wing then has gone the way \f$s = 0.7 (R + d) (\beta_\mathrm{r} - \beta)\f$.
template <Scalar S>
struct ClapAndFling {
  S amplitude = S(0);                                        ///< A [1], >= 0; 0: no interaction
  S decay_angle = S(1);                                      ///< \f$\lambda \bar c / (0.7 (R + d))\f$ [rad], > 0
  S reach = S(std::numeric_limits<double>::infinity());      ///< a reversal beyond it is close enough [rad]
  S reversal = S(-std::numeric_limits<double>::infinity());  ///< \f$\beta_\mathrm{r}\f$, largest stroke angle [rad]

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.amplitude, self.decay_angle, self.reach, self.reversal);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace clap_and_fling_key {
inline constexpr ParameterKey amplitude{"aerodynamics.clap_and_fling.amplitude", "1", range::not_negative};
inline constexpr ParameterKey decay{"aerodynamics.clap_and_fling.decay", "1", range::positive};
inline constexpr ParameterKey gap{"aerodynamics.clap_and_fling.gap", "1", range::not_negative};
inline constexpr ParameterKey meeting_angle{"aerodynamics.clap_and_fling.meeting_angle", "rad", range::positive};
}  // namespace clap_and_fling_key

/// Part of the distance from hinge to tip at which the way of a wing is measured.
inline constexpr double clap_station = 0.7;

template <Scalar S>
bool claps(const ClapAndFling<S>& c) {
  return acts(c.amplitude);
}

/// By what the forces of all wings are multiplied at the stroke angle beta [rad]; `stroke` is the sign of beta'. On the
/// way back, after the reversal at which the wings are apart, it is 1.
/// \f[
/// 1 + A \exp\left( -\frac{s}{\lambda \bar c} \right)
/// \f]
template <Scalar S>
S clap_factor(const ClapAndFling<S>& c, const S& beta, const S& stroke) {
  using std::exp;
  if (value_of(stroke) > 0.0 || !(value_of(c.reversal) >= value_of(c.reach))) return S(1.0);
  return S(1.0) + c.amplitude * exp(S((beta - c.reversal) / c.decay_angle));
}

/// The stroke angle [rad] from which on a reversal brings the 70 % stations of two wings, which meet at
/// \f$\beta_\mathrm{m}\f$, within the gap \f$g\, \bar c\f$ of each other.
/// \f[
/// \beta_\mathrm{m} - \arcsin \frac{g\, \bar c}{2 \cdot 0.7\, (R + d)}
/// \f]
template <Scalar S>
S clap_reach(const S& meeting_angle, const S& gap, const S& mean_chord, const S& tip_radius) {
  using std::asin;
  const S half = gap * mean_chord / (S(2.0 * clap_station) * tip_radius);
  if (!(value_of(half) < 1.0)) return S(-std::numeric_limits<double>::infinity());
  return meeting_angle - asin(half);
}

}  // namespace wingbeat

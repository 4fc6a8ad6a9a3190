// What commands a brushless motor: efficiency, current limit, and that no current flows back; model.md section 15.
#pragma once

#include <cmath>
#include <cstddef>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/core/status.hpp"

namespace wingbeat {

/// The motor itself is a DC motor of its line-to-line resistance and inductance, \f$K = 60 / (2 \pi K_\mathrm{v})\f$.
/// While the bridge conducts, the supply gives \f$v i / \eta\f$. Where the back-EMF exceeds the voltage the bridge
/// blocks, i = 0; at the current limit the voltage at the terminals follows so that \f$i = i_\mathrm{max}\f$.
template <Scalar S>
struct Electronics {
  static constexpr bool off_lanes = true;
  S efficiency = S(1);          ///< eta_esc [1], > 0, <= 1
  S current_max = S(infinity);  ///< i_max of all motors together [A], > 0
  bool regenerates = true;      ///< current may flow back; false of a brushless motor

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.efficiency, self.current_max, self.regenerates);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace electronics_key {
inline constexpr ParameterKey efficiency{"electronics.efficiency", "1", range::efficiency};
inline constexpr ParameterKey current_max{"electronics.current_max", "A", range::positive};
}  // namespace electronics_key

/// Whether the current stays within limits. Batches do not know that.
template <Scalar S>
bool limits_current(const Electronics<S>& e) {
  return !e.regenerates || std::isfinite(value_of(e.current_max));
}

/// Lanes know of none.
template <Scalar S>
S current_within(std::nullptr_t, const S& i) {
  return i;
}

/// A steady current [A] as the electronics let it flow.
template <Scalar S>
S current_within(const Electronics<S>& e, const S& i) {
  if constexpr (ScalarTraits<S>::reads_tables) {
    if (!e.regenerates && value_of(i) < 0.0) return S(0.0);
    if (value_of(i) > value_of(e.current_max)) return e.current_max;
  }
  return i;
}

}  // namespace wingbeat

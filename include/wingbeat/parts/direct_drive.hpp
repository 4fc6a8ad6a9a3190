// A direct drive as a transmission: the motor's shaft is the wings' hinge; model.md section 6.
#pragma once

#include <array>
#include <string_view>

#include "wingbeat/core/range.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/parts/transmission.hpp"

namespace wingbeat {

template <Scalar S>
struct DirectDrive {
  /// r_ref [m], at which the wings' moment is taken up: friction that follows the load acts on that moment over r_ref,
  /// which takes the place of the rod force. 1 where no friction does.
  S reference_radius = S(1);

  static constexpr std::array<std::string_view, 0> keys = {};  ///< [transmission] holds none
  template <class Design>
  static DirectDrive from(const Design&) {
    return {};
  }

  template <class Self, class Use>
  static constexpr auto members(Self& self, const Use& use) {
    return use(self.reference_radius);
  }
};

/// Keys, units and ranges; the table of parameters has them from here.
namespace direct_drive_key {
inline constexpr ParameterKey reference_radius{"friction.reference_radius", "m", range::positive};
}  // namespace direct_drive_key

/// The levers of a direct drive, whose shaft angle is the stroke angle itself. It holds no position: that is the stroke
/// angle of the state.
/// \f[
/// B_1 = 1, \qquad B_2 = 0, \qquad g = h = r_\mathrm{ref}
/// \f]
template <Scalar S>
CrankKinematics<S> direct_kinematics(const DirectDrive<S>& drive = {}) {
  return {S(0.0), S(0.0), S(1.0), S(0.0), drive.reference_radius, drive.reference_radius};
}

}  // namespace wingbeat

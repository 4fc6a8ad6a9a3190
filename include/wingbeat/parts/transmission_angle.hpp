// The angle between coupler and rocker of a four-bar where it is extreme; docs/model.md section 8.
#pragma once

#include "wingbeat/parts/four_bar.hpp"

namespace wingbeat {

/// Cosines of the transmission angle with the crank on the line of the axes. Beyond 1 or -1 the crank does not turn.
/// \f[
/// \cos\mu = \frac{p^2 + l^2 - (d \mp r_\mathrm{c})^2}{2\, p\, l}
/// \f]
struct TransmissionCosines {
  double least;    ///< of the least angle: the crank points to the rocker's axis
  double largest;  ///< of the largest: it points away from it
  /// Of the least angle, or of its least distance from 180 deg, if that is less.
  double worst() const { return least > -largest ? least : -largest; }
};
TransmissionCosines transmission_cosines(const FourBar<double>& f);

}  // namespace wingbeat

// Exact derivatives of a flight whose throttle follows the weight.
#pragma once

#include <span>
#include <vector>

#include "study/voltage_nodes.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat::detail {

/// A flight, or the part of it that ends at an event.
struct FlownPart {
  double time;                      ///< [s]
  double first_charge, end_charge;  ///< [1]
  FlightEvent event;
};

/// Derivatives of its time by parameters of the design, SI; absent where an orbit on the way has none. Of a battery
/// with Throttle::hover whose motor has settled. With the mean current I(s) that the battery gives at the charge s, and
/// X(s) that is zero where the flight ends:
/// \f[
/// t = \int_{s_\mathrm{e}}^{s_0} \frac{Q}{I}\, \mathrm{d}s, \qquad
/// \frac{\mathrm{d}t}{\mathrm{d}p} = -\int_{s_\mathrm{e}}^{s_0} \frac{Q}{I^2} \frac{\partial I}{\partial p}\,
/// \mathrm{d}s + \frac{Q}{I(s_\mathrm{e})} \frac{\partial X / \partial p}{\partial X / \partial s}
/// \f]
std::vector<double> throttled_gradient(const Design<double>& design, Condition condition, double tolerance,
                                       std::span<const DesignParameter> parameters, const FlownPart& part);

}  // namespace wingbeat::detail

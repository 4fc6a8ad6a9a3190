// The torque behind the gearbox of one motor over a cycle of steady flapping, which the limits of a gearbox are about.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "wingbeat/cycle/held.hpp"
#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"

namespace wingbeat {

enum class Condition;
struct DesignParameter;

/// Magnitudes of what one motor gives to crank or shaft behind its gearbox, \f$T_\mathrm{m} / M\f$ [N m]; the root of
/// the mean square is over the time of the cycle. Both absent unless flapping, and where the cycle was simulated in
/// time.
struct GearTorque {
  double rms = absent, peak = absent;
};

/// Limits of one gearbox [N m]: of the rms torque, for any time, and of the peak torque.
struct GearTorqueLimits {
  std::optional<double> continuous = {}, peak = {};
  bool any() const { return continuous || peak; }
};

/// The mean by the quadrature of the orbit's own steps, the peak between them. What impacts on stops add is in neither.
GearTorque gear_torque(const SteadyFlapping& orbit);

/// Derivatives by parameters of the design that `orbit` is of, through the orbit as those of metrics; absent where the
/// orbit has none. Throws ParameterError for a parameter without a value in the design.
std::vector<GearTorque> gear_torque_slopes(const Design<double>& design, Condition condition,
                                           const SteadyFlapping& orbit, std::span<const DesignParameter> parameters,
                                           Held held);

}  // namespace wingbeat

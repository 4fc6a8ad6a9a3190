#include "wingbeat/study/two_sides.hpp"

#include <cmath>

#include "wingbeat/core/status.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

/// Metrics of which the whole vehicle has the sum.
constexpr Metric sums[] = {
    Metric::current_mean,   Metric::power_electrical,     Metric::power_motor,    Metric::power_motor_reference,
    Metric::power_friction, Metric::power_aerodynamic,    Metric::power_reactive, Metric::power_copper,
    Metric::power_viscous,  Metric::power_motor_friction, Metric::power_gear,     Metric::power_electronics,
    Metric::power_loss,     Metric::power_residual,       Metric::lift_mean,      Metric::power_hinge};

Metrics<double> metrics_of(const TwoSidesResult& r) {
  Metrics<double> m;
  m.values.fill(absent);
  if (r.left.status != FlappingStatus::flapping || r.right.status != FlappingStatus::flapping) return m;
  const Metrics<double>&left = r.left.metrics, &right = r.right.metrics;
  for (const Metric which : {Metric::voltage, Metric::frequency}) m[which] = left[which];
  for (const Metric which : sums) m[which] = left[which] + right[which];
  m[Metric::efficiency_system] = m[Metric::power_aerodynamic] / m[Metric::power_electrical];
  m[Metric::efficiency_motor] = m[Metric::power_motor] / m[Metric::power_electrical];
  m[Metric::efficiency_mechanism] = m[Metric::power_aerodynamic] / m[Metric::power_motor];
  if (const std::optional<double> mass = total_mass(r.whole)) {
    m[Metric::lift_to_weight] = m[Metric::lift_mean] / (*mass * standard_gravity);
  }
  for (double& x : m.values) {
    if (!std::isfinite(x)) x = absent;
  }
  return m;
}

void require_no_sum(const RunOptions& options) {
  const char* why = "is the whole vehicle's, of which neither side has a known part; set the voltage instead";
  if (options.lift) throw ParameterError("lift", why);
  if (options.power) throw ParameterError("power", why);
}

TwoSidesResult together(const TwoSides& vehicle, RunResult left, RunResult right) {
  TwoSidesResult result{vehicle.whole, std::move(left), std::move(right), FlappingStatus::flapping, {}};
  result.whole.supply = result.left.design.supply;
  result.status = result.left.status != FlappingStatus::flapping ? result.left.status : result.right.status;
  result.metrics = metrics_of(result);
  return result;
}

}  // namespace

TwoSidesResult run_two_sides(const TwoSides& vehicle, const RunOptions& options) {
  require_no_sum(options);
  return together(vehicle, run_design(vehicle.left, options), run_design(vehicle.right, options));
}

TwoSidesMaps two_sides_maps(const TwoSides& vehicle, const ControlOptions& options) {
  require_no_sum(options.operating_point);
  require(options.hinge_offset >= 0.0 && std::isfinite(options.hinge_offset), "hinge_offset", "must be >= 0", "m",
          options.hinge_offset);
  const Linearisation left = linearise(vehicle.left, options.operating_point, options.step_cycles);
  const Linearisation right = linearise(vehicle.right, options.operating_point, options.step_cycles);
  TwoSidesMaps found{together(vehicle, left.operating_point, right.operating_point), options, {}};
  if (options.allocation_maps) found.maps = allocation_maps(left, right, options.hinge_offset);
  return found;
}

}  // namespace wingbeat

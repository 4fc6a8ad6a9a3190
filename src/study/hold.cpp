#include "wingbeat/study/hold.hpp"

#include "wingbeat/core/math.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

double held_lift(const Hold& hold, const Reporting& reporting) {
  if (hold.held == Held::lift) return hold.value;
  return hold.held == Held::lift_to_weight ? hold.value * reporting.mass * standard_gravity : absent;
}

FrequencySearch find_voltage(const Vehicle<double>& vehicle, const Hold& hold, const SteadyOptions& options,
                             const StartUp& start_up) {
  if (hold.held == Held::frequency) return find_voltage_for_frequency(vehicle, hold.value, options, start_up);
  LiftSearchOptions where;
  where.range = hold.range;
  if (vehicle.voltage > 0.0) where.nominal = vehicle.voltage;
  return find_voltage_for_lift(vehicle, held_lift(hold, options.reporting), options, start_up, where);
}

}  // namespace wingbeat

#include "wingbeat/study/hold.hpp"

#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

double held_lift(const Hold& hold, const Reporting& reporting) {
  if (hold.held == Held::lift) return hold.value;
  return hold.held == Held::lift_to_weight ? hold.value * reporting.mass * standard_gravity : absent;
}

void set_full_duty(Supply<double>& supply) {
  if (supply.type == SupplyType::battery) supply.duty = 1.0;
}

double highest_voltage(const Supply<double>& supply) {
  return has_battery(supply.type) ? open_circuit_voltage(supply.battery, supply.battery.charge) : HUGE_VAL;
}

void set_voltage(Supply<double>& supply, double voltage) {
  if (supply.type == SupplyType::battery) supply.duty = voltage / highest_voltage(supply);
  else supply.voltage = supply.type == SupplyType::pwm ? voltage / supply.duty : voltage;
}

FrequencySearch find_voltage(const Vehicle<double>& vehicle, const Hold& hold, const SteadyOptions& options,
                             const StartUp& start_up) {
  const SearchRange range = hold.range == SearchRange::coefficients ? SearchRange::extrapolation : hold.range;
  if (hold.held == Held::frequency) {
    return find_voltage_for_frequency(vehicle, hold.value, options, start_up, range, hold.highest_voltage);
  }
  if (hold.held == Held::power) {
    return find_voltage_for_power(vehicle, hold.value, options, start_up, range, hold.highest_voltage);
  }
  LiftSearchOptions where;
  where.range = hold.range;
  where.highest_voltage = hold.highest_voltage;
  if (vehicle.voltage > 0.0) where.nominal = vehicle.voltage;
  return find_voltage_for_lift(vehicle, held_lift(hold, options.reporting), options, start_up, where);
}

}  // namespace wingbeat

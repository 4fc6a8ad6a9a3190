#include "study/flight_moment.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/study/hold.hpp"

namespace wingbeat::detail {
namespace {

bool is_throttled(const Design<double>& design) { return design.supply.throttle == Throttle::hover; }

Vehicle<double> resolved(Design<double> design, Condition condition) {
  if (is_throttled(design)) set_full_duty(design.supply);
  return resolve(design, condition);
}

}  // namespace

double battery_current(const Metrics<double>& metrics, double duty, double E, double R_i, bool power_passed_on) {
  if (!power_passed_on) return duty * metrics[Metric::current_mean];
  const double P_e = metrics[Metric::power_electrical];
  return 2.0 * P_e / (E + std::sqrt(square(E) - 4.0 * R_i * P_e));
}

FlightMoments::FlightMoments(const Design<double>& design, const EnduranceOptions& options)
    : battery_(design.supply.battery),
      bridged_(design.supply.type == SupplyType::battery_sine),
      duty_(bridged_ ? 1.0 : design.supply.duty),
      vehicle_(resolved(design, options.condition)) {
  steady_.tolerance = std::max(0.01 * options.tolerance, 1e-12);
  steady_.stability = false;
  steady_.reporting = reporting_of(design);
  if (is_throttled(design)) {
    throttle_.emplace(steady_.reporting.mass * standard_gravity, steady_, std::max(0.1 * options.tolerance, 1e-12));
  }
}

Vehicle<double> FlightMoments::full_throttle(double voltage) const {
  Vehicle<double> full = vehicle_;
  full.voltage = voltage;
  return full;
}

FlightMoment FlightMoments::at(double voltage, const Temperatures& temperatures, const StartUp& start_up) {
  if (on_bridge_ && !temperatures) return *on_bridge_;
  SteadyFlapping found;
  FlightMoment moment;
  if (throttle_) {
    ThrottledFlapping throttled = throttle_->find(full_throttle(voltage), temperatures, start_up);
    found = std::move(throttled.flapping);
    moment.voltage = throttled.voltage;
    if (!bridged_) moment.duty = throttled.voltage / voltage;
  } else {
    ++evaluations_;
    if (!bridged_) vehicle_.voltage = duty_ * voltage;
    found = temperatures ? find_flapping_at_given_temperature(with_motor_at(vehicle_, *temperatures), steady_, start_up)
                         : find_steady_flapping(vehicle_, steady_, start_up);
    moment.voltage = vehicle_.voltage;
    moment.duty = duty_;
  }
  moment.flaps = found.status == FlappingStatus::flapping && std::isfinite(moment.voltage);
  moment.status = found.status;
  moment.evidence = found.evidence;
  moment.metrics = found.metrics;
  if (moment.flaps && temperatures) state_temperatures(moment.metrics, *temperatures);
  if (moment.flaps) moment.domain = domain_of(vehicle_, moment.metrics);
  if (bridged_ && !temperatures) on_bridge_ = moment;
  return moment;
}

SteadyFlapping FlightMoments::at_full_throttle(double voltage, const Temperatures& temperatures,
                                               const StartUp& start_up) {
  SteadyFlapping found = throttle_->solve(full_throttle(voltage), temperatures, start_up);
  if (found.status == FlappingStatus::flapping && temperatures) state_temperatures(found.metrics, *temperatures);
  return found;
}

void FlightMoments::state_temperatures(Metrics<double>& metrics, const MotorTemperatures<double>& temperatures) const {
  metrics[Metric::winding_temperature] = temperatures.winding - zero_celsius;
  metrics[Metric::case_temperature] = temperatures.casing - zero_celsius;
  metrics[Metric::winding_temperature_margin] = vehicle_.thermal.winding_temperature_max - temperatures.winding;
}

DomainStatus FlightMoments::domain_at_full_throttle(double voltage, const Metrics<double>& metrics) const {
  return domain_of(full_throttle(voltage), metrics);
}

BatteryLoad FlightMoments::load_of(const FlightMoment& moment, double voltage) const {
  const Metrics<double>& m = moment.metrics;
  const double R_i = source_resistance(battery_);
  const bool passed_on = bridged_ || std::isfinite(m[Metric::power_electronics]);
  const double current = battery_current(m, moment.duty, voltage, R_i, passed_on);
  const double heating = passed_on ? current : moment.duty * m[Metric::current_rms];
  return {voltage - R_i * current, current, R_i * square(heating)};
}

std::optional<EnduranceEnd> FlightMoments::end_at(const FlightMoment& moment, double voltage) const {
  if (!moment.flaps) return throttle_ ? EnduranceEnd::sinks : EnduranceEnd::stops;
  const double v = load_of(moment, voltage).voltage;
  if (bridged_ && !(v >= moment.voltage)) return EnduranceEnd::bridge;
  if (throttle_ && !bridged_ && !(moment.duty <= 1.0)) return EnduranceEnd::sinks;
  if (battery_.cutoff_voltage && !(v > battery_.cells * *battery_.cutoff_voltage)) return EnduranceEnd::cutoff;
  return std::nullopt;
}

bool FlightMoments::carries(const FlightMoment& moment) const {
  return throttle_ ? moment.flaps : moment.metrics[Metric::lift_to_weight] >= 1.0;
}

}  // namespace wingbeat::detail

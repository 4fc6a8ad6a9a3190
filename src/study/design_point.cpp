#include "wingbeat/study/design_point.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/study/endurance.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

/// Derivatives of a flight that begins where a hold puts it: by differences, for the hold moves it, too.
void differentiate_held_flight(const Design<double>& design, DesignPointOptions options,
                               std::span<const DesignParameter> parameters, const StartUp& start_up,
                               Endurance& flight) {
  options.tolerance = std::min(options.tolerance, 1e-8);
  flight.hover_by_parameter.assign(parameters.size(), absent);
  flight.by_parameter.assign(parameters.size(), absent);
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double x = parameters[k].value(design).value_or(absent), step = 1e-4 * std::abs(x);
    if (!(step > 0.0)) continue;
    const auto moved = [&](double stated) {
      Design<double> d = design;
      parameters[k].set(d, stated);
      return design_point(d, options, {}, start_up).metrics;
    };
    const Metrics<double> above = moved(x + step), below = moved(x - step);
    const auto slope = [&](Metric m) { return (above[m] - below[m]) / (2.0 * step); };
    flight.hover_by_parameter[k] = slope(Metric::hover);
    flight.by_parameter[k] = slope(Metric::endurance);
  }
}

}  // namespace

DesignPoint design_point(const Design<double>& given, const DesignPointOptions& options,
                         std::span<const DesignParameter> parameters, const StartUp& start_up) {
  Design<double> design = given;
  const bool driven =
      options.hold && options.hold->held == Held::frequency && set_drive_frequency(design, options.hold->value);
  DesignPoint point;
  point.metrics.values.fill(absent);
  std::array<double, metric_count> nothing;
  nothing.fill(absent);
  point.gradients.assign(parameters.size(), nothing);
  point.domain_slopes.resize(parameters.size());
  for (DomainExcess& slopes : point.domain_slopes) slopes.fill(absent);
  try {
    validate(design);
  } catch (const ParameterError& error) {
    point.error = error.what();
    return point;
  }
  std::optional<Hold> hold = options.hold;
  if (hold) {
    set_full_duty(design.supply);
    hold->highest_voltage = highest_voltage(design.supply);
  }
  Vehicle<double> vehicle = resolve(design, options.condition);
  const SteadyOptions steady{options.tolerance, false, reporting_of(design)};
  if (options.hold && !driven) {
    const FrequencySearch search = find_voltage(vehicle, *hold, steady, start_up);
    if (search.outcome != FrequencyOutcome::reached) {
      const bool flaps = search.status == FlappingStatus::flapping;
      point.status = flaps ? SweepStatus::unreached : sweep_status(search.status);
      point.refused = search.finding;
      return point;
    }
    set_mean_voltage(vehicle, search.voltage);
  }
  const SteadyFlapping orbit = find_steady_flapping(vehicle, steady, start_up);
  point.status = sweep_status(orbit.status);
  point.evidence = orbit.evidence;
  if (orbit.status != FlappingStatus::flapping) return point;
  point.metrics = orbit.metrics;
  point.voltage = vehicle.voltage;
  Endurance flight;
  if (options.flight.any() && has_battery(design.supply.type)) {
    const bool begins_held = hold && design.supply.throttle == Throttle::fixed;
    Design<double> flown = design;
    if (hold) set_voltage(flown.supply, vehicle.voltage);
    const auto exact = begins_held ? std::span<const DesignParameter>() : parameters;
    flight = endurance_of(flown, options.condition, options.tolerance, exact, options.flight);
    if (begins_held) differentiate_held_flight(given, options, parameters, start_up, flight);
    point.metrics[Metric::hover] = flight.hover;
    point.metrics[Metric::endurance] = flight.time;
  }
  point.domain_excess = domain_excess(vehicle, orbit.metrics);
  point.domain = domain_of(point.domain_excess);
  if (parameters.empty() || orbit.record.empty()) return point;

  const GradientOptions held{options.hold ? options.hold->held : Held::voltage, options.peaks, {}};
  const MetricGradients gradients = metric_gradients(design, options.condition, orbit, parameters, held);
  if (!gradients.regular) return point;
  point.gradients = gradients.by_parameter;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const auto of_flight = [&](Metric metric, const std::vector<double>& by_parameter) {
      if (!by_parameter.empty()) point.gradients[k][std::size_t(metric)] = by_parameter[k];
    };
    of_flight(Metric::hover, flight.hover_by_parameter);
    of_flight(Metric::endurance, flight.by_parameter);
    point.domain_slopes[k] = domain_excess_slopes(vehicle, orbit.metrics, Metrics<double>{point.gradients[k]});
  }
  return point;
}

}  // namespace wingbeat

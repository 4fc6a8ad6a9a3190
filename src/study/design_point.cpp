#include "wingbeat/study/design_point.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "study/pitch_search.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

/// Derivatives of a flight that begins where a hold, or an angle of attack, puts it: by differences, for that moves it,
/// too.
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

DesignPoint empty_point(std::size_t parameters) {
  DesignPoint point;
  point.metrics.values.fill(absent);
  std::array<double, metric_count> nothing;
  nothing.fill(absent);
  point.gradients.assign(parameters, nothing);
  point.domain_slopes.resize(parameters);
  for (DomainExcess& slopes : point.domain_slopes) slopes.fill(absent);
  return point;
}

/// The point of a design whose C_alpha is known; in derivatives it follows where `at_angle`, the same design with the
/// angle of attack that it was found for, is given.
DesignPoint point_at(const Design<double>& given, const DesignPointOptions& options,
                     std::span<const DesignParameter> parameters, const StartUp& start_up,
                     const Design<double>* at_angle = nullptr) {
  Design<double> design = given;
  const bool driven =
      options.hold && options.hold->held == Held::frequency && set_drive_frequency(design, options.hold->value);
  DesignPoint point = empty_point(parameters.size());
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
  if (options.gear_torque) point.gear_torque = gear_torque(orbit);
  Endurance flight;
  if (options.flight.any() && has_battery(design.supply.type)) {
    const bool begins_held = at_angle || (hold && design.supply.throttle == Throttle::fixed);
    Design<double> flown = design;
    if (hold) set_voltage(flown.supply, vehicle.voltage);
    const auto exact = begins_held ? std::span<const DesignParameter>() : parameters;
    flight = endurance_of(flown, options.condition, options.tolerance, exact, options.flight);
    if (begins_held) differentiate_held_flight(at_angle ? *at_angle : given, options, parameters, start_up, flight);
    point.metrics[Metric::hover] = flight.hover;
    point.metrics[Metric::endurance] = flight.time;
  }
  point.domain_excess = domain_excess(vehicle, orbit.metrics);
  point.domain = domain_of(point.domain_excess);
  if (parameters.empty() || orbit.record.empty()) return point;

  const GradientOptions held{options.hold ? options.hold->held : Held::voltage, options.peaks, {}, at_angle != nullptr};
  const MetricGradients gradients = metric_gradients(design, options.condition, orbit, parameters, held);
  if (!gradients.regular) return point;
  point.gradients = gradients.by_parameter;
  if (options.gear_torque) {
    point.gear_torque_slopes = gear_torque_slopes(design, options.condition, orbit, parameters, held.held);
  }
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

/// Finds C_alpha for the angle of attack that the design states; `point` says why where there is none.
std::optional<Design<double>> find_pitch(const Design<double>& design, DesignPointOptions options,
                                         const StartUp& start_up, DesignPoint& point) {
  options.flight = {};
  const auto by_angle = [](const DomainEvidence& e) { return e.limit == DomainLimit::angle_of_attack; };
  DesignPoint last;
  const auto angle_with = [&](double C) {
    last = point_at(detail::with_pitch_coefficient(design, C), options, {}, start_up);
    if (last.status == SweepStatus::flapping) return last.metrics[Metric::angle_of_attack_min];
    const bool too_large = last.status == SweepStatus::unreached && last.refused &&
                           std::any_of(last.refused->limits.begin(), last.refused->limits.end(), by_angle);
    return too_large ? detail::below_range : absent;
  };
  const double angle = *design.aerodynamics.angle_of_attack;
  const detail::PitchSearch search = detail::find_pitch_coefficient(
      design.aerodynamics.pitch_coefficient, degrees_per_radian * angle, options.tolerance, angle_with);
  if (search.outcome == detail::PitchOutcome::found) {
    return detail::with_pitch_coefficient(design, search.pitch_coefficient);
  }
  if (search.outcome == detail::PitchOutcome::impossible) {
    point.status = SweepStatus::unreached;
    point.error = std::string(aerodynamics_key::angle_of_attack.path) + ": " + detail::no_pitch_coefficient(angle);
    return std::nullopt;
  }
  point.status = last.status;
  point.evidence = last.evidence;
  point.refused = last.refused;
  return std::nullopt;
}

}  // namespace

DesignPoint design_point(const Design<double>& given, const DesignPointOptions& options,
                         std::span<const DesignParameter> parameters, const StartUp& start_up) {
  if (!needs_pitch_coefficient(given, options.condition)) return point_at(given, options, parameters, start_up);
  DesignPoint point = empty_point(parameters.size());
  try {
    validate(given);
  } catch (const ParameterError& error) {
    point.error = error.what();
    return point;
  }
  const std::optional<Design<double>> found = find_pitch(given, options, start_up, point);
  if (!found) return point;
  point = point_at(*found, options, parameters, start_up, &given);
  point.pitch_coefficient = found->aerodynamics.pitch_coefficient;
  return point;
}

}  // namespace wingbeat

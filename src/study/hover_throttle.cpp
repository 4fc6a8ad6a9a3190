#include "study/hover_throttle.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/study/frequency_search.hpp"

namespace wingbeat::detail {

SteadyFlapping HoverThrottle::solve(const Vehicle<double>& vehicle,
                                    const std::optional<MotorTemperatures<double>>& temperatures,
                                    const StartUp& start_up) {
  ++evaluations_;
  return temperatures ? find_flapping_at_given_temperature(with_motor_at(vehicle, *temperatures), options_, start_up)
                      : find_steady_flapping(vehicle, options_, start_up);
}

/// The secant method in the logarithms, in which lift over voltage is nearly straight.
std::optional<ThrottledFlapping> HoverThrottle::follow(const Vehicle<double>& full,
                                                       const std::optional<MotorTemperatures<double>>& temperatures) {
  constexpr int max_trials = 12;
  constexpr double largest_step = 0.2;  // in ln v
  double x = std::log(voltage_), last_x = absent, last_gap = absent;
  for (int n = 0; n < max_trials; ++n) {
    Vehicle<double> vehicle = full;
    set_mean_voltage(vehicle, std::exp(x));
    SteadyFlapping flapping = solve(vehicle, temperatures, {});
    if (flapping.status != FlappingStatus::flapping) return std::nullopt;
    const double gap = std::log(flapping.metrics[Metric::lift_mean] / weight_);
    if (!std::isfinite(gap)) return std::nullopt;
    const double slope = (gap - last_gap) / (x - last_x);
    if (slope > 0.2 && slope < 20.0) slope_ = slope;
    if (std::abs(gap) <= closeness_) {
      voltage_ = vehicle.voltage;
      return ThrottledFlapping{std::move(flapping), voltage_};
    }
    last_x = x;
    last_gap = gap;
    x -= std::clamp(gap / slope_, -largest_step, largest_step);
  }
  return std::nullopt;
}

ThrottledFlapping HoverThrottle::find(const Vehicle<double>& full,
                                      const std::optional<MotorTemperatures<double>>& temperatures,
                                      const StartUp& start_up) {
  if (std::isfinite(voltage_)) {
    if (auto found = follow(full, temperatures)) return *std::move(found);
  }
  // At temperatures that are given none are to be found.
  Vehicle<double> vehicle = temperatures ? with_motor_at(full, *temperatures) : full;
  if (temperatures) vehicle.thermal = {};
  SteadyOptions options = options_;
  options.tolerance = std::clamp(10.0 * closeness_, 1e-11, 1e-2);
  LiftSearchOptions where;
  where.nominal = where.highest_voltage = full.voltage;
  FrequencySearch search;
  for (const SearchRange range : {SearchRange::domain, SearchRange::coefficients, SearchRange::extrapolation}) {
    where.range = range;
    search = find_voltage_for_lift(vehicle, weight_, options, start_up, where);
    evaluations_ += search.evaluations;
    if (search.outcome == FrequencyOutcome::reached || search.outcome == FrequencyOutcome::never_flaps) break;
  }
  ThrottledFlapping result;
  result.flapping.status = search.status;
  result.flapping.metrics.values.fill(absent);
  if (search.outcome != FrequencyOutcome::reached) return result;
  result.voltage = voltage_ = search.voltage;
  vehicle = full;
  set_mean_voltage(vehicle, search.voltage);
  result.flapping = solve(vehicle, temperatures, start_up);
  return result;
}

}  // namespace wingbeat::detail

#include <algorithm>
#include <cmath>

#include "study/throttled_gradient.hpp"
#include "study/voltage_nodes.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/study/endurance.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using detail::FlightEvent;
using detail::VoltageNodes;

EnduranceOptions flight_options(Condition condition, double tolerance, bool allow_extrapolation) {
  // Rows are asked for only to find the end of the flight.
  return {.condition = condition,
          .tolerance = std::clamp(tolerance, 1e-10, 1e-2),
          .allow_extrapolation = allow_extrapolation,
          .intervals = 16,
          .climb_margin = false};
}

/// Without a mass where hover is not wanted, so that its loss is not looked for; a throttle needs it.
EnduranceResult flight_of(Design<double> design, Condition condition, double tolerance, const FlightMetrics& wanted) {
  if (!wanted.hover && design.supply.throttle == Throttle::fixed) design.mass.reset();
  return simulate_discharge(design, flight_options(condition, tolerance, wanted.allow_extrapolation));
}

/// The derivatives of a flight whose orbits are functions of the open-circuit voltage and of the parameters.
class FlightGradient {
 public:
  FlightGradient(const Design<double>& design, Condition condition, double tolerance,
                 std::span<const DesignParameter> parameters)
      : design_(design),
        battery_(design.supply.battery),
        condition_(condition),
        steady_{std::max(0.01 * tolerance, 1e-12), false, reporting_of(design)},
        parameters_(parameters) {}

  /// Of the time t = Q integral ds / mean(i) from the charge s_0 down to s_end, where `event` is what happens there;
  /// `current` is the mean one at the start.
  std::vector<double> of_time(double time, double s_0, double current, double s_end, FlightEvent event) const {
    const double Q = battery_.capacity;
    const double E_0 = open_circuit_voltage(battery_, s_0), E_end = open_circuit_voltage(battery_, s_end);
    const VoltageNodes nodes(battery_.discharge_curve.empty() ? E_0 : E_end, E_0);
    const std::vector<double> weights = nodes.integrals(battery_, s_end, s_0);
    Vehicle<double> vehicle = resolve(design_, condition_);
    std::vector<double> result(parameters_.size(), 0.0), at_end(parameters_.size(), 0.0);
    for (std::size_t j = 0; j < weights.size(); ++j) {
      vehicle.voltage = nodes.voltages()[j];
      const SteadyFlapping orbit = find_steady_flapping(vehicle, steady_, {});
      const bool passed_on = std::isfinite(orbit.metrics[Metric::power_electronics]);  // not the motor's current
      if (orbit.status != FlappingStatus::flapping || passed_on) {
        return std::vector<double>(parameters_.size(), absent);
      }
      const MetricGradients g = metric_gradients(design_, condition_, orbit, parameters_, {Held::voltage, false, {}});
      const double i = orbit.metrics[Metric::current_mean];
      for (std::size_t k = 0; k < parameters_.size(); ++k) {
        const double by_current = g.regular ? g.by_parameter[k][std::size_t(Metric::current_mean)] : absent;
        result[k] -= Q * weights[j] / (i * i) * by_current;
      }
      if (j > 0 || event == FlightEvent::empty) continue;
      // At the end X(s, p) = 0: ds/dp = -(dX/dp)/(dX/ds), which adds Q/i (dX/dp)/(dX/ds).
      const Metric watched = event == FlightEvent::cutoff ? Metric::voltage : Metric::lift_to_weight;
      const double h = 1e-6 * (s_0 - s_end), slope = (open_circuit_voltage(battery_, s_end + h) - E_end) / h;
      const double by_charge = g.by_voltage[std::size_t(watched)] * slope;
      for (std::size_t k = 0; k < parameters_.size(); ++k) {
        const double by = g.regular ? g.by_parameter[k][std::size_t(watched)] : absent;
        const bool limit = event == FlightEvent::cutoff && parameters_[k].key == battery_key::cutoff_voltage.path;
        at_end[k] = Q / i * (by - (limit ? battery_.cells : 0.0)) / by_charge;
      }
    }
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
      const std::string& key = parameters_[k].key;
      result[k] += at_end[k];
      // The larger battery lasts longer, and where its mass follows from it lift falls below the weight sooner.
      if (key == battery_key::capacity.path) result[k] = time / Q + (event == FlightEvent::sinks ? at_end[k] : 0.0);
      // What is left of the flight does not depend on the charge at its start.
      if (key == battery_key::charge.path) result[k] = Q / current;
    }
    return result;
  }

 private:
  const Design<double>& design_;
  const Battery<double>& battery_;
  Condition condition_;
  SteadyOptions steady_;
  std::span<const DesignParameter> parameters_;
};

/// By differences, where the flight ends at a fold of the orbits or its temperatures are states, where hover ends by
/// leaving the domain, at a stated duty below 1, and for a bridge, on which a flight is one orbit.
std::vector<double> by_differences(const Design<double>& design, Condition condition, double tolerance,
                                   std::span<const DesignParameter> parameters, const FlightMetrics& wanted) {
  std::vector<double> result;
  for (const DesignParameter& p : parameters) {
    const double x = p.value(design).value_or(absent), step = 1e-4 * std::abs(x);
    const auto time = [&](double stated) {
      Design<double> d = design;
      p.set(d, stated);
      try {
        validate(d);
        const EnduranceResult flight = flight_of(d, condition, std::min(tolerance, 1e-8), wanted);
        return wanted.hover ? flight.hover_time() : flight.endurance();
      } catch (const ParameterError&) {
        return absent;
      }
    };
    result.push_back(step > 0.0 ? (time(x + step) - time(x - step)) / (2.0 * step) : absent);
  }
  return result;
}

}  // namespace

FlightMetrics flight_metrics(const std::bitset<metric_count>& metrics, bool allow_extrapolation) {
  return {metrics[std::size_t(Metric::hover)], metrics[std::size_t(Metric::endurance)], allow_extrapolation};
}

Endurance endurance_of(const Design<double>& design, Condition condition, double tolerance,
                       std::span<const DesignParameter> parameters, FlightMetrics wanted) {
  Endurance result;
  wanted.hover = wanted.hover && design.mass;
  const EnduranceResult flight = flight_of(design, condition, tolerance, wanted);
  result.time = flight.endurance();
  result.hover = flight.hover_time();
  if (parameters.empty()) return result;

  const bool warms_up = design.motor.thermal.resistance_winding && design.motor.thermal.time_constant_winding;
  const Supply<double>& supply = design.supply;
  const bool one_orbit = supply.type == SupplyType::battery_sine;
  const bool throttled = supply.throttle == Throttle::hover;
  const FlightGradient gradient(design, condition, tolerance, parameters);
  const auto derivatives = [&](double time, double s_end, std::optional<FlightEvent> event, FlightMetrics metric) {
    if (!(time > 0.0)) return std::vector<double>(parameters.size(), absent);
    const bool stated_duty = !throttled && supply.duty < 1.0;
    if (one_orbit || stated_duty || warms_up || !event)
      return by_differences(design, condition, tolerance, parameters, metric);
    const EnduranceRow& first = flight.rows.front();
    if (throttled) {
      return detail::throttled_gradient(design, condition, tolerance, parameters, {time, first.charge, s_end, *event});
    }
    return gradient.of_time(time, first.charge, first.metrics[Metric::current_mean], s_end, *event);
  };
  std::optional<FlightEvent> end;
  if (flight.end == EnduranceEnd::empty) end = FlightEvent::empty;
  if (flight.end == EnduranceEnd::cutoff) end = FlightEvent::cutoff;
  if (flight.end == EnduranceEnd::sinks) end = FlightEvent::sinks;
  const bool kept = flight.hover == Hover::kept;
  if (wanted.endurance || (wanted.hover && kept)) {
    const double s_end = flight.rows.empty() ? absent : flight.rows.back().charge;
    result.by_parameter = derivatives(result.time, s_end, end, {false, true, wanted.allow_extrapolation});
  }
  if (wanted.hover && kept) {
    result.hover_by_parameter = result.by_parameter;
  } else if (wanted.hover) {
    constexpr double equal = 1e-6;  // of lift over weight, where it is what ends hover
    std::optional<FlightEvent> sinks;
    const auto& lost = flight.hover_lost;
    if (lost && std::abs(lost->metrics[Metric::lift_to_weight] - 1.0) < equal) sinks = FlightEvent::sinks;
    result.hover_by_parameter =
        derivatives(result.hover, lost ? lost->charge : absent, sinks, {true, false, wanted.allow_extrapolation});
  }
  return result;
}

}  // namespace wingbeat

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/study/endurance.hpp"

namespace wingbeat {
namespace {

EnduranceOptions flight_options(Condition condition, double tolerance) {
  // Rows are asked for only to find the end of the flight.
  return {.condition = condition, .tolerance = std::clamp(tolerance, 1e-10, 1e-2), .intervals = 16};
}

/// Without a mass, so that the loss of hover is not looked for.
EnduranceResult flight_of(Design<double> design, Condition condition, double tolerance) {
  design.mass.reset();
  return simulate_discharge(design, flight_options(condition, tolerance));
}

/// Interpolation over open-circuit voltages at Chebyshev's points between two of them.
class VoltageNodes {
 public:
  VoltageNodes(double low, double high) {
    const int last = high > low ? 10 : 0;
    for (int j = 0; j <= last; ++j) {
      voltages_.push_back(last == 0 ? low : 0.5 * (low + high) - 0.5 * (high - low) * std::cos(pi * j / last));
      weights_.push_back((j % 2 ? -1.0 : 1.0) * (j == 0 || j == last ? 0.5 : 1.0));
    }
  }

  const std::vector<double>& voltages() const { return voltages_; }

  /// Integrals of Lagrange's polynomials of these voltages over the state of charge: Gauss's rule of three points on
  /// parts of every piece of the discharge curve.
  std::vector<double> integrals(const Battery<double>& battery, double from, double to) const {
    std::vector<double> result(voltages_.size(), 0.0), ends{from};
    for (const auto& [charge, voltage] : battery.discharge_curve) {
      if (charge > from && charge < to) ends.push_back(charge);
    }
    ends.push_back(to);
    constexpr int parts = 8;
    constexpr double node = 0.77459666924148337704;  // sqrt(3/5)
    for (std::size_t k = 1; k < ends.size(); ++k) {
      const double half = 0.5 * (ends[k] - ends[k - 1]) / parts;
      for (int p = 0; p < parts; ++p) {
        const double middle = ends[k - 1] + (2 * p + 1) * half;
        for (int n = -1; n <= 1; ++n) {
          add(open_circuit_voltage(battery, middle + n * node * half), half * (n == 0 ? 8.0 : 5.0) / 9.0, result);
        }
      }
    }
    return result;
  }

 private:
  /// Barycentric interpolation (Berrut and Trefethen 2004).
  void add(double voltage, double factor, std::vector<double>& result) const {
    double sum = 0.0;
    std::vector<double> shares(voltages_.size());
    for (std::size_t j = 0; j < voltages_.size(); ++j) {
      if (voltage == voltages_[j]) {
        result[j] += factor;
        return;
      }
      shares[j] = weights_[j] / (voltage - voltages_[j]);
      sum += shares[j];
    }
    for (std::size_t j = 0; j < voltages_.size(); ++j) result[j] += factor * shares[j] / sum;
  }

  std::vector<double> voltages_, weights_;
};

/// By differences, where the flight ends at a fold of the orbits or its temperatures are states, and for a bridge, on
/// which a flight is one orbit.
std::vector<double> by_differences(const Design<double>& design, Condition condition, double tolerance,
                                   std::span<const DesignParameter> parameters) {
  std::vector<double> result;
  for (const DesignParameter& p : parameters) {
    const double x = p.value(design).value_or(absent), step = 1e-4 * std::abs(x);
    const auto time = [&](double at) {
      Design<double> d = design;
      p.set(d, at);
      try {
        validate(d);
        return flight_of(d, condition, std::min(tolerance, 1e-8)).endurance();
      } catch (const ParameterError&) {
        return absent;
      }
    };
    result.push_back(step > 0.0 ? (time(x + step) - time(x - step)) / (2.0 * step) : absent);
  }
  return result;
}

}  // namespace

Endurance endurance_of(const Design<double>& design, Condition condition, double tolerance,
                       std::span<const DesignParameter> parameters) {
  Endurance result;
  const EnduranceResult flight = flight_of(design, condition, tolerance);
  result.time = flight.endurance();
  if (parameters.empty()) return result;
  result.by_parameter.assign(parameters.size(), absent);
  if (!(result.time > 0.0)) return result;
  const bool warms_up = design.motor.thermal.resistance_winding && design.motor.thermal.time_constant_winding;
  if (design.supply.type == SupplyType::battery_sine || flight.end == EnduranceEnd::stops || warms_up) {
    result.by_parameter = by_differences(design, condition, tolerance, parameters);
    return result;
  }

  // t = Q integral ds / mean(i), the current being a function of the open-circuit voltage and of the parameters.
  const Battery<double>& battery = design.supply.battery;
  const double Q = battery.capacity, s_0 = battery.charge, s_end = flight.rows.back().charge;
  const double E_0 = open_circuit_voltage(battery, s_0), E_end = open_circuit_voltage(battery, s_end);
  const VoltageNodes nodes(battery.discharge_curve.empty() ? E_0 : E_end, E_0);
  const std::vector<double> weights = nodes.integrals(battery, s_end, s_0);
  const SteadyOptions steady{std::max(0.01 * tolerance, 1e-12), false, reporting_of(design)};
  Vehicle<double> vehicle = resolve(design, condition);
  result.by_parameter.assign(parameters.size(), 0.0);
  for (std::size_t j = 0; j < weights.size(); ++j) {
    vehicle.voltage = nodes.voltages()[j];
    const SteadyFlapping orbit = find_steady_flapping(vehicle, steady, {});
    if (orbit.status != FlappingStatus::flapping) {
      result.by_parameter.assign(parameters.size(), absent);
      return result;
    }
    const MetricGradients g = metric_gradients(design, condition, orbit, parameters, {Held::voltage, false, {}});
    const double i = orbit.metrics[Metric::current_mean];
    // At the cut-off V(s, p) = V_c: ds/dp = -(dV/dp - dV_c/dp)/(dV/ds).
    const bool ends_here = j == 0 && flight.end == EnduranceEnd::cutoff;
    const double h = 1e-6 * (s_0 - s_end);
    const double slope = (open_circuit_voltage(battery, s_end + h) - E_end) / h;
    const double dV_ds = g.by_voltage[std::size_t(Metric::voltage)] * slope;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      const auto by = [&](Metric m) { return g.regular ? g.by_parameter[k][std::size_t(m)] : absent; };
      result.by_parameter[k] -= Q * weights[j] / (i * i) * by(Metric::current_mean);
      if (!ends_here) continue;
      const bool limit = parameters[k].key == battery_key::cutoff_voltage.path;
      result.by_parameter[k] += Q / i * (by(Metric::voltage) - (limit ? battery.cells : 0.0)) / dV_ds;
    }
  }
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const std::string& key = parameters[k].key;
    if (key == battery_key::capacity.path) result.by_parameter[k] = result.time / Q;
    // What is left of the flight does not depend on the charge at its start.
    if (key == battery_key::charge.path) result.by_parameter[k] = Q / flight.rows.front().metrics[Metric::current_mean];
  }
  return result;
}

}  // namespace wingbeat

#include "study/throttled_gradient.hpp"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>

#include "study/flight_moment.hpp"
#include "study/hover_throttle.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/study/hold.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::detail {
namespace {

/// At one state of charge: open-circuit voltage E [V], source resistance R [ohm], mean current I from the battery [A],
/// and derivatives.
struct Moment {
  double E, R, I;
  std::vector<double> by_E, by_R, by_I;
};

class ThrottledGradient {
 public:
  ThrottledGradient(const Design<double>& design, Condition condition, double tolerance,
                    std::span<const DesignParameter> parameters)
      : design_(design),
        condition_(condition),
        steady_{std::max(0.01 * tolerance, 1e-12), false, reporting_of(design)},
        throttle_(steady_.reporting.mass * standard_gravity, steady_, std::max(0.1 * tolerance, 1e-12)),
        parameters_(parameters) {
    set_full_duty(design_.supply);
  }

  /// Empty where there is no flapping, or it has no derivatives.
  std::optional<Moment> moment_at(double charge) {
    const Design<double> d = design_at(charge);
    const ThrottledFlapping found = throttle_.find(resolve(d, condition_), {}, {});
    const SteadyFlapping& orbit = found.flapping;
    if (orbit.status != FlappingStatus::flapping || orbit.record.empty()) return std::nullopt;
    const MetricGradients g = metric_gradients(d, condition_, orbit, parameters_, {Held::lift_to_weight, false, {}});
    if (!g.regular) return std::nullopt;
    const Metrics<double>& m = orbit.metrics;
    Moment moment{open_circuit_voltage(d.supply.battery, charge), source_resistance(d.supply.battery), 0.0, {}, {}, {}};
    const double E = moment.E, R = moment.R, i = m[Metric::current_mean], D = found.voltage / E;
    const bool passed_on = std::isfinite(m[Metric::power_electronics]);
    moment.I = battery_current(m, D, E, R, passed_on);
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
      const auto [by_E, by_R] = of_battery(d, parameters_[k]);
      const auto by = [&](Metric metric) { return g.by_parameter[k][std::size_t(metric)]; };
      double by_I;
      if (passed_on) {  // (E - R I) I = P
        by_I = (by(Metric::power_electrical) - moment.I * by_E + square(moment.I) * by_R) / (E - 2.0 * R * moment.I);
      } else {  // mean(v) = D (E - D R mean(i))
        const double by_D = (by(Metric::voltage) - D * by_E + square(D) * (i * by_R + R * by(Metric::current_mean))) /
                            (E - 2.0 * D * R * i);
        by_I = by_D * i + D * by(Metric::current_mean);
      }
      moment.by_E.push_back(by_E);
      moment.by_R.push_back(by_R);
      moment.by_I.push_back(by_I);
    }
    return moment;
  }

  /// What is zero at the end: its derivatives by the parameters over that by the charge. Empty where there are none.
  std::vector<double> of_event(const FlownPart& part, const Moment& end) {
    std::vector<double> by;
    double by_charge = absent;
    const Design<double> d = design_at(part.end_charge);
    const double h = 3e-4 * (part.first_charge - part.end_charge);
    if (part.event == FlightEvent::cutoff) {  // E - R I less the cut-off
      for (std::size_t k = 0; k < parameters_.size(); ++k) {
        const double cutoff = difference(d, parameters_[k], [](const Design<double>& moved) {
          const Battery<double>& b = moved.supply.battery;
          return b.cells * b.cutoff_voltage.value_or(0.0);
        });
        by.push_back(end.by_E[k] - end.by_R[k] * end.I - end.R * end.by_I[k] - cutoff);
      }
      const std::optional<Moment> before = moment_at(part.end_charge + h), first = moment_at(part.end_charge + 2.0 * h);
      if (!before || !first) return {};
      const auto terminals = [](const Moment& m) { return m.E - m.R * m.I; };
      by_charge = (4.0 * terminals(*before) - 3.0 * terminals(end) - terminals(*first)) / (2.0 * h);
    } else {  // lift over weight at a duty of 1
      const SteadyFlapping orbit = find_steady_flapping(resolve(d, condition_), steady_, {});
      if (orbit.status != FlappingStatus::flapping || orbit.record.empty()) return {};
      const MetricGradients g = metric_gradients(d, condition_, orbit, parameters_, {Held::voltage, false, {}});
      if (!g.regular) return {};
      for (const auto& of_metric : g.by_parameter) by.push_back(of_metric[std::size_t(Metric::lift_to_weight)]);
      const double fine = 1e-3 * h;
      const double later = open_circuit_voltage(d.supply.battery, part.end_charge + fine);
      by_charge = g.by_voltage[std::size_t(Metric::lift_to_weight)] * (later - end.E) / fine;
    }
    for (double& x : by) x /= by_charge;
    return by;
  }

 private:
  Design<double> design_at(double charge) const {
    Design<double> d = design_;
    d.supply.battery.charge = charge;
    return d;
  }

  /// Derivative of a plain function of the design by one of its numbers, by differences of rounding's accuracy.
  template <class Function>
  static double difference(const Design<double>& d, const DesignParameter& p, const Function& f) {
    const double x = p.value(d).value_or(absent), h = 1e-5 * std::max(std::abs(x), 1e-3);
    const auto moved = [&](double to) {
      Design<double> other = d;
      p.set(other, to);
      return f(other);
    };
    return (moved(x + h) - moved(x - h)) / (2.0 * h);
  }

  static std::pair<double, double> of_battery(const Design<double>& d, const DesignParameter& p) {
    const auto E = [](const Design<double>& moved) {
      return open_circuit_voltage(moved.supply.battery, moved.supply.battery.charge);
    };
    const auto R = [](const Design<double>& moved) { return source_resistance(moved.supply.battery); };
    return {difference(d, p, E), difference(d, p, R)};
  }

  Design<double> design_;
  Condition condition_;
  SteadyOptions steady_;
  HoverThrottle throttle_;
  std::span<const DesignParameter> parameters_;
};

/// The charge at which the battery has that open-circuit voltage.
double charge_of(const Battery<double>& battery, double voltage, double low, double high) {
  const auto excess = [&](double charge) { return open_circuit_voltage(battery, charge) - voltage; };
  if (excess(low) >= 0.0) return low;
  if (excess(high) <= 0.0) return high;
  std::uintmax_t rounds = 200;
  return boost::math::tools::toms748_solve(excess, low, high, boost::math::tools::eps_tolerance<double>(50), rounds)
      .first;
}

}  // namespace

std::vector<double> throttled_gradient(const Design<double>& design, Condition condition, double tolerance,
                                       std::span<const DesignParameter> parameters, const FlownPart& part) {
  const Battery<double>& battery = design.supply.battery;
  const double Q = battery.capacity, s_0 = part.first_charge, s_end = part.end_charge;
  const double E_0 = open_circuit_voltage(battery, s_0), E_end = open_circuit_voltage(battery, s_end);
  const VoltageNodes nodes(battery.discharge_curve.empty() ? E_0 : E_end, E_0);
  const std::vector<double> weights = nodes.integrals(battery, s_end, s_0);
  ThrottledGradient gradient(design, condition, tolerance, parameters);
  const std::vector<double> none(parameters.size(), absent);
  std::vector<double> result(parameters.size(), 0.0);
  double first_current = absent;
  // From the first charge on, the highest voltage, from where the throttle follows.
  for (std::size_t j = weights.size(); j-- > 0;) {
    const bool last = j == 0;
    const double s = last ? s_end : charge_of(battery, nodes.voltages()[j], s_end, s_0);
    const std::optional<Moment> moment = gradient.moment_at(s);
    if (!moment) return none;
    if (j + 1 == weights.size()) first_current = moment->I;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      result[k] -= Q * weights[j] / square(moment->I) * moment->by_I[k];
    }
    if (!last || part.event == FlightEvent::empty) continue;
    const std::vector<double> by = gradient.of_event(part, *moment);
    if (by.empty()) return none;
    for (std::size_t k = 0; k < parameters.size(); ++k) result[k] += Q / moment->I * by[k];
  }
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (parameters[k].key == battery_key::capacity.path) result[k] += part.time / Q;
    // What is left of the flight does not depend on the charge at its start.
    if (parameters[k].key == battery_key::charge.path) result[k] = Q / first_current;
  }
  return result;
}

}  // namespace wingbeat::detail

#include "wingbeat/cycle/orbit_gradient.hpp"

#include "wingbeat/cycle/cycle_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace wingbeat {
namespace {

using J = GradientJet;
constexpr int slots = gradient_slots;

constexpr Metric peak_metrics[] = {Metric::current_peak,           Metric::lift_peak,           Metric::rod_force_peak,
                                   Metric::flapping_velocity_peak, Metric::angle_of_attack_min, Metric::crank_speed_min,
                                   Metric::crank_speed_max};

void make_absent(J& x) { x.v.setConstant(absent); }

template <class System>
OrbitGradient differentiate(const SteadyFlapping& orbit, const RecordedCycle<System>& recorded,
                            const GradientVehicle& given, const GradientOptions& options) {
  Vehicle<J> vehicle = given.vehicle;
  vehicle.voltage.a = recorded.system.vehicle.voltage;
  vehicle.drive_frequency.a = recorded.system.vehicle.drive_frequency;
  // A direct drive's frequency is its supply's: no voltage follows it, and its slot is a third state's.
  const bool voltage_varies = drive_of(vehicle).voltage_sets_frequency;
  if (voltage_varies) vehicle.voltage.v[gradient_voltage_slot] = 1.0;
  CycleGradient<System> cycle(recorded, vehicle);
  OrbitGradient g;
  g.regular = cycle.run();
  CycleExtremes<J> extremes;
  extremes.fill(J(absent));
  if (options.peaks) extremes = cycle.extremes();
  g.metrics = cycle_metrics(vehicle, cycle.integrals(), extremes, J(orbit.metrics[Metric::floquet_multiplier_max]), {});
  const J bench = voltage_varies ? given.bench_torque_constant : J(absent);
  g.metrics[Metric::power_motor_reference] =
      two_pi * bench * g.metrics[Metric::frequency] * g.metrics[Metric::current_mean];
  g.metrics[Metric::lift_to_weight] = g.metrics[Metric::lift_mean] / (given.mass * standard_gravity);
  for (const double theta : options.crank_angles) g.instants.push_back(cycle.instant(theta));

  if (options.held == Held::frequency && voltage_varies) {
    const J f = g.metrics[Metric::frequency];
    if (!(std::abs(f.v[gradient_voltage_slot]) > 0.0)) g.regular = false;
    const auto follow = [&](J& x) {
      for (int k = gradient_first_slot; k < slots; ++k) {
        x.v[k] -= x.v[gradient_voltage_slot] * f.v[k] / f.v[gradient_voltage_slot];
      }
      x.v[gradient_voltage_slot] = 0.0;
    };
    for (J& m : g.metrics.values) follow(m);
    for (GradientInstant& at : g.instants) {
      for (J* x : {&at.crank_speed, &at.current, &at.flapping_velocity, &at.lift, &at.rod_force, &at.motor_torque}) {
        follow(*x);
      }
    }
  }
  make_absent(g.metrics[Metric::floquet_multiplier_max]);
  if (!options.peaks) {
    for (const Metric m : peak_metrics) g.metrics[m] = J(orbit.metrics[m]), make_absent(g.metrics[m]);
  }
  // A value is the orbit's own, to the last digit.
  for (int m = 0; m < metric_count; ++m) g.metrics.values[std::size_t(m)].a = orbit.metrics.values[std::size_t(m)];
  return g;
}

}  // namespace

GradientVehicle gradient_vehicle(const Design<GradientJet>& design, Condition condition) {
  GradientVehicle v;
  v.vehicle = resolve(design, condition);
  if (const auto mass = total_mass(design)) v.mass = *mass;
  if (design.bench_torque_constant) v.bench_torque_constant = *design.bench_torque_constant;
  return v;
}

OrbitGradient orbit_gradient(const SteadyFlapping& orbit, const GradientVehicle& vehicle,
                             const GradientOptions& options) {
  return std::visit([&](const auto& recorded) { return differentiate(orbit, recorded, vehicle, options); },
                    orbit.record.cycles());
}

MetricGradients metric_gradients(const Design<double>& design, Condition condition, const SteadyFlapping& orbit,
                                 std::span<const DesignParameter> parameters, const GradientOptions& options) {
  MetricGradients result;
  result.by_parameter.resize(parameters.size());
  if (orbit.record.empty()) {  // a cycle simulated in time is no cycle to be repeated
    result.regular = false;
    result.by_voltage.fill(absent);
    for (auto& gradient : result.by_parameter) gradient.fill(absent);
    return result;
  }
  const Design<GradientJet> plain = cast<GradientJet>(design);
  for (std::size_t first = 0; first == 0 || first < parameters.size(); first += gradient_parameters) {
    const std::size_t count = std::min<std::size_t>(gradient_parameters, parameters.size() - first);
    Design<GradientJet> seeded = plain;
    for (std::size_t k = 0; k < count; ++k) {
      const DesignParameter& p = parameters[first + k];
      const std::optional<double> value = p.value(design);
      if (!value || !p.set_jet(seeded, gradient_seed(*value, int(k)))) {
        throw ParameterError(p.key, "the vehicle does not have this parameter");
      }
    }
    const OrbitGradient g = orbit_gradient(orbit, gradient_vehicle(seeded, condition), options);
    result.regular = result.regular && g.regular;
    for (std::size_t m = 0; m < metric_count; ++m) {
      const auto& derivative = g.metrics.values[m].v;
      result.by_voltage[m] = drive_of(design).voltage_sets_frequency ? derivative[gradient_voltage_slot] : absent;
      for (std::size_t k = 0; k < count; ++k) {
        result.by_parameter[first + k][m] = derivative[gradient_first_slot + Eigen::Index(k)];
      }
    }
  }
  return result;
}

}  // namespace wingbeat

#include "wingbeat/cycle/orbit_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <vector>

#include "cycle/repeat_recorded.hpp"
#include "wingbeat/cycle/air_equilibrium.hpp"
#include "wingbeat/solve/linear.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

using J = GradientJet;
constexpr int slots = gradient_slots;

/// All numbers of a gradient.
template <class Visit>
void for_each_jet(OrbitGradient& g, const Visit& visit) {
  for (J& m : g.metrics.values) visit(m);
  for (GradientInstant& instant : g.instants) {
    for (J* x :
         {&instant.time, &instant.crank_speed, &instant.current, &instant.voltage, &instant.stroke_angle,
          &instant.flapping_velocity, &instant.pitch_angle, &instant.lift, &instant.rod_force, &instant.motor_torque}) {
      visit(*x);
    }
  }
}

/// Derivatives with the motor's constants at the temperatures of `vehicle`.
OrbitGradient repeat(const SteadyFlapping& orbit, const Vehicle<J>& vehicle, const GradientVehicle& given,
                     const GradientOptions& options) {
  return visit(orbit.record,
               [&](const auto& recorded) { return detail::repeat_recorded(orbit, recorded, vehicle, given, options); });
}

/// A vehicle and what stands beside it without derivatives, to be differentiated by something else.
Vehicle<J> as_constants(Vehicle<J> vehicle) {
  for_each_number(vehicle, [](J& x) { x.v.setZero(); });
  return vehicle;
}
GradientVehicle as_constants(GradientVehicle given) {
  for (J* x : {&given.mass, &given.bench_torque_constant}) x->v.setZero();
  return given;
}

/// Adds to the derivatives `g` at two given numbers what they change, which are the fixed point x = G(x, p):
/// dx/dp = (I - dG/dx)^-1 dG/dp. `by_both` holds the derivatives by them in the first two slots of parameters, G is
/// read from either by `settled`.
template <class Settled>
void follow(OrbitGradient& g, OrbitGradient& by_both, const Settled& settled) {
  g.regular = g.regular && by_both.regular;
  constexpr int first = gradient_first_slot, second = gradient_first_slot + 1;
  const std::array<J, 2> G = settled(g), slope = settled(by_both);
  std::array<std::array<double, 2>, slots> change{};
  for (int k = gradient_voltage_slot; k < slots; ++k) {
    double matrix[4] = {1.0 - slope[0].v[first], -slope[0].v[second], -slope[1].v[first], 1.0 - slope[1].v[second]};
    double dx[2] = {G[0].v[k], G[1].v[k]};
    if (!solver::solve_linear(2, matrix, dx)) g.regular = false;
    change[std::size_t(k)] = {dx[0], dx[1]};
  }
  std::vector<J> slopes;
  for_each_jet(by_both, [&](const J& x) { slopes.push_back(x); });
  std::size_t n = 0;
  for_each_jet(g, [&](J& x) {
    const J& by = slopes[n++];
    for (int k = gradient_voltage_slot; k < slots; ++k) {
      x.v[k] += by.v[first] * change[std::size_t(k)][0] + by.v[second] * change[std::size_t(k)][1];
    }
  });
}

/// The derivatives with the motor's temperatures following.
OrbitGradient repeat_warm(const SteadyFlapping& orbit, const Vehicle<J>& vehicle, const GradientVehicle& given,
                          const GradientOptions& options) {
  if (!heats_up(vehicle.thermal)) return repeat(orbit, vehicle, given, options);
  const MotorTemperatures<J> temperatures{J(orbit.temperatures.winding), J(orbit.temperatures.casing)};
  OrbitGradient g = repeat(orbit, with_motor_at(vehicle, temperatures), given, options);
  // Under thermal runaway the temperatures are the last that were looked at, and no fixed point.
  if (orbit.temperatures.winding >= copper_melting_point) {
    g.regular = false;
    return g;
  }
  const Vehicle<J> seeded = with_motor_at(as_constants(vehicle), {gradient_seed(orbit.temperatures.winding, 0),
                                                                  gradient_seed(orbit.temperatures.casing, 1)});
  OrbitGradient by_temperature = repeat(orbit, seeded, as_constants(given), options);
  follow(g, by_temperature, [](const OrbitGradient& g_at) {
    return std::array<J, 2>{g_at.metrics[Metric::winding_temperature], g_at.metrics[Metric::case_temperature]};
  });
  return g;
}

/// The derivatives with the air following, too, that settles around the orbit.
OrbitGradient repeat_settled(const SteadyFlapping& orbit, Vehicle<J> vehicle, const GradientVehicle& given,
                             const GradientOptions& options) {
  const Vehicle<double>& found = orbit.record.vehicle();
  if (!settles_air(found)) return repeat_warm(orbit, vehicle, given, options);
  const bool has_wake = has_induced_velocity(found.wings.wake);
  const bool reverses = claps(found.wings.clap) && !drive_of(found).stroke_is_fixed;
  if (has_wake) vehicle.wings.wake.velocity = J(found.wings.wake.velocity);
  if (reverses) vehicle.wings.clap.reversal = J(found.wings.clap.reversal);
  OrbitGradient g = repeat_warm(orbit, vehicle, given, options);
  Vehicle<J> seeded = as_constants(vehicle);
  if (has_wake) seeded.wings.wake.velocity = gradient_seed(found.wings.wake.velocity, 0);
  if (reverses) seeded.wings.clap.reversal = gradient_seed(found.wings.clap.reversal, 1);
  OrbitGradient by_air = repeat_warm(orbit, seeded, as_constants(given), options);
  follow(g, by_air, [&](const OrbitGradient& g_at) {
    return std::array<J, 2>{has_wake ? g_at.metrics[Metric::induced_velocity] : J(0.0),
                            reverses ? g_at.metrics[Metric::stroke_angle_max] : J(0.0)};
  });
  return g;
}

}  // namespace

OrbitGradient orbit_gradient(const SteadyFlapping& orbit, const GradientVehicle& given,
                             const GradientOptions& options) {
  Vehicle<J> vehicle = given.vehicle;
  const double voltage = orbit.record.vehicle().voltage;
  const bool by_duty = options.held != Held::voltage && vehicle.source_resistance.a > 0.0;
  if (by_duty) {
    // Of a battery the duty follows: voltage and, with its square, resistance.
    const double ratio = voltage / vehicle.voltage.a;
    vehicle.voltage = vehicle.voltage * ratio;
    vehicle.source_resistance = vehicle.source_resistance * square(ratio);
  }
  vehicle.voltage.a = voltage;
  vehicle.drive_frequency.a = orbit.record.vehicle().drive_frequency;
  // A direct drive's frequency is its supply's: no voltage follows it, and its slot is a third state's.
  const bool voltage_varies = drive_of(vehicle).voltage_sets_frequency;
  if (voltage_varies) vehicle.voltage.v[gradient_voltage_slot] = 1.0;
  if (by_duty) vehicle.source_resistance.v[gradient_voltage_slot] = 2.0 * vehicle.source_resistance.a / voltage;
  OrbitGradient g = repeat_settled(orbit, vehicle, given, options);

  if (options.held != Held::voltage && voltage_varies) {
    const J held = g.metrics[metric_of(options.held)];
    if (!(std::abs(held.v[gradient_voltage_slot]) > 0.0)) g.regular = false;
    const auto hold = [&](J& x) {
      for (int k = gradient_first_slot; k < slots; ++k) {
        x.v[k] -= x.v[gradient_voltage_slot] * held.v[k] / held.v[gradient_voltage_slot];
      }
      x.v[gradient_voltage_slot] = 0.0;
    };
    for_each_jet(g, hold);
  }
  detail::make_absent(g.metrics[Metric::floquet_multiplier_max]);
  if (!options.peaks) {
    const Drive drive = drive_of(vehicle);
    for (int m = 0; m < metric_count; ++m) {
      if (is_peak(Metric(m), drive)) detail::make_absent(g.metrics.values[std::size_t(m)]);
    }
  }
  // A value is the orbit's own, to the last digit.
  for (int m = 0; m < metric_count; ++m) g.metrics.values[std::size_t(m)].a = orbit.metrics.values[std::size_t(m)];
  return g;
}

bool is_peak(Metric which, const Drive& drive) {
  switch (which) {
    case Metric::current_peak:
    case Metric::lift_peak:
    case Metric::rod_force_peak:
    case Metric::flapping_velocity_peak:
    case Metric::angle_of_attack_min:
    case Metric::angle_of_attack_max:
    case Metric::pitch_amplitude:
    case Metric::pitch_phase:
    case Metric::crank_speed_min:
    case Metric::crank_speed_max: return true;
    case Metric::stroke_amplitude: return !drive.stroke_is_fixed;
    default: return false;
  }
}

GradientVehicle gradient_vehicle(const Design<GradientJet>& design, Condition condition) {
  GradientVehicle v;
  v.vehicle = resolve(design, condition);
  if (const auto mass = total_mass(design)) v.mass = *mass;
  if (design.bench_torque_constant) v.bench_torque_constant = *design.bench_torque_constant;
  return v;
}

namespace {

/// Lets a direct drive's voltage follow, so that a metric is held: it has no slot of its own.
void follow_amplitude(GradientVehicle vehicle, const SteadyFlapping& orbit, const GradientOptions& options,
                      MetricGradients& result) {
  vehicle.vehicle.voltage = gradient_seed(orbit.record.vehicle().voltage, 0);
  const OrbitGradient g = orbit_gradient(orbit, vehicle, {Held::voltage, options.peaks, {}});
  const auto slope = [&](std::size_t m) { return g.metrics.values[m].v[gradient_first_slot]; };
  const std::size_t held = std::size_t(metric_of(options.held));
  result.regular = result.regular && g.regular && std::abs(slope(held)) > 0.0;
  for (auto& gradient : result.by_parameter) {
    const double follows = gradient[held] / slope(held);
    for (std::size_t m = 0; m < metric_count; ++m) gradient[m] -= slope(m) * follows;
  }
}

/// metric_gradients() where C_alpha follows, so that the least angle of attack alpha stays: of a metric m
/// dm/dp - dm/dC dalpha/dp / (dalpha/dC), and by alpha itself dm/dC / (dalpha/dC).
MetricGradients gradients_at_angle(const Design<double>& design, Condition condition, const SteadyFlapping& orbit,
                                   std::span<const DesignParameter> parameters, GradientOptions options) {
  const bool peaks = options.peaks;
  options.angle_held = false;
  options.peaks = true;
  const auto is_angle = [](const DesignParameter& p) { return p.key == aerodynamics_key::angle_of_attack.path; };
  std::vector<DesignParameter> others;
  std::copy_if(parameters.begin(), parameters.end(), std::back_inserter(others), std::not_fn(is_angle));
  const Parameter<double>& C = numeric_parameter<double>(aerodynamics_key::pitch_coefficient.path);
  others.push_back({std::string(C.path), std::string(C.unit), C.set, numeric_parameter<J>(C.path).set, C.get});
  const MetricGradients g = metric_gradients(design, condition, orbit, others, options);
  const auto& by_C = g.by_parameter.back();
  constexpr std::size_t alpha = std::size_t(Metric::angle_of_attack_min);
  MetricGradients result;
  result.regular = g.regular && std::abs(by_C[alpha]) > 0.0;
  const auto follow = [&](std::array<double, metric_count> slopes) {
    const double follows = slopes[alpha] / by_C[alpha];
    for (std::size_t m = 0; m < metric_count; ++m) slopes[m] -= by_C[m] * follows;
    return slopes;
  };
  std::size_t next = 0;
  for (const DesignParameter& p : parameters) {
    if (!is_angle(p)) {
      result.by_parameter.push_back(follow(g.by_parameter[next++]));
      continue;
    }
    auto& slopes = result.by_parameter.emplace_back(by_C);
    for (double& x : slopes) x *= degrees_per_radian / by_C[alpha];
  }
  result.by_voltage = drive_of(design).voltage_sets_frequency ? follow(g.by_voltage) : g.by_voltage;
  for (int m = 0; !peaks && m < metric_count; ++m) {
    if (!is_peak(Metric(m), drive_of(design))) continue;
    result.by_voltage[std::size_t(m)] = absent;
    for (auto& slopes : result.by_parameter) slopes[std::size_t(m)] = absent;
  }
  return result;
}

}  // namespace

MetricGradients metric_gradients(const Design<double>& design, Condition condition, const SteadyFlapping& orbit,
                                 std::span<const DesignParameter> parameters, const GradientOptions& options) {
  if (options.angle_held && !orbit.record.empty()) {
    return gradients_at_angle(design, condition, orbit, parameters, options);
  }
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
  if (!drive_of(design).voltage_sets_frequency && options.held != Held::voltage && options.held != Held::frequency) {
    follow_amplitude(gradient_vehicle(plain, condition), orbit, options, result);
  }
  return result;
}

}  // namespace wingbeat

#include "wingbeat/flight/stability.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "flight/periodic_flight.hpp"
#include "wingbeat/solve/eigenvalues.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using Complex = std::complex<double>;
using detail::body_of, detail::shape_of, detail::states_of;

/// Rates of the states under mean loads.
FlightVector rates_under(const Body& body, const FlightVector& x, const BodyLoads& loads) {
  const MeanAcceleration a = mean_acceleration(body, body_of(x), loads);
  FlightVector rates;
  const double sine = std::sin(x[6]), cosine = std::cos(x[6]);
  rates << a.linear[0], a.linear[1], a.linear[2], a.angular[0], a.angular[1], a.angular[2],
      x[3] + (x[4] * sine + x[5] * cosine) * std::tan(x[7]), x[4] * cosine - x[5] * sine;
  return rates;
}

/// Steps of differences, small beside the tip's speed.
FlightVector steps_of(const AveragedFlight& flight, const TrimResult& steady) {
  const double R = flight.vehicle().drives[0].vehicle.wings.wake.strips.at.back().radius;
  const double rate = two_pi * steady.frequency, speed = rate * R;
  FlightVector steps;
  steps << FlightVector::Constant(1e-3);
  steps.head<3>() *= speed;
  steps.segment<3>(3) *= rate;
  return steps;
}

/// `loads`, of the state `from`, with what the air does to body, tail and fin in the state `to`.
BodyLoads with_plates_moved(const Body& body, BodyLoads loads, const FlightVector& from, const FlightVector& to) {
  const auto plates = [&](const FlightVector& x) {
    const SteadyMotion motion = motion_of(body_of(x));
    return plate_loads(body, motion.velocity, motion.rates);
  };
  const BodyLoads before = plates(from), after = plates(to);
  for (std::size_t n = 0; n < 3; ++n) {
    loads.force[n] += after.force[n] - before.force[n];
    loads.moment[n] += after.moment[n] - before.moment[n];
  }
  return loads;
}

/// d/dx_k of the rates by what the air does to body, tail and fin. Drag is kinked about rest, where its slope is 0, but
/// not that of a difference over the wings' step.
FlightVector slope_by_plates(const Body& body, const FlightVector& x, const BodyLoads& loads, Eigen::Index k,
                             double step) {
  const double small = 1e-6 * step;
  const auto rates = [&](double by) {
    FlightVector moved = x;
    moved[k] += by;
    return rates_under(body, x, with_plates_moved(body, loads, x, moved));
  };
  return (rates(small) - rates(-small)) / (2.0 * small);
}

/// Of `among`, those whose distances to `to` sum to the least, one for each; fewer where there are fewer.
std::vector<Complex> nearest_of(const std::vector<Complex>& to, const std::vector<Complex>& among) {
  std::vector<Complex> best;
  double least = infinity;
  std::vector<std::size_t> taken;
  const auto search = [&](const auto& self, std::size_t n, double sum) -> void {
    if (sum >= least) return;
    if (n == std::min(to.size(), among.size())) {
      least = sum;
      best.clear();
      for (const std::size_t k : taken) best.push_back(among[k]);
      return;
    }
    for (std::size_t k = 0; k < among.size(); ++k) {
      if (std::find(taken.begin(), taken.end(), k) != taken.end()) continue;
      taken.push_back(k);
      self(self, n + 1, sum + std::abs(among[k] - to[n]));
      taken.pop_back();
    }
  };
  search(search, 0, 0.0);
  return best;
}

/// Of complex pairs the upper ones, the fastest growing first.
std::vector<Complex> upper_ones(std::vector<Complex> values) {
  std::erase_if(values, [](const Complex& s) { return s.imag() < 0.0; });
  std::sort(values.begin(), values.end(), [](const Complex& a, const Complex& b) { return a.real() > b.real(); });
  return values;
}

double growth_of(const FlightMode& mode) { return mode.averaged ? mode.averaged->real() : mode.floquet->real(); }

/// Adds the modes of one kind of motion, both ways beside each other.
void add_modes(bool longitudinal, const FlightVector& steps, StabilityResult& result) {
  const solver::EigenModes modes = solver::eigen_modes(result.model->A);
  std::vector<Complex> averaged, exponents;
  std::vector<std::pair<Complex, std::string>> shapes;
  for (Eigen::Index n = 0; n < 8; ++n) {
    bool along = false;
    const std::string shape = shape_of(modes.vectors.col(n), steps, along);
    if (along != longitudinal) continue;
    averaged.push_back(modes.values[n]);
    shapes.push_back({averaged.back(), shape});
  }
  if (result.periodic) {
    for (std::size_t n = 0; n < result.periodic->multipliers.size(); ++n) {
      const Complex multiplier = result.periodic->multipliers[n];
      if (result.periodic->longitudinal[n] != longitudinal || !(std::abs(multiplier) > 1e-12)) continue;
      exponents.push_back(std::log(multiplier) / result.periodic->period);
    }
    exponents = upper_ones(nearest_of(averaged, exponents));
  }
  averaged = upper_ones(averaged);
  for (std::size_t n = 0; n < std::max(averaged.size(), exponents.size()); ++n) {
    FlightMode mode;
    mode.longitudinal = longitudinal;
    if (n < averaged.size()) {
      mode.averaged = averaged[n];
      for (const auto& [value, shape] : shapes) {
        if (value == averaged[n]) mode.shape = shape;
      }
    }
    if (n < exponents.size()) mode.floquet = exponents[n];
    result.modes.push_back(mode);
  }
}

/// Modes of both kinds, the least stable first.
void add_all_modes(const FlightVector& steps, StabilityResult& result) {
  for (const bool longitudinal : {true, false}) add_modes(longitudinal, steps, result);
  std::stable_sort(result.modes.begin(), result.modes.end(),
                   [](const FlightMode& a, const FlightMode& b) { return growth_of(a) > growth_of(b); });
}

Complex least_stable(const FlightMatrix& A) {
  const Eigen::VectorXcd values = solver::eigenvalues_of(A);
  Complex found = values[0];
  for (const Complex& value : values) {
    if (value.real() > found.real() + 1e-12 || (value.real() > found.real() - 1e-12 && value.imag() > found.imag())) {
      found = value;
    }
  }
  return found;
}

}  // namespace

FlightVector steady_states(const TrimResult& steady) {
  return states_of(steady_body(steady.condition, steady.roll, steady.pitch));
}

std::optional<FlightLinearModel> linear_flight(AveragedFlight& flight, const TrimResult& steady) {
  if (!steady.flies()) return std::nullopt;
  const Body& body = flight.vehicle().body;
  const FlightVector trimmed = steady_states(steady), steps = steps_of(flight, steady);
  FlightLinearModel model;
  const auto rates_at = [&](const FlightVector& x, const FlightControls& controls) -> std::optional<FlightVector> {
    const std::optional<MeanFlight> mean = flight.at(controls, motion_of(body_of(x)));
    if (!mean) return std::nullopt;
    return rates_under(body, x, with_plates_moved(body, mean->loads, x, trimmed));
  };
  for (Eigen::Index k = 0; k < 8; ++k) {
    FlightVector above = trimmed, below = trimmed;
    above[k] += steps[k], below[k] -= steps[k];
    std::optional<FlightVector> high, low;
    if (k < 6) {
      high = rates_at(above, steady.controls), low = rates_at(below, steady.controls);
    } else {
      // Attitude turns gravity alone.
      high = rates_under(body, above, steady.flight->loads), low = rates_under(body, below, steady.flight->loads);
    }
    if (!high || !low) return std::nullopt;
    model.A.col(k) = (*high - *low) / (2.0 * steps[k]);
    if (k < 6) model.A.col(k) += slope_by_plates(body, trimmed, steady.flight->loads, k, steps[k]);
  }
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    if (flight.vehicle().ranges[k].given()) model.controls.push_back(FlightControl(k));
  }
  model.B.resize(8, Eigen::Index(model.controls.size()));
  for (std::size_t k = 0; k < model.controls.size(); ++k) {
    const ControlRange& range = flight.vehicle().ranges[std::size_t(model.controls[k])];
    const double step = 2e-3 * (range.high - range.low);
    FlightControls above = steady.controls, below = steady.controls;
    above[model.controls[k]] += step, below[model.controls[k]] -= step;
    const std::optional<FlightVector> high = rates_at(trimmed, above), low = rates_at(trimmed, below);
    if (!high || !low) return std::nullopt;
    model.B.col(Eigen::Index(k)) = (*high - *low) / (2.0 * step);
  }
  // What acts depends on the velocity through the air: on the body's less the wind's. A also has v' = ... - omega x v.
  model.W = -model.A.leftCols<3>();
  const FlightVector& x = trimmed;
  Eigen::Matrix3d turning;
  turning << 0.0, -x[5], x[4], x[5], 0.0, -x[3], -x[4], x[3], 0.0;
  model.W.topRows<3>() -= turning;
  return model;
}

std::vector<FlightMode> averaged_modes(AveragedFlight& flight, const TrimResult& steady) {
  StabilityResult result;
  result.model = linear_flight(flight, steady);
  if (result.model) add_all_modes(steps_of(flight, steady), result);
  return result.modes;
}

StabilityResult flight_stability(AveragedFlight& flight, const TrimResult& steady) {
  StabilityResult result;
  result.trim = steady;
  result.model = linear_flight(flight, steady);
  if (!result.model) {
    result.periodic_detail = "the vehicle does not flap near the trim";
    return result;
  }
  const FlightVector steps = steps_of(flight, steady);
  result.periodic = detail::periodic_flight(flight.vehicle(), steady, *result.model, steps, flight.options().tolerance,
                                            result.periodic_detail);
  add_all_modes(steps, result);
  return result;
}

double FlightMode::apart() const {
  if (!averaged || !floquet || (averaged->imag() == 0.0) != (floquet->imag() == 0.0)) return absent;
  return std::abs(*floquet - *averaged) / std::abs(*averaged);
}

std::vector<ModeSensitivity> mode_sensitivities(const Design<double>& design, const FlightCondition& condition,
                                                const TrimOptions& options,
                                                const std::vector<std::string>& parameters) {
  constexpr double share = 0.005;
  std::vector<ModeSensitivity> found;
  AveragedFlight stated(flight_vehicle(design), options.cycle);
  const TrimResult near = trim(stated, condition, options);
  if (!near.flies()) return found;
  const auto eigenvalue = [&](const Parameter<double>& parameter, double value) -> std::optional<Complex> {
    Design<double> changed = design;
    if (!parameter.set(changed, value)) return std::nullopt;
    try {
      validate(changed);
      AveragedFlight flight(flight_vehicle(changed), options.cycle);
      const TrimResult steady = trim(flight, condition, options, &near);
      if (!steady.flies()) return std::nullopt;
      const std::optional<FlightLinearModel> model = linear_flight(flight, steady);
      if (!model) return std::nullopt;
      return least_stable(model->A);
    } catch (const ParameterError&) {
      return std::nullopt;
    }
  };
  for (const Parameter<double>& parameter : parameter_table<double>()) {
    if (!parameter.set || parameter.path.starts_with("body.control") || parameter.path.starts_with("supply.")) continue;
    if (!parameters.empty() && std::find(parameters.begin(), parameters.end(), parameter.path) == parameters.end()) {
      continue;
    }
    const std::optional<double> value = parameter.get(design);
    if (!value || *value == 0.0) continue;
    const std::optional<Complex> high = eigenvalue(parameter, *value * (1.0 + share));
    const std::optional<Complex> low = eigenvalue(parameter, *value * (1.0 - share));
    if (!high || !low) continue;
    found.push_back({std::string(parameter.path), *value, *high, (high->real() - low->real()) / (2.0 * share)});
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return std::abs(a.slope) > std::abs(b.slope); });
  return found;
}

}  // namespace wingbeat

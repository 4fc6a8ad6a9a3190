#include "wingbeat/flight/stability.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/vehicle/unknowns.hpp"

namespace wingbeat {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;
using Complex = std::complex<double>;

FlightVector states_of(const BodyState& body) {
  FlightVector x;
  const Triple angles = euler_angles(body.attitude);
  x << body.velocity[0], body.velocity[1], body.velocity[2], body.rates[0], body.rates[1], body.rates[2], angles[0],
      angles[1];
  return x;
}
BodyState body_of(const FlightVector& x) {
  BodyState body;
  body.velocity = {x[0], x[1], x[2]};
  body.rates = {x[3], x[4], x[5]};
  body.attitude = attitude_of({x[6], x[7], 0.0});
  return body;
}

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
FlightVector steps_of(const AveragedFlight& flight, const TrimResult& at) {
  const double R = flight.vehicle().drives[0].vehicle.wings.wake.strips.at.back().radius;
  const double rate = two_pi * at.frequency, speed = rate * R;
  FlightVector steps;
  steps << FlightVector::Constant(1e-3);
  steps.head<3>() *= speed;
  steps.segment<3>(3) *= rate;
  return steps;
}

constexpr bool is_longitudinal(std::size_t state) { return state == 0 || state == 2 || state == 4 || state == 7; }

std::string shape_of(const Eigen::VectorXcd& vector, const FlightVector& steps, bool& longitudinal) {
  std::vector<std::pair<double, std::size_t>> sizes;
  double along = 0.0, across = 0.0;
  for (std::size_t k = 0; k < flight_state_count; ++k) {
    const double size = std::abs(vector[Eigen::Index(k)]) / steps[Eigen::Index(k)];
    sizes.push_back({size, k});
    (is_longitudinal(k) ? along : across) += size;
  }
  longitudinal = along >= across;
  std::sort(sizes.rbegin(), sizes.rend());
  std::string names;
  for (const auto& [size, k] : sizes) {
    if (size < 0.3 * sizes[0].first) break;
    const std::string name = flight_state_names[k];
    names += (names.empty() ? "" : ", ") + name.substr(0, name.find('_'));
  }
  return names;
}

/// The flight over one wingbeat as a map of drives and body.
class FlightMap {
 public:
  FlightMap(const FlightVehicle& vehicle, const FlightControls& controls, double tolerance)
      : simulation_(vehicle, {.tolerance = tolerance}), crank_(!vehicle.direct) {
    simulation_.command(controls);
    for (const FlightDrive& drive : vehicle.drives) indices_.emplace_back(drive.vehicle);
    if (!crank_) period_ = 1.0 / vehicle.drives[0].vehicle.drive_frequency;
  }

  Eigen::Index count() const {
    Eigen::Index n = Eigen::Index(flight_state_count);
    for (const UnknownIndices& indices : indices_) n += Eigen::Index(indices.count);
    return n;
  }
  bool crank() const { return crank_; }
  double period(const VectorXd& z) const { return crank_ ? z[0] : period_; }

  /// Drives, one after the other, of a crank with the period in the place of its angle, then the body.
  VectorXd start(const TrimResult& at) {
    VectorXd z(count());
    Eigen::Index next = 0;
    for (std::size_t n = 0; n < indices_.size(); ++n) {
      const DriveCycle& cycle = at.flight->cycles[n];
      indices_[n].unknowns(cycle.start, z.data() + next);
      angle_ = cycle.start.angle;
      if (crank_) z[next] = cycle.period;
      next += Eigen::Index(indices_[n].count);
    }
    z.tail<8>() = states_of(steady_body(at.condition, at.roll, at.pitch));
    return z;
  }
  /// End less start; of a crank its angle less a turn in the place of the period.
  VectorXd mismatch(const VectorXd& z) {
    std::vector<Coordinates<double>> drives;
    Eigen::Index next = 0;
    VectorXd from = z;
    for (const UnknownIndices& indices : indices_) {
      if (crank_) from[next] = angle_;
      drives.push_back(indices.coordinates(from.data() + next));
      next += Eigen::Index(indices.count);
    }
    simulation_.start(body_of(z.tail<8>()), drives);
    if (!(period(z) > 0.0) || !simulation_.step_to(period(z))) throw std::runtime_error("the mechanism jams");
    const FlightState to = simulation_.state();
    VectorXd end(count());
    next = 0;
    for (std::size_t n = 0; n < indices_.size(); ++n) {
      indices_[n].unknowns(to.drives[n], end.data() + next);
      next += Eigen::Index(indices_[n].count);
    }
    end.tail<8>() = states_of(to.body);
    VectorXd gap = end - from;
    if (crank_) gap[0] -= two_pi;
    return gap;
  }
  /// Mean of the states over a period from z, by Simpson's rule.
  FlightVector mean(const VectorXd& z) {
    constexpr int parts = 64;
    mismatch(z);  // sets the start
    std::vector<Coordinates<double>> drives;
    FlightVector sum = FlightVector::Zero();
    VectorXd from = z;
    Eigen::Index next = 0;
    for (const UnknownIndices& indices : indices_) {
      if (crank_) from[next] = angle_;
      drives.push_back(indices.coordinates(from.data() + next));
      next += Eigen::Index(indices.count);
    }
    simulation_.start(body_of(z.tail<8>()), drives);
    const double T = period(z);
    for (int k = 0; k <= parts; ++k) {
      if (k > 0) simulation_.step_to(T * k / parts);
      const double weight = k == 0 || k == parts ? 1.0 : k % 2 == 1 ? 4.0 : 2.0;
      sum += weight / (3.0 * parts) * states_of(simulation_.state().body);
    }
    return sum;
  }

 private:
  FlightSimulation simulation_;
  std::vector<UnknownIndices> indices_;
  bool crank_;
  double period_ = 0.0, angle_ = 0.0;
};

VectorXd sizes_for(const FlightMap& map, const VectorXd& z, const FlightVector& steps) {
  VectorXd sizes(z.size());
  const double rate = two_pi / map.period(z);
  for (Eigen::Index n = 0; n < z.size(); ++n) sizes[n] = std::max(std::abs(z[n]), 1e-3);
  if (map.crank()) sizes[0] = map.period(z);
  for (Eigen::Index n = 1; n < z.size() - 8; ++n) sizes[n] = std::max(sizes[n], 0.01 * rate);
  sizes.tail<8>() = 1e3 * steps;
  return sizes;
}

std::optional<PeriodicFlight> periodic_flight(const FlightVehicle& vehicle, const TrimResult& at,
                                              const FlightVector& steps, double tolerance, std::string& detail) {
  if (!vehicle.direct && vehicle.drives.size() > 1) {
    detail = "the cranks of two motors have no common cycle";
    return std::nullopt;
  }
  try {
    constexpr int max_iterations = 20;
    FlightMap map(vehicle, at.controls, tolerance);
    VectorXd z = map.start(at);
    VectorXd gap = map.mismatch(z);
    MatrixXd slopes;
    double off = infinity;
    const auto linearise = [&](double share, bool central) {
      const VectorXd sizes = sizes_for(map, z, steps);
      slopes.resize(z.size(), z.size());
      for (Eigen::Index n = 0; n < z.size(); ++n) {
        VectorXd above = z, below = z;
        above[n] += share * sizes[n];
        below[n] -= share * sizes[n];
        slopes.col(n) = central ? VectorXd((map.mismatch(above) - map.mismatch(below)) / (2.0 * share * sizes[n]))
                                : VectorXd((map.mismatch(above) - gap) / (share * sizes[n]));
      }
    };
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      const VectorXd sizes = sizes_for(map, z, steps);
      VectorXd scaled = gap.cwiseQuotient(sizes);
      if (map.crank()) scaled[0] = gap[0] / two_pi;
      const double before = off;
      off = scaled.norm();
      if (off <= 100.0 * tolerance || (iteration > 3 && off > 0.5 * before && off < 1e-6)) break;
      if (slopes.size() == 0 || off > 0.2 * before) linearise(1e-5, false);
      VectorXd correction = slopes.partialPivLu().solve(gap);
      const double longest = correction.cwiseQuotient(sizes).cwiseAbs().maxCoeff();
      if (longest > 0.1) correction *= 0.1 / longest;
      z -= correction;
      gap = map.mismatch(z);
    }
    if (!(off <= 1e-6)) {
      detail = "no flight that repeats with the wingbeat was found near the trim";
      return std::nullopt;
    }
    linearise(1e-4, true);
    PeriodicFlight flight;
    flight.period = map.period(z);
    flight.mismatch = off;
    flight.mean = map.mean(z);
    MatrixXd monodromy = slopes;
    monodromy += MatrixXd::Identity(z.size(), z.size());
    if (map.crank()) {
      // At the same crank angle again: the time to it changes with the start.
      const Eigen::Index rest = z.size() - 1;
      monodromy = slopes.bottomRightCorner(rest, rest) + MatrixXd::Identity(rest, rest) -
                  slopes.col(0).tail(rest) * slopes.row(0).tail(rest) / slopes(0, 0);
    }
    const Eigen::EigenSolver<MatrixXd> found(monodromy);
    for (Eigen::Index n = 0; n < monodromy.rows(); ++n) {
      bool longitudinal = false;
      shape_of(found.eigenvectors().col(n).tail(8), steps, longitudinal);
      flight.multipliers.push_back(found.eigenvalues()[n]);
      flight.longitudinal.push_back(longitudinal);
    }
    return flight;
  } catch (const std::runtime_error&) {
    detail = "the flight over a wingbeat could not be integrated";
    return std::nullopt;
  }
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
  const Eigen::EigenSolver<FlightMatrix> modes(result.model->A);
  std::vector<Complex> averaged, exponents;
  std::vector<std::pair<Complex, std::string>> shapes;
  for (Eigen::Index n = 0; n < 8; ++n) {
    bool along = false;
    const std::string shape = shape_of(modes.eigenvectors().col(n), steps, along);
    if (along != longitudinal) continue;
    averaged.push_back(modes.eigenvalues()[n]);
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

Complex least_stable(const FlightMatrix& A) {
  const Eigen::VectorXcd values = A.eigenvalues();
  Complex found = values[0];
  for (const Complex& value : values) {
    if (value.real() > found.real() + 1e-12 || (value.real() > found.real() - 1e-12 && value.imag() > found.imag())) {
      found = value;
    }
  }
  return found;
}

}  // namespace

std::optional<FlightLinearModel> linear_flight(AveragedFlight& flight, const TrimResult& at) {
  if (!at.flight) return std::nullopt;
  const Body& body = flight.vehicle().body;
  const FlightVector trimmed = states_of(steady_body(at.condition, at.roll, at.pitch)), steps = steps_of(flight, at);
  FlightLinearModel model;
  const auto rates_at = [&](const FlightVector& x, const FlightControls& controls) -> std::optional<FlightVector> {
    const std::optional<MeanFlight> mean = flight.at(controls, motion_of(body_of(x)));
    if (!mean) return std::nullopt;
    return rates_under(body, x, mean->loads);
  };
  for (Eigen::Index k = 0; k < 8; ++k) {
    FlightVector above = trimmed, below = trimmed;
    above[k] += steps[k], below[k] -= steps[k];
    std::optional<FlightVector> high, low;
    if (k < 6) {
      high = rates_at(above, at.controls), low = rates_at(below, at.controls);
    } else {
      // Attitude turns gravity alone.
      high = rates_under(body, above, at.flight->loads), low = rates_under(body, below, at.flight->loads);
    }
    if (!high || !low) return std::nullopt;
    model.A.col(k) = (*high - *low) / (2.0 * steps[k]);
  }
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    if (flight.vehicle().ranges[k].given()) model.controls.push_back(FlightControl(k));
  }
  model.B.resize(8, Eigen::Index(model.controls.size()));
  for (std::size_t k = 0; k < model.controls.size(); ++k) {
    const ControlRange& range = flight.vehicle().ranges[std::size_t(model.controls[k])];
    const double step = 2e-3 * (range.high - range.low);
    FlightControls above = at.controls, below = at.controls;
    above[model.controls[k]] += step, below[model.controls[k]] -= step;
    const std::optional<FlightVector> high = rates_at(trimmed, above), low = rates_at(trimmed, below);
    if (!high || !low) return std::nullopt;
    model.B.col(Eigen::Index(k)) = (*high - *low) / (2.0 * step);
  }
  return model;
}

StabilityResult flight_stability(AveragedFlight& flight, const TrimResult& at) {
  StabilityResult result;
  result.trim = at;
  result.model = linear_flight(flight, at);
  if (!result.model) {
    result.periodic_detail = "the vehicle does not flap beside the trim";
    return result;
  }
  const FlightVector steps = steps_of(flight, at);
  result.periodic = periodic_flight(flight.vehicle(), at, steps, flight.options().tolerance, result.periodic_detail);
  for (const bool longitudinal : {true, false}) add_modes(longitudinal, steps, result);
  std::stable_sort(result.modes.begin(), result.modes.end(),
                   [](const FlightMode& a, const FlightMode& b) { return growth_of(a) > growth_of(b); });
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
  if (near.status != TrimStatus::trimmed && near.status != TrimStatus::beyond_controls) return found;
  const auto eigenvalue = [&](const Parameter<double>& parameter, double value) -> std::optional<Complex> {
    Design<double> changed = design;
    if (!parameter.set(changed, value)) return std::nullopt;
    try {
      validate(changed);
      AveragedFlight flight(flight_vehicle(changed), options.cycle);
      const TrimResult at = trim(flight, condition, options, &near);
      if (at.status != TrimStatus::trimmed && at.status != TrimStatus::beyond_controls) return std::nullopt;
      const std::optional<FlightLinearModel> model = linear_flight(flight, at);
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

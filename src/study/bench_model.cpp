#include "study/bench_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

const GradientJet& at(const GradientInstant& i, WaveformQuantity q) {
  const GradientJet* all[] = {&i.crank_speed, &i.current, &i.flapping_velocity, &i.lift, &i.rod_force, &i.motor_torque};
  return *all[int(q)];
}
double at(const WaveformRow& r, WaveformQuantity q) {
  const double all[] = {r.crank_speed, r.current, r.flapping_velocity, r.lift, r.rod_force, r.motor_torque};
  return all[int(q)];
}

/// What a crank that does not turn shows: a prediction far off, so that no fit gains by stalling a row.
double standing_still(const Observation& o, const Vehicle<double>& vehicle, const OperatingPoint& point) {
  if (point.given == Given::frequency) return 0.0;
  const double current = point.value / vehicle.motor.armature_resistance;
  if (o.quantity.waveform) return o.quantity.quantity == WaveformQuantity::current ? current : 0.0;
  switch (o.quantity.metric) {
    case Metric::voltage: return point.value;
    case Metric::current_mean:
    case Metric::current_peak:
    case Metric::current_rms: return current;
    case Metric::power_electrical: return point.value * current;
    default: return 0.0;
  }
}

}  // namespace

BenchModel::BenchModel(const BenchFit& fit, const ForEach& for_each) : fit_(fit), for_each_(for_each) {
  for (std::size_t l = 0; l < fit.logs.size(); ++l) {
    const BenchLog& log = fit.logs[l];
    for (std::size_t r = 0; r < log.rows.size(); ++r) {
      const BenchRow& row = log.rows[r];
      if (!log.waveform || r == 0) {
        points_.push_back({log.condition, log.springs, log.given, row.given, l, r, {}, {}, false});
      }
      OperatingPoint& point = points_.back();
      if (log.waveform) point.crank_angles.push_back(row.crank_angle);
      for (std::size_t c = 0; c < log.columns.size(); ++c) {
        if (std::isnan(row.values[c])) continue;
        point.observations.push_back(observations_.size());
        point.peaks = point.peaks || (!log.columns[c].waveform && is_peak(log.columns[c].metric, drive_of(fit.design)));
        observations_.push_back({l, r, c, log.columns[c], points_.size() - 1,
                                 log.waveform ? point.crank_angles.size() - 1 : 0, row.values[c]});
      }
    }
  }
  voltages_.assign(points_.size(), absent);
  frequency_slopes_.assign(points_.size(), absent);
  voltage_slopes_.assign(points_.size(), {});
  predictions_.resize(points_.size());
  orbits_.resize(points_.size());
  evaluations_.assign(points_.size(), 0);
  fitted_.assign(observations_.size(), absent);
  jacobian_ = Eigen::MatrixXd::Zero(Eigen::Index(observations_.size()), Eigen::Index(fit.parameters.size()));
}

int BenchModel::evaluations() const { return std::accumulate(evaluations_.begin(), evaluations_.end(), 0); }

Design<double> BenchModel::design_at(const std::vector<double>& x) const {
  Design<double> design = fit_.design;
  for (std::size_t k = 0; k < x.size(); ++k) fit_.parameters[k].parameter.set(design, x[k]);
  return design;
}

void BenchModel::evaluate(const std::vector<double>& x, bool derivatives) {
  if (x != x_) {
    x_ = x;
    derivatives_known_ = false;
    const Design<double> design = design_at(x);
    for_all(for_each_, points_.size(), [&](std::size_t n) { evaluate_point(n, design); });
  }
  if (derivatives && !derivatives_known_) {
    jacobian_.setZero();
    for (std::size_t first = 0; first < x.size(); first += gradient_parameters) {
      const std::size_t count = std::min<std::size_t>(gradient_parameters, x.size() - first);
      Design<GradientJet> seeded = cast<GradientJet>(design_at(x));
      for (std::size_t k = 0; k < count; ++k) {
        fit_.parameters[first + k].parameter.set_jet(seeded, gradient_seed(x[first + k], int(k)));
      }
      Design<GradientJet> springless = seeded;
      springless.spring = {};
      for_all(for_each_, points_.size(), [&](std::size_t n) {
        if (!predictions_[n].reached) return;
        differentiate_point(n, points_[n].springs ? seeded : springless, first, count);
      });
    }
    derivatives_known_ = true;
  }
}

SteadyFlapping BenchModel::orbit(std::size_t n, Vehicle<double>& vehicle, double voltage, const Reporting& reporting) {
  ++evaluations_[n];
  vehicle.voltage = voltage;
  return find_steady_flapping(vehicle, {.tolerance = fit_.tolerance, .stability = false, .reporting = reporting});
}

void BenchModel::evaluate_point(std::size_t n, Design<double> design) {
  const OperatingPoint& point = points_[n];
  if (!point.springs) design.spring = {};
  Vehicle<double> vehicle = resolve(design, point.condition);
  const Reporting reporting = reporting_of(design);
  SteadyFlapping& found = orbits_[n];
  Prediction& prediction = predictions_[n];
  prediction.refused.reset();
  if (point.given == Given::voltage) {
    found = orbit(n, vehicle, point.value, reporting);
  } else {
    found = orbit_at_frequency(n, vehicle, reporting, prediction.refused);
  }
  prediction.reached = found.status == FlappingStatus::flapping && !found.record.empty();
  prediction.status = found.status;
  prediction.evidence = found.evidence;
  for (const std::size_t o : point.observations) {
    const Observation& observation = observations_[o];
    double& value = fitted_[o];
    if (!prediction.reached) {
      value = standing_still(observation, vehicle, point);
    } else if (observation.quantity.waveform) {
      value = at(found.record.at(point.crank_angles[observation.instant]), observation.quantity.quantity);
    } else {
      value = found.metrics[observation.quantity.metric];
    }
  }
}

SteadyFlapping BenchModel::orbit_at_frequency(std::size_t n, Vehicle<double>& vehicle, const Reporting& reporting,
                                              std::optional<SearchFinding>& refused) {
  const double wanted = points_[n].value;
  if (!drive_of(vehicle).voltage_sets_frequency) {
    vehicle.drive_frequency = wanted;
    return orbit(n, vehicle, vehicle.voltage, reporting);
  }
  const double close = std::max(3.0 * fit_.tolerance, 1e-6);
  double& start = voltages_[n];
  double& slope = frequency_slopes_[n];
  const VoltageSlopes& known = voltage_slopes_[n];
  const Motor<double>& m = vehicle.motor;
  double v = start;
  if (std::isfinite(v) && std::isfinite(known.voltage)) {
    double moved = known.voltage;
    for (std::size_t k = 0; k < x_.size(); ++k) moved += known.by_parameter[k] * (x_[k] - known.x[k]);
    if (moved > 0.5 * v && moved < 2.0 * v) v = moved;
  }
  // At first half as much again as the motor needs without load.
  if (!std::isfinite(v)) {
    v = 1.5 * two_pi * wanted * (m.torque_constant + m.armature_resistance * m.viscous_damping / m.torque_constant);
  }
  double v_before = absent, f_before = absent;
  for (int iteration = 0; iteration < 10; ++iteration) {
    SteadyFlapping found = orbit(n, vehicle, v, reporting);
    if (found.status != FlappingStatus::flapping) break;
    const double f = found.metrics[Metric::frequency];
    if (std::isfinite(v_before) && f != f_before) slope = (f - f_before) / (v - v_before);
    if (std::abs(f / wanted - 1.0) < close) {
      start = v;
      return found;
    }
    if (!(slope > 0.0)) slope = f / v;
    v_before = v;
    f_before = f;
    v += (wanted - f) / slope;
    if (!(v > 0.3 * v_before && v < 3.0 * v_before)) break;
  }
  const FrequencySearch search = find_voltage_for_frequency(
      vehicle, wanted, {.tolerance = fit_.tolerance, .stability = false, .reporting = reporting});
  evaluations_[n] += search.evaluations;
  if (search.outcome != FrequencyOutcome::reached) {
    start = absent;
    SteadyFlapping none;
    none.metrics.values.fill(absent);
    none.status = search.status == FlappingStatus::flapping ? FlappingStatus::stalled : search.status;
    refused = search.finding;
    return none;
  }
  start = search.voltage;
  return orbit(n, vehicle, search.voltage, reporting);
}

void BenchModel::differentiate_point(std::size_t n, const Design<GradientJet>& seeded, std::size_t first,
                                     std::size_t count) {
  const OperatingPoint& point = points_[n];
  GradientVehicle vehicle = gradient_vehicle(seeded, point.condition);
  // The bench sets the voltage (or the frequency): a free supply voltage plays no part.
  vehicle.vehicle.voltage = GradientJet(vehicle.vehicle.voltage.a);
  if (point.given == Given::frequency) {
    vehicle.vehicle.drive_frequency = GradientJet(vehicle.vehicle.drive_frequency.a);
  }
  const OrbitGradient g = orbit_gradient(orbits_[n], vehicle,
                                         {.held = point.given == Given::voltage ? Held::voltage : Held::frequency,
                                          .peaks = point.peaks,
                                          .crank_angles = point.crank_angles});
  if (point.given == Given::frequency) {
    VoltageSlopes& slopes = voltage_slopes_[n];
    slopes.voltage = orbits_[n].metrics[Metric::voltage];
    slopes.x = x_;
    slopes.by_parameter.resize(x_.size(), 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      slopes.by_parameter[first + k] = g.metrics[Metric::voltage].v[gradient_first_slot + Eigen::Index(k)];
    }
  }
  for (const std::size_t o : point.observations) {
    const Observation& observation = observations_[o];
    const GradientJet& value = observation.quantity.waveform
                                   ? at(g.instants[observation.instant], observation.quantity.quantity)
                                   : g.metrics[observation.quantity.metric];
    for (std::size_t k = 0; k < count; ++k) {
      const double slope = value.v[gradient_first_slot + Eigen::Index(k)];
      jacobian_(Eigen::Index(o), Eigen::Index(first + k)) = g.regular && std::isfinite(slope) ? slope : 0.0;
    }
  }
}

}  // namespace wingbeat

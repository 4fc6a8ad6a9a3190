#include "study/bench_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "study/balance_response.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

/// A quantity of an instant: of a row, on dual numbers or along the cycle.
template <class Instant>
const auto& at(const Instant& i, WaveformQuantity q) {
  switch (q) {
    case WaveformQuantity::crank_speed: return i.crank_speed;
    case WaveformQuantity::current: return i.current;
    case WaveformQuantity::flapping_velocity: return i.flapping_velocity;
    case WaveformQuantity::lift:
    case WaveformQuantity::balance_force: return i.lift;
    case WaveformQuantity::rod_force: return i.rod_force;
    case WaveformQuantity::motor_torque: return i.motor_torque;
    case WaveformQuantity::stroke_angle: return i.stroke_angle;
    case WaveformQuantity::pitch_angle: return i.pitch_angle;
    case WaveformQuantity::voltage: return i.voltage;
  }
  return i.current;
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
      if (!log.waveform || r == 0 || row.burst != log.rows[r - 1].burst) {
        points_.push_back({log.condition, log.springs, log.given, row.given, l, r});
        points_.back().in_time = log.in_time;
        points_.back().drive_frequency = row.drive_frequency;
        for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
          const auto& b = fit.parameters[k].of_bench;
          if (b && b->kind == BenchUnknown::Kind::phase && b->log == l && b->burst == row.burst)
            points_.back().phase = k;
        }
      }
      OperatingPoint& point = points_.back();
      if (log.waveform) point.crank_angles.push_back(row.crank_angle);
      for (std::size_t c = 0; c < log.columns.size(); ++c) {
        if (std::isnan(row.values[c])) continue;
        point.observations.push_back(observations_.size());
        point.peaks = point.peaks || (!log.columns[c].waveform && is_peak(log.columns[c].metric, drive_of(fit.design)));
        const MeasuredQuantity& q = log.columns[c];
        point.on_balance = point.on_balance || (q.waveform && q.quantity == WaveformQuantity::balance_force);
        observations_.push_back(
            {l, r, c, q, points_.size() - 1, log.waveform ? point.crank_angles.size() - 1 : 0, row.values[c]});
        if (c < row.deviations.size()) observations_.back().deviation = row.deviations[c];
        for (std::size_t k = 0; k < fit.parameters.size() && q.waveform; ++k) {
          const auto& b = fit.parameters[k].of_bench;
          if (b && b->kind == BenchUnknown::Kind::zero && b->log == l && b->quantity == q.quantity) {
            observations_.back().zero = k;
          }
        }
      }
    }
  }
  voltages_.assign(points_.size(), absent);
  frequency_slopes_.assign(points_.size(), absent);
  voltage_slopes_.assign(points_.size(), {});
  predictions_.resize(points_.size());
  orbits_.resize(points_.size());
  thetas_.resize(points_.size());
  lifts_.resize(points_.size());
  evaluations_.assign(points_.size(), 0);
  fitted_.assign(observations_.size(), absent);
  jacobian_ = Eigen::MatrixXd::Zero(Eigen::Index(observations_.size()), Eigen::Index(fit.parameters.size()));
}

int BenchModel::evaluations() const { return std::accumulate(evaluations_.begin(), evaluations_.end(), 0); }

Design<double> BenchModel::design_at(const std::vector<double>& x) const {
  Design<double> design = fit_.design;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!fit_.parameters[k].of_bench) fit_.parameters[k].parameter.set(design, x[k]);
  }
  return design;
}

Balance BenchModel::balance_at(const std::vector<double>& x) const {
  Balance balance = fit_.balance.value_or(Balance{});
  for (std::size_t k = 0; k < x.size(); ++k) {
    const auto& b = fit_.parameters[k].of_bench;
    if (b && b->of_balance) balance.*b->of_balance->number = x[k];
  }
  return balance;
}

double BenchModel::periods(const OperatingPoint& point, std::size_t instant) const {
  const double phase = point.crank_angles[instant] + (point.phase ? x_[*point.phase] : 0.0);
  return phase / two_pi - std::floor(phase / two_pi);
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
    std::vector<std::size_t> of_vehicle;
    for (std::size_t k = 0; k < x.size(); ++k) {
      if (!fit_.parameters[k].of_bench) of_vehicle.push_back(k);
    }
    const std::span<const std::size_t> all = of_vehicle;
    for (std::size_t first = 0; first == 0 || first < all.size(); first += gradient_parameters) {
      const auto which = all.subspan(first, std::min<std::size_t>(gradient_parameters, all.size() - first));
      Design<GradientJet> seeded = cast<GradientJet>(design_at(x));
      for (std::size_t slot = 0; slot < which.size(); ++slot) {
        const std::size_t k = which[slot];
        fit_.parameters[k].parameter.set_jet(seeded, gradient_seed(x[k], int(slot)));
      }
      Design<GradientJet> springless = seeded;
      springless.spring = {};
      for_all(for_each_, points_.size(), [&](std::size_t n) {
        if (!predictions_[n].reached) return;
        differentiate_point(n, points_[n].springs ? seeded : springless, which);
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
  if (std::isfinite(point.drive_frequency)) vehicle.drive_frequency = point.drive_frequency;
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
  place_instants(n);
  std::optional<BalanceResponse> response;
  if (prediction.reached && point.on_balance) response.emplace(balance_at(x_), found.metrics[Metric::frequency]);
  for (const std::size_t o : point.observations) {
    const Observation& observation = observations_[o];
    double& value = fitted_[o];
    if (!prediction.reached) {
      value = standing_still(observation, vehicle, point);
    } else if (!observation.quantity.waveform) {
      value = found.metrics[observation.quantity.metric];
    } else if (observation.quantity.quantity == WaveformQuantity::balance_force) {
      value = response->reading(lifts_[n], instant_periods(n, observation.instant));
    } else {
      value = at(found.record.at(thetas_[n][observation.instant]), observation.quantity.quantity);
    }
    if (observation.zero) value += x_[*observation.zero];
  }
}

void BenchModel::place_instants(std::size_t n) {
  const OperatingPoint& point = points_[n];
  std::vector<double>& thetas = thetas_[n];
  thetas.clear();
  lifts_[n].clear();
  if (!predictions_[n].reached || point.crank_angles.empty()) return;
  const CycleRecord& record = orbits_[n].record;
  const double period = record.period();
  for (std::size_t k = 0; k < point.crank_angles.size(); ++k) {
    thetas.push_back(point.in_time ? record.phase_at(period * periods(point, k)) : point.crank_angles[k]);
  }
  if (!point.on_balance) return;
  std::vector<double> lift;
  for (int k = 0; k < balance_instants; ++k) {
    thetas.push_back(record.phase_at(period * k / balance_instants));
    lift.push_back(record.at(thetas.back()).lift);
  }
  lifts_[n] = BalanceResponse::harmonics_of(lift);
}

double BenchModel::instant_periods(std::size_t n, std::size_t instant) const {
  if (points_[n].in_time) return periods(points_[n], instant);
  const CycleRecord& record = orbits_[n].record;
  return record.at(thetas_[n][instant]).time / record.period();
}

SteadyFlapping BenchModel::orbit_at_frequency(std::size_t n, Vehicle<double>& vehicle, const Reporting& reporting,
                                              std::optional<SearchFinding>& refused) {
  const double wanted = points_[n].value;
  if (!drive_of(vehicle).voltage_sets_frequency) {
    vehicle.drive_frequency = wanted;
    return orbit(n, vehicle, fit_.logs[points_[n].log].amplitude.value_or(vehicle.voltage), reporting);
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

void BenchModel::differentiate_point(std::size_t n, const Design<GradientJet>& seeded,
                                     std::span<const std::size_t> which) {
  const OperatingPoint& point = points_[n];
  GradientVehicle vehicle = gradient_vehicle(seeded, point.condition);
  // The bench sets the voltage (or the frequency): a free supply voltage plays no part.
  vehicle.vehicle.voltage = GradientJet(vehicle.vehicle.voltage.a);
  if (point.given == Given::frequency || std::isfinite(point.drive_frequency)) {
    vehicle.vehicle.drive_frequency = GradientJet(vehicle.vehicle.drive_frequency.a);
    if (const auto amplitude = fit_.logs[point.log].amplitude) vehicle.vehicle.voltage = GradientJet(*amplitude);
  }
  const OrbitGradient g = orbit_gradient(orbits_[n], vehicle,
                                         {.held = point.given == Given::voltage ? Held::voltage : Held::frequency,
                                          .peaks = point.peaks,
                                          .crank_angles = thetas_[n]});
  const auto slope = [](const GradientJet& value, std::size_t slot) {
    return value.v[gradient_first_slot + Eigen::Index(slot)];
  };
  const auto set = [&](std::size_t o, std::size_t k, double derivative) {
    jacobian_(Eigen::Index(o), Eigen::Index(k)) = g.regular && std::isfinite(derivative) ? derivative : 0.0;
  };
  if (point.given == Given::frequency) {
    VoltageSlopes& slopes = voltage_slopes_[n];
    slopes.voltage = orbits_[n].metrics[Metric::voltage];
    slopes.x = x_;
    slopes.by_parameter.resize(x_.size(), 0.0);
    for (std::size_t s = 0; s < which.size(); ++s) {
      slopes.by_parameter[which[s]] = slope(g.metrics[Metric::voltage], s);
    }
  }
  const GradientJet& frequency = g.metrics[Metric::frequency];
  // An instant's time in periods, and how it moves with a parameter while its crank angle stays.
  const auto share_moves = [&](const GradientInstant& instant, std::size_t s) {
    return slope(instant.time, s) * frequency.a + instant.time.a * slope(frequency, s);
  };
  const auto at_fixed_share = [&](const GradientInstant& instant, WaveformQuantity q, std::size_t s) {
    return slope(at(instant, q), s) -
           at(instant.slopes, q) * share_moves(instant, s) / (instant.slopes.time * frequency.a);
  };
  std::optional<BalanceResponse> response;
  std::vector<std::vector<std::complex<double>>> lift_slopes;
  if (point.on_balance) {
    response.emplace(balance_at(x_), frequency.a);
    for (std::size_t s = 0; s < which.size(); ++s) {
      std::vector<double> lift;
      for (std::size_t k = point.crank_angles.size(); k < thetas_[n].size(); ++k) {
        lift.push_back(at_fixed_share(g.instants[k], WaveformQuantity::lift, s));
      }
      lift_slopes.push_back(BalanceResponse::harmonics_of(lift));
    }
  }
  for (const std::size_t o : point.observations) {
    const Observation& observation = observations_[o];
    if (observation.zero) set(o, *observation.zero, 1.0);
    if (!observation.quantity.waveform) {
      for (std::size_t s = 0; s < which.size(); ++s) {
        set(o, which[s], slope(g.metrics[observation.quantity.metric], s));
      }
      continue;
    }
    const WaveformQuantity q = observation.quantity.quantity;
    const GradientInstant& instant = g.instants[observation.instant];
    if (q == WaveformQuantity::balance_force) {
      const double time = instant_periods(n, observation.instant);
      const BalanceResponse::Slopes by = response->slopes(lifts_[n], time);
      for (std::size_t s = 0; s < which.size(); ++s) {
        double moved = response->reading(lift_slopes[s], time) + by.frequency * slope(frequency, s);
        if (!point.in_time) moved += by.periods * share_moves(instant, s);
        set(o, which[s], moved);
      }
      for (std::size_t k = 0; k < x_.size(); ++k) {
        const auto& b = fit_.parameters[k].of_bench;
        if (b && b->of_balance) set(o, k, by.balance.*b->of_balance->number);
      }
      if (point.phase) set(o, *point.phase, by.periods / two_pi);
      continue;
    }
    for (std::size_t s = 0; s < which.size(); ++s) {
      set(o, which[s], point.in_time ? at_fixed_share(instant, q, s) : slope(at(instant, q), s));
    }
    if (point.phase) set(o, *point.phase, at(instant.slopes, q) / (instant.slopes.time * frequency.a * two_pi));
  }
}

std::vector<double> BenchModel::course(std::size_t n, WaveformQuantity quantity, std::span<const double> places) const {
  const OperatingPoint& point = points_[n];
  const CycleRecord& record = orbits_[n].record;
  const double period = record.period();
  std::optional<BalanceResponse> response;
  if (quantity == WaveformQuantity::balance_force) response.emplace(balance_at(x_), 1.0 / period);
  std::vector<double> values;
  for (const double place : places) {  // from 0 to 1
    const double theta = point.in_time ? record.phase_at(period * place) : two_pi * place;
    const double time = point.in_time || !response ? place : record.at(theta).time / period;
    values.push_back(response ? response->reading(lifts_[n], time) : at(record.at(theta), quantity));
  }
  return values;
}

std::vector<double> BenchModel::aligned(std::vector<double> x) {
  evaluate(x, false);
  constexpr int shifts = 120;
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const OperatingPoint& point = points_[n];
    if (!point.phase || !predictions_[n].reached) continue;
    std::vector<double> places;
    for (int k = 0; k <= shifts; ++k) places.push_back(double(k) / shifts);
    // Sum of squares between the courses without their means, in units of what each was measured to vary.
    std::vector<double> squares(shifts, 0.0);
    const BenchLog& log = fit_.logs[point.log];
    for (std::size_t c = 0; c < log.columns.size(); ++c) {
      if (!log.columns[c].waveform) continue;
      std::vector<double> measured, phases;
      for (const std::size_t o : point.observations) {
        if (observations_[o].column != c) continue;
        measured.push_back(observations_[o].measured);
        phases.push_back(point.crank_angles[observations_[o].instant] / two_pi);
      }
      if (measured.size() < 3) continue;
      const std::vector<double> model = course(n, log.columns[c].quantity, places);
      double mean = 0.0, variance = 0.0;
      for (const double m : measured) mean += m / double(measured.size());
      for (const double m : measured) variance += square(m - mean);
      if (!(variance > 0.0)) continue;
      for (int s = 0; s < shifts; ++s) {
        std::vector<double> differences;
        double offset = 0.0;
        for (std::size_t k = 0; k < measured.size(); ++k) {
          const double place = phases[k] + double(s) / shifts, cell = shifts * (place - std::floor(place));
          const std::size_t left = std::min<std::size_t>(std::size_t(cell), shifts - 1);
          const double value = model[left] + (cell - double(left)) * (model[left + 1] - model[left]);
          differences.push_back(value - measured[k]);
          offset += differences.back() / double(measured.size());
        }
        for (const double d : differences) squares[std::size_t(s)] += square(d - offset) / variance;
      }
    }
    const auto best = std::min_element(squares.begin(), squares.end()) - squares.begin();
    x[*point.phase] = two_pi * double(best) / shifts;
  }
  return x;
}

std::vector<FittedCycle> BenchModel::cycles(int count) const {
  std::vector<FittedCycle> all;
  std::vector<double> places;
  for (int k = 0; k < count; ++k) places.push_back(double(k) / (count - 1));
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const OperatingPoint& point = points_[n];
    if (point.crank_angles.empty() || !predictions_[n].reached) continue;
    const BenchLog& log = fit_.logs[point.log];
    for (std::size_t c = 0; c < log.columns.size(); ++c) {
      if (!log.columns[c].waveform) continue;
      const WaveformQuantity q = log.columns[c].quantity;
      FittedCycle cycle{point.log,           point.row, c, point.in_time, point.phase ? x_[*point.phase] : 0.0,
                        course(n, q, places)};
      for (const std::size_t o : point.observations) {
        if (observations_[o].column != c || !observations_[o].zero) continue;
        for (double& value : cycle.values) value += x_[*observations_[o].zero];
        break;
      }
      all.push_back(std::move(cycle));
    }
  }
  return all;
}

}  // namespace wingbeat

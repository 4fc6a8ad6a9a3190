#include "study/voltage_trials.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

VoltageTrials::VoltageTrials(const Vehicle<double>& vehicle, const SteadyOptions& options, const StartUp& start_up,
                             SearchRange range, bool slopes, bool simulate)
    : vehicle_(vehicle), options_(options), start_up_(start_up), range_(range), slopes_(slopes), simulate_(simulate) {
  // The root finder must not see the solver's own error.
  closeness_ = std::max(0.1 * options.tolerance, 1e-13);
  options_.tolerance = std::max(0.01 * options.tolerance, 1e-12);
  options_.stability = false;
}

SteadyFlapping VoltageTrials::solve() const {
  if (simulate_) return find_steady_flapping(vehicle_, options_, start_up_);
  const SteadyFlapping found = find_steady_flapping(vehicle_, options_);
  const bool several = std::isfinite(found.evidence.other_amplitude);
  return several ? find_steady_flapping(vehicle_, options_, start_up_) : found;
}

VoltageTrial VoltageTrials::at(double voltage) {
  ++count_;
  vehicle_.voltage = voltage;
  const SteadyFlapping found = solve();
  VoltageTrial trial;
  trial.voltage = voltage;
  trial.status = found.status;
  trial.flaps = found.status == FlappingStatus::flapping;
  trial.evidence = found.evidence;
  if (!trial.flaps) return trial;

  const Metrics<double>& m = found.metrics;
  trial.frequency = m[Metric::frequency];
  trial.lift = m[Metric::lift_mean];
  trial.lift_peak = m[Metric::lift_peak];
  trial.pitching = 90.0 - m[Metric::angle_of_attack_min];
  trial.frequency_slope = 1.0;
  trial.lift_slope = 0.0;
  // A cycle that was simulated in time has no record to be differentiated.
  if (slopes_ && !found.record.empty()) {
    GradientVehicle seeded{cast<GradientJet>(vehicle_)};
    const bool has_slot = drive_of(vehicle_).voltage_sets_frequency;  // of its own, for the voltage
    if (!has_slot) seeded.vehicle.voltage = gradient_seed(voltage, 0);
    const OrbitGradient g = orbit_gradient(found, seeded, {.peaks = false});
    const int slot = has_slot ? gradient_voltage_slot : gradient_first_slot;
    const double f_slope = g.metrics[Metric::frequency].v[slot], lift_slope = g.metrics[Metric::lift_mean].v[slot];
    trial.exact = g.regular && std::isfinite(f_slope) && std::isfinite(lift_slope);
    if (trial.exact) {
      trial.frequency_slope = f_slope * voltage / trial.frequency;
      trial.lift_slope = lift_slope * voltage;
    }
  }
  DomainExcess excess = domain_excess(vehicle_, m);
  const bool domain = range_ != SearchRange::extrapolation;
  const double alpha = m[Metric::angle_of_attack_min];
  const double flow = excess[std::size_t(DomainLimit::flow_speed)];
  const double heat = excess[std::size_t(DomainLimit::winding_temperature)];
  trial.beyond = domain
                     ? alpha < angle_of_attack_lowest_deg || flow > 0.0 || (heat > 0.0 && range_ == SearchRange::domain)
                     : alpha < extrapolation_angle_deg || flow > extrapolation_flow_speed / flow_speed_max - 1.0;
  if (!domain) {
    excess.fill(-1.0);
    excess[std::size_t(DomainLimit::angle_of_attack)] = (extrapolation_angle_deg - alpha) / -extrapolation_angle_deg;
    excess[std::size_t(DomainLimit::flow_speed)] = (flow + 1.0) * flow_speed_max / extrapolation_flow_speed - 1.0;
  }
  if (range_ == SearchRange::coefficients) {
    excess.fill(-1.0);
    excess[std::size_t(DomainLimit::angle_of_attack)] = (angle_of_attack_lowest_deg - alpha) / 90.0;
    excess[std::size_t(DomainLimit::flow_speed)] = flow;
  }
  trial.excess = excess;
  trial.inside = domain ? domain_of(excess).none() : !trial.beyond;
  if (!trial.inside && domain) trial.limits = domain_evidence(vehicle_, m);
  return trial;
}

double largest_excess(const VoltageTrial& t) {
  double largest = -1.0;
  for (const double e : t.excess) largest = std::isfinite(e) ? std::max(largest, e) : 1.0;
  return largest;
}

double unloaded_voltage(const Vehicle<double>& v, double omega, double friction_torque) {
  const double K = v.motor.torque_constant;
  return K * omega + circuit_resistance(v) * (v.motor.viscous_damping * omega + friction_torque) / K;
}

}  // namespace wingbeat::detail

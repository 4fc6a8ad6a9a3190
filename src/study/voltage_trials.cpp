#include "study/voltage_trials.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

/// By how much a cycle exceeds the limits of a range; of ranges beside the domain, angle of attack and flow speed
/// alone.
DomainExcess excess_over(SearchRange range, double angle_of_attack_deg, const DomainExcess& of_domain) {
  if (range == SearchRange::domain) return of_domain;
  const bool far = range == SearchRange::extrapolation;
  const double lowest = far ? extrapolation_angle_deg : angle_of_attack_lowest_deg;
  const double fastest = far ? extrapolation_flow_speed : flow_speed_max;
  const double speed = (of_domain[std::size_t(DomainLimit::flow_speed)] + 1.0) * flow_speed_max;
  DomainExcess excess;
  excess.fill(-1.0);
  excess[std::size_t(DomainLimit::angle_of_attack)] =
      (lowest - angle_of_attack_deg) / (far ? -extrapolation_angle_deg : angle_of_attack_highest_deg);
  excess[std::size_t(DomainLimit::flow_speed)] = speed / fastest - 1.0;
  return excess;
}

}  // namespace

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
  set_mean_voltage(vehicle_, voltage);
  const SteadyFlapping found = solve();
  VoltageTrial trial;
  trial.voltage = voltage;
  trial.status = found.status;
  trial.flaps = found.status == FlappingStatus::flapping;
  trial.evidence = found.evidence;
  if (!trial.flaps) return trial;

  const Metrics<double>& m = found.metrics;
  trial.frequency = m[Metric::frequency];
  trial.power = m[Metric::power_electrical];
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
    const int slot = has_slot ? gradient_voltage_slot : gradient_first_slot;
    seeded.vehicle.source_resistance.v[slot] = 2.0 * vehicle_.source_resistance / voltage;
    const OrbitGradient g = orbit_gradient(found, seeded, {.peaks = false});
    const double f_slope = g.metrics[Metric::frequency].v[slot], lift_slope = g.metrics[Metric::lift_mean].v[slot];
    trial.exact = g.regular && std::isfinite(f_slope) && std::isfinite(lift_slope);
    if (trial.exact) {
      trial.frequency_slope = f_slope * voltage / trial.frequency;
      trial.lift_slope = lift_slope * voltage;
    }
  }
  const DomainExcess of_domain = domain_excess(vehicle_, m);
  trial.excess = excess_over(range_, m[Metric::angle_of_attack_min], of_domain);
  trial.inside = domain_of(trial.excess).none();
  trial.beyond = !trial.inside;
  if (range_ == SearchRange::domain) {
    const auto exceeds = [&](DomainLimit limit) { return of_domain[std::size_t(limit)] > 0.0; };
    trial.beyond = m[Metric::angle_of_attack_min] < angle_of_attack_lowest_deg || exceeds(DomainLimit::flow_speed) ||
                   exceeds(DomainLimit::winding_temperature);
  }
  if (!trial.inside && range_ != SearchRange::extrapolation) trial.limits = domain_evidence(vehicle_, m);
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

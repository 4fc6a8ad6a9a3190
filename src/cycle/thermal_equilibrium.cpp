#include "wingbeat/cycle/thermal_equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/cycle/orbit_search.hpp"

namespace wingbeat {
namespace {

constexpr int max_solutions = 60;
/// Secants settle within five or six solutions; where they do not, the interval known is halved.
constexpr int patience = 12;
constexpr int relaxed_after = 16;
/// So close is the temperature known at which a vehicle stops [K].
constexpr double stop_width = 0.01;

MotorTemperatures<double> middle(const MotorTemperatures<double>& a, const MotorTemperatures<double>& b) {
  return {0.5 * (a.winding + b.winding), 0.5 * (a.casing + b.casing)};
}

MotorTemperatures<double> difference(const MotorTemperatures<double>& a, const MotorTemperatures<double>& b) {
  return {a.winding - b.winding, a.casing - b.casing};
}

}  // namespace

double tolerance_within_equilibrium(double tolerance) { return std::max(0.1 * tolerance, 1e-12); }

ThermalEquilibrium::ThermalEquilibrium(const MotorThermal<double>& thermal, double tolerance)
    : thermal_(thermal),
      closeness_(std::max(0.3 * tolerance, 2e-12)),
      at_{thermal.ambient_temperature, thermal.ambient_temperature} {}

/// Product of two changes of temperature by what they change: resistance and torque constant, as shares.
double ThermalEquilibrium::weighted(const MotorTemperatures<double>& a, const MotorTemperatures<double>& b) const {
  const double a_Cu = thermal_.copper_temperature_coefficient, a_B = thermal_.magnet_temperature_coefficient;
  return a_Cu * a_Cu * a.winding * b.winding + a_B * a_B * a.casing * b.casing;
}

MotorTemperatures<double> ThermalEquilibrium::secant(const Trial& last) const {
  if (!before_) return last.resulting;
  const auto r = difference(last.resulting, last.assumed);
  const auto dr = difference(r, difference(before_->resulting, before_->assumed));
  const double share = weighted(dr, r) / weighted(dr, dr);
  if (!std::isfinite(share)) return last.resulting;
  const auto dg = difference(last.resulting, before_->resulting);
  return {last.resulting.winding - share * dg.winding, last.resulting.casing - share * dg.casing};
}

/// Halves what lies between the last trial that flapped and the coolest that did not.
bool ThermalEquilibrium::towards_stop() {
  if (verge_is_unclear_ || stopped_->winding - before_->assumed.winding < stop_width) {
    // The verge itself is nothing that a start-up could decide.
    at_stop_ = true;
    at_ = {std::clamp(before_->resulting.winding, stopped_->winding, copper_melting_point),
           std::clamp(before_->resulting.casing, stopped_->casing, copper_melting_point)};
  } else {
    at_ = middle(before_->assumed, *stopped_);
  }
  return false;
}

bool ThermalEquilibrium::advance(bool flaps, const Metrics<double>& metrics, bool decided) {
  ++solutions_;
  if (at_stop_) return end(flaps ? ThermalOutcome::does_not_settle : ThermalOutcome::stops);
  if (!flaps) {
    if (!before_) return end(ThermalOutcome::never_flaps);
    // Where even a simulation is undecided, more of them would not show the verge more closely.
    verge_is_unclear_ = !decided && stopped_;
    if (!verge_is_unclear_) stopped_ = at_;
    return towards_stop();
  }
  const Trial last{
      at_, {metrics[Metric::winding_temperature] + zero_celsius, metrics[Metric::case_temperature] + zero_celsius}};
  const auto r = difference(last.resulting, last.assumed);
  // Simulations of a switching supply scatter by more than any tolerance.
  const double relaxed = std::min(closeness_ * std::pow(10.0, std::max(0, solutions_ - relaxed_after)), 1e-4);
  if (std::sqrt(weighted(r, r)) <= std::max(closeness_, relaxed)) return end(ThermalOutcome::settled);
  const bool heats = r.winding > 0.0;
  if (heats && at_.winding >= copper_melting_point) return end(ThermalOutcome::runaway);
  if (solutions_ >= max_solutions || !std::isfinite(r.winding)) return end(ThermalOutcome::does_not_settle);
  (heats ? heating_ : cooling_) = last;

  MotorTemperatures<double> next = secant(last);
  // Where it heats it is hotter that it settles, if at all: a secant says otherwise under runaway.
  if (heats ? !(next.winding > at_.winding) : !(next.winding < at_.winding)) next = last.resulting;
  const auto within = [&](double T) { return std::clamp(T, thermal_.ambient_temperature, copper_melting_point); };
  next = {within(next.winding), within(next.casing)};
  before_ = last;
  if (stopped_ && next.winding >= stopped_->winding) return towards_stop();
  if (solutions_ > patience && heating_ && cooling_) next = middle(heating_->assumed, cooling_->assumed);
  at_ = next;
  return false;
}

bool conclude(const ThermalEquilibrium& search, FlappingStatus& status, StatusEvidence& evidence) {
  if (search.outcome() == ThermalOutcome::stops) evidence.winding_temperature = search.stops_at() - zero_celsius;
  if (search.outcome() != ThermalOutcome::does_not_settle) return true;
  status = FlappingStatus::undecided;
  evidence = {.kind = StatusEvidence::Kind::no_steady_temperature,
              .winding_temperature = search.at().winding - zero_celsius};
  return false;
}

SteadyFlapping detail::find_warm_flapping(const Vehicle<double>& vehicle, const SteadyOptions& options,
                                          const StartUp& start_up) {
  SteadyOptions within = options;
  within.tolerance = tolerance_within_equilibrium(options.tolerance);
  ThermalEquilibrium equilibrium(vehicle.thermal, options.tolerance);
  SharedSearch shared;
  shared.work.limit = 2 * search_work(vehicle);
  SteadyFlapping found;
  do {
    found = find_flapping_among(with_motor_at(vehicle, equilibrium.at()), within, start_up, shared);
    found.temperatures = equilibrium.at();
  } while (!equilibrium.advance(found.status == FlappingStatus::flapping, found.metrics,
                                found.status != FlappingStatus::undecided));
  if (!conclude(equilibrium, found.status, found.evidence)) {
    SteadyFlapping none;
    none.metrics.values.fill(absent);
    none.status = found.status;
    none.evidence = found.evidence;
    return none;
  }
  return found;
}

}  // namespace wingbeat

#include "wingbeat/cycle/air_equilibrium.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

constexpr int max_solutions = 60;
/// Secants settle within five or six solutions; simulations of a switching supply scatter by more than any tolerance.
constexpr int relaxed_after = 16;

bool reverses_by_itself(const Vehicle<double>& v) { return claps(v.wings.clap) && !drive_of(v).stroke_is_fixed; }

/// In metres per second and radians: close to 1 where either counts.
double product(const SettledAir& a, const SettledAir& b) {
  return a.induced_velocity * b.induced_velocity + a.reversal * b.reversal;
}

SettledAir difference(const SettledAir& a, const SettledAir& b) {
  return {a.induced_velocity - b.induced_velocity, a.reversal - b.reversal};
}

}  // namespace

bool settles_air(const Vehicle<double>& v) { return has_induced_velocity(v.wings.wake) || reverses_by_itself(v); }

SettledAir air_of(const Metrics<double>& m) { return {m[Metric::induced_velocity], m[Metric::stroke_angle_max]}; }

Vehicle<double> in_air(Vehicle<double> vehicle, const SettledAir& air) {
  if (has_induced_velocity(vehicle.wings.wake)) vehicle.wings.wake.velocity = air.induced_velocity;
  if (reverses_by_itself(vehicle)) vehicle.wings.clap.reversal = air.reversal;
  return vehicle;
}

Vehicle<double> in_settled_air(const Vehicle<double>& vehicle) {
  if (!settles_air(vehicle)) return vehicle;
  const SteadyFlapping found = detail::find_flapping_at_given_temperature(vehicle, {}, {});
  return found.status == FlappingStatus::flapping ? in_air(vehicle, air_of(found.metrics)) : vehicle;
}

AirEquilibrium::AirEquilibrium(const Vehicle<double>& vehicle, double tolerance)
    : has_wake_(has_induced_velocity(vehicle.wings.wake)),
      reverses_(reverses_by_itself(vehicle)),
      closeness_(std::max(0.3 * tolerance, 2e-12)),
      at_{0.0, reverses_ ? -infinity : 0.0} {}

bool AirEquilibrium::advance(bool flaps, const Metrics<double>& metrics) {
  ++solutions_;
  if (!flaps) return end(solutions_ == 1 ? AirOutcome::does_not_flap : AirOutcome::does_not_settle);
  const Trial last{
      at_, {has_wake_ ? metrics[Metric::induced_velocity] : 0.0, reverses_ ? metrics[Metric::stroke_angle_max] : 0.0}};
  if (solutions_ == 1) {
    at_ = last.resulting;
    if (product(at_, at_) == 0.0) return end(AirOutcome::settled);
    return false;
  }
  const SettledAir r = difference(last.resulting, last.assumed);
  const double relaxed = std::min(closeness_ * std::pow(10.0, std::max(0, solutions_ - relaxed_after)), 1e-4);
  const double size = std::max(product(last.resulting, last.resulting), 1e-12);
  if (std::sqrt(product(r, r) / size) <= std::max(closeness_, relaxed)) return end(AirOutcome::settled);
  if (solutions_ >= max_solutions || !std::isfinite(product(r, r))) return end(AirOutcome::does_not_settle);
  SettledAir next = last.resulting;
  if (before_) {
    const SettledAir dr = difference(r, difference(before_->resulting, before_->assumed));
    const double share = product(dr, r) / product(dr, dr);
    const SettledAir dg = difference(last.resulting, before_->resulting);
    if (std::isfinite(share)) {
      next = {last.resulting.induced_velocity - share * dg.induced_velocity,
              last.resulting.reversal - share * dg.reversal};
    }
  }
  next.induced_velocity = std::max(next.induced_velocity, 0.0);
  before_ = last;
  at_ = next;
  return false;
}

bool conclude(const AirEquilibrium& search, FlappingStatus& status, StatusEvidence& evidence) {
  if (search.outcome() != AirOutcome::does_not_settle) return true;
  status = FlappingStatus::undecided;
  evidence = {.kind = StatusEvidence::Kind::no_steady_air, .induced_velocity = search.at().induced_velocity};
  return false;
}

}  // namespace wingbeat

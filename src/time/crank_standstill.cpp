// A crank that friction holds at a standstill while it starts up: for a while, or for good.
#include <cmath>

#include "time/crank_start_up.hpp"

namespace wingbeat::detail {

/// True, with the decision, where neither the supply nor the wings break it away any more. Wings that still pitch shake
/// the crank: they can only come to rest, and the current with them, so that a crank that stands long enough does so
/// for good.
bool CrankStartUp::stands_for_good() {
  const Vehicle<double>& v = model_.vehicle;
  const Supply<double>& supply = model_.supply;
  const double R = circuit_resistance(v), K = v.motor.torque_constant, tau = model_.electrical_time;
  const StandingTorques<double> torques = model_.standing_torques(now_.moving.angle);
  const auto held_at = [&](double i) { return torques.hold(K * current_within(v.electronics, i)); };
  bool for_good = now_.t >= stuck_until_;
  if (!model_.wings_rest()) {
    if (stuck_until_ == infinity) stuck_until_ = shaken_until();
  } else if (supply.type == SupplyType::constant) {
    // What the current tends to from where friction holds the crank already.
    for_good = for_good || held_at(now_.switched_voltage / R);
  } else if (supply.type == SupplyType::pwm) {
    // The ends of the current's limit cycle: on the way there it stays between its start and them.
    double top = supply.voltage / R, bottom = 0.0;
    if (model_.indices.inductive) {
      const double period = 1.0 / supply.frequency;
      top *= std::expm1(-supply.duty * period / tau) / std::expm1(-period / tau);
      bottom = top * std::exp(-(1.0 - supply.duty) * period / tau);
    }
    for_good = for_good || (held_at(top) && held_at(bottom));
  } else if (stuck_until_ == infinity) {
    stuck_until_ = now_.t + 40.0 * tau + 2.0 * model_.drive_period;
  }
  if (for_good) rest(now_.moving.angle, true);
  return for_good;
}

}  // namespace wingbeat::detail

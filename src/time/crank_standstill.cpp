// A crank at a standstill while it starts up: held by friction for good, for a while, or not at all.
#include <algorithm>
#include <cmath>
#include <utility>

#include "time/crank_start_up.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

/// At a standstill: rests for good, waits for the current to break it away, or moves on in the direction of the torque.
void CrankStartUp::stand() {
  if (!model_.wings_rest()) return stand_while_wings_pitch();
  now_.stuck = false;
  const StandingTorques<double> torques = model_.standing_torques(now_.moving.angle);
  const double K = model_.vehicle.motor.torque_constant;
  if (!model_.indices.inductive) now_.moving.current = model_.voltage(now_.t) / circuit_resistance(model_.vehicle);
  const double torque = K * now_.moving.current;
  if (torque < torques.low || torque > torques.high) {
    now_.direction = sign_of(torque - 0.5 * (torques.low + torques.high));
    return;
  }
  const double from = now_.t;
  if (!stick(torques.low / K, torques.high / K)) return;
  if (now_.t > from || crossings_.empty()) event(Kind::breakaway);
}

/// Wings that still pitch shake the crank: whether friction holds it changes with them. They can only come to rest, and
/// the current with them, so that a crank that stands long enough does so for good.
void CrankStartUp::stand_while_wings_pitch() {
  if (std::exchange(breaks_away_, false)) return;
  if (!now_.stuck) {
    model_.begin_piece();
    if (!now_.stuck) return;
    const PitchingWings<double>& wings = model_.vehicle.pitch;
    const double period = two_pi * std::sqrt((wings.pitch_inertia + wings.air.pp) / wings.hinge.stiffness);
    stuck_until_ = now_.t + 3.0 * period + 2.0 * model_.drive_period + 20.0 * model_.electrical_time;
  } else if (now_.t >= stuck_until_) {
    rest(now_.moving.angle, true);
  }
}

/// Crank held by friction while the current stays in [low, high]. True when it breaks away, now_.t, now_.moving.current
/// and the direction then being set; false when the decision is in.
bool CrankStartUp::stick(double low, double high) {
  const Motor<double>& m = model_.vehicle.motor;
  const double R = circuit_resistance(model_.vehicle);
  const double tau = m.armature_inductance / R;
  const auto inside = [&](double i) { return i >= low && i <= high; };

  if (model_.supply.type == SupplyType::constant && inside(now_.switched_voltage / R)) {
    rest(now_.moving.angle, true);
    return false;
  }
  if (model_.supply.type == SupplyType::pwm) {
    // The current's limit cycle; on the way there it stays between its start and the cycle's ends.
    const double period = 1.0 / model_.supply.frequency;
    double top = model_.supply.voltage / R, bottom = 0.0;
    if (model_.indices.inductive) {
      top *= std::expm1(-model_.supply.duty * period / tau) / std::expm1(-period / tau);
      bottom = top * std::exp(-(1.0 - model_.supply.duty) * period / tau);
    }
    if (inside(top) && inside(bottom)) {
      rest(now_.moving.angle, true);
      return false;
    }
  }
  const double started = now_.t;
  while (!out_of_budget()) {
    if (model_.supply.type == SupplyType::sine) {
      const double period = 1.0 / model_.supply.frequency;
      if (now_.t - started > 40.0 * tau + 2.0 * period) {
        rest(now_.moving.angle, true);
        return false;
      }
      const double piece_end = std::min(end_time_, now_.t + period / 64.0);
      const auto held_at = [&](double t) { return inside(standing_current(t)); };
      if (held_at(piece_end)) {
        relax(piece_end);
        continue;
      }
      relax(bisect(held_at, now_.t, piece_end).after);
      now_.direction = now_.moving.current > high ? 1.0 : -1.0;
      now_.moving.current = now_.moving.current > high ? high : low;
      return true;
    }
    const double limit = now_.switched_voltage / R;
    const double piece_end = std::min(end_time_, model_.next_switch());
    if (!inside(limit)) {
      const double bound = limit > high ? high : low;
      const double wait = model_.indices.inductive
                              ? tau * std::max(0.0, std::log((limit - now_.moving.current) / (limit - bound)))
                              : 0.0;
      if (now_.t + wait <= piece_end) {
        relax(now_.t + wait);
        if (model_.indices.inductive) now_.moving.current = bound;
        now_.direction = limit > high ? 1.0 : -1.0;
        return true;
      }
    }
    relax(piece_end);
    if (piece_end < end_time_) switch_supply();
  }
  return false;
}

/// Of the motor that stands since now_ [A], before any switching of the supply.
double CrankStartUp::standing_current(double theta) const {
  const double R = circuit_resistance(model_.vehicle);
  const double tau = model_.vehicle.motor.armature_inductance / R;
  const auto forced = [&](double t) {
    if (model_.supply.type != SupplyType::sine) return now_.switched_voltage / R;
    const double angular = two_pi * model_.supply.frequency, lag = std::atan(angular * tau);
    return model_.supply.voltage / R * std::cos(lag) * std::sin(angular * t - lag);
  };
  return model_.indices.inductive
             ? forced(theta) + (now_.moving.current - forced(now_.t)) * std::exp(-(theta - now_.t) / tau)
             : forced(theta);
}

/// Lets the current of the standing motor run on to the time `until`, before any switching of the supply.
void CrankStartUp::relax(double until) {
  const double start = now_.t, i_0 = now_.moving.current, span = until - start;
  const auto current = [&](double t) { return standing_current(t); };
  if (measuring_ && span > 0.0) {
    const Configuration<double> here = configuration_at_angle(model_.vehicle, now_.moving.angle);
    const double force = model_.wingless ? 0.0 : std::abs(static_rod_force(here.kinematics, here.spring_moment));
    double charge = 0.0, heat = 0.0, work = 0.0;
    if (model_.supply.type == SupplyType::sine) {
      constexpr double node = 0.77459666924148337704;  // three-point Gauss; spans are 1/64 of a drive period at most
      for (const auto& [position, weight] : {std::pair{-node, 5.0 / 18.0}, {0.0, 4.0 / 9.0}, {node, 5.0 / 18.0}}) {
        const double t = start + 0.5 * span * (1.0 + position);
        charge += weight * span * current(t);
        heat += weight * span * square(current(t));
        work += weight * span * current(t) * terminal_voltage(model_.vehicle, model_.voltage(t), current(t));
      }
    } else {
      const double R = circuit_resistance(model_.vehicle), tau = model_.vehicle.motor.armature_inductance / R;
      const double limit = now_.switched_voltage / R;
      const double d = model_.indices.inductive ? i_0 - limit : 0.0;
      const double a = model_.indices.inductive ? -tau * std::expm1(-span / tau) : 0.0;
      const double b = model_.indices.inductive ? -0.5 * tau * std::expm1(-2.0 * span / tau) : 0.0;
      charge = limit * span + d * a;
      heat = square(limit) * span + 2.0 * limit * d * a + square(d) * b;
      work = now_.switched_voltage * charge - model_.vehicle.source_resistance * heat;
    }
    for (int k = 0; k < quadrature_count; ++k) {
      switch (quadratures[k]) {
        case Integral::current: q_[k] += charge; break;
        case Integral::current_square: q_[k] += heat; break;
        case Integral::electrical_work: q_[k] += work; break;
        case Integral::rod_force: q_[k] += force * span; break;
        default: break;
      }
    }
  }
  recorder_.samples_until(until, [&](double t) { return TransientSample{t, now_.moving.angle, 0.0, current(t)}; });
  now_.moving.current = current(until);
  now_.t = until;
  recorder_.note_current(now_.t, now_.moving.current);
  if (measuring_) {
    double& top = extremes_[std::size_t(Extreme::current)];
    top = std::max(top, now_.moving.current);
    double& slowest = extremes_[std::size_t(Extreme::crank_speed_min)];
    slowest = std::max(slowest, 0.0);
  }
  if (options_.record_interval == 0.0 && span > 0.0) sample();
}

}  // namespace wingbeat::detail

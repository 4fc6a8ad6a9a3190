// What happens to a vehicle in time between smooth pieces: rod force and shaft change direction, friction holds and
// lets go, wings meet a stop; model.md sections 2, 9, 12.
#include <algorithm>
#include <cmath>
#include <utility>

#include "time/time_model.hpp"
#include "wingbeat/vehicle/impact.hpp"

namespace wingbeat::detail {

StandingTorques<double> TimeModel::standing_torques(double angle) const {
  const Configuration<double> here = configuration_at_angle(vehicle, angle);
  return wingbeat::standing_torques(vehicle, here.kinematics,
                                    wingless ? 0.0 : static_rod_force(here.kinematics, here.spring_moment));
}

StandingTorques<double> TimeModel::standing_torques(const double* y) const {
  if (!wings_pitch && !has_flow(vehicle.wings)) return standing_torques(y[0]);
  const FullState<double> here = instant(now.t, y);
  const CrankKinematics<double>& k = here.configuration.kinematics;
  const auto under = [&](double moment_of_air) {
    return wingbeat::standing_torques(vehicle, k,
                                      static_rod_force(k, here.configuration.spring_moment + moment_of_air));
  };
  if (wings_pitch) return under(wings_standing(vehicle, here, mode()).moment);
  // On a body that moves the air turns wings that stand. Under the pitch law they lie over as they set off, so that it
  // turns them otherwise to either side.
  const auto towards = [&](double way) {
    Mode<double> leaving = mode();
    leaving.stroke = way * sign_of(k.stroke_slope);
    return under(aero_loads(vehicle.wings, 0.0, leaving.stroke, now.pitching,
                            clap_factor(vehicle, here.configuration, leaving), here.configuration.stroke_angle)
                     .moment);
  };
  return {towards(-1.0).low, towards(1.0).high};
}

double TimeModel::net_static_torque(double angle, double i) const {
  return vehicle.motor.torque_constant * i - standing_torques(angle).middle();
}

double TimeModel::holding_torque(double angle) const { return standing_torques(angle).friction(); }

void TimeModel::choose_force_branch() {
  if (wingless || !force_matters) return;
  if (now.force_known) {
    now.force_known = false;
    return;
  }
  double y[max_unknowns];
  unknowns(y);
  double value = motion(now.t, y).force_switch / force_scale;
  if (std::abs(value) < 1e-9) {
    // The sign is about to be decided: look a little ahead, by the midpoint rule.
    const double ahead = 1e-5 * time_scale;
    double dy[max_unknowns] = {}, mid[max_unknowns] = {}, dmid[max_unknowns] = {};
    rates(now.t, y, dy, false);
    for (int k = 0; k < coupled; ++k) mid[k] = y[k] + 0.5 * ahead * dy[k];
    rates(now.t + 0.5 * ahead, mid, dmid, false);
    for (int k = 0; k < coupled; ++k) y[k] += ahead * dmid[k];
    value = motion(now.t + ahead, y).force_switch;
  }
  now.force = sign_of(value);
}

std::array<double, TimeModel::indicator_count> TimeModel::indicators(double t, const double* y) const {
  std::array<double, indicator_count> values;
  values.fill(1.0);
  if (now.stuck) {
    const StandingTorques<double> torques = standing_torques(y);
    values[standstill] = torques.margin(standing_torque(t, y)) /
                         (wings_pitch || has_flow(vehicle.wings) ? torque_scale : torques.friction());
  } else if (jumps_) {
    values[standstill] = y[1] / speed_scale;
  }
  if (limits_current(vehicle.electronics)) {
    const double i = indices.inductive ? y[indices.current] : algebraic_current(vehicle, voltage(t), y[1]);
    const double back_emf = vehicle.motor.torque_constant * (now.stuck ? 0.0 : y[1]), R = circuit_resistance(vehicle);
    const double beyond = (voltage(t) - back_emf) / R, highest = vehicle.electronics.current_max;
    if (!vehicle.electronics.regenerates) values[bridge] = (now.blocked ? -beyond : i) / current_scale;
    if (std::isfinite(highest)) values[limit] = (now.limited ? beyond - highest : highest - i) / current_scale;
  }
  if (now.stuck && !wings_pitch) return values;
  if (jumps_at_bound_) values[pitch_bound] = pitch_margin_at(y);
  PitchMotion<double> m;
  if (!wingless) m = motion(t, y);
  if (indices.pitching) {
    values[stop] = stop_room(y, m);
    values[turn] = now.held ? 1.0 : y[indices.pitch + 1] / pitch_velocity_scale;
  }
  if (indices.twisting) values[local_turn] = local_pitch_velocity(indices.coordinates(y)) / pitch_velocity_scale;
  if (now.stuck) return values;
  if (!direct) {
    values[jam] = wings_pitch ? std::min(1.0, uniqueness_at(y) - smallest_margin)
                              : std::min({1.0, jam_above - y[0], y[0] - jam_below});
  }
  if (wingless) return values;
  if (force_matters) values[force] = m.force_switch / force_scale;
  values[stored_moment] = m.stored_moment / torque_scale;
  values[reversal] =
      direct ? y[1] / speed_scale : m.kinematics.stroke_slope / typical_stroke_slope(vehicle.transmission);
  return values;
}

/// What rests or is held goes on so, or does not: with the accelerations, what holds it may have jumped.
void TimeModel::begin_piece() {
  resume();
  settle_electronics();
  settle_shaft();
  if (indices.pitching && now.held && !now.jammed && !is_clamped(vehicle.pitch.hinge)) settle_pitch();
}

/// At a standstill it is held, or moves on in the direction of the torque.
void TimeModel::settle_shaft() {
  // Without inductance the current jumps with the voltage, and what friction held may not be held any more.
  if (now.jammed || !jumps_ || (now.stuck && indices.inductive)) return;
  const bool leaving = std::exchange(now.leaving, false);
  if (now.moving.speed != 0.0) {
    now.direction = sign_of(now.moving.speed);
  } else if (!leaving) {
    if (!indices.inductive) now.moving.current = current_now();
    double y[max_unknowns];
    unknowns(y);
    const StandingTorques<double> torques = standing_torques(y);
    const double torque = standing_torque(now.t, y);
    now.direction = torques.direction(torque);
    now.stuck = torques.hold(torque);
    if (now.stuck) return;
  }
  choose_force_branch();
}

std::array<int, TimeModel::indicator_count> TimeModel::directions() const {
  const int turning = has_friction(vehicle.pitch.hinge) ? int(-now.turn) : 0, held_current = indices.inductive ? -1 : 0;
  return {int(-now.force),   now.stuck ? -1 : int(-now.direction), -1, 0, 0, -1, turning, 0, held_current, held_current,
          int(-now.pitching)};
}

void TimeModel::handle(std::size_t indicator) {
  if (indicator == jam) now.jammed = true;
  if (indicator == standstill) {
    if (now.stuck) {
      double y[max_unknowns];
      unknowns(y);
      now.direction = standing_torques(y).direction(standing_torque(now.t, y));
      now.leaving = true;
    }
    now.stuck = false;
    now.moving.speed = 0.0;
  }
  if (indicator == force) {
    now.force = -now.force;
    now.force_known = now.moving.speed != 0.0;
  }
  if (indicator == turn && has_friction(vehicle.pitch.hinge)) {
    now.moving.pitch_velocity = 0.0;
    settle_pitch();
  }
  if (indicator == stop) {
    if (now.held) {
      double y[max_unknowns];
      unknowns(y);
      now.turn = leaving_side(vehicle.pitch.hinge, now.moving.pitch_angle, pressing(y));
      now.held = false;
    } else {
      meet_stop();
    }
  }
  if (indicator == bridge && indices.inductive) {
    now.blocked = !now.blocked;
    if (now.blocked) now.moving.current = 0.0;
  }
  if (indicator == limit && indices.inductive) {
    now.limited = !now.limited;
    if (now.limited) now.moving.current = vehicle.electronics.current_max;
  }
  if (indicator == pitch_bound) {
    now.pitching = -now.pitching;
    now.force_known = false;  // it jumps
  }
}

/// How far the angle of attack is from its bound, as pitch_margin() [rad].
double TimeModel::pitch_margin_at(const double* y) const {
  return pitch_margin(vehicle.wings, std::abs(kinematics(y[0]).stroke_slope * y[1]));
}

/// Voltage left for the current beyond that of i [V].
double TimeModel::surplus_voltage(double i) const {
  const double omega = now.stuck ? 0.0 : now.moving.speed;
  return voltage(now.t) - vehicle.motor.torque_constant * omega - circuit_resistance(vehicle) * i;
}

/// Whether electronics block or limit the current, as it is and is about to be.
void TimeModel::settle_electronics() {
  const Electronics<double>& e = vehicle.electronics;
  if (!indices.inductive || !limits_current(e)) return;
  double& i = now.moving.current;
  now.blocked = !e.regenerates && (i <= 0.0 || now.blocked) && surplus_voltage(0.0) < 0.0;
  now.limited = (i >= e.current_max || now.limited) && surplus_voltage(e.current_max) > 0.0;
  if (now.blocked) i = 0.0;
  if (now.limited) i = e.current_max;
}

std::optional<TransientEvent::Kind> TimeModel::event_at(std::size_t indicator) const {
  using Kind = TransientEvent::Kind;
  if (indicator == standstill) return now.stuck ? Kind::breakaway : Kind::standstill;
  if (indicator == force && !direct) return Kind::force_sign_change;
  return std::nullopt;
}

bool TimeModel::branch_lost() {
  const auto passed_stop = [&] {
    const double psi = now.moving.pitch_angle, side = side_of_stop(vehicle.pitch.hinge, psi);
    return side * psi > side * nearer_stop(vehicle.pitch.hinge, psi) * (1.0 + 1e-9);
  };
  if (indices.pitching && !now.held && passed_stop()) {
    meet_stop();
    return true;
  }
  if (indices.inductive && limits_current(vehicle.electronics)) {
    const double i = now.moving.current, highest = vehicle.electronics.current_max;
    const bool below = !vehicle.electronics.regenerates && !now.blocked && i < -1e-9 * current_scale;
    if (below || (!now.limited && i > highest + 1e-9 * current_scale)) {
      settle_electronics();
      return now.blocked || now.limited;
    }
  }
  if (jumps_at_bound_) {
    double y[max_unknowns];
    unknowns(y);
    if (now.pitching * pitch_margin_at(y) < -1e-9) {
      now.pitching = -now.pitching;
      return true;
    }
  }
  if (now.stuck || !jumps_) return false;
  if (now.direction * now.moving.speed < -1e-9 * speed_scale) return true;
  if (wingless || !force_matters) return false;
  double y[max_unknowns];
  unknowns(y);
  if (now.force * indicators(now.t, y)[force] >= -1e-8) return false;
  now.force = -now.force;
  now.force_known = true;
  return true;
}

void TimeModel::resume() {
  const double side = side_of_stop(vehicle.pitch.hinge, now.moving.pitch_angle);
  const double stop = nearer_stop(vehicle.pitch.hinge, now.moving.pitch_angle);
  if (indices.pitching && !now.held && side * now.moving.pitch_angle >= side * stop &&
      side * now.moving.pitch_velocity > 0.0) {
    meet_stop();
  }
}

void TimeModel::meet_stop() {
  now.moving.pitch_angle = nearer_stop(vehicle.pitch.hinge, now.moving.pitch_angle);
  now.held = true;
  if (uniqueness_now() <= smallest_margin) {
    now.jammed = true;
    return;
  }
  double before[max_unknowns];
  unknowns(before);
  FullState<double> instant = this->instant(now.t, before);
  instant.pitch_velocity = now.moving.pitch_velocity;
  Mode<double> after = mode();
  wingbeat::meet_stop(vehicle, &instant, &after, [&](const StopImpact<double>& impact) {
    now.impact_loss += impact.stop_work;
    const CycleIntegrals<double> at_once = wingbeat::impulses(impact);
    for (std::size_t q = 0; q < at_once.size(); ++q) now.impulses[q] += at_once[q];
  });
  now.moving.speed = instant.omega;
  now.moving.pitch_velocity = instant.pitch_velocity;
  now.moving.twist_velocity = instant.twist.velocity;
  now.stuck = after.slip < 0.0;
  now.direction = after.direction;
  if (!indices.inductive) now.moving.current = current_now();
  double y[max_unknowns];
  unknowns(y);
  const bool stands = now.stuck || (jumps_ && now.moving.speed == 0.0);
  // The impact may have turned the rod force over; its sign may depend on that of the gear torque.
  for (int sweep = 0; sweep < 2 && !stands && force_matters; ++sweep) {
    now.force = sign_of(motion(now.t, y).force_switch);
  }
  settle_pitch();
}

/// How wings that are held press towards a positive psi [N m].
double TimeModel::pressing(const double* y) const {
  return now.stuck ? wings_standing(vehicle, instant(now.t, y), mode()).pitching_moment : motion(now.t, y).stop_moment;
}

/// Whether wings that rest are held, or to which side they go.
void TimeModel::settle_pitch() {
  double y[max_unknowns];
  unknowns(y);
  now.held = true;
  const double presses = pressing(y);
  if (holding_margin(vehicle.pitch.hinge, now.moving.pitch_angle, presses) >= 0.0) return;
  now.held = false;
  now.turn = leaving_side(vehicle.pitch.hinge, now.moving.pitch_angle, presses);
}

/// Room to the stop or, of wings that are held, what holds them beyond what would move them [1].
double TimeModel::stop_room(const double* y, const PitchMotion<double>& motion) const {
  const PitchHinge<double>& hinge = vehicle.pitch.hinge;
  const double psi = y[indices.pitch];
  if (!now.held) {
    if (!has_stop(hinge)) return 1.0;
    return side_of_stop(hinge, psi) * (nearer_stop(hinge, psi) - psi) / (0.5 * (hinge.stop_high - hinge.stop_low));
  }
  return holding_margin(hinge, psi, motion.stop_moment) /
         (vehicle.pitch.pitch_inertia * speed_scale * pitch_velocity_scale);
}

}  // namespace wingbeat::detail

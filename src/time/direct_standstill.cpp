// A shaft of a direct drive that comes to rest while it starts up: held for good, or creeping there.
#include <algorithm>
#include <cmath>

#include "time/direct_start_up.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::detail {
namespace {

constexpr int creep_periods = 8;  // of ever shorter slips in one direction, that end at rest

}  // namespace

/// The largest torque of the motor at rest from now on [N m]: its current is a sine and what remains of its start.
double DirectStartUp::largest_torque() const {
  const Motor<double>& m = model_.vehicle.motor;
  if (is_given(model_.vehicle.piezo)) {
    const double offset = std::abs(model_.vehicle.voltage_offset);
    return model_.drive_torque * (model_.supply.voltage > 0.0 ? 1.0 + offset / model_.supply.voltage : 1.0);
  }
  const double w = two_pi * model_.vehicle.drive_frequency;
  const double Z = std::hypot(m.armature_resistance, w * m.armature_inductance);
  const double lag = std::atan2(w * m.armature_inductance, m.armature_resistance);
  const double remains = model_.indices.inductive
                             ? std::abs(now_.moving.current - model_.vehicle.voltage / Z * std::sin(w * now_.t - lag))
                             : 0.0;
  return model_.drive_torque + m.torque_constant * remains;
}

/// True, with the decision, where nothing moves the shaft any more. Wings that still pitch shake it: they can only come
/// to rest, so that a shaft which stands long enough does so for good.
bool DirectStartUp::rests_for_good() {
  const bool no_drive = model_.vehicle.voltage == 0.0 && model_.vehicle.voltage_offset == 0.0 &&
                        std::abs(now_.moving.speed) < 1e-9 * model_.speed_scale &&
                        std::abs(bent()) < 1e-9 * model_.angle_scale && swing_ < 1e-9 * model_.angle_scale &&
                        wings_are_still();
  if (!now_.stuck) stuck_until_ = infinity;
  if (!now_.stuck && !no_drive) return false;
  const StandingTorques<double> torques = model_.standing_torques(now_.moving.angle);
  const double hold = torques.friction(), torque = largest_torque() + std::abs(torques.middle());
  if (now_.stuck && !no_drive) {
    if (torque > hold && model_.wings_rest()) return false;
    if (!model_.wings_rest()) {
      if (stuck_until_ == infinity) stuck_until_ = shaken_until();
      if (now_.t < stuck_until_) return false;
    }
  }
  decide(FlappingStatus::stalled);
  result_.time_to_steady = now_.t;
  result_.lock_angle = now_.moving.angle;
  result_.torque_margin = now_.stuck ? std::max(0.0, hold - torque) : 0.0;
  if (now_.stuck) {
    result_.evidence = {
        .kind = Evidence::held_shaft, .angle = now_.moving.angle, .torque = torque, .friction_torque = hold};
  } else {
    result_.evidence = {.kind = Evidence::no_voltage};
  }
  return true;
}

/// Of wings that pitch: as nearly as the stroke has to be where nothing drives it.
bool DirectStartUp::wings_are_still() const {
  const Coordinates<double>& c = now_.moving;
  return std::abs(c.pitch_angle) + std::abs(c.twist_angle) < 1e-9 * model_.pitch_scale &&
         std::abs(c.pitch_velocity) + std::abs(c.twist_velocity) < 1e-9 * model_.pitch_velocity_scale;
}

/// True, with the decision, where the drive alone cannot break the shaft away and the springs let it creep towards an
/// angle of rest: from standstill to standstill the angle is a monotone map of itself, and slips in one direction end
/// where there are none.
bool DirectStartUp::creeps_to_rest() {
  const double travel = std::max(travel_[0], travel_[1]), back = std::min(travel_[0], travel_[1]);
  const bool creeps =
      now_.stuck && model_.drive_torque <= model_.constant_friction && travel < last_travel_ && back <= 1e-6 * travel;
  creeping_ = creeps ? creeping_ + 1 : 0;
  last_travel_ = travel;
  travel_[0] = travel_[1] = 0.0;
  if (creeping_ < creep_periods) return false;
  decide(FlappingStatus::stalled);
  result_.time_to_steady = now_.t;
  result_.lock_angle = now_.moving.angle;
  result_.torque_margin = model_.constant_friction - model_.drive_torque;
  result_.evidence = {.kind = Evidence::creeping_shaft,
                      .angle = now_.moving.angle,
                      .torque = model_.drive_torque,
                      .friction_torque = model_.constant_friction,
                      .travel = travel};
  return true;
}

}  // namespace wingbeat::detail

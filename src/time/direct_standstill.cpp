// A shaft of a direct drive that comes to rest while it starts up: held for good, or creeping there.
#include <algorithm>
#include <cmath>

#include "time/direct_start_up.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::detail {
namespace {

constexpr int creep_periods = 8;  // of ever shorter slips in one direction, that end at rest

}  // namespace

/// By how much the torques that supply and springs apply to the shaft at rest leave `middle` from now on [N m]: a
/// motor's current is a sine and what remains of its start; a piezo's force follows its voltage, behind a compliant
/// transmission once its tip swings steadily.
double DirectStartUp::largest_torque(double middle) const {
  const Vehicle<double>& v = model_.vehicle;
  const Motor<double>& m = v.motor;
  if (is_given(v.piezo) && !is_compliant(v.piezo)) {
    const std::array<double, max_unknowns> y = model_.coordinates_now();
    const auto off = [&](double phase) { return std::abs(model_.standing_torque(phase * period_, y.data()) - middle); };
    return std::max(off(0.25), off(0.75));
  }
  if (is_given(v.piezo)) {
    const Piezo<double>& p = v.piezo;
    const FlexurePlace<double> flexure = flexure_at(p, now_.moving.angle);
    const double force = force_per_volt_at(p, v.voltage_offset) * v.voltage_offset;
    const double tip = (force + p.series_stiffness * flexure.tip) / (p.stiffness + p.series_stiffness);
    return model_.drive_torque + std::abs(p.series_stiffness * (tip - flexure.tip) / flexure.slope - middle);
  }
  const double w = two_pi * v.drive_frequency;
  const double Z = std::hypot(m.armature_resistance, w * m.armature_inductance);
  const double lag = std::atan2(w * m.armature_inductance, m.armature_resistance);
  const double remains =
      model_.indices.inductive ? std::abs(now_.moving.current - v.voltage / Z * std::sin(w * now_.t - lag)) : 0.0;
  return model_.drive_torque + m.torque_constant * remains + std::abs(middle);
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
  const double hold = torques.friction(), torque = largest_torque(torques.middle());
  if (now_.stuck && !no_drive) {
    // The tip of a compliant piezo that still swings may break the shaft away; if not, a steady period shows it.
    const bool tip_swings = is_given(model_.vehicle.piezo) && is_compliant(model_.vehicle.piezo);
    if ((torque > hold || tip_swings) && model_.wings_rest()) return false;
    if (!model_.wings_rest()) {
      if (stuck_until_ == infinity) stuck_until_ = shaken_until();
      if (now_.t < stuck_until_) return false;
    }
  }
  if (now_.stuck) {
    decide_held(torque, hold);
  } else {
    decide_stalled(0.0, {.kind = Evidence::no_voltage});
  }
  return true;
}

/// The decision that friction `hold` keeps the shaft where it stands against `torque` [N m].
void DirectStartUp::decide_held(double torque, double hold) {
  decide_stalled(std::max(0.0, hold - torque),
                 {.kind = Evidence::held_shaft, .angle = now_.moving.angle, .torque = torque, .friction_torque = hold});
}

/// `margin`: what friction could hold beyond that [N m].
void DirectStartUp::decide_stalled(double margin, StatusEvidence why) {
  decide(FlappingStatus::stalled);
  result_.time_to_steady = now_.t;
  result_.lock_angle = now_.moving.angle;
  result_.torque_margin = margin;
  result_.evidence = std::move(why);
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
  decide_stalled(model_.constant_friction - model_.drive_torque, {.kind = Evidence::creeping_shaft,
                                                                  .angle = now_.moving.angle,
                                                                  .torque = model_.drive_torque,
                                                                  .friction_torque = model_.constant_friction,
                                                                  .travel = travel});
  return true;
}

}  // namespace wingbeat::detail

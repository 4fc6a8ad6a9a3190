#include "time/crank_start_up.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

constexpr double captured_amplitude = 1e-4;  // [rad] swings about a stable equilibrium that are smaller cannot leave
constexpr double captured_creep = 1e-8;      // [rad] the same where friction holds: the angle itself is the answer
constexpr double same_swing = 1e-4;          // [rad] swings with a varying supply that differ less repeat
constexpr double cycle_spread_settled = 1e-2;

}  // namespace

/// True, with the decision, when the crank can no longer leave the stable equilibrium that it swings about or creeps
/// towards: kinetic energy, spring energy above the equilibrium's and inductive energy together only fall, and are
/// small already. With Coulomb friction, the equilibrium is where the torque no longer exceeds it: an overdamped crank
/// creeps there without ever standing still.
bool CrankStartUp::captured() {
  if (model_.supply.type != SupplyType::constant || std::abs(now_.moving.speed) > 0.02 * model_.speed_scale)
    return false;
  const Motor<double>& m = model_.vehicle.motor;
  const double final_current =
      current_within(model_.vehicle.electronics, now_.switched_voltage / circuit_resistance(model_.vehicle));
  if (model_.wingless || model_.vehicle.spring.stiffness == 0.0) {
    if (final_current > 0.0 || std::abs(now_.moving.speed) > 1e-7 * model_.speed_scale) return false;
    rest(now_.moving.angle, false);
    return true;
  }
  const auto excess_torque = [&](double theta) {
    return model_.net_static_torque(theta, final_current) - now_.direction * model_.holding_torque(theta);
  };
  double theta = now_.moving.angle, slope = 0.0;
  for (int k = 0; k < 5; ++k) {
    constexpr double step = 1e-6;
    slope = (excess_torque(theta + step) - excess_torque(theta - step)) / (2.0 * step);
    if (!(slope < 0.0)) return false;
    theta -= excess_torque(theta) / slope;
    if (!(std::abs(theta - now_.moving.angle) < 0.01)) return false;
  }
  const double scale = m.torque_constant * model_.current_scale;
  if (std::abs(excess_torque(theta)) > 1e-9 * scale) return false;
  const bool friction = model_.holding_torque(theta) > 1e-9 * scale;
  const double inertia = effective_inertia(model_.vehicle, model_.kinematics(now_.moving.angle), 0.0);
  const double energy = inertia * square(now_.moving.speed) - slope * square(theta - now_.moving.angle) +
                        m.armature_inductance * square(now_.moving.current - final_current) +
                        2.0 * pitch_energy(model_.vehicle, now_.moving, 0.0);
  if (energy > -slope * square(friction ? captured_creep : captured_amplitude)) return false;
  rest(theta, friction);
  return true;
}

/// With a varying supply: true, with the decision, when the crank swings without rotating and its swings repeat.
bool CrankStartUp::swings_repeat() {
  if (model_.supply.type == SupplyType::constant || now_.t < window_end_) return false;
  const bool same = window_cycles_ == crossings_.size() && std::abs(window_low_ - last_low_) < same_swing &&
                    std::abs(window_high_ - last_high_) < same_swing;
  repeats_ = same ? repeats_ + 1 : 0;
  last_low_ = window_low_;
  last_high_ = window_high_;
  window_low_ = window_high_ = now_.moving.angle;
  window_cycles_ = crossings_.size();
  window_end_ = now_.t + window_;
  if (repeats_ < 3) return false;
  decide(FlappingStatus::locked);
  result_.time_to_steady = now_.t;
  if (model_.supply.type == SupplyType::pwm && stalls(wrap_angle(now_.moving.angle))) return true;
  if (last_high_ - last_low_ < same_swing) result_.lock_angle = wrap_angle(0.5 * (last_low_ + last_high_));
  result_.evidence = {.kind = Evidence::swings, .range = AngleRange{last_low_, last_high_}};
  return true;
}

/// Start of the first cycle from which on every cycle's duration is within 1 % of the period.
double CrankStartUp::time_of_steadiness(double period) const {
  const auto off = [&](std::size_t cycle) { return std::abs(period / cycle_time(cycle) - 1.0); };
  std::size_t cycle = crossings_.size();
  while (cycle > 0 && off(cycle - 1) <= 1e-2) --cycle;
  if (cycle == 0) return 0.0;
  const Crossing& last = crossings_[cycle - 1];
  if (last.skipped == 0.0 || cycle == crossings_.size()) return last.time;
  // Among the cycles left out, which approach the period geometrically.
  const double before = off(cycle - 1), after = std::max(off(cycle), 1e-6);
  return last.time + last.skipped * std::clamp(std::log(before / 1e-2) / std::log(before / after), 0.0, 1.0);
}

void CrankStartUp::flap() {
  done_ = true;
  result_.status = FlappingStatus::flapping;
  const double period =
      options_.metrics ? result_.integrals[std::size_t(Integral::time)] : cycle_time(crossings_.size() - 1);
  result_.time_to_steady = time_of_steadiness(period);
  if (model_.supply.type == SupplyType::constant) {
    result_.settled = true;
    result_.evidence = {.kind = Evidence::settled_cycles,
                        .frequency = 1.0 / period,
                        .time = result_.time_to_steady,
                        .change = change_,
                        .accuracy = options_.metrics && result_.closure > options_.tolerance ? result_.closure : absent,
                        .cycles = int(crossings_.size()),
                        .repeats_after = int(turns_),
                        .extrapolated = jumped_};
    if (pitches(model_.vehicle) && options_.metrics) pitching_.add_to(result_.evidence, model_);
    return;
  }
  result_.settled = result_.cycle_scatter < cycle_spread_settled;
  result_.evidence = {.kind = Evidence::averaged_cycles,
                      .frequency = 1.0 / period,
                      .change = result_.cycle_scatter,
                      .cycles = result_.averaged_cycles,
                      .incommensurate = !result_.settled};
}

/// The motor's against the resistance, on a switched supply of its mean voltage [N m].
double CrankStartUp::stall_torque() const {
  const double v = model_.supply.type == SupplyType::pwm ? model_.vehicle.voltage : model_.supply.voltage;
  const double i = current_within(model_.vehicle.electronics, v / circuit_resistance(model_.vehicle));
  return model_.vehicle.motor.torque_constant * i;
}

/// Whether the motor is too weak for the constant friction, with the decision: that comes before all that else becomes
/// of the crank.
bool CrankStartUp::stalls(double angle) {
  if (stall_torque() > model_.constant_friction) return false;
  result_.status = FlappingStatus::stalled;
  result_.evidence = {.kind = Evidence::stalled_crank,
                      .angle = angle,
                      .torque = stall_torque(),
                      .friction_torque = model_.constant_friction};
  return true;
}

void CrankStartUp::rest(double theta, bool held_by_friction) {
  decide(FlappingStatus::locked);
  now_.moving.angle = theta;
  now_.moving.speed = 0.0;
  const double R = circuit_resistance(model_.vehicle);
  const double mean_current = model_.supply.type == SupplyType::sine ? 0.0 : model_.vehicle.voltage / R;
  const double angle = wrap_angle(theta);
  const double load = std::abs(model_.net_static_torque(theta, mean_current));
  result_.lock_angle = angle;
  result_.torque_margin = held_by_friction ? std::max(0.0, model_.holding_torque(theta) - load) : 0.0;
  result_.time_to_steady = now_.t;
  if (stalls(angle)) return;
  if (held_by_friction) {
    result_.evidence = {.kind = Evidence::friction_holds,
                        .angle = angle,
                        .friction_torque = model_.holding_torque(theta),
                        .torque_margin = *result_.torque_margin};
  } else {
    result_.evidence = {.kind = Evidence::springs_balance, .angle = angle, .torque = stall_torque()};
  }
}

void CrankStartUp::jam(double theta) {
  decide(FlappingStatus::jammed);
  event(Kind::jam);
  result_.time_to_steady = now_.t;
  if (stalls(wrap_angle(theta))) return;
  result_.jam_angle = wrap_angle(theta);
  const CrankKinematics<double> k = model_.kinematics(theta);
  if (k.wing_jacobian <= 2.0 * TimeModel::smallest_margin * typical_lever(model_.vehicle.transmission)) {
    result_.evidence = {.kind = Evidence::lever_vanishes, .angle = *result_.jam_angle, .lever = k.wing_jacobian};
    return;
  }
  result_.evidence = {
      .kind = Evidence::inertia_vanishes, .angle = *result_.jam_angle, .inertia = model_.least_inertia_now()};
}

void CrankStartUp::give_up(StatusEvidence why) {
  done_ = true;
  result_.settled = false;
  const std::size_t n = crossings_.size();
  const bool turning = n >= 2 && now_.t - crossings_.back().time < 3.0 * cycle_time(n - 1);
  result_.status = FlappingStatus::undecided;
  result_.time_to_steady = now_.t;
  if (turning) {
    if (model_.measuring && measured_cycles_ > 0 && model_.supply.type != SupplyType::constant) {
      result_.cycle_scatter = cycle_scatter(std::size_t(measured_cycles_));
    }
    why.frequency = 1.0 / cycle_time(n - 1);
  } else {
    why.range = AngleRange{swing_low_, swing_high_};
  }
  result_.evidence = std::move(why);
}

}  // namespace wingbeat::detail

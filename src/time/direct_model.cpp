#include "time/direct_model.hpp"

#include <algorithm>

#include "time/transient_tools.hpp"
#include "wingbeat/cycle/direct_balance.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {
namespace {

constexpr double stiff_decays_per_period = 500.0;

}  // namespace

DirectModel::DirectModel(const Vehicle<double>& v) : DrivenShaft(v), coupled(inductive ? 3 : 2) {}

void DirectModel::start(double beta, double speed, double current) {
  now = {};
  now.y[0] = beta;
  now.y[1] = speed;
  now.y[2] = inductive ? current : 0.0;
  start_ = {beta, speed, now.y[2]};
  scale_to(vehicle.voltage);
}

void DirectModel::scale_to(double highest_voltage) {
  const Motor<double>& m = vehicle.motor;
  const DirectBalance balance = balance_at(highest_voltage);
  drive_torque = balance.drive_torque;
  holding_torque = balance.breakaway_torque;
  sticks = holding_torque > 0.0;
  const auto typical = typical_from(balance, start_[0], start_[1], start_[2]);
  stroke_scale = typical[0];
  speed_scale = typical[1];
  current_scale = typical[2];

  const double damping = m.viscous_damping + vehicle.friction.damping;
  fastest_decay = inductive ? std::max(m.armature_resistance / m.armature_inductance, damping / inertia)
                            : (damping + square(m.torque_constant) / m.armature_resistance) / inertia;
}

Branch<double> DirectModel::branch_at(const double* y) const {
  const double way = sticks ? now.direction : sign_of(y[1]);
  return {way, 1.0, way, 1.0, sign_of(pitch_margin(vehicle.wings, std::abs(y[1])))};
}

Motion<double> DirectModel::motion(double t, const double* y) const {
  const double i = current_of(t, y), v = voltage(t), springs = springs_of(y[0]);
  const Branch<double> branch = branch_at(y);
  const double omega = now.stuck ? 0.0 : y[1];
  const IntermediateTerms<double> terms = terms_at(vehicle, direct_kinematics<double>(), springs, omega, i, v,
                                                   branch.stroke, branch.direction, branch.pitching);
  Motion<double> m = motion_on(vehicle, terms, i, v, branch);
  if (now.stuck) {
    m.crank_acceleration = m.stroke_acceleration = 0.0;
    m.rod_force = m.stored_moment = springs;
    m.motor_torque = terms.motor.torque;
    m.friction_torque = terms.motor.torque - springs - vehicle.load_torque;
  }
  return m;
}

bool DirectModel::rates(double t, const double* y, double* dy, bool quadrature) const {
  const Motion<double> m = motion(t, y);
  dy[0] = m.stroke_velocity;
  dy[1] = m.crank_acceleration;
  if (inductive) dy[2] = m.inductive_voltage / vehicle.motor.armature_inductance;
  if (quadrature) {
    const CycleIntegrals<double> all = integrands(m, m.stroke_velocity, branch_at(y));
    for (int k = 0; k < quadrature_count; ++k) dy[coupled + k] = all[std::size_t(quadratures[k])];
  }
  return std::isfinite(dy[1]) && std::isfinite(y[coupled - 1]);
}

std::array<double, DirectModel::indicator_count> DirectModel::indicators(double t, const double* y, bool all) const {
  std::array<double, indicator_count> values;
  values[motion_ends] = !sticks     ? 1.0
                        : now.stuck ? (holding_torque - std::abs(net_torque(t, y))) / holding_torque
                                    : y[1] / speed_scale;
  values[stored_moment] = values[velocity] = 1.0;
  if (!all || now.stuck) return values;
  const double torque = vehicle.motor.torque_constant * current_scale;
  values[stored_moment] = motion(t, y).stored_moment / torque;
  values[velocity] = y[1] / speed_scale;
  return values;
}

void DirectModel::begin_piece() {
  if (!sticks) return;
  if (now.stuck) {
    // Without inductance the current jumps with the voltage.
    if (!inductive && std::abs(net_torque(now.t, now.y)) > holding_torque) break_away();
    return;
  }
  now.direction = sign_of(now.y[1]);
  if (now.y[1] == 0.0) come_to_rest();
}

void DirectModel::handle(std::size_t indicator) {
  if (indicator != motion_ends) return;
  now.y[1] = 0.0;
  if (now.stuck) break_away();
}

void DirectModel::tolerated(double relative, const double* y, double* errors) const {
  errors[0] = relative * (std::abs(y[0]) + 0.01 * stroke_scale);
  errors[1] = relative * (std::abs(y[1]) + 0.01 * speed_scale);
  if (inductive) errors[2] = relative * (std::abs(y[2]) + 0.01 * current_scale);
}

bool DirectModel::stiff() const { return fastest_decay * period > stiff_decays_per_period; }

std::optional<TransientEvent::Kind> DirectModel::interrupt() {
  if (now.stuck) {
    break_away();
    return TransientEvent::Kind::breakaway;
  }
  come_to_rest();
  return TransientEvent::Kind::standstill;
}

double DirectModel::largest_net_torque() const {
  // The current is a sine and what remains of its start.
  const Motor<double>& m = vehicle.motor;
  const double Z = std::hypot(m.armature_resistance, w * m.armature_inductance);
  const double lag = std::atan2(w * m.armature_inductance, m.armature_resistance);
  const double remains = inductive ? std::abs(now.y[2] - vehicle.voltage / Z * std::sin(w * now.t - lag)) : 0.0;
  return drive_torque + std::abs(springs_of(now.y[0])) + m.torque_constant * remains;
}

void DirectModel::put_state(TransientResult& in) const {
  in.stroke_angle = now.y[0];
  in.crank_speed = now.y[1];
  in.current = current_of(now.t, now.y);
}

void DirectModel::come_to_rest() {
  now.y[1] = 0.0;
  const double torque = net_torque(now.t, now.y);
  now.stuck = std::abs(torque) <= holding_torque;
  now.direction = sign_of(torque);
}

void DirectModel::break_away() {
  now.stuck = false;
  now.direction = sign_of(net_torque(now.t, now.y));
}

}  // namespace wingbeat::detail

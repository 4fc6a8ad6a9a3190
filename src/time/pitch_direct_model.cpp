#include "time/pitch_direct_model.hpp"

namespace wingbeat::detail {
namespace {

constexpr double stiff_pitch_decays_per_period = 500.0;

}  // namespace

PitchDirectModel::PitchDirectModel(const Vehicle<double>& of, const PitchingWings<double>& pitching)
    : vehicle(of), wings(pitching) {
  validate(vehicle.motor);
  validate(vehicle.friction);
  validate(vehicle.spring);
  validate(vehicle.wings);
  validate(wings, vehicle.wing_count * vehicle.wing_inertia);
  require(vehicle.voltage >= 0.0, "supply.amplitude", "must be >= 0", "V", vehicle.voltage);
  require(vehicle.drive_frequency > 0.0, "supply.frequency", "must be > 0", "Hz", vehicle.drive_frequency);
  w = two_pi * vehicle.drive_frequency;
  period = 1.0 / vehicle.drive_frequency;
  inductive = vehicle.motor.armature_inductance > 0.0;
  coupled = inductive ? 5 : 4;
  stroke_inertia = vehicle.motor.inertia + vehicle.wing_count * vehicle.wing_inertia;
  // What the standing drive's torque does to the inertia within a radian of the supply.
  const Motor<double>& m = vehicle.motor;
  const double torque =
      m.torque_constant * vehicle.voltage / std::hypot(m.armature_resistance, w * m.armature_inductance);
  const double stroke = torque / (stroke_inertia * square(w)) + 1e-12;
  scale = {stroke, w * stroke, stroke, w * stroke, torque / m.torque_constant + 1e-12};
}

void PitchDirectModel::start(const std::array<double, 5>& y) {
  now = {};
  std::copy(y.begin(), y.end(), now.y);
  const double angle = std::max({scale[0], std::abs(y[0]), std::abs(y[2])});
  scale = {angle, std::max(w * angle, std::abs(y[1])), angle, std::max(w * angle, std::abs(y[3])),
           std::max(scale[4], std::abs(y[4]))};
}

PitchMotion<double> PitchDirectModel::motion(double t, const double* y) const {
  const double stroke = sign_of(y[1]), velocity_psi = now.held ? 0.0 : y[3];
  return pitch_motion_on<Vehicle, double>(vehicle, wings, direct_kinematics<double>(),
                                          vehicle.wing_count * vehicle.spring.stiffness * y[0], y[1], current_of(t, y),
                                          voltage(t), y[2], velocity_psi, {stroke, 1.0, stroke, 1.0},
                                          {sign_of(velocity_psi), now.held ? -1.0 : 1.0});
}

bool PitchDirectModel::rates(double t, const double* y, double* dy, bool) const {
  const PitchMotion<double> m = motion(t, y);
  dy[0] = m.stroke.stroke_velocity;
  dy[1] = m.stroke.crank_acceleration;
  dy[2] = now.held ? 0.0 : y[3];
  dy[3] = m.acceleration;
  if (inductive) dy[4] = m.stroke.inductive_voltage / vehicle.motor.armature_inductance;
  return std::isfinite(dy[1]) && std::isfinite(dy[3]) && std::isfinite(y[coupled - 1]);
}

std::array<double, PitchDirectModel::indicator_count> PitchDirectModel::indicators(double t, const double* y) const {
  std::array<double, indicator_count> values = {1.0, y[1] / scale[1], now.held ? 1.0 : y[3] / scale[3]};
  if (now.held) {
    values[stop] = side() * motion(t, y).stop_moment / (stroke_inertia * square(w) * scale[0]);
  } else if (has_stop(wings.hinge)) {
    values[stop] = (wings.hinge.stop - std::abs(y[2])) / wings.hinge.stop;
  }
  return values;
}

void PitchDirectModel::begin_piece() {
  if (!now.held && side() * now.y[2] >= wings.hinge.stop && side() * now.y[3] > 0.0) meet_stop();
}

void PitchDirectModel::handle(std::size_t indicator) {
  if (indicator != stop) return;
  if (now.held) now.held = false;
  else meet_stop();
}

void PitchDirectModel::meet_stop() {
  now.y[2] = side() * wings.hinge.stop;
  const StopImpact<double> impact =
      stop_impact(vehicle, wings, direct_kinematics<double>(), now.y[1], now.y[2], now.y[3]);
  now.y[1] += impact.shaft_speed;
  now.y[3] = 0.0;
  now.impact_loss += impact.energy;
  now.held = true;
  if (side() * motion(now.t, now.y).stop_moment < 0.0) now.held = false;
}

void PitchDirectModel::tolerated(double relative, const double* y, double* errors) const {
  for (int n = 0; n < coupled; ++n) errors[n] = relative * (std::abs(y[n]) + 0.01 * scale[std::size_t(n)]);
}

bool PitchDirectModel::stiff() const {
  const Motor<double>& m = vehicle.motor;
  const double damping = m.viscous_damping + vehicle.friction.damping;
  const double electrical = inductive ? m.armature_resistance / m.armature_inductance
                                      : square(m.torque_constant) / m.armature_resistance / stroke_inertia;
  const double pitching = wings.hinge.damping / wings.pitch_inertia;
  return std::max({electrical, damping / stroke_inertia, pitching}) * period > stiff_pitch_decays_per_period;
}

double PitchDirectModel::stored_energy() const {
  const double* y = now.y;
  const PitchState<double> at = pitch_state(y[2], y[3], y[1]);
  return kinetic_energy(pitch_inertia(wings, stroke_inertia, at), at) +
         0.5 * vehicle.wing_count * vehicle.spring.stiffness * square(y[0]) +
         hinge_loads(wings.hinge, y[2], y[3]).energy +
         0.5 * vehicle.motor.armature_inductance * square(current_of(now.t, y));
}

}  // namespace wingbeat::detail

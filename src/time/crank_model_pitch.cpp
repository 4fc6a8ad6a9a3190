// What a crank in time does where its wings pitch on hinges; model.md section 12.
#include <cmath>

#include "time/crank_model.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::detail {

PitchMotion<double> CrankModel::pitch_motion(double t, const double* y, Branch<double>* used) const {
  const CrankKinematics<double> k = kinematics(y[0]);
  Branch<double> branch = now.branch;
  branch.stroke = sign_of(k.stroke_slope * y[1]);
  const double i = current_of(t, y), v_t = terminal_voltage(vehicle, voltage(t), i);
  const double N_k_beta = spring_moment(vehicle, k);
  const double psi = y[pitch_at()], velocity = now.held ? 0.0 : y[pitch_at() + 1];
  const auto on_branch = [&] {
    return pitch_motion_on<Vehicle, double>(vehicle, vehicle.pitch, k, N_k_beta, y[1], i, v_t, psi, velocity, branch,
                                            {sign_of(velocity), now.held ? -1.0 : 1.0});
  };
  branch.gear = 1.0;
  PitchMotion<double> m = on_branch();
  if (m.stroke.gear_torque < 0.0) {
    branch.gear = -1.0;
    m = on_branch();
  }
  if (used) *used = branch;
  return m;
}

/// The wings at the pitch of the unknowns y while the crank stands.
WingsAtPitch<double> CrankModel::wings_standing(const double* y) const {
  const double velocity = now.held ? 0.0 : y[pitch_at() + 1];
  return wings_at_pitch(vehicle.wings, vehicle.pitch, vehicle.wing_count * vehicle.wing_inertia,
                        pitch_state(y[pitch_at()], velocity, 0.0), 1.0, sign_of(velocity), now.held ? -1.0 : 1.0);
}

/// Their lift [N].
double CrankModel::standing_lift(const double* y, const WingsAtPitch<double>& wings) const {
  const double velocity = now.held ? 0.0 : y[pitch_at() + 1];
  return lift_at_pitch(vehicle.pitch, wings, pitch_state(y[pitch_at()], velocity, 0.0), 0.0, wings.free_acceleration);
}

double CrankModel::uniqueness_at(const double* y) const {
  if (!pitching) return uniqueness(vehicle, y[0]);
  const CrankKinematics<double> k = kinematics(y[0]);
  const double lever = k.wing_jacobian / typical_lever(vehicle.transmission);
  if (!(lever > 0.0)) return lever;
  const double A = wings_standing(y).inertia * k.stroke_slope / k.wing_jacobian, radius = vehicle.friction.radius;
  const double least = rotor_inertia() + std::min(A * (k.crank_jacobian + radius), A * (k.crank_jacobian - radius));
  return std::min(lever, least / vehicle.motor.inertia);
}

double CrankModel::uniqueness_now() const {
  double y[5];
  unknowns(y);
  return uniqueness_at(y);
}

double CrankModel::least_inertia_now() const {
  if (!pitching) return min_inertia(vehicle, kinematics(now.theta));
  return uniqueness_now() * vehicle.motor.inertia;
}

StandingTorques<double> CrankModel::standing_torques(const double* y) const {
  const CrankKinematics<double> k = kinematics(y[0]);
  return wingbeat::standing_torques(vehicle, k,
                                    (spring_moment(vehicle, k) + wings_standing(y).moment) / k.wing_jacobian);
}

double CrankModel::pitch_energy(double stroke_velocity) const {
  if (!pitching) return 0.0;
  const PitchState<double> state = pitch_state(now.psi, now.pitch_velocity, stroke_velocity);
  return hinge_loads(vehicle.pitch.hinge, now.psi, now.pitch_velocity).energy +
         kinetic_energy(pitch_inertia(vehicle.pitch, 0.0, state), state);
}

void CrankModel::resume() {
  const double stop_angle = vehicle.pitch.hinge.stop, side = sign_of(now.psi);
  if (pitching && !now.held && side * now.psi >= stop_angle && side * now.pitch_velocity > 0.0) meet_stop();
}

/// The wings meet a stop. A crank that the blow brings to rest turns back where the lever of the rod exceeds that of
/// friction, as does one that friction holds; else the stop takes what is left.
void CrankModel::meet_stop() {
  const double side = sign_of(now.psi);
  now.psi = side * vehicle.pitch.hinge.stop;
  now.held = true;
  if (uniqueness_now() <= smallest_margin) {
    now.jammed = true;
    return;
  }
  const CrankKinematics<double> k = kinematics(now.theta);
  const auto impact = [&](double direction, double left) {
    return stop_impact(vehicle, vehicle.pitch, k, now.omega, now.psi, now.pitch_velocity, direction, left);
  };
  const auto pass = [&](const StopImpact<double>& passed, double left) {
    now.omega += passed.shaft_speed;
    now.pitch_velocity = left;
    now.impact_loss += passed.stop_work;
    const CycleIntegrals<double> at_once = wingbeat::impulses(passed);
    for (std::size_t q = 0; q < at_once.size(); ++q) now.impulses[q] += at_once[q];
    if (passed.shaft_speed != 0.0) now.stuck = false;
  };
  if (now.omega != 0.0) {
    const double direction = sign_of(now.omega);
    const StopImpact<double> whole = impact(direction, 0.0);
    if (direction * (now.omega + whole.shaft_speed) < 0.0) {
      const double left = (1.0 + now.omega / whole.shaft_speed) * now.pitch_velocity;
      pass(impact(direction, left), left);
      now.omega = 0.0;
    } else {
      pass(whole, 0.0);
    }
  }
  if (now.omega == 0.0 && now.pitch_velocity != 0.0) {
    const double coupling = (vehicle.pitch.mass_product + vehicle.pitch.air.rp) * std::cos(now.psi);
    const double direction = sign_of(coupling * now.pitch_velocity * k.crank_jacobian);
    const StopImpact<double> turning = impact(direction, 0.0);
    pass(direction * turning.shaft_speed > 0.0
             ? turning
             : stop_impact_standing(vehicle, vehicle.pitch, k, now.psi, now.pitch_velocity),
         0.0);
  }
  if (!inductive) now.i = algebraic_current(vehicle, voltage(now.t), now.omega);
  now.branch.direction = now.omega != 0.0 ? sign_of(now.omega) : now.branch.direction;
  double y[5];
  unknowns(y);
  const bool stands = now.stuck || now.omega == 0.0;
  // The impact may have turned the rod force over; its sign may depend on that of the gear torque.
  for (int sweep = 0; sweep < 2 && !stands; ++sweep) now.branch.force = sign_of(motion(now.t, y).force_switch);
  const double presses = stands ? wings_standing(y).pitching_moment : pitch_motion(now.t, y).stop_moment;
  if (side * presses < 0.0) now.held = false;
}

/// Room to the stop or, of wings that it holds, how they press on it [1].
double CrankModel::stop_room(double t, const double* y) const {
  const double stop_angle = vehicle.pitch.hinge.stop;
  if (!has_stop(vehicle.pitch.hinge)) return 1.0;
  if (!now.held) return (stop_angle - std::abs(y[pitch_at()])) / stop_angle;
  const double moment = now.stuck ? wings_standing(y).pitching_moment : pitch_motion(t, y).stop_moment;
  return sign_of(y[pitch_at()]) * moment / (vehicle.pitch.pitch_inertia * speed_scale * pitch_velocity_scale);
}

}  // namespace wingbeat::detail

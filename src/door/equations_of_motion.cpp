#include <cmath>

#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat {

EquationsOfMotion::EquationsOfMotion(const Design<double>& design, Condition condition)
    : supply_(design.supply), direct_(drive_of(design).alternating) {
  validate(design);
  vehicle_ = switched_on(resolve(design, condition));
  inductive_ = has_current_state(vehicle_);
  pitching_ = pitches(vehicle_);
}

PitchMotion<double> EquationsOfMotion::motion(const double* state, double current, double voltage) const {
  const double theta = state[0], omega = state[1];
  const CrankKinematics<double> k =
      direct_ ? direct_kinematics<double>() : crank_kinematics(vehicle_.transmission, std::sin(theta), std::cos(theta));
  const double N_k_beta =
      direct_ ? vehicle_.wing_count * vehicle_.spring.stiffness * theta : spring_moment(vehicle_, k);
  Branch<double> branch{1.0, 1.0, sign_of(omega), 1.0};
  branch.stroke = sign_of(k.stroke_slope * omega);
  branch.pitching = sign_of(pitch_margin(vehicle_.wings, std::abs(k.stroke_slope * omega)));
  const auto on_branch = [&]() -> PitchMotion<double> {
    if (!pitching_) {
      const Instant<double> at = instant_at(vehicle_, k, N_k_beta, omega, current, voltage, branch.stroke,
                                            branch.direction, branch.pitching, branch.gear);
      branch.force = sign_of(at.force_switch);
      return {motion_on(vehicle_, at, current, voltage, branch), 0.0, 0.0, 0.0, 0.0};
    }
    const double psi = state[state_count() - 2], velocity = state[state_count() - 1];
    const auto on_force_branch = [&] {
      return pitch_motion_on<Vehicle, double>(vehicle_, vehicle_.pitch, k, N_k_beta, omega, current, voltage, psi,
                                              velocity, branch, {sign_of(velocity), 1.0});
    };
    // The sign of the force is the same on either branch.
    branch.force = sign_of(on_force_branch().stroke.force_switch);
    return on_force_branch();
  };
  PitchMotion<double> m = on_branch();
  if (m.stroke.gear_torque < 0.0 && !direct_) {
    branch.gear = -1.0;
    m = on_branch();
  }
  return m;
}

void EquationsOfMotion::rates(double time, const double* state, double* derivatives,
                              std::optional<double> voltage) const {
  if (!voltage) {
    voltage =
        direct_ ? vehicle_.voltage * std::sin(two_pi * vehicle_.drive_frequency * time) : voltage_at(supply_, time);
  }
  const double current = inductive_ ? state[2] : algebraic_current(vehicle_, *voltage, state[1]);
  const PitchMotion<double> m = motion(state, current, terminal_voltage(vehicle_, *voltage, current));
  derivatives[0] = state[1];
  derivatives[1] = m.stroke.crank_acceleration;
  if (inductive_) derivatives[2] = m.stroke.inductive_voltage / vehicle_.motor.armature_inductance;
  if (!pitching_) return;
  derivatives[state_count() - 2] = state[state_count() - 1];
  derivatives[state_count() - 1] = m.acceleration;
}

}  // namespace wingbeat

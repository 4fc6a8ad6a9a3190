#include <cmath>
#include <memory>

#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/motion.hpp"
#include "wingbeat/vehicle/pitch_motion.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat {
namespace {

/// Of wings that do not pitch the acceleration of the pitch is 0; of those that do, `state` holds pitch angle and pitch
/// velocity at `pitch` and behind it.
PitchMotion<double> motion_at_state(const Vehicle<double>& vehicle, const double* state, std::size_t pitch,
                                    double current, double voltage) {
  const bool direct = drive_of(vehicle).alternating;
  const double theta = state[0], omega = state[1];
  const CrankKinematics<double> k =
      direct ? direct_kinematics<double>() : crank_kinematics(vehicle.transmission, std::sin(theta), std::cos(theta));
  const double N_k_beta = direct ? vehicle.wing_count * vehicle.spring.stiffness * theta : spring_moment(vehicle, k);
  Branch<double> branch{1.0, 1.0, sign_of(omega), 1.0};
  branch.stroke = sign_of(k.stroke_slope * omega);
  branch.pitching = sign_of(pitch_margin(vehicle.wings, std::abs(k.stroke_slope * omega)));
  const auto on_branch = [&]() -> PitchMotion<double> {
    if (!pitches(vehicle)) {
      const IntermediateTerms<double> terms = terms_at(vehicle, k, N_k_beta, omega, current, voltage, branch.stroke,
                                                       branch.direction, branch.pitching, branch.gear);
      branch.force = sign_of(terms.force_switch);
      return {motion_on(vehicle, terms, current, voltage, branch), 0.0, 0.0, 0.0, 0.0};
    }
    const double psi = state[pitch], velocity = state[pitch + 1];
    const auto on_force_branch = [&] {
      return pitch_motion_on<Vehicle, double>(vehicle, vehicle.pitch, k, N_k_beta, omega, current, voltage, psi,
                                              velocity, branch, {sign_of(velocity), 1.0});
    };
    // The sign of the force is the same on either branch.
    branch.force = sign_of(on_force_branch().stroke.force_switch);
    return on_force_branch();
  };
  PitchMotion<double> m = on_branch();
  if (m.stroke.gear_torque < 0.0 && !direct) {
    branch.gear = -1.0;
    m = on_branch();
  }
  return m;
}

}  // namespace

EquationsOfMotion::EquationsOfMotion(const Design<double>& design, Condition condition)
    : supply_(design.supply), direct_(drive_of(design).alternating) {
  validate(design);
  vehicle_ = std::make_shared<const Vehicle<double>>(switched_on(resolve(design, condition)));
  inductive_ = has_current_state(*vehicle_);
  pitching_ = pitches(*vehicle_);
}

void EquationsOfMotion::rates(double time, const double* state, double* derivatives,
                              std::optional<double> voltage) const {
  const Vehicle<double>& vehicle = *vehicle_;
  const std::size_t pitch = state_count() - 2;
  if (!voltage) {
    voltage = direct_ ? vehicle.voltage * std::sin(two_pi * vehicle.drive_frequency * time) : voltage_at(supply_, time);
  }
  const double current = inductive_ ? state[2] : algebraic_current(vehicle, *voltage, state[1]);
  const PitchMotion<double> m =
      motion_at_state(vehicle, state, pitch, current, terminal_voltage(vehicle, *voltage, current));
  derivatives[0] = state[1];
  derivatives[1] = m.stroke.crank_acceleration;
  if (inductive_) derivatives[2] = m.stroke.inductive_voltage / vehicle.motor.armature_inductance;
  if (!pitching_) return;
  derivatives[pitch] = state[pitch + 1];
  derivatives[pitch + 1] = m.acceleration;
}

}  // namespace wingbeat

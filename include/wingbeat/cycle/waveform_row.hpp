// One instant of a cycle with all that acts, as waveforms hold it.
#pragma once

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/vehicle/forward.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// One instant of a flapping cycle, in the order of a waveform file (all SI, angle of attack in degrees). Current,
/// lift, moments, torques and powers are the sums of all motors, the rod force is that of one.
struct WaveformRow {
  double time;                 ///< since crank angle 0; direct drive: since the supply's phase 0 [s]
  double crank_angle;          ///< theta; direct drive: of the shaft, which is the stroke angle [rad]
  double crank_speed;          ///< omega [rad/s]
  double current;              ///< i [A]
  double stroke_angle;         ///< beta [rad]
  double flapping_velocity;    ///< beta' [rad/s]
  double angle_of_attack_deg;  ///< alpha [deg]
  double lift;                 ///< [N]
  double aero_moment;          ///< M_aero [N m]
  double rod_force;            ///< F [N]; absent where there is no rod
  double motor_torque;         ///< T_m [N m]
  double friction_torque;      ///< T_f [N m]
  double voltage;              ///< v at the motor terminals [V]
  double power_electrical;     ///< v i [W]
  double power_motor;          ///< T_m omega [W]
  double power_friction;       ///< T_f omega [W]
  double power_aerodynamic;    ///< M_aero beta', of wings on pitch hinges with M_pitch psi' [W]
  double spring_moment;        ///< N_w k beta of all hinge springs [N m], towards stroke angle zero
  double inertial_moment;      ///< N_w J_w beta'' of all wings [N m]
  double pitch_angle;          ///< psi [rad]; absent where it follows from the angle of attack by the pitch law
};

/// What acts at one instant, as a row: `stroke_angle` beta and `shaft_angle` theta [rad], omega [rad/s].
WaveformRow waveform_row(const Vehicle<double>& vehicle, const Motion<double>& motion, double time, double shaft_angle,
                         double shaft_speed, double stroke_angle, double pitch_angle = absent);

}  // namespace wingbeat

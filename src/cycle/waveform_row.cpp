#include "wingbeat/cycle/waveform_row.hpp"

#include "wingbeat/core/math.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

WaveformRow waveform_row(const Vehicle<double>& v, const Motion<double>& m, double time, double shaft_angle,
                         double shaft_speed, double stroke_angle, double pitch_angle) {
  const double spring_moment = v.wing_count * spring_loads(v.spring, stroke_angle).moment;
  WaveformRow row;
  row.time = time;
  row.crank_angle = shaft_angle;
  row.crank_speed = shaft_speed;
  row.current = m.current;
  row.stroke_angle = stroke_angle;
  row.flapping_velocity = m.stroke_velocity;
  row.angle_of_attack_deg = degrees_per_radian * m.aero.angle_of_attack;
  row.lift = m.aero.lift;
  row.aero_moment = m.aero.moment;
  row.rod_force = drive_of(v).has_rod ? m.rod_force / v.motors : absent;
  row.motor_torque = m.motor_torque;
  row.friction_torque = m.friction_torque;
  row.voltage = m.voltage;
  row.power_electrical = m.voltage * m.current;
  row.power_motor = m.motor_torque * shaft_speed;
  row.power_friction = m.friction_torque * shaft_speed;
  row.power_aerodynamic = m.aero.power;
  row.spring_moment = spring_moment;
  row.inertial_moment = v.wing_count * v.wing_inertia * m.stroke_acceleration;
  row.pitch_angle = pitch_angle;
  return row;
}

}  // namespace wingbeat

// Where the mechanism can stand still or jam, from its geometry and statics alone; model.md section 2, "Not flapping".
#pragma once

#include <optional>
#include <vector>

#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// Crank angles over which the crank stays once it has come to rest.
struct LockInterval {
  double from;    ///< [rad], 0 to 2 pi
  double to;      ///< [rad], > from; may exceed 2 pi where the interval holds theta = 0
  double angle;   ///< where the margin is largest [rad], 0 to 2 pi
  double margin;  ///< there: mu r_e |F_s| + T_c - |K v/(R_a + R_i) - F_s h| [N m], >= 0
};

struct StaticBalance {
  double stall_torque;       ///< K v / (R_a + R_i) [N m]
  double breakaway_torque;   ///< T_c, the constant friction that holds the motor [N m]
  double inertia_least;      ///< least J + A (h + s mu r_e) over crank angle and branch [kg m2]; <= 0 jams
  double inertia_angle;      ///< crank angle of it [rad]
  double lever_least;        ///< least wing lever g over crank angle [m]; <= 0 jams
  double lever_angle;        ///< crank angle of it [rad]
  double advance_least;      ///< least K v/(R_a + R_i) - F_s h - mu r_e |F_s| - T_c over crank angle [N m]; <= 0: locks exist
  double advance_angle;      ///< crank angle of it [rad]
  bool has_wings;            ///< false: rod force zero, nothing can jam or lock

  bool stalled() const { return stall_torque <= breakaway_torque; }
  bool can_jam() const { return has_wings && (inertia_least <= 0.0 || lever_least <= 0.0); }
  bool can_lock() const { return has_wings && advance_least <= 0.0; }
};

/// K v / (R_a + R_i) [N m].
inline double stall_torque(const Vehicle<double>& v) {
  return v.motor.torque_constant * v.voltage / circuit_resistance(v);
}

/// T_c, the constant friction that holds the motor at rest, its own included [N m].
inline double breakaway_torque(const Vehicle<double>& v) { return v.friction.torque + v.motor.friction_torque; }

/// Torque that would start the crank forward from rest at an angle: K v/(R_a + R_i) - F_s h - mu r_e |F_s| - T_c [N m], with the
/// static rod force F_s = N_w k beta / g.
double advance_torque(const Vehicle<double>& vehicle, double crank_angle);

/// mu r_e |F_s| + T_c - |K v/(R_a + R_i) - F_s h| [N m]: >= 0 where a crank at rest stays.
double lock_margin(const Vehicle<double>& vehicle, double crank_angle);

StaticBalance static_balance(const Vehicle<double>& vehicle);

/// All intervals in which the crank locks, in order of crank angle; empty unless static_balance().can_lock().
std::vector<LockInterval> lock_intervals(const Vehicle<double>& vehicle);

/// Crank speeds [rad/s], lowest first, at which the motor's mean torque balances the mean load of a lap at constant
/// speed: first guesses for periodic orbits. More than one hints at several orbits. Empty: the load stalls the motor.
std::vector<double> balanced_speeds(const Vehicle<double>& vehicle);

}  // namespace wingbeat

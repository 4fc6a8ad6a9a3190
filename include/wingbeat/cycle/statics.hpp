// What statics find of a mechanism, as plain numbers: where it can stand still or jam. How: cycle/static_balance.hpp.
#pragma once

namespace wingbeat {

/// Crank angles over which the crank stays once it has come to rest.
struct LockInterval {
  double from;    ///< [rad], 0 to 2 pi
  double to;      ///< [rad], > from; may exceed 2 pi where the interval holds theta = 0
  double angle;   ///< where the margin is largest [rad], 0 to 2 pi
  double margin;  ///< there: mu r_e |F_s| + T_c - |K v/(R_a + R_i) - F_s h| [N m], >= 0
};

struct StaticBalance {
  double stall_torque;      ///< K v / (R_a + R_i) [N m]
  double breakaway_torque;  ///< T_c, the constant friction that holds the motor [N m]
  // Least values that are far from zero, beyond 0.3 J, 0.1 of a lever and 0.2 of the stall torque, are about the least.
  double inertia_min;    ///< least J + A (h + s mu r_e) over crank angle and branch [kg m2]; <= 0 jams
  double inertia_angle;  ///< crank angle of it [rad]
  double lever_min;      ///< least wing lever g over crank angle [m]; <= 0 jams
  double lever_angle;    ///< crank angle of it [rad]
  double advance_min;    ///< least K v/(R_a + R_i) - F_s h - mu r_e |F_s| - T_c over crank angle [N m]; <= 0: locks
                         ///< exist (of a gearbox that loses torque: advance_torque())
  double advance_angle;  ///< crank angle of it [rad]
  bool has_wings;        ///< false: rod force zero, nothing can jam or lock

  bool stalled() const { return stall_torque <= breakaway_torque; }
  bool can_jam() const { return has_wings && (inertia_min <= 0.0 || lever_min <= 0.0); }
  bool can_lock() const { return has_wings && advance_min <= 0.0; }
};

}  // namespace wingbeat

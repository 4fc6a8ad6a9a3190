// The cycle-to-cycle linear model of steady flapping, which controllers are designed on: the return map and the means
// of a cycle, linearised about the orbit by dual numbers along the recorded cycle.
//
//   x_{k+1} = A x_k + B u_k,   y_k = C x_k + D u_k
//
// All are deviations from the orbit. x_k is the state where cycle k begins: at crank angle 0, of a direct drive at
// phase 0 of its supply. u_k holds throughout cycle k, and y_k are the means of cycle k. What cycle/orbit_gradient.hpp
// closes to the orbit's derivatives, C (I - A)^-1 B + D, is open here.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/parts/supply.hpp"

namespace wingbeat {

/// A state, an input or an output.
struct CycleSignal {
  std::string name;  ///< "crank_speed"
  std::string unit;  ///< SI
  double value;      ///< on the orbit
  bool operator==(const CycleSignal&) const = default;
};

/// Deviations from the orbit: x the state where cycle k begins, u what is held throughout it, y its means.
/// \f[
/// x_{k+1} = A x_k + B u_k, \qquad y_k = C x_k + D u_k
/// \f]
struct CycleMap {
  double period = absent;  ///< of the orbit [s]
  /// crank_speed or stroke_angle and flapping_velocity; current, where there is an inductance; of wings on hinges
  /// pitch_angle and pitch_velocity.
  std::vector<CycleSignal> states;
  /// voltage [V] or, of a pwm supply, duty [1], of a sine the amplitude; load_torque on crank or shaft, of all motors
  /// together, against a positive speed [N m]; of a direct drive also frequency of the supply [Hz] and spring_stiffness
  /// of each hinge [N m/rad].
  std::vector<CycleSignal> inputs;
  /// Means of a cycle: lift_mean [N], power_electrical [W], current_mean [A], power_aerodynamic [W]; of a crank
  /// crank_speed_mean = 2 pi f [rad/s] and frequency [Hz].
  std::vector<CycleSignal> outputs;
  Eigen::MatrixXd a, b, c, d;  ///< SI per SI unit
};

/// Of a vehicle that flaps, `orbit` being what was found for it on `supply`; the motor stays at the orbit's
/// temperatures, which change over many cycles. Empty (no states) where the cycle was simulated in time, so that there
/// is no orbit.
CycleMap cycle_map(const SteadyFlapping& orbit, const Vehicle<double>& vehicle, const Supply<double>& supply);

}  // namespace wingbeat

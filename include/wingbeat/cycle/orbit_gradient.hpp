// Exact derivatives of steady flapping by the vehicle's parameters: dual numbers along the recorded cycle, closed by
// the implicit function theorem.
//
// The orbit is the fixed point y = P(y, p) of the return map, so dy/dp = (I - dP/dy)^-1 dP/dp. One repetition of the
// cycle gives both Jacobians, and those of all integrals and peaks by y and p; the chain rule does the rest. With the
// frequency held, the voltage follows: dv/dp = -(df/dp) / (df/dv).
//
// Steps and branches stay frozen although the parameters move the places where the rod force or the stored power
// changes sign. That is exact: the right-hand side and the integrands are continuous there, so a moving boundary adds
// nothing to a first derivative. It must lie where the sign changes, though: the recorded nodes are moved there first.
// An impact on a stop moves the state, and the place where it does moves: its saltation matrix is a part of dP/dy and
// dP/dp, and what jumps there is differentiated where it goes.
// A motor that heats up has its temperatures from a fixed point around the orbit, which is closed in the same way.
// The derivatives are about as accurate as the orbit. Peaks are differentiated at their fixed place (envelope theorem).
#pragma once

#include <vector>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/metric_gradients.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// A number that is parameter k of those differentiated, 0 <= k < gradient_parameters.
inline GradientJet gradient_seed(double value, int k) { return GradientJet(value, gradient_first_slot + k); }

/// What was differentiated: the orbit's vehicle, its numbers built from gradient_seed(), and what metrics need beside
/// it.
struct GradientVehicle {
  Vehicle<GradientJet> vehicle;
  GradientJet mass = GradientJet(absent);                   ///< [kg]
  GradientJet bench_torque_constant = GradientJet(absent);  ///< [N m/A]
};
GradientVehicle gradient_vehicle(const Design<GradientJet>& design, Condition condition);

/// What acts at one instant of the cycle.
template <class S>
struct InstantValues {
  S time;               ///< since the phase 0 [s]
  S crank_speed;        ///< omega [rad/s]
  S current;            ///< i [A]
  S voltage;            ///< v at the motor's terminals [V]
  S stroke_angle;       ///< beta [rad]
  S flapping_velocity;  ///< beta' [rad/s]
  S pitch_angle;        ///< psi [rad]; absent under the pitch law
  S lift;               ///< [N]
  S rod_force;          ///< F [N]; absent without a rod
  S motor_torque;       ///< T_m [N m]
};

/// One instant of the cycle at a fixed crank angle, or phase of a direct drive's supply.
struct GradientInstant : InstantValues<GradientJet> {
  InstantValues<double> slopes;  ///< along the cycle, by that angle [1/rad]
};

/// The derivative by parameter k is `metrics[m].v[gradient_first_slot + k]`; slot gradient_voltage_slot holds the one
/// by the voltage at the motor, 0 with the frequency held.
struct OrbitGradient {
  Metrics<GradientJet> metrics;
  std::vector<GradientInstant> instants;
  /// False: I - dP/dy (or df/dv) is singular, or the motor's temperatures do not settle; there are no derivatives.
  bool regular = true;
};

/// Derivatives of every metric but floquet_multiplier_max (which needs second ones: absent), in SI like the metrics.
/// Absent too: by the inductance of a vehicle without one, by a gear efficiency of 1. `orbit` must be
/// flapping and `vehicle` the one it was found for; `orbit.record` is the cycle repeated. The start y of the orbit is
/// the fixed point of the return map, \f$y = P(y, p)\f$; with the frequency held the voltage v follows the parameter p:
/// \f[
/// \frac{\mathrm{d}y}{\mathrm{d}p}
/// = \left( I - \frac{\partial P}{\partial y} \right)^{-1} \frac{\partial P}{\partial p}, \qquad
/// \left. \frac{\mathrm{d}v}{\mathrm{d}p} \right|_f = -\frac{\mathrm{d}f/\mathrm{d}p}{\mathrm{d}f/\mathrm{d}v}
/// \f]
OrbitGradient orbit_gradient(const SteadyFlapping& orbit, const GradientVehicle& vehicle,
                             const GradientOptions& options = {});

}  // namespace wingbeat

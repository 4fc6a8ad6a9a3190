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

#include <functional>
#include <span>
#include <vector>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/cycle/steady_flapping.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// Parameters differentiated side by side. A dual number also carries the states: two and the voltage, or the three of
/// a direct drive with inductance. Systems with more states have wider ones of their own (cycle_gradient.hpp).
inline constexpr int gradient_parameters = 5;
inline constexpr int gradient_voltage_slot = 2;
inline constexpr int gradient_first_slot = 3;
inline constexpr int gradient_slots = gradient_first_slot + gradient_parameters;
using GradientJet = Jet<gradient_slots>;

/// A number that is parameter k of those differentiated, 0 <= k < gradient_parameters.
inline GradientJet gradient_seed(double value, int k) { return GradientJet(value, gradient_first_slot + k); }

/// What stays as it is while a parameter changes.
enum class Held {
  voltage,
  frequency  ///< the supply's voltage follows, whatever it was given as; a direct drive has its frequency from the
             ///< supply
};

/// What was differentiated: the orbit's vehicle, its numbers built from gradient_seed(), and what metrics need beside
/// it.
struct GradientVehicle {
  Vehicle<GradientJet> vehicle;
  GradientJet mass = GradientJet(absent);                   ///< [kg]
  GradientJet bench_torque_constant = GradientJet(absent);  ///< [N m/A]
};
GradientVehicle gradient_vehicle(const Design<GradientJet>& design, Condition condition);

struct GradientOptions {
  Held held = Held::voltage;
  bool peaks = true;  ///< false: the metrics that are peaks (is_peak()) have values alone, their derivatives are absent
  std::span<const double> crank_angles = {};  ///< instants of the cycle wanted, 0 to 2 pi [rad]
};

/// True of metrics whose derivatives cost a search for peaks along the cycle, or as much.
bool is_peak(Metric which, const Drive& drive);

/// One instant of the cycle at a fixed crank angle, in the order of WaveformRow.
struct GradientInstant {
  GradientJet crank_speed;        ///< omega [rad/s]
  GradientJet current;            ///< i [A]
  GradientJet flapping_velocity;  ///< beta' [rad/s]
  GradientJet lift;               ///< [N]
  GradientJet rod_force;          ///< F [N]
  GradientJet motor_torque;       ///< T_m [N m]
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

/// A parameter of a design: how to set it for plain and for dual numbers; false if the design has no place for it.
struct DesignParameter {
  std::string key;   ///< as in a vehicle file: "friction.radius"
  std::string unit;  ///< SI
  bool (*set)(Design<double>&, const double&) = nullptr;
  bool (*set_jet)(Design<GradientJet>&, const GradientJet&) = nullptr;
  std::optional<double> (*value)(const Design<double>&) = nullptr;
};

/// Derivatives of all metrics by any number of parameters.
struct MetricGradients {
  std::vector<std::array<double, metric_count>> by_parameter;
  std::array<double, metric_count>
      by_voltage{};     ///< by the motor's; 0 with the frequency held, absent for a direct drive
  bool regular = true;  ///< as in OrbitGradient
};

/// orbit_gradient() of a design for any number of parameters, gradient_parameters at a time. A parameter that the
/// design has no place or no value for throws ParameterError. The record's voltage replaces the design's.
MetricGradients metric_gradients(const Design<double>& design, Condition condition, const SteadyFlapping& orbit,
                                 std::span<const DesignParameter> parameters, const GradientOptions& options = {});

}  // namespace wingbeat

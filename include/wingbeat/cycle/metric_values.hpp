// The metrics of a cycle and its integrals as plain numbers, and what they are called; cycle/metrics.hpp has what they
// are computed by.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>

#include "wingbeat/core/scalar.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

/// Every metric of a cycle, in the order of reports and data sets.
enum class Metric {
  voltage,
  frequency,
  current_mean,
  current_peak,
  current_rms,
  power_electrical,
  power_motor,
  power_motor_reference,
  power_friction,
  power_aerodynamic,
  power_reactive,
  power_copper,
  power_viscous,
  power_motor_friction,
  power_gear,
  power_loss,
  power_residual,
  lift_mean,
  lift_peak,
  rod_force_peak,
  rod_force_mean,
  stroke_amplitude,
  flapping_velocity_peak,
  angle_of_attack_min,
  crank_speed_min,
  crank_speed_max,
  efficiency_system,
  efficiency_motor,
  efficiency_mechanism,
  floquet_multiplier_max,
  lift_to_weight,
  winding_temperature,
  case_temperature,
  winding_temperature_margin,
  added_mass_inertia_ratio,
  power_hinge,
  pitch_amplitude,
  pitch_phase,
  angle_of_attack_max,
  lift_added_mass_share,
  reynolds_number,
  hover,     ///< as the next
  endurance  ///< of a flight, not of a cycle: absent unless a study asks for it
};
inline constexpr int metric_count = int(Metric::endurance) + 1;

/// How a metric is named outside the program.
struct MetricInfo {
  const char* key;        ///< as in JSON and data sets, e.g. "frequency_hz"
  const char* unit;       ///< UDUNITS
  const char* long_name;  ///< plain words
};

/// Names, units and descriptions of all metrics, indexed by Metric.
const std::array<MetricInfo, metric_count>& metric_table();
inline const MetricInfo& metric_info(Metric metric) { return metric_table()[std::size_t(metric)]; }

/// The metric with that key, or metric_count if there is none.
int metric_index(std::string_view key);

/// Stands for a metric that a design does not have (no mass given, 0/0); reported as null.
inline constexpr double absent = std::numeric_limits<double>::quiet_NaN();

template <Scalar S>
struct Metrics {
  std::array<S, metric_count> values;

  S& operator[](Metric m) { return values[std::size_t(m)]; }
  const S& operator[](Metric m) const { return values[std::size_t(m)]; }
};

/// What a metric's errors are a part of: its magnitude, or more where it may vanish. The angle of attack to 90 degrees,
/// the residual power and a gearbox's loss to the input, the mean lift and its ratio to the weight to a thousandth of
/// the peak lift, the least crank speed to a hundredth of the largest, the mean current of a direct drive, which
/// alternates, to its peak, temperatures to about the absolute one. Not a number for a metric that is absent.
double error_scale(const Metrics<double>& metrics, Metric which);

/// Quantities integrated over the TIME of a cycle.
enum class Integral {
  time,             ///< dt: the period [s]
  current,          ///< i [A s]
  current_square,   ///< i^2
  speed_square,     ///< omega^2
  electrical_work,  ///< v i [J] (eq 15)
  motor_work,       ///< T_m omega [J] (eq 16)
  friction_work,    ///< T_f omega [J] (eq 18), without the motor's own friction
  aero_work,        ///< M_aero beta' [J] (eq 19), of wings on pitch hinges with M_pitch psi'
  reactive_work,    ///< |(N_w J_w beta'' + N_w k beta) beta'| [J] (eq 23)
  residual_work,    ///< F (h omega - g beta') [J]: what the formulation fails to conserve
  lift,             ///< lift [N s]
  rod_force,        ///< |F| [N s]
  gear_work,        ///< (1 - e) T_g omega [J], lost in the gearbox
  travel            ///< |omega|: what crank or shaft turns by [rad]
};
inline constexpr int integral_count = int(Integral::travel) + 1;

template <Scalar S>
using CycleIntegrals = std::array<S, integral_count>;

/// What metrics need beside the motion itself.
template <Scalar S>
struct ReportingOf {
  S mass = S(absent);                   ///< [kg]
  S bench_torque_constant = S(absent);  ///< K_ref of eq (17) [N m/A]
};
using Reporting = ReportingOf<double>;
Reporting reporting_of(const Design<double>& design);

/// The key that a design would have to state for a metric of the motor's heat; null where the metric is none, or known.
const char* lacking_of_heat(Metric metric, const Design<double>& design);
/// The key that a design would have to state for a metric of a part that it leaves out; null where nothing is missing.
const char* missing_key(Metric metric, const Design<double>& design);

}  // namespace wingbeat

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
  voltage,                     ///< \f$v\f$ at the motor's terminals; of a direct drive its amplitude [V]
  frequency,                   ///< \f$f\f$ of flapping [Hz]
  current_mean,                ///< \f$\overline{i}\f$ [A]
  current_peak,                ///< largest \f$i\f$ [A]
  current_rms,                 ///< \f$\sqrt{\overline{i^2}}\f$ [A]
  power_electrical,            ///< \f$P_\mathrm{e}\f$, input (15) [W]
  power_motor,                 ///< \f$P_\mathrm{m}\f$, output of the motor (16) [W]
  power_motor_reference,       ///< \f$P_\mathrm{m,ref}\f$, the bench's estimate (17) [W]
  power_friction,              ///< \f$P_\mathrm{friction}\f$ of the mechanism (18) [W]
  power_aerodynamic,           ///< \f$P_\mathrm{aero}\f$ (19) [W]
  power_reactive,              ///< \f$P_\mathrm{re}\f$ (23) [W]
  power_copper,                ///< \f$P_\mathrm{cu}\f$ [W]
  power_viscous,               ///< \f$P_\mathrm{visc}\f$ of the motor [W]
  power_motor_friction,        ///< \f$P_\mathrm{motor}\f$ in the motor's own friction [W]
  power_gear,                  ///< \f$P_\mathrm{gear}\f$ lost in the gearbox [W]
  power_electronics,           ///< \f$P_\mathrm{esc}\f$ lost in electronics, of a piezo with its dielectric's [W]
  power_loss,                  ///< \f$P_\mathrm{loss}\f$ (20) [W]
  power_residual,              ///< \f$P_\mathrm{residual}\f$ that the formulation fails to conserve [W]
  lift_mean,                   ///< mean lift [N]
  lift_peak,                   ///< largest lift [N]
  rod_force_peak,              ///< largest \f$|F|\f$ of one rod [N]
  rod_force_mean,              ///< \f$\overline{|F|}\f$ of one rod [N]
  stroke_amplitude,            ///< half of \f$\beta\f$ from peak to peak [rad]
  flapping_velocity_peak,      ///< largest \f$|\dot\beta|\f$ [rad/s]
  angle_of_attack_min,         ///< smallest \f$\alpha\f$ [deg]
  crank_speed_min,             ///< smallest \f$\omega\f$ [rad/s]
  crank_speed_max,             ///< largest \f$\omega\f$ [rad/s]
  efficiency_system,           ///< \f$P_\mathrm{aero}/P_\mathrm{e}\f$ (24) [1]
  efficiency_motor,            ///< \f$P_\mathrm{m}/P_\mathrm{e}\f$ (25) [1]
  efficiency_mechanism,        ///< \f$P_\mathrm{aero}/P_\mathrm{m}\f$ (26) [1]
  floquet_multiplier_max,      ///< largest magnitude of the orbit's multipliers [1]
  lift_to_weight,              ///< mean lift over the weight [1]
  winding_temperature,         ///< \f$T_\mathrm{w}\f$ [degC]
  case_temperature,            ///< \f$T_\mathrm{case}\f$ [degC]
  winding_temperature_margin,  ///< largest temperature allowed less \f$T_\mathrm{w}\f$ [K]
  added_mass_inertia_ratio,    ///< \f$J_\mathrm{a} / (N_\mathrm{w} J_\mathrm{w})\f$ [1]
  power_hinge,                 ///< lost in pitch hinges and at their stops [W]
  pitch_amplitude,             ///< half of \f$\psi\f$ from peak to peak [deg]
  pitch_phase,                 ///< by which pitching is ahead of the pitch that opposes \f$\dot\beta\f$ [deg]
  angle_of_attack_max,         ///< largest \f$\alpha\f$ of wings on pitch hinges [deg]
  lift_added_mass_share,       ///< of the added mass in the mean lift [1]
  reynolds_number,             ///< of the mean chord at the mean speed of the tips [1]
  stroke_angle_max,            ///< largest \f$\beta\f$ of a direct drive whose wings clap [rad]
  induced_velocity,            ///< \f$v_\mathrm{i}\f$ that the mean lift leads to [m/s]
  hover,                       ///< time for which a battery lets it hover [s]; absent unless a study asks for it
  endurance                    ///< time for which a battery lets it flap [s]; absent unless a study asks for it
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
  current,          ///< \f$i\f$ [A s]
  current_square,   ///< \f$i^2\f$ [A2 s]
  speed_square,     ///< \f$\omega^2\f$ [rad2/s]
  electrical_work,  ///< \f$v i\f$ [J] (eq 15)
  motor_work,       ///< \f$T_\mathrm{m} \omega\f$ [J] (eq 16)
  friction_work,    ///< \f$T_\mathrm{f} \omega\f$ [J] (eq 18), without the motor's own friction
  aero_work,        ///< \f$M_\mathrm{aero} \dot\beta\f$ [J] (eq 19); on hinges \f$+ M_\mathrm{pitch} \dot\psi\f$
  reactive_work,    ///< \f$|(N_\mathrm{w} J_\mathrm{w} \ddot\beta + N_\mathrm{w} k \beta)\, \dot\beta|\f$ [J] (eq 23)
  residual_work,    ///< \f$F (h \omega - g \dot\beta)\f$ [J]: what the formulation fails to conserve
  lift,             ///< lift [N s]
  rod_force,        ///< \f$|F|\f$ [N s]
  gear_work,        ///< \f$(1 - e)\, T_\mathrm{g} \omega\f$ [J], lost in the gearbox
  travel            ///< \f$|\omega|\f$: what crank or shaft turns by [rad]
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

// Cycle metrics: what one flapping cycle costs and gives; model.md section 4, eqs (15-20, 23-26).
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/vehicle/impact.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// The time integrands at one instant, indexed by Integral.
template <Scalar S>
WINGBEAT_INLINE_FOR_SPEED CycleIntegrals<S> integrands(const Motion<S>& m, const S& omega, const Mode<S>& mode) {
  const S i = m.current;
  return {S(1.0),
          i,
          square(i),
          square(omega),
          m.voltage * i,
          m.motor_torque * omega,
          m.friction_torque * omega,
          m.aero.power,
          mode.stored_power * m.stored_moment * m.stroke_velocity,
          m.rod_force * (m.kinematics.crank_jacobian * omega - m.kinematics.wing_jacobian * m.stroke_velocity),
          m.aero.lift,
          mode.force * m.rod_force,
          m.gear_loss,
          mode.direction * omega};
}

template <Scalar S>
CycleIntegrals<S> integrands(const PitchMotion<S>& m, const S& omega, const Mode<S>& mode) {
  CycleIntegrals<S> all = integrands<S>(static_cast<const Motion<S>&>(m), omega, mode);
  all[std::size_t(Integral::speed_square)] = square(m.damped_speed);
  return all;
}

/// What an impact on a stop adds to the integrals at once.
template <Scalar S>
CycleIntegrals<S> impulses(const StopImpact<S>& impact) {
  CycleIntegrals<S> integrals;
  integrals.fill(S(0.0));
  integrals[std::size_t(Integral::motor_work)] = impact.motor_work;
  integrals[std::size_t(Integral::friction_work)] = impact.friction_work;
  integrals[std::size_t(Integral::reactive_work)] = impact.stored_work;
  integrals[std::size_t(Integral::residual_work)] = impact.residual_work;
  integrals[std::size_t(Integral::lift)] = impact.lift;
  integrals[std::size_t(Integral::rod_force)] = sign_of(impact.rod_impulse) * impact.rod_impulse;
  integrals[std::size_t(Integral::gear_work)] = impact.gear_work;
  return integrals;
}

/// Quantities of which a cycle's extreme value is a metric.
enum class Extreme {
  current,
  lift,
  rod_force,
  flapping_velocity,
  crank_speed_min,
  crank_speed_max,
  stroke_max,  ///< of a direct drive: a crank's stroke is fixed by its geometry
  stroke_min
};
inline constexpr int extreme_count = int(Extreme::stroke_min) + 1;

template <Scalar S>
using CycleExtremes = std::array<S, extreme_count>;

/// The value whose maximum over the cycle is sought for each Extreme (minima with their sign turned): i [A], lift [N],
/// |F| [N], |beta'| [rad/s], -omega and omega [rad/s], beta and -beta [rad].
template <Scalar S>
CycleExtremes<S> extreme_candidates(const Motion<S>& m, const S& omega, const Mode<S>& mode, const S& beta = S(0.0)) {
  return {m.current, m.aero.lift, mode.force * m.rod_force, mode.stroke * m.stroke_velocity, -omega, omega,
          beta,      -beta};
}

/// What electronics lose [W] of a power that they pass on to the terminals, at the frequency f of flapping: of a
/// brushless motor \f$(1/\eta - 1) \overline{v i}\f$, of a piezo electronics_loss() with its dielectric's. Nothing of
/// other vehicles.
template <Scalar S>
std::optional<S> electronics_power(const Vehicle<S>& v, const S& terminal_power, const S& f) {
  if (is_given(v.piezo)) return electronics_loss(v.piezo, v.voltage_offset, v.voltage, f);
  if (!limits_current(v.electronics) && value_of(v.electronics.efficiency) == 1.0) return std::nullopt;
  return (S(1.0) / v.electronics.efficiency - S(1.0)) * terminal_power;
}

/// The metrics of a cycle from its integrals and extremes: of all motors together, but for the force of one rod and the
/// temperatures of one motor. `extremes` holds the maxima of extreme_candidates(). A
/// direct drive has no rod, no speed of rotation and no direct current: rod forces, crank speeds and the bench estimate
/// (17) are absent; its voltage is the amplitude. Floquet multiplier: of the orbit, or `absent`. The temperatures are
/// those that the losses of this cycle lead to, absent without thermal resistances; the ratio of inertias is that at
/// rest, J_a / (N_w J_w), absent without added mass or without wings. The Reynolds number is that of the mean chord at
/// the mean speed of the wing tips, absent without air and of wings without a shape.
///
/// A bar is the mean over the time of the cycle, from the integrals: \f$\overline{x} = f \int x\,\mathrm{d}t\f$,
/// \f$f = 1 / \int \mathrm{d}t\f$. Equation numbers of the 2022 paper; model.md section 4:
/// \f[
/// \begin{aligned}
/// P_\mathrm{e} &= \overline{v i} && (15) & P_\mathrm{m} &= \overline{T_\mathrm{m} \omega} && (16) \cr
/// P_\mathrm{m,ref} &= 2 \pi f K_\mathrm{ref}\, \overline{i} && (17) &
/// P_\mathrm{friction} &= \overline{T_\mathrm{f} \omega} && (18) \cr
/// P_\mathrm{aero} &= \overline{M_\mathrm{aero} \dot\beta} && (19) &
/// P_\mathrm{loss} &= P_\mathrm{e} - P_\mathrm{aero} && (20) \cr
/// P_\mathrm{re} &= \overline{|(N_\mathrm{w} J_\mathrm{w} \ddot\beta + N_\mathrm{w} k \beta)\, \dot\beta|} && (23) &
/// \eta_\mathrm{system} &= P_\mathrm{aero} / P_\mathrm{e} && (24) \cr
/// \eta_\mathrm{motor} &= P_\mathrm{m} / P_\mathrm{e} && (25) &
/// \eta_\mathrm{mechanism} &= P_\mathrm{aero} / P_\mathrm{m} && (26) \cr
/// P_\mathrm{cu} &= R_\mathrm{a} \overline{i^2} &&& P_\mathrm{visc} &= b\, \overline{\omega^2} \cr
/// P_\mathrm{motor} &= T_\mathrm{c,m} \overline{|\omega|} &&&
/// P_\mathrm{gear} &= \overline{(1 - e)\, T_\mathrm{g} \omega} \cr
/// P_\mathrm{residual} &= \overline{F (h \omega - g \dot\beta)} &&&
/// i_\mathrm{rms} &= \sqrt{\overline{i^2}}
/// \end{aligned}
/// \f]
/// With the stroke amplitude \f$\beta_\mathrm{max}\f$ (half of peak to peak) and the mass m of the vehicle:
/// \f[
/// \mathrm{Re} = \frac{\overline{c}\, (R + d)}{\nu}\, 4 \beta_\mathrm{max} f, \qquad
/// \frac{\text{lift}}{\text{weight}} = \frac{\overline{L}}{m\, g_0}
/// \f]
template <template <Scalar> class V, Scalar S>
Metrics<S> cycle_metrics(const V<S>& v, const CycleIntegrals<S>& integrals, const CycleExtremes<S>& extremes,
                         const S& floquet_multiplier_max, const ReportingOf<S>& reporting) {
  const auto total = [&](Integral which) -> const S& { return integrals[std::size_t(which)]; };
  const auto peak = [&](Extreme which) -> const S& { return extremes[std::size_t(which)]; };
  const S f = S(1.0) / total(Integral::time);
  const auto ratio = [](const S& a, const S& b) {
    const auto defined = b > S(0.0);
    return select(defined, a / select(defined, b, S(1.0)), S(absent));
  };

  Metrics<S> m;
  m[Metric::frequency] = f;
  m[Metric::current_mean] = f * total(Integral::current);
  m[Metric::voltage] = terminal_voltage(v, v.voltage, m[Metric::current_mean]);
  // The instant at which a current meets its limit is known less well than the limit.
  m[Metric::current_peak] = current_within(v.electronics, peak(Extreme::current));
  using std::sqrt;
  const S current_square = f * total(Integral::current_square);
  const auto carries_current = current_square > S(0.0);
  m[Metric::current_rms] = select(carries_current, sqrt(select(carries_current, current_square, S(1.0))), S(0.0));
  const S terminal_power = f * total(Integral::electrical_work);
  m[Metric::power_electronics] = S(absent);
  m[Metric::power_electrical] = terminal_power;
  if constexpr (ScalarTraits<S>::reads_tables && requires { electronics_power(v, terminal_power, f); }) {
    if (const std::optional<S> lost = electronics_power(v, terminal_power, f)) {
      m[Metric::power_electronics] = *lost;
      m[Metric::power_electrical] = terminal_power + *lost;
    }
  }
  m[Metric::power_motor] = f * total(Integral::motor_work);
  m[Metric::power_motor_reference] = S(two_pi) * reporting.bench_torque_constant * f * m[Metric::current_mean];
  m[Metric::power_friction] = f * total(Integral::friction_work);
  m[Metric::power_aerodynamic] = f * total(Integral::aero_work);
  m[Metric::power_reactive] = f * total(Integral::reactive_work);
  m[Metric::power_copper] = v.motor.armature_resistance * current_square;
  m[Metric::power_viscous] = v.motor.viscous_damping * f * total(Integral::speed_square);
  m[Metric::power_motor_friction] = v.motor.friction_torque * f * total(Integral::travel);
  m[Metric::power_gear] = f * total(Integral::gear_work);
  m[Metric::power_loss] = m[Metric::power_electrical] - m[Metric::power_aerodynamic];
  m[Metric::power_residual] = f * total(Integral::residual_work);
  m[Metric::lift_mean] = f * total(Integral::lift);
  m[Metric::lift_peak] = peak(Extreme::lift);
  m[Metric::rod_force_peak] = peak(Extreme::rod_force) / v.motors;
  m[Metric::rod_force_mean] = f * total(Integral::rod_force) / v.motors;
  const Drive drive = drive_of(v);
  if (!drive.has_rod) m[Metric::rod_force_peak] = m[Metric::rod_force_mean] = S(absent);
  // An estimate from the mean current, which says nothing where it alternates.
  if (drive.alternating) m[Metric::power_motor_reference] = S(absent);
  m[Metric::stroke_amplitude] = drive.stroke_is_fixed
                                    ? stroke_amplitude(v.transmission)
                                    : S(S(0.5) * (peak(Extreme::stroke_max) + peak(Extreme::stroke_min)));
  m[Metric::flapping_velocity_peak] = peak(Extreme::flapping_velocity);
  const S alpha = aero_loads(v.wings, peak(Extreme::flapping_velocity)).angle_of_attack;  // falls with |beta'|
  m[Metric::angle_of_attack_min] = S(degrees_per_radian) * alpha;
  m[Metric::crank_speed_min] = -peak(Extreme::crank_speed_min);
  m[Metric::crank_speed_max] = peak(Extreme::crank_speed_max);
  if (!drive.rotates) m[Metric::crank_speed_min] = m[Metric::crank_speed_max] = S(absent);
  m[Metric::efficiency_system] = ratio(m[Metric::power_aerodynamic], m[Metric::power_electrical]);
  m[Metric::efficiency_motor] = ratio(m[Metric::power_motor], m[Metric::power_electrical]);
  m[Metric::efficiency_mechanism] = ratio(m[Metric::power_aerodynamic], m[Metric::power_motor]);
  m[Metric::floquet_multiplier_max] = floquet_multiplier_max;
  m[Metric::lift_to_weight] = m[Metric::lift_mean] / (reporting.mass * S(standard_gravity));
  const MotorTemperatures<S> T = settled_temperatures(v.thermal, m[Metric::power_copper],
                                                      S(m[Metric::power_viscous] + m[Metric::power_motor_friction]));
  m[Metric::winding_temperature] = T.winding - S(zero_celsius);
  m[Metric::case_temperature] = T.casing - S(zero_celsius);
  m[Metric::winding_temperature_margin] = v.thermal.winding_temperature_max - T.winding;
  const auto weighs = v.wings.added_inertia > S(0.0);
  m[Metric::added_mass_inertia_ratio] =
      select(weighs, ratio(v.wings.added_inertia, v.wing_count * v.wing_inertia), S(absent));
  // Of wings that pitch: see PitchMetrics.
  for (const Metric which : {Metric::power_hinge, Metric::pitch_amplitude, Metric::pitch_phase,
                             Metric::angle_of_attack_max, Metric::lift_added_mass_share}) {
    m[which] = S(absent);
  }
  m[Metric::reynolds_number] = v.wing_limits.reynolds_number_per_speed * (S(4.0) * m[Metric::stroke_amplitude] * f);
  // Of others its mean may be free, as without springs.
  m[Metric::stroke_angle_max] = drive.stroke_is_fixed || !claps(v.wings.clap) ? S(absent) : peak(Extreme::stroke_max);
  m[Metric::induced_velocity] = select<S>(
      v.wings.wake.share > S(0.0),
      induced_velocity_of(v.wings.wake, v.wings.air_density, m[Metric::lift_mean], m[Metric::stroke_amplitude]),
      S(absent));
  m[Metric::hover] = m[Metric::endurance] = S(absent);
  return m;
}

}  // namespace wingbeat

// The energy balance of a cycle: where the supply's power goes, and what is left over; model.md section 4.
#pragma once

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// Mean powers of a cycle [W]. P_e = copper + viscous + motor_friction + gear + friction + hinge + aerodynamic +
/// residual, to the solver's accuracy; what follows the gearbox is the motor's output.
struct EnergyAudit {
  double electrical;      ///< P_e
  double copper;          ///< R_a mean(i^2)
  double viscous;         ///< b mean(omega^2)
  double motor_friction;  ///< T_c,m mean(|omega|)
  double gear;            ///< mean((1 - e) T_g omega)
  double friction;        ///< mean(T_f omega) of the transmission
  double hinge;           ///< mean of c_psi psi'^2 and of what stops take in impacts; 0 where wings have no pitch hinge
  double aerodynamic;     ///< mean(M_aero beta' + M_pitch psi')
  double residual;        ///< what the formulation fails to conserve; zero to rounding for virtual-work
  double imbalance;       ///< P_e minus all of these: zero but for the error of the solution
};

namespace detail {

inline EnergyAudit with_imbalance(EnergyAudit a) {
  a.imbalance = a.electrical - a.copper - a.viscous - a.motor_friction - a.gear - a.friction - a.hinge - a.aerodynamic -
                a.residual;
  return a;
}

}  // namespace detail

inline EnergyAudit energy_audit(const Metrics<double>& m) {
  const double hinge = std::isfinite(m[Metric::power_hinge]) ? m[Metric::power_hinge] : 0.0;
  return detail::with_imbalance({m[Metric::power_electrical], m[Metric::power_copper], m[Metric::power_viscous],
                                 m[Metric::power_motor_friction], m[Metric::power_gear], m[Metric::power_friction],
                                 hinge, m[Metric::power_aerodynamic], m[Metric::power_residual], 0.0});
}

/// What a load takes in a cycle [J].
template <class V>
double load_work(const V& v) {
  return drive_of(v).rotates ? two_pi * v.load_torque : 0.0;
}

/// Of a cycle's integrals, `hinge_work` [J] being what hinges and stops take.
inline EnergyAudit energy_audit(const Vehicle<double>& v, const CycleIntegrals<double>& integrals, double hinge_work) {
  const double f = 1.0 / integrals[std::size_t(Integral::time)];
  const auto mean = [&](Integral which) { return f * integrals[std::size_t(which)]; };
  EnergyAudit audit = detail::with_imbalance(
      {mean(Integral::electrical_work), v.motor.armature_resistance * mean(Integral::current_square),
       v.motor.viscous_damping * mean(Integral::speed_square), v.motor.friction_torque * mean(Integral::travel),
       mean(Integral::gear_work), mean(Integral::friction_work), f * hinge_work, mean(Integral::aero_work),
       mean(Integral::residual_work), 0.0});
  audit.imbalance -= f * load_work(v);
  return audit;
}

/// Up to this imbalance [W] the balance of a solution to the relative `tolerance` counts as closed. What is beyond is
/// no solution: ten times the tolerance, or what rounding may leave, of the input or of what the formulation gives.
inline double largest_imbalance(const EnergyAudit& a, double tolerance) {
  constexpr double rounding = 1e-11;
  return 10.0 * std::max(tolerance, rounding) * std::max(std::abs(a.electrical), std::abs(a.residual));
}

/// `stored`: by how much what the vehicle stores grows on the average [W], where it does not return to its start.
inline bool closes(const EnergyAudit& a, double tolerance, double stored = 0.0) {
  return std::abs(a.imbalance - stored) <= largest_imbalance(a, tolerance);
}

}  // namespace wingbeat

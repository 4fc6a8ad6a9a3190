// The energy balance of a cycle: where the supply's power goes, and what is left over; model.md section 4.
#pragma once

#include <algorithm>
#include <cmath>

#include "wingbeat/cycle/metric_values.hpp"

namespace wingbeat {

/// Mean powers of a cycle [W], which add up to the input to the solver's accuracy; what follows the gearbox is the
/// motor's output (model.md section 4).
/// \f[
/// P_\mathrm{e} = P_\mathrm{esc} + R_\mathrm{a} \overline{i^2} + b\, \overline{\omega^2} + P_\mathrm{motor} +
/// P_\mathrm{gear} + P_\mathrm{friction} + P_\mathrm{hinge} + P_\mathrm{aero} + P_\mathrm{residual}
/// \f]
struct EnergyAudit {
  double electrical;      ///< P_e
  double copper;          ///< \f$R_\mathrm{a} \overline{i^2}\f$
  double viscous;         ///< \f$b\, \overline{\omega^2}\f$
  double motor_friction;  ///< \f$P_\mathrm{motor} = T_\mathrm{c,m} \overline{\lvert\omega\rvert}\f$
  double gear;            ///< \f$P_\mathrm{gear} = \overline{(1 - e)\, T_\mathrm{g} \omega}\f$
  double friction;        ///< \f$P_\mathrm{friction} = \overline{T_\mathrm{f} \omega}\f$ of the transmission
  double hinge;           ///< mean of c_psi psi'^2 and of what stops take in impacts; 0 where wings have no pitch hinge
  double aerodynamic;     ///< \f$P_\mathrm{aero} = \overline{M_\mathrm{aero} \dot\beta + M_\mathrm{pitch} \dot\psi}\f$
  double residual;        ///< what the formulation fails to conserve; zero to rounding for virtual-work
  double imbalance;       ///< P_e minus all of these: zero but for the error of the solution
  double electronics = 0.0;  ///< \f$P_\mathrm{esc}\f$ that electronics lose, of a piezo with its dielectric's
};

namespace detail {

inline EnergyAudit with_imbalance(EnergyAudit a) {
  a.imbalance = a.electrical - a.copper - a.viscous - a.motor_friction - a.gear - a.friction - a.hinge - a.aerodynamic -
                a.residual - a.electronics;
  return a;
}

}  // namespace detail

inline EnergyAudit energy_audit(const Metrics<double>& m) {
  const double hinge = std::isfinite(m[Metric::power_hinge]) ? m[Metric::power_hinge] : 0.0;
  const double electronics = std::isfinite(m[Metric::power_electronics]) ? m[Metric::power_electronics] : 0.0;
  return detail::with_imbalance({m[Metric::power_electrical], m[Metric::power_copper], m[Metric::power_viscous],
                                 m[Metric::power_motor_friction], m[Metric::power_gear], m[Metric::power_friction],
                                 hinge, m[Metric::power_aerodynamic], m[Metric::power_residual], 0.0, electronics});
}

/// Up to this imbalance [W] the balance of a solution to the relative `tolerance` counts as closed. What is beyond is
/// no solution: ten times the tolerance, or what rounding may leave, of the input or of what the formulation gives; or
/// what rounding may leave of `blocked`, beside which an idle motor without losses takes nothing.
inline double largest_imbalance(const EnergyAudit& a, double tolerance, double blocked = 0.0) {
  constexpr double rounding = 1e-11;
  return 10.0 * std::max(std::max(tolerance, rounding) * std::max(std::abs(a.electrical), std::abs(a.residual)),
                         rounding * blocked);
}

/// `stored`: by how much what the vehicle stores grows on the average [W], where it does not return to its start.
/// `blocked`: what its motors take where they stand [W], see blocked_input().
inline bool closes(const EnergyAudit& a, double tolerance, double stored = 0.0, double blocked = 0.0) {
  return std::abs(a.imbalance - stored) <= largest_imbalance(a, tolerance, blocked);
}

}  // namespace wingbeat

// The energy balance of a cycle: where the supply's power goes, and what is left over; model.md section 4.
#pragma once

#include "wingbeat/cycle/metrics.hpp"

namespace wingbeat {

/// Mean powers of a cycle [W]. P_e = copper + viscous + gear + friction + hinge + aerodynamic + residual, to the
/// solver's accuracy.
struct EnergyAudit {
  double electrical;   ///< P_e
  double copper;       ///< R_a mean(i^2)
  double viscous;      ///< b mean(omega^2)
  double gear;         ///< mean((1 - e) T_g omega)
  double friction;     ///< mean(T_f omega)
  double hinge;        ///< mean of c_psi psi'^2 and of what impacts on stops take; 0 where wings have no pitch hinge
  double aerodynamic;  ///< mean(M_aero beta')
  double residual;     ///< what the formulation fails to conserve; zero to rounding for virtual-work
  double imbalance;    ///< P_e minus all of these: zero but for the error of the solution
};

inline EnergyAudit energy_audit(const Metrics<double>& m) {
  const double hinge = std::isfinite(m[Metric::power_hinge]) ? m[Metric::power_hinge] : 0.0;
  EnergyAudit a{m[Metric::power_electrical],  m[Metric::power_copper],   m[Metric::power_viscous],
                m[Metric::power_gear],        m[Metric::power_friction], hinge,
                m[Metric::power_aerodynamic], m[Metric::power_residual], 0.0};
  a.imbalance = a.electrical - a.copper - a.viscous - a.gear - a.friction - a.hinge - a.aerodynamic - a.residual;
  return a;
}

}  // namespace wingbeat

// The energy balance from the integrals of a cycle and the work of its load.
#pragma once

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// What a load takes in a cycle [J], \f$2 \pi T_\mathrm{x}\f$ of a crank.
template <class V>
double load_work(const V& v) {
  return drive_of(v).rotates ? two_pi * v.load_torque : 0.0;
}

/// What a blocked motor takes, \f$V^2 / R\f$ [W]; nothing of a piezo, which does not idle.
inline double blocked_input(const Vehicle<double>& v) {
  return is_given(v.piezo) ? 0.0 : square(v.voltage) / circuit_resistance(v);
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

}  // namespace wingbeat

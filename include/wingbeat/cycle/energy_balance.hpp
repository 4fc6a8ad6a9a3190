// The energy that a cycle takes in against what it gives away, as a measure of the errors of its integrals.
#pragma once

#include <algorithm>
#include <cmath>

#include "wingbeat/cycle/integrals_audit.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// Electrical work of a closed cycle of a vehicle whose wings follow the pitch law, less its losses and the work on air
/// and load [J]: zero but for errors, since what is stored returns. Integrals over the time of the cycle:
/// \f[
/// \int \left( v i - R_\mathrm{a} i^2 - b\, \omega^2 - T_\mathrm{c,m} |\omega| - T_\mathrm{f} \omega
/// - M_\mathrm{aero} \dot\beta - F (h \omega - g \dot\beta) - (1 - e)\, T_\mathrm{g} \omega \right) \mathrm{d}t
/// - W_\mathrm{load}
/// \f]
template <class V>
double energy_gap(const V& v, const CycleIntegrals<double>& work) {
  const auto total = [&](Integral which) { return work[std::size_t(which)]; };
  return total(Integral::electrical_work) - v.motor.armature_resistance * total(Integral::current_square) -
         v.motor.viscous_damping * total(Integral::speed_square) - v.motor.friction_torque * total(Integral::travel) -
         total(Integral::friction_work) - total(Integral::aero_work) - total(Integral::residual_work) -
         total(Integral::gear_work) - load_work(v);
}

/// The open energy beside the smaller of the electrical work and all losses, of which metrics are means: about what
/// errors that add up over the cycle, and to 1 / (1 - multiplier) times that over all cycles, leave in them.
template <class V>
double relative_energy_gap(const V& v, const CycleIntegrals<double>& work) {
  const double input = std::abs(work[std::size_t(Integral::electrical_work)]);
  const double lost = std::abs(work[std::size_t(Integral::electrical_work)] - work[std::size_t(Integral::aero_work)]);
  constexpr double least = 1e-3;  // of the input, below which losses need not be accurate beside themselves
  return input > 0.0 ? std::abs(energy_gap(v, work)) / std::max(std::min(lost, input), least * input) : 0.0;
}

}  // namespace wingbeat

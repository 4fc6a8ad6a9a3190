#include "wingbeat/study/gear_torque.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/minimise.hpp"
#include "wingbeat/cycle/cycle_instants.hpp"
#include "wingbeat/cycle/orbit_gradient.hpp"
#include "wingbeat/vehicle/motion.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

/// Instants of a cycle: their phases, crank angles or those of the supply [rad], with their shares of a mean over the
/// phase.
struct Quadrature {
  std::vector<double> phases, shares, torques;  ///< torques [N m]
  std::vector<double> speeds;                   ///< of a crank [rad/s]
  double peak_phase = 0.0, peak = 0.0;          ///< of the largest magnitude
};

double within_turn(double phase) { return phase - two_pi * std::floor(phase / two_pi); }

Quadrature quadrature_of(const CycleRecord& record) {
  Quadrature q;
  const bool turns = drive_of(record.vehicle()).voltage_sets_frequency;
  std::size_t top = 0;
  for (const auto& [row, weight, phase] : cycle_instants(record)) {
    q.phases.push_back(phase);
    q.shares.push_back(turns ? weight * row.crank_speed : weight);
    q.torques.push_back(row.motor_torque);
    q.speeds.push_back(turns ? row.crank_speed : 1.0);
    if (std::abs(q.torques.back()) > std::abs(q.torques[top])) top = q.torques.size() - 1;
  }
  const std::size_t count = q.phases.size();
  const double before = top > 0 ? q.phases[top - 1] : q.phases[count - 1] - two_pi;
  const double after = top + 1 < count ? q.phases[top + 1] : q.phases[0] + two_pi;
  const auto negative = [&](double phase) { return -std::abs(record.at(within_turn(phase)).motor_torque); };
  // The value is exact to the square of its place.
  const Minimum best = minimise(negative, before, after, 1e-4 * (after - before));
  const bool higher = -best.value > std::abs(q.torques[top]);
  q.peak_phase = within_turn(higher ? best.argument : q.phases[top]);
  q.peak = higher ? -best.value : std::abs(q.torques[top]);
  return q;
}

}  // namespace

GearTorque gear_torque(const SteadyFlapping& orbit) {
  GearTorque torque;
  if (orbit.status != FlappingStatus::flapping || orbit.record.empty()) return torque;
  const Quadrature q = quadrature_of(orbit.record);
  double squares = 0.0, time = 0.0;
  for (std::size_t n = 0; n < q.phases.size(); ++n) {
    squares += q.shares[n] * square(q.torques[n]) / q.speeds[n];
    time += q.shares[n] / q.speeds[n];
  }
  const double motors = orbit.record.vehicle().motors;
  torque.rms = std::sqrt(squares / time) / motors;
  torque.peak = q.peak / motors;
  return torque;
}

std::vector<GearTorque> gear_torque_slopes(const Design<double>& design, Condition condition,
                                           const SteadyFlapping& orbit, std::span<const DesignParameter> parameters,
                                           Held held) {
  std::vector<GearTorque> slopes(parameters.size());
  if (orbit.status != FlappingStatus::flapping || orbit.record.empty()) return slopes;
  const bool turns = drive_of(orbit.record.vehicle()).voltage_sets_frequency;
  // The voltage of a direct drive has no slot of its own.
  if (!turns && held != Held::voltage && held != Held::frequency) return slopes;
  const Quadrature q = quadrature_of(orbit.record);
  std::vector<double> angles;
  for (const double phase : q.phases) angles.push_back(within_turn(phase));
  angles.push_back(q.peak_phase);
  for (std::size_t first = 0; first < parameters.size(); first += gradient_parameters) {
    const std::size_t count = std::min<std::size_t>(gradient_parameters, parameters.size() - first);
    Design<GradientJet> seeded = cast<GradientJet>(design);
    for (std::size_t k = 0; k < count; ++k) {
      const DesignParameter& p = parameters[first + k];
      const std::optional<double> value = p.value(design);
      if (!value || !p.set_jet(seeded, gradient_seed(*value, int(k)))) {
        throw ParameterError(p.key, "the vehicle does not have this parameter");
      }
    }
    const OrbitGradient g = orbit_gradient(orbit, gradient_vehicle(seeded, condition),
                                           {.held = held, .peaks = false, .crank_angles = angles});
    if (!g.regular || g.instants.size() != angles.size()) continue;
    GradientJet squares(0.0), time(0.0);
    for (std::size_t n = 0; n < q.phases.size(); ++n) {
      const GradientInstant& instant = g.instants[n];
      const GradientJet weight = turns ? GradientJet(q.shares[n] / instant.crank_speed) : GradientJet(q.shares[n]);
      squares += weight * instant.motor_torque * instant.motor_torque;
      time += weight;
    }
    const GradientJet rms = sqrt(squares / time), peak = abs(g.instants.back().motor_torque);
    for (std::size_t k = 0; k < count; ++k) {
      const Eigen::Index slot = gradient_first_slot + Eigen::Index(k);
      slopes[first + k] = {rms.v[slot] / design.motors, peak.v[slot] / design.motors};
    }
  }
  return slopes;
}

}  // namespace wingbeat

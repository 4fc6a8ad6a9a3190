// The current behind an inductance on SIMD lanes: the part of PackOrbit in which it relaxes, as a state, behind the
// sign changes of the rod force, or, where the inductance is small, is no state, but lags behind the speed. Then to
// first order i = (v - K omega - L_a di/dt) / R, di/dt being that of the trajectory found before.
#pragma once

#include "wingbeat/ensemble/pack_orbit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// The segments of half an iterate where the current is a state. Where it relaxes within less than a segment, each sign
/// change of the rod force has a segment of its own behind it, in which it does.
template <class L, int N>
void PackOrbit<L, N>::build_mesh_with_layers(int half) {
  constexpr double relaxation_times = 12.0;
  const ForceSwitches<L>& s = switches_[std::size_t(half)];
  HalfMesh<L>& mesh = mesh_[std::size_t(half)];
  const L width = L(relaxation_times) * vehicle_.motor.armature_inductance * per_resistance_ * y_[0];
  const Mask relaxes = width < L(1.5 / segments_) * reach(half);
  std::array<L, 2 * max_force_switches> place;
  place.fill(reach(half));
  for (std::size_t n = 0; n < max_force_switches; ++n) {
    const L next = n + 1 < max_force_switches ? s.angle[n + 1] : reach(half);
    place[n] = select<L>(relaxes, place[n], s.angle[n]);
    place[2 * n] = select<L>(relaxes, s.angle[n], place[2 * n]);
    place[2 * n + 1] = select<L>(relaxes, min(s.angle[n] + width, L(0.5) * (s.angle[n] + next)), place[2 * n + 1]);
  }
  const L count = select<L>(relaxes, L(2.0) * s.count, s.count);
  unresolved_ = unresolved_ || count > L(double(segments_ - 1));
  mesh.force.fill(s.first_sign);
  lay_segments(place, count, reach(half), mesh, [&](std::size_t m, std::size_t n, const Mask& beyond) {
    const Mask changes = n % 2 == 0 ? beyond : beyond && !relaxes;
    mesh.force[m] = select<L>(changes, -mesh.force[m], mesh.force[m]);
  });
}

/// The inductance's voltage at the nodes from the trajectory of the current that it leaves, twice: an iteration gains
/// the ratio of its time constant to that of the trajectory.
template <class L, int N>
void PackOrbit<L, N>::correct_quasi_steady_current() {
  if constexpr (N == 1) {
    const std::size_t intervals = std::size_t(rule_.intervals), nodes = first_node(2, 0);
    const L inductance = vehicle_.motor.armature_inductance;
    L change(0.0);
    for (int repeat = 0; repeat < 2; ++repeat) {
      change = L(0.0);
      for (int half = 0; half < 2; ++half) {
        const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
        for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
          const std::size_t base = first_node(half, s);
          const L inductance_per_h = inductance * inverse_of(max(L(mesh.u[s + 1] - mesh.u[s]), L(1e-12)));
          std::array<L, nodes_per_segment> current;
          for (std::size_t j = 0; j <= intervals; ++j) {
            current[j] =
                algebraic_current(vehicle_, L(vehicle_.voltage - inductive_drop_[base + j]), trajectory_[base + j][0]);
          }
          for (std::size_t m = 0; m <= intervals; ++m) {
            L slope(0.0);
            for (std::size_t j = 0; j <= intervals; ++j) slope = slope + L(rule_.slope[m][j]) * current[j];
            const L inductive_drop = inductance_per_h * trajectory_[base + m][0] * slope;
            change = change + abs(inductive_drop - inductive_drop_[base + m]);
            inductive_drop_[base + m] = inductive_drop;
          }
        }
      }
    }
    lag_residual_ = change * inverse_of(L(vehicle_.voltage * L(double(nodes))));
  }
}

/// Where the trajectory has a kink, at a sign change of the rod force, the current continues from what it was before
/// and has relaxed within a time constant: what that adds to state and integrals, up to the square of the angle it
/// takes.
template <class L, int N>
auto PackOrbit<L, N>::relaxation(System system, std::size_t base, const L& force) const -> solver::Rates<System> {
  solver::Rates<System> after, before;
  evaluate<true>(system, configuration_of(base), trajectory_[base], force, after);
  system.inductive_drop = inductive_drop_[base - 1];
  evaluate<true>(system, configuration_of(base), trajectory_[base], force, before);
  const L angle = vehicle_.motor.armature_inductance * trajectory_[base][0] * inverse_of(circuit_resistance(vehicle_));
  for (std::size_t n = 0; n < N; ++n) after.dy[n] = angle * (before.dy[n] - after.dy[n]);
  for (std::size_t q = 0; q < after.dq.size(); ++q) after.dq[q] = angle * (before.dq[q] - after.dq[q]);
  return after;
}

/// What relaxation() leaves out, relative: what grows with the angle of a time constant, and with what the speed
/// changes by meanwhile. The factor is measured, on the coreless motors of tests/ensemble/test_ensemble.cpp.
template <class L, int N>
L PackOrbit<L, N>::lag_left_out() const {
  const L angle = vehicle_.motor.armature_inductance * no_load_ * inverse_of(circuit_resistance(vehicle_));
  return L(20.0) * layer_ * (angle + electrical_to_mechanical_time());
}

/// Ratio of the motor's time constants, (L_a / R) / (J R / K^2).
template <class L, int N>
L PackOrbit<L, N>::electrical_to_mechanical_time() const {
  const Motor<L>& m = vehicle_.motor;
  return m.armature_inductance * square(L(m.torque_constant * inverse_of(circuit_resistance(vehicle_)))) *
         inverse_of(m.inertia);
}

/// Takes the rates below and above a node's speed again with what the inductance makes of the change of acceleration.
template <class L, int N>
void PackOrbit<L, N>::lag_with(System system, std::size_t node, const L& by, const L& force,
                               solver::Rates<System>& below, solver::Rates<System>& above) const {
  const L per_acceleration =
      vehicle_.motor.armature_inductance * vehicle_.motor.torque_constant * inverse_of(circuit_resistance(vehicle_));
  const State& y = trajectory_[node];
  const L acceleration = rates_[node][0] * y[0];
  for (solver::Rates<System>* rates : {&below, &above}) {
    State moved = y;
    moved[0] = rates == &below ? y[0] - by : y[0] + by;
    for (int repeat = 0; repeat < 2; ++repeat) {
      system.inductive_drop = inductive_drop_[node] - per_acceleration * (rates->dy[0] * moved[0] - acceleration);
      evaluate<false>(system, configuration_of(node), moved, force, *rates);
    }
  }
}

}  // namespace wingbeat

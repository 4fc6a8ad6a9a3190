// Kinks beside those of the rod force on SIMD lanes: of force coefficients at an angle of attack, at a stop of the
// passive pitching or where a coefficient table begins, and of a gearbox that loses torque where the load begins to
// drive the motor. The part of PackOrbit in which segments end there as well.
#pragma once

#include "wingbeat/ensemble/pack_orbit.hpp"

namespace wingbeat {

/// build_mesh() where segments end at the sign changes of HalfCycle::kink_margin_at(), too.
template <class L, int N>
void PackOrbit<L, N>::build_mesh_with_kinks(int half) {
  constexpr std::size_t max_switches = 2 * max_force_switches;
  const ForceSwitches<L>&f = switches_[std::size_t(half)], &b = kink_switches_[std::size_t(half)];
  HalfMesh<L>& mesh = mesh_[std::size_t(half)];
  const L count = f.count + b.count;
  unresolved_ = unresolved_ || count > L(double(segments_ - 1));
  // Both lists are sorted; those beyond the counts go to the end.
  std::array<L, max_switches> place, kinks;
  for (std::size_t n = 0; n < max_force_switches; ++n) {
    place[n] = select<L>(f.count > L(double(n)), f.angle[n], L(1e3));
    kinks[n] = L(0.0);
    const std::size_t m = max_switches - 1 - n;
    place[m] = select<L>(b.count > L(double(n)), b.angle[n], L(1e3));
    kinks[m] = L(1.0);
  }
  for (std::size_t end = max_switches; end > 1; --end) {
    for (std::size_t n = 0; n + 1 < end; ++n) {
      const Mask swap = place[n] > place[n + 1];
      const L low = min(place[n], place[n + 1]), high = max(place[n], place[n + 1]);
      const L first = select<L>(swap, kinks[n + 1], kinks[n]), second = select<L>(swap, kinks[n], kinks[n + 1]);
      place[n] = low, place[n + 1] = high;
      kinks[n] = first, kinks[n + 1] = second;
    }
  }
  mesh.force.fill(f.first_sign);
  mesh.kink.fill(b.first_sign);
  lay_segments(place, count, reach(half), mesh, [&](std::size_t m, std::size_t n, const Mask& beyond) {
    const Mask kink = kinks[n] > L(0.0);
    mesh.force[m] = select<L>(beyond && !kink, -mesh.force[m], mesh.force[m]);
    mesh.kink[m] = select<L>(beyond && kink, -mesh.kink[m], mesh.kink[m]);
  });
}

/// How far the pitch margin has the wrong sign inside the segments of half an iterate, as the nodes show it and the
/// tops of the stroke speed between them [rad]. The slopes of the speed at the nodes are those of the last rates.
template <class L, int N>
L PackOrbit<L, N>::overlooked_kink(int half) const {
  const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
  L depth(0.0);
  for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
    const std::size_t base = first_node(half, s);
    const L h = mesh.u[s + 1] - mesh.u[s], pitching = mesh.kink[s];
    L slope_before(0.0);
    for (std::size_t m = 0; m <= std::size_t(rule_.intervals); ++m) {
      const std::size_t node = base + m;
      const CrankKinematics<L>& k = configuration_of(node).kinematics;
      // Of the margin by crank angle, from there where it is positive on.
      const L slope = -(pitching * vehicle_.wings.pitch_coefficient * L(half == 0 ? 1.0 : -1.0) *
                        (k.stroke_second_derivative * trajectory_[node][0] + k.stroke_slope * rates_[node][0]));
      const L margin = pitching * margin_[node];
      if (m > 0 && m < std::size_t(rule_.intervals)) depth = max(depth, -margin);
      if (m > 0) {
        const L width = L(rule_.node[m] - rule_.node[m - 1]) * h;
        const Mask turns = slope_before < L(0.0) && slope > L(0.0);
        const L kink = select<L>(turns, slope - slope_before, L(1.0));
        const L lowest = pitching * margin_[node - 1] - L(0.5) * square(slope_before) * width * inverse_of(kink);
        depth = max(depth, select<L>(turns, -lowest, L(0.0)));
      }
      slope_before = slope;
    }
  }
  return depth;
}

/// How far the torque on the gearbox has the wrong sign inside the segments of half an iterate, as the nodes and the
/// cubics between them show it, of its largest magnitude.
template <class L, int N>
L PackOrbit<L, N>::overlooked_gear_kink(int half) const {
  const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
  L depth(0.0), highest(0.0);
  for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
    const std::size_t base = first_node(half, s), intervals = std::size_t(rule_.intervals);
    L slope_before(0.0);
    for (std::size_t m = 0; m <= intervals; ++m) {
      highest = max(highest, abs(margin_[base + m]));
      L slope(0.0);  // by the segment's length, from there where the torque has its sign on
      for (std::size_t j = 0; j <= intervals; ++j) slope = slope + L(rule_.slope[m][j]) * margin_[base + j];
      slope = slope * mesh.kink[s];
      if (m > 0 && m < intervals) depth = max(depth, -(mesh.kink[s] * margin_[base + m]));
      if (m > 0) {
        const L width(rule_.node[m] - rule_.node[m - 1]);
        const Mask turns = slope_before < L(0.0) && slope > L(0.0);
        const L curve = select<L>(turns, slope - slope_before, L(1.0));
        const L lowest =
            mesh.kink[s] * margin_[base + m - 1] - L(0.5) * square(slope_before) * width * inverse_of(curve);
        depth = max(depth, select<L>(turns, -lowest, L(0.0)));
      }
      slope_before = slope;
    }
  }
  return depth * inverse_of(max(highest, L(1e-300)));
}

/// Relative error of the rod force's peak where it stands on a kink, which the segment's end misses by a little.
template <class L, int N>
L PackOrbit<L, N>::error_of_peak_on_kink(const L& peak) const {
  const auto& force = observables_[std::size_t(Quantity::force)];
  L error(0.0);
  for (int half = 0; half < 2; ++half) {
    for (std::size_t s = 1; s < std::size_t(segments_); ++s) {
      const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
      const Observable<L>&before = force[first_node(half, s) - 1], &after = force[first_node(half, s)];
      const Mask here = mesh.kink[s - 1] * mesh.kink[s] < L(0.0) && after.value > L(0.99) * peak;
      const L missed = abs(off_[std::size_t(half * segments_) + s]) * max(abs(before.slope), abs(after.slope));
      error = max(error, select<L>(here, missed, L(0.0)));
    }
  }
  return error * inverse_of(max(peak, L(1e-300)));
}

}  // namespace wingbeat

// The segments of an iterate on SIMD lanes: the part of PackOrbit that finds the sign changes of the rod force between
// samples, lays the ends of segments onto them, and looks for those that a segment hides.
#pragma once

#include "wingbeat/ensemble/pack_orbit.hpp"

namespace wingbeat {

/// Sign changes of the rod force, or of the pitch margin, between the samples force[0..count] at u[0..count] of half an
/// iterate, by parabolas. Returns the largest distance from the switches known before [rad].
template <class L, int N>
L PackOrbit<L, N>::find_switches(ForceSwitches<L>& known, const L* u, const L* force, int count) {
  ForceSwitches<L> found;
  found.angle.fill(u[count]);
  found.count = L(0.0);
  found.first_sign = sign_of(force[0]);
  for (int k = 0; k < count; ++k) {
    const L f0 = force[k], f1 = force[k + 1];
    const Mask changes = (f0 >= L(0.0) && f1 < L(0.0)) || (f0 < L(0.0) && f1 >= L(0.0));
    if (!any<L>(changes)) continue;
    // Of the two neighbours the nearer to the switch.
    const L h = u[k + 1] - u[k];
    const L rise = f1 - f0, per_rise = inverse_of(rise);
    const L straight = -(f0 * per_rise);
    L curve;
    const auto left = [&] {
      const L h0 = u[k] - u[k - 1];
      return (rise - (f0 - force[k - 1]) * h * inverse_of(h0)) * h * inverse_of(L(h + h0));
    };
    const auto right = [&] {
      const L h2 = u[k + 2] - u[k + 1];
      return ((force[k + 2] - f1) * h * inverse_of(h2) - rise) * h * inverse_of(L(h + h2));
    };
    if (k == 0) {
      curve = right();
    } else if (k + 1 == count) {
      curve = left();
    } else {
      curve = select<L>(straight < L(0.5), left(), right());
    }
    // f0 + rise t - curve t (1 - t) = 0, by two Newton steps.
    L t = straight + straight * (L(1.0) - straight) * curve * per_rise;
    for (int n = 0; n < 2; ++n) {
      const L value = f0 + rise * t - curve * t * (L(1.0) - t);
      const L slope = rise - curve * (L(1.0) - L(2.0) * t);
      t = t - value * inverse_of(slope);
    }
    t = select<L>(t >= L(0.0) && t <= L(1.0), t, min(max(straight, L(0.0)), L(1.0)));
    const L root = u[k] + h * t;
    for (int n = 0; n < max_force_switches; ++n) {
      found.angle[std::size_t(n)] =
          select<L>(changes && found.count == L(double(n)), root, found.angle[std::size_t(n)]);
    }
    found.count = select<L>(changes, found.count + L(1.0), found.count);
  }
  unresolved_ = unresolved_ || found.count > L(double(max_force_switches));
  L offset(0.0);
  for (std::size_t n = 0; n < max_force_switches; ++n) offset = max(offset, abs(found.angle[n] - known.angle[n]));
  known = found;
  return offset;
}

/// Segments from -reach to reach between places, growing, of which lanes have `count`: of equal length between two of
/// them, their number in proportion to the distance. pass(m, n, where) is called for segment m where it lies beyond
/// place n.
template <class L, int N>
template <std::size_t max_ends, class Pass>
void PackOrbit<L, N>::lay_segments(const std::array<L, max_ends>& place, const L& count, const L& reach,
                                   HalfMesh<L>& mesh, const Pass& pass) const {
  const int steps = segments_;
  const L all(steps), per_length = L(0.5 * steps) / reach;
  std::array<L, max_ends + 2> node, position, per_step;
  node[0] = L(0.0);
  position[0] = -reach;
  for (std::size_t n = 0; n < max_ends; ++n) {
    const Mask used = count > L(double(n));
    const L wanted = nearest_whole(L((place[n] + reach) * per_length));
    const L within = min(max(wanted, node[n] + L(1.0)), all - (count - L(double(n))));
    node[n + 1] = select<L>(used, within, all);
    position[n + 1] = select<L>(used, place[n], reach);
  }
  node[max_ends + 1] = all;
  position[max_ends + 1] = reach;
  for (std::size_t n = 0; n <= max_ends; ++n) {
    per_step[n] = (position[n + 1] - position[n]) * inverse_of(max(L(node[n + 1] - node[n]), L(0.5)));
  }
  for (int m = 0; m < steps; ++m) {
    const L here(m);
    L u = position[0] + per_step[0] * here;
    for (std::size_t n = 1; n <= max_ends; ++n) {
      const Mask beyond = here >= node[n] && node[n] < all;
      u = select<L>(beyond, position[n] + per_step[n] * (here - node[n]), u);
      pass(std::size_t(m), n - 1, beyond);
    }
    mesh.u[std::size_t(m)] = u;
  }
  mesh.u[std::size_t(steps)] = reach;
}

/// The segments of half an iterate, which end at the sign changes of the rod force.
template <class L, int N>
void PackOrbit<L, N>::build_mesh(int half) {
  if (kinks_) return build_mesh_with_kinks(half);
  if constexpr (N == 2) return build_mesh_with_layers(half);
  const ForceSwitches<L>& s = switches_[std::size_t(half)];
  HalfMesh<L>& mesh = mesh_[std::size_t(half)];
  mesh.force.fill(s.first_sign);
  lay_segments(s.angle, s.count, reach(half), mesh, [&](std::size_t m, std::size_t, const Mask& beyond) {
    mesh.force[m] = select<L>(beyond, -mesh.force[m], mesh.force[m]);
  });
}

/// How deep the rod force, times the sign that it has on a segment, dips below zero between the nodes, by parabolas
/// [N]; 0 where it does not.
template <class L, int N>
L PackOrbit<L, N>::dip_between_nodes(std::size_t base, const L& sign) const {
  L depth(0.0);
  for (std::size_t m = 1; m < std::size_t(rule_.intervals); ++m) {
    const double x0 = rule_.node[m - 1], x1 = rule_.node[m], x2 = rule_.node[m + 1];
    const L f0 = sign * force_[base + m - 1], f1 = sign * force_[base + m], f2 = sign * force_[base + m + 1];
    const L left = (f1 - f0) * L(1.0 / (x1 - x0)), right = (f2 - f1) * L(1.0 / (x2 - x1));
    const L curve = (right - left) * L(1.0 / (x2 - x0)), slope = left + curve * L(x1 - x0), back = L(-0.5) * slope;
    const Mask inside = curve > L(0.0) && back > curve * L(x0 - x1) && back < curve * L(x2 - x1);
    const Mask dips = inside && square(back) > f1 * curve;
    if (!any<L>(dips)) continue;
    depth = max(depth, select<L>(dips, square(back) * inverse_of(select<L>(dips, curve, L(1.0))) - f1, L(0.0)));
  }
  return depth;
}

}  // namespace wingbeat

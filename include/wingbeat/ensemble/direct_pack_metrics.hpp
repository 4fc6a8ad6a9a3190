// What is read from the orbit on SIMD lanes: the part of DirectPackOrbit for means, extremes, errors and multipliers.
#pragma once

#include "wingbeat/ensemble/direct_pack_orbit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

template <class L, int N>
auto DirectPackOrbit<L, N>::read() -> Cycle {
  Cycle cycle;
  if (added_mass_) read_nodes<true>(cycle);
  else read_nodes<false>(cycle);
  read_extremes(cycle);
  return cycle;
}

/// Means by the stages' own weights, and what extremes are sought of at the stages.
template <class L, int N>
template <bool has_added_mass>
void DirectPackOrbit<L, N>::read_nodes(Cycle& cycle) {
  const Mode<L> upward;
  std::array<L, 6> sums;
  sums.fill(L(0.0));
  constexpr std::array which = {Integral::current_square, Integral::speed_square, Integral::electrical_work,
                                Integral::friction_work,  Integral::aero_work,    Integral::lift};
  for (std::size_t node = 0; node < nodes(); ++node) {
    const L v = voltage(node), i = current(node), omega = omega_[node];
    const Motion<L> m = motion_of<has_added_mass>(beta_[node], omega, i, v);
    const CycleIntegrals<L> in_time = integrands(m, omega, upward);
    const L weight(rule_.a[stages - 1][node % stages]);
    for (std::size_t q = 0; q < which.size(); ++q) sums[q] = sums[q] + weight * in_time[std::size_t(which[q])];
    acceleration_[node] = m.crank_acceleration;
    if (settings_.exchanged_energy) {
      moment_[node] = m.stored_moment;
      energy_[node] = stored_in_wings(beta_[node], omega);
    }
    if (settings_.current_peak) {
      if constexpr (N == 3) {
        current_slope_[node] = m.inductive_voltage * per_inductance_;
      } else {
        current_[node] = i;
        const L driven = omega_drive_ * voltage_slope(node);
        current_slope_[node] = per_resistance_ * (driven - vehicle_.motor.torque_constant * m.crank_acceleration);
      }
    }
  }
  const L whole = L(2.0) * length_in_time_;
  for (L& sum : sums) sum = whole * sum;
  cycle = {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], L(0.0), L(0.0), L(0.0), -start_[0]};
}

/// Energy of wings and springs, at rest or not [J].
template <class L, int N>
L DirectPackOrbit<L, N>::stored_in_wings(const L& beta, const L& omega) const {
  const L kinetic = L(0.5) * vehicle_.wing_count * vehicle_.wing_inertia * square(omega);
  return kinetic + vehicle_.wing_count * spring_loads(vehicle_.spring, beta).energy;
}

/// Calls visit(segment, at, where) where the slopes at the stages, those of half a period before being the negative
/// ones, change their sign, `at` between -1 and 1 in the segment being the zero of the polynomial through them. A
/// polynomial that dips through zero and back between two stages has two.
template <class L, int N>
template <class Visit>
void DirectPackOrbit<L, N>::for_each_zero(const std::array<L, max_nodes>& slopes, const Visit& visit) const {
  const L zero(0.0);
  for (std::size_t s = 0; s < segments_; ++s) {
    std::array<L, points> slope, curvature;
    slope[0] = s > 0 ? slopes[s * stages - 1] : -slopes[nodes() - 1];
    for (std::size_t m = 1; m < points; ++m) slope[m] = slopes[s * stages + m - 1];
    for (std::size_t m = 0; m < points; ++m) {
      curvature[m] = zero;
      for (std::size_t j = 0; j < points; ++j) curvature[m] = curvature[m] + L(rule_.slope[m][j]) * slope[j];
    }
    for (std::size_t m = 1; m < points; ++m) {
      const L before = slope[m - 1], after = slope[m], sign = sign_of(before);
      const Mask where = (before > zero && !(after > zero)) || (before < zero && !(after < zero));
      const Mask dips = before * after > zero && sign * curvature[m - 1] < zero && sign * curvature[m] > zero;
      if (!any<L>(where || dips)) continue;
      const Polynomial through_slopes = polynomial(slope);
      const L from(rule_.place[m - 1]), to(rule_.place[m]), width = to - from;
      if (any<L>(where)) {
        const L part = before * inverse_of(select<L>(where, before - after, L(1.0)));
        visit(s, zero_of(through_slopes, 0, from + part * width, from, to, where), where);
      }
      if (!any<L>(dips)) continue;
      const L part = curvature[m - 1] * inverse_of(select<L>(dips, curvature[m - 1] - curvature[m], L(1.0)));
      const L lowest = zero_of(through_slopes, 1, from + part * width, from, to, dips);
      const L value = sign * derivative_of(through_slopes, 0, lowest),
              curve = sign * derivative_of(through_slopes, 2, lowest);
      const Mask twice = dips && value < zero && curve > zero;
      if (!any<L>(twice)) continue;
      const L reach = sqrt(select<L>(twice, L(-2.0) * value * inverse_of(select<L>(twice, curve, L(1.0))), zero));
      visit(s, zero_of(through_slopes, 0, max(lowest - reach, from), from, lowest, twice), twice);
      visit(s, zero_of(through_slopes, 0, min(lowest + reach, to), lowest, to, twice), twice);
    }
  }
}

/// The order-th derivative of a polynomial.
template <class L, int N>
L DirectPackOrbit<L, N>::derivative_of(const Polynomial& p, std::size_t order, const L& x) {
  L value(0.0);
  for (std::size_t k = points; k-- > order;) {
    double factor = 1.0;
    for (std::size_t n = 0; n < order; ++n) factor = factor * double(k - n);
    const L coefficient = order == 0 ? p[k] : L(factor) * p[k];
    value = L(0.0) + coefficient + value * x;
  }
  return value;
}

/// A zero of the order-th derivative between two places, by Newton's method from `at`.
template <class L, int N>
L DirectPackOrbit<L, N>::zero_of(const Polynomial& p, std::size_t order, L x, const L& from, const L& to,
                                 const Mask& where) {
  for (int n = 0; n < 3; ++n) {
    const L value = derivative_of(p, order, x), change = derivative_of(p, order + 1, x);
    const L per_change = inverse_of(select<L>(where && !(change == L(0.0)), change, L(1e300)));
    x = min(max(x - value * per_change, from), to);
  }
  return x;
}

/// The polynomial through a segment's values, in powers of the place from its middle: of the place from its start the
/// powers would cancel at its end.
template <class L, int N>
auto DirectPackOrbit<L, N>::polynomial(const std::array<L, points>& values) const -> Polynomial {
  Polynomial result;
  for (std::size_t k = 0; k < points; ++k) {
    L sum(0.0);
    for (std::size_t m = 0; m < points; ++m) sum = sum + L(rule_.power[k][m]) * values[m];
    result[k] = sum;
  }
  return result;
}

/// A quantity inside a segment, `start` being its value at the reversal.
template <class L, int N>
L DirectPackOrbit<L, N>::inside(const std::array<L, max_nodes>& values, const L& start, std::size_t segment,
                                const L& x) const {
  std::array<L, points> through;
  through[0] = segment > 0 ? values[segment * stages - 1] : start;
  for (std::size_t m = 1; m < points; ++m) through[m] = values[segment * stages + m - 1];
  return derivative_of(polynomial(through), 0, x);
}

/// Extremes at the zeros of their derivatives; and whether the velocity keeps its sign.
template <class L, int N>
void DirectPackOrbit<L, N>::read_extremes(Cycle& cycle) {
  const L zero(0.0);
  // Off the reversals the velocity stays above what a dip between two stages could hide.
  const std::size_t last = nodes() - 1;
  Mask upward = acceleration_[last] < zero && start_[0] < zero;
  L highest(0.0), current_highest(0.0);
  for (std::size_t node = 0; node < last; ++node) {
    upward = upward && omega_[node] > zero;
    highest = max(highest, omega_[node]);
  }
  for (std::size_t node = 0; node + 1 < last; ++node) {
    const Mask dips = acceleration_[node] < zero && acceleration_[node + 1] > zero;
    upward = upward && !(dips && min(omega_[node], omega_[node + 1]) < L(0.05) * highest);
  }
  decided_ = decided_ && upward;
  for_each_zero(acceleration_, [&](std::size_t segment, const L& x, const Mask& where) {
    highest = select<L>(where, max(highest, inside(omega_, zero, segment, x)), highest);
  });
  cycle.velocity_peak = highest;
  if (settings_.current_peak) {
    const L start = -current_[last];
    for (std::size_t node = 0; node <= last; ++node) current_highest = max(current_highest, abs(current_[node]));
    for_each_zero(current_slope_, [&](std::size_t segment, const L& x, const Mask& where) {
      const L there = abs(inside(current_, start, segment, x));
      current_highest = select<L>(where, max(current_highest, there), current_highest);
    });
    cycle.current_peak = current_highest;
  }
  if (settings_.exchanged_energy) {
    // The power that wings and springs exchange is the rate of what they store.
    L total(0.0), before = stored_in_wings(start_[0], zero);
    for_each_zero(moment_, [&](std::size_t segment, const L& x, const Mask& where) {
      const L here = stored_in_wings(inside(beta_, start_[0], segment, x), inside(omega_, zero, segment, x));
      total = select<L>(where, total + abs(here - before), total);
      before = select<L>(where, here, before);
    });
    cycle.reactive_work = L(2.0) * (total + abs(energy_[last] - before));
  }
}

/// How far the cycles of two meshes are apart, of what is wanted; what the finer one is left with.
template <class L, int N>
L DirectPackOrbit<L, N>::apart(const Cycle& a, const Cycle& b) const {
  L largest(0.0);
  const auto compare = [&](const L& x, const L& y, const L& scale, double gain = mean_gain) {
    const L difference = L(gain) * abs(x - y);
    largest = max(largest, select<L>(difference == L(0.0), L(0.0), difference * inverse_of(max(scale, L(1e-300)))));
  };
  const auto compare_sizes = [&](const L& x, const L& y, double gain = mean_gain) { compare(x, y, abs(y), gain); };
  compare_sizes(a.current_square, b.current_square);
  compare_sizes(a.speed_square, b.speed_square);
  compare_sizes(a.electrical_work, b.electrical_work);
  compare_sizes(a.friction_work, b.friction_work);
  compare_sizes(a.aero_work, b.aero_work);
  compare_sizes(a.electrical_work - a.aero_work, b.electrical_work - b.aero_work);
  compare_sizes(a.stroke, b.stroke);
  // A mean lift is off by a part of what lift is at most.
  const L max_lift =
      L(1e-3) * abs(aero_loads(vehicle_.wings, b.velocity_peak).lift) * inverse_of(vehicle_.drive_frequency);
  compare(a.lift, b.lift, max(abs(b.lift), max_lift));
  if (settings_.velocity_peak || settings_.lift_peak) {
    // Lift changes by no more than four times as much.
    const L scale = settings_.lift_peak ? L(0.25) * b.velocity_peak : b.velocity_peak;
    compare(a.velocity_peak, b.velocity_peak, scale);
  }
  if (settings_.current_peak) compare_sizes(a.current_peak, b.current_peak, extreme_gain);
  if (settings_.exchanged_energy) compare_sizes(a.reactive_work, b.reactive_work, extreme_gain);
  return largest + square(newton_change_);
}

/// The largest modulus of the eigenvalues of the map from half a period's start to its end, squared.
template <class L, int N>
L DirectPackOrbit<L, N>::floquet_multiplier() const {
  const auto& M = half_map_;
  const auto modulus_of_pair = [](const L& trace, const L& determinant) {
    const L half = L(0.5) * trace, discriminant = square(half) - determinant;
    const L real = abs(half) + sqrt(max(discriminant, L(0.0)));
    return select<L>(discriminant >= L(0.0), real, sqrt(max(determinant, L(0.0))));
  };
  const auto minor = [&](std::size_t j, std::size_t k) {
    return L(0.0) + M[j][j + 1] * M[k][k + 1] - M[j][k + 1] * M[k][j + 1];
  };
  if constexpr (N == 2) {
    return square(modulus_of_pair(M[0][1] + M[1][2], minor(0, 1)));
  } else {
    // A real root of x^3 - c2 x^2 + c1 x - c0 by bisection; the others are those of a quadratic.
    const L c2 = M[0][1] + M[1][2] + M[2][3], c1 = minor(0, 1) + minor(0, 2) + minor(1, 2);
    const auto cofactor = [&](std::size_t j, std::size_t k) {
      return L(0.0) + M[1][j + 1] * M[2][k + 1] - M[1][k + 1] * M[2][j + 1];
    };
    const L c0 = L(0.0) + M[0][1] * cofactor(1, 2) - M[0][2] * cofactor(0, 2) + M[0][3] * cofactor(0, 1);
    L high = L(1.0) + max(abs(c2), max(abs(c1), abs(c0))), low = -high;
    for (int n = 0; n < 60; ++n) {
      const L middle = L(0.5) * (low + high);
      const Mask above = ((middle - c2) * middle + c1) * middle - c0 > L(0.0);
      high = select<L>(above, middle, high);
      low = select<L>(above, low, middle);
    }
    const L root = L(0.5) * (low + high), sum = c2 - root;
    return square(max(abs(root), modulus_of_pair(sum, c1 - root * sum)));
  }
}

}  // namespace wingbeat

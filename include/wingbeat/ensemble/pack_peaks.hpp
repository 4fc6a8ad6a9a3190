// Extremes of a cycle on SIMD lanes: the part of PackOrbit that looks for them.
#pragma once

#include "wingbeat/ensemble/pack_orbit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// The trajectory over a segment, which may differ from lane to lane: the integral of its rates' interpolant, and
/// through the nodes that the last correction has moved since the rates were taken.
template <class L, int N>
void PackOrbit<L, N>::follow(const L& segment, SegmentTrajectory<L, N>& trajectory) const {
  const std::size_t intervals = std::size_t(rule_.intervals);
  std::array<State, nodes_per_segment> rates, y;
  trajectory = {};
  for (State& state : y) state.fill(L(0.0));
  rates = y;
  for (int half = 0; half < 2; ++half) {
    const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
    for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
      const Mask here = segment == L(double(half * segments_) + double(s));
      if (!any<L>(here)) continue;
      const std::size_t base = first_node(half, s);
      trajectory.half = select<L>(here, L(half == 0 ? 1.0 : -1.0), trajectory.half);
      trajectory.u = select<L>(here, mesh.u[s], trajectory.u);
      trajectory.length = select<L>(here, mesh.u[s + 1] - mesh.u[s], trajectory.length);
      trajectory.force = select<L>(here, mesh.force[s], trajectory.force);
      if (kinks_) trajectory.kink = select<L>(here, mesh.kink[s], trajectory.kink);
      for (std::size_t k = 0; lags_ && k <= intervals; ++k) {
        L sum(0.0);
        for (std::size_t j = 0; j <= intervals; ++j) sum = sum + L(rule_.legendre[k][j]) * inductive_drop_[base + j];
        trajectory.inductive_drop[k] = select<L>(here, sum, trajectory.inductive_drop[k]);
      }
      for (std::size_t n = 0; n < N; ++n) {
        for (std::size_t j = 0; j <= intervals; ++j) {
          y[j][n] = select<L>(here, trajectory_[base + j][n], y[j][n]);
          rates[j][n] = select<L>(here, rates_[base + j][n], rates[j][n]);
        }
      }
    }
  }
  // Coefficients c of the rates; their integral from the start: c[k] (P[k+1] - P[k-1]) / (2 k + 1).
  const L half_length = L(0.5) * trajectory.length;
  for (std::size_t n = 0; n < N; ++n) {
    std::array<L, nodes_per_segment> c;
    for (std::size_t k = 0; k <= intervals; ++k) {
      L sum(0.0);
      for (std::size_t j = 0; j <= intervals; ++j) sum = sum + L(rule_.legendre[k][j]) * rates[j][n];
      c[k] = half_length * sum * L(1.0 / double(2 * k + 1));
    }
    auto& to = trajectory.legendre;
    to[0][n] = y[0][n] + c[0] - c[1];
    for (std::size_t k = 1; k <= intervals + 1; ++k) {
      to[k][n] = c[k - 1] - (k + 1 <= intervals ? c[k + 1] : L(0.0));
    }
    L reached = y[0][n];
    for (std::size_t m = 1; m <= intervals; ++m) {
      L sum(0.0);
      for (std::size_t j = 0; j <= intervals; ++j) sum = sum + L(rule_.between[m][j]) * rates[j][n];
      reached = reached + trajectory.length * sum;
      const L moved = y[m][n] - reached;
      for (std::size_t k = 0; k <= intervals; ++k) to[k][n] = to[k][n] + L(rule_.legendre[k][m]) * moved;
    }
  }
}

/// A quantity, with the motion, at distance x from the start of a segment.
template <class L, int N>
Observable<L> PackOrbit<L, N>::observable_inside(Quantity quantity, const SegmentTrajectory<L, N>& trajectory,
                                                 const L& x) const {
  System system = half_cycle(0);
  system.half = trajectory.half;
  system.middle = select<L>(trajectory.half > L(0.0), mechanism_.middle[0], mechanism_.middle[1]);
  if (kinks_) system.choose_side(trajectory.kink, trajectory.force);
  const L t = L(2.0) * x * inverse_of(max(trajectory.length, L(1e-12))) - L(1.0);
  State y;
  for (std::size_t n = 0; n < N; ++n) y[n] = trajectory.legendre[0][n] + t * trajectory.legendre[1][n];
  L before(1.0), here = t, slope_before(0.0), slope(1.0), drop_slope(0.0);
  if (lags_) {
    system.inductive_drop = trajectory.inductive_drop[0] + t * trajectory.inductive_drop[1];
    drop_slope = trajectory.inductive_drop[1];
  }
  for (std::size_t k = 1; k <= std::size_t(rule_.intervals); ++k) {
    const L next = L(double(2 * k + 1) / double(k + 1)) * t * here - L(double(k) / double(k + 1)) * before;
    for (std::size_t n = 0; n < N; ++n) y[n] = y[n] + trajectory.legendre[k + 1][n] * next;
    if (lags_) {
      const L next_slope = slope_before + L(double(2 * k + 1)) * here;
      system.inductive_drop = system.inductive_drop + trajectory.inductive_drop[k + 1] * next;
      drop_slope = drop_slope + trajectory.inductive_drop[k + 1] * next_slope;
      slope_before = slope;
      slope = next_slope;
    }
    before = here;
    here = next;
  }
  drop_slope = drop_slope * L(2.0) * inverse_of(max(trajectory.length, L(1e-12)));
  const L u = trajectory.u + x;
  const Configuration<L> configuration = system.configuration(u);
  const Motion<L> motion = system.motion(configuration, y, trajectory.force);
  const State dy = system.template rates_of<false>(motion, y, trajectory.force).dy;
  if (quantity != Quantity::force) return observable(system, configuration, y, motion, dy, quantity);
  // The slope along the solution by central differences.
  constexpr double by = 1e-4;
  L ahead[2];
  for (int side = 0; side < 2; ++side) {
    const L move(side == 0 ? -by : by);
    State moved;
    for (std::size_t n = 0; n < N; ++n) moved[n] = y[n] + move * dy[n];
    System there = system;
    if (lags_) there.inductive_drop = system.inductive_drop + move * drop_slope;
    ahead[side] = there.motion(there.configuration(u + move), moved, trajectory.force).rod_force;
  }
  return {trajectory.force * motion.rod_force, trajectory.force * (ahead[1] - ahead[0]) * L(0.5 / by)};
}

/// Calls visit(bracket, mask) for each subinterval of half a cycle, in order: from node to node, and where the cubic
/// through both turns twice in between, its two parts; subintervals that cannot rise above `floor` in any lane are left
/// out.
template <class L, int N>
template <class Visit>
void PackOrbit<L, N>::for_each_subinterval(int half, Quantity quantity, const L& floor, const Visit& visit) const {
  const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
  const auto& observables = observables_[std::size_t(quantity)];
  for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
    const std::size_t base = first_node(half, s);
    const L h = mesh.u[s + 1] - mesh.u[s];
    for (std::size_t m = 1; m <= std::size_t(rule_.intervals); ++m) {
      const Observable<L>& from = observables[base + m - 1];
      const Observable<L>& to = observables[base + m];
      const L x0 = L(rule_.node[m - 1]) * h, x1 = L(rule_.node[m]) * h, width = x1 - x0;
      const Mask may_rise = max(from.value, to.value) + L(0.3) * width * (abs(from.slope) + abs(to.slope)) > floor;
      if (!any<L>(may_rise)) continue;
      const PeakBracket<L> b = {
          L(double(half * segments_) + double(s)), x0, from.value, from.slope, x1, to.value, to.slope, L(0.0), L(0.0)};
      const L slope = (b.v1 - b.v0) * inverse_of(max(width, L(1e-300)));
      // A slope that is nowhere far below the larger one of the ends' does not change its sign in between.
      Mask twice = may_rise && b.d0 * b.d1 > L(0.0) && slope * sign_of(b.d0) < L(0.5) * max(abs(b.d0), abs(b.d1));
      if (any<L>(twice)) {
        const L c2 = L(3.0) * slope - L(2.0) * b.d0 - b.d1, c3 = b.d0 + b.d1 - L(2.0) * slope;
        const L discriminant = square(c2) - L(3.0) * c3 * b.d0;
        const L per_3c3 = inverse_of(select<L>(c3 == L(0.0), L(1e-300), L(3.0) * c3));
        const L middle = -(c2 * per_3c3), reach = sqrt(max(discriminant, L(0.0))) * abs(per_3c3);
        twice = twice && discriminant > L(0.0) && middle - reach > L(0.0) && middle + reach < L(1.0);
        if (any<L>(twice)) {
          visit(b, may_rise && !twice);
          SegmentTrajectory<L, N> trajectory;
          follow(b.segment, trajectory);
          const L x = x0 + select<L>(twice, middle, L(0.5)) * width;
          const Observable<L> observed = observable_inside(quantity, trajectory, x);
          PeakBracket<L> first = b, second = b;
          first.x1 = second.x0 = x;
          first.v1 = second.v0 = observed.value;
          first.d1 = second.d0 = observed.slope;
          visit(first, twice);
          visit(second, twice);
          continue;
        }
      }
      visit(b, may_rise);
    }
  }
}

template <class L, int N>
void PackOrbit<L, N>::keep(const PeakBracket<L>& from, const Mask& where, PeakBracket<L>& to) {
  using P = PeakBracket<L>;
  for (L P::* member :
       {&P::segment, &P::x0, &P::v0, &P::d0, &P::x1, &P::v1, &P::d1, &P::rises_and_falls, &P::estimate}) {
    to.*member = select<L>(where, from.*member, to.*member);
  }
}

/// Distance from x0, as a fraction of the bracket, of the maximum of the cubic through its ends; sets the estimate.
template <class L, int N>
L PackOrbit<L, N>::estimate_peak(PeakBracket<L>& b) {
  const L h = b.x1 - b.x0;
  const L slope = (b.v1 - b.v0) * inverse_of(max(h, L(1e-300)));
  const L z = b.d0 + b.d1 - L(3.0) * slope;
  const L root = sqrt(max(L(z * z - b.d0 * b.d1), L(0.0)));
  const Mask turns = b.d0 > L(0.0) && b.d1 < L(0.0);
  const L below = select<L>(turns, L(b.d0 - b.d1 + L(2.0) * root), L(1.0));
  const L t = min(max(L((b.d0 + root - z) * inverse_of(below)), L(0.0)), L(1.0));
  const L c2 = L(3.0) * slope - L(2.0) * b.d0 - b.d1, c3 = b.d0 + b.d1 - L(2.0) * slope;
  b.rises_and_falls = select<L>(turns, L(1.0), L(0.0));
  b.estimate = select<L>(turns, b.v0 + h * t * (b.d0 + t * (c2 + t * c3)), max(b.v0, b.v1));
  return t;
}

/// Relative error of an extreme at distance x from the start of a segment: what the trajectory's polynomial leaves out
/// there, by its first coefficients left out, as the last ones fall, and what Newton's last correction left stale,
/// times what the quantity makes of a change of the speed.
template <class L, int N>
L PackOrbit<L, N>::error_inside(Quantity quantity, const SegmentTrajectory<L, N>& trajectory, const L& x,
                                const L& value) const {
  const std::size_t end = std::size_t(rule_.intervals) + 1;
  const auto left_out = [&](std::size_t n) {
    const auto size = [&](std::size_t k) {
      return abs(trajectory.legendre[k][n]) + abs(trajectory.legendre[k - 1][n]);
    };
    const L high = size(end), low = max(size(end - 2), L(1e-300));
    return high * min(L(high * inverse_of(low)), L(1.0));
  };
  const L of_speed = left_out(0), speed = trajectory.legendre[0][0];
  const L per_value = inverse_of(max(abs(value), L(1e-300)));
  switch (quantity) {
    case Quantity::speed:
    case Quantity::negated_speed: return L(2.0) * of_speed * per_value;
    case Quantity::current:
      if constexpr (N == 2) return L(2.0) * max(L(of_speed * inverse_of(speed)), L(left_out(1) * per_value));
      else
        return L(2.0) * of_speed *
               max(inverse_of(speed), L(vehicle_.motor.torque_constant * per_resistance_ * per_value));
    case Quantity::force: {
      constexpr double by = 1e-5;
      L error(0.0);
      for (std::size_t n = 0; n < N; ++n) {
        const L size = n == 0 ? speed : current_scale_;
        SegmentTrajectory<L, N> beside = trajectory;
        beside.legendre[0][n] = trajectory.legendre[0][n] + L(by) * size;
        const L change = abs(observable_inside(quantity, beside, x).value - value) * L(1.0 / by) * per_value;
        L off = left_out(n);
        if (n == 0) off = off + L(0.5) * max_move_;
        error = error + L(2.0) * off * inverse_of(size) * change;
      }
      return error;
    }
    default: return L(2.0) * of_speed * inverse_of(speed);
  }
}

/// Takes the values that follow from the state at once from the nodes that the last correction has moved.
template <class L, int N>
void PackOrbit<L, N>::refresh(Quantity quantity) {
  if (quantity == Quantity::velocity || quantity == Quantity::force) return;
  auto& observables = observables_[std::size_t(quantity)];
  for (std::size_t n = 0; n < first_node(2, 0); ++n) {
    const State& y = trajectory_[n];
    L& value = observables[n].value;
    if (quantity == Quantity::speed) value = y[0];
    if (quantity == Quantity::negated_speed) value = -y[0];
    if (quantity == Quantity::current) {
      if constexpr (N == 2) value = y[1];
      else
        value = algebraic_current(vehicle_, lags_ ? L(vehicle_.voltage - inductive_drop_[n]) : vehicle_.voltage, y[0]);
    }
  }
}

/// The maximum within a bracket: the cubic's, read on the trajectory, and again within the bracket that this leaves.
/// What the trajectory errs by is added to the error of peaks.
template <class L, int N>
L PackOrbit<L, N>::refine(Quantity quantity, const L& sign, PeakBracket<L> b) {
  L highest = max(b.v0, b.v1);
  const Mask inside = b.rises_and_falls > L(0.0);
  if (!any<L>(inside)) return highest;
  SegmentTrajectory<L, N> trajectory;
  follow(b.segment, trajectory);
  Mask active = inside;
  L found = b.x0;
  for (int n = 0; n < 8 && any<L>(active); ++n) {
    const L t = estimate_peak(b);
    const L x = b.x0 + t * (b.x1 - b.x0);
    const Observable<L> observed = observable_inside(quantity, trajectory, x);
    const L v = sign * observed.value, d = sign * observed.slope;
    found = select<L>(active, x, found);
    const Mask rising = active && d > L(0.0), falling = active && !rising;
    b.x0 = select<L>(rising, x, b.x0);
    b.v0 = select<L>(rising, v, b.v0);
    b.d0 = select<L>(rising, d, b.d0);
    b.x1 = select<L>(falling, x, b.x1);
    b.v1 = select<L>(falling, v, b.v1);
    b.d1 = select<L>(falling, d, b.d1);
    highest = select<L>(active, max(highest, v), highest);
    // What is left to gain, by the cubic through the shrunken bracket.
    estimate_peak(b);
    active = active && b.estimate - highest > L(settings_.peak_tolerance) * abs(highest);
  }
  const L error = error_inside(quantity, trajectory, found, highest);
  peak_error_ = select<L>(inside, max(peak_error_, error), peak_error_);
  return select<L>(inside, max(highest, b.estimate), highest);
}

/// The maximum of a quantity over the cycle. Of two subintervals with almost the same peak both are refined.
template <class L, int N>
L PackOrbit<L, N>::peak(Quantity quantity) {
  L highest_node(-1e300);
  const std::size_t nodes = first_node(2, 0);
  refresh(quantity);
  for (std::size_t n = 0; n < nodes; ++n)
    highest_node = max(highest_node, observables_[std::size_t(quantity)][n].value);
  PeakBracket<L> best{}, other{};
  best.estimate = other.estimate = L(-1e300);
  for (int half = 0; half < 2; ++half) {
    for_each_subinterval(half, quantity, highest_node, [&](PeakBracket<L> b, const Mask& where) {
      estimate_peak(b);
      const Mask turns = where && b.rises_and_falls > L(0.0);
      const Mask first = turns && b.estimate > best.estimate;
      keep(best, first, other);
      keep(b, first, best);
      keep(b, turns && !first && b.estimate > other.estimate, other);
    });
  }
  const L highest =
      max(highest_node, select<L>(best.estimate > L(-1e300), refine(quantity, L(1.0), best), highest_node));
  // The cubics err by a small part of what they rise above their ends.
  const L rise = other.estimate - min(other.v0, other.v1) + best.estimate - min(best.v0, best.v1);
  const Mask close = other.estimate > L(-1e300) && other.estimate + L(0.2) * rise > best.estimate;
  if (!any<L>(close)) return highest;
  other.rises_and_falls = select<L>(close, other.rises_and_falls, L(0.0));
  return select<L>(close, max(highest, refine(quantity, L(1.0), other)), highest);
}

/// The work that wings and springs exchange with the rest, |power| integrated over the cycle [J]: the energy that they
/// store rises and falls by it between its extremes.
template <class L, int N>
L PackOrbit<L, N>::exchanged_energy() {
  L total(0.0);
  for (int half = 0; half < 2; ++half) {
    const auto& observables = observables_[std::size_t(Quantity::energy)];
    std::array<PeakBracket<L>, max_energy_extremes> extremes{};
    std::array<L, max_energy_extremes> signs;
    L count(0.0), sign_before(0.0);  // sign of the slope where the subinterval before ends
    const auto add = [&](PeakBracket<L> b, const L& sign, const Mask& where) {
      for (L* part : {&b.v0, &b.d0, &b.v1, &b.d1}) *part = sign * *part;
      estimate_peak(b);
      for (std::size_t n = 0; n < max_energy_extremes; ++n) {
        const Mask here = where && count == L(double(n));
        keep(b, here, extremes[n]);
        signs[n] = select<L>(here, sign, signs[n]);
      }
      count = select<L>(where, count + L(1.0), count);
    };
    for_each_subinterval(half, Quantity::energy, L(-1e300), [&](const PeakBracket<L>& b, const Mask& where) {
      const L sign = sign_of(b.d0), sign_after = sign_of(b.d1);
      // Without air, the energy turns where the rod force changes its sign: a node, on either side of which rounding
      // gives the slope another sign.
      const Mask turns_before = where && sign_before * sign < L(0.0), turns = where && sign * sign_after < L(0.0);
      if (any<L>(turns_before)) {
        PeakBracket<L> node = b;
        node.x1 = b.x0, node.v1 = b.v0, node.d1 = b.d0;
        add(node, sign_before, turns_before);
      }
      if (any<L>(turns)) add(b, sign, turns);
      sign_before = select<L>(where, sign_after, sign_before);
    });
    unresolved_ = unresolved_ || count > L(double(max_energy_extremes));
    L before = observables[first_node(half, 0)].value;
    for (std::size_t n = 0; n < max_energy_extremes; ++n) {
      const Mask exists = count > L(double(n));
      if (!any<L>(exists)) break;
      const L here = signs[n] * refine(Quantity::energy, signs[n], extremes[n]);
      total = select<L>(exists, total + abs(here - before), total);
      before = select<L>(exists, here, before);
    }
    const L end = observables[first_node(half, std::size_t(segments_)) - 1].value;
    total = total + abs(end - before);
  }
  return total;
}

}  // namespace wingbeat

// Newton's method along the iterate on SIMD lanes: the part of PackOrbit that places nodes on the segments and makes
// the trajectory satisfy the equations there.
#pragma once

#include "wingbeat/ensemble/pack_orbit.hpp"
#include "wingbeat/vehicle/motion.hpp"
namespace wingbeat {

/// Nodes on segments that end at the switches as march() left them, with its trajectory interpolated there.
template <class L, int N>
void PackOrbit<L, N>::place_nodes() {
  for (int half = 0; half < 2; ++half) {
    const System system = half_cycle(half);
    const HalfMesh<L> before = mesh_[std::size_t(half)];
    build_mesh(half);
    const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
    for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
      const Subinterval& from = subintervals_[std::size_t(half * segments_) + s];
      const Subinterval& to = subintervals_[std::size_t(half * segments_) + s + 1];
      const std::size_t base = first_node(half, s);
      const L u = mesh.u[s], h = mesh.u[s + 1] - u, h_before = before.u[s + 1] - before.u[s];
      const L shift = u - before.u[s], stretched = h - h_before;
      const L per_h_before = inverse_of(max(h_before, L(1e-12)));
      State c1, c2, c3;
      for (std::size_t n = 0; n < N; ++n) {
        const L rise = to.y[n] - from.y[n];
        const L d0 = select<L>(from.stiff, rise, h_before * from.rates[n]);
        const L d1 = select<L>(from.stiff, rise, h_before * to.rates[n]);
        c1[n] = d0;
        c2[n] = L(3.0) * rise - L(2.0) * d0 - d1;
        c3[n] = d0 + d1 - L(2.0) * rise;
      }
      for (std::size_t m = 0; m <= std::size_t(rule_.intervals); ++m) {
        const double x = rule_.node[m];
        if (m > 0 || s == 0) find_node(system, u, h, L(x), configurations_[base + m]);
        const L moved = (shift + L(x) * stretched) * per_h_before;
        for (std::size_t n = 0; n < N; ++n) {
          trajectory_[base + m][n] = from.y[n] + L(x) * (c1[n] + L(x) * (c2[n] + L(x) * c3[n])) +
                                     moved * (c1[n] + L(2.0 * x) * c2[n] + L(3.0 * x * x) * c3[n]);
        }
      }
    }
  }
}

/// What the nodes of a segment would each move by if the node before stood still. `end` is what the node before the
/// segment, and afterwards its last one, moves by if the iterate's start stands still.
///
/// The rates' integral from the segment's start on is off the trajectory by R; a correction is R + w with w' = J (w +
/// R). R swings from node to node, J does not: over an interval J counts as constant, and R as its mean over the
/// interval; where J is large against the interval, as the mean of the ends, which damps. `known_intervals` are the
/// rule's, or 0.
template <class L, int N>
template <int known_intervals>
void PackOrbit<L, N>::propose_with(std::size_t base, const L& h, State& end) {
  const std::size_t intervals = std::size_t(known_intervals > 0 ? known_intervals : rule_.intervals);
  const Mask smooth = resolves(base);
  std::array<State, nodes_per_segment> off;
  off[0].fill(L(0.0));
  for (std::size_t m = 1; m <= intervals; ++m) {
    State sum;
    sum.fill(L(0.0));
    for (std::size_t j = 0; j <= intervals; ++j) {
      const L weight(rule_.between[m][j]);
      for (std::size_t n = 0; n < N; ++n) sum[n] = sum[n] + weight * rates_[base + j][n];
    }
    for (std::size_t n = 0; n < N; ++n) {
      off[m][n] = off[m - 1][n] + (h * sum[n] - (trajectory_[base + m][n] - trajectory_[base + m - 1][n]));
    }
  }
  for (std::size_t n = 0; n < N; ++n) end[n] = end[n] + correction_[base][n];
  for (std::size_t m = 1; m <= intervals; ++m) {
    State mean;
    mean.fill(L(0.0));
    for (std::size_t j = 1; j <= intervals; ++j) {
      const L weight(rule_.mean[m][j]);
      for (std::size_t n = 0; n < N; ++n) mean[n] = mean[n] + weight * off[j][n];
    }
    const Matrix& step = step_[base + m];
    State from, before = end;
    for (std::size_t n = 0; n < N; ++n) {
      mean[n] = select<L>(smooth, mean[n], L(0.5) * (off[m - 1][n] + off[m][n]));
      from[n] = mean[n] - off[m - 1][n];
    }
    for (std::size_t n = 0; n < N; ++n) {
      L along = step[n][0] * from[0], onward = step[n][0] * before[0];
      if constexpr (N == 2) {
        along = along + step[n][1] * from[1];
        onward = onward + step[n][1] * before[1];
      }
      correction_[base + m][n] = off[m][n] - mean[n] + along;
      end[n] = onward + correction_[base + m][n];
    }
  }
}

/// The step of Newton's method by the segment's equations as a whole. In the last iteration the derivatives are those
/// of the one before.
template <class L, int N>
template <int known_intervals, bool renews>
void PackOrbit<L, N>::propose_in_one_piece(std::size_t base, const L& h, State& end, Matrix& whole) {
  const std::size_t intervals = std::size_t(known_intervals > 0 ? known_intervals : rule_.intervals);
  SegmentEquations<L, N, known_intervals, renews> equations;
  for (std::size_t m = 1; m <= intervals; ++m) {
    State sum;
    sum.fill(L(0.0));
    for (std::size_t j = 0; j <= intervals; ++j) {
      const L weight(rule_.up_to[m][j]);
      for (std::size_t n = 0; n < N; ++n) sum[n] = sum[n] + weight * rates_[base + j][n];
    }
    for (std::size_t n = 0; n < N; ++n) {
      equations.moved[m - 1][n][0] = h * sum[n] - (trajectory_[base + m][n] - trajectory_[base][n]);
    }
  }
  equations.solve(rule_, &jacobian_[base], h);
  for (std::size_t m = 1; m <= intervals; ++m) {
    for (std::size_t row = 0; row < N; ++row) {
      correction_[base + m][row] = equations.moved[m - 1][row][0];
      if constexpr (renews) {
        for (std::size_t n = 0; n < N; ++n) {
          L& step = step_[base + m][row][n];
          step = select<L>(settled_, step, equations.moved[m - 1][row][1 + n]);
        }
      }
    }
  }
  if constexpr (renews) append(step_[base + intervals], whole);
  for (std::size_t n = 0; n < N; ++n) end[n] = end[n] + correction_[base][n];
  const State start = end;
  for (std::size_t n = 0; n < N; ++n) {
    end[n] = correction_[base + intervals][n];
    for (std::size_t k = 0; k < N; ++k) end[n] = end[n] + step_[base + intervals][n][k] * start[k];
  }
}

/// Newton's step from the proposed corrections, along the iterate, which is to end where it started; `end` as propose()
/// leaves it.
template <class L, int N>
void PackOrbit<L, N>::correct(State end) {
  const std::size_t per_segment = std::size_t(rule_.intervals + 1), nodes = first_node(2, 0);
  State by, start;
  for (std::size_t n = 0; n < N; ++n) by[n] = end[n] + trajectory_[nodes - 1][n] - trajectory_[0][n];
  close_iterate(by);
  L sum(0.0);
  slowest_ = trajectory_[0][0];
  max_move_ = L(0.0);
  const L per_speed = inverse_of(slowest_), per_current = inverse_of(current_scale_);
  for (std::size_t base = 0; base < nodes; base += per_segment) {
    for (std::size_t m = 0; m < per_segment; ++m) {
      const std::size_t node = base + m;
      if (m == 0) {
        for (std::size_t n = 0; n < N; ++n) by[n] = by[n] + correction_[node][n];
        start = by;
      } else {
        const Matrix& step = step_[node];
        const State before = in_one_piece_ ? start : by;
        for (std::size_t n = 0; n < N; ++n) {
          by[n] = step[n][0] * before[0] + correction_[node][n];
          if constexpr (N == 2) by[n] = by[n] + step[n][1] * before[1];
        }
      }
      sum = sum + abs(by[0]) * per_speed;
      max_move_ = max(max_move_, abs(by[0]));
      if constexpr (N == 2) sum = sum + abs(by[1]) * per_current;
      for (std::size_t n = 0; n < N; ++n) {
        trajectory_[node][n] = select<L>(settled_, trajectory_[node][n], trajectory_[node][n] + by[n]);
      }
      slowest_ = min(slowest_, trajectory_[node][0]);
    }
  }
  residual_ = select<L>(settled_, residual_, sum * L(1.0 / double(nodes)));
  y_ = trajectory_[0];
}

/// The equations at all nodes, and the corrections that follow.
///
/// Where a node stands off the sign change it was meant for by d, the wrong branch has held, or will hold, over d. The
/// difference of the branches grows linearly from zero there, so that half of d times the difference at the node is the
/// error left behind, up to O(d^3). Where d is longer than the segment, or where the sign changes are others than those
/// that the segments were made for, an error of O(d^2) stays.
template <class L, int N>
template <typename PackOrbit<L, N>::Newton which>
void PackOrbit<L, N>::newton_iteration() {
  constexpr bool first = which == Newton::first, last = which == Newton::last;
  const std::size_t intervals = std::size_t(rule_.intervals);
  NodeRates at_node;
  Matrix jacobian, jacobian_before, monodromy;
  for (std::size_t row = 0; row < N; ++row) {
    for (std::size_t column = 0; column < N; ++column) monodromy[row][column] = L(row == column ? 1.0 : 0.0);
  }
  State end;
  end.fill(L(0.0));
  correction_[0] = end;
  L overlooked(0.0), highest(0.0), kink_depth(0.0), lift_magnitude(0.0);
  typename System::Quadrature integrands_before;
  if (lags_) correct_quasi_steady_current();
  if constexpr (last) {
    integrals_.fill(L(0.0));
    high_.fill(L(0.0));
    low_.fill(L(0.0));
    switch_error_ = layer_ = L(0.0);
  }
  for (int half = 0; half < 2; ++half) {
    System system = half_cycle(half);
    const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
    L h_before(0.0);
    for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
      const std::size_t base = first_node(half, s);
      const L sign = mesh.force[s], h = mesh.u[s + 1] - mesh.u[s];
      if (kinks_) system.choose_side(mesh.kink[s], mesh.force[s]);
      for (std::size_t m = 0; m <= intervals; ++m) {
        if (lags_) system.inductive_drop = inductive_drop_[base + m];
        if (kinks_) {
          margin_[base + m] = system.kink_margin_at(configuration_of(base + m), trajectory_[base + m], sign);
        }
        solver::Rates<System>& rates = at_node[last ? m : 0];
        if constexpr (last) {
          visit_node(system, base + m, sign, rates);
          highest = max(highest, abs(rates.switches[0]));
          if (m > 0 && m < intervals) overlooked = max(overlooked, -(rates.switches[0] * sign));
        } else if constexpr (first) {
          linearise(system, base + m, sign, rates, jacobian);
          if (in_one_piece_) {
            keep_settled(jacobian, jacobian_[base + m]);
          } else if (m > 0) {
            Matrix mean;
            for (std::size_t row = 0; row < N; ++row) {
              for (std::size_t column = 0; column < N; ++column) {
                mean[row][column] = L(0.5) * (jacobian_before[row][column] + jacobian[row][column]);
              }
            }
            Matrix step;
            propagator(mean, L(rule_.node[m] - rule_.node[m - 1]) * h, step);
            keep_settled(step, step_[base + m]);
            append(step_[base + m], monodromy);
          }
          jacobian_before = jacobian;
        } else {
          evaluate<false>(system, configuration_of(base + m), trajectory_[base + m], sign, rates);
        }
        rates_[base + m] = rates.dy;
        force_[base + m] = rates.switches[0];
        if (m > 0) continue;
        off_[std::size_t(half * segments_) + s] = L(0.0);
        if (half == 0 && s == 0) continue;
        // From the end of the segment before to the start of this one.
        State& jump = correction_[base];
        for (std::size_t n = 0; n < N; ++n) jump[n] = trajectory_[base - 1][n] - trajectory_[base][n];
        if (s == 0) continue;
        const Mask forces = mesh.force[s - 1] * sign < L(0.0);
        const Mask switches = kinks_ ? forces || mesh.kink[s - 1] * mesh.kink[s] < L(0.0) : forces;
        if (!any<L>(switches)) continue;
        const auto switch_at = [&](std::size_t node) {
          return kinks_ ? select<L>(forces, force_[node], margin_[node]) : force_[node];
        };
        L slope(0.0);
        for (std::size_t j = 0; j <= intervals; ++j)
          slope = slope + L(rule_.slope[intervals][j]) * switch_at(base - 1 - intervals + j);
        const L found = min(max(switch_at(base - 1) * h_before * inverse_of(slope), L(-1.0)), L(1.0));
        const L off = min(max(found, -h), h);
        const L half_off = select<L>(switches, L(0.5) * off, L(0.0));
        off_[std::size_t(half * segments_) + s] = select<L>(switches, last ? off : found, L(0.0));
        for (std::size_t n = 0; n < N; ++n) jump[n] = jump[n] - half_off * (rates_[base - 1][n] - rates_[base][n]);
        if (lags_) {
          const solver::Rates<System> by = relaxation(system, base, sign);
          for (std::size_t n = 0; n < N; ++n) jump[n] = jump[n] + select<L>(switches, by.dy[n], L(0.0));
          if constexpr (last) {
            for (std::size_t q = 0; q < integrals_.size(); ++q) {
              integrals_[q] = integrals_[q] + select<L>(switches, by.dq[q], L(0.0));
            }
            layer_ = max(layer_, select<L>(switches, abs(by.dy[0]) * inverse_of(trajectory_[base][0]), L(0.0)));
          }
        }
        if constexpr (last) {
          for (std::size_t q = 0; q < integrals_.size(); ++q) {
            integrals_[q] = integrals_[q] - half_off * (integrands_before[q] - rates.dq[q]);
          }
          const L left_behind = select<L>(off == found, abs(off) * square(off), misplaced(found));
          switch_error_ = max(switch_error_, select<L>(switches, left_behind, L(0.0)));
        }
      }
      h_before = h;
      propose<first>(base, h, end, monodromy);
      if constexpr (last) {
        for (std::size_t q = 0; q < integrals_.size(); ++q) {
          L sum(0.0);
          for (std::size_t m = 0; m <= intervals; ++m) sum = sum + L(rule_.weight[m]) * at_node[m].dq[q];
          integrals_[q] = integrals_[q] + h * sum;
        }
        L magnitude(0.0);
        for (std::size_t m = 0; m <= intervals; ++m) {
          magnitude = magnitude + L(rule_.weight[m]) * abs(at_node[m].dq[pack_integral(Integral::lift)]);
        }
        lift_magnitude = lift_magnitude + h * magnitude;
        integrands_before = at_node[intervals].dq;
        add_tails(at_node, base, h);
        overlooked = max(overlooked, dip_between_nodes(base, sign));
        if (wanted_[std::size_t(Quantity::force)]) {
          const L per_h = inverse_of(max(h, L(1e-12)));
          auto& observables = observables_[std::size_t(Quantity::force)];
          for (std::size_t m = 0; m <= intervals; ++m) {
            L slope(0.0);
            for (std::size_t j = 0; j <= intervals; ++j)
              slope = slope + L(rule_.slope[m][j]) * observables[base + j].value;
            observables[base + m].slope = slope * per_h;
          }
        }
      }
    }
    if constexpr (last) {
      std::array<L, 2 * max_half_segments + 1> u, force;
      for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
        const std::size_t base = first_node(half, s);
        u[2 * s] = mesh.u[s];
        force[2 * s] = force_[base];
        u[2 * s + 1] = L(0.5) * (mesh.u[s] + mesh.u[s + 1]);
        force[2 * s + 1] = force_[base + intervals / 2];
      }
      u[2 * std::size_t(segments_)] = mesh.u[std::size_t(segments_)];
      force[2 * std::size_t(segments_)] = force_[first_node(half, std::size_t(segments_)) - 1];
      const auto compare = [&](ForceSwitches<L>& switches) {
        const ForceSwitches<L> known = switches;
        const L offset = find_switches(switches, u.data(), force.data(), 2 * segments_);
        const Mask same = known.count == switches.count && known.first_sign == switches.first_sign && offset < L(0.1);
        switch_error_ = max(switch_error_, select<L>(same, L(0.0), misplaced(offset)));
      };
      compare(switches_[std::size_t(half)]);
      if (kinks_) {
        for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
          const std::size_t base = first_node(half, s);
          force[2 * s] = margin_[base];
          force[2 * s + 1] = margin_[base + intervals / 2];
        }
        force[2 * std::size_t(segments_)] = margin_[first_node(half, std::size_t(segments_)) - 1];
        compare(kink_switches_[std::size_t(half)]);
        kink_depth = max(kink_depth, loses_in_gear_ ? overlooked_gear_kink(half) : overlooked_kink(half));
      }
    }
  }
  if constexpr (first) keep_settled(monodromy, monodromy_);
  correct(end);
  if constexpr (last) {
    overlooked_ = max(L(overlooked * inverse_of(max(highest, L(1e-300)))), kink_depth);
    // As error_scale(): a mean lift below a thousandth of the lift itself need not be accurate beside itself.
    const L lift = max(abs(integrals_[pack_integral(Integral::lift)]), max(L(1e-3) * lift_magnitude, L(1e-300)));
    lift_opposed_ = max(L(lift_magnitude * inverse_of(lift) - L(1.0)), L(0.0));
    // The coefficients fall geometrically, and the sums over the nodes see none below the 2 n-th.
    step_error_ = speed_error_ = L(0.0);
    for (std::size_t c = 0; c < high_.size(); ++c) {
      const L scale =
          c == 0 ? L(1.0) : inverse_of(max(abs(integrals_[System::controlled_integrals[c - 1]]), L(1e-300)));
      const L ratio = high_[c] * inverse_of(max(low_[c], L(1e-300)));
      L error = high_[c] * scale;
      for (std::size_t k = 0; k < intervals / 2; ++k) error = error * ratio;
      // At the knots of a table third derivatives jump: coefficients fall with their fourth power only, in random
      // signs.
      if (has_knots_) error = max(error, L(L(1.0 / 128.0) * high_[c] * scale));
      step_error_ = max(step_error_, error);
      if (c < 2) speed_error_ = max(speed_error_, error);
    }
  }
}

/// Moves the ends of segments onto the sign changes that the last iteration found near them, and the nodes along.
template <class L, int N>
void PackOrbit<L, N>::follow_switches() {
  const std::size_t intervals = std::size_t(rule_.intervals);
  for (int half = 0; half < 2; ++half) {
    const System system = half_cycle(half);
    HalfMesh<L>& mesh = mesh_[std::size_t(half)];
    L end_before = mesh.u[0], shift(0.0);
    for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
      const std::size_t base = first_node(half, s);
      const L start = end_before, start_shift = shift, end = mesh.u[s + 1];
      end_before = end;
      shift = L(0.0);
      if (s + 1 < std::size_t(segments_)) {
        const L off = off_[std::size_t(half * segments_) + s + 1];
        const L narrowed = select<L>(off > L(0.0), end - start, mesh.u[s + 2] - end);
        shift = select<L>(abs(off) < L(0.2) * narrowed, -off, L(0.0));
      }
      if (!any<L>(!(shift == L(0.0)) || !(start_shift == L(0.0)))) continue;
      mesh.u[s + 1] = end + shift;
      const L u = start + start_shift, h = mesh.u[s + 1] - u, stretched = shift - start_shift;
      for (std::size_t m = 0; m <= intervals; ++m) {
        const L x(rule_.node[m]), moved = start_shift + x * stretched;
        for (std::size_t n = 0; n < N; ++n) {
          trajectory_[base + m][n] = trajectory_[base + m][n] + moved * rates_[base + m][n];
        }
        if (m > 0 || s == 0) find_node(system, u, h, x, configurations_[base + m]);
      }
    }
  }
}

/// Adds the last coefficients of a segment's rates of speed and integrals.
template <class L, int N>
void PackOrbit<L, N>::add_tails(const NodeRates& rates, std::size_t base, const L& h) {
  const std::size_t n = std::size_t(rule_.intervals);
  const L per_omega = inverse_of(trajectory_[base][0]);
  for (std::size_t c = 0; c < high_.size(); ++c) {
    L tail[4] = {L(0.0), L(0.0), L(0.0), L(0.0)};
    for (std::size_t j = 0; j <= n; ++j) {
      const L value = c == 0 ? rates[j].dy[0] * per_omega : rates[j].dq[System::controlled_integrals[c - 1]];
      for (std::size_t k = 0; k < 4; ++k) tail[k] = tail[k] + L(k <= n ? rule_.legendre[n - k][j] : 0.0) * value;
    }
    high_[c] = high_[c] + h * (abs(tail[0]) + abs(tail[1]));
    low_[c] = low_[c] + h * (abs(tail[2]) + abs(tail[3]));
  }
}

/// A quantity but the rod force, with the motion there.
template <class L, int N>
Observable<L> PackOrbit<L, N>::observable(const System& system, const Configuration<L>& configuration, const State& y,
                                          const Motion<L>& m, const State& dy, Quantity quantity) const {
  switch (quantity) {
    case Quantity::velocity:
      return {system.half * m.stroke_velocity, system.half * m.stroke_acceleration * inverse_of(y[0])};
    case Quantity::speed: return {y[0], dy[0]};
    case Quantity::negated_speed: return {-y[0], -dy[0]};
    case Quantity::current:
      if constexpr (N == 2) {
        return {y[1], dy[1]};
      } else {
        return {m.current, lags_ ? system.inductive_drop * per_inductance_ * inverse_of(y[0])
                                 : -(vehicle_.motor.torque_constant * dy[0] * per_resistance_)};
      }
    default: {
      // As wing_energy(), with the spring moment that the place has: M^2 / (2 N_w k) is stored in the springs.
      const L kinetic = L(0.5) * vehicle_.wing_count * vehicle_.wing_inertia * square(m.stroke_velocity);
      // At the dead centres the slope is zero but for rounding; its sign is that of the moment there.
      const L rising = sign_of(L(system.half * m.stored_moment));
      const L steepness = max(abs(L(m.stored_moment * m.kinematics.stroke_slope)), L(1e-30));
      return {kinetic + compliance_ * square(configuration.spring_moment), rising * steepness};
    }
  }
}

/// Rates at a node, and their derivatives by the state there. Without added mass the rates are linear in the current.
template <class L, int N>
void PackOrbit<L, N>::linearise(const System& system, std::size_t node, const L& force, solver::Rates<System>& rates,
                                Matrix& jacobian) const {
  const Configuration<L>& configuration = configuration_of(node);
  const State& y = trajectory_[node];
  evaluate<false>(system, configuration, y, force, rates);
  if (N == 1 || adds_mass_ || loses_in_gear_) {
    jacobian = jacobian_at(system, configuration, y, rates.dy, force);
    return;
  }
  solver::Rates<System> beside;
  State moved = y;
  const L by = L(1e-7) * y[0];
  moved[0] = moved[0] + by;
  evaluate<false>(system, configuration, moved, force, beside);
  const CrankKinematics<L>& k = configuration.kinematics;
  const L inertia_g =
      vehicle_.motor.inertia * k.wing_jacobian + vehicle_.wing_count * vehicle_.wing_inertia * k.stroke_slope *
                                                     (k.crank_jacobian + force * vehicle_.friction.radius);
  const L both = inverse_of(L(inertia_g * y[0])), per_omega = both * inertia_g, per_move = L(1e7) * per_omega;
  for (std::size_t row = 0; row < N; ++row) jacobian[row][0] = (beside.dy[row] - rates.dy[row]) * per_move;
  if constexpr (N == 2) {
    jacobian[0][1] = vehicle_.motor.torque_constant * k.wing_jacobian * both;
    jacobian[1][1] = -(circuit_resistance(vehicle_) * per_inductance_ * per_omega);
  }
}

/// Rates and observables at a node.
template <class L, int N>
template <bool every_law>
void PackOrbit<L, N>::visit_node_of(const System& system, std::size_t node, const L& force,
                                    solver::Rates<System>& rates) {
  const Configuration<L>& configuration = configuration_of(node);
  const State& y = trajectory_[node];
  const Motion<L> motion = system.template motion_of<every_law>(configuration, y, force);
  rates = system.template rates_of<true>(motion, y, force);
  const auto keep_of = [&](Quantity q) {
    if (wanted_[std::size_t(q)]) {
      observables_[std::size_t(q)][node] = observable(system, configuration, y, motion, rates.dy, q);
    }
  };
  keep_of(Quantity::velocity);
  keep_of(Quantity::current);
  keep_of(Quantity::negated_speed);
  keep_of(Quantity::speed);
  keep_of(Quantity::energy);
  if (wanted_[std::size_t(Quantity::force)]) {
    observables_[std::size_t(Quantity::force)][node].value = force * motion.rod_force;
  }
}

}  // namespace wingbeat

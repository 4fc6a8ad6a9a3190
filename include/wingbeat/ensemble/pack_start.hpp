// From a vehicle on each lane to a first trajectory of its cycle: the part of PackOrbit that comes before the nodes.
#pragma once

#include "wingbeat/ensemble/pack_orbit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

// Of implicit_step(), the other stage being the step's end: 1 - sqrt(1/2).
inline constexpr double first_stage = 0.29289321881345248;

template <class L, int N>
void PackOrbit<L, N>::tabulate() {
  for (int half = 0; half < 2; ++half) {
    const System system = half_cycle(half);
    for (int k = 0; k < coarse_samples; ++k) {
      table_[std::size_t(half)][std::size_t(k)] =
          system.configuration(L(reach(half) * L(2.0 * k / (coarse_samples - 1) - 1.0)));
    }
  }
}

/// Marks the lanes that could jam or lock: within a margin, for the table is coarse; static_balance() has the last
/// word.
template <class L, int N>
void PackOrbit<L, N>::assess_statics() {
  const Vehicle<L>& v = vehicle_;
  const L stall = stall_torque(v);
  unresolved_ = !(stall > breakaway_torque(v));
  locked_ = !unresolved_ && unresolved_;
  // From rest, locking shows by itself, and only jams on the way are left to be distinguished from near ones.
  const bool from_rest = settings_.approach == PackApproach::from_rest;
  const L inertia_margin(from_rest ? 0.05 : 0.15), lever_margin(from_rest ? 0.02 : 0.05);
  const bool springs = !from_rest && any<L>(v.spring.stiffness > L(0.0));
  for (const auto& half : table_) {
    for (const Configuration<L>& configuration : half) {
      const CrankKinematics<L>& k = configuration.kinematics;
      unresolved_ = unresolved_ || !(min_inertia(v, k) > inertia_margin * v.motor.inertia) ||
                    !(k.wing_jacobian > lever_margin * typical_lever(v.transmission));
      if (springs) {
        unresolved_ = unresolved_ || !(advance_torque(v, k, configuration.spring_moment, L(L(0.95) * stall)) > L(0.0));
      }
    }
  }
}

/// Starts at guess_orbit()'s speed; returns how many speeds balance.
template <class L, int N>
L PackOrbit<L, N>::guess_speed() {
  constexpr int stride = 4, count = coarse_samples / stride;
  std::array<LoadPlace<L>, 2 * count> places;
  for (int n = 0; n < 2 * count; ++n) {
    const Configuration<L>& configuration =
        table_[std::size_t(n / count)][std::size_t(stride / 2 + stride * (n % count))];
    places[std::size_t(n)] = load_place(vehicle_, configuration.kinematics, configuration.spring_moment);
  }
  const System downward = half_cycle(1);
  const OrbitGuess<L> guess =
      guess_orbit(vehicle_, places, [&](const L& angle) { return downward.configuration(reach(1) - angle); });
  y_[0] = guess.crank_speed;
  if constexpr (N == 2) y_[1] = algebraic_current(vehicle_, vehicle_.voltage, guess.earlier_speed);
  return guess.balanced.count;
}

/// From rest at crank angle zero, in time, by the classical fourth-order method: over the lower dead centre twice,
/// where the cycle may begin. Lanes that come near standing still are in doubt, but for those that come to rest and
/// stay.
template <class L, int N>
void PackOrbit<L, N>::start_from_rest() {
  using Moving = std::array<L, N + 1>;  // crank angle, state
  const int steps_per_cycle = settings_.start_up_steps;
  // The kinks leave an error of the second order, which counts most where the crank almost stands still.
  L slow_limit = L(1.92 / steps_per_cycle) * no_load_;
  const L end = L(4.0 * pi) + (mechanism_.middle[0] - reach(0));
  const L shortest = L(two_pi / double(steps_per_cycle)) * inverse_of(no_load_);
  // A current that settles faster than the method is stable follows the speed. The inductance left out changes the
  // speed by less than its share of the motor's time constant.
  Mask at_once = L(lags_ ? 1.0 : 0.0) > L(0.0);
  if constexpr (N == 2) at_once = shortest * circuit_resistance(vehicle_) * per_inductance_ > L(2.0);
  slow_limit = slow_limit + select<L>(at_once, L(2.0) * electrical_to_mechanical_time() * no_load_, L(0.0));
  // A kink leaves an error of the speed of dt^2 times the speed: a slow crank takes longer steps, within what resolves
  // the motor's time constants and the swing of the crank by the motor's and the springs' torque.
  const L braking = square(vehicle_.motor.torque_constant) * per_resistance_ * inverse_of(vehicle_.motor.inertia);
  const L spring =
      vehicle_.wing_count * vehicle_.spring.stiffness * square(typical_stroke_slope(vehicle_.transmission));
  const L swinging = max(L(braking * no_load_), L(spring * inverse_of(vehicle_.motor.inertia)));
  L fastest = max(braking, sqrt(swinging));
  if constexpr (N == 2) {
    fastest = max(fastest, select<L>(at_once, L(0.0), L(circuit_resistance(vehicle_) * per_inductance_)));
  }
  const L longest = max(shortest, L(0.5) * inverse_of(fastest));
  const L start_limit = min(L(1.3) * slow_limit, L(0.05) * no_load_);
  const auto rates = [&](const Moving& x) {
    System system = half_cycle(0);
    State y;
    for (std::size_t n = 0; n < N; ++n) y[n] = x[n + 1];
    if constexpr (N == 2) y[1] = select<L>(at_once, algebraic_current(vehicle_, vehicle_.voltage, y[0]), y[1]);
    const CrankKinematics<L> k = mechanism_.kinematics(x[0]);
    system.half = sign_of(k.stroke_slope);
    const typename System::Accelerations a = system.accelerations(system.configuration_of(k), y);
    Moving r;
    r[0] = y[0];
    r[1] = a.crank;
    if constexpr (N == 2) r[2] = select<L>(at_once, L(0.0), L(a.inductive_voltage * per_inductance_));
    return r;
  };
  const auto moved = [](const Moving& x, const Moving& rate, const L& by) {
    Moving to;
    for (std::size_t n = 0; n <= N; ++n) to[n] = x[n] + by * rate[n];
    return to;
  };
  Moving x;
  x.fill(L(0.0));
  y_.fill(L(0.0));
  Mask done = L(1.0) < L(0.0), started = done, slow = done, stopped = done;
  L waited(0.0);  // shortest steps at rest, or since the crank was slow: after a few cycles' worth others must decide
  for (int n = 0; n < steps_per_cycle * settings_.start_up_cycles; ++n) {
    if (all<L>(done || stopped || waited > L(2.0 * steps_per_cycle))) break;
    const L dt =
        max(shortest, min(longest, L(shortest * sqrt(L(no_load_ * inverse_of(max(x[1], L(1e-6) * no_load_)))))));
    const Moving k1 = rates(x);
    const Moving k2 = rates(moved(x, k1, L(0.5) * dt));
    const Moving k3 = rates(moved(x, k2, L(0.5) * dt));
    const Moving k4 = rates(moved(x, k3, dt));
    Moving next;
    for (std::size_t j = 0; j <= N; ++j) {
      next[j] = x[j] + dt * L(1.0 / 6.0) * (k1[j] + L(2.0) * (k2[j] + k3[j]) + k4[j]);
    }
    // Friction holds a crank that has not started; it does not turn it backwards.
    const Mask held = !started && !(next[1] > L(0.0));
    next[0] = select<L>(held, x[0], next[0]);
    next[1] = select<L>(held, L(0.0), next[1]);
    started = started || next[1] > start_limit;
    slow = slow || (started && !done && !(next[1] > slow_limit));
    waited = select<L>(slow || !started, waited + dt * inverse_of(shortest), waited);
    const Mask stops = started && !done && !stopped && !(next[1] > L(0.0));
    const Mask arrives = !done && !stopped && next[0] >= end;
    const L part = (end - x[0]) * inverse_of(max(L(next[0] - x[0]), L(1e-300)));
    for (std::size_t j = 0; j < N; ++j) y_[j] = select<L>(arrives, x[j + 1] + part * (next[j + 1] - x[j + 1]), y_[j]);
    done = done || arrives;
    stopped = stopped || stops;
    for (std::size_t j = 0; j <= N; ++j) x[j] = select<L>(stopped && !stops, x[j], next[j]);
  }
  const L stall = stall_torque(vehicle_);
  if constexpr (N == 2) {
    y_[1] = select<L>(at_once, algebraic_current(vehicle_, vehicle_.voltage, y_[0]), y_[1]);
    x[2] = select<L>(at_once, stall * inverse_of(vehicle_.motor.torque_constant), x[2]);
  }
  // A crank that has come to rest where friction outweighs the drive, at the present current and at the one that it
  // settles to, stays.
  const CrankKinematics<L> k = mechanism_.kinematics(x[0]);
  const L N_k_beta = spring_moment(vehicle_, k);
  L margin = lock_margin(vehicle_, k, N_k_beta, stall);
  if constexpr (N == 2) {
    margin = min(margin, lock_margin(vehicle_, k, N_k_beta, L(vehicle_.motor.torque_constant * x[2])));
  }
  const Mask rests = stopped || (!started && !(x[1] > L(0.0)));
  // One that the springs turn back is caught: i_s being the stalled motor's current, kinetic energy, what springs and
  // stall torque store and L_a (i - i_s)^2 / 2 together only fall, so that it comes neither over the load that has
  // stopped it nor, backwards, over where it has started from, until friction holds it.
  constexpr double beyond = 0.05;  // [rad]
  // What the springs' torque exceeds the motor's stall torque and friction by [N m].
  const auto turns_back = [&](const L& angle) {
    const CrankKinematics<L> kinematics = mechanism_.kinematics(angle);
    const L F_s = static_rod_force(kinematics, spring_moment(vehicle_, kinematics));
    return F_s * kinematics.crank_jacobian + vehicle_.load_torque - stall - holding_torque(vehicle_, F_s);
  };
  const L back = min(turns_back(x[0]), turns_back(L(x[0] + L(beyond))));
  L magnetic = L(0.5) * vehicle_.motor.armature_inductance * square(current_scale_);
  if constexpr (N == 2) {
    magnetic = magnetic * select<L>(at_once, L(1.0), square(L(x[2] * inverse_of(current_scale_) - L(1.0))));
  }
  const Mask friction = vehicle_.friction.radius > L(0.0) || breakaway_torque(vehicle_) > L(0.0);
  const Mask caught = stopped && friction && L(beyond) * back > magnetic;
  margin = select<L>(caught, max(margin, back), margin);
  locked_ = rests && !unresolved_ && margin > L(2.4 / steps_per_cycle) * stall;
  in_doubt_ = !locked_ && (slow || !done);
}

/// Whether an explicit step of fourth order would be near its limit of stability.
template <class L, int N>
auto PackOrbit<L, N>::is_stiff(const Matrix& jacobian, const L& h) -> Mask {
  L fastest = abs(jacobian[0][0]);
  if constexpr (N == 2) fastest = max(fastest, abs(jacobian[1][1]));
  return h * fastest > L(1.5);
}

/// A step by the L-stable diagonally implicit method of second order with two stages (Alexander 1977), each by a few
/// Newton steps with the derivatives at the step's start; rates(stage, y) are those at a stage's place.
template <class L, int N>
template <class Rates>
auto PackOrbit<L, N>::implicit_step(const State& y, const L& h, const Matrix& jacobian, const Rates& rates) const
    -> State {
  const L own = L(first_stage) * h;
  Matrix inverse;  // of 1 - first_stage h jacobian
  if constexpr (N == 1) {
    inverse[0][0] = inverse_of(L(L(1.0) - own * jacobian[0][0]));
  } else {
    // By elimination: of a b - c d, either product may be the fused one, another in each half of a block.
    const L a = L(1.0) - own * jacobian[0][0], d = L(1.0) - own * jacobian[1][1];
    const L b = -(own * jacobian[0][1]), c = -(own * jacobian[1][0]);
    const L per_a = inverse_of(a), factor = c * per_a, per_rest = inverse_of(L(d - factor * b));
    inverse[1][1] = per_rest;
    inverse[1][0] = -(factor * per_rest);
    inverse[0][1] = -(b * per_a * per_rest);
    inverse[0][0] = per_a - b * per_a * inverse[1][0];
  }
  State known = y, moved = y;
  for (int stage = 0; stage < 2; ++stage) {
    for (int newton = 0; newton < 2; ++newton) {
      const State slope = rates(stage, moved);
      State off;
      for (std::size_t n = 0; n < N; ++n) off[n] = known[n] + own * slope[n] - moved[n];
      const L least = L(0.3) * moved[0];  // it shall not pass standstill
      for (std::size_t n = 0; n < N; ++n) {
        moved[n] = moved[n] + inverse[n][0] * off[0];
        if constexpr (N == 2) moved[n] = moved[n] + inverse[n][1] * off[1];
      }
      moved[0] = max(moved[0], least);
    }
    // What the first stage leaves to the second: y + (1 - first_stage) h slope.
    for (std::size_t n = 0; n < N; ++n) known[n] = y[n] + L((1.0 - first_stage) / first_stage) * (moved[n] - y[n]);
  }
  return moved;
}

/// Derivatives of the rates at a sample, each on the branch that holds there.
template <class L, int N>
auto PackOrbit<L, N>::jacobian_on_its_branch(const System& system, const Configuration<L>& configuration,
                                             const State& y, const State& rates) const -> Matrix {
  State beside;
  L force;
  return derivatives(y, rates, [&](const State& moved) -> const State& {
    find_rates(system, configuration, moved, beside, force);
    return beside;
  });
}

/// Where a step of coarse_iterate() from y, over the three places from u on, is stiff, takes an implicit one instead:
/// its end, and the rod force's switch in its middle and at its end.
template <class L, int N>
void PackOrbit<L, N>::replace_stiff(const System& system, const Configuration<L>* over, const L& u, const L& h,
                                    const State& y, const Matrix& jacobian, const Mask& stiff, State& end,
                                    L& force_in_middle, L& force_at_end) const {
  State rates;
  L force;
  Configuration<L> inside;
  find_configuration(system, u + L(first_stage) * h, inside);
  const State by_implicit = implicit_step(y, h, jacobian, [&](int stage, const State& stage_state) {
    find_rates(system, stage == 0 ? inside : over[2], stage_state, rates, force);
    return rates;
  });
  State middle;
  for (std::size_t n = 0; n < N; ++n) {
    end[n] = select<L>(stiff, by_implicit[n], end[n]);
    middle[n] = L(0.5) * (y[n] + end[n]);
  }
  find_rates(system, over[1], middle, rates, force);
  force_in_middle = select<L>(stiff, force, force_in_middle);
  find_rates(system, over[2], end, rates, force);
  force_at_end = select<L>(stiff, force, force_at_end);
}

/// One cycle by the classical fourth-order method, each stage on the branch that holds there; the last one finds the
/// switches.
template <class L, int N>
template <bool last>
void PackOrbit<L, N>::coarse_iterate() {
  slowest_ = y_[0];
  for (int half = 0; half < 2; ++half) {
    const System system = half_cycle(half);
    const L h = reach(half) * L(2.0 / coarse_half_steps), half_h = L(0.5) * h;
    std::array<L, coarse_samples> angles;
    for (std::size_t k = 0; k < coarse_samples; ++k)
      angles[k] = reach(half) * L(2.0 * double(k) / (coarse_samples - 1) - 1.0);
    const auto& table = table_[std::size_t(half)];
    std::array<L, coarse_samples> force, margin;
    const auto moved = [](const State& from, const State& slope, const L& by) {
      State to;
      for (std::size_t n = 0; n < N; ++n) to[n] = from[n] + by * slope[n];
      return to;
    };
    for (std::size_t k = 0; k + 2 < coarse_samples; k += 2) {
      const auto slope_at = [&](std::size_t sample, const State& y) {
        const typename System::Accelerations a = system.accelerations(table[sample], y);
        force[sample] = a.force_switch;
        if (kinks_) margin[sample] = system.kink_margin_at(table[sample], y, sign_of(a.force_switch));
        return system.slope(a, inverse_of(y[0]));
      };
      const State k1 = slope_at(k, y_);
      Mask stiff = L(1.0) < L(0.0);
      Matrix jacobian;
      if (settings_.implicit) {
        jacobian = jacobian_on_its_branch(system, table[k], y_, k1);
        stiff = is_stiff(jacobian, h);
      }
      State next = y_;
      if (kinks_ || !all<L>(stiff)) {  // the margins are those of the explicit stages
        const State k2 = slope_at(k + 1, moved(y_, k1, half_h));
        const State k3 = slope_at(k + 1, moved(y_, k2, half_h));
        const State k4 = slope_at(k + 2, moved(y_, k3, h));
        for (std::size_t n = 0; n < N; ++n) {
          next[n] = y_[n] + L(1.0 / 6.0) * h * (k1[n] + L(2.0) * (k2[n] + k3[n]) + k4[n]);
        }
      }
      if (any<L>(stiff)) {
        replace_stiff(system, &table[k], angles[k], h, y_, jacobian, stiff, next, force[k + 1], force[k + 2]);
      }
      y_ = next;
      slowest_ = min(slowest_, y_[0]);
    }
    if constexpr (last) {
      find_switches(switches_[std::size_t(half)], angles.data(), force.data(), coarse_samples - 1);
      if (kinks_) find_switches(kink_switches_[std::size_t(half)], angles.data(), margin.data(), coarse_samples - 1);
    }
  }
  lost_ = lost_ || !(slowest_ > floor_);
}

/// A cycle from y_ by the classical fourth-order method with one step per segment; corrects the switches.
template <class L, int N>
void PackOrbit<L, N>::march() {
  solver::Rates<System> k1, k2, k3, k4;
  for (int half = 0; half < 2; ++half) {
    System system = half_cycle(half);
    build_mesh(half);
    const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
    std::array<L, 2 * max_half_segments + 1> u, force, margin;
    std::array<Configuration<L>, 3> configurations;
    configurations[2] = system.configuration(mesh.u[0]);
    const auto moved = [](const State& from, const State& slope, const L& by) {
      State to;
      for (std::size_t n = 0; n < N; ++n) to[n] = from[n] + by * slope[n];
      return to;
    };
    for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
      Subinterval& subinterval = subintervals_[std::size_t(half * segments_) + s];
      const L sign = mesh.force[s], h = mesh.u[s + 1] - mesh.u[s], half_h = L(0.5) * h;
      if (kinks_) system.choose_side(mesh.kink[s], mesh.force[s]);
      u[2 * s] = mesh.u[s];
      u[2 * s + 1] = mesh.u[s] + half_h;
      const Configuration<L>&start = configurations[s % 2 == 0 ? 2 : 0], &middle = configurations[1],
            &end = configurations[s % 2 == 0 ? 0 : 2];
      find_configuration(system, u[2 * s + 1], configurations[1]);
      find_configuration(system, mesh.u[s + 1], configurations[s % 2 == 0 ? 0 : 2]);
      evaluate<false>(system, start, y_, sign, k1);
      force[2 * s] = k1.switches[0];
      if (kinks_) margin[2 * s] = system.kink_margin_at(start, y_, sign);
      subinterval.y = y_;
      subinterval.rates = k1.dy;
      Mask stiff = L(1.0) < L(0.0);
      Matrix jacobian;
      if (settings_.implicit) {
        jacobian = jacobian_at(system, start, y_, k1.dy, sign);
        stiff = is_stiff(jacobian, h);
      }
      subinterval.stiff = stiff;
      State next = y_;
      if (!all<L>(stiff)) {
        evaluate<false>(system, middle, moved(y_, k1.dy, half_h), sign, k2);
        const State inside = moved(y_, k2.dy, half_h);
        evaluate<false>(system, middle, inside, sign, k3);
        force[2 * s + 1] = k3.switches[0];
        if (kinks_) margin[2 * s + 1] = system.kink_margin_at(middle, inside, sign);
        evaluate<false>(system, end, moved(y_, k3.dy, h), sign, k4);
        for (std::size_t n = 0; n < N; ++n) {
          next[n] = y_[n] + L(1.0 / 6.0) * h * (k1.dy[n] + L(2.0) * (k2.dy[n] + k3.dy[n]) + k4.dy[n]);
        }
      }
      if (any<L>(stiff)) {
        solver::Rates<System> rates;
        Configuration<L> inside_step;
        find_configuration(system, mesh.u[s] + L(first_stage) * h, inside_step);
        const State by_implicit = implicit_step(y_, h, jacobian, [&](int stage, const State& y) {
          evaluate<false>(system, stage == 0 ? inside_step : end, y, sign, rates);
          return rates.dy;
        });
        State between;
        for (std::size_t n = 0; n < N; ++n) {
          next[n] = select<L>(stiff, by_implicit[n], next[n]);
          between[n] = L(0.5) * (y_[n] + next[n]);
        }
        evaluate<false>(system, middle, between, sign, rates);
        force[2 * s + 1] = select<L>(stiff, rates.switches[0], force[2 * s + 1]);
        if (kinks_) {
          margin[2 * s + 1] = select<L>(stiff, system.kink_margin_at(middle, between, sign), margin[2 * s + 1]);
        }
      }
      y_ = next;
    }
    u[2 * std::size_t(segments_)] = mesh.u[std::size_t(segments_)];
    evaluate<false>(system, configurations[segments_ % 2 == 0 ? 2 : 0], y_, mesh.force[std::size_t(segments_ - 1)], k4);
    force[2 * std::size_t(segments_)] = k4.switches[0];
    subintervals_[std::size_t((half + 1) * segments_)].y = y_;
    subintervals_[std::size_t((half + 1) * segments_)].rates = k4.dy;
    find_switches(switches_[std::size_t(half)], u.data(), force.data(), 2 * segments_);
    if (kinks_) {
      margin[2 * std::size_t(segments_)] =
          system.kink_margin_at(configurations[segments_ % 2 == 0 ? 2 : 0], y_, mesh.force[std::size_t(segments_ - 1)]);
      find_switches(kink_switches_[std::size_t(half)], u.data(), margin.data(), 2 * segments_);
    }
  }
}

}  // namespace wingbeat

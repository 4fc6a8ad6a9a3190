// The direct drive as a periodic system in the phase of its supply: what solve/ integrates (model.md section 6).
#pragma once

#include <array>
#include <cmath>
#include <concepts>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/energy_balance.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/iterate.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// States stroke angle beta, its velocity and, with inductance (N = 3), current i; independent variable the phase of
/// the supply, v = V sin phi, from 0 to 2 pi. In time, with the drive frequency f (model.md section 6; friction is
/// added to the damping):
/// \f[
/// (J + N_\mathrm{w} J_\mathrm{w})\, \ddot\beta = K i - b\, \dot\beta - M_\mathrm{aero} - N_\mathrm{w} k \beta, \qquad
/// L_\mathrm{a} \frac{\mathrm{d}i}{\mathrm{d}t} = V \sin\varphi - R_\mathrm{a} i - K \dot\beta, \qquad
/// \dot\varphi = 2 \pi f
/// \f]
///
/// Constant friction (T_c) makes the right-hand side jump where the velocity changes sign, and holds the shaft at rest
/// while |K i - N_w k beta| <= T_c. Whether it holds is one more sign: `slip` is -1 then.
template <Scalar S, int N>
struct DirectSystem {
  using Real = S;
  using State = std::array<S, N>;
  using Quadrature = CycleIntegrals<S>;
  /// Signs, those of switches first: velocity, end of sticking, pitching, stored moment; slipping or stuck.
  enum Sign { velocity, release, pitching, stored, slip };
  using Switches = std::array<S, 4>;
  static constexpr int state_switches = 3;  ///< the stored moment causes no kink in the solution
  using Signs = std::array<S, 5>;
  static constexpr bool contracts_slowly = true;
  static constexpr bool has_rod = false;
  /// Integrals whose error limits the steps.
  static constexpr std::array<std::size_t, 6> controlled_integrals = {
      std::size_t(Integral::current_square), std::size_t(Integral::speed_square),  std::size_t(Integral::friction_work),
      std::size_t(Integral::aero_work),      std::size_t(Integral::reactive_work), std::size_t(Integral::lift)};
  /// What has an extreme that is a metric.
  static constexpr std::array extremes = {Extreme::current, Extreme::lift, Extreme::flapping_velocity,
                                          Extreme::stroke_max, Extreme::stroke_min};

  Vehicle<S> vehicle;
  State typical;        ///< size of each state, scale of errors
  bool sticks = false;  ///< there is constant friction

  DirectSystem() = default;
  DirectSystem(const Vehicle<S>& v, const State& size)
      : vehicle(v), typical(size), sticks(value_of(v.friction.torque + v.motor.friction_torque) > 0.0) {}

  template <Scalar T>
  DirectSystem<T, N> cast() const {
    std::array<T, N> size;
    for (std::size_t n = 0; n < N; ++n) size[n] = T(typical[n]);
    return {wingbeat::cast<T>(vehicle), size};
  }

  static double period() { return two_pi; }
  static const std::array<solver::FixedNode, 0>& fixed_nodes() {
    static constexpr std::array<solver::FixedNode, 0> none = {};
    return none;
  }
  static bool admissible(const State&) { return true; }
  State error_scale(const State& y) const {
    using std::abs;
    State scale;
    for (std::size_t n = 0; n < N; ++n) scale[n] = abs(y[n]) + S(0.1) * typical[n];
    return scale;
  }

  /// What the integrals of a closed cycle show of their errors, relative.
  double imbalance(const Quadrature& totals) const
    requires std::same_as<S, double>
  {
    return relative_energy_gap(vehicle, totals);
  }

  /// Angular frequency of the supply [rad/s]: d phi / dt.
  S phase_rate() const { return S(two_pi) * vehicle.drive_frequency; }
  S phase_rate(const State&) const { return phase_rate(); }
  static const S& shaft_speed(const State& y) { return y[1]; }
  static const S& shaft_angle(const S&, const State& y) { return y[0]; }
  static const S& stroke_angle(const Motion<S>&, const State& y) { return y[0]; }
  S voltage(const S& phi) const {
    using std::sin;
    return vehicle.voltage * sin(phi);
  }
  S current(const S& phi, const State& y) const {
    if constexpr (N == 3) {
      return y[2];
    } else {
      return algebraic_current(vehicle, voltage(phi), y[1]);
    }
  }

  bool jumps(std::size_t k) const { return sticks && k <= release; }

  Signs start_signs(const State& y) const {
    Signs signs;
    signs.fill(S(1.0));
    if (!sticks) return signs;
    signs[velocity] = sign_of(y[1]);
    if (value_of(y[1]) == 0.0) hold_or_move(S(0.0), y, signs);
    return signs;
  }

  /// Switch k is crossed: a shaft that comes to rest is held, or turns back.
  void event_transition(std::size_t k, const S& phi, State& y, Signs& signs) const {
    if (!jumps(k)) {
      signs[k] = -signs[k];
    } else if (k == velocity) {
      y[1] = S(0.0);
      hold_or_move(phi, y, signs);
    } else {
      signs[slip] = S(1.0);
      signs[velocity] = sign_of(net_torque(phi, y));
    }
  }

  /// A solution next to a recorded one that came to rest at phi: at its own rest, a little earlier or later, the rates
  /// change as recorded.
  template <bool quadratures>
  void reset_map(const S& phi, State& y, const Signs& from, const Signs& to, Quadrature* totals) const {
    if (!sticks) return;
    const bool stuck = value_of(to[slip]) < 0.0;
    const bool came_to_rest =
        value_of(from[slip]) > 0.0 && (stuck || value_of(from[velocity]) != value_of(to[velocity]));
    if (came_to_rest) {
      const auto before = rates<quadratures>(phi, y, from);
      const S late = -y[1] / before.dy[1];
      const auto after = rates<quadratures>(phi, y, to);
      for (std::size_t n = 0; n < N; ++n) y[n] = y[n] + (before.dy[n] - after.dy[n]) * late;
      if constexpr (quadratures) {
        for (std::size_t q = 0; q < before.dq.size(); ++q) {
          (*totals)[q] = (*totals)[q] + (before.dq[q] - after.dq[q]) * late;
        }
      }
    }
    if (stuck) y[1] = S(0.0);
  }

  static Branch<S> branch(const Signs& signs) {
    return {signs[velocity], S(1.0), signs[velocity], signs[stored] * signs[velocity], signs[pitching]};
  }

  [[gnu::always_inline]] Motion<S> motion(const S& phi, const State& y, const Signs& signs) const {
    const S N_k_beta = spring_moment_at(y);
    const S v = voltage(phi), i = current(phi, y);
    const bool stuck = value_of(signs[slip]) < 0.0;
    const S omega = stuck ? S(0.0) : y[1];
    const Branch<S> on = branch(signs);
    const IntermediateTerms<S> terms =
        terms_at(vehicle, direct_kinematics<S>(), N_k_beta, omega, i, v, on.stroke, on.direction, on.pitching);
    Motion<S> m = motion_on(vehicle, terms, i, v, on);
    if (stuck) {
      m.crank_acceleration = m.stroke_acceleration = S(0.0);
      m.rod_force = m.stored_moment = N_k_beta;
      m.motor_torque = terms.motor.torque;
      m.friction_torque = terms.motor.torque - N_k_beta - vehicle.load_torque;
    }
    return m;
  }

  CycleExtremes<S> candidates(const Motion<S>& m, const State& y, const Signs& signs) const {
    return extreme_candidates(m, m.stroke_velocity, branch(signs), y[0]);
  }

  template <bool quadratures>
  solver::Rates<DirectSystem> rates(const S& phi, const State& y, const Signs& signs) const {
    using std::abs;
    const Motion<S> m = motion(phi, y, signs);
    const S per_phase_rate = S(1.0) / phase_rate();
    const bool stuck = value_of(signs[slip]) < 0.0;
    solver::Rates<DirectSystem> r;
    r.dy[0] = m.stroke_velocity * per_phase_rate;
    r.dy[1] = m.crank_acceleration * per_phase_rate;
    if constexpr (N == 3) r.dy[2] = m.inductive_voltage / vehicle.motor.armature_inductance * per_phase_rate;
    r.switches[velocity] = stuck ? signs[velocity] : y[1];
    r.switches[release] = stuck ? S(holding_torque() - abs(net_torque(phi, y))) : S(1.0);
    r.switches[pitching] = m.aero.pitch_margin;
    r.switches[stored] = m.stored_moment;
    if constexpr (quadratures) {
      const CycleIntegrals<S> in_time = integrands(m, m.stroke_velocity, branch(signs));
      for (std::size_t q = 0; q < in_time.size(); ++q) r.dq[q] = in_time[q] * per_phase_rate;
    }
    return r;
  }

 private:
  S spring_moment_at(const State& y) const { return vehicle.wing_count * vehicle.spring.stiffness * y[0]; }
  /// T_c [N m].
  S holding_torque() const { return vehicle.friction.torque + vehicle.motor.friction_torque; }
  /// K i - T_x - N_w k beta [N m]: what would move the shaft at rest.
  S net_torque(const S& phi, const State& y) const {
    State at_rest = y;
    at_rest[1] = S(0.0);
    return vehicle.motor.torque_constant * current(phi, at_rest) - vehicle.load_torque - spring_moment_at(y);
  }
  void hold_or_move(const S& phi, const State& y, Signs& signs) const {
    using std::abs;
    const S torque = net_torque(phi, y);
    if (value_of(S(abs(torque))) <= value_of(holding_torque())) {
      signs[slip] = S(-1.0);
    } else {
      signs[slip] = S(1.0);
      signs[velocity] = sign_of(torque);
    }
  }
};

}  // namespace wingbeat

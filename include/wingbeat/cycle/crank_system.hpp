// The crank-driven vehicle as a periodic system in crank angle: what solve/ integrates (model.md section 2).
#pragma once

#include <array>
#include <cmath>
#include <concepts>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/configurations.hpp"
#include "wingbeat/cycle/crank_turn.hpp"
#include "wingbeat/cycle/energy_balance.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/iterate.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// States crank speed omega and, with inductance (N = 2), current i; independent variable crank angle from 0 to 2 pi.
/// Valid while omega > 0. V: a Vehicle, or what has the same members with another transmission. With the acceleration
/// of motion_on(), and i following omega without inductance (model.md section 2):
/// \f[
/// \frac{\mathrm{d}\omega}{\mathrm{d}\theta} = \frac{\dot\omega}{\omega}, \qquad
/// \frac{\mathrm{d}i}{\mathrm{d}\theta} = \frac{v - (R_\mathrm{a} + R_\mathrm{i})\, i - K \omega}{L_\mathrm{a} \omega},
/// \qquad f = \left( \int_0^{2\pi} \frac{\mathrm{d}\theta}{\omega} \right)^{-1}
/// \f]
template <Scalar S, int N, class V = Vehicle<S>>
struct CrankSystem : CrankTurn<S> {
  static_assert(Transmission<decltype(V::transmission), S>);
  using Real = S;
  using State = std::array<S, N>;
  using Quadrature = CycleIntegrals<S>;
  /// Signs, those of switches first: rod force, pitching, gear torque, stored moment; stroke velocity.
  enum Sign { force, pitching, gear, stored, stroke };
  using Switches = std::array<S, 4>;
  static constexpr int state_switches = 3;  ///< the stored moment causes no kink in the solution
  /// Integrals whose error limits the steps. Not those that may vanish up to rounding.
  static constexpr std::array<std::size_t, 5> controlled_integrals = {
      std::size_t(Integral::time), std::size_t(Integral::friction_work), std::size_t(Integral::aero_work),
      std::size_t(Integral::reactive_work), std::size_t(Integral::lift)};
  using Signs = std::array<S, 5>;

  V vehicle;
  S speed_floor = S(0.0);    ///< below this crank speed [rad/s] the crank counts as stopped
  S current_scale = S(0.0);  ///< v / (R_a + R_i) [A], scale of errors in the current

  CrankSystem() = default;
  CrankSystem(const V& v, const S& floor, const S& scale) : vehicle(v), speed_floor(floor), current_scale(scale) {
    if constexpr (std::same_as<S, double>) this->turn_at(reversals(v.transmission), stroke);
  }

  template <Scalar T>
  auto cast() const {
    const auto of_t = wingbeat::cast<T>(vehicle);
    return CrankSystem<T, N, std::remove_const_t<decltype(of_t)>>{of_t, T(speed_floor), T(current_scale)};
  }

  Signs start_signs() const { return {S(1.0), S(1.0), S(1.0), S(1.0), S(this->first_stroke())}; }

  bool admissible(const State& y) const { return all<S>(y[0] > speed_floor); }

  State error_scale(const State& y) const {
    State scale;
    scale[0] = y[0];
    if constexpr (N == 2) {
      using std::abs;
      scale[1] = abs(y[1]) + S(0.1) * current_scale;
    }
    return scale;
  }

  /// True where the current follows the speed so quickly, within a small part of a radian, that explicit steps would
  /// have to be shorter for it than their accuracy asks for.
  bool stiff(const State& y) const
    requires std::same_as<S, double> && (N == 2)
  {
    return circuit_resistance(vehicle) > 24.0 * vehicle.motor.armature_inductance * y[0];
  }

  /// How many times smaller than what limits their errors (`scale`) the integrals of a cycle are: metrics are to be
  /// accurate relative to themselves. A mean lift below a thousandth of its peak need not be.
  double cancellation(const Quadrature& totals, const Quadrature& scale) const
    requires std::same_as<S, double>
  {
    constexpr double usual = 2.0, max_cancellation = 1e3;
    double largest = 1.0;
    // Near its speed without load a motor's current is the small difference of two large voltages.
    const double charge = std::abs(totals[std::size_t(Integral::current)]);
    const double drop = circuit_resistance(vehicle) * charge, back_emf = two_pi * vehicle.motor.torque_constant;
    largest = std::max(largest, back_emf / (usual * drop + back_emf / max_cancellation));
    for (const std::size_t q : controlled_integrals) {
      if (scale[q] > 0.0)
        largest = std::max(largest, scale[q] / (usual * std::abs(totals[q]) + scale[q] / max_cancellation));
    }
    return largest;
  }

  /// What the integrals of a closed cycle show of their errors, relative.
  double imbalance(const Quadrature& totals) const
    requires std::same_as<S, double>
  {
    return relative_energy_gap(vehicle, totals);
  }

  S current(const S&, const State& y) const { return current(y); }
  S current(const State& y) const {
    if constexpr (N == 2) {
      return y[1];
    } else {
      return algebraic_current(vehicle, vehicle.voltage, y[0]);
    }
  }

  static Branch<S> branch(const Signs& signs) {
    return {signs[stroke], signs[force], S(1.0), signs[stored] * signs[stroke], signs[pitching], signs[gear]};
  }

  Configuration<S> configuration(const S& theta) const {
    using std::cos;
    using std::sin;
    return configuration_at(vehicle, S(sin(theta)), S(cos(theta)));
  }
  template <std::size_t count>
  std::array<Configuration<S>, count> configurations(const S& theta, const S& h, const double (&c)[count]) const
    requires std::same_as<S, double>
  {
    std::array<double, count> angles;
    for (std::size_t n = 0; n < count; ++n) angles[n] = theta + c[n] * h;
    std::array<Configuration<S>, count> configurations;
    if constexpr (std::same_as<V, Vehicle<double>>) {
      configurations_at(vehicle, angles, configurations);
    } else {
      for (std::size_t n = 0; n < count; ++n) configurations[n] = configuration(angles[n]);
    }
    return configurations;
  }

  [[gnu::always_inline]] Motion<S> motion(const Configuration<S>& configuration, const State& y,
                                          const Signs& signs) const {
    const S i = current(y);
    const S v_t = terminal_voltage(vehicle, vehicle.voltage, i);
    return motion_at(vehicle, configuration, y[0], i, v_t, branch(signs));
  }
  [[gnu::always_inline]] Motion<S> motion(const S& theta, const State& y, const Signs& signs) const {
    return motion(configuration(theta), y, signs);
  }

  CycleExtremes<S> candidates(const Motion<S>& m, const State& y, const Signs& signs) const {
    return extreme_candidates(m, y[0], branch(signs));
  }

  template <bool quadratures>
  solver::Rates<CrankSystem> rates(const S& theta, const State& y, const Signs& signs) const {
    return rates<quadratures>(configuration(theta), y, signs);
  }
  template <bool quadratures>
  solver::Rates<CrankSystem> rates(const Configuration<S>& configuration, const State& y, const Signs& signs) const {
    const Motion<S> m = motion(configuration, y, signs);
    const S per_omega = S(1.0) / y[0];
    solver::Rates<CrankSystem> r;
    r.dy[0] = m.crank_acceleration * per_omega;
    if constexpr (N == 2) r.dy[1] = m.inductive_voltage / vehicle.motor.armature_inductance * per_omega;
    const S gear_switch = has_gear_loss(vehicle.motor) ? m.gear_torque : S(1.0);
    r.switches = {m.force_switch, m.aero.pitch_margin, gear_switch, m.stored_moment};
    if constexpr (quadratures) {
      const CycleIntegrals<S> in_time = integrands(m, y[0], branch(signs));
      for (std::size_t q = 0; q < in_time.size(); ++q) r.dq[q] = in_time[q] * per_omega;
    }
    return r;
  }
};

}  // namespace wingbeat

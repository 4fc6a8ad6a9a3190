// The crank-driven vehicle whose wings pitch on a hinge, as a periodic system in crank angle (model.md sections 2, 12).
#pragma once

#include <array>
#include <cmath>
#include <concepts>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/crank_turn.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/pitch_stops.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// States crank speed omega, pitch angle psi, its velocity and, with inductance (N = 4), current i; independent
/// variable crank angle from 0 to 2 pi. Valid while omega > 0.
template <Scalar S, int N>
struct PitchCrankSystem : CrankTurn<S> {
  using Real = S;
  using State = std::array<S, N>;
  static constexpr std::size_t shaft = 0, pitch = 1;
  /// Behind the integrals that all vehicles have: loss in the hinges [J]; chordwise_lift() [N s].
  static constexpr std::size_t hinge_work = integral_count, chordwise = integral_count + 1;
  using Quadrature = std::array<S, integral_count + 2>;
  /// Signs, those of switches first: rod force, gear torque, pitch velocity, stop, stored moment; stroke velocity, and
  /// those of pitch_stops.
  enum Sign { force, gear, turn, stop, stored, stroke, held, impacts };
  using Switches = std::array<S, 5>;
  static constexpr int state_switches = 4;  ///< the stored moment causes no kink in the solution
  using Signs = std::array<S, 8>;
  static constexpr bool contracts_slowly = true;
  static constexpr bool state_jumps = true;
  /// Integrals whose error limits the steps.
  static constexpr std::array<std::size_t, 6> controlled_integrals = {
      std::size_t(Integral::time),          std::size_t(Integral::friction_work), std::size_t(Integral::aero_work),
      std::size_t(Integral::reactive_work), std::size_t(Integral::lift),          hinge_work};

  Vehicle<S> vehicle;
  State typical;           ///< size of each state, scale of errors
  S speed_floor = S(0.0);  ///< below this crank speed [rad/s] the crank counts as stopped

  PitchCrankSystem() = default;
  PitchCrankSystem(const Vehicle<S>& v, const State& size, const S& floor)
      : vehicle(v), typical(size), speed_floor(floor) {
    if constexpr (std::same_as<S, double>) this->turn_at(reversals(v.transmission), stroke);
  }

  template <Scalar T>
  PitchCrankSystem<T, N> cast() const {
    std::array<T, N> size;
    for (std::size_t n = 0; n < N; ++n) size[n] = T(typical[n]);
    return {wingbeat::cast<T>(vehicle), size, T(speed_floor)};
  }

  bool admissible(const State& y) const { return all<S>(y[0] > speed_floor); }
  State error_scale(const State& y) const {
    using std::abs;
    State scale;
    scale[0] = y[0];
    for (std::size_t n = 1; n < N; ++n) scale[n] = abs(y[n]) + S(0.1) * typical[n];
    return scale;
  }

  S current(const S&, const State& y) const {
    if constexpr (N == 4) {
      return y[3];
    } else {
      return algebraic_current(vehicle, vehicle.voltage, y[0]);
    }
  }
  CrankKinematics<S> kinematics(const S& theta) const {
    using std::cos;
    using std::sin;
    return crank_kinematics(vehicle.transmission, S(sin(theta)), S(cos(theta)));
  }

  using CrankTurn<S>::stroke_angle;
  S stroke_angle(const S& theta, const State&) const { return wingbeat::stroke_angle(kinematics(theta)); }
  static S stroke_sign(const Signs& signs) { return signs[stroke]; }

  bool jumps(std::size_t k) const { return k == stop && has_stop(vehicle.pitch.hinge); }
  Signs start_signs(const State& y) const {
    Signs signs;
    signs.fill(S(1.0));
    signs[stroke] = S(this->first_stroke());
    if (pitch_stops::rests_at_stop(*this, y)) pitch_stops::hold_or_leave(*this, S(0.0), y, signs);
    return signs;
  }
  void event_transition(std::size_t k, const S& theta, State& y, Signs& signs, Quadrature* totals) const {
    if (jumps(k)) pitch_stops::event_transition(*this, theta, y, signs, totals);
    else signs[k] = -signs[k];
  }
  template <bool quadratures>
  void reset_map(const S& theta, State& y, const Signs& from, const Signs& to, Quadrature* totals) const {
    pitch_stops::reset_map<quadratures>(*this, theta, y, from, to, totals);
  }

  static Branch<S> branch(const Signs& signs) {
    return {signs[stroke], signs[force], S(1.0), signs[stored] * signs[stroke], S(1.0), signs[gear]};
  }

  PitchMotion<S> pitch_motion(const S& theta, const State& y, const Signs& signs) const {
    const CrankKinematics<S> k = kinematics(theta);
    const S i = current(theta, y), v_t = terminal_voltage(vehicle, vehicle.voltage, i);
    const S psi_rate = select(signs[held] >= S(0.0), y[2], S(0.0));
    return pitch_motion_on(vehicle, vehicle.pitch, k, spring_moment(vehicle, k), y[0], i, v_t, y[1], psi_rate,
                           branch(signs), PitchBranch<S>{signs[turn], signs[held]});
  }

  Motion<S> motion(const S& theta, const State& y, const Signs& signs) const {
    return pitch_motion(theta, y, signs).stroke;
  }

  CycleExtremes<S> candidates(const Motion<S>& m, const State& y, const Signs& signs) const {
    return extreme_candidates(m, y[0], branch(signs));
  }

  template <bool quadratures>
  solver::Rates<PitchCrankSystem> rates(const S& theta, const State& y, const Signs& signs) const {
    const PitchMotion<S> m = pitch_motion(theta, y, signs);
    const S per_omega = S(1.0) / y[0];
    const bool at_stop = pitch_stops::is_held<PitchCrankSystem>(signs);
    solver::Rates<PitchCrankSystem> r;
    r.dy[0] = m.stroke.crank_acceleration * per_omega;
    r.dy[1] = at_stop ? S(0.0) : S(y[2] * per_omega);
    r.dy[2] = m.acceleration * per_omega;
    if constexpr (N == 4) r.dy[3] = m.stroke.inductive_voltage / vehicle.motor.armature_inductance * per_omega;
    r.switches[force] = m.stroke.force_switch;
    r.switches[gear] = has_gear_loss(vehicle.motor) ? m.stroke.gear_torque : S(1.0);
    r.switches[turn] = at_stop ? signs[turn] : y[2];
    r.switches[stop] = pitch_stops::switch_of(*this, m, y, signs);
    r.switches[stored] = m.stroke.stored_moment;
    if constexpr (quadratures) {
      const CycleIntegrals<S> in_time = integrands(m.stroke, y[0], branch(signs));
      for (std::size_t q = 0; q < in_time.size(); ++q) r.dq[q] = in_time[q] * per_omega;
      r.dq[hinge_work] = m.hinge_loss * per_omega;
      r.dq[chordwise] = m.chordwise_lift * per_omega;
    }
    return r;
  }
};

}  // namespace wingbeat

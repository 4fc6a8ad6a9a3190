// A direct drive whose wings pitch on a hinge, as a periodic system in the phase of its supply (model.md sections 6,
// 12).
#pragma once

#include <array>
#include <cmath>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/pitch_stops.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// States stroke angle beta, its velocity, pitch angle psi, its velocity and, with inductance (N = 5), current i;
/// independent variable the phase of the supply, v = V sin phi, from 0 to 2 pi.
/// Of a vehicle without constant friction.
template <Scalar S, int N>
struct PitchDirectSystem {
  using Real = S;
  using State = std::array<S, N>;
  static constexpr std::size_t shaft = 1, pitch = 2;
  /// Behind the integrals that all vehicles have: loss in the hinges [J]; chordwise_lift() [N s].
  static constexpr std::size_t hinge_work = integral_count, chordwise = integral_count + 1;
  using Quadrature = std::array<S, integral_count + 2>;
  /// Signs, those of switches first: stroke velocity, pitch velocity, stop, stored moment; those of pitch_stops.
  enum Sign { velocity, turn, stop, stored, held, impacts };
  using Switches = std::array<S, 4>;
  static constexpr int state_switches = 3;  ///< the stored moment causes no kink in the solution
  using Signs = std::array<S, 6>;
  static constexpr bool contracts_slowly = true;
  static constexpr bool state_jumps = true;
  static constexpr bool has_rod = false;
  /// Integrals whose error limits the steps.
  static constexpr std::array<std::size_t, 7> controlled_integrals = {std::size_t(Integral::current_square),
                                                                      std::size_t(Integral::speed_square),
                                                                      std::size_t(Integral::friction_work),
                                                                      std::size_t(Integral::aero_work),
                                                                      std::size_t(Integral::reactive_work),
                                                                      std::size_t(Integral::lift),
                                                                      hinge_work};

  /// What has an extreme that is a metric; those of the pitching are in PitchMetrics.
  static constexpr std::array extremes = {Extreme::current, Extreme::lift, Extreme::flapping_velocity,
                                          Extreme::stroke_max, Extreme::stroke_min};

  Vehicle<S> vehicle;
  State typical;  ///< size of each state, scale of errors

  template <Scalar T>
  PitchDirectSystem<T, N> cast() const {
    PitchDirectSystem<T, N> system{wingbeat::cast<T>(vehicle), {}};
    for (std::size_t n = 0; n < N; ++n) system.typical[n] = T(typical[n]);
    return system;
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

  /// Angular frequency of the supply [rad/s]: d phi / dt.
  S phase_rate() const { return S(two_pi) * vehicle.drive_frequency; }
  S phase_rate(const State&) const { return phase_rate(); }
  static const S& shaft_speed(const State& y) { return y[1]; }
  static const S& shaft_angle(const S&, const State& y) { return y[0]; }
  S voltage(const S& phi) const {
    using std::sin;
    return vehicle.voltage * sin(phi);
  }
  S current(const S& phi, const State& y) const {
    if constexpr (N == 5) {
      return y[4];
    } else {
      return algebraic_current(vehicle, voltage(phi), y[1]);
    }
  }

  static CrankKinematics<S> kinematics(const S&) { return direct_kinematics<S>(); }
  static const S& stroke_angle(const S&, const State& y) { return y[0]; }
  static const S& stroke_angle(const Motion<S>&, const State& y) { return y[0]; }
  static S stroke_sign(const Signs& signs) { return signs[velocity]; }

  bool jumps(std::size_t k) const { return k == stop && has_stop(vehicle.pitch.hinge); }
  Signs start_signs(const State& y) const {
    Signs signs;
    signs.fill(S(1.0));
    signs[velocity] = sign_of(y[1]);
    if (pitch_stops::rests_at_stop(*this, y)) pitch_stops::hold_or_leave(*this, S(0.0), y, signs);
    return signs;
  }
  void event_transition(std::size_t k, const S& phi, State& y, Signs& signs, Quadrature* totals) const {
    if (jumps(k)) pitch_stops::event_transition(*this, phi, y, signs, totals);
    else signs[k] = -signs[k];
  }
  template <bool quadratures>
  void reset_map(const S& phi, State& y, const Signs& from, const Signs& to, Quadrature* totals) const {
    pitch_stops::reset_map<quadratures>(*this, phi, y, from, to, totals);
  }

  static Branch<S> branch(const Signs& signs) {
    return {signs[velocity], S(1.0), signs[velocity], signs[stored] * signs[velocity]};
  }

  PitchMotion<S> pitch_motion(const S& phi, const State& y, const Signs& signs) const {
    const S N_k_beta = vehicle.wing_count * vehicle.spring.stiffness * y[0];
    const S psi_rate = select(signs[held] >= S(0.0), y[3], S(0.0));
    return pitch_motion_on(vehicle, vehicle.pitch, kinematics(phi), N_k_beta, y[1], current(phi, y), voltage(phi), y[2],
                           psi_rate, branch(signs), PitchBranch<S>{signs[turn], signs[held]});
  }

  Motion<S> motion(const S& phi, const State& y, const Signs& signs) const {
    return pitch_motion(phi, y, signs).stroke;
  }

  CycleExtremes<S> candidates(const Motion<S>& m, const State& y, const Signs& signs) const {
    return extreme_candidates(m, m.stroke_velocity, branch(signs), y[0]);
  }

  template <bool quadratures>
  solver::Rates<PitchDirectSystem> rates(const S& phi, const State& y, const Signs& signs) const {
    const PitchMotion<S> m = pitch_motion(phi, y, signs);
    const S per_phase_rate = S(1.0) / phase_rate();
    const bool at_stop = pitch_stops::is_held<PitchDirectSystem>(signs);
    solver::Rates<PitchDirectSystem> r;
    r.dy[0] = m.stroke.stroke_velocity * per_phase_rate;
    r.dy[1] = m.stroke.crank_acceleration * per_phase_rate;
    r.dy[2] = at_stop ? S(0.0) : S(y[3] * per_phase_rate);
    r.dy[3] = m.acceleration * per_phase_rate;
    if constexpr (N == 5) {
      r.dy[4] = m.stroke.inductive_voltage / vehicle.motor.armature_inductance * per_phase_rate;
    }
    r.switches[velocity] = y[1];
    r.switches[turn] = at_stop ? signs[turn] : y[3];
    r.switches[stop] = pitch_stops::switch_of(*this, m, y, signs);
    r.switches[stored] = m.stroke.stored_moment;
    if constexpr (quadratures) {
      const CycleIntegrals<S> in_time = integrands(m.stroke, m.stroke.stroke_velocity, branch(signs));
      for (std::size_t q = 0; q < in_time.size(); ++q) r.dq[q] = in_time[q] * per_phase_rate;
      r.dq[hinge_work] = m.hinge_loss * per_phase_rate;
      r.dq[chordwise] = m.chordwise_lift * per_phase_rate;
    }
    return r;
  }
};

}  // namespace wingbeat

// Half a cycle of the crank as a system for solve/, on SIMD lanes.
#pragma once

#include <array>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/pack.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/explicit_step.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Integrals over the cycle. The others follow: the supply's work from the current, the motor's from what it drives,
/// the reactive work from the extremes of the stored energy.
inline constexpr std::array pack_integrals = {
    Integral::time,          Integral::current,       Integral::current_square,
    Integral::speed_square,  Integral::friction_work, Integral::aero_work,
    Integral::residual_work, Integral::lift,          Integral::rod_force};

/// Where an integral stands among pack_integrals.
constexpr std::size_t pack_integral(Integral which) {
  std::size_t index = 0;
  while (pack_integrals[index] != which) ++index;
  return index;
}

/// The crank over half a cycle as a system for solve/: the independent variable u runs from -pi/2 to pi/2.
template <Scalar S, int N>
struct HalfCycle {
  using Real = S;
  using State = std::array<S, N>;
  using Quadrature = std::array<S, pack_integrals.size()>;
  using Switches = std::array<S, 1>;  ///< force_switch
  static constexpr std::array<std::size_t, 4> controlled_integrals = {
      pack_integral(Integral::time), pack_integral(Integral::friction_work), pack_integral(Integral::aero_work),
      pack_integral(Integral::lift)};

  const Vehicle<S>& vehicle;
  CrankGeometry<S> geometry;
  S per_inductance;    ///< 1 / L_a [1/H]
  S per_resistance;    ///< 1 / (R_a + R_i) [1/ohm]
  S half;              ///< +1: crank angle u, stroke upward; -1: crank angle pi + u, stroke downward
  bool has_every_law;  ///< whether added mass, coefficient tables or stops of the pitching count: see aero_loads()
  S inductive_drop = S(0.0);  ///< N = 1: L_a di/dt [V], which a small inductance takes from the voltage
  S pitching = S(1.0);        ///< as in Mode

  S current(const State& y) const {
    if constexpr (N == 2) {
      return y[1];
    } else {
      return (vehicle.voltage - inductive_drop - vehicle.motor.torque_constant * y[0]) * per_resistance;
    }
  }

  Configuration<S> configuration(const S& u) const {
    const SineCosine<S> of_u = sine_cosine_of_reduced(u);
    return configuration_of(crank_kinematics(geometry, S(half * of_u.sine), S(half * of_u.cosine)));
  }
  Configuration<S> configuration_of(const CrankKinematics<S>& k) const { return {k, spring_moment(vehicle, k)}; }

  Mode<S> mode(const S& force) const { return {half, force, S(1.0), S(1.0), pitching}; }

  /// pitch_margin() of the wings [rad].
  S pitch_margin_at(const Configuration<S>& configuration, const State& y) const {
    return pitch_margin(vehicle.wings, S(half * configuration.kinematics.stroke_slope * y[0]));
  }

  [[gnu::always_inline]] Motion<S> motion(const Configuration<S>& configuration, const State& y, const S& force) const {
    return has_every_law ? motion_by_every_law(configuration, y, force) : motion_of<false>(configuration, y, force);
  }

  /// The branch that holds is chosen on the spot.
  [[gnu::always_inline]] Motion<S> motion_on_its_branch(const Configuration<S>& configuration, const State& y) const {
    const S i = current(y);
    const S v_t = terminal_voltage(vehicle, vehicle.voltage, i);
    const IntermediateTerms<S> terms =
        has_every_law ? terms_by_every_law(configuration, y, i, v_t, sign_of(pitch_margin_at(configuration, y)))
                      : terms_of<false>(configuration, y, i, v_t, S(1.0));
    return motion_on(vehicle, terms, mode(sign_of(terms.force_switch)));
  }

  template <bool every_law>
  [[gnu::always_inline]] IntermediateTerms<S> terms_of(const Configuration<S>& configuration, const State& y,
                                                       const S& i, const S& v_t, const S& on_pitching) const {
    return terms_at<every_law>(vehicle, MotionState<S>{configuration, y[0], i, v_t},
                               Mode<S>{half, S(1.0), S(1.0), S(1.0), on_pitching});
  }
  template <bool every_law>
  [[gnu::always_inline]] Motion<S> motion_of(const Configuration<S>& configuration, const State& y,
                                             const S& force) const {
    const S i = current(y);
    const S v_t = terminal_voltage(vehicle, vehicle.voltage, i);
    return motion_on(vehicle, terms_of<every_law>(configuration, y, i, v_t, pitching), mode(force));
  }

  // Out of the way of vehicles without: a call in the midst of an evaluation costs registers.
  [[gnu::noinline]] IntermediateTerms<S> terms_by_every_law(const Configuration<S>& configuration, const State& y,
                                                            const S& i, const S& v_t, const S& on_pitching) const {
    return terms_of<true>(configuration, y, i, v_t, on_pitching);
  }
  [[gnu::noinline]] Motion<S> motion_by_every_law(const Configuration<S>& configuration, const State& y,
                                                  const S& force) const {
    return motion_of<true>(configuration, y, force);
  }

  template <bool quadratures>
  solver::Rates<HalfCycle> rates_of(const Motion<S>& m, const State& y, const S& force) const {
    const S per_omega = inverse_of(y[0]);
    solver::Rates<HalfCycle> r;
    r.dy[0] = m.crank_acceleration * per_omega;
    if constexpr (N == 2) r.dy[1] = m.inductive_voltage * per_inductance * per_omega;
    r.switches[0] = m.force_switch;
    if constexpr (quadratures) {
      const CycleIntegrals<S> in_time = integrands(m, y[0], mode(force));
      for (std::size_t q = 0; q < pack_integrals.size(); ++q) {
        r.dq[q] = in_time[std::size_t(pack_integrals[q])] * per_omega;
      }
    }
    return r;
  }
};

// A cycle's code must stay within the processor's instruction cache: the right-hand side is one function.
template <bool quadratures, bool every_law, class System>
[[gnu::noinline, gnu::flatten]] void evaluate_of(const System& system,
                                                 const Configuration<typename System::Real>& configuration,
                                                 const typename System::State& y, const typename System::Real& force,
                                                 solver::Rates<System>& out) {
  out = system.template rates_of<quadratures>(system.template motion_of<every_law>(configuration, y, force), y, force);
}

template <bool quadratures, class System>
[[gnu::always_inline]] inline void evaluate(const System& system,
                                            const Configuration<typename System::Real>& configuration,
                                            const typename System::State& y, const typename System::Real& force,
                                            solver::Rates<System>& out) {
  if (system.has_every_law) return evaluate_of<quadratures, true>(system, configuration, y, force, out);
  evaluate_of<quadratures, false>(system, configuration, y, force, out);
}

}  // namespace wingbeat

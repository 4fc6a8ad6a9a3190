// Half a cycle of the crank as a system for solve/, on SIMD lanes.
#pragma once

#include <array>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/pack.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/ensemble/lane_mechanism.hpp"
#include "wingbeat/solve/explicit_step.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Integrals over the cycle. The others follow: the supply's work from the current, the motor's from what it drives,
/// the reactive work from the extremes of the stored energy.
inline constexpr std::array pack_integrals = {
    Integral::time,          Integral::current,   Integral::current_square, Integral::speed_square,
    Integral::friction_work, Integral::aero_work, Integral::residual_work,  Integral::lift,
    Integral::rod_force,     Integral::gear_work};

/// Where an integral stands among pack_integrals.
constexpr std::size_t pack_integral(Integral which) {
  std::size_t index = 0;
  while (pack_integrals[index] != which) ++index;
  return index;
}

/// The crank over half a cycle, one stroke from reversal to reversal, as a system for solve/: the independent variable
/// u is the crank angle from the middle of the stroke.
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
  const LaneMechanism<S>& mechanism;
  S per_inductance;           ///< 1 / L_a [1/H]
  S per_resistance;           ///< 1 / (R_a + R_i) [1/ohm]
  S half;                     ///< sign of the stroke velocity: +1 of the upward stroke, -1 of the downward one
  S middle;                   ///< crank angle where u = 0 [rad]; of slider-cranks 0 upward, pi downward
  bool has_every_law;         ///< whether gear losses, added mass, coefficient tables or stops of the pitching count
  S inductive_drop = S(0.0);  ///< N = 1: L_a di/dt [V], which a small inductance takes from the voltage
  S pitching = S(1.0);        ///< as in Mode
  S gear = S(1.0);            ///< as in Mode

  S current(const State& y) const {
    if constexpr (N == 2) {
      return y[1];
    } else {
      return (vehicle.voltage - inductive_drop - vehicle.motor.torque_constant * y[0]) * per_resistance;
    }
  }

  Configuration<S> configuration(const S& u) const {
    if (!mechanism.is_slider_crank) return configuration_of(mechanism.kinematics_of_others(S(middle + u)));
    const SineCosine<S> of_u = sine_cosine_of_reduced(u);
    return configuration_of(crank_kinematics(mechanism.slider, S(half * of_u.sine), S(half * of_u.cosine)));
  }
  Configuration<S> configuration_of(const CrankKinematics<S>& k) const { return {k, spring_moment(vehicle, k)}; }

  Mode<S> mode(const S& force) const { return {half, force, S(1.0), S(1.0), pitching, gear}; }

  /// pitch_margin() of the wings [rad].
  S pitch_margin_at(const Configuration<S>& configuration, const State& y) const {
    return pitch_margin(vehicle.wings, S(half * configuration.kinematics.stroke_slope * y[0]));
  }

  [[gnu::always_inline]] Motion<S> motion(const Configuration<S>& configuration, const State& y, const S& force) const {
    return has_every_law ? motion_by_every_law(configuration, y, force) : motion_of<false>(configuration, y, force);
  }

  /// What changes sign where the equations have a kink beside that of the rod force: pitch_margin_at() or, where a
  /// gearbox loses torque, that torque. Without friction but that of the rod force it is F (h + s mu r_e) behind the
  /// gearbox: its sign changes with that of F, where there is a kink already, while |h| > mu r_e, and is positive
  /// elsewhere. What changes sign then is |h| - mu r_e, a little more of it lest it does so at the dead centres.
  [[gnu::noinline]] S kink_margin_at(const Configuration<S>& configuration, const State& y, const S& force) const {
    if (!has_gear_loss(vehicle.motor)) return pitch_margin_at(configuration, y);
    if (has_load_free_friction()) return motion_by_every_law(configuration, y, force).gear_torque;
    return half * configuration.kinematics.crank_jacobian - vehicle.friction.radius +
           S(1e-9) * typical_crank_lever(vehicle.transmission);
  }
  bool has_load_free_friction() const { return any<S>(load_free_friction(vehicle.friction, S(1.0), S(1.0)) > S(0.0)); }
  /// Takes the side of the kink on which kink_margin_at() has the sign `side`, the rod force that of `force`.
  void choose_side(const S& side, const S& force) {
    if (!has_gear_loss(vehicle.motor)) pitching = side;
    else if (has_load_free_friction()) gear = side;
    else gear = select<S>(side > S(0.0), force * half, S(1.0));
  }

  /// What the state's rates follow from, on the branch that holds, which is chosen on the spot.
  struct Accelerations {
    S crank;              ///< omega' [rad/s2]
    S inductive_voltage;  ///< L_a di/dt [V]
    S force_switch;       ///< as in Motion
  };
  [[gnu::always_inline]] Accelerations accelerations(const Configuration<S>& configuration, const State& y) const {
    if (has_every_law) return accelerations_by_every_law(configuration, y);
    const MotionStateView<S> instant = motion_state(configuration, y);
    const IntermediateTerms<S> terms = terms_at<false>(vehicle, instant, mode(S(1.0)));
    return accelerations_of(motion_on<false>(vehicle, instant, terms, mode(sign_of(terms.force_switch))));
  }
  static Accelerations accelerations_of(const Motion<S>& m) {
    return {m.crank_acceleration, m.inductive_voltage, m.force_switch};
  }
  /// The rates by crank angle.
  State slope(const Accelerations& a, const S& per_omega) const {
    State dy;
    dy[0] = a.crank * per_omega;
    if constexpr (N == 2) dy[1] = a.inductive_voltage * per_inductance * per_omega;
    return dy;
  }

  [[gnu::always_inline]] MotionStateView<S> motion_state(const Configuration<S>& configuration, const State& y) const {
    const S i = current(y);
    return {configuration, y[0], i, terminal_voltage(vehicle, vehicle.voltage, i)};
  }
  template <bool every_law>
  [[gnu::always_inline]] Motion<S> motion_of(const Configuration<S>& configuration, const State& y,
                                             const S& force) const {
    const MotionStateView<S> instant = motion_state(configuration, y);
    return motion_on<every_law>(vehicle, instant, terms_at<every_law>(vehicle, instant, mode(S(1.0))), mode(force));
  }

  // Out of the way of vehicles without: a call in the midst of an evaluation costs registers.
  [[gnu::noinline]] Accelerations accelerations_by_every_law(const Configuration<S>& configuration,
                                                             const State& y) const {
    HalfCycle branch = *this;
    branch.pitching = sign_of(pitch_margin_at(configuration, y));
    const MotionStateView<S> instant = motion_state(configuration, y);
    const auto motion = [&] {
      const IntermediateTerms<S> terms = terms_at<true>(vehicle, instant, branch.mode(S(1.0)));
      return motion_on<true>(vehicle, instant, terms, branch.mode(sign_of(terms.force_switch)));
    };
    branch.gear = S(1.0);
    Motion<S> m = motion();
    if (has_gear_loss(vehicle.motor)) {
      // As mode_at(): on one of its branches the torque on the gearbox has the sign of the branch.
      branch.gear = sign_of(m.gear_torque);
      m = motion();
    }
    return accelerations_of(m);
  }
  [[gnu::noinline]] Motion<S> motion_by_every_law(const Configuration<S>& configuration, const State& y,
                                                  const S& force) const {
    return motion_of<true>(configuration, y, force);
  }

  template <bool quadratures>
  solver::Rates<HalfCycle> rates_of(const Motion<S>& m, const State& y, const S& force) const {
    const S per_omega = inverse_of(y[0]);
    solver::Rates<HalfCycle> r;
    r.dy = slope(accelerations_of(m), per_omega);
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

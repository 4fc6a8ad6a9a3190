// Half a lap of the crank as a system for solve/, and a step of it, on SIMD lanes.
#pragma once

#include <array>

#include "wingbeat/core/lanes.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/explicit_step.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// Integrals of the fine lap. The others follow: the supply's work from the current, the motor's from what it drives,
/// the reactive work from the extremes of the stored energy.
inline constexpr std::array lane_integrals = {Integral::time,          Integral::current,   Integral::current_square,
                                              Integral::speed_square,  Integral::friction_work, Integral::aero_work,
                                              Integral::residual_work, Integral::lift,      Integral::rod_force};

/// Where an integral stands among lane_integrals.
constexpr std::size_t lane_integral(Integral which) {
  std::size_t at = 0;
  while (lane_integrals[at] != which) ++at;
  return at;
}

/// All that depends on the crank angle alone.
template <Scalar S>
struct Place {
  CrankKinematics<S> kinematics;
  S spring_moment;  ///< N_w k beta [N m]
};

/// The crank over half a lap as a system for solve/: the independent variable u runs from -pi/2 to pi/2.
template <Scalar S, int N>
struct HalfLap {
  using Real = S;
  using State = std::array<S, N>;
  using Quadrature = std::array<S, lane_integrals.size()>;
  using Switches = std::array<S, 2>;  ///< force_switch, stored moment along the stroke
  static constexpr std::array<std::size_t, 4> controlled_integrals = {
      lane_integral(Integral::time), lane_integral(Integral::friction_work), lane_integral(Integral::aero_work),
      lane_integral(Integral::lift)};

  const Vehicle<S>& vehicle;
  CrankGeometry<S> geometry;
  S per_inductance;  ///< 1 / L_a [1/H]
  S half;            ///< +1: crank angle u, stroke upward; -1: crank angle pi + u, stroke downward

  S current(const State& y) const {
    if constexpr (N == 2) {
      return y[1];
    } else {
      return algebraic_current(vehicle, vehicle.voltage, y[0]);
    }
  }

  Place<S> place(const S& u) const {
    const SineCosine<S> of = sine_cosine_of_reduced(u);
    return place_of(crank_kinematics(geometry, S(half * of.sine), S(half * of.cosine)));
  }
  Place<S> place_of(const CrankKinematics<S>& k) const { return {k, spring_moment(vehicle, k)}; }

  Branch<S> branch(const S& force) const { return {half, force, S(1.0), S(1.0)}; }

  Motion<S> motion(const Place<S>& place, const State& y, const S& force) const {
    const S i = current(y);
    const S v_t = terminal_voltage(vehicle, vehicle.voltage, i);
    const Instant<S> at = instant_at(vehicle, place.kinematics, place.spring_moment, y[0], i, v_t, half, S(1.0));
    return motion_on(vehicle, at, i, v_t, branch(force));
  }

  /// The branch that holds is chosen on the spot.
  Motion<S> motion_on_its_branch(const Place<S>& place, const State& y) const {
    const S i = current(y);
    const S v_t = terminal_voltage(vehicle, vehicle.voltage, i);
    const Instant<S> at = instant_at(vehicle, place.kinematics, place.spring_moment, y[0], i, v_t, half, S(1.0));
    return motion_on(vehicle, at, i, v_t, branch(sign_of(at.force_switch)));
  }

  template <bool quadratures>
  solve::Rates<HalfLap> rates_of(const Motion<S>& m, const State& y, const S& force) const {
    const S per_omega = inverse_of(y[0]);
    solve::Rates<HalfLap> r;
    r.dy[0] = m.crank_acceleration * per_omega;
    if constexpr (N == 2) r.dy[1] = m.voltage_reserve * per_inductance * per_omega;
    r.switches[0] = m.force_switch;
    if constexpr (quadratures) {
      r.switches[1] = half * m.stored_moment;
      const CycleIntegrals<S> in_time = integrands(vehicle, m, y[0], branch(force));
      for (std::size_t q = 0; q < lane_integrals.size(); ++q) {
        r.dq[q] = in_time[std::size_t(lane_integrals[q])] * per_omega;
      }
    }
    return r;
  }
};

inline constexpr std::size_t late_stage = 10;  ///< its force is seen before the end of a step

// A lap's code must stay within the processor's instruction cache: the right-hand side is one function, called in a loop
// over the stages, where the scalar solver unrolls them.
template <bool quadratures, class System>
[[gnu::noinline, gnu::flatten]] void evaluate(const System& system, const Place<typename System::Real>& place,
                                              const typename System::State& y, const typename System::Real& force,
                                              solve::Rates<System>& out) {
  out = system.template rates_of<quadratures>(system.motion(place, y, force), y, force);
}

/// The places of a step's stages. Apart from the stages, which wait for each other while these do not.
template <class System>
[[gnu::noinline, gnu::flatten]] void find_places(const System& system, const typename System::Real& u,
                                                 const typename System::Real& h,
                                                 std::array<Place<typename System::Real>, solve::dop853::stages>& places) {
  using S = typename System::Real;
#pragma GCC unroll 1
  for (std::size_t stage = 1; stage < places.size(); ++stage) {
    places[stage] = system.place(S(u + S(solve::dop853::c[stage]) * h));
  }
}

/// What is seen inside a step beside its result.
template <class S>
struct StepSights {
  S late_force_switch;  ///< at 6/7 of the step
  S dip_at;             ///< fraction of the step at which the stored moment is least by its sign at the start
  Place<S> end;         ///< of the step
};

/// One step of Dormand and Prince's pair as solve::explicit_step takes it.
template <bool quadratures, class System>
[[gnu::noinline]] void lane_step(const System& system, const typename System::Real& u, const typename System::State& y,
                                 const typename System::Real& h, const typename System::Real& force,
                                 const solve::Rates<System>& first, solve::StepResult<System>& result,
                                 StepSights<typename System::Real>& sights) {
  using S = typename System::Real;
  constexpr std::size_t states = std::tuple_size_v<typename System::State>;
  namespace pair = solve::dop853;
  std::array<typename System::State, pair::stages> k;
  k[0] = first.dy;
  const auto add_integrands = [&](std::size_t stage, const typename System::Quadrature& dq) {
    if constexpr (quadratures) {
      const S weight(pair::b[stage]), third(pair::e3[stage]), fifth(pair::e5[stage]);
      for (std::size_t q = 0; q < dq.size(); ++q) result.dq[q] = result.dq[q] + weight * dq[q];
      for (const std::size_t q : System::controlled_integrals) {
        result.integral_error3[q] = result.integral_error3[q] + third * dq[q];
        result.integral_error5[q] = result.integral_error5[q] + fifth * dq[q];
      }
    }
  };
  if constexpr (quadratures) {
    result.dq.fill(S(0.0));
    for (const std::size_t q : System::controlled_integrals) result.integral_error3[q] = result.integral_error5[q] = S(0.0);
    add_integrands(0, first.dq);
  }
  result.lowest.fill(S(1e300));
  S trend;
  if constexpr (quadratures) trend = sign_of(first.switches[1]);
  solve::Rates<System> rates;
  std::array<Place<S>, pair::stages> places;
  find_places(system, u, h, places);
  sights.end = places[pair::stages - 1];
#pragma GCC unroll 1
  for (std::size_t stage = 1; stage < std::size_t(pair::stages); ++stage) {
    typename System::State sum;
    for (std::size_t n = 0; n < states; ++n) sum[n] = S(pair::a[stage][0]) * k[0][n];
#pragma GCC unroll 1
    for (std::size_t j = stage < 4 ? 1 : stage < 6 ? 2 : 3; j < stage; ++j) {
      const S a(pair::a[stage][j]);
      for (std::size_t n = 0; n < states; ++n) sum[n] = sum[n] + a * k[j][n];
    }
    typename System::State at;
    for (std::size_t n = 0; n < states; ++n) at[n] = y[n] + h * sum[n];
    if (quadratures && pair::b[stage] != 0.0) {
      evaluate<true>(system, places[stage], at, force, rates);
      add_integrands(stage, rates.dq);
    } else {
      evaluate<false>(system, places[stage], at, force, rates);
    }
    k[stage] = rates.dy;
    if (stage == late_stage) sights.late_force_switch = rates.switches[0];
    if constexpr (quadratures) {
      if (stage < 5) continue;
      // At the end of a step the force may be zero on purpose.
      if (stage <= late_stage) result.lowest[0] = min(result.lowest[0], rates.switches[0] * force);
      const S along = rates.switches[1] * trend;
      sights.dip_at = select<S>(along < result.lowest[1], S(pair::c[stage]), sights.dip_at);
      result.lowest[1] = min(result.lowest[1], along);
    }
  }
  for (std::size_t n = 0; n < states; ++n) {
    S sum(0.0), third(0.0), fifth(0.0);
    for (std::size_t j = 0; j < std::size_t(pair::stages); ++j) {
      sum = sum + S(pair::b[j]) * k[j][n];
      if constexpr (quadratures) {
        third = third + S(pair::e3[j]) * k[j][n];
        fifth = fifth + S(pair::e5[j]) * k[j][n];
      }
    }
    result.y[n] = y[n] + h * sum;
    result.error3[n] = h * third;
    result.error5[n] = h * fifth;
  }
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < result.dq.size(); ++q) result.dq[q] = h * result.dq[q];
    for (const std::size_t q : System::controlled_integrals) {
      result.integral_error3[q] = h * result.integral_error3[q];
      result.integral_error5[q] = h * result.integral_error5[q];
    }
  }
}

}  // namespace wingbeat

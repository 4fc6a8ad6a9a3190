// The physics of one instant and of one step as a list of numbers, for any scalar.
#pragma once

#include <array>

#include "wingbeat/cycle/crank_system.hpp"
#include "wingbeat/solve/explicit_step.hpp"

namespace wingbeat {

/// Where the physics is evaluated. `force` and `stored` are the assumed signs of the rod force and the stored power.
template <Scalar S>
struct Point {
  S sin_theta, cos_theta, omega, current, voltage, force, stored;
};

inline constexpr int instant_size = 21 + integral_count + extreme_count;

/// Motion, energies, integrands and extremes at one instant.
template <Scalar S>
std::array<S, instant_size> instant(const Vehicle<S>& v, const Point<S>& p) {
  const CrankKinematics<S> k = crank_kinematics(v.crank, p.sin_theta, p.cos_theta);
  const Branch<S> branch{sign_of<S>(k.stroke_slope * p.omega), p.force, sign_of(p.omega), p.stored};
  const Motion<S> m = motion_at(v, p.sin_theta, p.cos_theta, p.omega, p.current, p.voltage, branch);
  std::array<S, instant_size> out = {k.slider_height,
                                     stroke_angle(k),
                                     k.stroke_slope,
                                     k.stroke_curve,
                                     k.wing_lever,
                                     k.crank_lever,
                                     m.crank_acceleration,
                                     m.voltage_reserve,
                                     m.rod_force,
                                     m.force_switch,
                                     m.stroke_velocity,
                                     m.stroke_acceleration,
                                     m.aero_moment,
                                     m.friction_torque,
                                     m.motor_torque,
                                     m.stored_moment,
                                     stored_energy(v, k, p.omega, p.current),
                                     effective_inertia(v, k, p.force),
                                     stroke_amplitude(v.crank),
                                     no_load_speed(v),
                                     algebraic_current(v, p.voltage, p.omega)};
  const CycleIntegrals<S> q = integrands(v, m, p.omega, branch);
  const CycleExtremes<S> e = extreme_candidates(v, m, p.omega, branch);
  for (std::size_t n = 0; n < q.size(); ++n) out[21 + n] = q[n];
  for (std::size_t n = 0; n < e.size(); ++n) out[21 + q.size() + n] = e[n];
  return out;
}

/// Where the residual work stands among the outputs of instant(): a difference that is rounding alone for virtual work,
/// to be judged beside the motor work.
inline constexpr std::size_t residual_at = 21 + std::size_t(Integral::residual_work);
inline constexpr std::size_t motor_work_at = 21 + std::size_t(Integral::motor_work);

inline constexpr int step_size = 2 + integral_count;

template <int N, Scalar S>
std::array<S, step_size> crank_step_of(const Vehicle<S>& v, const S& theta, const std::array<S, N>& state, const S& h,
                                       const std::array<S, 3>& signs) {
  const CrankSystem<S, N> system{v, S(0.0), S(1.0)};
  const auto first = system.template rates<true>(theta, state, signs);
  const auto result = solve::explicit_step<true>(system, theta, state, h, signs, first);
  std::array<S, step_size> out;
  out[0] = result.y[0];
  out[1] = system.current(result.y);
  for (std::size_t n = 0; n < result.dq.size(); ++n) out[2 + n] = result.dq[n];
  return out;
}

/// One explicit step of the crank, integrals included, on a given smooth branch. Lanes are alike in having an inductance.
template <Scalar S>
std::array<S, step_size> crank_step(const Vehicle<S>& v, const S& theta, const std::array<S, 2>& state, const S& h,
                                    const std::array<S, 3>& signs) {
  if (any<S>(v.motor.armature_inductance > S(0.0))) return crank_step_of<2, S>(v, theta, state, h, signs);
  return crank_step_of<1, S>(v, theta, {state[0]}, h, signs);
}

}  // namespace wingbeat

// The physics of one instant and of one step as a list of numbers, for any scalar.
#pragma once

#include <array>

#include "wingbeat/cycle/cycle_system.hpp"
#include "wingbeat/solve/explicit_step.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Where the physics is evaluated. `force` and `stored` are the assumed signs of the rod force and the stored power.
template <Scalar S>
struct Point {
  S sin_theta, cos_theta, omega, current, voltage, force, stored;
};

inline constexpr int motion_size = 23;
inline constexpr int instant_size = motion_size + integral_count + extreme_count;

/// Motion, energies, integrands and extremes at one instant.
template <Scalar S>
std::array<S, instant_size> instant(const Vehicle<S>& v, const Point<S>& p) {
  const CrankKinematics<S> k = crank_kinematics(v.transmission, p.sin_theta, p.cos_theta);
  const Mode<S> mode{sign_of<S>(k.stroke_slope * p.omega), p.force, sign_of(p.omega), p.stored};
  const Motion<S> m =
      motion_at(v, MotionState<S>{configuration_at(v, p.sin_theta, p.cos_theta), p.omega, p.current, p.voltage}, mode);
  std::array<S, instant_size> out = {slider_height(v.transmission.slider_crank, p.sin_theta, p.cos_theta),
                                     stroke_angle(k),
                                     k.stroke_slope,
                                     k.stroke_second_derivative,
                                     k.wing_jacobian,
                                     k.crank_jacobian,
                                     m.crank_acceleration,
                                     m.inductive_voltage,
                                     m.rod_force,
                                     m.force_switch,
                                     m.stroke_velocity,
                                     m.stroke_acceleration,
                                     m.aero.moment,
                                     m.friction_torque,
                                     m.motor_torque,
                                     m.stored_moment,
                                     stored_energy(v, k, p.omega, p.current),
                                     effective_inertia(v, k, p.force),
                                     stroke_amplitude(v.transmission),
                                     no_load_speed(v),
                                     algebraic_current(v, p.voltage, p.omega),
                                     m.aero.angle_of_attack,
                                     m.aero.power};
  const CycleIntegrals<S> q = integrands(m, p.omega, mode);
  const CycleExtremes<S> e = extreme_candidates(m, p.omega, mode);
  for (std::size_t n = 0; n < q.size(); ++n) out[motion_size + n] = q[n];
  for (std::size_t n = 0; n < e.size(); ++n) out[motion_size + q.size() + n] = e[n];
  return out;
}

/// Where the residual work stands among the outputs of instant(): a difference that is rounding alone for virtual work,
/// to be assessed beside the motor work.
inline constexpr std::size_t residual_at = motion_size + std::size_t(Integral::residual_work);
inline constexpr std::size_t motor_work_at = motion_size + std::size_t(Integral::motor_work);

inline constexpr int step_size = 2 + integral_count;

/// One explicit step of the crank, integrals included, on a given smooth mode. Without inductance the current is none
/// of the states; `out` holds zero for it.
template <Scalar S>
std::array<S, step_size> crank_step(const Vehicle<S>& v, const S& theta, const std::array<S, 2>& state, const S& h,
                                    const typename CrankSystem<S, 2>::Signs& signs) {
  std::array<S, step_size> out;
  const auto take = [&](const auto& system, const auto& start) {
    const auto first = system.template rates<true>(theta, start, signs);
    const auto result = solver::explicit_step<true>(system, theta, start, h, signs, first);
    out[1] = S(0.0);
    for (std::size_t n = 0; n < start.size(); ++n) out[n] = result.y[n];
    for (std::size_t n = 0; n < result.dq.size(); ++n) out[2 + n] = result.dq[n];
  };
  if (value_of(v.motor.armature_inductance) > 0.0) {
    take(CrankSystem<S, 2>{v, {state[0], S(1.0)}}, state);
  } else {
    take(CrankSystem<S, 1>{v, {state[0]}}, std::array<S, 1>{state[0]});
  }
  return out;
}

}  // namespace wingbeat

// Where the mechanism can stand still or jam, from its geometry and statics alone; model.md section 2, "Not flapping".
// All of it holds of every crank angle: least values and intervals are found from bounds over ranges of the angle
// (core/certain.hpp), to 1e-8 rad.
#pragma once

#include <span>
#include <type_traits>
#include <vector>

#include "wingbeat/cycle/statics.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat {

/// Torque of the motor that stands [N m].
/// \f[
/// T_\mathrm{stall} = \frac{K v}{R_\mathrm{a} + R_\mathrm{i}}
/// \f]
template <template <Scalar> class V, Scalar S>
S stall_torque(const V<S>& v) {
  const S i = v.voltage / circuit_resistance(v);
  if constexpr (requires { v.electronics; }) return v.motor.torque_constant * current_within(v.electronics, i);
  else return v.motor.torque_constant * i;
}

/// The current [A] at a steady speed, as electronics let it flow.
template <template <Scalar> class V, Scalar S>
S steady_current(const V<S>& v, const S& omega) {
  const S i = algebraic_current(v, v.voltage, omega);
  if constexpr (requires { v.electronics; }) return current_within(v.electronics, i);
  else return i;
}

/// Torque that would start the crank forward from rest [N m], `torque` T being the motor's; behind a gearbox what the
/// motor's torque exceeds the upper standing torque by.
/// \f[
/// T - F_\mathrm{s} h - T_\mathrm{x} - \mu r_\mathrm{e} |F_\mathrm{s}| - T_\mathrm{c}
/// \f]
template <template <Scalar> class V, Scalar S>
S advance_torque(const V<S>& v, const CrankKinematics<S>& k, const S& N_k_beta, const S& torque) {
  const S F_s = static_rod_force(k, N_k_beta);
  if (has_gear_loss(v.motor)) return torque - standing_torques(v, k, F_s).high;
  return torque - F_s * k.crank_jacobian - v.load_torque - holding_torque(v, F_s);
}

/// >= 0 where friction holds a crank at rest under the motor's `torque` T [N m]. Behind a gearbox: what the motor's
/// torque lies within the standing torques by.
/// \f[
/// \mu r_\mathrm{e} |F_\mathrm{s}| + T_\mathrm{c} - |T - F_\mathrm{s} h - T_\mathrm{x}|
/// \f]
template <template <Scalar> class V, Scalar S>
S lock_margin(const V<S>& v, const CrankKinematics<S>& k, const S& N_k_beta, const S& torque) {
  using std::abs;
  using std::min;
  const S F_s = static_rod_force(k, N_k_beta);
  if (has_gear_loss(v.motor)) {
    const StandingTorques<S> torques = standing_torques(v, k, F_s);
    return min(S(torques.high - torque), S(torque - torques.low));
  }
  return holding_torque(v, F_s) - abs(S(torque - F_s * k.crank_jacobian - v.load_torque));
}

/// The least of \f$J + A (h + s \mu r_\mathrm{e})\f$ over both branches s [kg m2]; <= 0 jams.
template <template <Scalar> class V, Scalar S>
S min_inertia(const V<S>& v, const CrankKinematics<S>& k) {
  using std::min;
  return min(effective_inertia(v, k, S(1.0)), effective_inertia(v, k, S(-1.0)));
}

/// advance_torque() of the motor's stall torque at a crank angle [rad].
double advance_torque(const Vehicle<double>& vehicle, double crank_angle);

/// lock_margin() of the motor's stall torque at a crank angle [rad].
double lock_margin(const Vehicle<double>& vehicle, double crank_angle);

StaticBalance static_balance(const Vehicle<double>& vehicle);

/// All intervals in which the crank locks, in order of crank angle; empty unless static_balance().can_lock().
std::vector<LockInterval> lock_intervals(const Vehicle<double>& vehicle);

/// Whether links and springs alone, at less work than static_balance(), show that neither J + A (h + s mu r_e) nor the
/// lever g comes near zero, and that the advance torque does not.
bool certainly_unique(const Vehicle<double>& vehicle);
bool certainly_advances(const Vehicle<double>& vehicle);

/// The smaller of the lever g over its size and the least J + A (h + s mu r_e) over J: the equations of motion have one
/// solution while it is positive [1].
double uniqueness(const Vehicle<double>& vehicle, double crank_angle);

/// Crank angles nearest to `from` on either side at which uniqueness() falls to `margin` [rad], not wrapped; infinite
/// where it does so nowhere.
struct JamAngles {
  double below, above;
};
JamAngles nearest_jams(const Vehicle<double>& vehicle, double from, double margin);

/// A crank angle as the mean load of a cycle sees it.
template <Scalar S>
struct LoadPlace {
  S inertia;         ///< N_w J_w B2 [kg m2]
  S slope;           ///< |B1| [1]
  S stroke;          ///< sign of beta'
  S spring;          ///< N_w k beta [N m]
  S crank_jacobian;  ///< h [m]
  S per_wing_lever;  ///< 1 / g [1/m]
};

template <template <Scalar> class V, Scalar S>
LoadPlace<S> load_place(const V<S>& v, const CrankKinematics<S>& k, const S& N_k_beta) {
  using std::abs;
  return {v.wing_count * v.wing_inertia * k.stroke_second_derivative,
          abs(k.stroke_slope),
          sign_of(k.stroke_slope),
          N_k_beta,
          k.crank_jacobian,
          inverse_of(k.wing_jacobian)};
}

/// Motor torque less the mean load over evenly spaced places of a cycle at the constant crank speed omega [N m], a bar
/// being the mean over them and F the rod force at that speed:
/// \f[
/// e \left( K \frac{v - K \omega}{R_\mathrm{a} + R_\mathrm{i}} - b\, \omega - T_\mathrm{c,m} \right) - T_\mathrm{l}
/// - \overline{F h + \mu r_\mathrm{e} |F|} - T_\mathrm{x}, \qquad
/// F = \frac{N_\mathrm{w} J_\mathrm{w} B_2 \omega^2 + M_\mathrm{aero} + N_\mathrm{w} k \beta}{g}
/// \f]
template <template <Scalar> class V, Scalar S>
S torque_surplus(const V<S>& v, std::span<const LoadPlace<S>> places, const S& omega) {
  using std::abs;
  const bool every_law = has_further_laws(v.wings);
  S load(0.0);
  for (const LoadPlace<S>& p : places) {
    const S speed = p.slope * omega;
    const S drag =
        every_law ? moment_by_every_law(v.wings, speed) : aero_loads<false>(v.wings, speed, S(1.0), S(1.0)).moment;
    const S moment = p.inertia * square(omega) + p.stroke * drag + p.spring;
    const S F = moment * p.per_wing_lever;
    load = load + F * p.crank_jacobian + v.friction.radius * abs(F);
  }
  if (!places.empty()) load = load * S(1.0 / double(places.size()));
  const S motor =
      v.motor.torque_constant * steady_current(v, omega) - v.motor.viscous_damping * omega - v.motor.friction_torque;
  return gear_torque_ratio(v.motor, S(1.0)) * motor - load_free_friction(v.friction, omega, S(1.0)) - load -
         v.load_torque;
}

/// Crank speeds at which the motor's torque balances the mean load of a cycle at constant speed.
template <Scalar S>
struct BalancedSpeed {
  S slowest;  ///< first guess for the periodic orbit [rad/s]; the no-load speed where there is none
  S count;    ///< more than one, or nearly so, hints at several orbits; 0: the load stalls the motor
  S slope;    ///< of the surplus of torque by the speed there, about [N m s]
};

/// Angle that passive pitching can turn the wings by [rad], \f$C_\alpha |B_1| \omega\f$ at the largest stroke slope.
template <template <Scalar> class V, Scalar S>
S largest_pitch(const V<S>& v, std::span<const LoadPlace<S>> places, const S& omega) {
  using std::max;
  S steepest(0.0);
  for (const LoadPlace<S>& p : places) steepest = max(steepest, p.slope);
  return v.wings.pitch_coefficient * steepest * omega;
}

/// Balances between 2 % of the speed without load and that speed, on a grid, without springs from standstill on. A
/// surplus that is almost used up counts as a balance, too.
template <int speeds, template <Scalar> class V, Scalar S>
BalancedSpeed<S> balanced_on_grid(const V<S>& v, std::span<const LoadPlace<S>> places) {
  const S no_load = no_load_speed(v), near = S(0.1) * stall_torque(v);
  BalancedSpeed<S> balanced{no_load, S(0.0), S(0.0)};
  S before = S(0.02) * no_load, surplus_before = torque_surplus(v, places, before), surplus_earlier = surplus_before;
  auto found = S(0.0) > S(0.0);
  const auto note_balance = [&](const S& below, const S& surplus_below, const S& omega, const S& surplus) {
    const auto crossed = surplus_below > S(0.0) && surplus <= S(0.0);
    const S root = below + (omega - below) * surplus_below / (surplus_below - surplus);
    const auto first = crossed && !found;
    found = found || crossed;
    balanced.slowest = select<S>(first, root, balanced.slowest);
    balanced.slope = select<S>(first, (surplus - surplus_below) / (omega - below), balanced.slope);
    balanced.count = select<S>(crossed, balanced.count + S(1.0), balanced.count);
  };
  // What keeps a slow crank turning against springs is not their mean torque.
  const auto creeps = v.spring.stiffness == S(0.0) && surplus_before <= S(0.0);
  if (any<S>(creeps)) {
    const S from_standstill = select<S>(creeps, torque_surplus(v, places, S(0.0)), S(0.0));
    note_balance(S(0.0), from_standstill, before, surplus_before);
  }
  for (int n = 1; n <= speeds; ++n) {
    const S omega = no_load * S(double(n) / speeds), surplus = torque_surplus(v, places, omega);
    note_balance(before, surplus_before, omega, surplus);
    if (n > 1) {
      const auto touches = surplus_before > S(0.0) && surplus_before < near && surplus_before < surplus_earlier &&
                           surplus_before < surplus;
      balanced.count = select<S>(touches, balanced.count + S(1.0), balanced.count);
    }
    surplus_earlier = surplus_before;
    before = omega;
    surplus_before = surplus;
  }
  return balanced;
}

/// largest_pitch() at the speed without load beyond which balances are sought on a fine grid [rad].
inline constexpr double far_pitch = 1.2;

template <template <Scalar> class V, Scalar S>
BalancedSpeed<S> balanced_speed(const V<S>& v, std::span<const LoadPlace<std::type_identity_t<S>>> places) {
  // The drag coefficient is a wave in the angle of attack: over a long way of pitching the drag's torque has several
  // humps, and beyond a longer one no grid is fine enough.
  const S pitch = largest_pitch(v, places, no_load_speed(v));
  BalancedSpeed<S> balanced = balanced_on_grid<8>(v, places);
  const auto steep = pitch > S(far_pitch);
  if (any<S>(steep)) {
    const BalancedSpeed<S> finely = balanced_on_grid<40>(v, places);
    balanced.slowest = select<S>(steep, finely.slowest, balanced.slowest);
    balanced.slope = select<S>(steep, finely.slope, balanced.slope);
    balanced.count = select<S>(steep, finely.count, balanced.count);
    balanced.count = select<S>(pitch > S(20.0), balanced.count + S(1.0), balanced.count);
  }
  return balanced;
}

/// Share of a disturbance of the speed that the motor alone would take away in a time [s], wings swinging along.
template <template <Scalar> class V, Scalar S>
S free_return(const V<S>& v, const S& time) {
  using std::max;
  using std::sqrt;
  const Motor<S>& m = v.motor;
  const S R = circuit_resistance(v), L = m.armature_inductance, K = m.torque_constant;
  const S inertia = m.inertia + S(0.5) * v.wing_count * v.wing_inertia * square(typical_stroke_slope(v.transmission));
  // The slower eigenvalue of speed and current, times L/R to allow for none: s^2 L/R + s trace + determinant = 0.
  const S damping = m.viscous_damping + v.friction.damping;
  const S trace = S(1.0) + damping * L / (R * inertia), determinant = (damping + K * K / R) / inertia;
  const S root = sqrt(max(S(square(trace) - S(4.0) * determinant * L / R), S(0.0)));
  const S decay = S(2.0) * determinant / (trace + root);  // of a complex pair too fast by no more than a factor of 2
  const S x = decay * time;
  return x / (S(1.0) + x);
}

/// True where a multiplier is above 1, or so near that another orbit may be near: the load takes back almost all of
/// what the motor does against a disturbance. Such an orbit shows only in time whether start-up leads there.
template <template <Scalar> class V, Scalar S>
auto hardly_returns(const V<S>& v, const S& multiplier, const S& period) {
  return !(multiplier < S(0.8)) && !(S(1.0) - multiplier > S(0.1) * free_return(v, period));
}
BalancedSpeed<double> balanced_speed(const Vehicle<double>& vehicle);

/// Where the search for a rotating orbit begins: a cycle of the energy that it has at the balanced speed.
template <Scalar S>
struct OrbitGuess {
  BalancedSpeed<S> balanced;
  S crank_speed;    ///< where the cycle starts [rad/s]
  S earlier_speed;  ///< an electrical time constant before, which the current is still at [rad/s]
  S multiplier;     ///< what a cycle leaves of a small disturbance of the speed, by mean torques and inertia; 1 where
                    ///< nothing balances
};

/// `before(angle)` is the Configuration at an angle [rad] before the one that the cycle starts at.
template <template <Scalar> class V, Scalar S, class Before>
OrbitGuess<S> guess_orbit(const V<S>& v, std::span<const LoadPlace<std::type_identity_t<S>>> places,
                          const Before& before) {
  using std::exp;
  using std::max;
  using std::min;
  using std::sqrt;
  OrbitGuess<S> guess{balanced_speed(v, places), S(0.0), S(0.0), S(1.0)};
  const S balanced = guess.balanced.slowest;
  guess.crank_speed = guess.earlier_speed = balanced;
  if (places.empty()) return guess;
  const auto balances = guess.balanced.count > S(0.0);
  const S all_springs = v.wing_count * v.spring.stiffness;
  const S compliance = select<S>(all_springs > S(0.0), S(0.5) / max(all_springs, S(1e-300)), S(0.0));
  const auto inertia_of = [&](const S& slope) -> S {
    return v.motor.inertia + v.wing_count * v.wing_inertia * square(slope);
  };
  const auto elastic_of = [&](const S& moment) -> S { return compliance * square(moment); };
  S mean_inertia(0.0), mean_elastic(0.0);
  for (const LoadPlace<S>& p : places) {
    mean_inertia = mean_inertia + inertia_of(p.slope);
    mean_elastic = mean_elastic + elastic_of(p.spring);
  }
  const S per_place(1.0 / double(places.size()));
  mean_inertia = mean_inertia * per_place;
  mean_elastic = mean_elastic * per_place;
  const auto speed_before = [&](const S& angle) -> S {
    const Configuration<S> configuration = before(angle);
    const S kinetic =
        S(0.5) * mean_inertia * square(balanced) + (mean_elastic - elastic_of(configuration.spring_moment));
    // Strong springs may hold more energy than the cycle has.
    return sqrt(max(S(S(2.0) * kinetic / inertia_of(configuration.kinematics.stroke_slope)),
                    S(square(balanced * S(1.0 / 3.0)))));
  };
  const S lag = v.motor.armature_inductance / circuit_resistance(v);
  guess.crank_speed = select<S>(balances, speed_before(S(0.0)), balanced);
  guess.earlier_speed = select<S>(balances, speed_before(min(S(lag * balanced), S(1.0))), balanced);
  const S dwell(1.2);  // a crank spends more time where it is slow
  const S gain = dwell * S(two_pi) * guess.balanced.slope / (mean_inertia * balanced);
  guess.multiplier = select<S>(balances, exp(min(gain, S(0.0))), S(1.0));
  return guess;
}
OrbitGuess<double> guess_orbit(const Vehicle<double>& vehicle);

}  // namespace wingbeat

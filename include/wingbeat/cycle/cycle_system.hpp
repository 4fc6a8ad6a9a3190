// The dynamic model of a vehicle as a periodic system: what solve/ integrates. A crank's cycle is a turn, its variable
// the crank angle; a direct drive's is a period of its supply, its variable the phase of that. model.md sections 2, 6,
// 9, 12.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <type_traits>

#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/configurations.hpp"
#include "wingbeat/cycle/crank_turn.hpp"
#include "wingbeat/cycle/cycle_layout.hpp"
#include "wingbeat/cycle/electronics_events.hpp"
#include "wingbeat/cycle/energy_balance.hpp"
#include "wingbeat/cycle/event_crossing.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/cycle/pitch_bound.hpp"
#include "wingbeat/cycle/pitch_stops.hpp"
#include "wingbeat/cycle/shaft_rest.hpp"
#include "wingbeat/cycle/supply_period.hpp"
#include "wingbeat/solve/iterate.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat {

/// The system of vehicles of one kind. A crank's is valid while omega > 0. V: a Vehicle, or what has the same members
/// with another transmission. With the acceleration of motion_on(), and i following omega without inductance:
/// \f[
/// \frac{\mathrm{d}\omega}{\mathrm{d}\theta} = \frac{\dot\omega}{\omega}, \qquad
/// \frac{\mathrm{d}i}{\mathrm{d}\theta} = \frac{v - (R_\mathrm{a} + R_\mathrm{i})\, i - K \omega}{L_\mathrm{a} \omega},
/// \qquad f = \left( \int_0^{2\pi} \frac{\mathrm{d}\theta}{\omega} \right)^{-1}
/// \f]
/// Of a direct drive the same equations in the phase of the supply, \f$\dot\varphi = 2 \pi f\f$, with
/// \f$v = V \sin\varphi\f$. Friction that does not vanish with the speed, and a gearbox that loses torque, make its
/// right-hand side jump where the velocity changes sign, and hold the shaft at rest between two torques of the motor
/// (StandingTorques).
template <Scalar S, CycleFeatures features_, class V = Vehicle<S>>
struct CycleSystem : CycleLayout<features_>, std::conditional_t<features_.turns, CrankTurn<S>, SupplyPeriod<S>> {
  using Layout = CycleLayout<features_>;
  using Base = std::conditional_t<features_.turns, CrankTurn<S>, SupplyPeriod<S>>;
  using Real = S;
  using State = std::array<S, Layout::state_count>;
  using Quadrature = std::array<S, Layout::quadrature_count>;
  using Switches = std::array<S, Layout::switch_count>;
  using Signs = std::array<S, Layout::sign_count>;
  using MotionHere = std::conditional_t<features_.on_hinges, PitchMotion<S>, Motion<S>>;
  using Layout::general, Layout::features, Layout::tip, Layout::twist, Layout::local_turn, Layout::bridge;
  using Layout::limit, Layout::blocked, Layout::limited;
  using Layout::stored, Layout::stroke, Layout::slip, Layout::held, Layout::hinge_work, Layout::chordwise;
  using Layout::turns, Layout::on_hinges, Layout::inductive, Layout::shaft, Layout::current_state, Layout::pitch;
  using Layout::velocity, Layout::release, Layout::force, Layout::gear, Layout::pitching, Layout::turn, Layout::stop;

  V vehicle;
  State typical;                   ///< size of each state, scale of errors; that of a crank's speed is the speed itself
  S speed_floor = S(0.0);          ///< below this crank speed [rad/s] the crank counts as stopped
  bool jumps_at_velocity = false;  ///< of a direct drive: at its reversals something other than the drag changes

  CycleSystem() = default;
  CycleSystem(const V& v, const State& size, const S& floor = S(0.0)) : vehicle(v), typical(size), speed_floor(floor) {
    if constexpr (turns && std::same_as<S, double>) this->turn_at(reversals(v.transmission), stroke);
    if constexpr (!turns) jumps_at_velocity = jumps_at_rest(v);
  }

  template <Scalar T>
  auto cast() const {
    const auto of_t = wingbeat::cast<T>(vehicle);
    std::array<T, Layout::state_count> size;
    for (std::size_t n = 0; n < size.size(); ++n) size[n] = T(typical[n]);
    return CycleSystem<T, features, std::remove_const_t<decltype(of_t)>>{of_t, size, T(speed_floor)};
  }

  bool admissible(const State& y) const {
    if constexpr (turns) return all<S>(y[0] > speed_floor);
    return true;
  }
  State error_scale(const State& y) const {
    using std::abs;
    State scale;
    for (std::size_t n = 0; n < y.size(); ++n) scale[n] = abs(y[n]) + S(0.1) * typical[n];
    if constexpr (turns) scale[shaft] = y[shaft];
    return scale;
  }

  /// True where the current follows the speed so quickly, within a small part of a radian, that explicit steps would
  /// have to be shorter for it than their accuracy asks for.
  bool stiff(const State& y) const
    requires(std::same_as<S, double> && features_.turns && !features_.on_hinges && features_.inductive)
  {
    return circuit_resistance(vehicle) > 24.0 * vehicle.motor.armature_inductance * y[0];
  }

  /// How many times smaller than what limits their errors (`scale`) the integrals of a cycle are: metrics are to be
  /// accurate relative to themselves. A mean lift below a thousandth of its peak need not be.
  double cancellation(const Quadrature& totals, const Quadrature& scale) const
    requires(std::same_as<S, double> && features_.turns && !features_.on_hinges)
  {
    constexpr double usual = 2.0, max_cancellation = 1e3;
    double largest = 1.0;
    // Near its speed without load a motor's current is the small difference of two large voltages.
    const double charge = std::abs(totals[std::size_t(Integral::current)]);
    const double drop = circuit_resistance(vehicle) * charge, back_emf = two_pi * vehicle.motor.torque_constant;
    largest = std::max(largest, back_emf / (usual * drop + back_emf / max_cancellation));
    for (const std::size_t q : Layout::controlled_integrals) {
      if (scale[q] > 0.0)
        largest = std::max(largest, scale[q] / (usual * std::abs(totals[q]) + scale[q] / max_cancellation));
    }
    return largest;
  }

  /// What the integrals of a closed cycle show of their errors, relative.
  double imbalance(const Quadrature& totals) const
    requires(std::same_as<S, double> && !features_.on_hinges)
  {
    return relative_energy_gap(vehicle, totals);
  }

  /// The state of a vehicle of which everything is like this.
  static State state_of(const Coordinates<S>& c, [[maybe_unused]] const Vehicle<S>& v) {
    State y{};
    if constexpr (!turns) y[0] = c.angle;
    y[shaft] = c.speed;
    for_groups([&](StateGroup group, std::size_t place, const GroupState<S>& state) {
      if (!general || has_states(v, group)) y[place] = c.*state.number;
    });
    if constexpr (general && !turns) {
      if (is_compliant(v.piezo)) y[tip] = c.tip, y[tip + 1] = c.tip_velocity;
    }
    return y;
  }
  /// How everything is in a state; what the vehicle does not have is 0.
  Coordinates<S> coordinates(const S& x, const State& y) const {
    Coordinates<S> c;
    c.angle = turns ? x : y[0];
    c.speed = y[shaft];
    for_groups([&](StateGroup, std::size_t place, const GroupState<S>& state) { c.*state.number = y[place]; });
    if constexpr (general && !turns) c.tip = y[tip], c.tip_velocity = y[tip + 1];
    return c;
  }
  /// Pitch of the wings where it is reported [rad], of a state or its rate.
  static S local_pitch(const State& y)
    requires(features_.on_hinges)
  {
    if constexpr (general) return y[pitch] + S(reported_station) * y[twist];
    else return y[pitch];
  }

  /// Rate of the independent variable [rad/s].
  S phase_rate() const
    requires(!features_.turns)
  {
    return S(two_pi) * vehicle.drive_frequency;
  }
  S phase_rate(const State& y) const {
    if constexpr (turns) return y[0];
    else return S(two_pi) * vehicle.drive_frequency;
  }
  /// Of the supply [V].
  S voltage([[maybe_unused]] const S& x) const {
    using std::sin;
    if constexpr (turns) return vehicle.voltage;
    else return vehicle.voltage_offset + vehicle.voltage * sin(x);
  }
  /// Of the supply, with its rate in time.
  SupplyMoment<S> supply([[maybe_unused]] const S& x) const {
    using std::cos;
    if constexpr (turns) return {vehicle.voltage};
    else return {voltage(x), vehicle.voltage * cos(x) * phase_rate()};
  }
  S current([[maybe_unused]] const S& x, const State& y) const {
    if constexpr (general) return instant(x, y, start_signs_at(x, y)).current;
    else if constexpr (inductive) return y[current_state];
    else return algebraic_current(vehicle, voltage(x), y[shaft]);
  }

  using Base::stroke_angle;
  S stroke_angle(const S& x, const State& y) const {
    if constexpr (turns) return wingbeat::stroke_angle(configuration(x).kinematics);
    else return y[0];
  }
  /// Of beta'.
  [[gnu::always_inline]] static S stroke_sign(const auto& signs) { return signs[turns ? stroke : velocity]; }

  bool jumps([[maybe_unused]] std::size_t k) const {
    if constexpr (on_hinges) {
      if (k == stop) return has_stop(vehicle.pitch.hinge) || has_friction(vehicle.pitch.hinge);
      if (k == turn) return has_friction(vehicle.pitch.hinge);
    }
    if constexpr (general) {
      if (k == bridge || k == limit) return limits_current(vehicle.electronics) && has_current_state(vehicle);
      if (k == pitching) return jumps_at_pitch_stop(vehicle);
    }
    if constexpr (!turns) return jumps_at_velocity && k <= release;
    return false;
  }

  Signs start_signs(const State& y) const { return start_signs_at(S(0.0), y); }
  /// Of a cycle that starts at x.
  Signs start_signs_at([[maybe_unused]] const S& x, [[maybe_unused]] const State& y) const {
    Signs signs;
    signs.fill(S(1.0));
    if constexpr (turns) {
      signs[stroke] = S(this->first_stroke());
    } else if (on_hinges || jumps_at_velocity) {
      signs[velocity] = sign_of(y[shaft]);
      if (jumps_at_velocity && value_of(y[shaft]) == 0.0) shaft_rest::hold_or_move(*this, x, y, signs);
    }
    if constexpr (general) electronics_events::start(*this, x, y, signs), pitch_bound::start(*this, x, y, signs);
    if constexpr (on_hinges) {
      if (has_friction(vehicle.pitch.hinge)) signs[turn] = sign_of(y[pitch + 1]);
      if (is_clamped(vehicle.pitch.hinge)) signs[held] = S(-1.0);
      else if (pitch_stops::rests(*this, y)) pitch_stops::hold_or_leave(*this, x, y, signs);
    }
    return signs;
  }

  /// Switch k is crossed. A shaft that comes to rest is held or turns back; wings meet a stop or leave it.
  void event_transition(std::size_t k, const S& x, State& y, Signs& signs) const
    requires(!features_.turns && !features_.on_hinges)
  {
    if (jumps(k)) shaft_rest::event_transition(*this, k, x, y, signs);
    else signs[k] = -signs[k];
  }
  void event_transition(std::size_t k, const S& x, State& y, Signs& signs, Quadrature* totals) const
    requires(features_.on_hinges)
  {
    if (!jumps(k) || (general && k == pitching)) {
      signs[k] = -signs[k];
    } else if (k == stop || k == turn) {
      pitch_stops::event_transition(*this, k, x, y, signs, totals);
    } else {
      if constexpr (general) {
        if (k == bridge || k == limit) return electronics_events::event_transition(*this, k, y, signs);
      }
      if constexpr (!turns) shaft_rest::event_transition(*this, k, x, y, signs);
    }
  }

  /// A solution next to a recorded one that came to rest, or met a stop, at x: it does so a little earlier or later.
  template <bool quadratures>
  void reset_map(const S& x, State& y, const Signs& from, const Signs& to, Quadrature* totals) const
    requires(!features_.turns || features_.on_hinges)
  {
    reset_map_of<quadratures>(*this, x, y, from, to, totals);
  }
  /// That of a system that integrates more beside it.
  template <bool quadratures, class System>
  static void reset_map_of(const System& system, const S& x, State& y, const typename System::Signs& from,
                           const typename System::Signs& to, typename System::Quadrature* totals) {
    if constexpr (on_hinges) {
      pitch_stops::reset_map<quadratures>(system, x, y, from, to, totals);
      if (pitch_stops::has_impact<System>(from, to)) return;
    }
    if constexpr (general) {
      electronics_events::reset_map<quadratures>(system, x, y, from, to, totals);
      pitch_bound::reset_map<quadratures>(system, x, y, from, to, totals);
    }
    if constexpr (!turns) {
      if (!system.jumps_at_velocity) return;
      const bool stuck = value_of(to[slip]) < 0.0;
      const bool came_to_rest =
          value_of(from[slip]) > 0.0 && (stuck || value_of(from[velocity]) != value_of(to[velocity]));
      if (came_to_rest) detail::cross_at_zero<quadratures>(system, x, y, shaft, S(y[shaft]), from, to, totals);
      if (stuck) y[shaft] = S(0.0);
    }
  }

  /// The instant at which wings meet a stop; what drives does not matter to the impact.
  auto instant_before_impact(const S& x, const State& y, [[maybe_unused]] const auto& signs) const {
    if constexpr (general) {
      return instant(x, y, signs);
    } else {
      return MotionState<S>{{kinematics(x), S(0.0)}, y[shaft], S(0.0), S(0.0), y[pitch], y[pitch + 1]};
    }
  }
  /// After an impact of the wings: a shaft that it has brought to rest is held or turns back.
  void shaft_after_impact([[maybe_unused]] const S& x, [[maybe_unused]] const State& y,
                          [[maybe_unused]] Signs& signs) const {
    if constexpr (!turns) {
      if (jumps_at_velocity && value_of(y[shaft]) == 0.0) return shaft_rest::hold_or_move(*this, x, y, signs);
      signs[velocity] = sign_of(y[shaft]);
      signs[slip] = S(1.0);
    }
  }

  [[gnu::always_inline]] static Mode<S> mode(const auto& signs) {
    Mode<S> mode{.stroke = stroke_sign(signs),
                 .force = signs[force],
                 .direction = turns ? S(1.0) : signs[velocity],
                 .stored_power = signs[stored] * stroke_sign(signs),
                 .gear = signs[gear]};
    if constexpr (on_hinges) {
      mode.turn = signs[turn];
      mode.held = signs[held];
    }
    if constexpr (general) {
      // Of a current that is a state the limits hold it; another has kinks there.
      mode.bridge = value_of(signs[blocked]) < 0.0 ? signs[blocked] : signs[bridge];
      mode.limit = value_of(signs[limited]) < 0.0 ? signs[limited] : signs[limit];
    }
    if constexpr (general || !on_hinges) mode.pitching = signs[pitching];
    if constexpr (!turns) mode.slip = signs[slip];
    return mode;
  }

  CrankKinematics<S> kinematics([[maybe_unused]] const S& x) const {
    if constexpr (turns) return configuration(x).kinematics;
    else return direct_kinematics(vehicle.transmission.direct);
  }
  Configuration<S> configuration(const S& theta) const
    requires(features_.turns)
  {
    using std::cos;
    using std::sin;
    return configuration_at(vehicle, S(sin(theta)), S(cos(theta)));
  }
  template <std::size_t count>
  std::array<Configuration<S>, count> configurations(const S& theta, const S& h, const double (&c)[count]) const
    requires(features_.turns && !features_.general && std::same_as<S, double>)
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

  /// The instant of a crank in a configuration, or of a direct drive at a phase.
  template <class At>
  [[gnu::always_inline]] auto instant(const At& place, const State& y, [[maybe_unused]] const Signs& signs) const {
    if constexpr (general) return instant_at(vehicle, coordinates(place, y), supply(place), mode(signs));
    else return compact_instant(place, y, signs);
  }
  template <class At>
  [[gnu::always_inline]] auto compact_instant(const At& place, const State& y,
                                              [[maybe_unused]] const Signs& signs) const {
    if constexpr (turns) {
      const S i = current(S(0.0), y), v_t = terminal_voltage(vehicle, vehicle.voltage, i);
      if constexpr (!on_hinges) return MotionStateView<S>{place, y[shaft], i, v_t};
      else return MotionState<S>{place, y[shaft], i, v_t, y[pitch], pitch_velocity(y, signs)};
    } else {
      const Configuration<S> here{direct_kinematics(vehicle.transmission.direct),
                                  vehicle.wing_count * vehicle.spring.stiffness * (y[0] - vehicle.spring.rest_angle),
                                  y[0]};
      const S omega = value_of(signs[slip]) < 0.0 ? S(0.0) : y[shaft];
      const S i = current(place, y), v_t = terminal_voltage(vehicle, voltage(place), i);
      if constexpr (!on_hinges) return MotionState<S>{here, omega, i, v_t};
      else return MotionState<S>{here, omega, i, v_t, y[pitch], pitch_velocity(y, signs)};
    }
  }

  [[gnu::always_inline]] MotionHere motion(const Configuration<S>& place, const State& y, const Signs& signs) const
    requires(features_.turns && !features_.general)
  {
    return motion_of(instant(place, y, signs), mode(signs));
  }
  [[gnu::always_inline]] MotionHere motion(const S& x, const State& y, const Signs& signs) const {
    if constexpr (turns && !general) return motion(configuration(x), y, signs);
    else return motion_of(instant(x, y, signs), mode(signs));
  }

  CycleExtremes<S> candidates(const Motion<S>& m, const State& y, const Signs& signs) const {
    if constexpr (turns) return extreme_candidates(m, y[shaft], mode(signs));
    else return extreme_candidates(m, m.stroke_velocity, mode(signs), y[0]);
  }

  template <bool quadratures>
  solver::Rates<CycleSystem> rates(const S& x, const State& y, const Signs& signs) const {
    if constexpr (turns && !general) return rates<quadratures>(configuration(x), y, signs);
    else return rates_at<quadratures>(x, y, signs);
  }
  template <bool quadratures>
  solver::Rates<CycleSystem> rates(const Configuration<S>& place, const State& y, const Signs& signs) const
    requires(features_.turns && !features_.general)
  {
    return rates_at<quadratures>(place, y, signs);
  }

 private:
  /// Calls use(group, place, state) for each state beside the shaft's, but for a piezo's.
  template <class Use>
  [[gnu::always_inline]] static constexpr void for_groups(const Use& use) {
    const auto states_of = [&](StateGroup group) {
      for_states_of<S>(group, Layout::place(group),
                       [&](std::size_t place, const GroupState<S>& state) { use(group, place, state); });
    };
    if constexpr (inductive) states_of(StateGroup::current);
    if constexpr (on_hinges) states_of(StateGroup::pitch);
    if constexpr (general) {
      for (std::size_t k = std::size_t(StateGroup::twist); k < state_group_count; ++k) states_of(StateGroup(k));
    }
  }
  static S pitch_velocity(const State& y, const Signs& signs) {
    return select(signs[held] >= S(0.0), y[pitch + 1], S(0.0));
  }

  template <class Instant>
  [[gnu::always_inline]] MotionHere motion_of(const Instant& instant, const Mode<S>& mode) const {
    if constexpr (general) {
      return evaluate(vehicle, instant, mode);
    } else if constexpr (on_hinges) {
      return pitch_motion_at(vehicle, instant, mode);
    } else {
      Motion<S> m = motion_at(vehicle, instant, mode);
      if constexpr (!turns) {
        if (value_of(mode.slip) < 0.0) detail::stand_still(vehicle, S(0.0), m, instant.configuration.spring_moment);
      }
      return m;
    }
  }

  template <bool quadratures, class At>
  [[gnu::always_inline]] solver::Rates<CycleSystem> rates_at(const At& place, const State& y,
                                                             const Signs& signs) const {
    const MotionHere m = motion(place, y, signs);
    const S per_rate = S(1.0) / phase_rate(y);
    solver::Rates<CycleSystem> r;
    if constexpr (!turns) r.dy[0] = m.stroke_velocity * per_rate;
    r.dy[shaft] = m.crank_acceleration * per_rate;
    if constexpr (general) further_rates(place, y, signs, m, per_rate, r);
    else if constexpr (inductive)
      r.dy[current_state] = m.inductive_voltage / vehicle.motor.armature_inductance * per_rate;
    r.switches[force] = m.force_switch;
    r.switches[gear] = has_gear_loss(vehicle.motor) ? m.gear_torque : S(1.0);
    if constexpr (!turns) {
      const bool stuck = value_of(signs[slip]) < 0.0;
      r.switches[velocity] = stuck ? signs[velocity] : y[shaft];
      r.switches[release] = stuck ? shaft_rest::at_rest(*this, place, y, signs).margin() : S(1.0);
      if (!force_has_branches(vehicle)) r.switches[force] = S(1.0);
      if (stuck) r.switches[force] = signs[force], r.switches[gear] = signs[gear];
    }
    if constexpr (on_hinges) {
      const bool is_held = pitch_stops::is_held<CycleSystem>(signs);
      const bool hinged = !general || is_hinged(vehicle);
      if constexpr (!general) {
        r.dy[pitch] = is_held ? S(0.0) : S(y[pitch + 1] * per_rate);
        r.dy[pitch + 1] = m.pitch_acceleration * per_rate;
      }
      r.switches[turn] = is_held || !hinged ? signs[turn] : y[pitch + 1];
      r.switches[stop] = pitch_stops::switch_of(*this, m, y, signs);
    }
    if constexpr (!on_hinges) r.switches[pitching] = m.aero.pitch_margin;
    r.switches[stored] = m.stored_moment;
    if constexpr (quadratures) {
      const CycleIntegrals<S> in_time = integrands<S>(m, turns ? y[shaft] : m.stroke_velocity, mode(signs));
      for (std::size_t q = 0; q < in_time.size(); ++q) r.dq[q] = in_time[q] * per_rate;
      if constexpr (on_hinges) {
        r.dq[hinge_work] = m.hinge_loss * per_rate;
        r.dq[chordwise] = m.chordwise_lift * per_rate;
      }
    }
    return r;
  }

  /// Rates of what only vehicles of further kinds have; states that this one lacks fade away.
  void further_rates(const S& x, const State& y, const Signs& signs, const PitchMotion<S>& m, const S& per_rate,
                     solver::Rates<CycleSystem>& r) const {
    const Coordinates<S> here = coordinates(x, y), rates = rates_of(vehicle, here, instant(x, y, signs), m);
    for (std::size_t n = current_state; n < y.size(); ++n) r.dy[n] = -y[n];
    const auto take = [&](StateGroup group, std::size_t place, const GroupState<S>& state) {
      if (has_states(vehicle, group)) r.dy[place] = rates.*state.number * per_rate;
    };
    for_groups(take);
    if constexpr (!turns) {
      for_states_of<S>(StateGroup::tip, tip,
                       [&](std::size_t place, const GroupState<S>& state) { take(StateGroup::tip, place, state); });
    }
    if (!pitches(vehicle)) {
      r.switches[pitching] = m.aero.pitch_margin;
    } else {
      r.switches[pitching] = S(1.0);
    }
    r.switches[local_turn] = twists(vehicle.pitch.torsion) ? local_pitch_velocity(here) : S(1.0);
    r.switches[bridge] = electronics_events::bridge_switch(*this, x, y, signs);
    r.switches[limit] = electronics_events::limit_switch(*this, x, y, signs);
  }
};

/// A crank with wings under the pitch law, and with wings that pitch on hinges; a direct drive with either. N: the
/// number of states, one more with an inductance.
template <Scalar S, int N, class V = Vehicle<S>>
using CrankSystem = CycleSystem<S, CycleFeatures{true, false, N == 2}, V>;
template <Scalar S, int N>
using PitchCrankSystem = CycleSystem<S, CycleFeatures{true, true, N == 4}>;
template <Scalar S, int N>
using DirectSystem = CycleSystem<S, CycleFeatures{false, false, N == 3}>;
template <Scalar S, int N>
using PitchDirectSystem = CycleSystem<S, CycleFeatures{false, true, N == 5}>;
/// A vehicle of any kind, on a crank and as a direct drive.
template <Scalar S>
using AnyCrankSystem = CycleSystem<S, CycleFeatures{true, true, true, true}>;
template <Scalar S>
using AnyDirectSystem = CycleSystem<S, CycleFeatures{false, true, true, true}>;

}  // namespace wingbeat

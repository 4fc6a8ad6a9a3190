// Where states, switches, signs and integrals of a CycleSystem stand.
#pragma once

#include <array>
#include <cstddef>

#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/vehicle/coordinates.hpp"

namespace wingbeat {

/// What a CycleSystem is compiled for. Those of cranks and direct drives, wings under the pitch law or on hinges, a
/// current that is a state or not, hold the states of such vehicles alone. One that is `general` takes any vehicle:
/// states that it does not have fade away.
struct CycleFeatures {
  bool turns;      ///< a crank, else a direct drive
  bool on_hinges;  ///< the wings pitch on hinges, else under the pitch law; general: either, or they twist
  bool inductive;  ///< the current is a state; general: an actuator may have states
  bool general = false;
};

template <CycleFeatures features_>
struct CycleLayout {
  static constexpr CycleFeatures features = features_;
  static constexpr bool turns = features.turns, on_hinges = features.on_hinges, inductive = features.inductive;
  static constexpr bool general = features.general;

  // States: the stroke angle of a direct drive, speed, then the groups of StateGroup that there are. No vehicle has
  // both a current and the tip of a piezo: they share a place.
  static constexpr std::size_t shaft = turns ? 0 : 1;  ///< its speed [rad/s]
  static constexpr std::size_t current_state = shaft + 1, tip = shaft + 1;
  static constexpr std::size_t pitch = shaft + 1 + (inductive ? 1 : 0) + (general && !turns ? 1 : 0);
  static constexpr std::size_t place(StateGroup group) {
    if (group < StateGroup::pitch) return current_state;
    std::size_t next = pitch;
    for (std::size_t k = std::size_t(StateGroup::pitch); k < std::size_t(group); ++k) next += size_of(StateGroup(k));
    return next;
  }
  static constexpr std::size_t twist = place(StateGroup::twist);
  static constexpr std::size_t state_count =
      general ? place(StateGroup(state_group_count)) : pitch + (on_hinges ? 2 : 0);

  // Switches: of a direct drive velocity and end of a standstill; rod force and gear torque; under the pitch law its
  // bound, on hinges pitch velocity and stop; where a twisting wing's local pitch turns back, and the limits of a
  // current; the stored moment, which causes no kink in the solution.
  static constexpr std::size_t velocity = 0, release = 1;
  static constexpr std::size_t force = turns ? 0 : 2, gear = force + 1;
  static constexpr std::size_t pitching = gear + 1;
  static constexpr std::size_t turn = gear + (general ? 2 : 1), stop = turn + 1;
  static constexpr std::size_t local_turn = stop + 1, bridge = stop + 2, limit = stop + 3;
  static constexpr std::size_t stored = general ? limit + 1 : on_hinges ? stop + 1 : pitching + 1;
  static constexpr std::size_t switch_count = stored + 1;
  static constexpr int state_switches = int(stored);
  // Signs behind theirs: of a crank stroke velocity, which nodes flip, of a direct drive -1 where friction holds the
  // shaft; of wings on hinges -1 where something holds them, and the number of impacts so far; -1 where electronics
  // block the current, and where they limit it.
  static constexpr std::size_t stroke = switch_count, slip = switch_count;
  static constexpr std::size_t held = switch_count + 1, impacts = switch_count + 2;
  static constexpr std::size_t blocked = switch_count + 3, limited = switch_count + 4;
  static constexpr std::size_t sign_count = switch_count + (general ? 5 : on_hinges ? 3 : 1);

  // Integrals behind those that all vehicles have: loss in the hinges [J]; chordwise_lift() [N s].
  static constexpr std::size_t hinge_work = integral_count, chordwise = integral_count + 1;
  static constexpr std::size_t quadrature_count = integral_count + (on_hinges ? 2 : 0);

  /// Integrals whose error limits the steps. Not those that may vanish up to rounding.
  static constexpr auto controlled_integrals = [] {
    constexpr bool hinge = on_hinges && !general;
    std::array<std::size_t, (turns ? 5 : 6) + (hinge ? 1 : 0)> which{};
    std::size_t n = 0;
    if (turns) which[n++] = std::size_t(Integral::time);
    if (!turns) which[n++] = std::size_t(Integral::current_square);
    if (!turns) which[n++] = std::size_t(Integral::speed_square);
    for (const Integral each :
         {Integral::friction_work, Integral::aero_work, Integral::reactive_work, Integral::lift}) {
      which[n++] = std::size_t(each);
    }
    if (hinge) which[n++] = hinge_work;
    return which;
  }();

  static constexpr bool contracts_slowly = !turns || on_hinges;
  static constexpr bool state_jumps = on_hinges;
};

}  // namespace wingbeat

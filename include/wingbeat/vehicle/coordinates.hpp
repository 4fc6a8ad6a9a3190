// What moves in a vehicle, and what files and interfaces call it.
#pragma once

#include <array>
#include <cstddef>

#include "wingbeat/core/scalar.hpp"

namespace wingbeat {

/// What moves. Of a direct drive the shaft angle is the stroke angle; what a vehicle does not have is 0.
template <Scalar S>
struct Coordinates {
  S angle = S(0.0);           ///< theta, or beta of a direct drive [rad]
  S speed = S(0.0);           ///< its rate omega [rad/s]
  S current = S(0.0);         ///< i [A]; without inductance it follows from the voltage instead
  S pitch_angle = S(0.0);     ///< psi [rad]
  S pitch_velocity = S(0.0);  ///< psi' [rad/s]
  S twist_angle = S(0.0);     ///< tau [rad]
  S twist_velocity = S(0.0);  ///< tau' [rad/s]
  S tip = S(0.0);             ///< x of a piezo behind a compliant transmission [m]
  S tip_velocity = S(0.0);    ///< x' [m/s]

  /// Calls use(number) for each of them.
  template <class Self, class Use>
  static constexpr void each(Self& self, const Use& use) {
    use(self.angle), use(self.speed), use(self.current), use(self.pitch_angle), use(self.pitch_velocity);
    use(self.twist_angle), use(self.twist_velocity), use(self.tip), use(self.tip_velocity);
  }
};

/// Coordinates beside those of the shaft that a vehicle has together or not at all, in the order in which whatever
/// integrates a vehicle has them as states.
enum class StateGroup { current, tip, pitch, twist };
inline constexpr std::size_t state_group_count = 4;

/// One number of a group.
template <Scalar S>
struct GroupState {
  S Coordinates<S>::* number = nullptr;
  const char* name = "";
  const char* unit = "";
};

/// The numbers of each group; the second of a group that has but one is without a name.
template <Scalar S>
inline constexpr std::array<std::array<GroupState<S>, 2>, state_group_count> states_of_groups{
    {{{{&Coordinates<S>::current, "current", "A"}, {}}},
     {{{&Coordinates<S>::tip, "tip", "m"}, {&Coordinates<S>::tip_velocity, "tip_velocity", "m/s"}}},
     {{{&Coordinates<S>::pitch_angle, "pitch_angle", "rad"},
       {&Coordinates<S>::pitch_velocity, "pitch_velocity", "rad/s"}}},
     {{{&Coordinates<S>::twist_angle, "twist_angle", "rad"},
       {&Coordinates<S>::twist_velocity, "twist_velocity", "rad/s"}}}}};

/// How many numbers a group has.
constexpr std::size_t size_of(StateGroup group) {
  return states_of_groups<double>[std::size_t(group)][1].number ? 2 : 1;
}

/// Calls use(place, state) for each number of a group that begins at the place `first`.
template <Scalar S, class Use>
constexpr void for_states_of(StateGroup group, std::size_t first, const Use& use) {
  for (const GroupState<S>& state : states_of_groups<S>[std::size_t(group)]) {
    if (state.number) use(first++, state);
  }
}

}  // namespace wingbeat

// Where what moves in a vehicle is among the unknowns of those who integrate it.
#pragma once

#include <array>
#include <cstddef>

#include "wingbeat/parts/wing_torsion.hpp"
#include "wingbeat/vehicle/coordinates.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// Pitch of the wing where it is reported, \f$\psi + x \tau\f$ at reported_station [rad], and its rate [rad/s].
template <Scalar S>
S local_pitch(const Coordinates<S>& c) {
  return c.pitch_angle + S(reported_station) * c.twist_angle;
}
template <Scalar S>
S local_pitch_velocity(const Coordinates<S>& c) {
  return c.pitch_velocity + S(reported_station) * c.twist_velocity;
}

/// True of wings that pitch on hinges.
template <Scalar S>
bool is_hinged(const Vehicle<S>& v) {
  return pitches(v) && !is_clamped(v.pitch.hinge);
}

/// True of what only the solvers for vehicles of any kind know: wings that twist, a piezo, electronics that limit the
/// current, added mass beside a stop of the pitching. Batches leave them to the scalar solver; the last because lanes
/// know where a stop is met to the square root of the tolerance alone, which is enough where no acceleration jumps.
template <Scalar S>
bool is_of_further_kind(const Vehicle<S>& v) {
  if (jumps_at_pitch_stop(v)) return true;
  return twists(v.pitch.torsion) || is_given(v.piezo) || limits_current(v.electronics);
}

/// Whether a vehicle has the states of a group.
template <Scalar S>
bool has_states(const Vehicle<S>& v, StateGroup group) {
  switch (group) {
    case StateGroup::current: return has_current_state(v);
    case StateGroup::tip: return is_compliant(v.piezo);
    case StateGroup::pitch: return is_hinged(v);
    case StateGroup::twist: return twists(v.pitch.torsion);
  }
  return false;
}

/// Of a vehicle that has all but a current, which a piezo does not.
inline constexpr std::size_t max_unknowns = [] {
  std::size_t count = 1;
  for (std::size_t group = 0; group < state_group_count; ++group) count += size_of(StateGroup(group));
  return count;
}();

/// Where the coordinates of a vehicle are among its unknowns: shaft, then the groups that it has.
struct UnknownIndices {
  bool rotates;
  std::array<bool, state_group_count> has{};
  std::array<std::size_t, state_group_count> first{};  ///< of a group that the vehicle has
  std::size_t count = 2;
  bool inductive, compliant, pitching, twisting;
  std::size_t current, pitch;

  template <Scalar S>
  explicit UnknownIndices(const Vehicle<S>& v) : rotates(drive_of(v).rotates) {
    for (std::size_t k = 0; k < state_group_count; ++k) {
      has[k] = has_states(v, StateGroup(k));
      first[k] = count;
      if (has[k]) count += size_of(StateGroup(k));
    }
    inductive = has[std::size_t(StateGroup::current)], compliant = has[std::size_t(StateGroup::tip)];
    pitching = has[std::size_t(StateGroup::pitch)], twisting = has[std::size_t(StateGroup::twist)];
    current = first[std::size_t(StateGroup::current)], pitch = first[std::size_t(StateGroup::pitch)];
  }

  /// Calls use(index, state) for each unknown beside the shaft's angle and speed.
  template <Scalar S, class Use>
  void for_each(const Use& use) const {
    for (std::size_t k = 0; k < state_group_count; ++k) {
      if (has[k]) for_states_of<S>(StateGroup(k), first[k], use);
    }
  }
  template <Scalar S>
  Coordinates<S> coordinates(const S* y) const {
    Coordinates<S> c{y[0], y[1]};
    for_each<S>([&](std::size_t n, const GroupState<S>& state) { c.*state.number = y[n]; });
    return c;
  }
  template <Scalar S>
  void unknowns(const Coordinates<S>& c, S* y) const {
    y[0] = c.angle, y[1] = c.speed;
    for_each<S>([&](std::size_t n, const GroupState<S>& state) { y[n] = c.*state.number; });
  }
};

}  // namespace wingbeat

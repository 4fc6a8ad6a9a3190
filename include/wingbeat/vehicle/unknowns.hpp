// Where what moves in a vehicle is among the unknowns of those who integrate it.
#pragma once

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

inline constexpr std::size_t max_unknowns = 8;

/// True of wings that pitch on hinges.
template <Scalar S>
bool is_hinged(const Vehicle<S>& v) {
  return pitches(v) && !is_clamped(v.pitch.hinge);
}

/// True of what only the solvers for vehicles of any kind know: wings that twist, a piezo, electronics that limit the
/// current. Batches leave them to the scalar solver.
template <Scalar S>
bool is_of_further_kind(const Vehicle<S>& v) {
  return twists(v.pitch.torsion) || is_given(v.piezo) || limits_current(v.electronics);
}

/// Where the coordinates of a vehicle are among its unknowns: shaft, actuator, pitch, twist, without those that it does
/// not have.
struct UnknownIndices {
  bool rotates, inductive, compliant, pitching, twisting;
  std::size_t current, tip, pitch, twist, count;

  template <Scalar S>
  explicit UnknownIndices(const Vehicle<S>& v)
      : rotates(drive_of(v).rotates),
        inductive(has_current_state(v)),
        compliant(is_compliant(v.piezo)),
        pitching(is_hinged(v)),
        twisting(twists(v.pitch.torsion)),
        current(2),
        tip(2),
        pitch(2u + (inductive ? 1u : 0u) + (compliant ? 2u : 0u)),
        twist(pitch + (pitching ? 2u : 0u)),
        count(twist + (twisting ? 2u : 0u)) {}

  template <Scalar S>
  Coordinates<S> coordinates(const S* y) const {
    Coordinates<S> c{y[0], y[1]};
    if (inductive) c.current = y[current];
    if (compliant) c.tip = y[tip], c.tip_velocity = y[tip + 1];
    if (pitching) c.pitch_angle = y[pitch], c.pitch_velocity = y[pitch + 1];
    if (twisting) c.twist_angle = y[twist], c.twist_velocity = y[twist + 1];
    return c;
  }
  template <Scalar S>
  void unknowns(const Coordinates<S>& c, S* y) const {
    y[0] = c.angle, y[1] = c.speed;
    if (inductive) y[current] = c.current;
    if (compliant) y[tip] = c.tip, y[tip + 1] = c.tip_velocity;
    if (pitching) y[pitch] = c.pitch_angle, y[pitch + 1] = c.pitch_velocity;
    if (twisting) y[twist] = c.twist_angle, y[twist + 1] = c.twist_velocity;
  }
};

}  // namespace wingbeat

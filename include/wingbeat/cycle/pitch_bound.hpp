// The bound of the angle of attack as an event of a periodic system, where the air's inertia jumps there (model.md
// section 10).
#pragma once

#include <cmath>

#include "wingbeat/cycle/event_crossing.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::pitch_bound {

/// The branch of a state with which a cycle begins.
template <class System>
void start(const System& system, const typename System::Real& x, const typename System::State& y,
           typename System::Signs& signs) {
  using S = typename System::Real;
  using std::abs;
  if (!jumps_at_pitch_stop(system.vehicle)) return;
  const S speed = abs(S(system.kinematics(x).stroke_slope * y[System::shaft]));
  signs[System::pitching] = sign_of(S(pitch_margin(system.vehicle.wings, speed)));
}

/// A solution next to a recorded one whose angle of attack came to its bound at x, or left it: the margin changes with
/// -C_alpha d|beta'|/dt.
template <bool quadratures, class System>
void reset_map(const System& system, const typename System::Real& x, typename System::State& y,
               const typename System::Signs& from, const typename System::Signs& to,
               typename System::Quadrature* totals) {
  using S = typename System::Real;
  const auto& v = system.vehicle;
  if (!jumps_at_pitch_stop(v) || value_of(from[System::pitching]) == value_of(to[System::pitching])) return;
  const auto motion = system.motion(x, y, from);
  const S slope =
      -v.wings.pitch_coefficient * System::mode(from).stroke * motion.stroke_acceleration / system.phase_rate(y);
  const S late = -motion.aero.pitch_margin / slope;
  detail::cross_late<quadratures>(system, x, y, from, to, totals, [&](const auto&) { return late; });
}

}  // namespace wingbeat::pitch_bound

// Stops and friction of the pitching as events of a periodic system, whatever drives the stroke (model.md section 12).
//
// A stop takes the pitch velocity in an inelastic impact, at which the stroke velocity jumps too, and holds the wings
// as long as they press on it. Friction of their joint holds them where they come to rest, as long as nothing exceeds
// it. What the names of signs and states mean: CycleLayout.
#pragma once

#include <cmath>

#include "wingbeat/cycle/event_crossing.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/iterate_record.hpp"
#include "wingbeat/vehicle/impact.hpp"

namespace wingbeat::pitch_stops {

/// At which stop the wings are, or nearer to which: +1 or -1.
template <class System>
typename System::Real side(const System& system, const typename System::State& y) {
  return typename System::Real(side_of_stop(system.vehicle.pitch.hinge, y[System::pitch]));
}
/// How far they are from it [rad].
template <class System>
typename System::Real room_to_stop(const System& system, const typename System::State& y) {
  return nearer_stop(system.vehicle.pitch.hinge, y[System::pitch]) - y[System::pitch];
}

template <class System>
bool is_held(const typename System::Signs& signs) {
  return value_of(signs[System::held]) < 0.0;
}

/// What the switch `stop` is: room to the stop [rad], of wings that are held what holds them beyond what would move
/// them [N m].
template <class System>
typename System::Real switch_of(const System& system, const PitchMotion<typename System::Real>& m,
                                const typename System::State& y, const typename System::Signs& signs) {
  using S = typename System::Real;
  const PitchHinge<S>& hinge = system.vehicle.pitch.hinge;
  if (!system.jumps(System::stop) || is_clamped(hinge)) return S(1.0);
  if (is_held<System>(signs)) return holding_margin<S>(hinge, y[System::pitch], m.stop_moment);
  return has_stop(hinge) ? S(side(system, y) * room_to_stop(system, y)) : S(1.0);
}

/// True of a state with which a recorded cycle may begin with wings that something holds.
template <class System>
bool rests(const System& system, const typename System::State& y) {
  const auto& hinge = system.vehicle.pitch.hinge;
  return value_of(y[System::pitch + 1]) == 0.0 &&
         (has_friction(hinge) ||
          (has_stop(hinge) && value_of(side(system, y)) * value_of(room_to_stop(system, y)) <= 0.0));
}

/// Decides whether wings that rest are held.
template <class System>
void hold_or_leave(const System& system, const typename System::Real& x, const typename System::State& y,
                   typename System::Signs& signs) {
  using S = typename System::Real;
  const PitchHinge<S>& hinge = system.vehicle.pitch.hinge;
  signs[System::held] = S(-1.0);
  if (is_at_stop<S>(hinge, y[System::pitch])) signs[System::turn] = -side(system, y);
  // An impact may have turned them over.
  solver::settle_signs(system, x, y, signs);
  const S moment = system.motion(x, y, signs).stop_moment;
  if (value_of(holding_margin<S>(hinge, y[System::pitch], moment)) >= 0.0) return;
  signs[System::held] = S(1.0);
  signs[System::turn] = leaving_side<S>(hinge, y[System::pitch], moment);
}

/// The state after the impact of one that is at a stop; what it adds to the integrals is added to `*totals`, where
/// given.
template <class System>
typename System::State after_impact(const System& system, const typename System::Real& x, typename System::State y,
                                    const typename System::Signs& signs, typename System::Quadrature* totals) {
  using S = typename System::Real;
  y[System::pitch] = nearer_stop(system.vehicle.pitch.hinge, y[System::pitch]);
  auto instant = system.instant_before_impact(x, y, signs);
  Mode<S> mode = System::mode(signs);
  meet_stop(system.vehicle, &instant, &mode, [&](const StopImpact<S>& impact) {
    if (!totals) return;
    const CycleIntegrals<S> at_once = impulses(impact);
    for (std::size_t q = 0; q < at_once.size(); ++q) (*totals)[q] = (*totals)[q] + at_once[q];
    (*totals)[System::hinge_work] = (*totals)[System::hinge_work] + impact.stop_work;
  });
  y[System::shaft] = instant.omega;
  y[System::pitch + 1] = S(0.0);
  if constexpr (System::general) y[System::twist + 1] = instant.twist.velocity;
  return y;
}

/// The switch `stop` or `turn` is crossed: wings that were held leave, others meet the stop or come to rest. `totals`
/// as in after_impact().
template <class System>
void event_transition(const System& system, std::size_t k, const typename System::Real& x, typename System::State& y,
                      typename System::Signs& signs, typename System::Quadrature* totals) {
  using S = typename System::Real;
  if (k == System::turn) {
    y[System::pitch + 1] = S(0.0);
    hold_or_leave(system, x, y, signs);
  } else if (is_held<System>(signs)) {
    const S moment = system.motion(x, y, signs).stop_moment;
    signs[System::held] = S(1.0);
    signs[System::turn] = leaving_side<S>(system.vehicle.pitch.hinge, y[System::pitch], moment);
  } else {
    y = after_impact(system, x, y, signs, totals);
    signs[System::impacts] = signs[System::impacts] + S(1.0);
    system.shaft_after_impact(x, y, signs);
    hold_or_leave(system, x, y, signs);
  }
}

/// True where an impact lies between steps with these signs.
template <class System>
bool has_impact(const typename System::Signs& from, const typename System::Signs& to) {
  return value_of(from[System::impacts]) != value_of(to[System::impacts]);
}

/// A solution next to a recorded one that met a stop, or whose wings friction brought to rest, at x.
template <bool quadratures, class System>
void reset_map(const System& system, const typename System::Real& x, typename System::State& y,
               const typename System::Signs& from, const typename System::Signs& to,
               typename System::Quadrature* totals) {
  using S = typename System::Real;
  if (has_impact<System>(from, to)) {
    const auto before = system.template rates<quadratures>(x, y, from);
    const S late = room_to_stop(system, y) / before.dy[System::pitch];
    for (std::size_t n = 0; n < y.size(); ++n) y[n] = y[n] + before.dy[n] * late;
    y = after_impact(system, S(x + late), y, from, quadratures ? totals : nullptr);
    const auto after = system.template rates<quadratures>(S(x + late), y, to);
    for (std::size_t n = 0; n < y.size(); ++n) y[n] = y[n] - after.dy[n] * late;
    if constexpr (quadratures) {
      for (std::size_t q = 0; q < before.dq.size(); ++q) {
        (*totals)[q] = (*totals)[q] + (before.dq[q] - after.dq[q]) * late;
      }
    }
  }
  const PitchHinge<S>& hinge = system.vehicle.pitch.hinge;
  if (is_clamped(hinge)) return;
  const bool holds = is_held<System>(to), held_before = is_held<System>(from);
  const bool turned = has_friction(hinge) && !held_before && !has_impact<System>(from, to) &&
                      (holds || value_of(from[System::turn]) != value_of(to[System::turn]));
  if (turned)
    detail::cross_at_zero<quadratures>(system, x, y, System::pitch + 1, S(y[System::pitch + 1]), from, to, totals);
  if (!holds) return;
  if (is_at_stop<S>(hinge, y[System::pitch])) y[System::pitch] = nearer_stop(hinge, y[System::pitch]);
  y[System::pitch + 1] = S(0.0);
}

}  // namespace wingbeat::pitch_stops

// Stops of the pitching as events of a periodic system, whatever drives the stroke (model.md section 12).
//
// A stop takes the pitch velocity in an inelastic impact, at which the stroke velocity jumps too, and holds the wings
// as long as they press on it. What the names of signs and states mean: CycleLayout.
#pragma once

#include <cmath>

#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/solve/iterate_record.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::pitch_stops {

/// At which stop the wings are, or nearer to which: +1 or -1.
template <class System>
typename System::Real side(const typename System::State& y) {
  return typename System::Real(value_of(y[System::pitch]) >= 0.0 ? 1.0 : -1.0);
}

template <class System>
bool is_held(const typename System::Signs& signs) {
  return value_of(signs[System::held]) < 0.0;
}

/// What the switch `stop` is: room to the stop [rad], of wings that it holds how they press on it [N m].
template <class System>
typename System::Real switch_of(const System& system, const PitchMotion<typename System::Real>& m,
                                const typename System::State& y, const typename System::Signs& signs) {
  using S = typename System::Real;
  if (!has_stop(system.vehicle.pitch.hinge)) return S(1.0);
  const S stop_side = side<System>(y);
  return is_held<System>(signs) ? S(stop_side * m.stop_moment)
                                : S(system.vehicle.pitch.hinge.stop - stop_side * y[System::pitch]);
}

/// True of a state with which a recorded cycle may begin at a stop.
template <class System>
bool rests_at_stop(const System& system, const typename System::State& y) {
  return has_stop(system.vehicle.pitch.hinge) && value_of(y[System::pitch + 1]) == 0.0 &&
         std::abs(value_of(y[System::pitch])) >= value_of(system.vehicle.pitch.hinge.stop);
}

/// Decides whether wings that rest at a stop are held there.
template <class System>
void hold_or_leave(const System& system, const typename System::Real& x, const typename System::State& y,
                   typename System::Signs& signs) {
  using S = typename System::Real;
  const S stop_side = side<System>(y);
  signs[System::held] = S(-1.0);
  signs[System::turn] = -stop_side;
  // An impact may have turned them over.
  solver::settle_signs(system, x, y, signs);
  if (value_of(S(stop_side * system.motion(x, y, signs).stop_moment)) < 0.0) signs[System::held] = S(1.0);
}

/// The state after the impact of one that is at a stop; what it adds to the integrals is added to `*totals`, where
/// given.
template <class System>
typename System::State after_impact(const System& system, const typename System::Real& x, typename System::State y,
                                    const typename System::Signs& signs, typename System::Quadrature* totals) {
  using S = typename System::Real;
  y[System::pitch] = side<System>(y) * system.vehicle.pitch.hinge.stop;
  MotionState<S> instant{
      {system.kinematics(x), S(0.0)}, y[System::shaft], S(0.0), S(0.0), y[System::pitch], y[System::pitch + 1]};
  Mode<S> mode = System::mode(signs);
  meet_stop(system.vehicle, &instant, &mode, [&](const StopImpact<S>& impact) {
    if (!totals) return;
    const CycleIntegrals<S> at_once = impulses(impact);
    for (std::size_t q = 0; q < at_once.size(); ++q) (*totals)[q] = (*totals)[q] + at_once[q];
    (*totals)[System::hinge_work] = (*totals)[System::hinge_work] + impact.stop_work;
  });
  y[System::shaft] = instant.omega;
  y[System::pitch + 1] = S(0.0);
  return y;
}

/// The switch `stop` is crossed: wings that were held leave, others meet the stop. `totals` as in after_impact().
template <class System>
void event_transition(const System& system, const typename System::Real& x, typename System::State& y,
                      typename System::Signs& signs, typename System::Quadrature* totals) {
  using S = typename System::Real;
  if (is_held<System>(signs)) {
    signs[System::held] = S(1.0);
    signs[System::turn] = -side<System>(y);
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

/// A solution next to a recorded one that met a stop at x: it meets it a little earlier or later.
template <bool quadratures, class System>
void reset_map(const System& system, const typename System::Real& x, typename System::State& y,
               const typename System::Signs& from, const typename System::Signs& to,
               typename System::Quadrature* totals) {
  using S = typename System::Real;
  if (has_impact<System>(from, to)) {
    const auto before = system.template rates<quadratures>(x, y, from);
    const S late = (side<System>(y) * system.vehicle.pitch.hinge.stop - y[System::pitch]) / before.dy[System::pitch];
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
  if (is_held<System>(to)) {
    y[System::pitch] = side<System>(y) * system.vehicle.pitch.hinge.stop;
    y[System::pitch + 1] = S(0.0);
  }
}

}  // namespace wingbeat::pitch_stops

// Electronics that block and limit a motor's current as events of a periodic system (model.md section 15). Of a current
// that is a state the switches are what is left to the limits and, at a limit, what holds it there; of another, which
// follows the voltage, what is left, of either sign.
#pragma once

#include <cmath>

#include "wingbeat/cycle/event_crossing.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::electronics_events {

/// Voltage left for the current beyond that of i [V].
template <class System>
typename System::Real surplus(const System& system, const typename System::Real& x, const typename System::State& y,
                              const typename System::Real& i) {
  const auto& v = system.vehicle;
  return system.voltage(x) - circuit_resistance(v) * i - v.motor.torque_constant * y[System::shaft];
}

/// The current where nothing limits it [A].
template <class System>
typename System::Real free_current(const System& system, const typename System::Real& x,
                                   const typename System::State& y) {
  using S = typename System::Real;
  if (has_current_state(system.vehicle)) return y[System::current_state];
  return algebraic_current(system.vehicle, system.voltage(x), S(y[System::shaft]));
}

template <class System>
typename System::Real bridge_switch(const System& system, const typename System::Real& x,
                                    const typename System::State& y, const typename System::Signs& signs) {
  using S = typename System::Real;
  if (system.vehicle.electronics.regenerates) return S(1.0);
  if (value_of(signs[System::blocked]) < 0.0) return -surplus(system, x, y, S(0.0));
  return free_current(system, x, y);
}
template <class System>
typename System::Real limit_switch(const System& system, const typename System::Real& x,
                                   const typename System::State& y, const typename System::Signs& signs) {
  using S = typename System::Real;
  const S& highest = system.vehicle.electronics.current_max;
  if (!std::isfinite(value_of(highest))) return S(1.0);
  if (value_of(signs[System::limited]) < 0.0) return surplus(system, x, y, highest);
  return highest - free_current(system, x, y);
}

/// The branches of a state with which a cycle begins.
template <class System>
void start(const System& system, const typename System::Real& x, const typename System::State& y,
           typename System::Signs& signs) {
  using S = typename System::Real;
  const auto& e = system.vehicle.electronics;
  if (!limits_current(e) || !has_current_state(system.vehicle)) return;
  const double i = value_of(free_current(system, x, y));
  const bool blocks = i <= 0.0 && value_of(surplus(system, x, y, S(0.0))) < 0.0;
  signs[System::blocked] = S(!e.regenerates && blocks ? -1.0 : 1.0);
  const bool at_limit = i >= value_of(e.current_max) && value_of(surplus(system, x, y, e.current_max)) > 0.0;
  signs[System::limited] = S(at_limit ? -1.0 : 1.0);
}

template <class System>
void event_transition(const System& system, std::size_t k, typename System::State& y, typename System::Signs& signs) {
  using S = typename System::Real;
  const std::size_t sign = k == System::bridge ? System::blocked : System::limited;
  signs[sign] = -signs[sign];
  if (value_of(signs[sign]) > 0.0) return;
  y[System::current_state] = k == System::bridge ? S(0.0) : system.vehicle.electronics.current_max;
}

/// A solution next to a recorded one whose current came to a limit at x.
template <bool quadratures, class System>
void reset_map(const System& system, const typename System::Real& x, typename System::State& y,
               const typename System::Signs& from, const typename System::Signs& to,
               typename System::Quadrature* totals) {
  using S = typename System::Real;
  if (!limits_current(system.vehicle.electronics) || !has_current_state(system.vehicle)) return;
  constexpr std::size_t i = System::current_state;
  const auto hold_at = [&](std::size_t sign, const S& held_current) {
    if (value_of(to[sign]) > 0.0) return;
    if (value_of(from[sign]) > 0.0) {
      detail::cross_at_zero<quadratures>(system, x, y, i, S(y[i] - held_current), from, to, totals);
    }
    y[i] = held_current;
  };
  hold_at(System::blocked, S(0.0));
  hold_at(System::limited, system.vehicle.electronics.current_max);
}

}  // namespace wingbeat::electronics_events

// The shaft of a direct drive that comes to rest as an event of a periodic system: friction or a lossy gearbox holds
// it, or it turns back (model.md sections 6, 9). What the names of signs and states mean: CycleLayout.
#pragma once

#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::shaft_rest {

/// The actuator's torque on a shaft at rest, and between which torques it stands [N m].
template <Scalar S>
struct AtRest {
  S torque;
  StandingTorques<S> torques;
  S margin() const { return torques.margin(torque); }
  S direction() const { return torques.direction(torque); }
};

template <class System>
AtRest<typename System::Real> at_rest(const System& system, const typename System::Real& x, typename System::State y,
                                      const typename System::Signs& signs) {
  using S = typename System::Real;
  const auto& v = system.vehicle;
  y[System::shaft] = S(0.0);
  const auto here = system.instant(x, y, signs);
  S moment = here.configuration.spring_moment;
  if constexpr (System::on_hinges) {
    if (!System::general || pitches(v)) moment = moment + wings_standing(v, here, System::mode(signs)).moment;
  }
  return {standing_torque(v, here),
          standing_torques(v, here.configuration.kinematics, static_rod_force(here.configuration.kinematics, moment))};
}

template <class System>
void hold_or_move(const System& system, const typename System::Real& x, const typename System::State& y,
                  typename System::Signs& signs) {
  using S = typename System::Real;
  const AtRest<S> rest = at_rest(system, x, y, signs);
  signs[System::slip] = S(rest.torques.hold(rest.torque) ? -1.0 : 1.0);
  if (value_of(signs[System::slip]) > 0.0) signs[System::velocity] = rest.direction();
}

/// The switch `velocity` or `release` is crossed.
template <class System>
void event_transition(const System& system, std::size_t k, const typename System::Real& x, typename System::State& y,
                      typename System::Signs& signs) {
  using S = typename System::Real;
  if (k == System::velocity) {
    y[System::shaft] = S(0.0);
    hold_or_move(system, x, y, signs);
  } else {
    signs[System::slip] = S(1.0);
    signs[System::velocity] = at_rest(system, x, y, signs).direction();
  }
}

}  // namespace wingbeat::shaft_rest

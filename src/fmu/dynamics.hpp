// Everything that acts at one instant of a vehicle in time, on any scalar: rates and outputs of an FMU, on dual numbers
// their directional derivatives. What holds or sticks is given, all signs follow from the unknowns.
#pragma once

#include <array>

#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat::fmu {

/// Rates of the unknowns and what outputs are read from.
template <Scalar S>
struct Dynamics {
  std::array<S, max_unknowns> rates;
  PitchMotion<S> motion;
  Coordinates<S> moving;  ///< what stands still has no speed
  S stroke_angle, load_torque;
  CycleIntegrals<S> integrands;
};

/// At the unknowns y, where the supply drives v_s [V] and the load takes v.load_torque.
template <Scalar S>
Dynamics<S> evaluate(const Vehicle<S>& v, const Mode<S>& standing, const S* y, const S& v_s) {
  const UnknownIndices indices(v);
  Dynamics<S> all;
  all.moving = indices.coordinates(y);
  const FullState<S> instant = instant_at(v, all.moving, {v_s}, standing);
  const Mode<S> mode = mode_at(v, instant, standing, &all.motion);
  all.moving.speed = instant.omega;
  all.moving.pitch_velocity = instant.pitch_velocity;
  all.load_torque = v.load_torque;
  all.stroke_angle = stroke_angle_at(v, instant.configuration.kinematics, all.moving.angle);
  all.rates.fill(S(0.0));
  indices.unknowns(rates_of(v, all.moving, instant, all.motion), all.rates.data());
  all.integrands = integrands<S>(all.motion, instant.omega, mode);
  return all;
}

}  // namespace wingbeat::fmu

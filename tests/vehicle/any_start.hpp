// Random slider-cranks far from the reference, from random states, some on a pwm supply: most lock, stall or jam.
#pragma once

#include <random>

#include "vehicle/reference_vehicle.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat {

struct AnyStart {
  Vehicle<double> vehicle;
  TransientOptions options;
};

inline AnyStart any_start(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto chance = [&](double p) { return uniform(generator) < p; };
  const auto between = [&](double a, double b) { return a * std::pow(b / a, uniform(generator)); };
  AnyStart any{reference_vehicle(), {}};
  Vehicle<double>& v = any.vehicle;
  v.voltage = chance(0.05) ? 0.0 : between(0.1, 12.0);
  v.motor.armature_resistance = between(0.5, 50.0);
  v.motor.armature_inductance = chance(0.2) ? 0.0 : between(1e-6, 0.1);
  v.motor.torque_constant = between(2e-3, 3e-2);
  v.motor.inertia = between(1e-9, 1e-6);
  v.motor.viscous_damping = between(1e-7, 1e-4);
  v.motor.friction_torque = chance(0.5) ? 0.0 : between(1e-6, 3e-3);
  v.transmission.slider_crank.crank_radius = between(2e-3, 1e-2);
  v.transmission.slider_crank.rod_length = v.transmission.slider_crank.crank_radius * (1.1 + 5.0 * uniform(generator));
  v.transmission.slider_crank.hinge_offset = v.transmission.slider_crank.crank_radius * between(0.3, 3.0);
  v.transmission.slider_crank.mid_stroke_height =
      v.transmission.slider_crank.rod_length + (chance(0.3) ? 0.3 * v.transmission.slider_crank.crank_radius : 0.0);
  v.transmission.slider_crank.formulation = chance(0.5) ? Formulation::rod_force : Formulation::virtual_work;
  v.friction = {chance(0.3) ? 0.0 : between(1e-5, 5e-3), chance(0.7) ? 0.0 : between(1e-7, 1e-4),
                chance(0.7) ? 0.0 : between(1e-9, 1e-6), chance(0.7) ? 0.0 : between(1e-6, 1e-3)};
  v.spring.stiffness = chance(0.4) ? 0.0 : between(1e-5, 1e-1);
  v.wing_inertia = chance(0.1) ? 0.0 : between(1e-9, 1e-6);
  v.wings.air_density = chance(0.2) ? 0.0 : 1.2;
  v.wings.s2 = between(1e-7, 1e-5);
  v.wings.s3 = between(1e-9, 1e-6);
  any.options.max_steps = 200000;
  if (chance(0.2)) any.options.start.speed = 1000.0 * (uniform(generator) - 0.5);
  if (chance(0.2)) any.options.start.angle = 10.0 * (uniform(generator) - 0.5);
  if (chance(0.1)) any.options.supply = Supply<double>{SupplyType::pwm, v.voltage, between(100.0, 2000.0), 0.6};
  return any;
}

}  // namespace wingbeat

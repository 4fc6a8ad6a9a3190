// Random, physically valid vehicles around the reference vehicle of the 2022 friction paper.
#pragma once

#include <random>

#include "vehicle/reference_vehicle.hpp"

namespace wingbeat {

/// A design whose every parameter is drawn around the reference: some lock, stall or jam. `spread` is the largest
/// factor up or down of most parameters.
inline Design<double> random_design(std::mt19937_64& random, double spread = 2.0) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto around = [&](double value, double factor) {
    return value * std::exp(uniform(-std::log(factor), std::log(factor)));
  };
  Design<double> d = reference_design();
  d.supply.voltage = uniform(1.0, 6.0);
  Motor<double>& m = d.motor.constants;
  m.armature_resistance = around(m.armature_resistance, spread);
  m.armature_inductance = uniform(0.0, 1.0) < 0.15 ? 0.0 : around(m.armature_inductance, 10.0 * spread);
  m.torque_constant = around(m.torque_constant, spread);
  m.inertia = around(m.inertia, spread);
  m.viscous_damping = around(m.viscous_damping, spread);
  m.friction_torque = uniform(0.0, 1.0) < 0.3 ? uniform(0.0, 2e-3) : 0.0;
  auto& t = d.transmission;
  t.crank_radius = around(5e-3, 1.6);
  t.rod_length = t.crank_radius * uniform(2.0, 8.0);
  t.hinge_offset = t.crank_radius * uniform(0.8, 3.0);
  t.formulation = uniform(0.0, 1.0) < 0.5 ? Formulation::rod_force : Formulation::virtual_work;
  switch (std::uniform_int_distribution<int>(0, 6)(random)) {
    case 0: d.friction = {FrictionLaw::none, 0.0}; break;
    case 1: d.friction = {FrictionLaw::viscous, around(3e-6, 3.0)}; break;
    case 2: d.friction = {FrictionLaw::quadratic, around(2e-8, 3.0)}; break;
    case 3: d.friction = {FrictionLaw::constant, around(4e-4, 3.0)}; break;
    default: d.friction = {FrictionLaw::load_proportional, around(2.5e-3, 2.0)};
  }
  if (uniform(0.0, 1.0) < 0.5) d.spring.stiffness = around(1.377e-3, 3.0);
  d.wing.inertia = around(d.wing.inertia, spread);
  d.wing.planform.s2 = around(d.wing.planform.s2, spread);
  d.wing.planform.s3 = around(d.wing.planform.s3, spread);
  d.aerodynamics.pitch_coefficient = around(5e-3, 1.5);
  return d;
}

/// The reference box of the ensemble benchmark and tests: every parameter within 30 % of the reference vehicle's, 2 to
/// 5 V, half of the designs with springs, half in either formulation.
inline Design<double> box_design(std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto vary = [&](double& value) { value *= uniform(0.7, 1.3); };
  Design<double> d = reference_design();
  d.supply.voltage = uniform(2.0, 5.0);
  Motor<double>& m = d.motor.constants;
  for (double* value : {&m.armature_resistance, &m.armature_inductance, &m.torque_constant, &m.inertia,
                        &m.viscous_damping, &d.transmission.crank_radius, &d.transmission.rod_length,
                        &*d.transmission.hinge_offset, &d.friction.coefficient, &d.wing.inertia, &d.wing.planform.s2,
                        &d.wing.planform.s3, &d.aerodynamics.pitch_coefficient}) {
    vary(*value);
  }
  double stiffness = 1.377e-3;
  vary(stiffness);
  if (uniform(0.0, 1.0) < 0.5) d.spring.stiffness = stiffness;
  d.transmission.formulation = uniform(0.0, 1.0) < 0.5 ? Formulation::rod_force : Formulation::virtual_work;
  return d;
}

/// A design of the box with a coreless motor of 4.5 g (0816K006SR of data/motors/motors.csv) behind a gearbox of 2 to
/// 60, from near stall to far above its voltage, whose electrical time constant is drawn from 1 us to 1 ms: it is 10
/// us.
inline Design<double> coreless_design(std::mt19937_64& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto logarithmic = [&](double a, double b) { return a * std::pow(b / a, uniform(0.0, 1.0)); };
  Design<double> d = box_design(random);
  const double gear_ratio = logarithmic(2.0, 60.0);
  Motor<double>& m = d.motor.constants;
  m.armature_resistance = 21.2;
  m.armature_inductance = 21.2 * logarithmic(1e-6, 1e-3);
  m.torque_constant = 4.12e-3 * gear_ratio;
  m.inertia = 5.2e-9 * gear_ratio * gear_ratio;
  m.viscous_damping = 1.4e-10 * gear_ratio * gear_ratio;
  d.supply.voltage = uniform(1.0, 12.0);
  d.spring.stiffness = std::max(0.0, uniform(-1e-3, 5e-3));
  return d;
}

/// A direct drive whose every parameter is drawn: quality factors from about a half to 20, electrical time constants
/// from nothing to a fifth of a period, drive frequencies up to 60 % off resonance, half with a pitch stop. With
/// `constant_friction` the friction reaches up to what the drive can just overcome.
inline Design<double> random_direct_design(std::mt19937_64& random, bool constant_friction) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  const auto around = [&](double value, double factor) {
    return value * std::exp(uniform(-std::log(factor), std::log(factor)));
  };
  Design<double> d = reference_design();
  d.transmission = {};
  d.transmission.type = TransmissionType::direct;
  d.supply = {SupplyType::sine, uniform(1.0, 6.0), around(22.0, 2.0), 1.0};
  Motor<double>& m = d.motor.constants;
  m.armature_resistance = around(9.0, 2.0);
  m.armature_inductance = uniform(0.0, 1.0) < 0.25 ? 0.0 : around(3e-3, 30.0);
  m.torque_constant = around(0.01, 2.0);
  m.inertia = around(1.5e-7, 4.0);
  m.viscous_damping = around(3.6e-6, 3.0);
  switch (std::uniform_int_distribution<int>(0, 2)(random)) {
    case 0: d.friction = {FrictionLaw::none, 0.0}; break;
    case 1: d.friction = {FrictionLaw::viscous, around(3e-6, 3.0)}; break;
    default: d.friction = {FrictionLaw::quadratic, around(2e-8, 3.0)};
  }
  if (constant_friction) {
    const double drive = m.torque_constant * d.supply.voltage /
                         std::hypot(m.armature_resistance, two_pi * d.supply.frequency * m.armature_inductance);
    (uniform(0.0, 1.0) < 0.5 ? d.friction.coefficient : m.friction_torque) = uniform(0.0, 0.95) * drive;
    if (m.friction_torque == 0.0) d.friction.law = FrictionLaw::constant;
  }
  d.spring.resonance = d.supply.frequency * around(1.0, 1.6);
  d.wing.inertia = around(d.wing.inertia, 4.0);
  d.wing.planform.s2 = around(d.wing.planform.s2, 10.0);
  d.wing.planform.s3 = around(d.wing.planform.s3, 10.0);
  d.aerodynamics.pitch_coefficient = around(5e-3, 2.0);
  if (uniform(0.0, 1.0) < 0.5) d.aerodynamics.angle_of_attack_min = uniform(0.3, 1.2);
  return d;
}

}  // namespace wingbeat

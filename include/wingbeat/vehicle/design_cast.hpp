// A design on another scalar: where derivatives by its parameters begin.
#pragma once

#include <optional>

#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// The same design with every number as a T.
template <Scalar T>
Design<T> cast_design(const Design<double>& d) {
  const auto optional = [](const std::optional<double>& x) { return x ? std::optional<T>(T(*x)) : std::nullopt; };
  const Planform<double>& p = d.wing.planform;
  Design<T> r;
  r.name = d.name;
  r.mass = optional(d.mass);
  r.masses = {optional(d.masses.supply), optional(d.masses.motor), optional(d.masses.rod_linear_density),
              optional(d.masses.spring)};
  r.bench_torque_constant = optional(d.bench_torque_constant);
  r.supply = d.supply.template cast<T>();
  r.supply_resonance_ratio = optional(d.supply_resonance_ratio);
  r.motor = {optional(d.motor.gear_ratio), d.motor.constants.template cast<T>(), T(d.motor.gear_inertia),
             T(d.motor.gear_damping)};
  r.transmission = {T(d.transmission.crank_radius),
                    T(d.transmission.rod_length),
                    optional(d.transmission.hinge_offset),
                    optional(d.transmission.stroke_amplitude),
                    optional(d.transmission.mid_stroke_height),
                    d.transmission.formulation,
                    d.transmission.type};
  r.friction = {d.friction.law, T(d.friction.coefficient)};
  r.spring = {optional(d.spring.stiffness), optional(d.spring.resonance), optional(d.spring.resonance_ratio)};
  r.wing = {T(d.wing.count),
            T(d.wing.inertia),
            {p.shape, T(p.length), T(p.root_chord), T(p.hub_offset), p.chord_table, T(p.s2), T(p.s3),
             optional(p.chord_ratio)},
            optional(d.wing.resonance)};
  r.aerodynamics = {T(d.aerodynamics.air_density), T(d.aerodynamics.pitch_coefficient),
                    d.aerodynamics.coefficients_name, d.aerodynamics.coefficients.template cast<T>(),
                    optional(d.aerodynamics.angle_of_attack_min)};
  return r;
}

}  // namespace wingbeat

#include "wingbeat/vehicle/design.hpp"

#include <cmath>

#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

void validate(const Design<double>& d) {
  if (d.mass) require(*d.mass > 0.0, "vehicle.mass", "must be > 0", "kg", *d.mass);
  const auto check_mass = [](const std::optional<double>& x, const char* key, const char* unit) {
    if (x) require(*x >= 0.0, key, "must be >= 0", unit, *x);
  };
  check_mass(d.masses.supply, "supply.mass", "kg");
  check_mass(d.masses.motor, "motor.mass", "kg");
  check_mass(d.masses.rod_linear_density, "transmission.rod_linear_density", "kg/m");
  check_mass(d.masses.spring, "spring.mass", "kg");
  if (d.bench_torque_constant) {
    require(*d.bench_torque_constant > 0.0, "bench.torque_constant", "must be > 0", "N m/A", *d.bench_torque_constant);
  }
  validate(d.supply);
  if (d.motor.gear_ratio) {
    require(*d.motor.gear_ratio > 0.0, "motor.gear_ratio", "must be > 0", "1", *d.motor.gear_ratio);
    require(d.motor.gear_inertia >= 0.0, "motor.gear_inertia", "must be >= 0", "kg m2", d.motor.gear_inertia);
    require(d.motor.gear_damping >= 0.0, "motor.gear_damping", "must be >= 0", "N m s/rad", d.motor.gear_damping);
  }
  validate(d.motor.constants);

  const TransmissionDesign<double>& t = d.transmission;
  if (t.hinge_offset.has_value() == t.stroke_amplitude.has_value()) {
    throw ParameterError("transmission.hinge_offset", "give exactly one of hinge_offset and stroke_amplitude");
  }
  if (t.stroke_amplitude) {
    require(*t.stroke_amplitude > 0.0 && *t.stroke_amplitude < pi / 2.0, "transmission.stroke_amplitude",
            "must lie between 0 and pi/2", "rad", *t.stroke_amplitude);
    if (t.mid_stroke_height) {
      throw ParameterError("transmission.stroke_amplitude",
                           "cannot be combined with mid_stroke_height; give hinge_offset instead");
    }
  }
  if (d.spring.stiffness && d.spring.resonance) {
    throw ParameterError("spring.stiffness", "give one of stiffness and resonance, not both");
  }
  if (d.spring.resonance) {
    require(*d.spring.resonance >= 0.0, "spring.resonance", "must be >= 0", "Hz", *d.spring.resonance);
  }
  require(d.wing.count >= 1.0 && d.wing.count == std::floor(d.wing.count), "wing.count", "must be a whole number >= 1",
          "1", d.wing.count);
  require(d.wing.inertia > 0.0, "wing.inertia", "must be > 0", "kg m2", d.wing.inertia);
  validate(d.wing.planform);

  const Vehicle<double> v = resolve(d);
  validate(v.crank);
  validate(v.friction);
  validate(v.spring);
  validate(v.wings);
}

}  // namespace wingbeat

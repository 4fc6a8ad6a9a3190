#include "wingbeat/vehicle/design.hpp"

#include <cmath>

#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

/// What a direct drive needs and cannot have.
void validate_direct(const Design<double>& d) {
  if (d.supply.type != SupplyType::sine) {
    throw ParameterError("supply.type", "a direct drive swings as its supply does: expected sine");
  }
  if (d.friction.law == FrictionLaw::load_proportional) {
    throw ParameterError("friction.type",
                         "load-proportional friction follows the rod force, and a direct drive has no "
                         "rod; expected none, viscous, quadratic or constant");
  }
  const auto positive = [](const std::optional<double>& x, const char* key, const char* unit) {
    if (x) require(*x > 0.0, key, "must be > 0", unit, *x);
  };
  positive(d.supply_resonance_ratio, "supply.resonance_ratio", "1");
  positive(d.spring.resonance_ratio, "spring.resonance_ratio", "1");
  positive(d.wing.resonance, "wing.resonance", "Hz");
  if (d.masses.rod_linear_density) {
    throw ParameterError("transmission.rod_linear_density", "a direct drive has no rod");
  }
  if (d.supply_resonance_ratio && d.spring.resonance_ratio) {
    throw ParameterError("supply.resonance_ratio",
                         "ties the frequency to the springs, which spring.resonance_ratio "
                         "ties to the frequency; give one of them");
  }
  if (d.wing.resonance && !d.spring.stiffness) {
    throw ParameterError("wing.resonance", "gives the inertia that resonates on a known spring; give spring.stiffness");
  }
  if (d.supply_resonance_ratio && !d.spring.stiffness && !d.spring.resonance) {
    throw ParameterError("supply.resonance_ratio",
                         "needs springs to resonate with; give spring.stiffness or "
                         "spring.resonance");
  }
}

}  // namespace

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
  {
    Supply<double> supply = d.supply;
    if (d.supply_resonance_ratio) supply.frequency = 1.0;  // follows from the springs
    validate(supply);
  }
  if (d.motor.gear_ratio) {
    require(*d.motor.gear_ratio > 0.0, "motor.gear_ratio", "must be > 0", "1", *d.motor.gear_ratio);
    require(d.motor.gear_inertia >= 0.0, "motor.gear_inertia", "must be >= 0", "kg m2", d.motor.gear_inertia);
    require(d.motor.gear_damping >= 0.0, "motor.gear_damping", "must be >= 0", "N m s/rad", d.motor.gear_damping);
  }
  validate(d.motor.constants);

  const TransmissionDesign<double>& t = d.transmission;
  const bool direct = t.type == TransmissionType::direct;
  if (direct) {
    validate_direct(d);
  } else if (t.hinge_offset.has_value() == t.stroke_amplitude.has_value()) {
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
  if (int(d.spring.stiffness.has_value()) + d.spring.resonance.has_value() + d.spring.resonance_ratio.has_value() > 1) {
    throw ParameterError("spring.stiffness", direct ? "give one of stiffness, resonance and resonance_ratio"
                                                    : "give one of stiffness and resonance, not both");
  }
  if (d.spring.resonance) {
    require(*d.spring.resonance >= 0.0, "spring.resonance", "must be >= 0", "Hz", *d.spring.resonance);
  }
  require(d.wing.count >= 1.0 && d.wing.count == std::floor(d.wing.count), "wing.count", "must be a whole number >= 1",
          "1", d.wing.count);
  if (!d.wing.resonance) require(d.wing.inertia > 0.0, "wing.inertia", "must be > 0", "kg m2", d.wing.inertia);
  validate(d.wing.planform);
  if (d.aerodynamics.angle_of_attack_min) {
    require(*d.aerodynamics.angle_of_attack_min >= 0.0, "aerodynamics.angle_of_attack_min", "must be >= 0 and < pi/2",
            "rad", *d.aerodynamics.angle_of_attack_min);
  }

  const Vehicle<double> v = resolve(d);
  if (!direct) validate(v.crank);
  validate(v.friction);
  validate(v.spring);
  validate(v.wings);
  if (d.supply_resonance_ratio && !(v.drive_frequency > 0.0)) {
    throw ParameterError("supply.resonance_ratio", "the springs' stiffness is 0: nothing resonates");
  }
  if (d.wing.resonance) {
    require(v.wing_inertia > 0.0, "wing.resonance", "leaves the wings no inertia beside the rotor's: must be lower",
            "Hz", *d.wing.resonance);
  }
}

}  // namespace wingbeat

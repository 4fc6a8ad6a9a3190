#include "wingbeat/vehicle/design.hpp"

#include <cmath>

#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

void validate_slider_crank(const Design<double>& d) {
  const TransmissionDesign<double>& t = d.transmission;
  if (t.hinge_offset.has_value() == t.stroke_amplitude.has_value()) {
    throw ParameterError("transmission.hinge_offset", "give exactly one of hinge_offset and stroke_amplitude");
  }
  if (t.stroke_amplitude && t.mid_stroke_height) {
    throw ParameterError("transmission.stroke_amplitude",
                         "cannot be combined with mid_stroke_height; give hinge_offset instead");
  }
}

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
  for (const Parameter<double>& parameter : parameter_table<double>()) {
    const std::optional<double> x = parameter.get ? parameter.get(d) : std::nullopt;
    if (!x || (parameter.range.holds(*x) && std::isfinite(*x))) continue;
    throw ParameterError(std::string(parameter.path),
                         range_message(parameter.range.expected, std::string(parameter.unit).c_str(), *x));
  }
  if (d.supply.type == SupplyType::battery) validate(d.supply.battery);

  const TransmissionType type = d.transmission.type;
  if (d.masses.rod_linear_density && !rod_length(d.transmission)) {
    throw ParameterError(
        "transmission.rod_linear_density",
        std::string("a ") + name_of(type) + (drive_of(d).rotates ? " transmission" : " drive") + " has no rod");
  }
  switch (type) {
    case TransmissionType::slider_crank: validate_slider_crank(d); break;
    case TransmissionType::direct: validate_direct(d); break;
    case TransmissionType::four_bar:
    case TransmissionType::tabulated: break;
  }
  if (int(d.spring.stiffness.has_value()) + d.spring.resonance.has_value() + d.spring.resonance_ratio.has_value() > 1) {
    throw ParameterError("spring.stiffness", drive_of(d).alternating
                                                 ? "give one of stiffness, resonance and resonance_ratio"
                                                 : "give one of stiffness and resonance, not both");
  }
  validate(d.wing.planform);
  const MotorThermalDesign<double>& thermal = d.motor.thermal;
  if (thermal.resistance_winding.has_value() != thermal.resistance_case.has_value()) {
    throw ParameterError(thermal.resistance_winding ? motor_thermal_key::resistance_case.path
                                                    : motor_thermal_key::resistance_winding.path,
                         "missing: give both thermal resistances, of winding and case, or neither");
  }

  const Vehicle<double> v = resolve(d);
  if (drive_of(d).rotates) validate(v.transmission);
  if (thermal.time_constant_winding.has_value() != thermal.time_constant_case.has_value()) {
    throw ParameterError(thermal.time_constant_winding ? motor_thermal_key::time_constant_case.path
                                                       : motor_thermal_key::time_constant_winding.path,
                         "missing: give both thermal time constants, of winding and case, or neither");
  }
  validate(v.spring);
  validate(v.thermal);
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

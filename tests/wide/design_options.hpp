// A vehicle of the wide boxes as options of wingbeat run, to look at it.
#pragma once

#include <cstdio>
#include <string>

#include "vehicle/wide_boxes.hpp"

namespace wingbeat {

inline void print_design(const WideVehicle& vehicle) {
  const Design<double>& d = vehicle.design;
  const auto set = [](const char* key, double value) { std::printf(" --set %s=%.17g", key, value); };
  const auto choose = [](const char* key, const char* value) { std::printf(" --set %s=%s", key, value); };
  constexpr const char* supplies[] = {"constant", "sine", "pwm", "battery"};
  choose("supply.type", supplies[int(d.supply.type)]);
  if (d.supply.type == SupplyType::battery) {
    const Battery<double>& b = d.supply.battery;
    set("supply.cells", b.cells), set("supply.cell_voltage", b.cell_voltage);
    set("supply.internal_resistance", b.internal_resistance), set("supply.capacity", b.capacity);
    set("supply.charge", b.charge);
  } else {
    set(d.supply.type == SupplyType::sine ? "supply.amplitude" : "supply.voltage", d.supply.voltage);
    if (d.supply.type != SupplyType::constant) set("supply.frequency", d.supply.frequency);
    if (d.supply.type == SupplyType::pwm) set("supply.duty", d.supply.duty);
  }
  const Motor<double>& m = d.motor.constants;
  set("motor.armature_resistance", m.armature_resistance), set("motor.armature_inductance", m.armature_inductance);
  set("motor.torque_constant", m.torque_constant), set("motor.inertia", m.inertia);
  set("motor.viscous_damping", m.viscous_damping), set("motor.friction_torque", m.friction_torque);
  const auto& t = d.transmission;
  if (t.type == TransmissionType::four_bar) {
    choose("transmission.type", "four-bar");
    set("transmission.crank_radius", t.crank_radius), set("transmission.coupler_length", t.coupler_length);
    set("transmission.rocker_length", t.rocker_length), set("transmission.ground_length", t.ground_length);
    set("transmission.stroke_ratio", t.stroke_ratio);
    if (t.ground_angle) set("transmission.ground_angle", degrees_per_radian * *t.ground_angle);
  }
  if (t.type == TransmissionType::slider_crank) {
    set("transmission.crank_radius", t.crank_radius), set("transmission.rod_length", t.rod_length);
    set("transmission.hinge_offset", *t.hinge_offset);
    choose("transmission.formulation", t.formulation == Formulation::rod_force ? "rod-force" : "virtual-work");
  }
  constexpr const char* laws[] = {"none", "load-proportional", "viscous", "quadratic", "constant"};
  constexpr const char* coefficients[] = {"", "radius", "damping", "coefficient", "torque"};
  choose("friction.type", laws[int(d.friction.law)]);
  if (d.friction.law != FrictionLaw::none) {
    set((std::string("friction.") + coefficients[int(d.friction.law)]).c_str(), d.friction.coefficient);
  }
  if (d.spring.stiffness) set("spring.stiffness", *d.spring.stiffness);
  if (d.spring.resonance) set("spring.resonance", *d.spring.resonance);
  set("wing.inertia", d.wing.inertia);
  std::printf(" --set 'wing.planform={shape=\"moments\", s2=%.17g, s3=%.17g", d.wing.planform.s2, d.wing.planform.s3);
  if (d.wing.planform.s22) std::printf(", s22=%.17g", *d.wing.planform.s22);
  std::printf("}'");
  if (d.aerodynamics.added_mass) choose("aerodynamics.added_mass", "true");
  if (d.motor.gear_efficiency) set("motor.gear_efficiency", *d.motor.gear_efficiency);
  if (d.motor.thermal.resistance_winding) {
    set("motor.thermal_resistance_winding", *d.motor.thermal.resistance_winding);
    set("motor.thermal_resistance_case", *d.motor.thermal.resistance_case);
    set("motor.magnet_temperature_coefficient", d.motor.thermal.magnet_temperature_coefficient);
  }
  set("aerodynamics.pitch_coefficient", d.aerodynamics.pitch_coefficient);
  if (d.aerodynamics.angle_of_attack_min) {
    set("aerodynamics.angle_of_attack_min", degrees_per_radian * *d.aerodynamics.angle_of_attack_min);
  }
  constexpr const char* conditions[] = {"air", "vacuum", "wingless"};
  std::printf(" --condition %s%s\n", conditions[int(vehicle.condition)],
              d.aerodynamics.coefficients.table ? " (and a table of coefficients)" : "");
}

}  // namespace wingbeat

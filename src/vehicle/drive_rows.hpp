// The rows of the parameter table that say what drives a vehicle: the vehicle itself, supply, motor, electronics,
// piezo.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "vehicle/parameter_access.hpp"

namespace wingbeat::detail {

template <Scalar S>
constexpr auto drive_rows() {
  using D = Design<S>;
  using Powered = SupplyIs<SupplyType::constant, SupplyType::pwm>;
  using Sine = SupplyIs<SupplyType::sine, SupplyType::battery_sine>;
  using Periodic = SupplyIs<SupplyType::sine, SupplyType::pwm, SupplyType::battery_sine>;
  using Switched = SupplyIs<SupplyType::pwm, SupplyType::battery>;
  using OnBattery = SupplyIs<SupplyType::battery, SupplyType::battery_sine>;
  using Direct = TransmissionIs<TransmissionType::direct>;
  constexpr auto drive_ratio = [](auto& d) -> auto& { return d.supply_resonance_ratio; };
  constexpr auto supply_mass = [](auto& d) -> auto& { return d.masses.supply; };
  constexpr auto specific_energy = [](auto& d) -> auto& { return d.supply.battery.specific_energy; };
  return std::array{
      text<S>({"vehicle.name", "", {"any text"}, "no name", "name of the vehicle, for reports"},
              [](const D& d) { return d.name; }),
      number<S>({"vehicle.mass",
                 "kg",
                 range::positive,
                 "unknown",
                 "mass of the vehicle without the masses stated separately (motor.mass, supply.mass, "
                 "supply.specific_energy, spring.mass, transmission.rod_linear_density); enables lift_to_weight",
                 {},
                 "3.34 g"},
                [](auto& d) -> auto& { return d.mass; }),
      number<S>({"vehicle.motors", "1", range::count, "1",
                 "M, number of motors on the supply, each with its own transmission and wings, in phase"},
                [](auto& d) -> auto& { return d.motors; }),

      choice<S, SupplyChoice>("source at the motor terminals"),
      number<S, Powered>(row(supply_key::voltage, "required", "v, terminal voltage; pwm: while switched on", {}, "3 V"),
                         [](auto& d) -> auto& { return d.supply.voltage; }),
      number<S, Sine>(row(supply_key::amplitude, "required", "amplitude of the sine", {}, "3 V"),
                      [](auto& d) -> auto& { return d.supply.voltage; }),
      number<S, Sine>(row(supply_key::offset, "0 V", "V_0, constant part of the voltage, added to the sine"),
                      [](auto& d) -> auto& { return d.supply.offset; }),
      replaceable<S, Periodic>(
          row(supply_key::frequency, "required", "drive frequency (sine) or switching frequency (pwm)",
              {"resonance_ratio"}, "22 Hz"),
          [](auto& d) -> auto& { return d.supply.frequency; }, drive_ratio),
      alternative<S, Direct>({"supply.resonance_ratio",
                              "1",
                              range::positive,
                              "required",
                              "drive frequency over the frequency at which rotor and wings resonate on the springs; 1 "
                              "drives a direct drive at resonance",
                              {"frequency"}},
                             drive_ratio),
      number<S, Switched>(row(supply_key::duty, "1",
                              "D, fraction of a period switched on; required for pwm, else of the speed control"),
                          [](auto& d) -> auto& { return d.supply.duty; }),
      text<S, OnBattery>({"supply.throttle",
                          "",
                          {wingbeat::listed_names<Throttle>()},
                          "fixed",
                          "speed control in flight: fixed holds the duty (or a bridge's amplitude), hover "
                          "sets it so that the mean lift carries the weight"},
                         [](const D& d) {
                           if (!OnBattery::holds(d)) return std::string();
                           return std::string(name_of(d.supply.throttle));
                         }),
      number<S, OnBattery>(row(battery_key::cells, "1", "cells in series"),
                           [](auto& d) -> auto& { return d.supply.battery.cells; }),
      battery_voltage<S>(row(battery_key::cell_voltage, "required", "E, open-circuit voltage of one cell at any charge",
                             {"discharge_curve"})),
      table<S, OnBattery>({"supply.discharge_curve",
                           "",
                           {"name of a CSV file, or rows from charge 0 to 1, voltages not falling"},
                           "required",
                           "open-circuit voltage of one cell: rows [state of charge, voltage], monotone cubics, see "
                           "below",
                           {"cell_voltage"}}),
      number<S, OnBattery>(
          row(battery_key::internal_resistance, "required", "R_i of one cell: terminal voltage E - R_i i, times cells"),
          [](auto& d) -> auto& { return d.supply.battery.internal_resistance; }),
      number<S, OnBattery>(row(battery_key::capacity, "required", "charge that a full cell holds"),
                           [](auto& d) -> auto& { return d.supply.battery.capacity; }),
      number<S, OnBattery>(row(battery_key::charge, "1", "state of charge of a run, and at the start of a flight"),
                           [](auto& d) -> auto& { return d.supply.battery.charge; }),
      number<S, OnBattery>(
          row(battery_key::cutoff_voltage, "none", "mean terminal voltage of one cell at which a flight ends"),
          [](auto& d) -> auto& { return d.supply.battery.cutoff_voltage; }),
      alternative<S, OnBattery>(
          row(battery_key::specific_energy, "none: in vehicle.mass",
              "energy of the full battery without load over its mass: that mass, which grows with the capacity, is in "
              "addition to vehicle.mass",
              {"mass"}),
          specific_energy, supply_mass),
      alternative<S, Weighed>({"supply.mass",
                               "kg",
                               range::not_negative,
                               "none: in vehicle.mass",
                               "mass of the battery, in addition to vehicle.mass",
                               {"specific_energy"}},
                              supply_mass, specific_energy),

      number<S, Motorised>({"motor.gear_ratio", "1", range::positive, "none: constants at the output shaft",
                            "n, motor turns per output turn; with it the constants below hold at the motor shaft"},
                           [](auto& d) -> auto& { return d.motor.gear_ratio; }),
      number<S, Geared>({"motor.gear_inertia", "kg m2", range::not_negative, "0 kg m2",
                         "J_G, inertia of the gearbox at the output shaft"},
                        [](auto& d) -> auto& { return d.motor.gear_inertia; }),
      number<S, Geared>({"motor.gear_damping", "N m s/rad", range::not_negative, "0 N m s/rad",
                         "b_G, viscous damping of the gearbox at the output shaft"},
                        [](auto& d) -> auto& { return d.motor.gear_damping; }),
      Parameter<S>{placed<Motorised>(row(
                       motor_key::gear_efficiency, "1",
                       "eta, torque behind the gearbox over torque before it while the motor drives; 1/eta while the "
                       "load drives")),
                   [](Design<S>& d, const S& x) {
                     if (!Motorised::holds(d)) return false;
                     d.motor.constants.gear_efficiency = x;  // what is referred to the output shaft keeps it
                     d.motor.gear_efficiency = x;
                     return true;
                   },
                   [](const Design<S>& d) -> std::optional<S> { return d.motor.gear_efficiency; }},
      number<S, Motorised>(row(motor_key::armature_resistance, "required", "R_a, armature resistance", {}, "9 ohm"),
                           [](auto& d) -> auto& { return d.motor.constants.armature_resistance; }),
      number<S, Motorised>(
          row(motor_key::armature_inductance, "required",
              "L_a, armature inductance; 0, or a lag of the current below 1e-9 rad, makes it algebraic", {}, "29 mH"),
          [](auto& d) -> auto& { return d.motor.constants.armature_inductance; }),
      number<S, Motorised>(row(motor_key::torque_constant, "required",
                               "K at the output shaft; K_b at the motor shaft with gear_ratio", {}, "10 mN m/A"),
                           [](auto& d) -> auto& { return d.motor.constants.torque_constant; }),
      number<S, Motorised>(
          row(motor_key::inertia, "required",
              "J, rotor and gearbox at the output shaft; J_m of the rotor with gear_ratio", {}, "1.5e-7 kg m2"),
          [](auto& d) -> auto& { return d.motor.constants.inertia; }),
      number<S, Motorised>(
          row(motor_key::viscous_damping, "required",
              "b, motor and gearbox at the output shaft; b_m of the motor with gear_ratio", {}, "3.6e-6 N m s/rad"),
          [](auto& d) -> auto& { return d.motor.constants.viscous_damping; }),
      number<S, Motorised>(
          row(motor_key::friction_torque, "0 N m",
              "constant friction torque of the motor itself, before its gearbox, at the motor shaft with gear_ratio; "
              "in addition to every friction law, and it heats the motor"),
          [](auto& d) -> auto& { return d.motor.constants.friction_torque; }),
      number<S, Motorised>(
          row({"motor.core_torque", "N m", range::not_negative}, "0 N m",
              "c_h, hysteresis of a brushless motor's core: a constant torque against its speed, at the "
              "motor shaft with gear_ratio; counts as the motor's own friction"),
          [](auto& d) -> auto& { return d.motor.core_torque; }),
      number<S, Motorised>(row({"motor.core_damping", "N m s/rad", range::not_negative}, "0 N m s/rad",
                               "c_e, eddy currents of a brushless motor's core: a torque that grows with the speed, at "
                               "the motor shaft with gear_ratio; counts as viscous damping"),
                           [](auto& d) -> auto& { return d.motor.core_damping; }),
      number<S, Weighed>({"motor.mass", "kg", range::not_negative, "none: in vehicle.mass",
                          "mass of one motor with its gearbox, in addition to vehicle.mass"},
                         [](auto& d) -> auto& { return d.masses.motor; }),

      number<S, Motorised>(
          row(motor_thermal_key::resistance_winding, "none: constants the same at any load",
              "R_th1, thermal resistance from winding to case; with it the constants depend on temperature"),
          [](auto& d) -> auto& { return d.motor.thermal.resistance_winding; }),
      number<S, Heated>(
          row(motor_thermal_key::resistance_case, "required", "R_th2, thermal resistance from case to air"),
          [](auto& d) -> auto& { return d.motor.thermal.resistance_case; }),
      number<S, Heated>(row(motor_thermal_key::ambient_temperature, "298.15 K", "T_amb, of the air about the motor"),
                        [](auto& d) -> auto& { return d.motor.thermal.ambient_temperature; }),
      number<S, Heated>(row(motor_thermal_key::reference_temperature, "298.15 K",
                            "T_0 at which armature_resistance and torque_constant are stated"),
                        [](auto& d) -> auto& { return d.motor.thermal.reference_temperature; }),
      number<S, Heated>(row(motor_thermal_key::copper_temperature_coefficient, "0.0039 1/K",
                            "a_Cu: R_a grows as 1 + a_Cu (T_winding - T_0)"),
                        [](auto& d) -> auto& { return d.motor.thermal.copper_temperature_coefficient; }),
      number<S, Heated>(row(motor_thermal_key::magnet_temperature_coefficient, "0 1/K",
                            "a_B: K falls as 1 + a_B (T_case - T_0), about -0.001 1/K of NdFeB"),
                        [](auto& d) -> auto& { return d.motor.thermal.magnet_temperature_coefficient; }),
      number<S, Heated>(row(motor_thermal_key::winding_temperature_max, "398.15 K",
                            "largest winding temperature, from the data sheet: above it a result is outside "
                            "the domain; 125 degC unless given"),
                        [](auto& d) -> auto& { return d.motor.thermal.winding_temperature_max; }),
      number<S, Heated>(row(motor_thermal_key::time_constant_winding, "none",
                            "tau_w, of the winding over the case, for `wingbeat endurance`"),
                        [](auto& d) -> auto& { return d.motor.thermal.time_constant_winding; }),
      number<S, Heated>(row(motor_thermal_key::time_constant_case, "none",
                            "tau_c, of the case over the air, for `wingbeat endurance`"),
                        [](auto& d) -> auto& { return d.motor.thermal.time_constant_case; }),

      number<S, Motorised>(
          row(electronics_key::efficiency, "none: no electronics",
              "eta_esc of a brushless motor's electronics: power into the motor over power from the supply; "
              "given, no current flows back into the supply"),
          [](auto& d) -> auto& { return d.electronics.efficiency; }),
      number<S, Brushless>(
          row(electronics_key::current_max, "none", "i_max to which they limit the current of one motor"),
          [](auto& d) -> auto& { return d.electronics.current_max; }),
      text<S, Brushless>({"electronics.regeneration",
                          "",
                          {"true or false"},
                          "false",
                          "current may flow back: where the back-EMF exceeds the voltage the motor brakes"},
                         [](const D& d) {
                           if (!Brushless::holds(d)) return std::string();
                           return std::string(d.electronics.regenerates ? "true" : "false");
                         }),

      Parameter<S>{row(piezo_key::force_per_volt, "none: a motor",
                       "kappa of a piezo bimorph that replaces the motor: force at its tip per volt"),
                   [](Design<S>& d, const S& x) {
                     d.piezo.force_per_volt = d.piezo.constants.force_per_volt = x;
                     return true;
                   },
                   [](const Design<S>& d) -> std::optional<S> { return d.piezo.force_per_volt; }},
      number<S, PiezoDriven>(
          row(piezo_key::voltage_factor, "0 1/V", "kappa_1: the force grows as kappa (1 + kappa_1 abs(V)) V"),
          [](auto& d) -> auto& { return d.piezo.constants.voltage_factor; }),
      number<S, PiezoDriven>(row(piezo_key::stiffness, "required", "k_a of the bimorph at its tip"),
                             [](auto& d) -> auto& { return d.piezo.constants.stiffness; }),
      number<S, PiezoDriven>(row(piezo_key::damping, "0 N s/m", "c_a of the bimorph at its tip"),
                             [](auto& d) -> auto& { return d.piezo.constants.damping; }),
      number<S, PiezoDriven>(row(piezo_key::mass, "required", "m_a, mass that moves with the tip"),
                             [](auto& d) -> auto& { return d.piezo.constants.mass; }),
      number<S, PiezoDriven>(row(piezo_key::capacitance, "0 F", "C of the bimorph"),
                             [](auto& d) -> auto& { return d.piezo.constants.capacitance; }),
      number<S, PiezoDriven>(row(piezo_key::loss_tangent, "0", "tan d of its dielectric"),
                             [](auto& d) -> auto& { return d.piezo.constants.loss_tangent; }),
      number<S, PiezoDriven>(row(piezo_key::recovered_share, "1",
                                 "share of the energy returned by the capacitance in a cycle that the electronics "
                                 "recover"),
                             [](auto& d) -> auto& { return d.piezo.constants.recovered_share; }),
      number<S, PiezoDriven>(row(piezo_key::transmission_ratio, "required",
                                 "T_1: stroke angle over tip displacement, beta = T_1 x + T_3 x^3"),
                             [](auto& d) -> auto& { return d.piezo.constants.transmission_ratio; }),
      number<S, PiezoDriven>(row(piezo_key::transmission_cubic, "0 rad/m3", "T_3 of the transmission"),
                             [](auto& d) -> auto& { return d.piezo.constants.transmission_cubic; }),
      Parameter<S>{placed<PiezoDriven>(
                       row(piezo_key::series_stiffness, "none: rigid", "k_s between the tip and the transmission")),
                   [](Design<S>& d, const S& x) {
                     if (!PiezoDriven::holds(d)) return false;
                     d.piezo.series_stiffness = d.piezo.constants.series_stiffness = x;
                     return true;
                   },
                   [](const Design<S>& d) -> std::optional<S> { return d.piezo.series_stiffness; }}};
}

}  // namespace wingbeat::detail

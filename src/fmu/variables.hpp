// The variables of a vehicle's FMU: one table for the description and the binary.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::fmu {

/// What a variable is; its number counts within.
enum class VariableKind {
  time,
  state,       ///< as Places counts them, then the sums of exposed_sums
  derivative,  ///< of the states, in their order
  input,       ///< InputId
  output,      ///< OutputId
  mean,        ///< MeanId: of the last whole cycle, held until the next one ends
  count,       ///< CountId: whole numbers
  parameter,   ///< row of the table of parameters
  setting,     ///< SettingId
  text,        ///< row of the table of parameters: a choice, constant
  indicator    ///< of events, in the order of Instance::indicators
};

enum class InputId { voltage, voltage_offset, duty, load_torque };
enum class OutputId {
  crank_angle,
  crank_speed,
  stroke_angle,
  flapping_velocity,
  pitch_angle,
  pitch_velocity,
  current,
  terminal_voltage,
  lift,
  drag_moment,
  rod_force,
  motor_torque,
  friction_torque,
  power_electrical,
  power_motor,
  power_friction,
  power_aerodynamic,
  power_copper,
  power_viscous,
  power_load,
  last
};
enum class MeanId { frequency, lift, current, power_electrical, power_friction, power_aerodynamic, power_copper, last };
enum class CountId { status, cycles };
enum class SettingId { tolerance, angle, speed, current, pitch_angle, pitch_velocity };

/// `status`: 0 before the first whole cycle, 1 flapping, 2 standing, 3 jammed.
enum class Status { starting, flapping, standing, jammed };

/// Which sums of MeasuredModel are states of model exchange: lift, charge, energies.
struct ExposedSum {
  const char* name;
  const char* unit;
  const char* description;
  Integral integral;
};
inline constexpr ExposedSum exposed_sums[] = {
    {"sum_lift", "N.s", "lift, integrated over time", Integral::lift},
    {"sum_current", "A.s", "current, integrated over time", Integral::current},
    {"sum_current_square", "A2.s", "square of the current, integrated over time", Integral::current_square},
    {"sum_power_electrical", "J", "electrical energy taken", Integral::electrical_work},
    {"sum_power_friction", "J", "energy lost in friction", Integral::friction_work},
    {"sum_power_aerodynamic", "J", "energy given to the air", Integral::aero_work}};
inline constexpr std::size_t exposed_sum_count = std::size(exposed_sums);

/// Value references count up to 999 within a kind.
inline std::size_t reference_of(VariableKind kind, std::size_t number) { return 1000 * std::size_t(kind) + number; }

struct Variable {
  VariableKind kind;
  std::size_t number;
  std::string name;
  std::string unit;  ///< as FMUs write it; empty: none
  std::string description;
  std::string causality, variability, initial;  ///< initial empty: the default
  std::optional<double> min, max, nominal;
  std::size_t reference() const { return reference_of(kind, number); }
};

inline VariableKind kind_of(std::size_t reference) { return VariableKind(reference / 1000); }
inline std::size_t number_of(std::size_t reference) { return reference % 1000; }

/// Those that a vehicle has, in the order of their references.
std::vector<Variable> variables_of(const Design<double>& design);

/// What the event indicators of a vehicle's time model watch, in their order.
enum class Watched { standstill, jam, stop, cycle_end, slip_end };
std::vector<Watched> watched_events(const Vehicle<double>& vehicle);

/// True for a parameter that may change while the vehicle flies.
bool is_tunable(std::string_view key);

/// "kg m2" as FMUs write it: "kg.m2".
std::string unit_in_fmu(std::string_view unit);

}  // namespace wingbeat::fmu

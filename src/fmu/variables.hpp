// The variables of a vehicle's FMU: one table for the description and the binary.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fmu/dynamics.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::fmu {

/// What a variable is; its number counts within.
enum class VariableKind {
  time,
  state,       ///< as StateLayout counts them
  derivative,  ///< of the states, in their order
  input,       ///< InputId
  output,      ///< OutputId
  mean,        ///< MeanId: of the last whole cycle, held until the next one ends
  count,       ///< CountId: whole numbers, of which the status is an enumeration
  parameter,   ///< row of the table of parameters
  setting,     ///< SettingId
  text,        ///< row of the table of parameters: a choice, constant
  indicator    ///< of events, in the order of Instance::indicators
};

enum class InputId { voltage, voltage_offset, duty, load_torque, frequency };
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
  power_motor_friction,
  power_load,
  roll_moment,  ///< these of two drives together alone
  pitch_moment,
  yaw_moment,
  last
};
enum class MeanId { frequency, lift, current, power_electrical, power_friction, power_aerodynamic, power_copper, last };
enum class CountId { status, cycles };
enum class SettingId { tolerance, angle, speed, current, pitch_angle, pitch_velocity, hinge_offset };

/// Of a drive: before a whole cycle, in which case the means are 0, and after one; at a standstill.
enum class Status { starting, flapping, standing, jammed };
struct StatusMeaning {
  Status status;
  const char* name;
  const char* meaning;
};
inline constexpr StatusMeaning status_meanings[] = {
    {Status::starting, "starting", "no whole cycle since the start, a standstill or a reversal"},
    {Status::flapping, "flapping", "the means are those of the last whole cycle"},
    {Status::standing, "standing", "at a standstill"},
    {Status::jammed, "jammed", "the mechanism has jammed"}};

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
    {"sum_speed_square", "rad2/s", "square of the speed of crank or shaft, integrated over time",
     Integral::speed_square},
    {"sum_power_electrical", "J", "electrical energy taken", Integral::electrical_work},
    {"sum_power_friction", "J", "energy lost in friction of the transmission", Integral::friction_work},
    {"sum_power_aerodynamic", "J", "energy given to the air", Integral::aero_work}};
inline constexpr std::size_t exposed_sum_count = std::size(exposed_sums);

/// Unknowns of a drive as states of model exchange: those of the time model as UnknownIndices counts them, the phase of
/// the supply where it is a sine that drives the wings directly, the sums of exposed_sums.
struct StateLayout {
  UnknownIndices indices;
  bool has_phase;

  explicit StateLayout(const Vehicle<double>& vehicle) : indices(vehicle), has_phase(!indices.rotates) {}
  std::size_t phase() const { return indices.count; }
  std::size_t first_sum() const { return indices.count + (has_phase ? 1 : 0); }
  std::size_t count() const { return first_sum() + exposed_sum_count; }
};

/// A vehicle with two motors has two drives that move each for itself, the left and the right one: sides 1 and 2, and
/// side 0 is both together. Of any other vehicle everything is one drive, side 0.
inline bool has_two_drives(const Design<double>& design) { return design.motors == 2.0; }
inline constexpr const char* side_names[] = {"", "_left", "_right"};
/// A body's variables are those of this side, by numbers of their own.
inline constexpr std::size_t body_side = 3;
/// A drive of the vehicle as it is switched on. Of two, each is on half of the supply: with twice its resistance both
/// draw alike what the whole vehicle draws.
Vehicle<double> drive_vehicle(const Design<double>& design, bool one_of_two);

/// Value references count up to 999 within a kind; of what a drive has, by hundreds, the sides.
inline std::size_t reference_of(VariableKind kind, std::size_t number, std::size_t side = 0) {
  return 1000 * std::size_t(kind) + 100 * side + number;
}

struct Variable {
  VariableKind kind;
  std::size_t number;
  std::string name;
  std::string unit;  ///< as FMUs write it; empty: none
  std::string description;
  std::string causality, variability, initial;  ///< initial empty: the default
  std::optional<double> min, max;
  std::size_t side = 0;
  std::string display_unit{};  ///< that a display shows it in; empty: none beside the unit
  std::size_t reference() const { return reference_of(kind, number, side); }
  bool is_status() const { return kind == VariableKind::count && CountId(number) == CountId::status; }
};

inline VariableKind kind_of(std::size_t reference) { return VariableKind(reference / 1000); }
/// Within a kind that knows no sides.
inline std::size_t number_of(std::size_t reference) { return reference % 1000; }
/// Of what a drive has.
inline std::size_t side_of(std::size_t reference) { return number_of(reference) / 100; }
inline std::size_t index_of(std::size_t reference) { return number_of(reference) % 100; }

/// Outputs and means that two drives together have.
bool has_total(OutputId output);
bool has_total(MeanId mean);

/// Those that a vehicle has, by their kinds.
std::vector<Variable> variables_of(const Design<double>& design);

/// What the event indicators of a drive watch, in their order. They do not depend on what parameters can change.
enum class Watched { standstill, jam, stop, cycle_end, slip_end, rest };
std::vector<Watched> watched_events(const Vehicle<double>& vehicle);

/// True for a parameter that may change while the vehicle flies.
bool is_tunable(std::string_view key);

/// The unit of a rate: "m/s" to "m/s2".
std::string unit_of_rate(const std::string& unit);
/// What a quantity is shown in; empty: nothing beside its unit.
std::string display_unit_of(const std::string& name, const std::string& unit);

/// "kg m2" as FMUs write it: "kg.m2".
std::string unit_in_fmu(std::string_view unit);

/// A unit that displays may show values in: value_in_it = factor * value + offset.
struct DisplayUnit {
  const char* unit;
  const char* name;
  double factor, offset;
};
inline constexpr DisplayUnit display_units[] = {{"rad", "deg", degrees_per_radian, 0.0},
                                                {"rad/s", "rpm", 60.0 / two_pi, 0.0},
                                                {"rad/s", "deg/s", degrees_per_radian, 0.0},
                                                {"K", "degC", 1.0, -273.15},
                                                {"m", "mm", 1e3, 0.0},
                                                {"kg", "g", 1e3, 0.0},
                                                {"N", "mN", 1e3, 0.0},
                                                {"N.m", "mN.m", 1e3, 0.0},
                                                {"H", "mH", 1e3, 0.0}};

}  // namespace wingbeat::fmu

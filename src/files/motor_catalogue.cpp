#include "files/motor_catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "files/part_list.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

/// What manufacturers and collections call the columns.
constexpr ColumnAlias aliases[] = {{"type", "model"},
                                   {"motor", "model"},
                                   {"part_number", "model"},
                                   {"ratio", "gear_ratio"},
                                   {"reduction", "gear_ratio"},
                                   {"r", "armature_resistance"},
                                   {"resistance", "armature_resistance"},
                                   {"terminal_resistance", "armature_resistance"},
                                   {"phase_to_phase_resistance", "armature_resistance"},
                                   {"k_t", "torque_constant"},
                                   {"kt", "torque_constant"},
                                   {"k_m", "torque_constant"},
                                   {"l", "armature_inductance"},
                                   {"inductance", "armature_inductance"},
                                   {"terminal_inductance", "armature_inductance"},
                                   {"rotor_inertia", "inertia"},
                                   {"j", "inertia"},
                                   {"coulomb_friction", "friction_torque"},
                                   {"viscous_friction", "viscous_damping"},
                                   {"weight", "mass"},
                                   {"i_0", "no_load_current"},
                                   {"i0", "no_load_current"},
                                   {"n_0", "no_load_speed"},
                                   {"n0", "no_load_speed"},
                                   {"rated_current", "nominal_current"},
                                   {"continuous_current", "nominal_current"},
                                   {"max_continuous_current", "nominal_current"},
                                   {"maximum_continuous_current", "nominal_current"},
                                   {"max_speed", "speed_max"},
                                   {"maximum_speed", "speed_max"},
                                   {"max_permissible_speed", "speed_max"},
                                   {"limiting_speed", "speed_max"},
                                   {"rth1", "thermal_resistance_winding"},
                                   {"rth2", "thermal_resistance_case"}};

/// Headers of the Motor-Gearbox Database.
constexpr PlainHeader plain_headers[] = {{"key", "model"},
                                         {"k_t", "torque_constant"},
                                         {"R", "armature_resistance"},
                                         {"L", "armature_inductance"},
                                         {"mass", "mass"},
                                         {"inertia", "inertia"},
                                         {"omega_nl", "no_load_speed"},
                                         {"I_nl", "no_load_current"},
                                         {"I_nom", "nominal_current"},
                                         {"max_cont_speed", "speed_max"},
                                         {"coulomb_friction", "friction_torque"},
                                         {"viscous_friction", "viscous_damping"},
                                         {"Rth1", "thermal_resistance_winding"},
                                         {"Rth2", "thermal_resistance_case"}};

const PartColumns& motor_columns() {
  static const PartColumns columns = {
      "motors",
      {{"model", "model", ""},
       {"gear_ratio", "gear_ratio", "1"},
       {"armature_resistance", "resistance_ohm", "ohm"},
       {"torque_constant", "torque_constant_Nm_per_A", "N m/A"},
       {"inertia", "rotor_inertia_kgm2", "kg m2"},
       {"armature_inductance", "inductance_H", "H"},
       {"friction_torque", "friction_torque_Nm", "N m"},
       {"viscous_damping", "viscous_friction_Nms", "N m s/rad"},
       {"mass", "mass_kg", "kg"},
       {"no_load_current", "no_load_current_A", "A"},
       {"no_load_speed", "no_load_speed_rad_s", "rad/s"},
       {"nominal_current", "nominal_current_A", "A"},
       {"speed_max", "speed_max_rad_s", "rad/s"},
       {"thermal_resistance_winding", "Rth1_K_per_W", "K/W"},
       {"thermal_resistance_case", "Rth2_K_per_W", "K/W"}},
      aliases,
      plain_headers,
      {"model", "armature_resistance", "torque_constant", "inertia", "armature_inductance"}};
  return columns;
}

/// A row as a vehicle, or what it lacks.
template <class Number>
MotorCandidate candidate(const std::string& model, const Number& number, double gear, std::optional<double> rest,
                         const Design<double>& design) {
  MotorCandidate motor{one_line(model), "", {}, design, {}};
  const auto resistance = number("armature_resistance"), constant = number("torque_constant");
  const auto inertia = number("inertia"), inductance = number("armature_inductance");
  const auto mass = number("mass");
  // Heat is a choice of the vehicle; the resistances are the motor's own.
  MotorThermalDesign<double>& thermal = motor.design.motor.thermal;
  const bool heats = thermal.resistance_winding.has_value();
  if (heats) {
    thermal.resistance_winding = number("thermal_resistance_winding");
    thermal.resistance_case = number("thermal_resistance_case");
  }
  std::string lacks;
  const auto need_value = [&](const std::optional<double>& x, const char* what) {
    if (!x) lacks += fmt::format("{}{}", lacks.empty() ? "" : ", ", what);
  };
  need_value(resistance, "armature resistance");
  need_value(constant, "torque constant");
  need_value(inertia, "rotor inertia");
  need_value(inductance, "inductance");
  if (heats) {
    need_value(thermal.resistance_winding, "thermal resistance of the winding");
    need_value(thermal.resistance_case, "thermal resistance of the case");
  }
  const bool weighed = rest || design.masses.motor;
  if (weighed) need_value(mass, "mass");
  if (!lacks.empty()) {
    motor.refused = "incomplete, no " + lacks;
    return motor;
  }
  auto& c = motor.design.motor.constants;
  c.armature_resistance = *resistance;
  c.torque_constant = *constant;
  c.inertia = *inertia;
  c.armature_inductance = *inductance;
  c.friction_torque = number("friction_torque").value_or(0.0);
  const auto no_load_current = number("no_load_current"), no_load_speed = number("no_load_speed");
  if (const auto damping = number("viscous_damping")) {
    c.viscous_damping = *damping;
  } else if (no_load_current && no_load_speed) {
    // At no load the motor's torque covers its own friction alone.
    const double rest_of_torque = *constant * *no_load_current - c.friction_torque;
    c.viscous_damping = std::max(0.0, rest_of_torque) / *no_load_speed;
    motor.derived.push_back(fmt::format("b = {:.2g} N m s/rad from the no-load current", c.viscous_damping));
  } else {
    motor.refused = "incomplete, neither viscous friction nor no-load current and speed";
    return motor;
  }
  // A gearmotor's sheet states its output shaft; a bare motor gets the study's gearbox.
  const double own = number("gear_ratio").value_or(1.0);
  if (own == 1.0) motor.design.motor.gear_ratio = gear;
  else motor.design.motor.gear_ratio.reset();
  motor.design.motor.gear_inertia = 0.0;
  motor.design.motor.gear_damping = 0.0;
  motor.nominal_current = number("nominal_current");
  if (rest) motor.design.mass = rest;
  if (weighed) motor.design.masses.motor = mass;
  try {
    validate(motor.design);
  } catch (const ParameterError& error) {
    motor.refused = error.what();
  }
  return motor;
}

}  // namespace

const std::vector<NamedColumn>& catalogue_columns() { return motor_columns().columns; }

std::vector<MotorCandidate> parse_motor_catalogue(std::string_view text, const std::string& name, double gear,
                                                  std::optional<double> rest, const Design<double>& design,
                                                  const StatedTable& stated) {
  const PartList list(text, name, stated, motor_columns());
  std::vector<MotorCandidate> motors;
  for (const TableLine& row : list.rows()) {
    const auto number = [&](std::string_view column) { return list.number(row, column); };
    motors.push_back(candidate(list.text(row, "model"), number, gear, rest, design));
    motors.back().speed_max = list.limit(row, "speed_max");
  }
  return motors;
}

}  // namespace wingbeat::detail

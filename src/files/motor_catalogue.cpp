#include "files/motor_catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "files/csv_cells.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    else if (c == ',' && !quoted) cells.emplace_back();
    else if (c != '\r') cells.back() += c;
  }
  return cells;
}

/// A row as a vehicle, or what it lacks.
template <class Number>
MotorCandidate candidate(const std::string& model, const Number& number, double gear, std::optional<double> rest,
                         const Design<double>& design) {
  MotorCandidate motor{one_line(model), "", {}, design};
  const auto resistance = number("resistance_ohm"), constant = number("torque_constant_Nm_per_A");
  const auto inertia = number("rotor_inertia_kgm2"), inductance = number("inductance_H");
  const auto mass = number("mass_kg");
  // Heat is a choice of the vehicle; the resistances are the motor's own.
  MotorThermalDesign<double>& thermal = motor.design.motor.thermal;
  const bool heats = thermal.resistance_winding.has_value();
  if (heats) {
    thermal.resistance_winding = number("Rth1_K_per_W");
    thermal.resistance_case = number("Rth2_K_per_W");
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
  c.friction_torque = number("friction_torque_Nm").value_or(0.0);
  const auto no_load_current = number("no_load_current_A"), no_load_speed = number("no_load_speed_rad_s");
  if (const auto damping = number("viscous_friction_Nms")) {
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

std::vector<MotorCandidate> parse_motor_catalogue(std::string_view text, const std::string& name, double gear,
                                                  std::optional<double> rest, const Design<double>& design) {
  std::vector<MotorCandidate> motors;
  std::vector<std::string> header;
  int line_number = 0;
  const auto refuse_there = [&](const std::string& key, const std::string& message) {
    throw InputError(name, line_number, 1, key, message);
  };
  for (std::string_view line; next_line(text, line, line_number);) {
    if (is_blank_or_comment(line)) continue;
    const std::vector<std::string> cells = cells_of(line);
    if (header.empty()) {
      header = cells;
      for (const char* needed : {"model", "gear_ratio", "resistance_ohm", "torque_constant_Nm_per_A",
                                 "rotor_inertia_kgm2", "inductance_H"}) {
        if (std::find(header.begin(), header.end(), needed) == header.end()) {
          refuse_there(needed, "missing; expected a column of that name");
        }
      }
      continue;
    }
    if (cells.size() != header.size()) {
      refuse_there("", fmt::format("expected {} cells, got {}", header.size(), cells.size()));
    }
    const auto cell = [&](std::string_view column) -> std::string {
      const auto found = std::find(header.begin(), header.end(), column);
      return found == header.end() ? "" : cells[std::size_t(found - header.begin())];
    };
    const auto number = [&](std::string_view column) -> std::optional<double> {
      const std::string content = cell(column);
      if (content.find_first_not_of(" \t") == std::string::npos) return std::nullopt;
      try {
        return parse_quantity(content, "1");
      } catch (const UnitError&) {
        refuse_there(std::string(column), fmt::format("expected a number, got {}", in_quotes(content)));
      }
      return std::nullopt;
    };
    motors.push_back(candidate(cell("model"), number, gear, rest, design));
  }
  return motors;
}

}  // namespace wingbeat::detail

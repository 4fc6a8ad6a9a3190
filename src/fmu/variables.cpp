#include "fmu/variables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmu/body_variables.hpp"
#include "fmu/dynamics.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::fmu {
namespace {

constexpr double least_positive = std::numeric_limits<double>::min();

struct Row {
  const char* name;
  const char* unit;
  const char* description;
};

constexpr Row output_rows[] = {
    {"crank_angle", "rad", "crank angle, not wrapped"},
    {"crank_speed", "rad/s", "crank speed"},
    {"stroke_angle", "rad", "stroke angle"},
    {"flapping_velocity", "rad/s", "rate of the stroke angle"},
    {"pitch_angle", "rad", "pitch angle of the wings, 0 with the chord upright"},
    {"pitch_velocity", "rad/s", "rate of the pitch angle"},
    {"current", "A", "armature current of all motors"},
    {"terminal_voltage", "V", "voltage at the motor terminals"},
    {"lift", "N", "lift of all wings"},
    {"drag_moment", "N.m", "moment of the air on all wings about their hinges"},
    {"rod_force", "N", "force in one rod, positive as it raises the stroke angle"},
    {"motor_torque", "N.m", "motor torque on crank or shaft"},
    {"friction_torque", "N.m", "friction torque of the transmission on crank or shaft"},
    {"power_electrical", "W", "electrical input power"},
    {"power_motor", "W", "motor output power, behind its gearbox and its own friction"},
    {"power_friction", "W", "friction loss of the transmission"},
    {"power_aerodynamic", "W", "power given to the air"},
    {"power_copper", "W", "loss in the armature resistance"},
    {"power_viscous", "W", "viscous loss of the motor"},
    {"power_motor_friction", "W", "loss in the motor's own constant friction"},
    {"power_load", "W", "power given to the external load"},
    {"roll_moment", "N.m", "moment of the air on the body, positive with the right wing down"},
    {"pitch_moment", "N.m", "moment of the air on the body, positive with the nose up"},
    {"yaw_moment", "N.m", "moment of the air on the body, positive with the nose to the right"}};
static_assert(std::size(output_rows) == std::size_t(OutputId::last));

constexpr Row mean_rows[] = {{"frequency_mean", "Hz", "flapping frequency"},
                             {"lift_mean", "N", "mean lift"},
                             {"current_mean", "A", "mean current"},
                             {"power_electrical_mean", "W", "mean electrical power"},
                             {"power_friction_mean", "W", "mean friction loss of the transmission"},
                             {"power_aerodynamic_mean", "W", "mean power given to the air"},
                             {"power_copper_mean", "W", "mean loss in the armature resistance"}};
static_assert(std::size(mean_rows) == std::size_t(MeanId::last));

bool has_output(OutputId which, const UnknownIndices& indices) {
  switch (which) {
    case OutputId::crank_angle:
    case OutputId::crank_speed:
    case OutputId::rod_force: return indices.rotates;
    case OutputId::pitch_angle:
    case OutputId::pitch_velocity: return indices.pitching;
    case OutputId::roll_moment:
    case OutputId::pitch_moment:
    case OutputId::yaw_moment: return false;
    default: return true;
  }
}

std::vector<Row> state_rows(const StateLayout& layout) {
  const UnknownIndices& indices = layout.indices;
  std::vector<Row> rows(indices.count);
  rows[0] = indices.rotates ? Row{"state_crank_angle", "rad", "crank angle, not wrapped"}
                            : Row{"state_stroke_angle", "rad", "stroke angle"};
  rows[1] = indices.rotates ? Row{"state_crank_speed", "rad/s", "crank speed"}
                            : Row{"state_flapping_velocity", "rad/s", "rate of the stroke angle"};
  if (indices.inductive) rows[indices.current] = {"state_current", "A", "armature current of all motors"};
  if (indices.pitching) {
    rows[indices.pitch] = {"state_pitch_angle", "rad", "pitch angle of the wings"};
    rows[indices.pitch + 1] = {"state_pitch_velocity", "rad/s", "rate of the pitch angle"};
  }
  if (layout.has_phase) rows.push_back({"state_supply_phase", "rad", "phase of the supply, not wrapped"});
  for (const ExposedSum& sum : exposed_sums) rows.push_back({sum.name, sum.unit, sum.description});
  return rows;
}

std::string flat(std::string_view key) {
  std::string name(key);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

class Table {
 public:
  std::vector<Variable> variables;
  std::size_t side = 0;  ///< of what is added

  Variable& add(VariableKind kind, std::size_t number, const std::string& name, const std::string& unit,
                const std::string& description, const char* causality, const char* variability,
                const char* initial = "") {
    variables.push_back({kind,
                         number,
                         name + side_names[side],
                         unit,
                         description + meanings[side],
                         causality,
                         variability,
                         initial,
                         {},
                         {},
                         side,
                         display_unit_of(name, unit)});
    return variables.back();
  }

 private:
  static constexpr const char* meanings[] = {"", ", left", ", right"};
};

void add_inputs(Table& table, const Design<double>& design) {
  const auto add = [&](InputId id, const char* name, const char* unit, const char* description,
                       const char* variability = "continuous") -> Variable& {
    return table.add(VariableKind::input, std::size_t(id), name, unit, description, "input", variability);
  };
  const bool sine = is_sine(design.supply.type), pwm = design.supply.type == SupplyType::pwm;
  add(InputId::voltage, "voltage", "V",
      sine  ? "amplitude of the sine that drives the motors"
      : pwm ? "voltage while switched on"
            : "voltage that drives the motors, before the resistance of the supply",
      pwm ? "discrete" : "continuous");
  if (sine) add(InputId::voltage_offset, "voltage_offset", "V", "added to the sine");
  if (sine)
    add(InputId::frequency, "frequency", "Hz", "of the sine, whose phase stays continuous").min = least_positive;
  if (pwm) {
    Variable& duty = add(InputId::duty, "duty", "1", "part of a switching period that is on", "discrete");
    duty.min = 0.0, duty.max = 1.0;
  }
  add(InputId::load_torque, "load_torque", "N.m", "torque of a load on crank or shaft, against a positive speed");
}

void add_parameters(Table& table, const Design<double>& design) {
  const auto rows = parameter_table<double>();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const Parameter<double>& p = rows[row];
    if (!p.get || !p.get(design)) continue;
    const bool tunable = is_tunable(p.path);
    Variable& v = table.add(VariableKind::parameter, row, flat(p.path), unit_in_fmu(p.unit), std::string(p.meaning),
                            "parameter", tunable ? "tunable" : "fixed", "exact");
    // Bounds that are not allowed themselves lie a little inside.
    constexpr double below = 1.0 - 1e-15;
    if (std::isfinite(p.range.lower))
      v.min = p.range.above_lower && p.range.lower == 0.0 ? least_positive : p.range.lower;
    if (std::isfinite(p.range.upper)) v.max = p.range.upper * (p.range.below_upper ? below : 1.0);
    if (p.path == "vehicle.motors" && has_two_drives(design)) v.min = v.max = 2.0;
  }
  const UnknownIndices indices(resolve(design));
  const auto setting = [&](SettingId id, const char* name, const char* unit, const char* description) -> Variable& {
    return table.add(VariableKind::setting, std::size_t(id), name, unit, description, "parameter", "fixed", "exact");
  };
  Variable& tolerance =
      setting(SettingId::tolerance, "solver_tolerance", "1", "relative error of a step, co-simulation");
  tolerance.min = 1e-12;
  tolerance.max = 1e-2;
  setting(SettingId::angle, "initial_angle", "rad", "crank angle, of a direct drive stroke angle, at the start");
  setting(SettingId::speed, "initial_speed", "rad/s", "its rate at the start");
  if (indices.inductive) setting(SettingId::current, "initial_current", "A", "armature current at the start");
  if (indices.pitching) {
    setting(SettingId::pitch_angle, "initial_pitch_angle", "rad", "pitch angle at the start");
    setting(SettingId::pitch_velocity, "initial_pitch_velocity", "rad/s", "its rate at the start");
  }
  if (has_two_drives(design) && !has_body(design)) {
    setting(SettingId::hinge_offset, "hinge_offset", "m",
            "from the middle plane of the body to either stroke axis, of the moments on the body")
        .min = 0.0;
  }
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const Parameter<double>& p = rows[row];
    if (p.get || !p.text || p.text(design).empty()) continue;
    table.add(VariableKind::text, row, flat(p.path), "", std::string(p.meaning), "local", "constant", "exact");
  }
}

}  // namespace

std::string display_unit_of(const std::string& name, const std::string& unit) {
  const bool turns = name.find("crank") != std::string::npos || name == "initial_speed";
  for (const DisplayUnit& d : display_units) {
    if (unit == d.unit && (unit != "rad/s" || (std::string_view(d.name) == "rpm") == turns)) return d.name;
  }
  return {};
}

std::string unit_of_rate(const std::string& unit) {
  if (unit == "J") return "W";
  if (unit.ends_with(".s")) return unit.substr(0, unit.size() - 2);
  if (unit.ends_with("/s")) return unit.substr(0, unit.size() - 2) + "/s2";
  return unit + "/s";
}

bool is_tunable(std::string_view key) {
  // What wears, warms up, is adjusted or changes with the weather. Geometry and inertia do not, nor what decides which
  // states there are.
  constexpr std::string_view keys[] = {"motor.armature_resistance",
                                       "motor.torque_constant",
                                       "motor.viscous_damping",
                                       "friction.radius",
                                       "friction.damping",
                                       "friction.coefficient",
                                       "spring.stiffness",
                                       "aerodynamics.air_density",
                                       "aerodynamics.pitch_coefficient",
                                       "pitch.stiffness",
                                       "pitch.damping",
                                       "supply.internal_resistance"};
  return std::find(std::begin(keys), std::end(keys), key) != std::end(keys);
}

std::vector<Watched> watched_events(const Vehicle<double>& v) {
  const UnknownIndices indices(v);
  std::vector<Watched> events;
  if (indices.rotates) events = {Watched::standstill, Watched::jam};
  if (indices.pitching && has_stop(v.pitch.hinge)) events.push_back(Watched::stop);
  events.push_back(Watched::cycle_end);
  if (indices.rotates) events.push_back(Watched::rest);
  if (!indices.rotates) events.push_back(Watched::slip_end);
  return events;
}

Vehicle<double> drive_vehicle(const Design<double>& design, bool one_of_two) {
  if (!one_of_two) return switched_on(resolve(design));
  Design<double> half = design;
  half.motors = 1.0;
  Vehicle<double> vehicle = switched_on(resolve(half));
  vehicle.source_resistance *= design.motors;
  return vehicle;
}

bool has_total(OutputId output) {
  switch (output) {
    case OutputId::current:
    case OutputId::lift:
    case OutputId::power_electrical:
    case OutputId::power_motor:
    case OutputId::power_friction:
    case OutputId::power_aerodynamic:
    case OutputId::power_copper:
    case OutputId::power_viscous:
    case OutputId::power_motor_friction:
    case OutputId::power_load:
    case OutputId::roll_moment:
    case OutputId::pitch_moment:
    case OutputId::yaw_moment: return true;
    default: return false;
  }
}
bool has_total(MeanId mean) { return mean != MeanId::frequency; }

std::string unit_in_fmu(std::string_view unit) {
  std::string text;
  for (const char c : unit) text += c == ' ' ? '.' : c;
  return text;
}

std::vector<Variable> variables_of(const Design<double>& design) {
  const Vehicle<double> vehicle = drive_vehicle(design, has_two_drives(design));
  const StateLayout layout(vehicle);
  const UnknownIndices& indices = layout.indices;
  const bool two = has_two_drives(design), flies = has_body(design);
  const std::size_t first = two ? 1 : 0, last = two ? 2 : 0;
  Table table;
  const auto on_sides = [&](const auto& add) {
    for (table.side = first; table.side <= last; ++table.side) add();
    table.side = 0;
  };
  const auto output = [&](std::size_t k) {
    const Row& row = output_rows[k];
    table.add(VariableKind::output, k, row.name, row.unit, row.description, "output", "continuous", "calculated");
  };
  const auto mean = [&](std::size_t k) {
    const Row& row = mean_rows[k];
    table.add(VariableKind::mean, k, row.name, row.unit, std::string(row.description) + " of the last whole cycle",
              "output", "discrete", "calculated");
  };
  const auto of_body = [&](VariableKind kind) {
    if (!flies) return;
    for (Variable& v : body_variables(design, kind)) table.variables.push_back(std::move(v));
  };
  table.add(VariableKind::time, 0, "time", "s", "simulation time", "independent", "continuous");
  const std::vector<Row> states = state_rows(layout);
  on_sides([&] {
    for (std::size_t k = 0; k < states.size(); ++k) {
      table.add(VariableKind::state, k, states[k].name, states[k].unit, states[k].description, "local", "continuous",
                "calculated");
    }
  });
  of_body(VariableKind::state);
  on_sides([&] {
    for (std::size_t k = 0; k < states.size(); ++k) {
      Variable& rate = table.add(VariableKind::derivative, k, states[k].name, unit_of_rate(states[k].unit),
                                 std::string("rate of ") + states[k].name, "local", "continuous", "calculated");
      rate.name = "der(" + rate.name + ")";
    }
  });
  of_body(VariableKind::derivative);
  on_sides([&] { add_inputs(table, design); });
  of_body(VariableKind::input);
  for (std::size_t k = 0; two && k < std::size(output_rows); ++k) {
    // A body has its own moments.
    if (has_total(OutputId(k)) && !(flies && OutputId(k) >= OutputId::roll_moment)) output(k);
  }
  on_sides([&] {
    for (std::size_t k = 0; k < std::size(output_rows); ++k) {
      if (has_output(OutputId(k), indices)) output(k);
    }
  });
  of_body(VariableKind::output);
  for (std::size_t k = 0; two && k < std::size(mean_rows); ++k) {
    if (has_total(MeanId(k))) mean(k);
  }
  on_sides([&] {
    for (std::size_t k = 0; k < std::size(mean_rows); ++k) mean(k);
    table.add(VariableKind::count, std::size_t(CountId::status), "status", "", "of the motion", "output", "discrete",
              "calculated");
    table.add(VariableKind::count, std::size_t(CountId::cycles), "cycles", "",
              "whole cycles since the start, in either direction", "output", "discrete", "calculated");
  });
  add_parameters(table, design);
  of_body(VariableKind::setting);
  on_sides([&] {
    for (std::size_t k = 0; k < watched_events(vehicle).size(); ++k) {
      table.add(VariableKind::indicator, k, "event_indicator_" + std::to_string(k + 1), "1",
                "positive until an event of the motion happens", "local", "continuous", "calculated");
    }
  });
  return table.variables;
}

}  // namespace wingbeat::fmu

#include "fmu/body_variables.hpp"

#include <span>
#include <string>

namespace wingbeat::fmu {
namespace {

struct BodyKind {
  std::span<const BodyRow> rows;
  const char* causality;
  const char* variability;
  const char* initial;
};

BodyKind kind_of_body(VariableKind kind) {
  switch (kind) {
    case VariableKind::input: return {body_input_rows, "input", "continuous", ""};
    case VariableKind::output: return {body_output_rows, "output", "continuous", "calculated"};
    case VariableKind::setting: return {body_setting_rows, "parameter", "fixed", "exact"};
    default: return {body_state_rows, "local", "continuous", "calculated"};
  }
}

}  // namespace

std::vector<Variable> body_variables(const Design<double>& design, VariableKind kind) {
  const BodyKind all = kind_of_body(kind);
  const FlightVehicle vehicle = flight_vehicle(design);
  const bool derivative = kind == VariableKind::derivative;
  std::vector<Variable> found;
  for (std::size_t k = 0; k < all.rows.size(); ++k) {
    const bool control = kind == VariableKind::input && k >= first_body_control;
    if (control && !vehicle.has(body_controls[k - first_body_control])) continue;
    const BodyRow& row = all.rows[k];
    Variable v{kind,
               k,
               row.name,
               row.unit,
               row.description,
               all.causality,
               all.variability,
               all.initial,
               {},
               {},
               body_side,
               display_unit_of(row.name, row.unit)};
    if (derivative) {
      v.name = std::string("der(") + row.name + ")";
      v.unit = unit_of_rate(row.unit);
      v.description = std::string("rate of ") + row.name;
      v.display_unit = display_unit_of(row.name, v.unit);
    }
    if (control) {
      const ControlRange& range = vehicle.ranges[std::size_t(body_controls[k - first_body_control])];
      v.min = range.low, v.max = range.high;
    }
    found.push_back(std::move(v));
  }
  return found;
}

}  // namespace wingbeat::fmu

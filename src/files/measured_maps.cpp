#include "files/measured_maps.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "files/measured_line.hpp"

namespace wingbeat::detail {
namespace {

const AllocationColumn& column_of(const TomlFields& map) {
  std::vector<std::string_view> names;
  for (const AllocationColumn& c : allocation_columns) names.push_back(c.name);
  const std::string name = map.choice("gives", names);
  return *std::find_if(std::begin(allocation_columns), std::end(allocation_columns),
                       [&](const AllocationColumn& c) { return name == c.name; });
}

}  // namespace

MapsProblem read_maps(const TomlFields& plan, const MeasuredTable& table, Design<double> design, ValidationSet& set) {
  MapsProblem problem;
  problem.design = std::move(design);
  problem.hinge_offset = plan.needed_quantity("hinge_offset", "m");
  if (problem.hinge_offset < 0.0) plan.refuse(plan.at("hinge_offset"), "hinge_offset", "must be >= 0 m");
  for (const TomlFields& map : plan.tables("map")) {
    const std::string_view keys[] = {"quantity", "unit", "input",           "gives",          "slope",
                                     "zero",     "at",   "input_per_value", "value_per_value"};
    map.known_keys(keys);
    const AllocationColumn& column = column_of(map);
    const MeasuredLine line = read_line(map, table);
    MapsProblem::Map found{map.choice<AllocationInput>("input"), column.member, factor_of(map, "value_per_value")};
    found.per_value *= unit_of_map(map, line.quantity, column.unit);
    const bool voltage = found.input == AllocationInput::voltage;
    if (!voltage && !(problem.design.transmission.type == TransmissionType::direct && problem.design.motors == 2.0)) {
      map.refuse(map.at("input"), "input", "needs a vehicle of two motors on direct drives");
    }
    const double per_value = factor_of(map, "input_per_value");
    for (const double x : line.inputs) problem.inputs.push_back(per_value * x);
    add_points(line, unit_of(found.input), set);
    problem.maps.push_back(found);
  }
  if (problem.maps.empty()) plan.refuse("map", "missing; expected [[validation.map]]");
  set.split = ValidationSplit::none;
  set.position_name = "Command over the largest one shown";
  return problem;
}

}  // namespace wingbeat::detail

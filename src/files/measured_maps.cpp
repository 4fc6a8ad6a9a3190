#include "files/measured_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

const AllocationColumn& column_of(const TomlFields& map) {
  std::vector<std::string_view> names;
  for (const AllocationColumn& c : allocation_columns) names.push_back(c.name);
  const std::string name = map.choice("gives", names);
  return *std::find_if(std::begin(allocation_columns), std::end(allocation_columns),
                       [&](const AllocationColumn& c) { return name == c.name; });
}

/// A number other than 0, 1 unless given.
double factor(const TomlFields& map, std::string_view key) {
  if (!map.has(key)) return 1.0;
  const double x = map.needed_quantity(key, "1");
  if (x == 0.0) map.refuse(map.at(key), key, "must not be 0");
  return x;
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
    const ComparedQuantity quantity{map.needed_text("quantity", "what is compared, in words"),
                                    map.needed_text("unit", "its unit")};
    MapsProblem::Map found{map.choice<AllocationInput>("input"), column.member, factor(map, "value_per_value")};
    try {
      found.per_value *= unit_factor(quantity.unit, column.unit);
    } catch (const UnitError& error) {
      map.refuse(map.at("unit"), "unit", error.what());
    }
    const bool voltage = found.input == AllocationInput::voltage;
    if (!voltage && !(problem.design.transmission.type == TransmissionType::direct && problem.design.motors == 2.0)) {
      map.refuse(map.at("input"), "input", "needs a vehicle of two motors on direct drives");
    }
    const double slope = table.named(map, "slope", map.needed_text("slope", "a quantity of the rows"));
    const double zero =
        map.has("zero") ? table.named(map, "zero", map.needed_text("zero", "a quantity of the rows")) : 0.0;
    const double per_value = factor(map, "input_per_value");
    const TomlNode& inputs = map.at("at");
    const char* expected = "expected a list of inputs > 0";
    if (!map.has("at") || inputs.kind != TomlNode::Kind::array || inputs.items.empty()) {
      map.refuse(inputs, "at", expected);
    }
    double largest = 0.0;
    for (const TomlNode& item : inputs.items) {
      if (item.kind != TomlNode::Kind::number || !(item.number > 0.0)) map.refuse(item, "at", expected);
      largest = std::max(largest, item.number);
    }
    for (const TomlNode& item : inputs.items) {
      const double x = item.number;
      const std::string unit = unit_of(found.input);
      set.points.push_back({fmt::format("{:g}{}", x, unit == "1" ? "" : " " + unit), x / largest, set.quantities.size(),
                            slope * (x - zero)});
      problem.inputs.push_back(per_value * x);
    }
    set.quantities.push_back(quantity);
    problem.maps.push_back(found);
  }
  if (problem.maps.empty()) plan.refuse("map", "missing; expected [[validation.map]]");
  set.split = ValidationSplit::none;
  set.position_name = "Command over the largest one shown";
  return problem;
}

}  // namespace wingbeat::detail

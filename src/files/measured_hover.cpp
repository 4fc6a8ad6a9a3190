#include "files/measured_hover.hpp"

#include <string>
#include <utility>

#include "files/measured_line.hpp"
#include "wingbeat/study/flight_numbers.hpp"

namespace wingbeat::detail {

FlightProblem read_hover(const TomlFields& plan, const MeasuredTable& table, const Design<double>& design,
                         ValidationSet& set) {
  FlightProblem problem;
  try {
    problem.vehicle = flight_vehicle(design);
  } catch (const ParameterError& error) {
    plan.refuse(plan.at("vehicle"), "vehicle", error.what());
  }
  for (const TomlFields& value : plan.tables("value")) {
    const std::string_view keys[] = {"quantity", "unit", "gives", "row"};
    value.known_keys(keys);
    const ComparedQuantity quantity{value.needed_text("quantity", "what is compared, in words"),
                                    value.needed_text("unit", "its unit")};
    const auto gives = value.choice<FlightNumber>("gives");
    problem.per_value.push_back(unit_of_map(value, quantity, unit_of(gives)));
    problem.numbers.push_back(gives);
    const double measured = table.named(value, "row", value.needed_text("row", "a quantity of the rows"));
    set.points.push_back({name_of(gives), double(set.points.size() + 1), set.quantities.size(), measured});
    set.quantities.push_back(quantity);
  }
  for (const TomlFields& map : plan.tables("map")) {
    const std::string_view keys[] = {"quantity", "unit", "input",           "gives",          "slope",
                                     "zero",     "at",   "input_per_value", "value_per_value"};
    map.known_keys(keys);
    const MeasuredLine line = read_line(map, table);
    FlightProblem::Map found{map.choice<FlightControl>("input"), map.choice<FlightLoad>("gives"), {}};
    if (!problem.vehicle.has(found.control)) {
      map.refuse(map.at("input"), "input", "is no control of the vehicle");
    }
    const double per_value = factor_of(map, "input_per_value");
    for (const double x : line.inputs) found.settings.push_back(per_value * x);
    problem.per_value.push_back(factor_of(map, "value_per_value") *
                                unit_of_map(map, line.quantity, found.load == FlightLoad::lift ? "N" : "N m"));
    add_points(line, flight_control_units[std::size_t(found.control)], set);
    problem.maps.push_back(std::move(found));
  }
  if (set.points.empty()) plan.refuse("value", "missing; expected [[validation.value]] or [[validation.map]]");
  set.split = ValidationSplit::none;
  set.position_name = "Command over the largest one shown, or row";
  return problem;
}

}  // namespace wingbeat::detail

#include "files/measured_line.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {

using Kind = TomlNode::Kind;

double factor_of(const TomlFields& map, std::string_view key) {
  if (!map.has(key)) return 1.0;
  const double x = map.needed_quantity(key, "1");
  if (x == 0.0) map.refuse(map.at(key), key, "must not be 0");
  return x;
}

double unit_of_map(const TomlFields& map, const ComparedQuantity& quantity, std::string_view si) {
  try {
    return unit_factor(quantity.unit, si);
  } catch (const UnitError& error) {
    map.refuse(map.at("unit"), "unit", error.what());
  }
}

MeasuredLine read_line(const TomlFields& map, const MeasuredTable& table) {
  MeasuredLine line;
  line.quantity = {map.needed_text("quantity", "what is compared, in words"), map.needed_text("unit", "its unit")};
  const double slope = table.named(map, "slope", map.needed_text("slope", "a quantity of the rows"));
  const double zero =
      map.has("zero") ? table.named(map, "zero", map.needed_text("zero", "a quantity of the rows")) : 0.0;
  const TomlNode& inputs = map.at("at");
  const char* expected = "expected a list of inputs > 0";
  if (!map.has("at") || inputs.kind != Kind::array || inputs.items.empty()) map.refuse(inputs, "at", expected);
  for (const TomlNode& item : inputs.items) {
    if (item.kind != Kind::number || !(item.number > 0.0)) map.refuse(item, "at", expected);
    line.inputs.push_back(item.number);
    line.measured.push_back(slope * (item.number - zero));
  }
  return line;
}

void add_points(const MeasuredLine& line, const std::string& unit, ValidationSet& set) {
  const double largest = *std::max_element(line.inputs.begin(), line.inputs.end());
  for (std::size_t n = 0; n < line.inputs.size(); ++n) {
    const double x = line.inputs[n];
    set.points.push_back({fmt::format("{:g}{}", x, unit == "1" ? "" : " " + unit), x / largest, set.quantities.size(),
                          line.measured[n]});
  }
  set.quantities.push_back(line.quantity);
}

}  // namespace wingbeat::detail

// The design as a vehicle file.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "files/design_settings.hpp"
#include "files/design_write.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {

namespace {

/// The shortest text that reads back to the same double. A TOML integer has no negative zero.
std::string toml_number(double x) { return x == 0.0 && std::signbit(x) ? "-0.0" : fmt::format("{}", x); }

TomlNode number_node(double x) {
  TomlNode node;
  node.kind = TomlNode::Kind::number;
  node.number = x;
  return node;
}

/// Rows of a table, each column in its unit.
template <std::size_t N>
void write_rows(WrittenKey& key, const std::array<std::string_view, N>& units,
                const std::vector<std::array<double, N>>& rows) {
  key.value.kind = TomlNode::Kind::array;
  key.text = "[";
  for (const std::array<double, N>& row : rows) {
    TomlNode& node = key.value.items.emplace_back();
    node.kind = TomlNode::Kind::array;
    key.text += "\n  [";
    for (std::size_t n = 0; n < N; ++n) {
      node.items.push_back(number_node(row[n]));
      key.text += fmt::format("{}{}", n ? ", " : "", toml_quantity(row[n], units[n]));
    }
    key.text += "],";
  }
  key.text += "\n]";
}

std::vector<std::array<double, 2>> rows_of(const std::vector<std::pair<double, double>>& pairs) {
  std::vector<std::array<double, 2>> rows;
  for (const auto& [x, y] : pairs) rows.push_back({x, y});
  return rows;
}

}  // namespace

std::string toml_quantity(double x, std::string_view unit) {
  return unit == "1" ? toml_number(x) : fmt::format("\"{} {}\"", x, unit);
}

std::vector<WrittenKey> written_keys(const Design<double>& design) {
  const bool custom = design.aerodynamics.coefficients_name == "custom";
  std::vector<WrittenKey> keys;
  for (const auto& key : parameter_table<double>()) {
    WrittenKey written{key.path, key.unit, {}, {}};
    const bool of_wave = key.get && key.path.starts_with("aerodynamics.coefficients.");
    if (key.path == "wing.planform.chords") {
      if (design.wing.planform.shape != PlanformShape::tabulated) continue;
      write_rows<2>(written, {"m", "m"}, rows_of(design.wing.planform.chord_table));
    } else if (key.path == "supply.discharge_curve") {
      const Battery<double>& battery = design.supply.battery;
      if (!has_battery(design.supply.type) || battery.discharge_curve.empty()) continue;
      write_rows<2>(written, {"1", "V"}, rows_of(battery.discharge_curve));
    } else if (key.path == "transmission.stroke_table") {
      const auto& curve = design.transmission.table.curve;
      if (!curve) continue;
      write_rows<2>(written, {"rad", "rad"}, rows_of(curve->rows()));
    } else if (key.path == "aerodynamics.coefficients.table") {
      const auto& table = design.aerodynamics.coefficients.table;
      if (!table) continue;
      std::vector<std::array<double, 3>> rows;
      for (std::size_t n = 0; n < table->alpha().size(); ++n) {
        rows.push_back({table->alpha()[n], table->lift()[n], table->drag()[n]});
      }
      write_rows<3>(written, {"rad", "1", "1"}, rows);
    } else if (key.path == load_table_key::rows) {
      const auto& table = design.aerodynamics.load_table;
      if (!table) continue;
      write_rows<LoadTable::columns>(written, {"rad", "rad/s", "rad", "rad/s", "N", "N m", "N m"}, table->rows());
    } else if (key.text) {
      written.value.text = key.text(design);
      if (written.value.text.empty()) continue;
      const bool flag = key.range.text == "true or false";
      if (flag && key.fallback == "true" && written.value.text == key.fallback) continue;
      written.value.kind = flag ? TomlNode::Kind::boolean : TomlNode::Kind::text;
      written.value.number = written.value.text == "true" ? 1.0 : 0.0;
      written.text = flag ? written.value.text : toml_text(written.value.text);
    } else {
      const auto value = key.get(design);
      if (!value || (of_wave && !custom)) continue;
      written.value = number_node(*value);
      written.text = toml_quantity(*value, key.unit);
    }
    keys.push_back(std::move(written));
  }
  return keys;
}

Document document_of(const Design<double>& design, std::string_view name) {
  Document document;
  document.file_name = name;
  const Origin origin{document.file_name, 0, 0, false};
  for (WrittenKey& key : written_keys(design)) {
    for (auto dot = key.path.find('.'); dot != std::string_view::npos; dot = key.path.find('.', dot + 1)) {
      document.sections.try_emplace(std::string(key.path.substr(0, dot)), origin);
    }
    document.values.emplace(key.path, Value{std::move(key.value), origin});
  }
  return document;
}

std::string write_design(const Design<double>& design) {
  std::string result, header;
  for (const WrittenKey& key : written_keys(design)) {
    const auto dot = key.path.rfind('.');
    if (key.path.substr(0, dot) != header) {
      header = key.path.substr(0, dot);
      result += fmt::format("{}[{}]\n", result.empty() ? "" : "\n", header);
    }
    result += fmt::format("{} = {}\n", key.path.substr(dot + 1), key.text);
  }
  return result;
}

}  // namespace wingbeat

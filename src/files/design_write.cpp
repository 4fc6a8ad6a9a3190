// The design as a vehicle file.
#include <fmt/format.h>

#include <cmath>

#include "files/design_write.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {

namespace {

/// The shortest text that reads back to the same double. A TOML integer has no negative zero.
std::string toml_number(double x) { return x == 0.0 && std::signbit(x) ? "-0.0" : fmt::format("{}", x); }

std::string chord_rows(const Planform<double>& planform) {
  std::string rows = "[";
  for (const auto& [distance, chord] : planform.chord_table) {
    rows += fmt::format("\n  [{}, {}],", toml_quantity(distance, "m"), toml_quantity(chord, "m"));
  }
  return rows + "\n]";
}

std::string discharge_rows(const Battery<double>& battery) {
  std::string rows = "[";
  for (const auto& [charge, voltage] : battery.discharge_curve) {
    rows += fmt::format("\n  [{}, {}],", toml_number(charge), toml_quantity(voltage, "V"));
  }
  return rows + "\n]";
}

std::string stroke_rows(const StrokeCurve& curve) {
  std::string rows = "[";
  for (const auto& [theta, beta] : curve.rows()) {
    rows += fmt::format("\n  [{}, {}],", toml_quantity(theta, "rad"), toml_quantity(beta, "rad"));
  }
  return rows + "\n]";
}

std::string coefficient_rows(const CoefficientTable& table) {
  std::string rows = "[";
  for (std::size_t n = 0; n < table.alpha().size(); ++n) {
    rows += fmt::format("\n  [{}, {}, {}],", toml_quantity(table.alpha()[n], "rad"), toml_number(table.lift()[n]),
                        toml_number(table.drag()[n]));
  }
  return rows + "\n]";
}

}  // namespace

std::string toml_quantity(double x, std::string_view unit) {
  return unit == "1" ? toml_number(x) : fmt::format("\"{} {}\"", x, unit);
}

std::vector<WrittenKey> written_keys(const Design<double>& design) {
  const bool custom = design.aerodynamics.coefficients_name == "custom";
  std::vector<WrittenKey> keys;
  const auto write = [&](const ParameterText& key, std::string text, std::optional<double> number = {}) {
    keys.push_back({key.path, key.unit, std::move(text), number});
  };
  for (const auto& key : parameter_table<double>()) {
    const bool of_wave = key.get && key.path.starts_with("aerodynamics.coefficients.");
    if (key.path == "wing.planform.chords") {
      if (design.wing.planform.shape == PlanformShape::tabulated) write(key, chord_rows(design.wing.planform));
    } else if (key.path == "supply.discharge_curve") {
      const bool battery = has_battery(design.supply.type);
      if (battery && !design.supply.battery.discharge_curve.empty()) write(key, discharge_rows(design.supply.battery));
    } else if (key.path == "transmission.stroke_table") {
      if (const auto& curve = design.transmission.table.curve) write(key, stroke_rows(*curve));
    } else if (key.path == "aerodynamics.coefficients.table") {
      if (const auto& table = design.aerodynamics.coefficients.table) write(key, coefficient_rows(*table));
    } else if (key.text) {
      const bool flag = key.range.text == "true or false";
      if (const std::string text = key.text(design); !text.empty()) write(key, flag ? text : toml_text(text));
    } else if (const auto value = key.get(design); value && (custom || !of_wave)) {
      write(key, toml_quantity(*value, key.unit), *value);
    }
  }
  return keys;
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

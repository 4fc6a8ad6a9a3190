#include "files/heating_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "files/part_list.hpp"
#include "files/table_form.hpp"
#include "files/text_encoding.hpp"
#include "wingbeat/files/input_file.hpp"

namespace wingbeat::detail {
namespace {

constexpr ColumnAlias heating_aliases[] = {{"t", "time"},
                                           {"seconds", "time"},
                                           {"i", "current"},
                                           {"motor_current", "current"},
                                           {"u", "voltage"},
                                           {"v", "voltage"},
                                           {"terminal_voltage", "voltage"},
                                           {"t_w", "winding_temperature"},
                                           {"t_winding", "winding_temperature"},
                                           {"winding", "winding_temperature"},
                                           {"coil_temperature", "winding_temperature"},
                                           {"t_c", "case_temperature"},
                                           {"t_case", "case_temperature"},
                                           {"case", "case_temperature"},
                                           {"t_housing", "case_temperature"},
                                           {"housing_temperature", "case_temperature"},
                                           {"r", "resistance"},
                                           {"winding_resistance", "resistance"},
                                           {"terminal_resistance", "resistance"},
                                           {"armature_resistance", "resistance"}};

const PartColumns& heating_columns() {
  static const PartColumns columns = {"heating",
                                      {{"time", "time_s", "s"},
                                       {"current", "current_a", "A"},
                                       {"voltage", "voltage_v", "V"},
                                       {"winding_temperature", "winding_temperature_degc", "degC"},
                                       {"case_temperature", "case_temperature_degc", "degC"},
                                       {"resistance", "resistance_ohm", "ohm"}},
                                      heating_aliases,
                                      {},
                                      {"time"}};
  return columns;
}

}  // namespace

HeatingCurve read_heating(const TomlFields& section, const std::filesystem::path& folder) {
  constexpr std::string_view known[] = {"file",
                                        "motor",
                                        "current",
                                        "voltage",
                                        "ambient_temperature",
                                        "start_temperature",
                                        "copper_temperature_coefficient",
                                        "columns",
                                        "separator",
                                        "decimal"};
  section.known_keys(known);
  HeatingCurve c;
  const std::string name = section.needed_text("file", "the name of a CSV file with the heating curve");
  const std::filesystem::path path = folder / name;
  if (!is_there(path)) section.refuse(section.at("file"), "file", fmt::format("there is no file {}", path.string()));
  c.source = path.filename().string();
  c.motor = section.choice<HeatedMotor>("motor", c.motor);
  const auto positive = [&](const char* key, const char* unit) {
    const std::optional<double> x = section.quantity(key, unit);
    if (x && !(*x > 0.0)) section.refuse(section.at(key), key, fmt::format("must be > 0 {}", unit));
    return x;
  };
  c.held_current = positive("current", "A");
  c.held_voltage = positive("voltage", "V");
  c.ambient_temperature = section.quantity("ambient_temperature", "K").value_or(c.ambient_temperature);
  c.start_temperature = section.quantity("start_temperature", "K");
  c.copper_temperature_coefficient =
      section.quantity("copper_temperature_coefficient", "1/K").value_or(c.copper_temperature_coefficient);
  for (const char* key : {"ambient_temperature", "start_temperature"}) {
    const std::optional<double> T = section.quantity(key, "K");
    if (T && !range::temperature.holds(*T)) section.refuse(section.at(key), key, range::temperature.expected);
  }

  const StatedTable stated = stated_table(section, "winding_temperature");
  std::string encoding;
  const std::string text = decoded(read_text_file(path), path.string(), encoding);
  const PartList list(text, path.string(), stated, heating_columns());
  struct Column {
    const char* name;
    std::vector<double>* values;
    double offset;
  };
  const Column columns[] = {{"current", &c.current, 0.0},
                            {"voltage", &c.voltage, 0.0},
                            {"winding_temperature", &c.winding_temperature, zero_celsius},
                            {"case_temperature", &c.case_temperature, zero_celsius},
                            {"resistance", &c.resistance, 0.0}};
  for (const Column& column : columns) {
    const bool held =
        (column.values == &c.current && c.held_current) || (column.values == &c.voltage && c.held_voltage);
    if (held && list.has(column.name)) {
      section.refuse(
          section.at(column.name), column.name,
          fmt::format("is a column of {} as well: leave it out here, or give columns = {{ ... = \"ignore\" }}",
                      c.source));
    }
  }
  for (const TableLine& row : list.rows()) {
    const std::optional<double> time = list.number(row, "time");
    if (!time) list.refuse(row.number, 1, "time", "missing: every row needs its time");
    if (!(*time >= 0.0)) {
      list.refuse(row.number, 1, "time",
                  fmt::format("must be >= 0 s, from when the motor is switched on, got {:.6g}", *time));
    }
    if (!c.time.empty() && !(*time > c.time.back())) {
      list.refuse(row.number, 1, "time",
                  fmt::format("must grow from row to row: {:.6g} s after {:.6g} s", *time, c.time.back()));
    }
    c.time.push_back(*time);
    for (const Column& column : columns) {
      if (!list.has(column.name)) continue;
      column.values->push_back(list.number(row, column.name).value_or(std::nan("")) + column.offset);
    }
  }
  return c;
}

}  // namespace wingbeat::detail

#include "files/drive_train_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "files/part_list.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

constexpr ColumnAlias gearbox_aliases[] = {{"name", "model"},
                                           {"type", "model"},
                                           {"gearbox", "model"},
                                           {"gearhead", "model"},
                                           {"part_number", "model"},
                                           {"gear_ratio", "ratio"},
                                           {"reduction", "ratio"},
                                           {"reduction_ratio", "ratio"},
                                           {"weight", "mass"},
                                           {"mass_inertia", "inertia"},
                                           {"moment_of_inertia", "inertia"},
                                           {"input_inertia", "inertia"},
                                           {"gear_efficiency", "efficiency"},
                                           {"max_efficiency", "efficiency"},
                                           {"max_cont_torque", "torque_continuous"},
                                           {"continuous_torque", "torque_continuous"},
                                           {"max_continuous_torque", "torque_continuous"},
                                           {"nominal_torque", "torque_continuous"},
                                           {"rated_torque", "torque_continuous"},
                                           {"max_int_torque", "torque_peak"},
                                           {"peak_torque", "torque_peak"},
                                           {"intermittent_torque", "torque_peak"},
                                           {"max_intermittent_torque", "torque_peak"},
                                           {"momentary_torque", "torque_peak"},
                                           {"max_speed", "speed_max"},
                                           {"input_speed", "speed_max"},
                                           {"max_input_speed", "speed_max"},
                                           {"max_continuous_input_speed", "speed_max"}};
constexpr PlainHeader gearbox_headers[] = {{"key", "model"},
                                           {"ratio", "ratio"},
                                           {"mass", "mass"},
                                           {"inertia", "inertia"},
                                           {"efficiency", "efficiency"},
                                           {"max_int_torque", "torque_peak"},
                                           {"max_cont_torque", "torque_continuous"}};
constexpr ColumnAlias battery_aliases[] = {{"name", "model"},
                                           {"type", "model"},
                                           {"battery", "model"},
                                           {"part_number", "model"},
                                           {"s", "cells"},
                                           {"cells_in_series", "cells"},
                                           {"weight", "mass"},
                                           {"resistance", "internal_resistance"},
                                           {"cell_resistance", "internal_resistance"},
                                           {"nominal_cell_voltage", "cell_voltage"},
                                           {"cut_off_voltage", "cutoff_voltage"},
                                           {"max_current", "current_max"},
                                           {"discharge_current", "current_max"},
                                           {"continuous_current", "current_max"},
                                           {"max_continuous_current", "current_max"},
                                           {"max_discharge_current", "current_max"},
                                           {"c_rating", "discharge_rate"},
                                           {"c_rate", "discharge_rate"}};

const PartColumns& gearbox_columns() {
  static const PartColumns columns = {"gearboxes",
                                      {{"model", "model", ""},
                                       {"ratio", "ratio", "1"},
                                       {"mass", "mass_kg", "kg"},
                                       {"inertia", "inertia_kgm2", "kg m2"},
                                       {"efficiency", "efficiency", "1"},
                                       {"torque_continuous", "torque_continuous_Nm", "N m"},
                                       {"torque_peak", "torque_peak_Nm", "N m"},
                                       {"speed_max", "speed_max_rad_s", "rad/s"}},
                                      gearbox_aliases,
                                      gearbox_headers,
                                      {"model", "ratio"}};
  return columns;
}

const PartColumns& battery_columns() {
  static const PartColumns columns = {"batteries",
                                      {{"model", "model", ""},
                                       {"cells", "cells", "1"},
                                       {"capacity", "capacity_C", "C"},
                                       {"internal_resistance", "internal_resistance_ohm", "ohm"},
                                       {"mass", "mass_kg", "kg"},
                                       {"cell_voltage", "cell_voltage_V", "V"},
                                       {"cutoff_voltage", "cutoff_voltage_V", "V"},
                                       {"current_max", "current_max_A", "A"},
                                       {"discharge_rate", "discharge_rate", "1"}},
                                      battery_aliases,
                                      {},
                                      {"model", "cells", "capacity"}};
  return columns;
}

/// Notes why a part cannot be tried, once.
void refuse(std::string& refused, bool when, const std::string& why) {
  if (when && refused.empty()) refused = why;
}

}  // namespace

std::vector<GearboxCandidate> parse_gearboxes(std::string_view utf8, const std::string& name, const StatedTable& stated,
                                              bool weighed) {
  const PartList list(utf8, name, stated, gearbox_columns());
  std::vector<GearboxCandidate> gearboxes;
  for (const TableLine& row : list.rows()) {
    GearboxCandidate g;
    g.model = one_line(list.text(row, "model"));
    const auto ratio = list.number(row, "ratio"), efficiency = list.number(row, "efficiency");
    const auto inertia = list.number(row, "inertia");
    g.ratio = ratio.value_or(1.0);
    g.efficiency = efficiency.value_or(1.0);
    g.inertia = inertia.value_or(0.0);
    g.mass = list.number(row, "mass");
    g.torque_continuous = list.limit(row, "torque_continuous");
    g.torque_peak = list.limit(row, "torque_peak");
    g.speed_max = list.limit(row, "speed_max");
    if (!efficiency) g.assumed.push_back("no efficiency stated: taken as without loss");
    if (!inertia) g.assumed.push_back("no inertia stated: taken as none");
    const auto outside = [](double x, const char* expected) { return fmt::format("{}, got {:.6g}", expected, x); };
    refuse(g.refused, !ratio, "incomplete, no ratio");
    refuse(g.refused, !(g.ratio > 0.0), outside(g.ratio, "ratio must be > 0"));
    refuse(g.refused, !(g.efficiency > 0.0 && g.efficiency <= 1.0),
           outside(g.efficiency, "efficiency must be > 0 and <= 1"));
    refuse(g.refused, !(g.inertia >= 0.0), outside(g.inertia, "inertia must be >= 0 kg m2"));
    refuse(g.refused, weighed && !g.mass, "incomplete, no mass");
    refuse(g.refused, g.mass && !(*g.mass >= 0.0), outside(g.mass.value_or(0.0), "mass must be >= 0 kg"));
    gearboxes.push_back(std::move(g));
  }
  return gearboxes;
}

std::vector<BatteryCandidate> parse_batteries(std::string_view utf8, const std::string& name, const StatedTable& stated,
                                              bool weighed, const Design<double>& design) {
  const PartList list(utf8, name, stated, battery_columns());
  std::vector<BatteryCandidate> batteries;
  for (const TableLine& row : list.rows()) {
    BatteryCandidate b;
    b.model = one_line(list.text(row, "model"));
    const auto cells = list.number(row, "cells"), capacity = list.number(row, "capacity");
    b.cells = cells.value_or(1.0);
    b.capacity = capacity.value_or(0.0);
    b.mass = list.number(row, "mass");
    b.internal_resistance = list.number(row, "internal_resistance");
    b.cell_voltage = list.number(row, "cell_voltage");
    b.cutoff_voltage = list.number(row, "cutoff_voltage");
    b.current_max = list.limit(row, "current_max");
    const auto rate = list.limit(row, "discharge_rate");
    constexpr double hour = 3600.0;
    if (!b.current_max && rate) b.current_max = *rate * b.capacity / hour;
    refuse(b.refused, !cells, "incomplete, no number of cells");
    refuse(b.refused, !capacity, "incomplete, no capacity");
    refuse(b.refused, weighed && !b.mass, "incomplete, no mass");
    refuse(b.refused, b.mass && !(*b.mass >= 0.0), fmt::format("mass must be >= 0 kg, got {:.6g}", b.mass.value_or(0)));
    if (b.refused.empty()) {
      try {
        validate(with_parts(design, nullptr, &b).supply.battery);
      } catch (const ParameterError& error) {
        b.refused = error.what();
      }
    }
    batteries.push_back(std::move(b));
  }
  return batteries;
}

std::map<std::string, std::vector<std::string>> parse_compatibility(std::string_view utf8) {
  std::map<std::string, std::vector<std::string>> compatible;
  while (!utf8.empty()) {
    const std::size_t end = std::min(utf8.find('\n'), utf8.size());
    std::string_view line = trimmed(utf8.substr(0, end));
    utf8.remove_prefix(std::min(end + 1, utf8.size()));
    if (line.empty() || line.starts_with('#')) continue;
    std::vector<std::string> names;
    while (!line.empty()) {
      const std::size_t comma = std::min(line.find(','), line.size());
      const std::string_view cell = trimmed(line.substr(0, comma));
      if (!cell.empty()) names.emplace_back(cell);
      line.remove_prefix(std::min(comma + 1, line.size()));
    }
    if (names.empty()) continue;
    std::vector<std::string>& with = compatible[names[0]];
    with.insert(with.end(), names.begin() + 1, names.end());
  }
  return compatible;
}

const char* listed_with(const DriveTrainSearch& search, std::string_view key) {
  constexpr std::string_view of_gearboxes[] = {"motor.gear_ratio", "motor.gear_inertia", "motor.gear_damping",
                                               "motor.gear_efficiency", "motor.mass"};
  constexpr std::string_view of_batteries[] = {
      "supply.cells",           "supply.capacity",     "supply.internal_resistance", "supply.mass",
      "supply.specific_energy", "supply.cell_voltage", "supply.cutoff_voltage"};
  const auto states = [&](const auto& keys) {
    return std::find(std::begin(keys), std::end(keys), key) != std::end(keys);
  };
  if (!search.gearboxes.empty() && states(of_gearboxes)) return "gearboxes";
  if (!search.batteries.empty() && states(of_batteries)) return "batteries";
  return nullptr;
}

}  // namespace wingbeat::detail

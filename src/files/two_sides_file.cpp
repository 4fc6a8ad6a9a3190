#include "wingbeat/files/two_sides_file.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "files/design_settings.hpp"
#include "files/input_errors.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/parts/supply.hpp"

namespace wingbeat {
namespace {

/// Why the vehicle has no sides of its own; empty where it has.
std::string complaint_about(const Design<double>& d) {
  if (d.transmission.type != TransmissionType::direct) {
    return fmt::format(
        "the wings of one crank move together; sides differ where transmission.type = \"direct\", it is {}",
        in_quotes(name_of(d.transmission.type)));
  }
  if (d.motors != 2.0) {
    return fmt::format("sides differ where vehicle.motors = 2, one motor on either side; there {} {:.0f}",
                       d.motors == 1.0 ? "is" : "are", d.motors);
  }
  if (d.supply.type != SupplyType::sine) {
    return "both sides would draw on one battery, which ties them together; expected supply.type = \"sine\"";
  }
  if (d.supply_resonance_ratio) {
    return "supply.resonance_ratio would give the sides different frequencies; give supply.frequency";
  }
  return "";
}

bool is_shared(std::string_view path) {
  const std::string_view section = path.substr(0, path.find('.'));
  return section == "vehicle" || section == "supply" || path == "transmission" || path == "transmission.type";
}

VehicleFile vehicle_of(Document document, std::span<const Setting> settings, std::span<const std::string> overrides,
                       const TableLoader& load_table) {
  const std::map<std::string, SideTable> tables = std::exchange(document.sides, {});
  const Design<double> whole = design_of(document, settings, overrides, load_table);
  if (tables.empty()) return {whole, std::nullopt};
  InputErrors errors;
  const std::string complaint = complaint_about(whole);
  for (const auto& [name, table] : tables) {
    errors.attempt([&, &n = name, &t = table] {
      if (!complaint.empty()) t.origin.refuse(n, complaint);
    });
    for (const Setting& s : table.settings) {
      errors.attempt([&] {
        if (is_shared(s.path)) s.origin.refuse(s.path, "is the whole vehicle's: both sides share it");
      });
    }
  }
  errors.refuse();
  const auto side = [&](const char* name) {
    Design<double> design = whole;
    const auto found = tables.find(name);
    if (found == tables.end()) return design;
    std::vector<Setting> of_side = found->second.settings;
    of_side.insert(of_side.end(), settings.begin(), settings.end());
    errors.attempt([&] { design = design_of(document, of_side, overrides, load_table); });
    return design;
  };
  TwoSides sides{whole, side("left"), side("right")};
  errors.refuse();
  if (write_design(sides.left) == write_design(sides.right)) return {sides.left, std::nullopt};
  for (Design<double>* design : {&sides.left, &sides.right}) {
    design->motors = 1.0;
    design->mass.reset();
    AerodynamicsDesign<double>& air = design->aerodynamics;
    // Stated of all wings.
    if (air.swept_area) *air.swept_area *= 0.5;
    if (air.load_table && !air.table_wings) air.table_wings = whole.motors * whole.wing.count;
  }
  return {whole, std::move(sides)};
}

}  // namespace

VehicleFile read_vehicle(const std::filesystem::path& file, std::span<const Setting> settings,
                         std::span<const std::string> overrides) {
  return vehicle_of(parse_document(read_text_file(file), input_name(file)), settings, overrides,
                    [&](const std::string& name) { return read_text_file(file.parent_path() / name); });
}

VehicleFile read_vehicle(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read_vehicle(file, {}, overrides);
}

VehicleFile parse_vehicle(std::string_view text, std::string_view file_name, std::span<const std::string> overrides,
                          const TableLoader& load_table) {
  return vehicle_of(parse_document(text, file_name), {}, overrides, load_table);
}

}  // namespace wingbeat

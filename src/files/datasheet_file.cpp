#include "wingbeat/files/datasheet_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "files/heating_table.hpp"
#include "files/input_errors.hpp"
#include "files/toml_fields.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {
namespace {

struct Field {
  std::string_view key, unit;
  std::optional<double> MotorDatasheet::* value;
};
constexpr Field fields[] = {{"voltage", "V", &MotorDatasheet::voltage},
                            {"no_load_speed", "rad/s", &MotorDatasheet::no_load_speed},
                            {"no_load_current", "A", &MotorDatasheet::no_load_current},
                            {"stall_torque", "N m", &MotorDatasheet::stall_torque},
                            {"stall_current", "A", &MotorDatasheet::stall_current},
                            {"resistance", "ohm", &MotorDatasheet::resistance},
                            {"torque_constant", "N m/A", &MotorDatasheet::torque_constant},
                            {"speed_constant", "rad/s/V", &MotorDatasheet::speed_constant},
                            {"friction_torque", "N m", &MotorDatasheet::friction_torque},
                            {"viscous_damping", "N m s/rad", &MotorDatasheet::viscous_damping},
                            {"inductance", "H", &MotorDatasheet::inductance},
                            {"rotor_inertia", "kg m2", &MotorDatasheet::rotor_inertia},
                            {"mechanical_time_constant", "s", &MotorDatasheet::mechanical_time_constant},
                            {"rotor_diameter", "m", &MotorDatasheet::rotor_diameter},
                            {"rotor_length", "m", &MotorDatasheet::rotor_length}};
constexpr Field thermal_fields[] = {
    {"thermal_resistance_winding", "K/W", &MotorDatasheet::thermal_resistance_winding},
    {"thermal_resistance_case", "K/W", &MotorDatasheet::thermal_resistance_case},
    {"winding_temperature_max", "K", &MotorDatasheet::winding_temperature_max},
    {"thermal_time_constant_winding", "s", &MotorDatasheet::thermal_time_constant_winding},
    {"thermal_time_constant_case", "s", &MotorDatasheet::thermal_time_constant_case}};
constexpr Field point_fields[] = {{"voltage", "V", nullptr},
                                  {"torque", "N m", nullptr},
                                  {"speed", "rad/s", nullptr},
                                  {"current", "A", nullptr},
                                  {"efficiency", "1", nullptr}};

}  // namespace

MotorDatasheet parse_datasheet(std::string_view text, const std::string& file_name,
                               const std::filesystem::path& folder) {
  const TomlNode tree = parse_toml_tree(text, file_name);
  const TomlFields root(file_name, "", tree);
  const std::string_view sections[] = {"datasheet", "deviation", "fallback", "heating"};
  InputErrors errors;
  errors.attempt([&] { root.known_keys(sections); });
  const auto sheet = root.table("datasheet");
  if (!sheet) root.refuse("datasheet", "missing section [datasheet] with the published values");
  std::vector<std::string_view> known = {"name", "source", "note", "shaft", "gear_ratio", "gear_efficiency", "point"};
  for (const Field& f : fields) known.push_back(f.key);
  for (const Field& f : thermal_fields) known.push_back(f.key);
  errors.attempt([&] { sheet->known_keys(known); });

  MotorDatasheet s;
  std::optional<HeatingCurve> heating_curve;
  s.name = sheet->text("name").value_or("");
  sheet->text("source");
  sheet->text("note");
  s.shaft = sheet->choice<Shaft>("shaft", s.shaft);
  s.gear_ratio = sheet->quantity("gear_ratio", "1").value_or(1.0);
  s.gear_efficiency = sheet->quantity("gear_efficiency", "1");
  for (const Field& f : fields) errors.attempt([&] { s.*f.value = sheet->quantity(f.key, f.unit); });
  for (const Field& f : thermal_fields) errors.attempt([&] { s.*f.value = sheet->quantity(f.key, f.unit); });
  errors.attempt([&] {
    if (s.shaft == Shaft::output && !sheet->has("gear_ratio")) {
      sheet->refuse("gear_ratio", "missing; values at the output shaft need the ratio (1 without a gearbox)");
    }
  });
  std::vector<std::string_view> point_keys;
  for (const Field& f : point_fields) point_keys.push_back(f.key);
  for (const TomlFields& p : sheet->tables("point")) {
    errors.attempt([&] {
      p.known_keys(point_keys);
      s.points.push_back({p.quantity("voltage", "V"), p.quantity("torque", "N m"), p.quantity("speed", "rad/s"),
                          p.quantity("current", "A"), p.quantity("efficiency", "1")});
    });
  }
  errors.refuse();
  if (const auto deviation = root.table("deviation")) {
    std::vector<std::string_view> names = {"default", "point"};
    for (const Field& f : fields) names.push_back(f.key);
    deviation->known_keys(names);
    for (const auto& [key, node] : deviation->node().members) {
      const double x = *deviation->quantity(key, "1");
      if (!(x > 0.0 && x < 1.0)) deviation->refuse(node, key, "must lie between 0 and 1 (relative)");
      if (key == "default") {
        s.deviation = x;
      } else {
        s.deviations[key] = x;
      }
    }
  }
  if (const auto fallback = root.table("fallback")) {
    const std::string_view names[] = {"inertia", "viscous_damping"};
    fallback->known_keys(names);
    const std::string_view cylinder[] = {"solid-steel-cylinder"}, typical[] = {"typical"};
    if (fallback->has("inertia")) s.assume_steel_cylinder = !fallback->choice("inertia", cylinder).empty();
    if (fallback->has("viscous_damping"))
      s.assume_typical_damping = !fallback->choice("viscous_damping", typical).empty();
  }
  if (const auto heating = root.table("heating")) {
    HeatingCurve curve = detail::read_heating(*heating, folder);
    curve.cold_resistance = s.resistance;
    try {
      validate(curve);
    } catch (const ParameterError& error) {
      heating->refuse(heating->at(error.key()), error.key(), error.reason());
    }
    heating_curve = std::move(curve);
  }
  try {
    // The heating curve, whose fit takes long, has been checked.
    MotorDatasheet without_heat = s;
    if (heating_curve) {
      without_heat.winding_temperature_max.reset();
      without_heat.thermal_time_constant_winding.reset();
      without_heat.thermal_time_constant_case.reset();
    }
    identify_motor(without_heat);
  } catch (const ParameterError& error) {
    const bool point = error.key() == "point";
    const bool of_root = error.key().starts_with("fallback");
    const TomlNode* named = of_root ? tree.find("fallback") : sheet->node().find(point ? "point" : error.key());
    const TomlNode& place = named ? *named : sheet->node();
    throw InputError(file_name, place.line, place.column, of_root ? error.key() : sheet->name_of(error.key()),
                     error.reason());
  }
  s.heating = std::move(heating_curve);
  return s;
}

MotorDatasheet read_datasheet(const std::filesystem::path& file) {
  return parse_datasheet(read_text_file(file), input_name(file), file.parent_path());
}

}  // namespace wingbeat

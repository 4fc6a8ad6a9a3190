#include "wingbeat/io/datasheet_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "input_errors.hpp"
#include "toml_fields.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/io/input_file.hpp"
#include "wingbeat/io/report.hpp"
#include "wingbeat/io/units.hpp"

namespace wingbeat {
namespace {

struct Field {
  std::string_view key, unit;
  std::optional<double> MotorDatasheet::*value;
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
constexpr Field point_fields[] = {{"voltage", "V", nullptr}, {"torque", "N m", nullptr}, {"speed", "rad/s", nullptr},
                                  {"current", "A", nullptr}, {"efficiency", "1", nullptr}};

struct Constant {
  std::string_view key;   ///< of [motor]
  std::string_view name, unit;
  IdentifiedConstant MotorIdentification::*value;
};
constexpr Constant constants[] = {
    {"armature_resistance", "armature resistance", "ohm", &MotorIdentification::armature_resistance},
    {"armature_inductance", "armature inductance", "H", &MotorIdentification::armature_inductance},
    {"torque_constant", "torque constant", "N m/A", &MotorIdentification::torque_constant},
    {"inertia", "inertia", "kg m2", &MotorIdentification::inertia},
    {"viscous_damping", "viscous damping", "N m s/rad", &MotorIdentification::viscous_damping},
    {"friction_torque", "friction torque", "N m", &MotorIdentification::friction_torque}};

std::string percent(double x) { return fmt::format("{:.{}f} %", 100.0 * x, std::abs(x) < 0.1 ? 1 : 0); }

std::string sentence(const Contradiction& c) {
  return fmt::format("{} and {} disagree about the {} by {}", c.first, c.second, c.constant, percent(c.size));
}

std::string spaced(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string scientific(double x, std::string_view unit) { return fmt::format("{:.4g} {}", x, unit); }

}  // namespace

MotorDatasheet parse_datasheet(std::string_view text, const std::string& file_name) {
  const TomlNode tree = parse_toml_tree(text, file_name);
  const TomlFields root(file_name, "", tree);
  const std::string_view sections[] = {"datasheet", "deviation", "fallback"};
  InputErrors errors;
  errors.attempt([&] { root.known_keys(sections); });
  const auto sheet = root.table("datasheet");
  if (!sheet) root.refuse("datasheet", "missing section [datasheet] with what the maker publishes");
  std::vector<std::string_view> known = {"name", "source", "note", "shaft", "gear_ratio", "gear_efficiency", "point"};
  for (const Field& f : fields) known.push_back(f.key);
  errors.attempt([&] { sheet->known_keys(known); });

  MotorDatasheet s;
  s.name = sheet->text("name").value_or("");
  sheet->text("source");
  sheet->text("note");
  const std::string_view shafts[] = {"motor", "output"};
  s.shaft = sheet->choice("shaft", shafts, "motor") == "output" ? Shaft::output : Shaft::motor;
  s.gear_ratio = sheet->quantity("gear_ratio", "1").value_or(1.0);
  s.gear_efficiency = sheet->quantity("gear_efficiency", "1");
  for (const Field& f : fields) errors.attempt([&] { s.*f.value = sheet->quantity(f.key, f.unit); });
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
  try {
    identify_motor(s);
  } catch (const ParameterError& error) {
    const bool point = error.key() == "point";
    const bool of_root = error.key().starts_with("fallback");
    const TomlNode* at = of_root ? tree.find("fallback") : sheet->node().find(point ? "point" : error.key());
    const TomlNode& place = at ? *at : sheet->node();
    throw InputError(file_name, place.line, place.column,
                     of_root ? error.key() : sheet->name_of(error.key()), error.reason());
  }
  return s;
}

MotorDatasheet read_datasheet(const std::filesystem::path& file) {
  return parse_datasheet(read_text_file(file), input_name(file));
}

std::string motor_section(const MotorIdentification& motor, const MotorDatasheet& sheet, const std::string& made_by) {
  motor.motor();
  std::string text = fmt::format("# {}\n# {}; constants at the output shaft.\n",
                                 sheet.name.empty() ? "Motor of a data sheet" : one_line(sheet.name, 100), made_by);
  for (const Contradiction& c : motor.contradictions) text += fmt::format("# On the sheet, {}.\n", sentence(c));
  for (const std::string& remark : motor.remarks) text += fmt::format("# {}.\n", remark);
  if (sheet.gear_efficiency) text += fmt::format("# Of the sheet, not of this section: gear_efficiency = {}\n", *sheet.gear_efficiency);
  text += "\n[motor]\n";
  for (const Constant& c : constants) {
    text += fmt::format("{} = \"{} {}\"\n", c.key, *(motor.*c.value).value, c.unit);
  }
  return text;
}

std::string text_identification(const MotorIdentification& motor, const MotorDatasheet& sheet) {
  std::string text = sheet.name.empty() ? "" : one_line(sheet.name, 88) + "\n";
  text += "\nConstants at the output shaft\n";
  for (const Constant& c : constants) {
    const IdentifiedConstant& x = motor.*c.value;
    text += fmt::format("  {:<22}", c.name);
    if (!x.value) {
      text += "not determined\n";
    } else if (x.standard_error > 0.0) {
      text += fmt::format("{:>22} +- {:<10.2g}{}\n", scientific(*x.value, c.unit), x.standard_error, x.source);
    } else {
      text += fmt::format("{:>22}    {:<10}{}\n", scientific(*x.value, c.unit), "", x.source);
    }
  }
  if (!motor.checks.empty()) {
    text += "\nThe sheet beside the identified motor    published    identified   deviation\n";
    for (const DatasheetCheck& c : motor.checks) {
      text += fmt::format("  {:<34}{:>14.4g}{:>14.4g}{:>12}\n", spaced(c.name), c.published, c.identified,
                          fmt::format("{:+.1f} %", 100.0 * c.deviation));
    }
  }
  if (!motor.contradictions.empty()) {
    text += "\nContradictions of the sheet\n";
    for (const Contradiction& c : motor.contradictions) {
      text += "  " + wrapped(fmt::format("{}: {:.4g} and {:.4g}", sentence(c), c.first_value, c.second_value), 88, 4) +
              "\n";
    }
  }
  if (!motor.remarks.empty()) text += "\nRemarks\n";
  for (const std::string& remark : motor.remarks) text += "  " + wrapped(remark, 88, 4) + "\n";
  if (!motor.missing.empty()) text += "\nNot determined\n";
  for (const std::string& missing : motor.missing) text += "  " + wrapped(missing, 88, 4) + "\n";
  return text;
}

std::string json_identification(const MotorIdentification& motor, const MotorDatasheet& sheet) {
  using Json = nlohmann::ordered_json;
  const auto number = [](const std::optional<double>& x) { return x && std::isfinite(*x) ? Json(*x) : Json(nullptr); };
  Json json;
  json["name"] = sheet.name;
  json["complete"] = motor.complete();
  json["birge_ratio"] = motor.birge_ratio;
  json["gear_efficiency"] = number(sheet.gear_efficiency);
  for (const Constant& c : constants) {
    const IdentifiedConstant& x = motor.*c.value;
    json["motor"][std::string(c.key)] = {{"value", number(x.value)},
                                         {"standard_error", x.value ? Json(x.standard_error) : Json(nullptr)},
                                         {"unit", c.unit},
                                         {"source", x.source}};
  }
  json["checks"] = Json::array();
  for (const DatasheetCheck& c : motor.checks) {
    json["checks"].push_back(
        {{"name", c.name}, {"published", c.published}, {"identified", c.identified}, {"deviation", c.deviation}});
  }
  json["contradictions"] = Json::array();
  for (const Contradiction& c : motor.contradictions) {
    json["contradictions"].push_back({{"constant", c.constant}, {"first", c.first}, {"second", c.second},
                                      {"first_value", c.first_value}, {"second_value", c.second_value},
                                      {"size", c.size}, {"sentence", sentence(c)}});
  }
  json["remarks"] = motor.remarks;
  json["missing"] = motor.missing;
  return json.dump(2) + "\n";
}

}  // namespace wingbeat

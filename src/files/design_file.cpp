#include "wingbeat/files/design_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "files/design_settings.hpp"
#include "files/input_errors.hpp"
#include "files/table_rows.hpp"
#include "files/toml_reader.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/parts/coefficient_sets.hpp"
#include "wingbeat/parts/pitching_wings.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

std::string message_text(const std::string& file, int line, int column, const std::string& key,
                         const std::string& message) {
  std::string text = file;
  if (line > 0) text += fmt::format(":{}:{}", line, column);
  if (!key.empty()) text += (text.empty() ? "" : ": ") + key;
  return detail::printable(text.empty() ? message : text + ": " + message);
}

constexpr std::string_view wave_coefficients[] = {"aerodynamics.coefficients.lift", "aerodynamics.coefficients.drag"};

constexpr std::string_view centre_of_pressure_key = "aerodynamics.centre_of_pressure";

class Reader {
 public:
  Reader(const Document& document, const TableLoader& load_table)
      : document_(document), load_table_(load_table), errors_(document.errors) {}

  /// Reads on after an error, so that all of them are reported.
  Design<double> read() {
    Design<double> d{};
    require_sections();
    attempt([&] {
      if (const Value* name = document_.find("vehicle.name")) d.name = text_of(*name, "vehicle.name", "a text");
    });
    read_choice("supply.type", d.supply.type);
    read_choice("transmission.type", d.transmission.type);
    attempt([&] { read_formulation(d.transmission); });
    read_choice("friction.type", d.friction.law);
    attempt([&] {
      if (document_.has_section("wing.planform")) return;
      absent_.push_back("wing.planform");
      missing("wing.planform",
              "a table such as { shape = \"semi-ellipse\", length = \"63 mm\", root_chord = \"25 mm\" }");
    });
    read_choice("wing.planform.shape", d.wing.planform.shape);
    check_alternatives();
    attempt([&] { read_coefficients(d.aerodynamics); });
    attempt([&] { read_loads(d.aerodynamics); });
    attempt([&] { read_flag("aerodynamics.added_mass", d.aerodynamics.added_mass); });
    const RotationTerms rotation = rotation_with(d.aerodynamics.coefficients_name);
    d.pitch.rotational_lift = rotation.lift;
    d.pitch.damping_coefficient = rotation.damping;
    attempt([&] { read_flag("pitch.rotational_lift", d.pitch.rotational_lift); });
    attempt([&] {
      if (document_.find(centre_of_pressure_key)) {
        d.pitch.centre_of_pressure = choice<CentreOfPressure>(centre_of_pressure_key);
      }
    });
    attempt([&] { read_flag("wing.planform.scale_inertia", d.wing.scale_inertia); });
    attempt([&] { read_flag("electronics.regeneration", d.electronics.regenerates); });
    attempt([&] { read_flag("body.opposed", d.body.opposed); });
    attempt([&] {
      if (document_.find("supply.throttle")) d.supply.throttle = choice<Throttle>("supply.throttle");
    });
    attempt([&] {
      if (d.supply.type == SupplyType::pwm && !document_.find("supply.duty"))
        missing("supply.duty", quantity_example("1"));
    });
    for (const auto& [section, key] :
         {std::pair("pitch", pitch_key::stiffness), std::pair("wing.torsion", torsion_key::stiffness),
          std::pair("piezo", piezo_key::force_per_volt), std::pair("electronics", electronics_key::efficiency),
          std::pair("aerodynamics.clap_and_fling", clap_and_fling_key::amplitude),
          std::pair("body", body_key::inertia_pitch)}) {
      attempt([&, s = section, k = key] {
        if (document_.has_section(s) && !document_.find(k.path)) missing(k.path, quantity_example(k.unit));
      });
    }
    attempt([&] {
      if (!document_.has_section("piezo") || !document_.has_section("motor")) return;
      document_.locate("motor").refuse("motor",
                                       "cannot be combined with [piezo], which swings the wings without a motor");
    });
    read_numbers(d);
    attempt([&] {
      if (has_battery(d.supply.type)) read_discharge_curve(d.supply.battery);
    });
    attempt([&] {
      if (d.wing.planform.shape == PlanformShape::tabulated) read_chords(d.wing.planform);
    });
    attempt([&] {
      if (d.transmission.type == TransmissionType::tabulated) read_stroke_table(d.transmission.table);
    });
    errors_.refuse(missing_);
    check(d);
    return d;
  }

 private:
  /// Thrown instead of an error that follows from one that is reported already.
  struct Reported {};

  template <class Do>
  bool attempt(const Do& act) {
    try {
      return errors_.attempt(act);
    } catch (const Reported&) {
      return false;  // nothing to add
    }
  }

  /// True if a misspelt or misplaced key, which is reported already, was to be this one.
  bool known_to_be_wrong(std::string_view path) const {
    const auto leaf = [](std::string_view p) { return p.substr(p.rfind('.') + 1); };
    const auto section = [](std::string_view p) { return p.substr(0, p.size() - p.substr(p.rfind('.') + 1).size()); };
    const std::string_view name[] = {leaf(path)};
    return std::any_of(document_.spoiled.begin(), document_.spoiled.end(), [&](const std::string& wrong) {
      return wrong == path || (section(wrong) == section(path) && !nearest_name(leaf(wrong), name).empty());
    });
  }

  void require_sections() {
    constexpr std::pair<std::string_view, std::string_view> required[] = {
        {"supply", "the voltage at the motor terminals"},
        {"motor", "the motor's constants"},
        {"transmission", "the mechanism between motor and wings"},
        {"friction", "the friction law; without friction write type = \"none\""},
        {"wing", "the wings' number, inertia and planform"},
        {"aerodynamics", "air density, pitch coefficient and force coefficients"}};
    for (const auto& [section, holds] : required) {
      if (document_.has_section(section)) continue;
      absent_.push_back(section);
      if (section == "motor" && document_.has_section("piezo")) continue;
      if (known_to_be_wrong(section)) continue;
      missing_.attempt([&, s = section, h = holds] {
        document_.locate(s).refuse(std::string(s), fmt::format("missing section [{}]: {}", s, h));
      });
    }
  }

  /// Reported after the errors that stand in the file.
  [[noreturn]] void missing(std::string_view path, std::string_view expected) const {
    const bool follows = std::any_of(absent_.begin(), absent_.end(), [&](std::string_view section) {
      return path.starts_with(section) && path.size() > section.size() && path[section.size()] == '.';
    });
    if (follows || known_to_be_wrong(path)) throw Reported{};
    const auto dot = path.rfind('.');
    const std::string section(path.substr(0, dot));
    missing_.attempt([&] {
      document_.locate(section).refuse(std::string(path),
                                       fmt::format("missing in [{}]; expected {}", section, expected));
    });
    throw Reported{};
  }

  [[noreturn]] void wrong(const Value& value, std::string_view path, std::string_view expected) const {
    TomlReader(value.origin.file).wrong(value, std::string(path), expected);
  }

  const std::string& text_of(const Value& value, std::string_view path, std::string_view expected) const {
    if (value.kind != TomlNode::Kind::text) wrong(value, path, expected);
    return value.text;
  }

  const std::string& required_text(std::string_view path) const {
    const std::string_view expected = find_parameter<double>(path)->range.text;
    const Value* value = document_.find(path);
    if (!value) missing(path, expected);
    return text_of(*value, path, expected);
  }

  template <NamedEnum E>
  E choice(std::string_view path) const {
    if (const auto value = from_name<E>(required_text(path))) return *value;
    wrong(*document_.find(path), path, find_parameter<double>(path)->range.text);
  }

  /// A choice on which other keys depend: what depends on one that cannot be read is passed over.
  template <NamedEnum E>
  void read_choice(std::string_view path, E& result) {
    unread_.push_back(path);
    attempt([&] {
      result = choice<E>(path);
      unread_.pop_back();
    });
  }

  bool is_unread(std::string_view path) const {
    return std::find(unread_.begin(), unread_.end(), path) != unread_.end();
  }

  static double number_of(const Value& value, const TomlNode& node, std::string_view path, std::string_view unit) {
    return TomlReader(value.origin.file).quantity(node, std::string(path), unit, SpeedConstant::inverted);
  }

  /// True if the choices made so far leave a place for the key.
  bool has_place(const ParameterText& key) const {
    if (key.only_with.empty()) return true;
    const Requirement requirement = requirement_of(key.only_with);
    const Value* choice = document_.find(requirement.path);
    return !is_unread(requirement.path) && choice && requirement.allows(choice->text);
  }

  /// Whether the key belongs to the choices made; refuses one that is given and does not.
  bool belongs(const ParameterText& key) const {
    if (has_place(key)) return true;
    const Requirement requirement = requirement_of(key.only_with);
    const Value* value = document_.find(key.path);
    if (!value || is_unread(requirement.path)) return false;
    const Value* choice = document_.find(requirement.path);
    if (!choice) {
      value->origin.refuse(std::string(key.path), fmt::format("needs {}, which is not given", requirement.path));
    }
    value->origin.refuse(std::string(key.path), no_place_message(key.path, requirement, choice->text));
  }

  void read_formulation(TransmissionDesign<double>& transmission) const {
    const std::string_view path = "transmission.formulation";
    if (document_.find(path)) {
      transmission.formulation = choice<Formulation>(path);
    } else if (has_place(*find_parameter<double>(path))) {
      missing(path,
              "rod-force or virtual-work: virtual-work conserves power and is the choice for a new vehicle, "
              "rod-force is equation (1) of the 2022 paper as printed");
    }
  }

  void read_flag(std::string_view path, bool& flag) const {
    const Value* value = document_.find(path);
    if (!value) return;
    flag = TomlReader(value->origin.file).boolean(*value, std::string(path));
  }

  void read_numbers(Design<double>& d) {
    std::string_view unread;  // section of a number that could not be read: it may decide what applies there
    for (const auto& key : parameter_table<double>()) {
      const std::string_view section = key.path.substr(0, key.path.rfind('.'));
      std::optional<double> number;
      const bool accepted = attempt([&] {
        if (!belongs(key) || !key.set) return;
        if (const Value* value = document_.find(key.path)) {
          number = number_of(*value, *value, key.path, key.unit);
          if (!key.set(d, *number)) {
            if (section == unread) return;
            value->origin.refuse(std::string(key.path), "does not apply to this vehicle");
          }
          check_range(*value, key, *number);
        } else if (is_required(key)) {
          missing(key.path, quantity_example(key.unit));
        }
      });
      if (!accepted && !number) unread = section;
    }
  }

  bool is_required(const ParameterText& key) const {
    // read_coefficients() requires the numbers of a section that is given.
    return key.fallback == "required" && !key.has_alternative() && !is_section(key.required_unless) && !is_spared(key);
  }

  /// By one of the keys that take its place.
  bool is_spared(const ParameterText& key) const {
    for (std::string_view rest = key.required_unless; !rest.empty();) {
      const std::size_t end = std::min(rest.find('|'), rest.size());
      if (document_.find(rest.substr(0, end))) return true;
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
  }

  /// Each at its own line; validate() sees to what needs another key.
  static void check_range(const Value& value, const ParameterText& key, double number) {
    if (key.range.holds(number)) return;
    value.origin.refuse(std::string(key.path),
                        range_message(key.range.expected, std::string(key.unit).c_str(), number));
  }

  void check_alternatives() {
    const auto keys = parameter_table<double>();
    for (std::size_t n = 0; n < keys.size(); ++n) {
      const ParameterText& one = keys[n];
      bool first = one.has_alternative(), given = document_.find(one.path);
      for (const std::string& other : alternatives_of(one)) {
        const Parameter<double>* found = find_parameter<double>(other);
        if (found && found < &keys[n]) first = false;
        if (found && found > &keys[n]) attempt([&] { refuse_both(one.path, other); });
        given = given || document_.find(other);
      }
      if (first && !given) attempt([&] { require_either(one, alternatives_of(one).front()); });
    }
  }

  static std::string_view leaf_of(std::string_view path) { return path.substr(path.rfind('.') + 1); }

  void refuse_both(std::string_view one, const std::string& other) const {
    const Value* second = document_.find(other);
    if (!document_.find(one) || !second) return;
    second->origin.refuse(other, fmt::format("give {} or {}, not both", leaf_of(one), leaf_of(other)));
  }

  void require_either(const ParameterText& one, const std::string& other) const {
    const Parameter<double>* second = find_parameter<double>(other);
    const std::string_view section = one.path.substr(0, one.path.rfind('.'));
    if (one.fallback != "required" || !second || !has_place(one) || !document_.has_section(section)) return;
    if (is_spared(one) || known_to_be_wrong(other)) return;
    const std::string one_like_it =
        one.unit.empty() ? fmt::format("the {}", one.range.text) : quantity_example(one.unit);
    // Alternatives of another drive are not offered.
    missing(one.path, has_place(*second) ? fmt::format("{}, or {} instead", one_like_it, leaf_of(other)) : one_like_it);
  }

  void read_coefficients(AerodynamicsDesign<double>& a) const {
    const std::string path = "aerodynamics.coefficients", table_path = path + ".table";
    const std::string expected = coefficient_set_names() + " or a table of coefficients";
    a.coefficients = translational_2022();
    a.coefficients_name = "translational-2022";
    if (const Value* name = document_.find(path)) {
      const auto named = name->kind == TomlNode::Kind::text ? named_coefficients(name->text) : std::nullopt;
      if (!named) wrong(*name, path, expected);
      a.coefficients = *named;
      a.coefficients_name = name->text;
    }
    if (!document_.has_section(path)) return;
    if (const Value* table = document_.find(table_path)) {
      for (const std::string_view wave : wave_coefficients) {
        if (document_.has_section(wave)) {
          document_.locate(wave).refuse(std::string(wave), "give table, or lift and drag, not both");
        }
      }
      const auto rows = table_rows(*table, table_path, coefficient_columns, load_table_);
      std::array<std::vector<double>, 3> columns;
      for (const auto& row : rows) {
        for (std::size_t n = 0; n < 3; ++n) columns[n].push_back(row[n]);
      }
      try {
        a.coefficients.table = std::make_shared<CoefficientTable>(columns[0], columns[1], columns[2]);
      } catch (const ParameterError& error) {
        table->origin.refuse(table_path, error.reason());
      }
      a.coefficients.lift = {};
      a.coefficients.drag = {};
      a.coefficients_name = "table";
      return;
    }
    // The numbers themselves come with the others.
    for (const auto& key : parameter_table<double>()) {
      if (key.set && key.path.starts_with(path + ".") && key.fallback == "required" && !document_.find(key.path)) {
        missing(key.path, quantity_example(key.unit));
      }
    }
  }

  /// The table of loads of aerodynamics.type = "tabulated".
  void read_loads(AerodynamicsDesign<double>& a) const {
    const Value* const type = document_.find(load_table_key::type);
    const std::string_view types = "quasi-steady or tabulated";
    if (!type || text_of(*type, load_table_key::type, types) == "quasi-steady") return;
    if (type->text != "tabulated") wrong(*type, load_table_key::type, types);
    const auto [value, path] = file_or_rows(load_table_key::file, load_table_key::rows, "rows of seven values");
    if (!value) return missing(load_table_key::file, "\"loads.csv\", the name of a CSV file");
    for (const std::string_view other : {std::string_view("aerodynamics.coefficients"), centre_of_pressure_key}) {
      if (!document_.find(other) && !document_.has_section(other)) continue;
      document_.locate(other).refuse(std::string(other), "is not for tabulated loads, which come in its place");
    }
    try {
      a.load_table = std::make_shared<LoadTable>(table_rows(*value, path, load_columns, load_table_));
    } catch (const ParameterError& error) {
      value->origin.refuse(path, error.reason());
    }
    a.coefficients_name = "tabulated";
  }

  void read_discharge_curve(Battery<double>& battery) const {
    const std::string_view path = "supply.discharge_curve";
    const Value* value = document_.find(path);
    if (!value) return;
    for (const auto& row : table_rows(*value, path, discharge_columns, load_table_)) {
      battery.discharge_curve.emplace_back(row[0], row[1]);
    }
    if (battery.discharge_curve.empty()) value->origin.refuse(std::string(path), "has no rows");
  }

  void read_stroke_table(StrokeTable<double>& table) const {
    const auto [value, path] =
        file_or_rows("transmission.file", "transmission.stroke_table", "rows [crank angle, stroke angle]");
    if (!value) return;  // missing, which is among the errors already
    std::vector<std::pair<double, double>> rows;
    for (const auto& row : table_rows(*value, path, stroke_columns, load_table_)) rows.emplace_back(row[0], row[1]);
    try {
      table.curve = std::make_shared<StrokeCurve>(std::move(rows));
    } catch (const ParameterError& error) {
      value->origin.refuse(path, error.reason());
    }
  }

  void read_chords(Planform<double>& planform) const {
    const auto [value, path] = file_or_rows("wing.planform.file", "wing.planform.chords", "rows [distance, chord]");
    if (!value) return;  // missing, which is among the errors already
    for (const auto& row : table_rows(*value, path, chord_columns, load_table_)) {
      planform.chord_table.emplace_back(row[0], row[1]);
    }
  }

  /// A table that the key of a file gives, or that of rows in place: its value, null where neither is there, and its
  /// key.
  struct StatedTable {
    const Value* value;
    std::string path;
  };
  StatedTable file_or_rows(const char* file, const char* in_place, std::string_view rows) const {
    if (const Value* const value = document_.find(file)) {
      text_of(*value, file, "the name of a CSV file");
      return {value, file};
    }
    const Value* const value = document_.find(in_place);
    if (value && value->kind != TomlNode::Kind::array) wrong(*value, in_place, rows);
    return {value, in_place};
  }

  void check(const Design<double>& d) const {
    try {
      validate(d);
    } catch (const ParameterError& error) {
      std::string key = error.key();
      if (key == "wing.planform.file" && !document_.find(key)) key = "wing.planform.chords";
      if (key == load_table_key::file && !document_.find(key)) key = load_table_key::rows;
      if (key == "transmission.stroke_table" && !document_.find(key)) key = "transmission.file";
      document_.locate(key).refuse(key, error.reason());
    }
  }

  const Document& document_;
  const TableLoader& load_table_;
  InputErrors errors_;
  mutable InputErrors missing_;
  std::vector<std::string_view> absent_;  ///< sections
  std::vector<std::string_view> unread_;  ///< choices
};

}  // namespace

InputError::InputError(std::string file, int line, int column, std::string key, const std::string& message)
    : std::runtime_error(message_text(file, line, column, key, message)),
      file_(std::move(file)),
      line_(line),
      column_(column),
      key_(std::move(key)) {}

Design<double> design_of(Document document, std::span<const Setting> settings, std::span<const std::string> overrides,
                         const TableLoader& load_table) {
  for (const auto& [name, side] : document.sides) {
    document.errors.attempt([&, &n = name, &at = side.origin] { at.refuse(n, sides_refused); });
  }
  document.errors.attempt([&] { apply_overrides(document, settings, overrides); });
  return Reader(document, load_table).read();
}

Design<double> parse_design(std::string_view text, std::string_view file_name, std::span<const std::string> overrides,
                            const TableLoader& load_table) {
  return design_of(parse_document(text, file_name), {}, overrides, load_table);
}

Design<double> read_design(const std::filesystem::path& file, std::span<const Setting> settings,
                           std::span<const std::string> overrides) {
  return design_of(parse_document(read_text_file(file), input_name(file)), settings, overrides,
                   [&](const std::string& name) { return read_text_file(file.parent_path() / name); });
}

Design<double> read_design(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return read_design(file, {}, overrides);
}

}  // namespace wingbeat

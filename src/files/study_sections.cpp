#include "files/study_sections.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "files/design_settings.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::detail {
namespace {

std::string within(std::string_view section, std::string_view key) {
  const std::string shown = one_line(key);
  return section.empty() ? shown : fmt::format("{}.{}", section, shown);
}

std::vector<std::string_view> with(std::initializer_list<std::string_view> common,
                                   std::initializer_list<std::string_view> own) {
  std::vector<std::string_view> all(common);
  all.insert(all.end(), own);
  return all;
}

}  // namespace

StudySections::StudySections(std::string name, std::string_view text, std::span<const std::string> overrides,
                             std::initializer_list<std::string_view> sections,
                             std::initializer_list<std::string_view> keys)
    : TomlReader(std::move(name)),
      root_(parse_toml_tree(text, file(), largest_study)),
      overrides_(overrides.begin(), overrides.end()) {
  known_keys(root_, "", with({"study", "set"}, sections));
  attempt([&] {
    study_ = &need(root_, "", "study", "a section [study] with the name of a vehicle file");
    must_be_section(*study_, "study");
    known_keys(*study_, "study",
               with({"vehicle", "title", "tolerance", "metrics", "hold", "allow_extrapolation"}, keys));
  });
  if (!study_ || study_->kind != Kind::table) finish();
  attempt([&] { find_hold(); });
  attempt([&] { check_overrides(); });
}

std::string StudySections::vehicle_file() const {
  const TomlNode& node = need(*study_, "study", "vehicle", "the name of a vehicle file");
  return text_of(node, "study.vehicle", "the name of a vehicle file");
}

void StudySections::refuse_file(const char* section, const char* key, const std::string& message) const {
  const TomlNode* node = root_.find(section)->find(key);
  refuse(*node, fmt::format("{}.{}", section, key), message);
}

template <class Read>
auto StudySections::with_settings(SupplyType supply, std::span<const KeySettings* const> further,
                                  const Read& read) const {
  std::vector<Setting> settings;
  std::vector<std::string> shown;
  const auto set = [&](const std::string& key, const TomlNode& value, std::string name) {
    settings.push_back({key, value, {file(), value.line, value.column, true}});
    shown.push_back(std::move(name));
  };
  const auto set_all = [&](const KeySettings& given) {
    for (const auto& [key, value] : given.values) set(key, *value, given.shown + "." + key);
  };
  set_all(set_);
  for (const KeySettings* given : further) set_all(*given);
  const char* voltage = is_sine(supply) ? "supply.amplitude" : "supply.voltage";
  if (held_voltage_) set(voltage, *held_voltage_, "study.hold.voltage");
  try {
    return read(settings);
  } catch (const InputError& error) {
    InputErrors errors;
    const auto add = [&](const InputError& e) {
      for (std::size_t k = 0; k < settings.size(); ++k) {
        const Origin& o = settings[k].origin;
        if (e.file() != o.file || e.line() != o.line || e.column() != o.column) continue;
        return errors.add(InputError(o.file, o.line, o.column, shown[k], reason_of(e)));
      }
      errors.add(e);
    };
    add(error);
    for (const InputError& other : error.others()) add(other);
    errors.refuse();
    throw;
  }
}

Design<double> StudySections::vehicle_in(const std::filesystem::path& vehicle,
                                         std::span<const KeySettings* const> further) const {
  const Design<double> alone = read_design(vehicle, overrides_);  // its own errors come first, at its own lines
  return with_settings(alone.supply.type, further,
                       [&](std::span<const Setting> settings) { return read_design(vehicle, settings, overrides_); });
}

VehicleFile StudySections::sides_in(const std::filesystem::path& vehicle) const {
  const VehicleFile alone = wingbeat::read_vehicle(vehicle, overrides_);
  return with_settings(alone.design.supply.type, {}, [&](std::span<const Setting> settings) {
    return wingbeat::read_vehicle(vehicle, settings, overrides_);
  });
}

void StudySections::known_keys(const TomlNode& table, const std::string& section,
                               std::initializer_list<std::string_view> known) const {
  known_keys(table, section, std::span<const std::string_view>(known.begin(), known.size()));
}

void StudySections::known_keys(const TomlNode& table, const std::string& section,
                               std::span<const std::string_view> names) const {
  for (const auto& [key, node] : table.members) {
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    const std::string_view near = nearest_name(key, names);
    if (!near.empty()) spoiled_.insert({&table, std::string(near)});
    attempt([&, &k = key, &n = node] {
      unknown(n, within(section, k), near.empty() ? std::string() : within(section, near), names);
    });
  }
}

const TomlNode& StudySections::need(const TomlNode& table, const std::string& section, std::string_view key,
                                    std::string_view expected) const {
  const TomlNode* node = table.find(key);
  if (!node) {
    if (spoiled_.contains({&table, std::string(key)})) finish();  // misspelt, which is reported already
    const SourceLocation p = table.line > 0 ? place_of(table) : SourceLocation{1, 1};
    refuse(p, within(section, key), fmt::format("missing; expected {}", expected));
  }
  return *node;
}

std::span<const TomlNode> StudySections::sections_of(const std::string& name) const {
  const TomlNode* list = root_.find(name);
  return list ? sections(*list, name) : std::span<const TomlNode>{};
}

std::string reason_of(const InputError& error) {
  const std::string text = error.what();
  std::string prefix = error.file();
  if (error.line() > 0) prefix += fmt::format(":{}:{}", error.line(), error.column());
  return text.substr(std::min(text.size(), prefix.size() + 2));
}

// ---- --set

/// The override of the command line that gives a key, or holds or lies within a table given; null where there is none.
const std::string* StudySections::override_of(std::string_view key) const {
  const auto within_other = [](std::string_view path, std::string_view above) {
    return path.starts_with(above) && (path.size() == above.size() || path[above.size()] == '.');
  };
  for (const std::string& assignment : overrides_) {
    std::string_view path = std::string_view(assignment).substr(0, assignment.find('='));
    while (path.ends_with(' ')) path.remove_suffix(1);
    if (within_other(key, path) || within_other(path, key)) return &assignment;
  }
  return nullptr;
}

void StudySections::no_override_of(std::string_view key, const std::string& reason) const {
  const std::string* assignment = override_of(key);
  if (assignment) throw InputError("--set " + one_line(*assignment, 120), 0, 0, std::string(key), reason);
}

void StudySections::check_overrides() const {
  for (const char* key : {"supply.voltage", "supply.amplitude"}) {
    if (held_voltage_) no_override_of(key, "has no effect: study.hold holds the voltage");
  }
  if (held_target_) {
    no_override_of("supply.voltage", fmt::format("has no effect: study.hold holds the {}", held_key_->name));
  }
}

// ---- [study] and [set]

void StudySections::find_hold() {
  if (const TomlNode* set = root_.find("set")) {
    if (set->kind != Kind::table) wrong(*set, "set", "a section [set] of vehicle-file keys");
    read_keys(*set, "", set_);
  }
  const TomlNode* hold = study_->find("hold");
  if (!hold) return;
  if (hold->kind != Kind::table)
    wrong(*hold, "study.hold", "{ voltage = \"3 V\" }, { frequency = \"22 Hz\" } or { lift_to_weight = 1 }");
  known_keys(*hold, "study.hold", {"voltage", "frequency", "lift", "lift_to_weight", "power"});
  held_voltage_ = hold->find("voltage");
  for (const HeldKey& key : held_keys) {
    const TomlNode* target = hold->find(std::string(key.key));
    if (!target) continue;
    if (held_target_) refuse(*target, "study.hold", fmt::format("holds the {} already", held_key_->name));
    held_target_ = target;
    held_key_ = &key;
  }
  const bool nothing_known = !held_voltage_ && !held_target_ && !hold->members.empty();
  if (nothing_known) finish();  // which is reported already
  if (bool(held_voltage_) == bool(held_target_)) {
    refuse(*hold, "study.hold", "give one of voltage, frequency, lift, lift_to_weight and power");
  }
  if (held_voltage_ && !(quantity(*held_voltage_, "study.hold.voltage", "V") >= 0.0)) {
    refuse(*held_voltage_, "study.hold.voltage", "must be >= 0 V");
  }
  for (const char* key : {"supply.voltage", "supply.amplitude"}) {
    const bool held = held_voltage_ || std::string_view(key) == "supply.voltage";
    if (held && set_.values.contains(key)) refuse(*hold, "study.hold", fmt::format("[set] gives {} already", key));
  }
}

void StudySections::read_keys(const TomlNode& table, const std::string& path, KeySettings& into) const {
  for (const auto& [key, node] : table.members) {
    const std::string full = path.empty() ? key : fmt::format("{}.{}", path, key);
    const bool known = find_parameter<double>(full) != nullptr;
    const bool has_place = attempt([&, &n = node] {
      if (!known && !is_section(full)) refuse(n, into.shown + "." + one_line(full), unknown_key_message(full));
    });
    if (!has_place) continue;
    if (!known && node.kind == Kind::table && full != "wing.planform" && full != "aerodynamics.coefficients") {
      read_keys(node, full, into);
    } else {
      into.values.emplace(full, &node);
    }
  }
}

void StudySections::read_tolerance(EnsembleOptions& options) const {
  const TomlNode* node = study_->find("tolerance");
  if (!node) return;
  const bool fits = node->kind == Kind::number && node->number >= 1e-12 && node->number <= 1e-2;
  if (!fits) wrong(*node, "study.tolerance", "a number from 1e-12 to 1e-2");
  options.tolerance = node->number;
}

void StudySections::read_metrics(EnsembleOptions& options) const {
  const TomlNode* node = study_->find("metrics");
  if (!node) return;
  if (node->kind != Kind::array || node->items.empty()) {
    wrong(*node, "study.metrics", "an array of names such as [\"frequency_hz\", \"lift_mean_n\"]");
  }
  options.metrics.reset();
  for (const TomlNode& item : node->items) {
    if (item.kind != Kind::text) wrong(item, "study.metrics", "the name of a metric");
    const std::size_t index = std::size_t(metric_called(item, "study.metrics", item.text));
    if (options.metrics[index]) {
      refuse(item, "study.metrics", fmt::format("{} is given twice", in_quotes(item.text)));
    }
    options.metrics.set(index);
  }
}

void StudySections::complete_metrics(EnsembleOptions& options, std::span<const Design<double>* const> designs) const {
  const auto no_design_has = [&](Metric metric) {
    return std::all_of(designs.begin(), designs.end(),
                       [&](const Design<double>* design) { return missing_key(metric, *design) != nullptr; });
  };
  if (options.metrics[std::size_t(Metric::endurance)] && !no_design_has(Metric::hover)) {
    options.metrics.set(std::size_t(Metric::hover));
  }
  if (study_->find("metrics")) return;
  for (int m = 0; m < metric_count; ++m) {
    if (no_design_has(Metric(m))) options.metrics.reset(std::size_t(m));
  }
}

std::string StudySections::read_title() const {
  const TomlNode* title = study_->find("title");
  return title ? text_of(*title, "study.title", "a text") : "";
}

std::filesystem::path StudySections::found_vehicle(const std::filesystem::path& folder) const {
  std::filesystem::path vehicle = find_vehicle(folder, vehicle_file());
  if (!is_there(vehicle)) {
    refuse_file("study", "vehicle", fmt::format("there is no file {}", vehicle.string()));
  }
  return vehicle;
}

Design<double> StudySections::read_vehicle(const std::filesystem::path& folder,
                                           std::span<const KeySettings* const> further) const {
  return vehicle_in(found_vehicle(folder), further);
}

VehicleFile StudySections::read_sides(const std::filesystem::path& folder) const {
  return sides_in(found_vehicle(folder));
}

Metric StudySections::metric_called(const TomlNode& node, const std::string& where, const std::string& name) const {
  const int index = metric_index(name);
  if (index != metric_count) return Metric(index);
  std::vector<std::string_view> names;
  for (const MetricInfo& metric : metric_table()) names.push_back(metric.key);
  const std::string_view near = nearest_name(name, names);
  refuse(node, where,
         near.empty() ? fmt::format("{} is no metric; the metrics are {}", in_quotes(name), fmt::join(names, ", "))
                      : fmt::format("{} is no metric; did you mean {}?", in_quotes(name), near));
}

bool StudySections::read_allow_extrapolation() const {
  const TomlNode* node = study_->find("allow_extrapolation");
  return node && boolean(*node, "study.allow_extrapolation");
}

Condition StudySections::read_condition() const {
  const TomlNode* node = study_->find("condition");
  if (!node) return Condition::air;
  return one_of<Condition>(*node, "study.condition");
}

bool swings_a_crank(const Design<double>& design) {
  return design.supply.type == SupplyType::sine && !drive_of(design).alternating;
}

std::optional<Hold> StudySections::read_hold(const Design<double>& design) const {
  if (swings_a_crank(design)) {
    const auto given = set_.values.find("supply.type");
    refuse(given == set_.values.end() ? need(*study_, "study", "vehicle", "") : *given->second, "supply.type",
           no_swinging_crank);
  }
  if (!held_target_) return std::nullopt;
  const std::string why = no_hold(*held_key_, design);
  if (!why.empty()) refuse(*held_target_, within("study.hold", held_key_->key), why);
  return held_target();
}

Hold StudySections::held_target() const {
  const std::string key = within("study.hold", held_key_->key);
  const double value = quantity(*held_target_, key, held_key_->unit);
  if (!(value > 0.0)) refuse(*held_target_, key, must_be_positive(held_key_->unit));
  return {held_key_->held, value};
}

std::string must_be_positive(std::string_view unit) {
  return unit == "1" ? "must be > 0" : fmt::format("must be > 0 {}", unit);
}

const HeldKey* held_key(std::string_view key) {
  for (const HeldKey& k : held_keys) {
    if (k.key == key) return &k;
  }
  return nullptr;
}

const HeldKey& held_key(Held held) {
  return *std::find_if(std::begin(held_keys), std::end(held_keys), [&](const HeldKey& k) { return k.held == held; });
}

std::string no_hold(const HeldKey& key, const Design<double>& design) {
  if (key.held == Held::lift_to_weight && !total_mass(design)) return "the vehicle states no mass; give vehicle.mass";
  return "";
}

bool is_void_at(const HeldKey& held, std::string_view key, const Design<double>& design) {
  const bool voltage = key == "supply.voltage" || key == "supply.duty" || key == "supply.amplitude";
  if (held.held != Held::frequency || drive_of(design).voltage_sets_frequency) return voltage;
  return key == "supply.frequency" || key == "supply.resonance_ratio";
}

DesignParameter StudySections::parameter_named(const TomlNode& node, const std::string& where,
                                               const Design<double>& design) const {
  const std::string key = text_of(node, where, "a vehicle-file key");
  DesignParameter parameter;
  try {
    parameter = design_parameter(key);
  } catch (const ParameterError& error) {
    refuse(node, where, fmt::format("{}: {}", one_line(key), error.reason()));
  }
  if (key == "vehicle.motors" || key == "wing.count" || key == "supply.cells") {
    refuse(node, where, fmt::format("{} is a whole number and has no derivative", key));
  }
  const bool voltage = key == "supply.voltage" || key == "supply.duty" || key == "supply.amplitude";
  if (voltage && held_voltage_) refuse(node, where, "study.hold holds the voltage already");
  if (held_target_ && is_void_at(*held_key_, key, design)) {
    refuse(node, where, fmt::format("{} has no effect where the {} is held", key, held_key_->name));
  }
  if (!parameter.value(design)) {
    const std::string_view only_with = find_parameter<double>(key)->only_with;
    Design<double> trial = design;
    const bool has_place = parameter.set(trial, 1.0);
    refuse(node, where,
           has_place ? fmt::format("{} is not in the vehicle; give it in [set] first", key)
                     : fmt::format("{}: only with {}", key, with_or(only_with)));
  }
  return parameter;
}

}  // namespace wingbeat::detail

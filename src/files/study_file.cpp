#include "wingbeat/files/study_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <set>
#include <utility>

#include "files/design_table.hpp"
#include "files/study_sections.hpp"
#include "files/sweep_checks.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;
using detail::Kind;

constexpr std::uint64_t longest_axis = 1000000;
/// Text keys that name or hold tables, of which no axis is made.
constexpr std::string_view table_keys[] = {"wing.planform.file",
                                           "wing.planform.chords",
                                           "transmission.file",
                                           "transmission.stroke_table",
                                           "aerodynamics.coefficients.table",
                                           load_table_key::file,
                                           load_table_key::rows};

class StudyReader : public detail::StudySections {
 public:
  StudyReader(std::string name, std::string_view text, std::span<const std::string> overrides = {})
      : StudySections(std::move(name), text, overrides, {"axis", "samples"}) {}

  /// The CSV of designs that the study names, or nothing.
  std::optional<std::string> table_file() const {
    const TomlNode* samples = root_.find("samples");
    const TomlNode* file = samples ? samples->find("file") : nullptr;
    if (!file) return std::nullopt;
    return text_of(*file, "samples.file", "the name of a CSV file");
  }

  Study read(const StudyInput& input) {
    Study study;
    study.input = input;
    input_ = &input;
    sweep_ = &study.sweep;
    attempt([&] { study.title = read_title(); });
    attempt([&] { read_tolerance(sweep_->options); });
    attempt([&] { sweep_->allow_extrapolation = read_allow_extrapolation(); });
    attempt([&] { read_metrics(sweep_->options); });
    attempt([&] {
      if (held_target_) sweep_->hold = held_target();
    });
    attempt([&] { read_axes(); });
    attempt([&] {
      if (const TomlNode* samples = root_.find("samples")) read_samples(*samples);
    });
    finish();
    if (sweep_->axes.empty()) {
      refuse(*study_, "study", "nothing to vary; give [[axis]] sections or [samples]");
    }
    places_.study = place_of(*study_);
    if (const auto voltage = set_.values.find("supply.voltage"); voltage != set_.values.end())
      places_.set_voltage = voltage->second;
    detail::complete_sweep(study.sweep, *this, places_, input);
    std::vector<const Design<double>*> designs;
    for (const auto& v : study.sweep.variants) designs.push_back(&v.design);
    complete_metrics(study.sweep.options, designs);
    return study;
  }

 private:
  // ---- [[axis]]

  /// What is varied under that name. `where` is the key of the study file that gives the name.
  SweptQuantity quantity_named(const TomlNode& node, const std::string& where) {
    if (node.kind != Kind::text)
      wrong(node, where, "a vehicle-file key, \"frequency\", \"lift\", \"condition\" or \"springs\"");
    SweptQuantity q;
    q.key = node.text;
    q.name = q.key;
    std::replace(q.name.begin(), q.name.end(), '.', '_');
    q.unit = "1";
    const Parameter<double>* key = find_parameter<double>(q.key);
    if (!used_.insert(q.key).second) refuse(node, where, fmt::format("{} is varied already", q.key));
    if (set_.values.contains(q.key)) refuse(node, where, fmt::format("{} is given in [set] already", q.key));
    no_override_of(q.key, "has no effect: the study varies it");
    if (const detail::HeldKey* held = detail::held_key(q.key)) {
      q.kind = SweptQuantity::Kind::held;
      q.name = held->axis;
      q.unit = held->unit;
      q.meaning = fmt::format("{} asked for", held->held == Held::frequency ? "flapping frequency" : held->name);
      if (held_target_) refuse(node, where, fmt::format("study.hold holds the {} already", held_key_->name));
      if (held_voltage_)
        refuse(node, where, fmt::format("study.hold holds the voltage, which then sets the {}", held->name));
      if (sweep_->hold) refuse(node, where, "another axis gives what is held");
      sweep_->hold = Hold{held->held};
    } else if (q.key == "condition") {
      q.kind = SweptQuantity::Kind::choice;
      q.meaning = "environment: air, vacuum or without wings";
    } else if (q.key == "springs") {
      q.kind = SweptQuantity::Kind::choice;
      q.meaning = "hinge springs on or off";
    } else if (!key) {
      const std::string_view own[] = {"frequency", "lift", "lift_to_weight", "condition", "springs"};
      const std::string_view near = nearest_name(q.key, own);
      refuse(
          node, where,
          fmt::format("{}: {}", one_line(q.key),
                      near.empty() ? unknown_key_message(q.key) : fmt::format("unknown key; did you mean {}?", near)));
    } else if (key->set) {
      q.unit = std::string(key->unit);
      q.meaning = std::string(key->meaning);
      q.set = key->set;
    } else {
      if (std::find(std::begin(table_keys), std::end(table_keys), q.key) != std::end(table_keys)) {
        refuse(node, where, fmt::format("{} is a table, of which no axis can be made", q.key));
      }
      q.kind = SweptQuantity::Kind::choice;
      q.meaning = std::string(key->meaning);
    }
    if ((q.key == "supply.voltage" || q.key == "supply.amplitude") && held_voltage_)
      refuse(node, where, "study.hold holds the voltage already");
    places_.keys[q.key] = place_of(node);
    return q;
  }

  void add_value(SweptQuantity& q, const TomlNode& node, const std::string& where) {
    if (q.kind == SweptQuantity::Kind::choice) {
      if (q.key == "springs") {
        q.labels.push_back(boolean(node, where) ? "on" : "off");
      } else if (q.key == "condition") {
        q.labels.push_back(name_of(one_of<Condition>(node, where)));
      } else {
        q.labels.push_back(text_of(node, where, find_parameter<double>(q.key)->range.text));
      }
      return;
    }
    const double x = quantity(node, where, q.unit);
    if (q.kind == SweptQuantity::Kind::held && !(x > 0.0)) {
      refuse(node, where, detail::must_be_positive(q.unit));
    }
    q.values.push_back(x);
  }

  void read_axes() {
    const TomlNode* axes = root_.find("axis");
    if (!axes) return;
    if (axes->kind != Kind::array) wrong(*axes, "axis", "[[axis]] sections");
    for (const TomlNode& node : axes->items) {
      if (node.kind != Kind::table) wrong(node, "axis", "[[axis]] sections");
      attempt([&] { read_axis(node); });
    }
  }

  void read_axis(const TomlNode& node) {
    known_keys(node, "axis", {"key", "keys", "name", "values", "from", "to", "count", "scale"});
    SweepAxis axis;
    const TomlNode* key = node.find("key");
    const TomlNode* keys = node.find("keys");
    if (bool(key) == bool(keys)) refuse(node, "axis", "give one of key and keys");
    if (key) {
      axis.quantities.push_back(quantity_named(*key, "axis.key"));
    } else {
      if (keys->kind != Kind::array || keys->items.empty()) wrong(*keys, "axis.keys", "an array of keys");
      for (const TomlNode& item : keys->items) axis.quantities.push_back(quantity_named(item, "axis.keys"));
    }
    axis.name = axis.quantities.front().name;
    if (const TomlNode* name = node.find("name")) axis.name = identifier(*name, "axis.name");
    if (key) axis.quantities.front().name = axis.name;

    const TomlNode* values = node.find("values");
    if (values) {
      for (const char* other : {"from", "to", "count", "scale"}) {
        if (const TomlNode* given = node.find(other)) {
          refuse(*given, fmt::format("axis.{}", other), "give values, or from, to and count, not both");
        }
      }
      read_values(axis, *values);
    } else {
      if (keys) refuse(node, "axis.values", "missing; expected one row of values for each key of keys");
      if (axis.quantities.front().kind == SweptQuantity::Kind::choice) {
        refuse(node, "axis.values", fmt::format("missing; expected the values of {}", axis.quantities.front().key));
      }
      read_range(axis, node);
    }
    places_.axes.push_back(place_of(node));
    sweep_->axes.push_back(std::move(axis));
  }

  std::string identifier(const TomlNode& node, const std::string& key) const {
    const char* expected = "a name of letters, digits and _, beginning with a letter";
    const std::string name = text_of(node, key, expected);
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    const bool good = letter(name.front()) && name.size() <= 60 && std::all_of(name.begin(), name.end(), [&](char c) {
                        return letter(c) || (c >= '0' && c <= '9') || c == '_';
                      });
    if (!good) wrong(node, key, expected);
    return name;
  }

  void read_values(SweepAxis& axis, const TomlNode& node) {
    const bool zipped = axis.quantities.size() > 1;
    if (node.kind != Kind::array || node.items.empty()) wrong(node, "axis.values", "an array of values");
    if (!zipped) {
      for (const TomlNode& item : node.items) add_value(axis.quantities.front(), item, "axis.values");
    } else {
      if (node.items.size() != axis.quantities.size()) {
        refuse(node, "axis.values",
               fmt::format("expected {} arrays of values, one for each of keys, got {}", axis.quantities.size(),
                           node.items.size()));
      }
      for (std::size_t q = 0; q < node.items.size(); ++q) {
        const TomlNode& row = node.items[q];
        if (row.kind != Kind::array) wrong(row, "axis.values", "an array of values for each of keys");
        if (row.items.empty() || row.items.size() != node.items.front().items.size()) {
          refuse(row, "axis.values",
                 fmt::format("{} has {} values, {} has {}", axis.quantities[q].key, row.items.size(),
                             axis.quantities.front().key, node.items.front().items.size()));
        }
        for (const TomlNode& item : row.items) add_value(axis.quantities[q], item, "axis.values");
      }
    }
    const SweptQuantity& first = axis.quantities.front();
    axis.count = std::max(first.values.size(), first.labels.size());
    if (axis.count > longest_axis) refuse(node, "axis.values", "more than 1000000 values");
    if (zipped) return;
    const auto& items = node.items;
    const auto twice = [&](const auto& list) {
      std::map<typename std::decay_t<decltype(list)>::value_type, std::size_t> seen;
      for (std::size_t n = 0; n < list.size(); ++n) {
        if (!seen.emplace(list[n], n).second) refuse(items[n], "axis.values", "the same value is given twice");
      }
    };
    twice(first.values);
    twice(first.labels);
  }

  bool logarithmic(const TomlNode& node, const std::string& section) const {
    const TomlNode* scale = node.find("scale");
    return scale && one_of(*scale, section + ".scale", {"linear", "log"}) == "log";
  }

  void read_ends(SweptQuantity& q, const TomlNode& node, const std::string& section) {
    const TomlNode& from = need(node, section, "from", quantity_example(q.unit));
    const TomlNode& to = need(node, section, "to", quantity_example(q.unit));
    q.low = quantity(from, section + ".from", q.unit);
    q.high = quantity(to, section + ".to", q.unit);
    q.logarithmic = logarithmic(node, section);
    if (q.low == q.high) refuse(to, section + ".to", "is the value of from");
    const bool positive = q.logarithmic || q.kind == SweptQuantity::Kind::held;
    const std::string why = q.logarithmic ? "must be > 0 on a logarithmic scale" : detail::must_be_positive(q.unit);
    if (positive && !(q.low > 0.0)) refuse(from, section + ".from", why);
    if (positive && !(q.high > 0.0)) refuse(to, section + ".to", why);
  }

  void read_range(SweepAxis& axis, const TomlNode& node) {
    SweptQuantity& q = axis.quantities.front();
    read_ends(q, node, "axis");
    axis.count = whole_number(need(node, "axis", "count", "a whole number"), "axis.count", 2, longest_axis);
    const double last = double(axis.count - 1);
    for (std::uint64_t n = 0; n < axis.count; ++n) {
      const double k = double(n);
      const double x =
          q.logarithmic ? q.low * std::pow(q.high / q.low, k / last) : ((last - k) * q.low + k * q.high) / last;
      q.values.push_back(n == 0 ? q.low : n + 1 == axis.count ? q.high : x);
    }
  }

  // ---- [samples]

  void read_samples(const TomlNode& node) {
    must_be_section(node, "samples");
    known_keys(node, "samples", {"method", "count", "seed", "range", "file"});
    const TomlNode& method = need(node, "samples", "method", "\"latin-hypercube\", \"sobol\" or \"csv\"");
    const std::string name = one_of(method, "samples.method", {"latin-hypercube", "sobol", "csv"});
    SweepAxis axis;
    axis.name = "sample";
    axis.samples = true;
    const auto not_with = [&](std::initializer_list<const char*> keys) {
      for (const char* key : keys) {
        if (const TomlNode* given = node.find(key)) {
          refuse(*given, fmt::format("samples.{}", key), fmt::format("does not apply with method = \"{}\"", name));
        }
      }
    };
    places_.axes.push_back(place_of(node));
    if (name == "csv") {
      not_with({"count", "seed", "range"});
      need(node, "samples", "file", "the name of a CSV file");
      const SourceLocation place = place_of(*node.find("file"));
      places_.table_lines =
          detail::parse_design_table(input_->table, input_->table_name, axis, [&](const auto& heading) {
            TomlNode key;
            key.kind = Kind::text;
            key.text = heading;
            key.line = place.line;
            key.column = place.column;
            return quantity_named(key, "");
          });
      sweep_->axes.push_back(std::move(axis));
      return;
    }
    not_with({"file"});
    const TomlNode& ranges = need(node, "samples", "range", "[[samples.range]] sections");
    if (ranges.kind != Kind::array || ranges.items.empty())
      wrong(ranges, "samples.range", "[[samples.range]] sections");
    for (const TomlNode& range : ranges.items) {
      if (range.kind != Kind::table) wrong(range, "samples.range", "[[samples.range]] sections");
      known_keys(range, "samples.range", {"key", "from", "to", "scale"});
      const TomlNode& key = need(range, "samples.range", "key", "a vehicle-file key");
      SweptQuantity q = quantity_named(key, "samples.range.key");
      if (q.kind == SweptQuantity::Kind::choice) {
        refuse(key, "samples.range.key", fmt::format("{} is not a number; make it an [[axis]]", q.key));
      }
      read_ends(q, range, "samples.range");
      if (q.low > q.high) std::swap(q.low, q.high);
      axis.quantities.push_back(std::move(q));
    }
    axis.count = whole_number(need(node, "samples", "count", "a whole number"), "samples.count", 1, 1000000000);
    const TomlNode* seed = node.find("seed");
    const std::uint64_t s = seed ? whole_number(*seed, "samples.seed", 0, std::uint64_t(1) << 53) : 1;
    if (name == "sobol") {
      if (axis.quantities.size() > ScrambledSobol::max_dimensions) {
        refuse(ranges, "samples.range", fmt::format("sobol varies at most {} keys", ScrambledSobol::max_dimensions));
      }
      axis.sobol.emplace(axis.quantities.size(), s);
    } else {
      axis.latin_hypercube = LatinHypercube{axis.count, s};
    }
    sweep_->axes.push_back(std::move(axis));
  }

  std::set<std::string> used_;
  detail::SweepPlaces places_;
  const StudyInput* input_ = nullptr;
  Sweep* sweep_ = nullptr;
};

}  // namespace

Study parse_study(const StudyInput& input) { return StudyReader(input.study_name, input.study).read(input); }

Study read_study(const fs::path& file, std::span<const std::string> overrides) {
  StudyInput input;
  input.study_name = input_name(file);
  input.study = read_text_file(file, largest_study);
  StudyReader reader(input.study_name, input.study, overrides);
  const fs::path folder = file.parent_path();
  reader.attempt([&] {
    const fs::path vehicle = find_vehicle(folder, reader.vehicle_file());
    if (!is_there(vehicle)) {
      reader.refuse_file("study", "vehicle", fmt::format("there is no file {}", vehicle.string()));
    }
    input.design = reader.vehicle_in(vehicle);
    input.vehicle = write_design(*input.design);
  });
  const bool all_read = reader.attempt([&] {
    const auto table = reader.table_file();
    if (!table) return;
    const fs::path path = folder / *table;
    if (!is_there(path)) reader.refuse_file("samples", "file", fmt::format("there is no file {}", path.string()));
    input.table_name = path.string();
    input.table = detail::read_design_table_file(path);
  });
  if (!all_read) reader.finish();
  return reader.read(input);
}

}  // namespace wingbeat

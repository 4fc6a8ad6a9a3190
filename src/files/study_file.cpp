#include "wingbeat/files/study_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <set>
#include <utility>

#include "files/study_sections.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;
using detail::Kind, detail::Place, detail::place_of, detail::toml_text;

constexpr std::uint64_t longest_axis = 1000000;
constexpr std::uint64_t max_designs = 1000000000000;
constexpr std::size_t max_variants = 1000;
/// Text keys that name or hold tables, of which no axis is made.
constexpr std::string_view table_keys[] = {"wing.planform.file", "wing.planform.chords", "transmission.stroke_table",
                                           "aerodynamics.coefficients.table"};
constexpr std::string_view own_variables[] = {"status", "recomputed", "error_estimate", "sample"};

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
      if (held_frequency_) sweep_->frequency = quantity(*held_frequency_, "study.hold.frequency", "Hz");
      if (sweep_->frequency && !(*sweep_->frequency > 0.0)) {
        refuse(*held_frequency_, "study.hold.frequency", "must be > 0 Hz");
      }
    });
    attempt([&] { read_axes(); });
    attempt([&] {
      if (const TomlNode* samples = root_.find("samples")) read_samples(*samples);
    });
    finish();
    if (sweep_->axes.empty()) {
      refuse(*study_, "study", "nothing to vary; give [[axis]] sections or [samples]");
    }
    check_names();
    check_size();
    make_variants();
    check_supply();
    check_places();
    check_ranges();
    return study;
  }

 private:
  // ---- [[axis]]

  /// What is varied under that name. `where` is the key of the study file that gives the name.
  SweptQuantity quantity_named(const TomlNode& node, const std::string& where) {
    if (node.kind != Kind::text) wrong(node, where, "a vehicle-file key, \"frequency\", \"condition\" or \"springs\"");
    SweptQuantity q;
    q.key = node.text;
    q.name = q.key;
    std::replace(q.name.begin(), q.name.end(), '.', '_');
    q.unit = "1";
    const Parameter<double>* key = find_parameter<double>(q.key);
    if (!used_.insert(q.key).second) refuse(node, where, fmt::format("{} is varied already", q.key));
    if (set_.contains(q.key)) refuse(node, where, fmt::format("{} is given in [set] already", q.key));
    no_override_of(q.key, "has no effect: the study varies it");
    if (q.key == "frequency") {
      q.kind = SweptQuantity::Kind::frequency;
      q.unit = "Hz";
      q.meaning = "flapping frequency asked for";
      if (held_frequency_) refuse(node, where, "study.hold holds the frequency already");
      if (held_voltage_) refuse(node, where, "study.hold holds the voltage, which then sets the frequency");
      frequency_axis_ = true;
    } else if (q.key == "condition") {
      q.kind = SweptQuantity::Kind::choice;
      q.meaning = "environment: air, vacuum or without wings";
    } else if (q.key == "springs") {
      q.kind = SweptQuantity::Kind::choice;
      q.meaning = "hinge springs on or off";
    } else if (!key) {
      const std::string_view own[] = {"frequency", "condition", "springs"};
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
    origins_[q.key] = place_of(node);
    return q;
  }

  void add_value(SweptQuantity& q, const TomlNode& node, const std::string& where) {
    if (q.kind == SweptQuantity::Kind::choice) {
      if (q.key == "springs") {
        if (node.kind != Kind::boolean) wrong(node, where, "true or false");
        q.labels.push_back(node.number != 0.0 ? "on" : "off");
      } else if (q.key == "condition") {
        q.labels.push_back(name_of(one_of<Condition>(node, where)));
      } else {
        q.labels.push_back(text_of(node, where, find_parameter<double>(q.key)->range.text));
      }
      return;
    }
    const double x = quantity(node, where, q.unit);
    if (q.kind == SweptQuantity::Kind::frequency && !(x > 0.0)) refuse(node, where, "must be > 0 Hz");
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
    axis_places_.push_back(place_of(node));
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
    const bool positive = q.logarithmic || q.kind == SweptQuantity::Kind::frequency;
    const char* why = q.logarithmic ? "must be > 0 on a logarithmic scale" : "must be > 0 Hz";
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
    if (node.kind != Kind::table) wrong(node, "samples", "a section [samples]");
    known_keys(node, "samples", {"method", "count", "seed", "range", "file"});
    const TomlNode& method = need(node, "samples", "method", "\"latin-hypercube\", \"sobol\" or \"csv\"");
    const std::string name = one_of(method, "samples.method", {"latin-hypercube", "sobol", "csv"});
    SweepAxis axis;
    axis.name = "sample";
    axis.samples = true;
    const auto not_with = [&](std::initializer_list<const char*> keys) {
      for (const char* key : keys) {
        if (const TomlNode* given = node.find(key)) {
          refuse(*given, fmt::format("samples.{}", key), fmt::format("has no place with method = \"{}\"", name));
        }
      }
    };
    axis_places_.push_back(place_of(node));
    if (name == "csv") {
      not_with({"count", "seed", "range"});
      need(node, "samples", "file", "the name of a CSV file");
      read_table(axis, *node.find("file"));
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

  /// Designs from a CSV: a header of keys with units, "transmission.crank_radius [mm]", and a line for each design.
  void read_table(SweepAxis& axis, const TomlNode& node) {
    const std::string& file = input_->table_name;
    std::string_view text = input_->table;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    int line_number = 0;
    std::vector<std::string> units;
    const auto trim = [](std::string_view s) {
      const auto first = s.find_first_not_of(" \t\r");
      return first == std::string_view::npos ? std::string_view{}
                                             : s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
    };
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line_number;
      if (trim(line).empty() || trim(line).starts_with('#')) continue;
      std::vector<std::pair<std::string_view, int>> cells;
      for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t stop = std::min(line.find(',', begin), line.size());
        const std::string_view raw = line.substr(begin, stop - begin);
        const std::size_t blank = std::min(raw.find_first_not_of(" \t\r"), raw.size());
        cells.emplace_back(trim(raw), int(begin + blank + 1));
        begin = stop + 1;
      }
      if (axis.quantities.empty()) {
        for (const auto& [cell, column] : cells) {
          const auto refuse_here = [&, c = column](const std::string& message) {
            throw InputError(file, line_number, c, "", message);
          };
          const auto bracket = std::min(cell.find_first_of("[("), cell.size());
          std::string_view unit = trim(cell.substr(bracket));
          if (!unit.empty()) {
            const bool closed = unit.size() > 2 && unit.back() == (unit.front() == '[' ? ']' : ')');
            if (!closed)
              refuse_here(
                  fmt::format("{}: the unit stands in brackets, as in \"motor.inertia [kg m2]\"", in_quotes(cell)));
            unit = trim(unit.substr(1, unit.size() - 2));
          }
          TomlNode key;
          key.kind = Kind::text;
          key.text = std::string(trim(cell.substr(0, bracket)));
          key.line = node.line;
          key.column = node.column;
          SweptQuantity q;
          try {
            q = quantity_named(key, "");
          } catch (const InputError& error) {
            refuse_here(reason_of(error));
          }
          if (q.kind == SweptQuantity::Kind::choice) refuse_here(fmt::format("{} is not a number", q.key));
          if (unit.empty() && q.unit != "1") {
            refuse_here(fmt::format("{} names no unit; expected a heading such as \"{} [{}]\"", q.key, q.key, q.unit));
          }
          try {
            unit_factor(unit, q.unit);
          } catch (const UnitError& error) {
            refuse_here(fmt::format("{}: {}", q.key, error.what()));
          }
          units.emplace_back(unit);
          axis.quantities.push_back(std::move(q));
        }
        continue;
      }
      if (cells.size() != axis.quantities.size()) {
        throw InputError(file, line_number, 1, "",
                         fmt::format("expected {} numbers, got {}", axis.quantities.size(), cells.size()));
      }
      for (std::size_t n = 0; n < cells.size(); ++n) {
        SweptQuantity& q = axis.quantities[n];
        try {
          q.values.push_back(parse_quantity(fmt::format("{} {}", cells[n].first, units[n]), q.unit));
        } catch (const UnitError&) {
          throw InputError(file, line_number, cells[n].second, q.key,
                           fmt::format("expected a number, got {}", in_quotes(cells[n].first)));
        }
        if (q.kind == SweptQuantity::Kind::frequency && !(q.values.back() > 0.0)) {
          throw InputError(file, line_number, cells[n].second, q.key, "must be > 0 Hz");
        }
      }
      table_lines_.push_back(line_number);
    }
    if (table_lines_.empty()) {
      throw InputError(file, 0, 0, "",
                       "holds no designs; expected a header such as \"transmission.crank_radius [mm]\" "
                       "and a line for each design");
    }
    axis.count = table_lines_.size();
  }

  // ---- The sweep as a whole

  void check_names() const {
    std::set<std::string, std::less<>> names(std::begin(own_variables), std::end(own_variables));
    for (const MetricInfo& metric : metric_table()) names.insert(metric.key);
    for (std::size_t a = 0; a < sweep_->axes.size(); ++a) {
      const SweepAxis& axis = sweep_->axes[a];
      std::set<std::string> here;
      if (!axis.samples) here.insert(axis.name);
      for (const SweptQuantity& q : axis.quantities) here.insert(q.name);
      for (const std::string& name : here) {
        if (!names.insert(name).second) {
          refuse(axis_places_[a], "axis.name", fmt::format("{} is the name of another variable", name));
        }
      }
    }
  }

  void check_size() const {
    std::uint64_t product = 1;
    for (std::size_t a = 0; a < sweep_->axes.size(); ++a) {
      if (sweep_->axes[a].count > max_designs / product) {
        refuse(axis_places_[a], "axis", "the study has more than 1e12 designs");
      }
      product *= sweep_->axes[a].count;
    }
  }

  static bool has_choice(const SweepAxis& axis) {
    return std::any_of(axis.quantities.begin(), axis.quantities.end(),
                       [](const SweptQuantity& q) { return q.kind == SweptQuantity::Kind::choice; });
  }

  void make_variants() {
    Sweep& sweep = *sweep_;
    sweep.variant_stride.assign(sweep.axes.size(), 0);
    std::size_t count = 1;
    for (std::size_t a = sweep.axes.size(); a-- > 0;) {
      if (!has_choice(sweep.axes[a])) continue;
      sweep.variant_stride[a] = count;
      if (sweep.axes[a].count > max_variants / count) {
        refuse(axis_places_[a], "axis", fmt::format("more than {} combinations of choices", max_variants));
      }
      count *= std::size_t(sweep.axes[a].count);
    }
    for (std::size_t v = 0; v < count; ++v) sweep.variants.push_back(variant(v));
  }

  SweepVariant variant(std::size_t index) {
    SweepVariant result;
    std::vector<std::string> overrides;
    std::vector<std::string> keys;
    for (std::size_t a = 0; a < sweep_->axes.size(); ++a) {
      const SweepAxis& axis = sweep_->axes[a];
      if (sweep_->variant_stride[a] == 0) continue;
      const std::size_t n = index / sweep_->variant_stride[a] % std::size_t(axis.count);
      for (const SweptQuantity& q : axis.quantities) {
        if (q.key == "condition") {
          result.condition = *from_name<Condition>(q.labels[n]);
        } else if (q.key == "springs") {
          result.springs = q.labels[n] == "on";
        } else if (q.kind != SweptQuantity::Kind::frequency) {
          TomlNode value;
          value.kind = q.labels.empty() ? Kind::number : Kind::text;
          if (q.labels.empty()) value.number = q.values[n];
          else value.text = q.labels[n];
          overrides.push_back(fmt::format("{}={}", q.key, toml_text(value)));
          keys.push_back(q.key);
        }
      }
    }
    try {
      result.design = parse_design(input_->vehicle, "the vehicle with [set]", overrides);
    } catch (const InputError& error) {
      for (std::size_t k = 0; k < overrides.size(); ++k) {
        if (error.file() == "--set " + one_line(overrides[k], 120)) {
          refuse(origins_.at(keys[k]), "axis", reason_of(error));
        }
      }
      if (!keys.empty()) refuse(origins_.at(keys.front()), "axis", reason_of(error));
      throw;
    }
    return result;
  }

  void check_supply() const {
    const auto at = [&](const char* key) {
      const auto found = origins_.find(key);
      return found == origins_.end() ? place_of(*study_) : found->second;
    };
    const bool frequency = held_frequency_ || frequency_axis_;
    for (const SweepVariant& v : sweep_->variants) {
      if (swings_a_crank(v.design)) refuse(at("supply.type"), "supply.type", no_swinging_crank);
      if (frequency && v.design.supply.type == SupplyType::battery) {
        refuse(at("supply.type"), "supply.type", no_held_frequency);
      }
      if (frequency && v.design.supply.type == SupplyType::pwm && !(v.design.supply.duty > 0.0)) {
        refuse(at("supply.duty"), "supply.duty", "is 0: no voltage sets the flapping frequency");
      }
    }
    for (const char* key : {"supply.frequency", "supply.resonance_ratio"}) {
      if (frequency && origins_.contains(key)) refuse(at(key), key, "has no effect where the frequency is held");
    }
    for (const char* key : {"supply.voltage", "supply.duty"}) {
      if (frequency && origins_.contains(key)) {
        refuse(at(key), key, "has no effect where the frequency is held: the voltage is found for it");
      }
    }
    if (held_frequency_ && set_.contains("supply.voltage")) {
      refuse(*set_.at("supply.voltage"), "set.supply.voltage", "has no effect where the frequency is held");
    }
  }

  /// A number of the study at a fraction of the way along its axis.
  static double number_at(const SweepAxis& axis, std::size_t q, double fraction) {
    const SweptQuantity& quantity = axis.quantities[q];
    if (quantity.values.empty()) return quantity.low + fraction * (quantity.high - quantity.low);
    return quantity.values[std::size_t(fraction * double(quantity.values.size() - 1))];
  }

  template <class Do>
  void for_each_number(const Do& act) const {
    for (std::size_t a = 0; a < sweep_->axes.size(); ++a) {
      for (std::size_t q = 0; q < sweep_->axes[a].quantities.size(); ++q) {
        if (sweep_->axes[a].quantities[q].kind == SweptQuantity::Kind::number) act(sweep_->axes[a], q);
      }
    }
  }

  /// Every key has a place in every variant, and no key undoes another.
  void check_places() const {
    for (const SweepVariant& variant : sweep_->variants) {
      Design<double> d = variant.design;
      for_each_number([&](const SweepAxis& axis, std::size_t q) {
        const SweptQuantity& quantity = axis.quantities[q];
        if (quantity.set(d, number_at(axis, q, 0.5))) return;
        const std::string_view only_with = find_parameter<double>(quantity.key)->only_with;
        refuse(origins_.at(quantity.key), quantity.key,
               only_with.empty() ? "has no place in this vehicle" : fmt::format("only with {}", only_with));
      });
      for_each_number([&](const SweepAxis& axis, std::size_t q) {
        const SweptQuantity& quantity = axis.quantities[q];
        const auto found = find_parameter<double>(quantity.key)->get(d);
        if (!found || *found != number_at(axis, q, 0.5)) {
          refuse(origins_.at(quantity.key), quantity.key, "another varied key takes its place");
        }
      });
      const auto spring = [](const std::optional<double>& x) { return x && *x > 0.0; };
      const auto place = origins_.find("springs");
      if (place != origins_.end() && variant.springs && !spring(d.spring.stiffness) && !spring(d.spring.resonance)) {
        refuse(place->second, "springs",
               "the vehicle has none to switch on; give spring.stiffness or spring.resonance "
               "in the vehicle file, in [set] or as an axis");
      }
    }
  }

  /// Why no design with these numbers is possible, or nothing if one is: other axes at either end and in the middle.
  std::optional<ParameterError> impossible(const std::function<void(Design<double>&)>& set,
                                           std::string_view blamed) const {
    std::optional<ParameterError> reason;
    for (const SweepVariant& variant : sweep_->variants) {
      for (const double fraction : {0.0, 0.5, 1.0}) {
        Design<double> d = variant.design;
        for_each_number(
            [&](const SweepAxis& axis, std::size_t q) { axis.quantities[q].set(d, number_at(axis, q, fraction)); });
        set(d);
        if (!variant.springs) d.spring = {};
        try {
          validate(d);
          return std::nullopt;
        } catch (const ParameterError& error) {
          if (!blamed.empty() && error.key() != blamed) return std::nullopt;
          if (!reason) reason = error;
        }
      }
    }
    return reason;
  }

  void check_ranges() const {
    for_each_number([&](const SweepAxis& axis, std::size_t q) {
      const SweptQuantity& quantity = axis.quantities[q];
      if (!table_lines_.empty() && axis.samples) return;
      std::vector<double> tried = {number_at(axis, q, 0.0), number_at(axis, q, 1.0)};
      if (quantity.low == quantity.high) tried = quantity.values;
      for (const double x : tried) {
        const auto reason = impossible([&](Design<double>& d) { quantity.set(d, x); }, quantity.key);
        if (reason) refuse(origins_.at(quantity.key), quantity.key, reason->reason());
      }
    });
    for (std::size_t row = 0; row < table_lines_.size(); ++row) {
      const SweepAxis& axis = sweep_->axes.back();
      const auto reason = impossible(
          [&](Design<double>& d) {
            for (const SweptQuantity& q : axis.quantities) {
              if (q.set) q.set(d, q.values[row]);
            }
          },
          "");
      if (reason) throw InputError(input_->table_name, table_lines_[row], 1, reason->key(), reason->reason());
    }
  }

  bool frequency_axis_ = false;
  std::set<std::string> used_;
  std::map<std::string, Place, std::less<>> origins_;  ///< of the varied keys
  std::vector<Place> axis_places_;
  std::vector<int> table_lines_;  ///< of the designs in a CSV
  const StudyInput* input_ = nullptr;
  Sweep* sweep_ = nullptr;
};

/// A CSV of designs may be larger than a vehicle file.
std::string read_table_file(const fs::path& file) {
  constexpr std::uintmax_t largest = 256u << 20;
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error) throw InputError(file.string(), 0, 0, "", "cannot be read: " + error.message());
  if (size > largest) throw InputError(file.string(), 0, 0, "", "larger than 256 MB");
  std::string text(size, '\0');
  std::FILE* stream = std::fopen(file.c_str(), "rb");
  const std::size_t got = stream ? std::fread(text.data(), 1, text.size(), stream) : 0;
  if (stream) std::fclose(stream);
  if (got != text.size()) throw InputError(file.string(), 0, 0, "", "cannot be read");
  FileRecord::of_this_program().add_read(file);
  return text;
}

}  // namespace

Study parse_study(const StudyInput& input) { return StudyReader(input.study_name, input.study).read(input); }

Study read_study(const fs::path& file, std::span<const std::string> overrides) {
  StudyInput input;
  input.study_name = input_name(file);
  input.study = read_text_file(file);
  StudyReader reader(input.study_name, input.study, overrides);
  const fs::path folder = file.parent_path();
  reader.attempt([&] {
    const fs::path vehicle = find_vehicle(folder, reader.vehicle_file());
    if (!fs::exists(vehicle)) {
      reader.refuse_file("study", "vehicle", fmt::format("there is no file {}", vehicle.string()));
    }
    input.vehicle = reader.vehicle_text(vehicle);
  });
  const bool all_read = reader.attempt([&] {
    const auto table = reader.table_file();
    if (!table) return;
    const fs::path path = folder / *table;
    if (!fs::exists(path)) reader.refuse_file("samples", "file", fmt::format("there is no file {}", path.string()));
    input.table_name = path.string();
    input.table = read_table_file(path);
  });
  if (!all_read) reader.finish();
  return reader.read(input);
}

}  // namespace wingbeat

#include "wingbeat/files/measured_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <type_traits>

#include "files/free_parameter.hpp"
#include "files/measured_flight.hpp"
#include "files/measured_hover.hpp"
#include "files/measured_maps.hpp"
#include "files/measured_table.hpp"
#include "files/toml_document.hpp"
#include "files/toml_fields.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/cycle/metrics.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {
namespace {

using Kind = TomlNode::Kind;
using Cell = MeasuredTable::Cell;

constexpr double degree = 1.0 / degrees_per_radian;

class MeasuredReader {
 public:
  MeasuredReader(const std::filesystem::path& path, std::string text)
      : path_(path),
        name_(input_name(path)),
        text_(std::move(text)),
        tree_(parse_toml_tree(text_, name_)),
        root_(name_, "", tree_),
        plan_(section("validation")) {}

  ValidationSet read() {
    const std::string_view sections[] = {"measured", "notes", "known", "tables", "data", "validation"};
    root_.known_keys(sections);
    set_.name = path_ == "-" ? name_ : path_.stem().string();
    read_texts();
    table_ = MeasuredTable(section("data"));
    set_.rows = int(table_.rows().size());
    set_.model = plan_.choice<ValidationModel>("model");
    set_.split = plan_.choice<ValidationSplit>("split", ValidationSplit::alternate);
    set_.assumes = texts(plan_, "assumes");
    set_.not_predicted = texts(plan_, "not_predicted");
    if (set_.model == ValidationModel::none) {
      known({"reason"});
      set_.reason = plan_.needed_text("reason", "why the program predicts nothing of it");
      return std::move(set_);
    }
    set_.operating_point = texts(plan_, "operating_point");
    switch (set_.model) {
      case ValidationModel::prescribed: read_prescribed(); break;
      case ValidationModel::bench: read_bench(); break;
      case ValidationModel::passive_pitch: read_passive_pitch(); break;
      case ValidationModel::ratios: read_ratios(); break;
      case ValidationModel::resistance: read_resistance(); break;
      case ValidationModel::maps:
        known({"vehicle", "settings", "hinge_offset", "map"});
        set_.problem = detail::read_maps(plan_, table_, vehicle(), set_);
        break;
      case ValidationModel::prescribed_flight:
        known({"wings", "air_density", "frequency", "stroke_mean", "stroke_harmonics", "pitch_mean", "pitch_harmonics",
               "speed", "stroke_plane_tilt", "load"});
        set_.problem = detail::read_flight(root_, plan_, table_, set_);
        break;
      case ValidationModel::flight:
        known({"vehicle", "settings", "value", "map"});
        set_.problem = detail::read_hover(plan_, table_, vehicle(), set_);
        break;
      case ValidationModel::none: break;
    }
    return std::move(set_);
  }

 private:
  TomlFields section(std::string_view key) const {
    const auto found = root_.table(key);
    if (!found) root_.refuse(key, fmt::format("missing; expected a section [{}]", key));
    return *found;
  }

  /// Refuses keys of [validation] beside these and those of every model.
  void known(std::initializer_list<std::string_view> keys) const {
    std::vector<std::string_view> all = {"model", "split", "operating_point", "assumes", "not_predicted"};
    all.insert(all.end(), keys);
    plan_.known_keys(all);
  }

  std::vector<std::string> texts(const TomlFields& fields, std::string_view key) const {
    std::vector<std::string> found;
    if (!fields.has(key)) return found;
    const TomlNode& node = fields.at(key);
    if (node.kind != Kind::array) fields.refuse(node, key, "expected a list of texts, got " + kind_of(node));
    for (const TomlNode& item : node.items) {
      if (item.kind != Kind::text) fields.refuse(item, key, "expected a list of texts, got " + kind_of(item));
      found.push_back(item.text);
    }
    return found;
  }

  /// Lists of so many texts in a list.
  std::vector<std::vector<std::string>> text_lists(std::string_view key, std::size_t length) const {
    std::vector<std::vector<std::string>> found;
    if (!plan_.has(key)) return found;
    const TomlNode& node = plan_.at(key);
    const std::string expected = fmt::format("expected a list of lists of {} names", length);
    if (node.kind != Kind::array) plan_.refuse(node, key, expected);
    for (const TomlNode& item : node.items) {
      if (item.kind != Kind::array || item.items.size() != length) plan_.refuse(item, key, expected);
      std::vector<std::string> names;
      for (const TomlNode& name : item.items) {
        if (name.kind != Kind::text) plan_.refuse(name, key, expected);
        names.push_back(name.text);
      }
      found.push_back(std::move(names));
    }
    return found;
  }

  void read_texts() {
    const TomlFields m = section("measured");
    const std::string_view keys[] = {"vehicle", "source", "licence", "measured", "uncertainty", "unknown", "remarks"};
    m.known_keys(keys);
    set_.vehicle = m.needed_text("vehicle", "the vehicle that was measured");
    set_.source = m.needed_text("source", "where the numbers were read");
    set_.licence = m.needed_text("licence", "the licence of the source, or that it states none");
    set_.measured = m.needed_text("measured", "what was measured, and how");
    set_.uncertainty = m.needed_text("uncertainty", "what is known of it, or that nothing is");
    set_.unknown = m.text("unknown").value_or("");
    set_.remarks = m.text("remarks").value_or("");
    const auto notes = root_.table("notes");
    if (!notes) return;
    for (const auto& [key, node] : notes->node().members) {
      if (node.kind != Kind::text) notes->refuse(node, key, "expected a text, got " + kind_of(node));
    }
  }

  double known_number(std::string_view key) const {
    const auto fields = root_.table("known");
    const TomlNode* node = fields ? fields->node().find(key) : nullptr;
    if (!node) root_.refuse("known", fmt::format("the model {} needs known.{}", name_of(set_.model), key));
    if (node->kind != Kind::number || !std::isfinite(node->number)) {
      fields->refuse(*node, key, "expected a number, got " + kind_of(*node));
    }
    return node->number;
  }

  double positive(std::string_view key, std::optional<double> fallback = {}) const {
    if (fallback && !plan_.has(key)) return *fallback;
    const double x = plan_.needed_quantity(key, "1");
    if (!(x > 0.0)) plan_.refuse(plan_.at(key), key, fmt::format("must be > 0, got {:g}", x));
    return x;
  }

  double unit_of(std::string_view si) const {
    const std::string unit = plan_.needed_text("unit", "the unit of the measured numbers");
    try {
      return unit_factor(unit, si);
    } catch (const UnitError& error) {
      plan_.refuse(plan_.at("unit"), "unit", error.what());
    }
  }

  ComparedQuantity quantity() const {
    return {plan_.needed_text("quantity", "what is compared, in words"), plan_.needed_text("unit", "its unit")};
  }

  Design<double> vehicle() {
    const std::string file = plan_.needed_text("vehicle", "a vehicle file");
    const std::filesystem::path path = find_vehicle(path_.parent_path(), file);
    set_.vehicle_file = std::filesystem::path(file).filename().string();
    std::vector<std::string> overrides;
    const auto settings = plan_.table("settings");
    if (settings) {
      for (const auto& [key, node] : settings->node().members) {
        if (node.kind != Kind::text) settings->refuse(node, key, "expected a text with a unit, got " + kind_of(node));
        set_.settings.push_back({key, node.text});
        overrides.push_back(key + "=" + node.text);
      }
    }
    try {
      return read_design(path, overrides);
    } catch (const InputError& error) {
      plan_.refuse(plan_.at(settings ? "settings" : "vehicle"), settings ? "settings" : "vehicle", error.what());
    }
  }

  std::vector<FreeParameter> parameters(const Design<double>& design, std::size_t& one) const {
    std::vector<FreeParameter> all;
    for (const TomlFields& p : plan_.tables("parameter")) {
      const std::string_view keys[] = {"key", "lower", "upper"};
      p.known_keys(keys);
      const std::string key = p.needed_text("key", "a number of the vehicle file");
      FreeParameter free = detail::bounded_parameter(p, key);
      const std::optional<double> own = free.parameter.value(design);
      if (!own) p.refuse(p.at("key"), "key", fmt::format("the vehicle file has no {}", key));
      free.start = *own;
      if (!(free.lower <= free.start && free.start <= free.upper && free.lower < free.upper)) {
        p.refuse(p.at("lower"), "lower",
                 fmt::format("the vehicle's own value, {:g} {}, must lie within lower and upper", free.start,
                             free.parameter.unit));
      }
      all.push_back(std::move(free));
    }
    const std::string name = plan_.needed_text("one", "the key of the parameter that is fitted alone");
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const FreeParameter& p) { return p.parameter.key == name; });
    if (found == all.end()) {
      plan_.refuse(plan_.at("one"), "one", in_quotes(name) + " is the key of no [[validation.parameter]]");
    }
    one = std::size_t(found - all.begin());
    return all;
  }

  /// Marks the fitted points; `keys` holds what was set at each, in the order of operating_point.
  void split(const std::vector<std::vector<Cell>>& keys) {
    if (set_.split == ValidationSplit::none) return;
    std::vector<std::vector<Cell>> distinct = keys;
    std::sort(distinct.begin(), distinct.end());
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    std::vector<std::size_t> numbers;
    for (const std::vector<Cell>& key : keys) {
      numbers.push_back(std::size_t(std::lower_bound(distinct.begin(), distinct.end(), key) - distinct.begin()));
    }
    split_alternately(set_, numbers);
  }

  std::vector<Cell> operating_point(std::size_t row) const {
    std::vector<Cell> key;
    for (const std::string& name : set_.operating_point) {
      const Cell& cell = table_.rows()[row][table_.column(plan_, "operating_point", name)];
      if (std::isnan(cell.number)) {
        plan_.refuse(plan_.at("operating_point"), "operating_point",
                     fmt::format("row {} has no number in the column {}", row + 1, in_quotes(name)));
      }
      key.push_back(cell);
    }
    return key;
  }

  std::string label_of(const std::vector<std::pair<std::string, Cell>>& cells) const {
    std::string label;
    for (const auto& [unit, cell] : cells) {
      label += (label.empty() ? "" : ", ") + (cell.is_text ? cell.text : fmt::format("{:g} {}", cell.number, unit));
    }
    return label;
  }

  void read_prescribed() {
    known({"column", "quantity", "unit", "air_density"});
    PrescribedProblem problem;
    problem.planform = detail::outline_of(root_, "planform_mm", "mm", known_number("hub_offset_mm") * 1e-3);
    problem.air_density = plan_.needed_quantity("air_density", "kg/m3");
    problem.unit = unit_of("N");
    set_.quantities = {quantity()};
    const double frequency = known_number("frequency_Hz");
    const std::size_t column = table_.column(plan_, "column", plan_.needed_text("column", "the measured column"));
    const auto angle = [&](std::size_t row, const char* name) {
      return degree * table_.number(plan_, "model", row, table_.column(plan_, "model", name));
    };
    std::vector<std::vector<Cell>> keys;
    for (std::size_t row = 0; row < table_.rows().size(); ++row) {
      PrescribedFlapping motion;
      motion.frequency = frequency;
      motion.stroke = {angle(row, "stroke_mean_deg"), {{angle(row, "stroke_amplitude_deg"), 0.0}}};
      // The source's pitch is positive where the wing gives way to the air, psi where its trailing edge is ahead.
      motion.pitch = {-angle(row, "pitch_mean_deg"),
                      {{-angle(row, "pitch_amplitude_deg"), 0.5 * pi + angle(row, "pitch_lead_deg")}}};
      problem.motions.push_back(std::move(motion));
      keys.push_back(operating_point(row));
      std::vector<std::pair<std::string, Cell>> label;
      for (std::size_t k = 0; k < keys.back().size(); ++k) label.push_back({set_.operating_point[k], keys.back()[k]});
      set_.points.push_back(
          {label_of(label), keys.back().back().number, 0, table_.number(plan_, "column", row, column)});
    }
    set_.position_name = set_.operating_point.empty() ? "" : "Drive voltage (V)";
    split(keys);
    set_.problem = std::move(problem);
  }

  Metric metric() const {
    const std::string name = plan_.needed_text("metric", "a metric, as wingbeat metrics lists them");
    const int index = metric_index(name);
    if (index == metric_count) plan_.refuse(plan_.at("metric"), "metric", "no metric is named " + in_quotes(name));
    return Metric(index);
  }

  void read_bench() {
    known({"vehicle", "settings", "column", "line", "quantity", "unit", "metric", "metric_per_value", "voltage",
           "voltage_per_value", "frequency", "one", "parameter"});
    BenchProblem problem;
    problem.design = vehicle();
    problem.parameters = parameters(problem.design, problem.one);
    problem.metric = metric();
    problem.metric_per_value = positive("metric_per_value", 1.0) * unit_of(metric_info(problem.metric).unit);
    set_.quantities = {quantity()};
    const double voltage_per_value = positive("voltage_per_value", 1.0);
    std::vector<std::vector<Cell>> keys;
    if (const auto line = plan_.table("line")) {
      const std::string_view line_keys[] = {"slope", "zero", "at"};
      line->known_keys(line_keys);
      const double slope = table_.named(*line, "slope", line->needed_text("slope", "a quantity of the rows"));
      const double zero = table_.named(*line, "zero", line->needed_text("zero", "a quantity of the rows"));
      const TomlNode& voltages = line->at("at");
      if (!line->has("at") || voltages.kind != Kind::array) line->refuse(voltages, "at", "expected a list of voltages");
      for (const TomlNode& item : voltages.items) {
        if (item.kind != Kind::number || !(item.number > 0.0)) line->refuse(item, "at", "expected voltages > 0");
        keys.push_back({{item.number, {}, false}});
        problem.voltages.push_back(voltage_per_value * item.number);
        problem.frequencies.push_back(absent);
        set_.points.push_back({fmt::format("{:g} V", item.number), item.number, 0, slope * (item.number - zero)});
      }
      set_.position_name = "Voltage amplitude (V)";
    } else {
      const std::size_t column = table_.column(plan_, "column", plan_.needed_text("column", "the measured column"));
      const std::size_t voltage = table_.column(plan_, "voltage", plan_.needed_text("voltage", "a column"));
      const std::size_t frequency = table_.column(plan_, "frequency", plan_.needed_text("frequency", "a column"));
      for (std::size_t row = 0; row < table_.rows().size(); ++row) {
        const double measured = table_.number(plan_, "column", row, column);
        if (!std::isfinite(measured)) continue;
        const double V = table_.number(plan_, "voltage", row, voltage);
        const double f = table_.number(plan_, "frequency", row, frequency);
        keys.push_back(operating_point(row));
        problem.voltages.push_back(voltage_per_value * V);
        problem.frequencies.push_back(f);
        set_.points.push_back({fmt::format("{:g} V, {:g} Hz", V, f), f, 0, measured});
      }
      set_.position_name = "Frequency (Hz)";
    }
    split(keys);
    sort_points(problem);
    set_.problem = std::move(problem);
  }

  /// In the order of voltage and frequency.
  void sort_points(BenchProblem& problem) {
    std::vector<std::size_t> order(set_.points.size());
    for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      if (problem.voltages[a] != problem.voltages[b]) return problem.voltages[a] < problem.voltages[b];
      return problem.frequencies[a] < problem.frequencies[b];
    });
    const auto sorted = [&](const auto& list) {
      std::decay_t<decltype(list)> other;
      for (const std::size_t n : order) other.push_back(list[n]);
      return other;
    };
    set_.points = sorted(set_.points);
    problem.voltages = sorted(problem.voltages);
    problem.frequencies = sorted(problem.frequencies);
  }

  void read_passive_pitch() {
    known({"vehicle", "settings", "frequency_Hz", "quantity", "unit", "half_strokes", "pitches", "harmonics",
           "phase_behind_deg", "one", "parameter"});
    PassivePitchProblem problem;
    problem.design = vehicle();
    problem.parameters = parameters(problem.design, problem.one);
    problem.frequency = positive("frequency_Hz");
    set_.quantities = {quantity()};
    set_.position_name = "Stroke amplitude (deg)";
    std::vector<std::vector<Cell>> keys;
    const auto add = [&](const std::string& label, double stroke, std::size_t quantity, double measured) {
      problem.strokes.push_back(degree * stroke);
      set_.points.push_back({label, stroke, quantity, measured});
    };
    if (const auto h = plan_.table("harmonics")) {
      const std::string_view harmonic_keys[] = {"column", "stroke", "pitch"};
      h->known_keys(harmonic_keys);
      problem.first_harmonics = true;
      const std::size_t column = table_.column(*h, "column", h->needed_text("column", "the column of amplitudes"));
      const auto amplitude = [&](const char* key) {
        return table_.number(*h, key, table_.row_of(*h, key, h->needed_text(key, "a quantity of the rows")), column);
      };
      add("first harmonic", amplitude("stroke"), 0, amplitude("pitch"));
      if (plan_.has("phase_behind_deg")) {
        set_.quantities.push_back({"pitch ahead of velocity", "deg", false});
        add("first harmonic", amplitude("stroke"), 1, -plan_.needed_quantity("phase_behind_deg", "1"));
      }
    } else {
      const auto strokes = text_lists("half_strokes", 2), pitches = text_lists("pitches", 2);
      if (strokes.empty() || strokes.size() != pitches.size()) {
        plan_.refuse(plan_.at("half_strokes"), "half_strokes", "expected as many pairs of columns as pitches has");
      }
      const auto half_sum = [&](std::size_t row, std::string_view key, const std::vector<std::string>& columns) {
        return 0.5 * (table_.number(plan_, key, row, table_.column(plan_, key, columns[0])) +
                      table_.number(plan_, key, row, table_.column(plan_, key, columns[1])));
      };
      for (std::size_t row = 0; row < table_.rows().size(); ++row) {
        for (std::size_t wing = 0; wing < strokes.size(); ++wing) {
          keys.push_back(operating_point(row));
          std::string label;
          for (std::size_t k = 0; k < keys.back().size(); ++k) {
            label += fmt::format("{}{:g} V", k == 0 ? "" : ", offset ", keys.back()[k].number);
          }
          if (strokes.size() > 1) label += fmt::format(", #{}", wing + 1);
          add(label, half_sum(row, "half_strokes", strokes[wing]), 0, half_sum(row, "pitches", pitches[wing]));
        }
      }
    }
    if (set_.split == ValidationSplit::amplitude) {
      for (ValidationPoint& p : set_.points) p.fitted = p.quantity == 0;
    } else {
      split(keys);
    }
    set_.problem = std::move(problem);
  }

  void read_ratios() {
    known({"vehicle", "settings", "thrust_line", "thrusts", "damping"});
    RatiosProblem problem;
    problem.design = vehicle();
    if (!problem.design.mass) plan_.refuse(plan_.at("vehicle"), "vehicle", "the vehicle file has no vehicle.mass");
    set_.quantities = {};
    const auto add = [&](const std::string& label, const std::string& quantity, double measured,
                         RatiosProblem::Kind kind) {
      std::size_t q = 0;
      while (q < set_.quantities.size() && set_.quantities[q].name != quantity) ++q;
      if (q == set_.quantities.size()) set_.quantities.push_back({quantity, "1"});
      set_.points.push_back({label, double(set_.points.size() + 1), q, measured});
      problem.kinds.push_back(kind);
    };
    const std::vector<std::string> line = texts(plan_, "thrust_line");
    if (!line.empty()) {
      if (line.size() != 2) plan_.refuse(plan_.at("thrust_line"), "thrust_line", "expected slope and constant");
      const double c1 = table_.named(plan_, "thrust_line", line[0]), c2 = table_.named(plan_, "thrust_line", line[1]);
      const double thrust = known_number("mass_kg") * standard_gravity / positive("thrusts", 1.0);
      if (!(c1 > 0.0 && thrust > c2)) {
        plan_.refuse(plan_.at("thrust_line"), "thrust_line", "the line must grow, and reach the weight");
      }
      add("thrust line at hover", "exponent of lift over frequency", (thrust - c2) / thrust,
          RatiosProblem::Kind::lift_exponent);
    }
    for (const std::vector<std::string>& pair : text_lists("damping", 2)) {
      const double x = table_.named(plan_, "damping", pair[0]), z = table_.named(plan_, "damping", pair[1]);
      add(pair[0] + "/" + pair[1], "ratio of damping, x to z", x / z, RatiosProblem::Kind::damping_ratio);
    }
    if (set_.points.empty()) plan_.refuse("damping", "missing; give damping, thrust_line or both");
    set_.split = ValidationSplit::none;
    set_.position_name = "Row";
    set_.problem = std::move(problem);
  }

  void read_resistance() {
    known({"column", "quantity", "unit"});
    set_.quantities = {quantity()};
    const std::size_t column = table_.column(plan_, "column", plan_.needed_text("column", "the measured column"));
    if (set_.operating_point.size() != 1) {
      plan_.refuse(plan_.at("operating_point"), "operating_point", "expected one column, of the frequency");
    }
    std::vector<std::vector<Cell>> keys;
    for (std::size_t row = 0; row < table_.rows().size(); ++row) {
      keys.push_back(operating_point(row));
      const double f = keys.back().front().number;
      set_.points.push_back({fmt::format("{:g} Hz", f), std::log10(f), 0, table_.number(plan_, "column", row, column)});
    }
    set_.position_name = "Decimal logarithm of the frequency in Hz";
    split(keys);
    set_.problem = ResistanceProblem{};
  }

  std::filesystem::path path_;
  std::string name_, text_;
  TomlNode tree_;
  TomlFields root_, plan_;
  MeasuredTable table_;
  ValidationSet set_;
};

}  // namespace

ValidationSet read_measured(const std::filesystem::path& file) {
  return MeasuredReader(file, read_text_file(file)).read();
}

}  // namespace wingbeat

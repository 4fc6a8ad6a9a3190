#include "wingbeat/files/bench_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "files/csv_cells.hpp"
#include "files/input_errors.hpp"
#include "files/toml_fields.hpp"
#include "wingbeat/core/status.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

/// A column of a log by its name without unit.
struct ColumnName {
  std::string name;
  std::string full;  ///< with the SI unit, as in JSON and data sets: "current_mean_a"
  std::string unit;
  MeasuredQuantity quantity;
  bool may_be_negative;
};

std::string base_name(std::string_view key) {
  for (const std::string_view suffix : {"_rad_per_s", "_v", "_hz", "_a", "_w", "_n", "_rad", "_deg"}) {
    if (key.ends_with(suffix)) return std::string(key.substr(0, key.size() - suffix.size()));
  }
  return std::string(key);
}

const std::vector<ColumnName>& metric_columns() {
  static const std::vector<ColumnName> columns = [] {
    std::vector<ColumnName> all;
    for (int m = 0; m < metric_count; ++m) {
      const MetricInfo& info = metric_info(Metric(m));
      const Metric metric = Metric(m);
      const bool negative = metric == Metric::lift_mean || metric == Metric::lift_peak ||
                            metric == Metric::power_residual || metric == Metric::angle_of_attack_min ||
                            metric == Metric::power_aerodynamic || metric == Metric::lift_to_weight;
      all.push_back({base_name(info.key), info.key, info.unit, {false, metric, {}}, negative});
    }
    return all;
  }();
  return columns;
}

const std::vector<ColumnName>& waveform_quantities() {
  static const std::vector<ColumnName> columns = [] {
    std::vector<ColumnName> all;
    for (int q = 0; q < waveform_quantity_count; ++q) {
      const auto quantity = WaveformQuantity(q);
      all.push_back({name_of(quantity), name_of(quantity), unit_of(quantity), {true, {}, quantity}, true});
    }
    return all;
  }();
  return columns;
}

/// SI value of a number in a column: value * factor.
double column_factor(const std::string& unit, const std::string& expected) {
  if (expected == "degree") return degrees_per_radian * unit_factor(unit, "rad");
  return unit_factor(unit.empty() ? "1" : unit, expected);
}

class LogReader {
 public:
  LogReader(const std::string& file, const LogRequest& request) : file_(file), request_(request), log_(request.log) {
    log_.waveform = request.given_value.has_value();
    if (log_.waveform) log_.given = *request.given;
    log_.file = file;
  }

  BenchLog read(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    bool header = true;
    for (std::string_view line; next_line(text, line, line_);) {
      if (is_blank_or_comment(line)) continue;
      if (header) {
        read_header(csv_cells(line));
        header = false;
      } else {
        read_row(csv_cells(line));
      }
    }
    if (header)
      throw InputError(file_, 0, 0, "", "is empty; expected a header such as voltage_V,frequency_Hz,current_mean_mA");
    if (log_.rows.empty()) throw InputError(file_, line_, 1, "", "holds no rows");
    return log_;
  }

 private:
  struct Column {
    const ColumnName* name = nullptr;  ///< null: what was set on the bench
    double factor = 1.0;
    bool used = true;
    std::string header;
  };

  [[noreturn]] void refuse(int column, const std::string& key, const std::string& message) const {
    throw InputError(file_, line_, column, key, message);
  }

  Column column_of(const CsvCell& cell) {
    const std::vector<ColumnName>& known = log_.waveform ? waveform_quantities() : metric_columns();
    static const ColumnName crank_angle{"crank_angle", "crank_angle", "rad", {}, true};
    const ColumnName* best = nullptr;
    const auto offer = [&](const ColumnName& c) {
      const bool prefix = cell.text.starts_with(c.name) &&
                          (cell.text.size() == c.name.size() ||
                           std::string_view("_ [(").find(cell.text[c.name.size()]) != std::string_view::npos);
      if (prefix && (!best || c.name.size() > best->name.size())) best = &c;
    };
    for (const ColumnName& c : known) offer(c);
    if (log_.waveform) offer(crank_angle);
    if (!best) {
      std::vector<std::string_view> names;
      for (const ColumnName& c : known) names.push_back(c.name);
      if (log_.waveform) names.push_back(crank_angle.name);
      const std::string_view near = nearest_name(cell.text.substr(0, cell.text.find_first_of("[( ")), names);
      refuse(cell.column, "",
             fmt::format("unknown column {}; {}", in_quotes(cell.text),
                         near.empty() ? fmt::format("known are {}", fmt::join(names, ", "))
                                      : fmt::format("did you mean {} with its unit?", near)));
    }
    Column column{best, 1.0, true, best->name};
    if (cell.text != best->full || best->full == best->name) {
      std::string unit(cell.text.substr(best->name.size()));
      std::replace(unit.begin(), unit.end(), '_', ' ');
      unit = trimmed(unit);
      const bool bracketed = unit.size() >= 2 && ((unit.front() == '[' && unit.back() == ']') ||
                                                  (unit.front() == '(' && unit.back() == ')'));
      if (bracketed) unit = trimmed(unit.substr(1, unit.size() - 2));
      if (unit.empty() && best->unit != "1") {
        refuse(cell.column, best->name,
               fmt::format("names no unit; write {}_{} or {} [{}]", best->name,
                           best->unit == "degree" ? "deg" : best->unit, best->name, best->unit));
      }
      try {
        column.factor = column_factor(unit, best->unit);
      } catch (const UnitError& error) {
        refuse(cell.column, best->name, fmt::format("the unit {} is wrong: {}", in_quotes(unit), error.what()));
      }
    }
    return column;
  }

  void read_header(const std::vector<CsvCell>& cells) {
    for (const CsvCell& cell : cells) {
      Column column = column_of(cell);
      for (const Column& before : columns_) {
        if (before.header == column.header) refuse(cell.column, column.header, "is given twice");
      }
      columns_.push_back(column);
    }
    const auto index_of = [&](std::string_view name) {
      const auto found =
          std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.header == name; });
      return found == columns_.end() ? -1 : int(found - columns_.begin());
    };
    if (log_.waveform) {
      set_ = index_of("crank_angle");
      if (set_ < 0) refuse(1, "crank_angle", "missing column: a waveform needs crank_angle_rad or crank_angle_deg");
    } else {
      const int voltage = index_of("voltage"), frequency = index_of("frequency");
      if (!request_.given && voltage >= 0 && frequency >= 0) {
        // Both were logged: the supply's voltage is set, the frequency follows.
        log_.given = Given::voltage;
      } else if (request_.given) {
        log_.given = *request_.given;
      } else {
        log_.given = voltage >= 0 ? Given::voltage : Given::frequency;
      }
      set_ = log_.given == Given::voltage ? voltage : frequency;
      if (set_ < 0) {
        refuse(1, log_.given == Given::voltage ? "voltage" : "frequency",
               "missing column: a log needs the voltage or the frequency that was set");
      }
    }
    for (const std::string& wanted : request_.measured) {
      if (index_of(base_name(wanted)) < 0) refuse(1, wanted, "missing column: [[log]] names it as measured");
    }
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (int(c) == set_) continue;
      const auto& wanted = request_.measured;
      columns_[c].used = wanted.empty() || std::any_of(wanted.begin(), wanted.end(), [&](const std::string& w) {
                           return base_name(w) == columns_[c].header;
                         });
      if (columns_[c].used) log_.columns.push_back(columns_[c].name->quantity);
    }
    if (log_.columns.empty()) refuse(1, "", "no measured column beside what was set");
  }

  void read_row(const std::vector<CsvCell>& cells) {
    if (cells.size() != columns_.size()) {
      refuse(1, "", fmt::format("expected {} values, got {}", columns_.size(), cells.size()));
    }
    BenchRow row;
    row.line = line_;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const Column& column = columns_[c];
      const std::string text(cells[c].text);
      char* end = nullptr;
      const double number = std::strtod(text.c_str(), &end);
      if (text.empty() || *end != '\0' || !std::isfinite(number)) {
        refuse(cells[c].column, column.header, fmt::format("expected a number, got {}", in_quotes(text)));
      }
      const double x = column.factor * number;
      if (int(c) == set_) {
        if (log_.waveform) {
          row.given = *request_.given_value;
          row.crank_angle = x;
          if (!(x >= 0.0 && x <= two_pi * (1.0 + 1e-12))) {
            refuse(cells[c].column, column.header, fmt::format("must lie between 0 and 360 deg, got {}", text));
          }
        } else {
          row.given = x;
          if (!(x > 0.0)) refuse(cells[c].column, column.header, fmt::format("must be > 0, got {}", text));
        }
      } else {
        if (x < 0.0 && !column.name->may_be_negative) {
          refuse(cells[c].column, column.header, fmt::format("must not be negative, got {}", text));
        }
        if (column.used) row.values.push_back(x);
      }
    }
    if (!log_.rows.empty()) {
      const BenchRow& before = log_.rows.back();
      const double last = log_.waveform ? before.crank_angle : before.given;
      const double now = log_.waveform ? row.crank_angle : row.given;
      const std::string& name = columns_[std::size_t(set_)].header;
      if (now == last) refuse(1, name, fmt::format("the same value as in line {}: a row stands twice", before.line));
      if (now < last) {
        refuse(1, name, fmt::format("rows must be sorted: smaller than in line {}", before.line));
      }
    }
    log_.rows.push_back(row);
  }

  std::string file_;
  const LogRequest& request_;
  BenchLog log_;
  std::vector<Column> columns_;
  int line_ = 0;
  int set_ = -1;
};

class BenchReader {
 public:
  BenchReader(const std::filesystem::path& file, std::span<const std::string> overrides)
      : path_(file),
        overrides_(overrides),
        name_(input_name(file)),
        tree_(parse_toml_tree(read_text_file(file), name_)),
        root_(name_, "", tree_) {}

  BenchFit read() {
    const std::string_view sections[] = {"bench", "fit", "parameter", "deviation", "log"};
    errors_.attempt([&] { root_.known_keys(sections); });
    const auto bench = root_.table("bench");
    if (!bench) root_.refuse("bench", "missing section [bench] with the name of a vehicle file");
    const std::string_view bench_keys[] = {"vehicle", "title", "source"};
    errors_.attempt([&] { bench->known_keys(bench_keys); });
    errors_.attempt([&] { bench->text("title"), bench->text("source"); });
    BenchFit fit;
    errors_.attempt([&] { read_options(fit); });
    const bool has_vehicle = errors_.attempt([&] {
      const std::string vehicle = bench->needed_text("vehicle", "the name of a vehicle file");
      fit.design = read_design(find_vehicle(path_.parent_path(), vehicle), overrides_);
    });
    if (!has_vehicle) errors_.refuse();  // the rest is read for this vehicle
    errors_.attempt([&] { read_parameters(fit); });
    errors_.attempt([&] { read_logs(fit); });
    errors_.refuse();
    read_deviations(fit);
    return fit;
  }

 private:
  void read_options(BenchFit& fit) const {
    const auto options = root_.table("fit");
    if (!options) return;
    const std::string_view keys[] = {"loss", "loss_scale", "starts", "seed", "tolerance"};
    options->known_keys(keys);
    fit.loss = options->choice<Loss>("loss", Loss::none);
    fit.loss_scale = options->quantity("loss_scale", "1").value_or(fit.loss_scale);
    if (!(fit.loss_scale > 0.0)) options->refuse(options->at("loss_scale"), "loss_scale", "must be > 0");
    fit.starts = options->count("starts", 1).value_or(1);
    if (fit.starts > max_fit_starts) {
      options->refuse(
          options->at("starts"), "starts",
          fmt::format("must be at most {}, got {}; every start is a whole fit", max_fit_starts, fit.starts));
    }
    fit.seed = std::uint64_t(options->count("seed", 0).value_or(1));
    fit.tolerance = options->quantity("tolerance", "1").value_or(fit.tolerance);
    if (!(fit.tolerance >= 1e-12 && fit.tolerance <= 1e-3)) {
      options->refuse(options->at("tolerance"), "tolerance", "must lie between 1e-12 and 1e-3");
    }
  }

  void read_parameters(BenchFit& fit) {
    const auto read_one = [&](const TomlFields& p) {
      const std::string_view keys[] = {"key", "lower", "upper", "start"};
      p.known_keys(keys);
      const std::string key = p.needed_text("key", "a number of the vehicle file, such as \"friction.radius\"");
      FreeParameter free;
      try {
        free.parameter = design_parameter(key);
      } catch (const ParameterError& error) {
        p.refuse(p.at("key"), "key", error.what());
      }
      free.lower = p.needed_quantity("lower", free.parameter.unit);
      free.upper = p.needed_quantity("upper", free.parameter.unit);
      const std::optional<double> own = free.parameter.value(fit.design);
      const auto start = p.quantity("start", free.parameter.unit);
      if (!start && !own) p.refuse("start", fmt::format("missing; the vehicle file has no {}", key));
      free.start = start ? *start : *own;
      if (!(free.lower < free.upper)) p.refuse(p.at("lower"), "lower", "must lie below upper");
      if (!(free.start >= free.lower && free.start <= free.upper)) {
        p.refuse(p.at("start"), "start",
                 fmt::format("must lie within the bounds, is {} {}", free.start, free.parameter.unit));
      }
      for (const double x : {free.lower, free.upper}) {
        Design<double> design = fit.design;
        try {
          set_parameter(design, key, x);
          validate(design);
        } catch (const ParameterError& error) {
          p.refuse(p.at(x == free.lower ? "lower" : "upper"), x == free.lower ? "lower" : "upper", error.what());
        }
      }
      for (const FreeParameter& before : fit.parameters) {
        if (before.parameter.key == key) p.refuse(p.at("key"), "key", fmt::format("{} is given twice", key));
      }
      if (start) {
        for (const std::string& assignment : overrides_) {
          if (!assignment.starts_with(key + "=")) continue;
          throw InputError("--set " + one_line(assignment, 120), 0, 0, key,
                           "has no effect: the bench file gives its start");
        }
      }
      fit.parameters.push_back(free);
    };
    const auto sections = root_.tables("parameter");
    for (const TomlFields& p : sections) errors_.attempt([&] { read_one(p); });
    if (sections.empty()) root_.refuse("parameter", "missing: which parameters are free? Give [[parameter]] sections");
  }

  void read_logs(BenchFit& fit) {
    const bool has_springs = fit.design.spring.stiffness || fit.design.spring.resonance;
    const auto read_one = [&](const TomlFields& l) {
      const std::string_view keys[] = {"file", "condition", "springs", "given", "measured", "voltage", "frequency"};
      l.known_keys(keys);
      const std::string file = l.needed_text("file", "the name of a CSV file");
      LogRequest request;
      request.log.condition = l.choice<Condition>("condition");
      const auto springs = l.boolean("springs");
      if (!springs && has_springs && request.log.condition != Condition::wingless) {
        l.refuse("springs", "missing; the vehicle file has springs: true, or false where they were taken off");
      }
      request.log.springs = springs.value_or(false) && request.log.condition != Condition::wingless;
      if (springs.value_or(false) && !has_springs) l.refuse(l.at("springs"), "springs", "the vehicle file has none");
      if (l.has("given")) request.given = l.choice<Given>("given");
      const auto voltage = l.quantity("voltage", "V"), frequency = l.quantity("frequency", "Hz");
      if (voltage && frequency) l.refuse(l.at("frequency"), "frequency", "give voltage or frequency, not both");
      if (voltage || frequency) {
        request.given = voltage ? Given::voltage : Given::frequency;
        request.given_value = voltage ? *voltage : *frequency;
        if (!(*request.given_value > 0.0)) l.refuse(voltage ? "voltage" : "frequency", "must be > 0");
      }
      if (const TomlNode* measured = l.node().find("measured")) {
        if (measured->kind != TomlNode::Kind::array) l.refuse(*measured, "measured", "expected a list of column names");
        for (const TomlNode& item : measured->items) {
          if (item.kind != TomlNode::Kind::text) l.refuse(item, "measured", "expected a list of column names");
          request.measured.push_back(item.text);
        }
      }
      const std::filesystem::path path = path_.parent_path() / file;
      std::string text;
      try {
        text = read_text_file(path);
      } catch (const InputError& error) {
        l.refuse(l.at("file"), "file", error.what());
      }
      fit.logs.push_back(parse_log(text, path.string(), request));
      check_columns(l, fit);
    };
    const auto sections = root_.tables("log");
    for (const TomlFields& l : sections) errors_.attempt([&] { read_one(l); });
    if (sections.empty()) root_.refuse("log", "missing: what was measured? Give [[log]] sections");
  }

  void check_columns(const TomlFields& l, const BenchFit& fit) const {
    for (const MeasuredQuantity& q : fit.logs.back().columns) {
      if (q.waveform) continue;
      if (q.metric == Metric::power_motor_reference && !fit.design.bench_torque_constant) {
        l.refuse(l.at("file"), "file", "power_motor_reference needs [bench] torque_constant in the vehicle file");
      }
      if (q.metric == Metric::lift_to_weight && !fit.design.mass) {
        l.refuse(l.at("file"), "file", "lift_to_weight needs [vehicle] mass in the vehicle file");
      }
      if (q.metric == Metric::floquet_multiplier_max)
        l.refuse(l.at("file"), "file", "a Floquet multiplier cannot be fitted");
    }
  }

  /// `{ relative = 0.01 }`, `{ absolute = "0.1 Hz" }` or "estimated".
  Deviation deviation_at(const TomlFields& section, std::string_view key, const std::string& unit) const {
    const TomlNode& node = *section.node().find(key);
    if (node.kind == TomlNode::Kind::text && node.text == "estimated") return {Deviation::Kind::estimated, 0.0};
    const char* expected = "expected { relative = 0.01 }, { absolute = \"a quantity\" } or \"estimated\"";
    if (node.kind != TomlNode::Kind::table || node.members.size() != 1) section.refuse(node, key, expected);
    const TomlFields form(name_, section.name_of(key), node);
    const std::string_view keys[] = {"relative", "absolute"};
    form.known_keys(keys);
    Deviation d;
    if (form.has("relative")) {
      d = {Deviation::Kind::relative, *form.quantity("relative", "1")};
    } else if (unit.empty()) {
      section.refuse(node, key, "an absolute deviation belongs to one column");
    } else {
      d = {Deviation::Kind::absolute, unit == "degree" ? degrees_per_radian * *form.quantity("absolute", "rad")
                                                       : *form.quantity("absolute", unit)};
    }
    if (!(d.value > 0.0)) section.refuse(node, key, "must be > 0");
    return d;
  }

  void read_deviations(BenchFit& fit) const {
    const auto section = root_.table("deviation");
    if (!section) {
      root_.refuse("deviation",
                   "missing section [deviation]: how well was each column measured? For example default = "
                   "{ relative = 0.01 }, or \"estimated\"");
    }
    std::vector<std::string_view> keys = {"default"};
    for (const ColumnName& c : metric_columns()) keys.push_back(c.name);
    for (const ColumnName& c : waveform_quantities()) keys.push_back(c.name);
    section->known_keys(keys);
    for (const BenchLog& log : fit.logs) {
      for (std::size_t c = 0; c < log.columns.size(); ++c) {
        const MeasuredQuantity& q = log.columns[c];
        const auto& known = q.waveform ? waveform_quantities() : metric_columns();
        const ColumnName& column =
            *std::find_if(known.begin(), known.end(), [&](const auto& k) { return k.quantity == q; });
        if (section->has(column.name)) {
          fit.deviations[q] = deviation_at(*section, column.name, column.unit);
        } else if (section->has("default")) {
          fit.deviations[q] = deviation_at(*section, "default", "");
        } else {
          section->refuse(column.name, fmt::format("missing: the standard deviation of this column of {}", log.file));
        }
        if (fit.deviations[q].kind != Deviation::Kind::relative) continue;
        for (const BenchRow& row : log.rows) {
          if (row.values[c] == 0.0) {
            throw InputError(log.file, row.line, 1, column.name,
                             "is 0, of which no relative standard deviation can be taken; give an absolute one");
          }
        }
      }
    }
  }

  std::filesystem::path path_;
  std::span<const std::string> overrides_;
  InputErrors errors_;
  std::string name_;
  TomlNode tree_;
  TomlFields root_;
};

}  // namespace

BenchLog parse_log(std::string_view text, const std::string& file_name, const LogRequest& request) {
  return LogReader(file_name, request).read(text);
}

std::filesystem::path vehicle_of_bench(const std::filesystem::path& file) {
  const TomlNode tree = parse_toml_tree(read_text_file(file), file.string());
  const TomlNode* bench = tree.find("bench");
  const TomlNode* vehicle = bench ? bench->find("vehicle") : nullptr;
  if (!vehicle) throw InputError(file.string(), 0, 0, "bench.vehicle", "missing; expected the name of a vehicle file");
  return find_vehicle(file.parent_path(), vehicle->text);
}

BenchFit read_bench(const std::filesystem::path& file, std::span<const std::string> overrides) {
  return BenchReader(file, overrides).read();
}

}  // namespace wingbeat

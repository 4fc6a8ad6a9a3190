// Logs of a test bench.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "files/bench_columns.hpp"
#include "files/csv_cells.hpp"
#include "wingbeat/files/bench_file.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {

using detail::ColumnName, detail::metric_columns, detail::waveform_quantities;

namespace {

std::string base_name(std::string_view key) {
  for (const std::string_view suffix : {"_rad_per_s", "_v", "_hz", "_a", "_w", "_n", "_rad", "_deg", "_degc", "_k"}) {
    if (key.ends_with(suffix)) return std::string(key.substr(0, key.size() - suffix.size()));
  }
  return std::string(key);
}

/// SI value of a number in a column: value * factor.
double column_factor(const std::string& unit, const std::string& expected) {
  if (expected == "degC") {  // it has a zero of its own
    if (unit == expected || unit == "degc") return 1.0;
    throw UnitError("expected degC");
  }
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

}  // namespace

const std::vector<ColumnName>& detail::metric_columns() {
  static const std::vector<ColumnName> columns = [] {
    std::vector<ColumnName> all;
    for (int m = 0; m < metric_count; ++m) {
      const MetricInfo& info = metric_info(Metric(m));
      const Metric metric = Metric(m);
      const bool negative = metric == Metric::lift_mean || metric == Metric::lift_peak ||
                            metric == Metric::power_residual || metric == Metric::angle_of_attack_min ||
                            metric == Metric::power_aerodynamic || metric == Metric::lift_to_weight ||
                            lacking_of_heat(metric, {}) != nullptr;
      all.push_back({base_name(info.key), info.key, info.unit, {false, metric, {}}, negative});
    }
    return all;
  }();
  return columns;
}

const std::vector<ColumnName>& detail::waveform_quantities() {
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

BenchLog parse_log(std::string_view text, const std::string& file_name, const LogRequest& request) {
  return LogReader(file_name, request).read(text);
}

}  // namespace wingbeat

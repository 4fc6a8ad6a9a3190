// Logs of a test bench.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "files/bench_columns.hpp"
#include "files/bench_record.hpp"
#include "files/bench_table.hpp"
#include "files/read_number.hpp"
#include "files/text_encoding.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/bench_file.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {

using detail::BenchTable, detail::ColumnName, detail::RecognisedColumn, detail::TableCell, detail::TableLine;
using detail::metric_columns, detail::record_columns, detail::waveform_columns;
using Part = ColumnName::Part;

namespace {

constexpr const char* ignored = "ignore";

class LogReader {
 public:
  LogReader(const std::string& file, const LogRequest& request) : file_(file), request_(request), log_(request.log) {
    log_.waveform = request.given_value.has_value();
    if (log_.waveform) log_.given = *request.given;
    log_.file = file;
  }

  BenchLog read(std::string_view text) {
    const std::string utf8 = detail::decoded(text, file_, notes_.encoding);
    const BenchTable table = detail::read_bench_table(utf8, file_, {request_.separator, request_.decimal});
    if (table.header.cells.empty())
      throw InputError(file_, 0, 0, "", "is empty; expected a header such as voltage_V,frequency_Hz,current_mean_mA");
    decimal_comma_ = table.decimal_comma;
    record_ = request_.sampling_rate || has_times(table.header);
    if (record_) log_.waveform = true;
    known_ = record_ ? record_columns() : log_.waveform ? waveform_columns() : metric_columns();
    read_header(table.header);
    for (const TableLine& row : table.rows) read_row(row);
    if (log_.rows.empty()) throw InputError(file_, table.header.number, 1, "", "holds no rows");
    refuse_empty_columns();
    const auto set_on_bench = [&](const BenchRow& row) { return log_.waveform ? row.crank_angle : row.given; };
    notes_.sorted = std::is_sorted(log_.rows.begin(), log_.rows.end(), [&](const BenchRow& a, const BenchRow& b) {
      return set_on_bench(a) < set_on_bench(b);
    });
    std::stable_sort(log_.rows.begin(), log_.rows.end(),
                     [&](const BenchRow& a, const BenchRow& b) { return set_on_bench(a) < set_on_bench(b); });
    notes_.separator = table.separator;
    notes_.decimal_comma = table.decimal_comma;
    notes_.remarks = table.remarks;
    return record_ ? detail::mean_cycles(log_, request_, notes_) : log_;
  }

  LogNotes notes() {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const Column& column = columns_[c];
      notes_.columns.push_back({column.header, column.name ? column.name->name : "", column.unit, column.factor,
                                column.name ? column.name->unit : "",
                                int(c) == set_ || (column.name && column.name->part == Part::burst), column.used,
                                column.renamed, column.values, column.min, column.max});
    }
    return notes_;
  }

 private:
  struct Column {
    const ColumnName* name = nullptr;  ///< null: not read
    double factor = 1.0;
    std::string unit;
    bool used = true, renamed = false;
    std::string header;
    int values = 0;
    double min = HUGE_VAL, max = -HUGE_VAL;  ///< SI
  };

  [[noreturn]] void refuse(int line, int column, const std::string& key, const std::string& message) const {
    throw InputError(file_, line, column, key, message);
  }

  /// A column of times, unless it is to be ignored or only metrics are wanted.
  bool has_times(const TableLine& header) const {
    for (const std::string& wanted : request_.measured) {
      if (!detail::column_named(wanted, detail::waveform_quantities())) return false;
    }
    for (const TableCell& cell : header.cells) {
      const auto stated = std::find_if(request_.columns.begin(), request_.columns.end(),
                                       [&](const auto& named) { return named.first == cell.text; });
      const bool named = stated != request_.columns.end();
      const RecognisedColumn found = named ? detail::recognise_stated(stated->second, cell.text, record_columns())
                                           : detail::recognise(cell.text, record_columns());
      if (found.column && found.column->name == "time") return true;
    }
    return false;
  }

  Column column_of(const TableCell& cell, int line) {
    RecognisedColumn found;
    bool stated = false;
    for (const auto& [header, name] : request_.columns) {
      if (header != cell.text) continue;
      if (name == ignored) return {nullptr, 1.0, "", false, false, cell.text};
      stated = true;
      found = detail::recognise_stated(name, cell.text, known_);
      if (!found.column)
        refuse(line, cell.column, "", fmt::format("columns names {}, which is no quantity", in_quotes(name)));
    }
    if (!stated) found = detail::recognise(cell.text, known_);
    const auto& wanted = request_.measured;
    if (!found.column) {
      if (!wanted.empty()) return {nullptr, 1.0, "", false, false, cell.text};  // the others are named
      refuse_unknown(cell, line);
    }
    if (!found.complaint.empty()) refuse(line, cell.column, found.column->name, found.complaint);
    return {found.column, found.factor, found.unit, true, found.renamed, cell.text};
  }

  [[noreturn]] void refuse_unknown(const TableCell& cell, int line) const {
    std::vector<std::string_view> names;
    for (const ColumnName& c : known_) names.push_back(c.name);
    const std::string_view near = nearest_name(
        std::string_view(cell.text).substr(0, std::min(cell.text.find_first_of("[( "), cell.text.size())), names);
    refuse(line, cell.column, "",
           fmt::format("unknown column {}; {}; columns = {{ {} = \"ignore\" }} in [[log]] leaves it out",
                       in_quotes(cell.text),
                       near.empty() ? fmt::format("known are {}", fmt::join(names, ", "))
                                    : fmt::format("did you mean {} with its unit?", near),
                       in_quotes(cell.text)));
  }

  void read_header(const TableLine& header) {
    for (const auto& [name, meaning] : request_.columns) {
      const auto there = [&, n = name](const TableCell& cell) { return cell.text == n; };
      if (std::none_of(header.cells.begin(), header.cells.end(), there)) {
        refuse(header.number, 1, "",
               fmt::format("[[log]] columns names {}, which the header has not", in_quotes(name)));
      }
    }
    for (const TableCell& cell : header.cells) {
      Column column = column_of(cell, header.number);
      for (const Column& before : columns_) {
        if (!column.name || before.name != column.name) continue;
        refuse(
            header.number, cell.column, column.name->name,
            before.header == column.header
                ? "is given twice"
                : fmt::format("is given twice, as {} and as {}; columns = {{ {} = \"ignore\" }} in [[log]] leaves one "
                              "out",
                              in_quotes(before.header), in_quotes(column.header), in_quotes(column.header)));
      }
      columns_.push_back(column);
    }
    const auto index_of = [&](std::string_view name) {
      const auto found = std::find_if(columns_.begin(), columns_.end(),
                                      [&](const Column& c) { return c.name && c.name->name == name; });
      return found == columns_.end() ? -1 : int(found - columns_.begin());
    };
    if (record_) {
      set_ = index_of("time");
      if (set_ >= 0 && request_.sampling_rate) {
        refuse(header.number, 1, "time", "[[log]] states a sampling_rate, and the file has times");
      }
    } else if (log_.waveform) {
      set_ = index_of("crank_angle");
      if (set_ >= 0 && index_of("phase") >= 0) {
        refuse(header.number, 1, "phase", "crank_angle and phase are both given: one is the place in the cycle");
      }
      if (set_ < 0) {
        set_ = index_of("phase");
        log_.in_time = set_ >= 0;
      }
      if (set_ < 0) {
        refuse(header.number, 1, "crank_angle",
               "missing column: a waveform needs crank_angle_deg, phase_deg (equal steps in time) or time_s");
      }
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
        refuse(header.number, 1, log_.given == Given::voltage ? "voltage" : "frequency",
               "missing column: a log needs the voltage or the frequency that was set");
      }
    }
    for (const std::string& wanted : request_.measured) {
      const ColumnName* column = detail::column_named(wanted, known_);
      if (!column || index_of(column->name) < 0) {
        refuse(header.number, 1, wanted, "missing column: [[log]] names it as measured");
      }
    }
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (int(c) == set_ || !columns_[c].name) continue;
      const auto& wanted = request_.measured;
      columns_[c].used = wanted.empty() || std::any_of(wanted.begin(), wanted.end(), [&](const std::string& w) {
                           return detail::column_named(w, known_) == columns_[c].name;
                         });
      if (columns_[c].name->part == Part::burst) columns_[c].used = true;
      if (columns_[c].used && columns_[c].name->part == Part::value) log_.columns.push_back(columns_[c].name->quantity);
    }
    find_scatter(header);
    if (log_.columns.empty()) refuse(header.number, 1, "", "no measured column beside what was set");
  }

  /// Which columns hold the scatter of which others.
  void find_scatter(const TableLine& header) {
    scatter_of_.assign(columns_.size(), -1);
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (!columns_[c].name || columns_[c].name->part != Part::scatter) continue;
      const auto measured = std::find(log_.columns.begin(), log_.columns.end(), columns_[c].name->quantity);
      columns_[c].used = measured != log_.columns.end();
      if (columns_[c].used) {
        scatter_of_[c] = int(measured - log_.columns.begin());
      } else if (request_.measured.empty()) {
        refuse(header.number, 1, columns_[c].name->name, "is the scatter of a column that the file has not");
      }
    }
  }

  /// NaN for a cell without a value.
  double number_in(const TableCell& cell, int line, const Column& column) const {
    if (detail::is_missing(cell.text)) return absent;
    const std::optional<double> number = detail::finite_number(cell.text, decimal_comma_);
    if (!number) {
      refuse(line, cell.column, column.name->name, fmt::format("expected a number, got {}", in_quotes(cell.text)));
    }
    return column.factor * *number;
  }

  void read_row(const TableLine& line) {
    BenchRow row;
    row.line = line.number;
    if (first_line_ == 0) first_line_ = line.number;
    bool has_place = true;
    int missing = 0;
    for (std::size_t c = 0; c < line.cells.size(); ++c) {
      Column& column = columns_[c];
      const TableCell& cell = line.cells[c];
      if (!column.name) continue;
      const double x = number_in(cell, line.number, column);
      if (int(c) == set_) {
        has_place = !std::isnan(x);
        check_place(x, cell, line.number, column);
        if (log_.waveform) row.given = request_.given_value.value_or(absent);
        (log_.waveform ? row.crank_angle : row.given) = x;
      } else if (column.name->part == Part::burst) {
        if (!(std::abs(x) < 1e6)) refuse(line.number, cell.column, "burst", "expected the number of a burst");
        row.burst = int(std::lround(x));
      } else if (column.name->part == Part::scatter) {
        if (!column.used) continue;
        if (x <= 0.0)
          refuse(line.number, cell.column, column.name->name, fmt::format("must be > 0, got {}", cell.text));
        row.deviations.resize(log_.columns.size(), absent);
        row.deviations[std::size_t(scatter_of_[c])] = x / std::sqrt(double(request_.cycles.value_or(1)));
      } else {
        if (x < 0.0 && !column.name->may_be_negative) {
          refuse(line.number, cell.column, column.name->name, fmt::format("must not be negative, got {}", cell.text));
        }
        if (!column.used) continue;
        row.values.push_back(x);
        missing += std::isnan(x);
      }
      if (std::isnan(x)) continue;
      ++column.values;
      column.min = std::min(column.min, x);
      column.max = std::max(column.max, x);
    }
    if (!has_place || missing == int(row.values.size())) {
      log_.rows_left_out.push_back(line.number);
      return;
    }
    log_.values_left_out += missing;
    if (request_.sampling_rate) {
      row.given = request_.given_value.value_or(absent);
      row.crank_angle = double(line.number - first_line_) / *request_.sampling_rate;
    }
    log_.rows.push_back(row);
  }

  void check_place(double x, const TableCell& cell, int line, const Column& column) const {
    if (std::isnan(x)) return;
    if (record_) return;
    if (log_.waveform && !(x >= 0.0 && x <= two_pi * (1.0 + 1e-12))) {
      refuse(line, cell.column, column.name->name, fmt::format("must lie between 0 and 360 deg, got {}", cell.text));
    }
    if (!log_.waveform && !(x > 0.0)) {
      refuse(line, cell.column, column.name->name, fmt::format("must be > 0, got {}", cell.text));
    }
  }

  void refuse_empty_columns() const {
    for (const Column& column : columns_) {
      if (column.name && column.used && column.values == 0) {
        throw InputError(file_, 0, 0, column.name->name,
                         fmt::format("the column {} holds no numbers", in_quotes(column.header)));
      }
    }
  }

  std::string file_;
  const LogRequest& request_;
  BenchLog log_;
  LogNotes notes_;
  std::vector<ColumnName> known_;
  std::vector<Column> columns_;
  std::vector<int> scatter_of_;  ///< by column: index of the measured column that it is the scatter of
  bool decimal_comma_ = false;
  bool record_ = false;  ///< of signals in time
  int first_line_ = 0;
  int set_ = -1;
};

}  // namespace

BenchLog parse_log(std::string_view text, const std::string& file_name, const LogRequest& request, LogNotes* notes) {
  LogReader reader(file_name, request);
  BenchLog log = reader.read(text);
  if (notes) *notes = reader.notes();
  return log;
}

}  // namespace wingbeat

#include "wingbeat/files/loads_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "files/bench_table.hpp"
#include "files/column_headers.hpp"
#include "files/read_number.hpp"
#include "files/text_encoding.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/input_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {
namespace {

using detail::BenchTable, detail::ColumnAlias, detail::NamedColumn, detail::RecognisedHeader, detail::TableCell;
using detail::TableLine;

enum class LoadColumn {
  time,
  phase,
  cycle,
  stroke_angle,
  pitch_angle,
  lift,
  lift_per_wing,
  stroke_moment,
  stroke_moment_per_wing,
  pitch_moment,
  pitch_moment_per_wing
};
constexpr std::size_t load_column_count = 11;

/// In the order of LoadColumn.
const std::array<NamedColumn, load_column_count>& load_columns() {
  static const std::array<NamedColumn, load_column_count> columns = {{
      {"time", "time_s", "s"},
      {"phase", "phase_rad", "rad"},
      {"cycle", "cycle", "1"},
      {"stroke_angle", "stroke_angle_rad", "rad"},
      {"pitch_angle", "pitch_angle_rad", "rad"},
      {"lift", "lift_n", "N"},
      {"lift_per_wing", "lift_per_wing_n", "N"},
      {"stroke_moment", "stroke_moment_nm", "N m"},
      {"stroke_moment_per_wing", "stroke_moment_per_wing_nm", "N m"},
      {"pitch_moment", "pitch_moment_nm", "N m"},
      {"pitch_moment_per_wing", "pitch_moment_per_wing_nm", "N m"},
  }};
  return columns;
}

constexpr ColumnAlias load_aliases[] = {{"t", "time"},
                                        {"cycles", "cycle"},
                                        {"t/t", "cycle"},
                                        {"stroke", "stroke_angle"},
                                        {"flapping_angle", "stroke_angle"},
                                        {"pitch", "pitch_angle"},
                                        {"lift_force", "lift"},
                                        {"lift_of_a_wing", "lift_per_wing"}};

constexpr const char* loads_header_example = "phase_deg,lift_mN or time_s,lift_per_wing_mN,stroke_moment_mN_m";

class LoadsReader {
 public:
  explicit LoadsReader(const std::string& file) : file_(file) {
    for (const NamedColumn& c : load_columns()) known_.push_back(&c);
  }

  SimulatedLoads read(std::string_view text, LoadsNotes* notes) {
    std::string encoding;
    const std::string utf8 = detail::decoded(text, file_, encoding);
    const BenchTable table = detail::read_bench_table(utf8, file_);
    if (table.header.cells.empty()) {
      throw InputError(file_, 0, 0, "", fmt::format("is empty; expected a header such as {}", loads_header_example));
    }
    decimal_comma_ = table.decimal_comma;
    read_header(table.header);
    if (table.rows.empty()) refuse(table.header.number, 1, "", "holds no rows");
    for (const TableLine& row : table.rows) read_row(row);
    if (notes) {
      for (const Column& c : columns_) notes->columns.push_back({c.header, c.name ? c.name->name : ""});
    }
    return loads(table.header.number);
  }

 private:
  struct Column {
    std::string header;
    const NamedColumn* name = nullptr;  ///< null: not read
    double factor = 1.0;
    std::vector<double> values = {};
  };

  [[noreturn]] void refuse(int line, int column, const std::string& key, const std::string& message) const {
    throw InputError(file_, line, column, key, message);
  }

  Column* column(LoadColumn which) {
    const NamedColumn* name = &load_columns()[std::size_t(which)];
    const auto found = std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == name; });
    return found == columns_.end() ? nullptr : &*found;
  }

  void read_header(const TableLine& header) {
    for (const TableCell& cell : header.cells) {
      const RecognisedHeader found = detail::recognise_header(cell.text, known_, load_aliases);
      if (found.column && !found.complaint.empty()) {
        refuse(header.number, cell.column, found.column->name, found.complaint);
      }
      for (const Column& before : columns_) {
        if (found.column && before.name == found.column) {
          refuse(header.number, cell.column, found.column->name,
                 fmt::format("is given twice, as {} and as {}", in_quotes(before.header), in_quotes(cell.text)));
        }
      }
      columns_.push_back({cell.text, found.column, found.factor});
    }
    if (column(LoadColumn::phase) && column(LoadColumn::cycle)) {
      refuse(header.number, 1, "cycle", "phase and cycle are both given: one is the place in the cycle");
    }
    if (!column(LoadColumn::time) && !column(LoadColumn::phase) && !column(LoadColumn::cycle)) {
      refuse(header.number, 1, "",
             fmt::format("missing column: a place in the cycle is needed, time_s, phase_deg or cycle (0 to 1); the "
                         "header has {}",
                         listed_headers()));
    }
    bool any = false;
    for (std::size_t k = std::size_t(LoadColumn::lift); k < load_column_count; ++k) {
      any = any || column(LoadColumn(k)) != nullptr;
    }
    if (!any) {
      refuse(header.number, 1, "",
             fmt::format("missing column: a load is needed, such as lift_mN, lift_per_wing_mN, stroke_moment_mN_m or "
                         "pitch_moment_mN_m; the header has {}",
                         listed_headers()));
    }
    for (const LoadColumn all : {LoadColumn::lift, LoadColumn::stroke_moment, LoadColumn::pitch_moment}) {
      const auto one = LoadColumn(int(all) + 1);
      if (column(all) && column(one)) {
        refuse(header.number, 1, load_columns()[std::size_t(one)].name,
               "is given of all wings and per wing; expected one of both");
      }
    }
  }

  std::string listed_headers() const {
    std::vector<std::string> names;
    for (const Column& c : columns_) names.push_back(in_quotes(c.header));
    return fmt::format("{}", fmt::join(names, ", "));
  }

  void read_row(const TableLine& row) {
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      Column& c = columns_[k];
      if (!c.name) continue;
      const TableCell& cell = row.cells[k];
      const bool is_place = c.name->name == "time" || c.name->name == "phase" || c.name->name == "cycle";
      if (detail::is_missing(cell.text)) {
        if (is_place) refuse(row.number, cell.column, c.name->name, "is missing; expected a number in each row");
        c.values.push_back(absent);
        continue;
      }
      const std::optional<double> number = detail::finite_number(cell.text, decimal_comma_);
      if (!number) {
        refuse(row.number, cell.column, c.name->name, fmt::format("expected a number, got {}", in_quotes(cell.text)));
      }
      c.values.push_back(c.factor * *number);
    }
  }

  /// Of rows that have both time and phase: the cycles over the time between the first and the last of them.
  std::optional<double> frequency_of(const std::vector<double>& times, const std::vector<double>& cycles) const {
    const auto [first, last] = std::minmax_element(times.begin(), times.end());
    const double passed = cycles[std::size_t(last - times.begin())] - cycles[std::size_t(first - times.begin())];
    if (!(*last > *first) || !(passed > 0.0)) return std::nullopt;
    const double frequency = passed / (*last - *first);
    // A phase that begins anew with each cycle does not count them.
    for (std::size_t n = 0; n < times.size(); ++n) {
      const double expected = cycles[std::size_t(first - times.begin())] + frequency * (times[n] - *first);
      if (std::abs(cycles[n] - expected) > 1e-3) return std::nullopt;
    }
    return frequency;
  }

  SimulatedLoads loads(int header_line) {
    SimulatedLoads result;
    result.file = file_;
    Column* const time = column(LoadColumn::time);
    if (Column* const phase = column(LoadColumn::phase)) {
      result.places = phase->values;
      for (double& x : result.places) x /= two_pi;
    } else if (Column* const cycle = column(LoadColumn::cycle)) {
      result.places = cycle->values;
    } else {
      result.places = time->values;
      result.in_time = true;
    }
    if (time && !result.in_time) result.frequency = frequency_of(time->values, result.places);
    const auto angle = [&](LoadColumn which, std::vector<double>& values) {
      if (Column* const c = column(which)) values = c->values;
    };
    angle(LoadColumn::stroke_angle, result.stroke);
    angle(LoadColumn::pitch_angle, result.pitch);
    for (std::size_t q = 0; q < load_quantity_count; ++q) {
      const auto all = std::size_t(LoadColumn::lift) + 2 * q;
      for (const bool per_wing : {false, true}) {
        Column* const c = column(LoadColumn(all + (per_wing ? 1 : 0)));
        if (!c) continue;
        if (std::none_of(c->values.begin(), c->values.end(), [](double x) { return std::isfinite(x); })) {
          refuse(header_line, 1, c->name->name, fmt::format("the column {} holds no numbers", in_quotes(c->header)));
        }
        result.loads[q] = LoadSeries{c->values, per_wing};
      }
    }
    return result;
  }

  std::string file_;
  std::vector<const NamedColumn*> known_;
  std::vector<Column> columns_;
  bool decimal_comma_ = false;
};

}  // namespace

SimulatedLoads parse_loads(std::string_view text, const std::string& file_name, LoadsNotes* notes) {
  return LoadsReader(file_name).read(text, notes);
}

SimulatedLoads read_loads(const std::filesystem::path& file, LoadsNotes* notes) {
  return parse_loads(read_text_file(file, largest_study), input_name(file), notes);
}

}  // namespace wingbeat

#include "files/design_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <system_error>
#include <utility>

#include "files/csv_cells.hpp"
#include "files/study_sections.hpp"
#include "wingbeat/files/file_record.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

struct Column {
  SweptQuantity quantity;
  std::string unit;
};

/// A cell of the header; `refuse` throws.
template <class Refuse>
Column column_of(std::string_view cell, const std::function<SweptQuantity(const std::string& key)>& quantity_named,
                 const Refuse& refuse) {
  const auto bracket = std::min(cell.find_first_of("[("), cell.size());
  std::string_view unit = trimmed(cell.substr(bracket));
  if (!unit.empty()) {
    const bool closed = unit.size() > 2 && unit.back() == (unit.front() == '[' ? ']' : ')');
    if (!closed) {
      refuse(fmt::format("{}: the unit stands in brackets, as in \"motor.inertia [kg m2]\"", in_quotes(cell)));
    }
    unit = trimmed(unit.substr(1, unit.size() - 2));
  }
  SweptQuantity q;
  try {
    q = quantity_named(std::string(trimmed(cell.substr(0, bracket))));
  } catch (const InputError& error) {
    refuse(reason_of(error));
  }
  if (q.kind == SweptQuantity::Kind::choice) refuse(fmt::format("{} is not a number", q.key));
  if (unit.empty() && q.unit != "1") {
    refuse(fmt::format("{} names no unit; expected a heading such as \"{} [{}]\"", q.key, q.key, q.unit));
  }
  try {
    require_unit(unit, q.unit);
  } catch (const UnitError& error) {
    refuse(fmt::format("{}: {}", q.key, error.what()));
  }
  return {std::move(q), std::string(unit)};
}

}  // namespace

std::string read_design_table_file(const std::filesystem::path& file) {
  constexpr std::uintmax_t largest = 256u << 20;
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
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

std::vector<int> parse_design_table(std::string_view text, const std::string& file, SweepAxis& axis,
                                    const std::function<SweptQuantity(const std::string& key)>& quantity_named) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  int line_number = 0;
  std::vector<std::string> units;
  std::vector<int> lines;
  for (std::string_view line; next_line(text, line, line_number);) {
    if (is_blank_or_comment(line)) continue;
    const std::vector<CsvCell> cells = csv_cells(line);
    if (axis.quantities.empty()) {
      for (const CsvCell& cell : cells) {
        Column column = column_of(cell.text, quantity_named, [&](const std::string& message) {
          throw InputError(file, line_number, cell.column, "", message);
        });
        axis.quantities.push_back(std::move(column.quantity));
        units.push_back(std::move(column.unit));
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
        q.values.push_back(parse_quantity(fmt::format("{} {}", cells[n].text, units[n]), q.unit));
      } catch (const UnitError&) {
        throw InputError(file, line_number, cells[n].column, q.key,
                         fmt::format("expected a number, got {}", in_quotes(cells[n].text)));
      }
      if (q.kind == SweptQuantity::Kind::held && !(q.values.back() > 0.0)) {
        throw InputError(file, line_number, cells[n].column, q.key, must_be_positive(q.unit));
      }
    }
    lines.push_back(line_number);
  }
  if (lines.empty()) {
    throw InputError(file, 0, 0, "",
                     "holds no designs; expected a header such as \"transmission.crank_radius [mm]\" "
                     "and a line for each design");
  }
  axis.count = lines.size();
  return lines;
}

}  // namespace wingbeat::detail

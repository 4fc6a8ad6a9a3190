#include "files/table_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "files/csv_cells.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {

namespace {

std::string example_header(std::span<const CsvColumn> columns) {
  std::string header;
  for (const CsvColumn& column : columns) {
    if (column.optional) continue;
    header += (header.empty() ? "" : ",") + std::string(column.name);
    if (column.unit == "m") header += "_mm";
    if (column.unit == "rad") header += "_deg";
    if (column.unit == "rad/s") header += "_rad_per_s";
    if (column.unit == "N") header += "_mN";
    if (column.unit == "N m") header += "_mN_m";
  }
  return header;
}

/// One column of the file: which of the wanted it is, and its unit as a suffix of every number.
struct Heading {
  std::size_t index;
  std::string unit;
};

}  // namespace

std::vector<std::vector<double>> parse_csv(std::string_view text, const std::string& file_name,
                                           std::span<const CsvColumn> columns) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<Heading> headings;
  std::vector<std::vector<double>> rows;
  int line_number = 0;
  const auto refuse = [&](const CsvCell& cell, const std::string& message) {
    throw InputError(file_name, line_number, cell.column, "", message);
  };
  const std::string header = example_header(columns);
  for (std::string_view line; next_line(text, line, line_number);) {
    if (is_blank_or_comment(line)) continue;
    const std::vector<CsvCell> cells = csv_cells(line);

    if (headings.empty()) {
      for (const CsvCell& cell : cells) {
        const auto known = std::find_if(columns.begin(), columns.end(), [&](const CsvColumn& c) {
          const std::size_t end = c.name.size();
          return cell.text.starts_with(c.name) &&
                 (cell.text.size() == end || std::string_view("_[( ").find(cell.text[end]) != std::string_view::npos);
        });
        if (known == columns.end()) {
          refuse(cell, fmt::format("unknown column {}; expected a header such as {}", in_quotes(cell.text), header));
        }
        const std::string_view name = known->name;
        std::string unit(cell.text.substr(name.size()));
        std::replace(unit.begin(), unit.end(), '_', ' ');
        unit = trimmed(unit);
        const bool bracketed = unit.size() >= 2 && ((unit.front() == '[' && unit.back() == ']') ||
                                                    (unit.front() == '(' && unit.back() == ')'));
        if (bracketed) unit = trimmed(unit.substr(1, unit.size() - 2));
        const std::size_t index = std::size_t(known - columns.begin());
        if (std::any_of(headings.begin(), headings.end(), [&](const Heading& h) { return h.index == index; })) {
          refuse(cell, fmt::format("column {} is given twice", in_quotes(name)));
        }
        if (unit.empty() && known->unit != "1") {
          refuse(cell, fmt::format("column {} names no unit; expected a header such as {}", in_quotes(name), header));
        }
        try {
          unit_factor(unit, known->unit);
        } catch (const UnitError& error) {
          refuse(cell, error.what());
        }
        headings.push_back({index, unit});
      }
      const bool complete = std::all_of(columns.begin(), columns.end(), [&](const CsvColumn& c) {
        const auto index = std::size_t(&c - columns.data());
        return c.optional ||
               std::any_of(headings.begin(), headings.end(), [&](const Heading& h) { return h.index == index; });
      });
      if (!complete) {
        refuse(cells.front(), fmt::format("too few columns; expected a header such as {}", header));
      }
      continue;
    }

    if (cells.size() != headings.size()) {
      refuse(cells.front(), fmt::format("expected {} numbers, got {}", headings.size(), cells.size()));
    }
    std::vector<double> row(columns.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t n = 0; n < cells.size(); ++n) {
      try {
        const std::string quantity = std::string(cells[n].text) + " " + headings[n].unit;
        row[headings[n].index] = parse_quantity(quantity, columns[headings[n].index].unit);
      } catch (const UnitError&) {
        refuse(cells[n], fmt::format("expected a number, got {}", in_quotes(cells[n].text)));
      }
    }
    rows.push_back(std::move(row));
  }
  if (headings.empty()) {
    throw InputError(file_name, 0, 0, "", fmt::format("is empty; expected a header such as {}", header));
  }
  return rows;
}

}  // namespace wingbeat

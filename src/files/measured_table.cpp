#include "files/measured_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wingbeat/files/units.hpp"

namespace wingbeat {

using Kind = TomlNode::Kind;

MeasuredTable::MeasuredTable(const TomlFields& section) {
  const std::string_view keys[] = {"columns", "rows"};
  section.known_keys(keys);
  const TomlNode& columns = section.at("columns");
  if (!section.has("columns") || columns.kind != Kind::array) {
    section.refuse(columns, "columns", "expected a list of column names");
  }
  for (const TomlNode& item : columns.items) {
    if (item.kind != Kind::text || item.text.empty()) {
      section.refuse(item, "columns", "expected a list of column names, got " + kind_of(item));
    }
    if (std::find(columns_.begin(), columns_.end(), item.text) != columns_.end()) {
      section.refuse(item, "columns", in_quotes(item.text) + " is given twice");
    }
    columns_.push_back(item.text);
  }
  const TomlNode& rows = section.at("rows");
  if (!section.has("rows") || rows.kind != Kind::array) section.refuse(rows, "rows", "expected a list of rows");
  for (const TomlNode& row : rows.items) {
    const std::string name = fmt::format("rows[{}]", rows_.size() + 1);
    if (row.kind != Kind::array) section.refuse(row, name, "expected a list of cells, got " + kind_of(row));
    if (row.items.size() != columns_.size()) {
      section.refuse(row, name,
                     fmt::format("has {} cells, but there are {} columns", row.items.size(), columns_.size()));
    }
    std::vector<Cell> cells;
    for (const TomlNode& item : row.items) {
      if (item.kind == Kind::text) {
        cells.push_back({0.0, item.text, true});
      } else if (item.kind == Kind::number && !std::isinf(item.number)) {
        cells.push_back({item.number, {}, false});
      } else {
        section.refuse(item, name,
                       "expected a number, nan where there is none, or a text, got " +
                           (item.kind == Kind::number ? "infinity" : kind_of(item)));
      }
    }
    rows_.push_back(std::move(cells));
  }
}

std::size_t MeasuredTable::column(const TomlFields& section, std::string_view key, const std::string& name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end()) {
    section.refuse(
        section.at(key), key,
        fmt::format("there is no column {}; the columns are {}", in_quotes(name), fmt::join(columns_, ", ")));
  }
  return std::size_t(found - columns_.begin());
}

double MeasuredTable::number(const TomlFields& section, std::string_view key, std::size_t row,
                             std::size_t column) const {
  const Cell& cell = rows_[row][column];
  if (cell.is_text) {
    section.refuse(section.at(key), key,
                   fmt::format("row {} has the text {} in the column {}, where a number is needed", row + 1,
                               in_quotes(cell.text), in_quotes(columns_[column])));
  }
  return cell.number;
}

std::size_t MeasuredTable::row_of(const TomlFields& section, std::string_view key, const std::string& name) const {
  for (std::size_t n = 0; n < rows_.size(); ++n) {
    if (!rows_[n].empty() && rows_[n].front().is_text && rows_[n].front().text == name) return n;
  }
  section.refuse(section.at(key), key, fmt::format("no row begins with {}", in_quotes(name)));
}

double MeasuredTable::named(const TomlFields& section, std::string_view key, const std::string& name) const {
  const double x = number(section, key, row_of(section, key, name), column(section, key, "value"));
  if (!std::isfinite(x)) section.refuse(section.at(key), key, fmt::format("{} has no value", in_quotes(name)));
  return x;
}

}  // namespace wingbeat

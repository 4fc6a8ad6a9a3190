// The columns and rows of a measured file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "files/toml_fields.hpp"

namespace wingbeat {

/// Numbers, which may be missing ("nan"), and texts in named columns.
class MeasuredTable {
 public:
  struct Cell {
    double number = 0.0;
    std::string text;  ///< of a cell that holds one
    bool is_text = false;
    auto operator<=>(const Cell&) const = default;
  };

  MeasuredTable() = default;
  /// Of the section [data]. Throws InputError where a row has another number of cells than there are columns.
  explicit MeasuredTable(const TomlFields& section);

  const std::vector<std::vector<Cell>>& rows() const { return rows_; }
  /// The index of a column that the key of a section names; refused at that key where there is none.
  std::size_t column(const TomlFields& section, std::string_view key, const std::string& name) const;
  /// The number in a row; refused at the key of the section that asks for the column where the cell holds a text.
  double number(const TomlFields& section, std::string_view key, std::size_t row, std::size_t column) const;
  /// The number in column "value" of the row whose column "quantity" has this name.
  double named(const TomlFields& section, std::string_view key, const std::string& name) const;
  /// The row whose first cell has this text.
  std::size_t row_of(const TomlFields& section, std::string_view key, const std::string& name) const;

 private:
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

}  // namespace wingbeat

// CSV files as test benches, spreadsheets and data loggers write them, cut into cells.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wingbeat::detail {

struct TableCell {
  std::string text;  ///< without quotes and blanks around it
  int column;        ///< of its first character in the line, from 1
};

struct TableLine {
  int number;  ///< in the file, from 1
  std::vector<TableCell> cells;
};

/// What a file states about itself, where it cannot be seen.
struct TableForm {
  std::optional<char> separator;  ///< ',', ';' or '\t'
  std::optional<char> decimal;    ///< '.' or ','
};

/// Beside it what columns are that do not say so themselves.
struct StatedTable {
  TableForm form;
  /// Header and name of a column, with a unit where the header has none, or "ignore".
  std::vector<std::pair<std::string, std::string>> columns;
};

struct BenchTable {
  char separator = ',';
  bool decimal_comma = false;  ///< numbers are written 3,14
  int remarks = 0;             ///< lines of comments
  TableLine header{0, {}};     ///< without cells in an empty file
  std::vector<TableLine> rows;
};

/// A cell without a value: empty, NaN, #N/A and the like.
bool is_missing(std::string_view cell);

/// Cells between commas, semicolons or tabs, with or without quotes, numbers with a decimal point or comma, remarks
/// behind #, % or //, lines that end in any way. Throws InputError with a question where two readings are possible, and
/// for rows that have not as many cells as the header.
BenchTable read_bench_table(std::string_view utf8, const std::string& file, const TableForm& form = {});

}  // namespace wingbeat::detail

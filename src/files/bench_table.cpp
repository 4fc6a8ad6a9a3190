#include "files/bench_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "wingbeat/core/text.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat::detail {
namespace {

constexpr std::array separators{',', ';', '\t'};

const char* name_of_separator(char c) { return c == ',' ? "comma" : c == ';' ? "semicolon" : "tab"; }

struct Line {
  int number;
  std::string_view text;
};

bool is_remark(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

/// Lines that end in \n, \r\n or \r.
std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    lines.push_back({number, text.substr(0, end)});
    const bool two = text.substr(std::min(end, text.size()), 2) == "\r\n";
    text.remove_prefix(std::min(end + (two ? 2 : 1), text.size()));
  }
  return lines;
}

/// Quotes around a cell hide separators; a quote within them is written twice.
TableLine cut(const Line& line, char separator) {
  TableLine result{line.number, {}};
  std::string cell;
  std::size_t first = 0;
  bool quoted = false, was_quoted = false;
  const std::string_view text = line.text;
  for (std::size_t n = 0; n <= text.size(); ++n) {
    if (n == text.size() || (text[n] == separator && !quoted)) {
      const std::size_t blank = was_quoted ? 0 : std::min(cell.find_first_not_of(" \t"), cell.size());
      result.cells.push_back({std::string(trimmed(cell)), int(first + blank + 1)});
      cell.clear();
      first = n + 1;
      was_quoted = false;
    } else if (text[n] == '"' && (quoted || trimmed(cell).empty())) {
      if (quoted && n + 1 < text.size() && text[n + 1] == '"') cell += text[n++];
      else quoted = !quoted;
      was_quoted = true;
    } else {
      cell += text[n];
    }
  }
  return result;
}

/// A number with a comma in it, as 3,14 or 1,234.
struct CommaNumber {
  bool is = false;
  bool one_reading = false;  ///< it cannot have a comma between thousands
};
CommaNumber comma_number(std::string_view cell) {
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  const std::size_t comma = cell.find(',');
  if (comma == std::string_view::npos || cell.find(',', comma + 1) != std::string_view::npos) return {};
  const std::string_view before = cell.substr(0, comma), after = cell.substr(comma + 1);
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const std::size_t digits = std::size_t(std::find_if_not(after.begin(), after.end(), is_digit) - after.begin());
  const bool exponent = digits < after.size() && (after[digits] == 'e' || after[digits] == 'E');
  if (!std::all_of(before.begin(), before.end(), is_digit) || digits == 0) return {};
  if (digits < after.size() && !exponent) return {};
  const bool thousands = digits == 3 && !exponent && !before.empty() && before.size() <= 3 && before[0] != '0';
  return {true, !thousands};
}

bool has_point(std::string_view cell) {
  return !cell.empty() && cell.find('.') != std::string_view::npos &&
         cell.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
}

class TableReader {
 public:
  TableReader(const std::string& file, const TableForm& form) : file_(file), form_(form) {}

  BenchTable read(std::string_view text) {
    gather(text);
    if (lines_.empty()) return std::move(table_);
    table_.separator = separator();
    table_.header = cut(lines_.front(), table_.separator);
    while (!table_.header.cells.empty() && table_.header.cells.back().text.empty()) table_.header.cells.pop_back();
    const std::size_t width = table_.header.cells.size();
    for (std::size_t n = 1; n < lines_.size(); ++n) {
      TableLine row = cut(lines_[n], table_.separator);
      // A line of separators alone, as spreadsheets leave them, is blank.
      if (std::all_of(row.cells.begin(), row.cells.end(), [](const TableCell& c) { return c.text.empty(); })) continue;
      while (row.cells.size() > width && row.cells.back().text.empty()) row.cells.pop_back();
      if (row.cells.size() != width) refuse_width(row, width);
      table_.rows.push_back(std::move(row));
    }
    find_decimal();
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(int line, int column, const std::string& message) const {
    throw InputError(file_, line, column, "", message);
  }

  void gather(std::string_view text) {
    for (const Line& line : lines_of(text)) {
      const std::string_view content = trimmed(line.text);
      if (content.empty()) continue;
      if (is_remark(content)) {
        ++table_.remarks;
      } else if (lines_.empty() && content.size() == 5 && content.starts_with("sep=")) {
        if (!form_.separator) form_.separator = content[4];  // as spreadsheets say it
      } else {
        lines_.push_back(line);
      }
    }
  }

  char separator() const {
    if (form_.separator) return *form_.separator;
    std::vector<char> found;
    for (const char c : separators) {
      if (cut(lines_.front(), c).cells.size() > 1) found.push_back(c);
    }
    if (found.empty()) return ',';  // one column
    if (found.size() == 1) return found.front();
    std::vector<char> fit;
    for (const char c : found) {
      const std::size_t width = cut(lines_.front(), c).cells.size();
      const auto matches = [&](const Line& line) { return cut(line, c).cells.size() == width; };
      if (std::all_of(lines_.begin() + 1, lines_.end(), matches)) fit.push_back(c);
    }
    if (fit.size() == 1) return fit.front();
    const std::vector<char>& open = fit.empty() ? found : fit;
    refuse(
        lines_.front().number, 1,
        fmt::format("are the cells separated by a {} or by a {}? Both stand in the header; say separator = \"{}\" or "
                    "\"{}\" in [[log]]",
                    name_of_separator(open[0]), name_of_separator(open[1]), name_of_separator(open[0]),
                    name_of_separator(open[1])));
  }

  [[noreturn]] void refuse_width(const TableLine& row, std::size_t width) const {
    const bool doubled =
        table_.separator == ',' && width > 1 && row.cells.size() > width && row.cells.size() <= 2 * width;
    refuse(row.number, 1,
           fmt::format("expected {} values, got {}{}", width, row.cells.size(),
                       doubled ? "; decimal commas between commas are ambiguous: write points, or separate the "
                                 "cells by semicolons"
                               : ""));
  }

  void find_decimal() {
    if (form_.decimal) {
      table_.decimal_comma = *form_.decimal == ',';
      return;
    }
    struct Place {
      int line, column;
      std::string text;
    };
    std::optional<Place> comma, point, open;
    bool sure = false;
    for (const TableLine& row : table_.rows) {
      for (const TableCell& cell : row.cells) {
        const CommaNumber number = comma_number(cell.text);
        const auto note = [&](std::optional<Place>& place) {
          if (!place) place = Place{row.number, cell.column, cell.text};
        };
        if (number.is) note(comma);
        if (number.is && !number.one_reading) note(open);
        if (has_point(cell.text)) note(point);
        sure = sure || number.one_reading;
      }
    }
    if (!comma) return;
    if (point) {
      refuse(
          comma->line, comma->column,
          fmt::format("{} has a comma and {} in line {} has a point: which is the decimal sign? Say decimal = \",\" or "
                      "\".\" in [[log]]",
                      in_quotes(comma->text), in_quotes(point->text), point->line));
    }
    if (!sure) {
      refuse(open->line, open->column,
             fmt::format("is {} a decimal fraction or a number of thousands? Say decimal = \",\" or \".\" in [[log]]",
                         in_quotes(open->text)));
    }
    table_.decimal_comma = true;
  }

  const std::string& file_;
  TableForm form_;
  std::vector<Line> lines_;  ///< header and rows
  BenchTable table_;
};

}  // namespace

bool is_missing(std::string_view cell) {
  std::string small(cell);
  std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  for (const char* known : {"", "nan", "na", "n/a", "#n/a", "#n/v", "-", "--", "null", "none", "#value!", "#div/0!"}) {
    if (small == known) return true;
  }
  return false;
}

BenchTable read_bench_table(std::string_view utf8, const std::string& file, const TableForm& form) {
  return TableReader(file, form).read(utf8);
}

}  // namespace wingbeat::detail

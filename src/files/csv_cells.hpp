// Lines of CSV files without quoting, cell by cell.
#pragma once

#include <algorithm>
#include <string_view>
#include <vector>

#include "wingbeat/core/text.hpp"

namespace wingbeat {

using detail::trimmed;

struct CsvCell {
  std::string_view text;  ///< without blanks around it
  int column;             ///< of its first character in the line, from 1
};

inline std::vector<CsvCell> csv_cells(std::string_view line) {
  std::vector<CsvCell> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::string_view raw = line.substr(begin, end - begin);
    const std::size_t blank = std::min(raw.find_first_not_of(" \t\r"), raw.size());
    cells.push_back({trimmed(raw), int(begin + blank + 1)});
    begin = end + 1;
  }
  return cells;
}

/// Takes the next line off the text and counts it; false at the end.
inline bool next_line(std::string_view& text, std::string_view& line, int& number) {
  if (text.empty()) return false;
  const std::size_t end = std::min(text.find('\n'), text.size());
  line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  ++number;
  return true;
}

/// True for a line that holds nothing but blanks or a comment.
inline bool is_blank_or_comment(std::string_view line) {
  const std::string_view content = trimmed(line);
  return content.empty() || content.starts_with('#');
}

}  // namespace wingbeat

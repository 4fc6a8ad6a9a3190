// Chord and coefficient tables: comma-separated values under a header that names each column and its unit.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wingbeat {

struct CsvColumn {
  std::string_view name;
  std::string_view unit;  ///< SI; "1": the column has no unit
  bool optional = false;  ///< a table without it has rows that are not a number there
};

/// Rows of SI numbers, the columns in the order asked for. The header reads "distance_mm,chord_mm",
/// "distance [mm],chord [mm]" or "distance (mm),chord (mm)"; blank lines and lines that begin with # are skipped.
/// Throws InputError with `file_name` and the line.
std::vector<std::vector<double>> parse_csv(std::string_view text, const std::string& file_name,
                                           std::span<const CsvColumn> columns);

}  // namespace wingbeat

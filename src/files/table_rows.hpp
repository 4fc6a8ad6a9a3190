// Tables of vehicle files: rows in place, or the CSV file of that name.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "files/table_csv.hpp"
#include "files/toml_document.hpp"
#include "files/toml_reader.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/design_file.hpp"

namespace wingbeat {

inline constexpr CsvColumn chord_columns[] = {{"distance", "m"}, {"chord", "m"}};
inline constexpr CsvColumn stroke_columns[] = {{"crank_angle", "rad"}, {"stroke_angle", "rad"}};
inline constexpr CsvColumn discharge_columns[] = {{"charge", "1"}, {"voltage", "V"}};
inline constexpr CsvColumn load_columns[] = {{"stroke_angle", "rad", true},
                                             {"flapping_velocity", "rad/s"},
                                             {"pitch_angle", "rad", true},
                                             {"pitch_velocity", "rad/s", true},
                                             {"lift", "N"},
                                             {"stroke_moment", "N m"},
                                             {"pitch_moment", "N m", true}};
inline constexpr CsvColumn coefficient_columns[] = {{"alpha", "rad"}, {"cl", "1"}, {"cd", "1"}};

/// SI numbers, in the order of `columns`. Throws InputError at the value's place.
template <std::size_t N>
std::vector<std::array<double, N>> table_rows(const Value& value, std::string_view path, const CsvColumn (&columns)[N],
                                              const TableLoader& load_table) {
  const TomlReader reader(value.origin.file);
  std::vector<std::array<double, N>> rows;
  if (value.kind == TomlNode::Kind::array) {
    for (const TomlNode& row : value.items) {
      if (row.kind != TomlNode::Kind::array || row.items.size() != N) {
        value.origin.refuse(std::string(path), fmt::format("row {} must hold {} values", rows.size() + 1, N));
      }
      std::array<double, N>& numbers = rows.emplace_back();
      for (std::size_t n = 0; n < N; ++n) {
        numbers[n] = reader.quantity(row.items[n], std::string(path), columns[n].unit, SpeedConstant::inverted);
      }
    }
    return rows;
  }
  if (value.kind != TomlNode::Kind::text) reader.wrong(value, std::string(path), "the name of a CSV file, or rows");
  if (!load_table) value.origin.refuse(std::string(path), "table files cannot be read here; give the rows in place");
  try {
    for (const auto& row : parse_csv(load_table(value.text), one_line(value.text), columns)) {
      std::copy_n(row.begin(), N, rows.emplace_back().begin());
    }
    return rows;
  } catch (const std::runtime_error& error) {
    value.origin.refuse(std::string(path), error.what());
  }
}

}  // namespace wingbeat

// A line of a measured file that a map is compared with.
#pragma once

#include <string>
#include <vector>

#include "files/measured_table.hpp"
#include "wingbeat/study/validation.hpp"

namespace wingbeat::detail {

/// The line `slope (x - zero)` of rows of the data at the inputs `at`, of the quantity that a table [[validation.map]]
/// names.
struct MeasuredLine {
  ComparedQuantity quantity;
  std::vector<double> inputs;    ///< of the source
  std::vector<double> measured;  ///< in the quantity's unit
};
MeasuredLine read_line(const TomlFields& map, const MeasuredTable& table);

/// A number other than 0, 1 unless given.
double factor_of(const TomlFields& map, std::string_view key);

/// The SI value of the quantity's unit, refused where it is none of `si`.
double unit_of_map(const TomlFields& map, const ComparedQuantity& quantity, std::string_view si);

/// Adds the points of the line, its inputs labelled in `unit`.
void add_points(const MeasuredLine& line, const std::string& unit, ValidationSet& set);

}  // namespace wingbeat::detail

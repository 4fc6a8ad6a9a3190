// The columns that a log of a test bench may have.
#pragma once

#include <string>
#include <vector>

#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat::detail {

/// A column of a log by its name without unit.
struct ColumnName {
  std::string name;
  std::string full;  ///< with the SI unit, as in JSON and data sets: "current_mean_a"
  std::string unit;
  MeasuredQuantity quantity;
  bool may_be_negative;
};

/// Of a log with an operating point in each row.
const std::vector<ColumnName>& metric_columns();
/// Of a log over one turn of the crank.
const std::vector<ColumnName>& waveform_quantities();

}  // namespace wingbeat::detail

// The columns that a log of a test bench may have, and how benches name them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/column_headers.hpp"
#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat::detail {

/// A column of a log.
struct ColumnName : NamedColumn {
  MeasuredQuantity quantity;
  bool may_be_negative;
  enum class Part { value, place, scatter, burst } part = Part::value;
};

/// Of a log with an operating point in each row.
const std::vector<ColumnName>& metric_columns();
/// Of a log over one cycle.
const std::vector<ColumnName>& waveform_quantities();
/// Beside them the place in the cycle (crank_angle, or phase in time) and the scatter of each quantity.
const std::vector<ColumnName>& waveform_columns();
/// Of a record of signals: the quantities, time and burst.
const std::vector<ColumnName>& record_columns();

/// The column of a name of the program or of one in use at benches ("current", "thrust"), with or without unit; null
/// where it is none of them.
const ColumnName* column_named(std::string_view name, std::span<const ColumnName> known);

struct RecognisedColumn {
  const ColumnName* column = nullptr;  ///< null: unknown
  double factor = 1.0;                 ///< SI value over the number
  std::string unit;                    ///< as written
  bool renamed = false;                ///< the bench's name is not the program's
  std::string complaint;               ///< about the unit; empty where there is none
};

/// What a header means, as "current_mean_mA", "Lift (g)", "U [V]" or "Frequency / Hz".
RecognisedColumn recognise(std::string_view header, std::span<const ColumnName> known);

/// What a header means that [[log]] says to be `name`.
RecognisedColumn recognise_stated(std::string_view name, std::string_view header, std::span<const ColumnName> known);

}  // namespace wingbeat::detail

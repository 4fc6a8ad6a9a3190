// Numbers of hover and maps of a vehicle with a body, of a measured file: [[validation.value]], [[validation.map]].
#pragma once

#include "files/measured_table.hpp"
#include "wingbeat/study/validation.hpp"

namespace wingbeat::detail {

/// The numbers of [validation], each of a row of the data, and its maps, each a line `slope (x - zero)` at stated
/// inputs; quantities and points go to `set`.
FlightProblem read_hover(const TomlFields& plan, const MeasuredTable& table, const Design<double>& design,
                         ValidationSet& set);

}  // namespace wingbeat::detail

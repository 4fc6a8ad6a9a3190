// Static maps of a measured file: [[validation.map]].
#pragma once

#include "files/measured_table.hpp"
#include "wingbeat/study/validation.hpp"

namespace wingbeat::detail {

/// The maps of [validation], each a line `slope (x - zero)` at stated inputs; their quantities and points go to `set`.
MapsProblem read_maps(const TomlFields& plan, const MeasuredTable& table, Design<double> design, ValidationSet& set);

}  // namespace wingbeat::detail

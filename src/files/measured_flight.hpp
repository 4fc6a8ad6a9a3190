// Forward flight along a stated motion, of a measured file: [[validation.load]].
#pragma once

#include <string>

#include "files/measured_table.hpp"
#include "wingbeat/study/validation.hpp"

namespace wingbeat::detail {

/// A table of outlines, rows of radius and chord in that unit, from the root on; `hub_offset`: of the root from the
/// stroke axis [m].
Planform<double> outline_of(const TomlFields& root, const std::string& key, const std::string& unit, double hub_offset);

/// The motion of [validation], the outline of tables.chords, and the loads that are compared, each a row of the data
/// times a factor; quantities and points go to `set`.
PrescribedFlightProblem read_flight(const TomlFields& root, const TomlFields& plan, const MeasuredTable& table,
                                    ValidationSet& set);

}  // namespace wingbeat::detail

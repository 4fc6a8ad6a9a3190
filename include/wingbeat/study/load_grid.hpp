// The grid of a table of loads that covers a vehicle's motion, with the model's loads: what a rig or CFD has to
// measure.
#pragma once

#include <span>
#include <vector>

#include "wingbeat/parts/load_table.hpp"
#include "wingbeat/study/wing_motion.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

/// Rows as LoadTable takes them, over flapping velocities from 0 and, of wings on hinges, pitch angles and velocities
/// to either side, a fifth further than `motion` goes; the other half-stroke is the mirror image. `count` values of
/// each coordinate, of pitch velocities a third of them; at least 3. The inertia of the air is not in them. Throws
/// ParameterError for wings that twist or clap, that are in a wake or have such a table.
std::vector<LoadTable::Row> load_grid(const Vehicle<double>& vehicle, std::span<const WingInstant> motion, int count);

}  // namespace wingbeat

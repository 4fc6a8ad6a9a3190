// Instants of a recorded cycle for means over it, by Gauss's rule on each of the solver's steps: these end where
// something jumps, which rows at even distances in time do not.
#pragma once

#include <vector>

#include "wingbeat/cycle/record.hpp"

namespace wingbeat {

struct CycleInstant {
  WaveformRow row;  ///< its time is since the start of its step
  double weight;    ///< share of the period; they add up to 1
  double phase;     ///< crank angle, or phase of the supply [rad]
};

/// Five instants of each step. What impacts add to a mean at once is not in them.
std::vector<CycleInstant> cycle_instants(const CycleRecord& cycle);

}  // namespace wingbeat

// How solve_ensemble() meets a tolerance: the settings of its attempts, one after the other.
#pragma once

#include <array>
#include <vector>

#include "wingbeat/ensemble/direct_pack_blocks.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/ensemble/pack_blocks.hpp"

namespace wingbeat {

/// Up to such an electrical_lag() lanes take the current for one that lags, of which they leave out what is of higher
/// order. Segments are forty times as long.
double max_lag(double tolerance);

/// How a tolerance is met.
struct Plan {
  PackSettings first;
  std::array<PackSettings, 4> from_rest;  ///< more and more finely
  std::array<PackSettings, 3> again;
  std::vector<DirectPackSettings> direct;  ///< one after the other, until a design is exact enough
};

Plan plan_for(const EnsembleOptions& options);

}  // namespace wingbeat

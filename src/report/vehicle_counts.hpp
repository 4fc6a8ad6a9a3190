// How designs of a front's search divide among the motors of its catalogue.
#pragma once

#include <cstdint>
#include <vector>

#include "wingbeat/study/pareto.hpp"

namespace wingbeat {

struct VehicleCount {
  std::uint64_t solved = 0, flap = 0, feasible = 0, front = 0;
};
std::vector<VehicleCount> count_vehicles(const ParetoStudy& study, const ParetoResult& result);

}  // namespace wingbeat

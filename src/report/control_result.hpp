// The description of a static map, for every result that has them.
#pragma once

#include "report/described.hpp"
#include "wingbeat/study/allocation.hpp"

namespace wingbeat::described {

const Description<AllocationMap>& allocation_description();

}  // namespace wingbeat::described

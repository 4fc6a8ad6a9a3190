// What a sweep's --json has.
#pragma once

#include <string>

#include "wingbeat/run/sweep_run.hpp"

namespace wingbeat {

/// One JSON object: numbers of designs by status, and the best ones with their swept values [SI]. `output`: the data
/// set; `plot`: the figure, may be empty.
std::string json_sweep(const Study& study, const SweepResult& result, const std::string& output,
                       const std::string& plot);

}  // namespace wingbeat

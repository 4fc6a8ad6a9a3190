// How the reports of a fit name rows of its logs.
#pragma once

#include <cstddef>
#include <string>

#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat::detail {

/// "air.csv:12"
std::string row_name(const BenchFit& fit, std::size_t log, std::size_t row);

}  // namespace wingbeat::detail

// Which knowns - states and continuous inputs - a derivative or an output of an FMU depends on.
#pragma once

#include <vector>

#include "fmu/variables.hpp"

namespace wingbeat::fmu {

/// By value reference, in their order. Of variables that are neither derivative nor output: none.
std::vector<std::size_t> dependencies_of(const Design<double>& design, std::size_t reference);

}  // namespace wingbeat::fmu

// What scaling a vehicle changes, for people and for programs.
#pragma once

#include <string>

#include "wingbeat/study/scaling.hpp"

namespace wingbeat {

/// A table of the numbers that change, at most 90 columns.
std::string text_scaling(const ScaledDesign& scaled, double factor);

/// One JSON object, SI: the factor, and each number before and after.
std::string json_scaling(const ScaledDesign& scaled, double factor);

}  // namespace wingbeat

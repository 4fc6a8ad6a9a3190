#pragma once

#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/study/optimise.hpp"

namespace wingbeat {

/// A parameter for an optimisation to choose within bounds, in the unit of its key.
inline OptimisedParameter between(const char* key, double lower, double upper) {
  return {design_parameter(key), lower, upper, false};
}

}  // namespace wingbeat

// Parameters of a vehicle file for studies that vary and differentiate them.
#pragma once

#include <string_view>

#include "wingbeat/cycle/metric_gradients.hpp"

namespace wingbeat {

/// The numeric key of that path. Throws ParameterError for an unknown key and for one that is not a number.
DesignParameter design_parameter(std::string_view path);

}  // namespace wingbeat

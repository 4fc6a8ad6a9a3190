// modelDescription.xml of a vehicle's FMU.
#pragma once

#include <string>

#include "wingbeat/fmu/fmu.hpp"

namespace wingbeat::fmu {

/// The whole file. `token` is that of the resource.
std::string model_description(const Design<double>& design, const std::string& token, const FmuOptions& options);

}  // namespace wingbeat::fmu

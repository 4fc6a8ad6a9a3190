// design_with() of values that are no texts.
#pragma once

#include <span>

#include "files/toml_document.hpp"

namespace wingbeat {

/// As design_with() of wingbeat.hpp. The origins of the settings are not reported.
Design<double> design_with(std::span<const Setting> settings, const Design<double>* base);

}  // namespace wingbeat

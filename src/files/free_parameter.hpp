// Parameters that a file lets free, within bounds.
#pragma once

#include <string>

#include "files/toml_fields.hpp"
#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat::detail {

/// The number of the vehicle file that `key` names, with the bounds that stand beside it as lower and upper. Throws
/// InputError with the place.
FreeParameter bounded_parameter(const TomlFields& fields, const std::string& key);

}  // namespace wingbeat::detail

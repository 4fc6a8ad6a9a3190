// The schema of what sweep prints with --json.
#pragma once

#include <nlohmann/json.hpp>

namespace wingbeat::described {

nlohmann::ordered_json sweep_schema();

}  // namespace wingbeat::described

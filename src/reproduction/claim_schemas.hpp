// The schemas of what compare and reproduce print with --json.
#pragma once

#include <nlohmann/json.hpp>

namespace wingbeat::described {

nlohmann::ordered_json comparison_schema();
nlohmann::ordered_json claims_schema();

}  // namespace wingbeat::described

// JSON Schema of what the commands print with --json.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wingbeat {

/// The commands whose --json has a schema, in the order of the program's help.
const std::vector<std::string_view>& schema_commands();

/// The JSON Schema (draft 2020-12) of the object that `wingbeat COMMAND --json` prints, from the descriptions of
/// results that it is written by; empty for a command without one. Every key is listed, and no other is allowed.
std::string json_schema(std::string_view command);

}  // namespace wingbeat

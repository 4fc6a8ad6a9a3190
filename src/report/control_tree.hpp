// Models for control as a tree: --json prints it, and the TOML file has the same keys.
#pragma once

#include <string>

#include "report/report_tools.hpp"
#include "wingbeat/study/control_models.hpp"

namespace wingbeat::detail {

Json control_tree(const ControlModels& models, const std::string& version);

/// A static map as a table.
std::string map_text(const AllocationMap& map);

}  // namespace wingbeat::detail

// Vehicles that once went wrong: tests/cases.
#pragma once

#include <string>

#include "wingbeat/files/design_file.hpp"

namespace wingbeat {

/// The one of that name, without ".toml".
inline Design<double> case_design(const std::string& name) {
  return read_design(std::string(WINGBEAT_CASES) + "/" + name + ".toml");
}

}  // namespace wingbeat

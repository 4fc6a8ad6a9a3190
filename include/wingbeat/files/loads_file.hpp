// Loads over the cycle that another program has written: CSV with a header that names each column with its unit. For
// the columns see docs/cfd.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "wingbeat/study/load_comparison.hpp"

namespace wingbeat {

/// What a file was understood as.
struct LoadsNotes {
  struct Column {
    std::string header, name;  ///< as written; of the program, empty where it is not read
  };
  std::vector<Column> columns;
};

/// Rows in any order, of one cycle or several; a cell without a value leaves its quantity out of its row. Throws
/// InputError with file, line, column and what was expected.
SimulatedLoads read_loads(const std::filesystem::path& file, LoadsNotes* notes = nullptr);
SimulatedLoads parse_loads(std::string_view text, const std::string& file_name, LoadsNotes* notes = nullptr);

}  // namespace wingbeat

// Designs of a sweep from a CSV: a header of keys with units, "transmission.crank_radius [mm]", and a line for each.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "wingbeat/study/sweep.hpp"

namespace wingbeat::detail {

/// The text of such a file, which may be larger than a vehicle file. Throws InputError.
std::string read_design_table_file(const std::filesystem::path& file);

/// Adds the columns to the axis as quantities with their values; returns the line of each design. `quantity_named`
/// gives what is varied under a key. Throws InputError, naming `file`.
std::vector<int> parse_design_table(std::string_view text, const std::string& file, SweepAxis& axis,
                                    const std::function<SweptQuantity(const std::string& key)>& quantity_named);

}  // namespace wingbeat::detail

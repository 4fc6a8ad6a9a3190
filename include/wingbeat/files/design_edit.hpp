// A vehicle file written back: the user's text with other values in it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "wingbeat/files/design_file.hpp"

namespace wingbeat {

/// The text of the vehicle file `original`, changed where the design differs from what it says, and there alone:
/// comments, order, alternatives and the units of its values stay, every other line byte for byte. New keys come at the
/// end of their section, keys without a place any more become comments. Names of table files are adapted to `output`,
/// where the text will stand. It reads back as `design` to within the rounding of units (relative 1e-15); where that
/// cannot be reached, and where `original` cannot be read, it is write_design().
std::string edited_design(const std::filesystem::path& original, const std::filesystem::path& output,
                          const Design<double>& design);

/// A vehicle file given as text with the values of `design`; without `tables` nothing is read and names of table files
/// stay.
std::string edited_design(std::string_view original, const Design<double>& design, const TableLoader& tables = {});

}  // namespace wingbeat

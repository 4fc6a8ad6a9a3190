// Measured files: data of vehicles that others made, with source, licence and uncertainty, and what of them the program
// computes. For the keys see docs/validation.md.
#pragma once

#include <filesystem>

#include "wingbeat/study/validation.hpp"

namespace wingbeat {

/// The set in a measured file; the vehicle file that it names is sought beside it or among those that come with the
/// program. Throws InputError with file, line, key and reason.
ValidationSet read_measured(const std::filesystem::path& file);

}  // namespace wingbeat

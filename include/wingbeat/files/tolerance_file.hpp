// Tolerance studies: TOML in, a checked study out. See docs/tolerance.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/study/tolerance.hpp"

namespace wingbeat {

/// The study in a TOML file; the vehicle file and a fit's covariance that it names are sought beside it. Throws
/// InputError.
ToleranceStudy read_tolerance_study(const std::filesystem::path& file, std::span<const std::string> overrides = {});

}  // namespace wingbeat

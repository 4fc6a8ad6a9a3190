// The optimum of one objective as a data set.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/files/optimise_file.hpp"

namespace wingbeat {

/// Outcome and optimum of every trial, and of the best one its searches, constraints and walks, as NetCDF-4. `input` is
/// the text of the study file. Throws NetcdfError.
void write_optimum(const OptimiseFile& file, std::span<const MotorTrial> trials, const std::string& input,
                   const std::string& version, const std::filesystem::path& output);

}  // namespace wingbeat

// The data set of a tolerance study.
#pragma once

#include <filesystem>
#include <string>

#include "wingbeat/study/tolerance.hpp"

namespace wingbeat {

/// The samples with their parameters, status and metrics, and the indices, as NetCDF-4. `input` is the text of the
/// study file. Throws NetcdfError.
void write_tolerance(const ToleranceStudy& study, const ToleranceResult& result, const SweepColumns& columns,
                     const std::string& input, const std::string& version, const std::filesystem::path& file);

}  // namespace wingbeat

// The optimum of one objective as a data set and as a figure.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/io/optimise_file.hpp"
#include "wingbeat/io/plot.hpp"

namespace wingbeat {

/// Outcome and optimum of every trial, and of the best one its searches, constraints and walks, as NetCDF-4. `input` is
/// the text of the study file. Throws NetcdfError.
void write_optimum(const OptimiseFile& file, std::span<const MotorTrial> trials, const std::string& input,
                   const std::string& version, const std::filesystem::path& output);

/// Where the searches ended, what each parameter's bounds leave, and the walks along the free directions. `trial` has
/// found an optimum. Throws std::runtime_error where gnuplot is missing or fails.
void plot_optimum(const OptimiseFile& file, const MotorTrial& trial, PlotFormat format,
                  const std::filesystem::path& output);

}  // namespace wingbeat

// Tolerance studies: TOML in, a checked study out; reports, data set and figure of its result. See docs/tolerance.md.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/io/plot.hpp"
#include "wingbeat/study/tolerance.hpp"

namespace wingbeat {

/// The study in a TOML file; the vehicle file and a fit's covariance that it names are sought beside it. Throws
/// InputError.
ToleranceStudy read_tolerance_study(const std::filesystem::path& file, std::span<const std::string> overrides = {});

/// A readable report of at most 100 columns.
std::string text_tolerance(const ToleranceStudy& study, const ToleranceResult& result);

/// One JSON object: probabilities, and for each output its distribution, linear prediction and Sobol indices.
std::string json_tolerance(const ToleranceStudy& study, const ToleranceResult& result);

/// The samples with their parameters, status and metrics, and the indices, as NetCDF-4. `input` is the text of the
/// study file. Throws NetcdfError.
void write_tolerance(const ToleranceStudy& study, const ToleranceResult& result, const SweepColumns& columns,
                     const std::string& input, const std::string& version, const std::filesystem::path& file);

/// The output that a figure shows unless another is asked for: lift to weight where the mass is known, else mean lift,
/// else the first one that varies; null where nothing varies.
const ToleranceOutput* main_output(const ToleranceResult& result);

/// The distribution of a metric with the linear prediction, and what it comes from, factor by factor. Throws like
/// plot_cycle.
void plot_tolerance(const ToleranceStudy& study, const SweepColumns& columns,
                    const ToleranceOutput& output, PlotFormat format, const std::filesystem::path& file);

}  // namespace wingbeat

// The front of several objectives for people, programs and other tools.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/report/plot.hpp"

namespace wingbeat {

/// The picked designs by name, with their places in the front: "end-lift_mean_n" for the best by each objective,
/// "knee", "even-1" and so on.
std::vector<std::pair<std::string, std::size_t>> named_picks(const ParetoStudy& study, const ParetoResult& result);

/// Their names, where `even` designs are picked along the front.
std::vector<std::string> pick_names(std::span<const ParetoObjective> objectives, std::size_t even);

/// Readable report with a table of the picked designs.
std::string text_front(const OptimiseFile& file, const ParetoStudy& study, const ParetoResult& result);

/// One JSON object with every design of the front.
std::string json_front(const OptimiseFile& file, const ParetoStudy& study, const ParetoResult& result);

/// Front and every design solved as NetCDF-4. `input` is the text of the study file. Throws NetcdfError.
void write_front(const ParetoStudy& study, const ParetoResult& result, const std::string& title,
                 const std::string& input, const std::string& version, const std::filesystem::path& file);

/// The front over the feasible designs; of three objectives its projections. `result` has a front. Throws
/// std::runtime_error where gnuplot is missing or fails.
void plot_front(const ParetoStudy& study, const ParetoResult& result, const std::string& title, PlotFormat format,
                const std::filesystem::path& file);

}  // namespace wingbeat

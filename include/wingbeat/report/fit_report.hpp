// Fits as text, JSON, files and a plot of residuals.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/report/plot.hpp"
#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat {

/// What the data tell, a sentence for each finding.
std::vector<std::string> describe(std::span<const FitFinding> findings);
/// Why the model does not describe the data, a clause with the numbers.
std::string describe(const Misfit& misfit);
/// A clause; empty where the data determine the parameter.
std::string describe(Undetermined why);

/// Without a robust loss, of one value that is far off where all others are not: a sentence, or nothing.
std::string outlier_advice(const BenchFit& fit, const FitResult& result);

std::string text_fit(const BenchFit& fit, const FitResult& result);
std::string text_friction(std::span<const FrictionCandidate> candidates);
/// One JSON object; `candidates` may be empty.
std::string json_fit(const BenchFit& fit, const FitResult& result, std::span<const FrictionCandidate> candidates);

/// What a fitted vehicle rests on, as the comments above its file.
std::string fitted_vehicle_head(const BenchFit& fit, const FitResult& result, const std::string& made_by);

/// The determined parameters with their covariance, as TOML: what a tolerance study starts from.
std::string covariance_file(const FitResult& result, const std::string& vehicle_name, const std::string& made_by);

/// Residuals in standard deviations against what was set, one panel per condition. Throws like plot_cycle.
void plot_residuals(const BenchFit& fit, const FitResult& result, PlotFormat format, const std::filesystem::path& file);

/// Measured points over the computed cycle of each waveform, 12 panels at most. Throws like plot_cycle.
void plot_fitted_cycles(const BenchFit& fit, const FitResult& result, PlotFormat format,
                        const std::filesystem::path& file);

}  // namespace wingbeat

// Measured sets beside the model's numbers, as text, JSON and figures of the differences.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/report/plot.hpp"
#include "wingbeat/study/validation.hpp"

namespace wingbeat {

/// What there is, and by what it is predicted: a line or two for each set.
std::string text_validation_list(std::span<const ValidationSet> sets);

/// A set, every stage and every row, at most 90 columns.
std::string text_validation(const ValidationSet& set, const ValidationResult& result);

/// How far the model is off on the rows that no fit saw, a line for each quantity of each set.
std::string text_validation_summary(std::span<const ValidationSet> sets, std::span<const ValidationResult> results);

/// One JSON object with the list of sets; `results` is empty where nothing was computed, else of the same length.
std::string json_validation(std::span<const ValidationSet> sets, std::span<const ValidationResult> results);

/// Differences of the first quantity, in shares of the measured numbers where these have a size, over what was set, a
/// panel for each stage but those that only scale another. Throws like plot_cycle, and std::runtime_error where the set
/// has no prediction.
void plot_validation(const ValidationSet& set, const ValidationResult& result, PlotFormat format,
                     const std::filesystem::path& file);

}  // namespace wingbeat

// Plots of a sweep: lines over one axis of numbers, filled contours over two.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/files/study_file.hpp"
#include "wingbeat/report/plot.hpp"

namespace wingbeat {

/// The metrics that are drawn, one panel each: those of that name, or, of none, mean lift and system efficiency as far
/// as they are kept. Throws InputError, naming `option`, for a metric that the study does not keep and where the sweep
/// has no plot: samples, no axis or more than two axes of numbers, too many curves or designs.
std::vector<Metric> metrics_to_plot(const Study& study, std::span<const std::string> names, const std::string& option);

/// Draws a data set of the study. With one axis of numbers a curve for each combination of choices (and of the values
/// of an axis of three numbers at most beside one of ten or more), broken where the vehicle does not flap; with two,
/// contours with the feasible region outlined: flapping, and carrying its own weight where lift_to_weight is kept and
/// known. The best design is marked. Throws like plot_cycle.
void plot_sweep(const Study& study, const std::filesystem::path& data_set, std::span<const Metric> metrics,
                PlotFormat format, const std::filesystem::path& file);

}  // namespace wingbeat

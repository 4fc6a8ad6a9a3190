// Optima as text, JSON and a plot.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/report/plot.hpp"

namespace wingbeat {

/// "lift_to_weight >= 1: 9 of 10 that flap break it, the best of them reaches 0.9", for a report without a design.
std::string explanation(const std::string& reason, bool nothing_flaps, std::span<const MetricConstraint> constraints,
                        const ScreenCounts& screen);

/// Readable report of one result; of a catalogue, the table of motors and the best one's result.
std::string text_optimum(const OptimiseFile& file, const OptimiseResult& result);
std::string text_motors(const OptimiseFile& file, std::span<const MotorTrial> trials);

/// One JSON object of a result, or of all motors with the best one first.
std::string json_optimum(const OptimiseFile& file, const OptimiseResult& result);
std::string json_motors(const OptimiseFile& file, std::span<const MotorTrial> trials);

/// Where the searches ended, what each parameter's bounds leave, and the walks along the free directions. `trial` has
/// found an optimum. Throws std::runtime_error where gnuplot is missing or fails.
void plot_optimum(const OptimiseFile& file, const MotorTrial& trial, PlotFormat format,
                  const std::filesystem::path& output);

}  // namespace wingbeat

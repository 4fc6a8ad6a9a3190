// Optima as text, JSON and a plot.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "wingbeat/files/optimise_file.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/study/drive_train.hpp"

namespace wingbeat {

/// What a search without a result has seen.
struct NothingFound {
  bool flaps = false;          ///< some designs do
  std::uint64_t screened = 0;  ///< designs within the bounds; 0 where nothing varies
  bool allow_extrapolation = false;
  std::span<const MetricConstraint> constraints;  ///< of the study, which must outlive this
  const ScreenCounts& screen;                     ///< of the result, which must outlive this
};
NothingFound nothing_found(const OptimiseStudy& study, const OptimiseResult& result);
NothingFound nothing_found(const ParetoStudy& study, const ParetoResult& result);
/// "designs flap, but none within every constraint was found; lift_to_weight >= 1: 9 of 10 that flap break it, the best
/// of them reaches 0.9"
std::string describe(const NothingFound& nothing);

/// Readable report of one result; of a catalogue, the table of motors and the best one's result.
std::string text_optimum(const OptimiseFile& file, const OptimiseResult& result);
std::string text_motors(const OptimiseFile& file, std::span<const MotorTrial> trials);
/// What the screening of a drive train's combinations found, the searches from the most promising ones, and the best.
std::string text_drive_trains(const OptimiseFile& file, const DriveTrainScreen& screen,
                              std::span<const MotorTrial> trials);

/// One JSON object of a result, or of all motors with the best one first.
std::string json_optimum(const OptimiseFile& file, const OptimiseResult& result);
std::string json_motors(const OptimiseFile& file, std::span<const MotorTrial> trials);
std::string json_drive_trains(const OptimiseFile& file, const DriveTrainScreen& screen,
                              std::span<const MotorTrial> trials);

/// Where the searches ended, what each parameter's bounds leave, and the walks along the free directions. `trial` has
/// found an optimum. Throws std::runtime_error where gnuplot is missing or fails.
void plot_optimum(const OptimiseFile& file, const MotorTrial& trial, PlotFormat format,
                  const std::filesystem::path& output);

}  // namespace wingbeat

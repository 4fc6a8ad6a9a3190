// What is printed of the motion that other programs are given, and of their loads beside the model's.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/files/kinematics_file.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/study/load_comparison.hpp"

namespace wingbeat {

/// A motion as it was written.
struct WrittenKinematics {
  KinematicsFormat format = KinematicsFormat::csv;
  double frequency = 0.0;                     ///< [Hz]
  double stroke_min = 0.0, stroke_max = 0.0;  ///< [rad]
  double pitch_min = 0.0, pitch_max = 0.0;    ///< [rad]
  bool twists = false;
  int rows = 0;                              ///< of a CSV file
  std::optional<AngleSeries> stroke, pitch;  ///< of a file with series
};
std::string text_kinematics(const WrittenKinematics& written);
std::string json_kinematics(const WrittenKinematics& written);

/// A comparison and where it came from.
struct LoadReport {
  LoadComparison comparison;
  std::string loads_file;
  std::vector<std::string> not_read;  ///< headers of columns
};

/// What the numbers of a quantity mean, in two or three sentences.
std::string describe(LoadQuantity quantity, const LoadDisagreement& disagreement);
/// A table of the quantities, sentences below it.
std::string text_loads(const LoadReport& report);
std::string json_loads(const LoadReport& report);

/// A panel for each quantity over the cycle: simulated, of the model, and the means of both. Throws like plot_cycle.
void plot_loads(const LoadReport& report, const std::string& title, PlotFormat format,
                const std::filesystem::path& file);

}  // namespace wingbeat

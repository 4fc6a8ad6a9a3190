// Axes and metrics of a sweep as its plots show them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/files/study_file.hpp"
#include "wingbeat/report/plot.hpp"
#include "wingbeat/study/sweep_best.hpp"

namespace wingbeat {

inline constexpr std::uint64_t max_curves = 6;

bool is_number(const SweepAxis& axis);
/// True of an axis that a plot shows by a curve for each of its values: choices, and so few numbers beside an axis of
/// many that contours between them would say nothing.
bool makes_curves(const Sweep& sweep, const SweepAxis& axis);
/// A parameter in words: "crank radius", "supply voltage"; with its section where the last word alone says too little.
std::string words(const std::string& key);

/// A unit for the eye and what SI values are multiplied by.
struct Display {
  std::string unit;
  double factor = 1.0;
  std::string in_brackets() const;
};

/// For values of that unit up to `largest` [SI]; an efficiency is shown in per cent.
Display display_for(std::string_view unit, double largest, bool efficiency = false);
Display display_of(Metric metric, double largest);

/// One axis of numbers as it is drawn.
struct Scale {
  std::string name;
  Display display;
  bool logarithmic = false;
  std::vector<double> values;  ///< in the displayed unit

  explicit Scale(const SweepAxis& axis);
  std::string label() const { return name + display.in_brackets(); }
  /// gnuplot's commands for the range and the marks of `which` axis, "x" or "y".
  std::string range(const char* which) const;
  /// "5 mm"
  std::string value(std::size_t n) const;
};

std::string title_of(const Study& study);

/// A metric's values with the display that suits them.
struct Field {
  Metric metric;
  std::vector<double> values;  ///< in the displayed unit
  Display display;

  Field(const NetcdfReader& file, Metric m);
  std::string label() const;
  std::string shown(double value) const;
  /// "best", "highest" or "lowest"
  const char* superlative() const;
  bool lower_is_better() const;  ///< of what costs: powers, currents, forces, heat
};

/// What designs do that have no metrics: "does not flap".
const char* without_numbers(const Sweep& sweep);

/// What a read-out says of a design beside its numbers: that it does not flap, or the limits of the domain it exceeds.
std::string design_note(int status, unsigned domain);

/// Of every design; empty where the study does not keep it, or holds it.
std::vector<double> lift_over_weight(const Sweep& sweep, const NetcdfReader& file);

/// The largest value, or the lowest where that is better.
SweepBest best_of(const Field& field, const std::vector<double>& weight, const std::vector<double>& domain,
                  bool extrapolates);

/// The metrics against one axis of numbers, a curve for each choice.
void plot_lines(const Study& study, const NetcdfReader& file, std::span<const Metric> metrics, PlotFormat format,
                const std::filesystem::path& output);
/// One axis of numbers where nothing flaps: the status of each design.
void plot_idle_lines(const Study& study, const std::vector<double>& status, PlotFormat format,
                     const std::filesystem::path& output);
/// The metrics as contours over two axes of numbers.
void plot_contours(const Study& study, const NetcdfReader& file, std::span<const Metric> metrics, PlotFormat format,
                   const std::filesystem::path& output);

}  // namespace wingbeat

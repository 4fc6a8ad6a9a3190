// Plots through gnuplot, sized for one column of a paper or for both, as SVG, PDF or PNG.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/cycle/waveform_row.hpp"
#include "wingbeat/vehicle/design.hpp"

namespace wingbeat {

/// Widths of a printed figure [in]: one column of a journal, and both.
inline constexpr double single_column_width = 89.0 / 25.4, double_column_width = 183.0 / 25.4;

/// What a figure is written as, and how wide it is printed.
struct PlotFormat {
  enum Kind { svg, pdf, png, html };
  Kind kind = svg;
  double width = single_column_width;  ///< [in]

  constexpr PlotFormat(Kind written_as, double printed_width = single_column_width)
      : kind(written_as), width(printed_width) {}
  friend constexpr bool operator==(const PlotFormat& format, Kind kind) { return format.kind == kind; }
};

/// As OutputRules expects them.
inline constexpr const char* plot_extensions = ".svg .pdf .png";
/// Of sweeps and fronts also a page that shows the numbers of the design under the pointer.
inline constexpr const char* page_extensions = ".svg .pdf .png .html";

/// Throws std::runtime_error where gnuplot, which draws all figures, is not installed: to be called before computing.
void require_gnuplot();

/// By the extension; empty for any other.
std::optional<PlotFormat> plot_format(const std::filesystem::path& file);

/// One flapping cycle against time: stroke angle and flapping velocity, lift, the force in rod or coupler, powers;
/// above them the mechanism that the design has. Throws std::runtime_error, with what to do, where gnuplot is missing
/// or fails.
void plot_cycle(std::span<const WaveformRow> rows, const Design<double>& design, const std::string& title,
                PlotFormat format, const std::filesystem::path& file);

/// The mechanism that the design has, alone, as it stands above a plotted cycle. `stroke_amplitude` [rad] is that of a
/// direct drive; cranks have their own. The content of a file; throws like plot_cycle.
std::string drawn_mechanism(const Design<double>& design, double stroke_amplitude, PlotFormat format);

/// Of links alone, which validate() takes: a slider-crank, a four-bar or a stroke table.
std::string drawn_mechanism(const TransmissionDesign<double>& transmission, PlotFormat format);

/// One case of a power breakdown.
struct PowerBar {
  std::string label;
  EnergyAudit audit;
};

/// Where the electrical input goes, one stacked bar per case. Throws like plot_cycle.
void plot_powers(std::span<const PowerBar> bars, const std::string& title, PlotFormat format,
                 const std::filesystem::path& file);

}  // namespace wingbeat

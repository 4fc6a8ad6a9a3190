// The look of every figure: sizes at which it is printed, colours with one meaning each, strokes.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "wingbeat/cycle/waveform_row.hpp"

namespace wingbeat::style {

/// Widths of a printed figure [in]: 89 mm and 183 mm.
inline constexpr double single_column = 3.504, double_column = 7.205;
/// Sizes of text [pt].
inline constexpr double text_size = 7.0, heading_size = 7.5, title_size = 8.0;
/// Widths of lines in gnuplot's unit, which the terminals scale to 0.9 pt: 1 pt, 0.5 pt.
inline constexpr double curve_width = 1.1, thin_width = 0.6;

// Colours of Okabe and Ito, safe with any colour vision. Each has one meaning in every figure.
inline constexpr const char* with_springs = "#0072b2";
inline constexpr const char* without_springs = "#d55e00";
// Where power goes; black is the electrical input or a quantity that stands alone.
inline constexpr const char* copper = "#e69f00";
inline constexpr const char* viscous = "#f0e442";
inline constexpr const char* motor_friction = "#882255";  // of P. Tol's muted scheme
inline constexpr const char* gearbox = "#009e73";
inline constexpr const char* hinges = "#8c6d46";
inline constexpr const char* electronics = "#5f6b7a";
inline constexpr const char* friction = "#cc79a7";
inline constexpr const char* residual = "#bbbbbb";
inline constexpr const char* aerodynamic = "#56b4e9";
inline constexpr const char* ink = "#000000";
inline constexpr const char* grey = "#707070";
inline constexpr const char* outside_domain = "#a0a0a0";
// Surroundings of the vehicle, in colours of P. Tol's muted scheme.
inline constexpr const char* in_air = "#000000";
inline constexpr const char* in_vacuum = "#44aa99";
inline constexpr const char* without_wings = "#999933";
/// An ordered quantity, small to large: growing darkness.
inline constexpr const char* ordered[] = {"#b79fd0", "#8d68b5", "#653a92", "#35125e"};

// Dashes, as gnuplot writes them. Between the formulations the dash decides, never the colour.
inline constexpr const char* solid = "1";
inline constexpr const char* dashed = "(8,4)";
inline constexpr const char* dotted = "(2,3)";
inline constexpr const char* dash_dotted = "(10,3,2,3)";

// Curves that have no meaning of their own, distinguished by grey and dash.
inline constexpr const char* first_curve = "dt 1 lw 1.1 lc rgb '#000000'";
inline constexpr const char* second_curve = "dt (8,4) lw 1.1 lc rgb '#707070'";
inline constexpr const char* third_curve = "dt (2,3) lw 1.1 lc rgb '#000000'";
/// A value to compare with: weight, hover, a mean.
inline constexpr const char* reference_line = "dt (10,3,2,3) lw 0.8 lc rgb '#707070'";

/// "dt 1 lw 1.1 lc rgb '#000000'"
std::string stroke(const char* colour, const char* dash = solid, double width = curve_width);

/// Where a row of a cycle stands in a figure, in periods since stroke reversal (the least stroke angle), from -1/8 to
/// 7/8: neither strokes nor velocities have a peak at the edge then.
struct Phase {
  std::size_t row;
  double periods;
};
std::vector<Phase> phases(std::span<const WaveformRow> rows);

/// An SVG that gnuplot wrote, tidied: its commands do not stay as tooltips, what it defines and does not use goes. A
/// plot titled "curve|..." becomes a group with that text as its attribute data-curve.
std::string tidied_svg(std::string text);

}  // namespace wingbeat::style

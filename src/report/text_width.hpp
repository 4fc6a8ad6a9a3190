// How wide a text is printed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace wingbeat {

/// Width of a text on a page [in], `size` its size [pt], in DejaVu Sans: what gnuplot and Linux browsers take for
/// "sans-serif", and wider than Arial, Helvetica or Liberation Sans. Characters outside its table count as an em.
double text_width(std::string_view utf8, double size);

/// The text in lines no wider than `room` [in], broken at blanks; a word wider than that is broken anywhere.
std::vector<std::string> broken_lines(std::string_view utf8, double size, double room);

/// `size`, or the smaller one at which the text is no wider than `room` [in].
double fitting_size(std::string_view utf8, double size, double room);

/// Height of an ascender and depth of a descender of DejaVu Sans, in parts of the size.
inline constexpr double ascent_share = 1556.0 / 2048.0, descent_share = 426.0 / 2048.0;
/// From one baseline to the next, in parts of the size.
inline constexpr double line_pitch = 1.25;
inline constexpr double points_per_inch = 72.0;

}  // namespace wingbeat

// Where texts, keys and panels of a figure stand: sizes in inches, places from the upper left corner of the page.
#pragma once

#include <string>
#include <vector>

#include "report/figure.hpp"

namespace wingbeat {

/// Margin of a page [in].
inline constexpr double page_margin = 0.05;
/// From one line of a key to the next [in].
inline constexpr double key_pitch = 0.15;

/// A text in one line, smaller where it would be wider than `room` [in]; `x`, `y` of its anchor, `y` its middle.
void fitted_text(Figure& figure, const std::string& text, double size, double room, double x, double y,
                 const char* anchor);
/// A title at the top of a page, its middle `y` below the edge [in].
void page_title(Figure& figure, const std::string& text, double y);
/// The name of a vertical axis `room` [in] long, centred on it; x, y as fractions of the page.
void axis_title(Figure& figure, const std::string& text, double size, double room, double x, double y);

/// Remarks that "; " separates, in as few lines as hold them.
std::vector<std::string> remark_lines(const std::string& all, double page_width);
/// Height of the lines at the foot of a page [in].
double remarks_height(const std::vector<std::string>& lines);
void draw_remarks(Figure& figure, const std::vector<std::string>& lines);

/// 1, 2, 2.5, 5 or 10 times a power of ten, at least `rough`: a distance of tics.
double round_step(double rough);

/// One entry of a key: a sample of a line, a point or a filled box, as gnuplot writes them, and a name.
struct KeyEntry {
  std::string name, line, point, fill;
};
inline KeyEntry line_key(std::string name, std::string line) { return {std::move(name), std::move(line), {}, {}}; }
inline KeyEntry point_key(std::string name, std::string point) { return {std::move(name), {}, std::move(point), {}}; }
inline KeyEntry fill_key(std::string name, std::string fill) { return {std::move(name), {}, {}, std::move(fill)}; }

/// The entries beside each other as far as `room` [in] goes: in one line each as wide as its name, in several lines in
/// columns.
class Key {
 public:
  Key() = default;
  Key(std::vector<KeyEntry> entries, double room);
  double height() const;  ///< [in]
  /// From a point of the page [in].
  void draw(Figure& figure, double left, double top) const;

 private:
  struct Place {
    double x;
    std::size_t line;
  };
  std::vector<KeyEntry> entries_;
  std::vector<Place> places_;
  std::size_t lines_ = 0;
  double size_ = style::text_size;
};

/// Numbers at which an axis is marked, as far apart as their labels need.
struct AxisMarks {
  double low = 0.0, high = 1.0;  ///< the axis, whose ends `rounded` takes to marks
  std::vector<double> positions;
  std::vector<std::string> labels;

  /// Of an axis `length` [in] long. `upright` is true of vertical axes.
  AxisMarks(double low, double high, double length, bool upright, bool rounded);
  double widest() const;  ///< of the labels [in]
  /// gnuplot's commands for range and marks of `axis`: "x", "y" or "y2"; without labels where `labelled` is false.
  std::string commands(const char* axis, bool labelled = true) const;
};

}  // namespace wingbeat

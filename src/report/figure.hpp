// What the plots share: a gnuplot script under way, and gnuplot itself.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <string>
#include <utility>

#include "report/style.hpp"
#include "wingbeat/report/plot.hpp"

namespace wingbeat {

/// What gnuplot draws by a script, complete. The script goes in, and the drawing comes out, through pipes: no name and
/// no label ever passes a shell or gnuplot's own parser of file names, and no disk can cut it off. gnuplot sees nothing
/// of the user's own settings. Throws std::runtime_error.
std::string drawing_of(const std::string& script);
/// Draws by a script of gnuplot into a file.
void run_gnuplot(const std::string& script, const std::filesystem::path& output);

/// A string for gnuplot: nothing in it is special but the quote.
std::string quoted(const std::string& text);

/// A gnuplot script under way. Sizes are those of the printed figure, text in points; everything is placed by its
/// anchor on the page, because terminals disagree about the width of text. Its room is that of report/text_width.hpp.
class Figure {
 public:
  /// As wide as the format says; `height` [in].
  Figure(PlotFormat format, double height) : Figure(format, format.width, height) {}
  Figure(PlotFormat format, double width, double height) : width_(width), height_(height) {
    switch (format.kind) {
      case PlotFormat::svg:
      case PlotFormat::html:
        // A browser shows it twice as large as it prints, and may scale it freely.
        points_ = 192.0 / 72.0;
        add("set terminal svg enhanced size {:.0f},{:.0f} dynamic butt font 'sans-serif,{}' lw 2.4 dl 0.6 "
            "background '#ffffff'\n",
            192.0 * width, 192.0 * height, 7.5 * points_);
        break;
      case PlotFormat::pdf:
        points_ = 0.75;
        add("set terminal pdfcairo enhanced size {:.3f}in,{:.3f}in butt font 'Sans,{}' fontscale 1 lw 1.8 dl 1.1\n",
            width, height, 7.5 * points_);
        break;
      case PlotFormat::png:
        points_ = 300.0 / 96.0;
        add("set terminal pngcairo enhanced size {:.0f},{:.0f} butt font 'Sans,{}' lw 3.75 dl 1.2\n", 300.0 * width,
            300.0 * height, 7.5 * points_);
        break;
    }
    add("set encoding utf8\n"
        "set minussign\n"
        "set border 3 lw 0.6 lc rgb '#404040'\n"
        "set tics nomirror out scale 0.5 noenhanced\n"
        "unset key\n");
  }

  template <class... Args>
  void add(fmt::format_string<Args...> pattern, Args&&... args) {
    fmt::format_to(std::back_inserter(script_), pattern, std::forward<Args>(args)...);
  }
  /// `placement`: position, anchor and further options of a gnuplot label.
  void text(const std::string& content, double size, const std::string& placement) {
    add("set label {} {} at {} front noenhanced font ',{}'\n", ++labels_, quoted(content), placement, size * points_);
  }
  /// A text with gnuplot's marks for italics and subscripts: "{/:Italic r}_c". Not for a user's words.
  void symbols(const std::string& content, double size, const std::string& placement) {
    add("set label {} {} at {} front enhanced font ',{}'\n", ++labels_, quoted(content), placement, size * points_);
  }
  double width() const { return width_; }
  double height() const { return height_; }
  /// A point of the page, `x` and `y` from its upper left corner [in], as gnuplot writes it.
  std::string at(double x, double y) const {
    return fmt::format("screen {:.6g},screen {:.6g}", x / width_, 1.0 - y / height_);
  }

  /// A line between two points of the page.
  void sample(const std::string& from, const std::string& to, const std::string& line) {
    add("set arrow {} from {} to {} nohead front {}\n", ++arrows_, from, to, line);
    // gnuplot's SVG joins strokes of one width and colour and forgets that their dashes differ: this one parts them.
    add("set arrow {} from {} to {} nohead front dt 1 lw 0.01 lc rgb '#fefefe'\n", ++arrows_, from, from);
  }
  /// A sample of a line with its name, starting at (x, y) of the page, which is a single column wide.
  void key_entry(double x, double y, const std::string& line, const std::string& name) {
    sample(fmt::format("screen {},{}", x, y), fmt::format("screen {},{}", x + 0.057, y), line);
    text(name, style::text_size, fmt::format("screen {},{} left", x + 0.065, y));
  }
  /// A mark without text; `point` as gnuplot writes it: "pt 7 ps 0.5".
  void mark(const std::string& place, const std::string& point) {
    add("set label {} '' at {} point {} front\n", ++labels_, place, point);
  }
  void box(const std::string& from_to, const char* fill) {
    add("set object {} rectangle {} front fillcolor rgb '{}' fillstyle solid border lc rgb '#202020' lw 0.4\n",
        ++objects_, from_to, fill);
  }
  /// A circle around a point of the plot, as large in every format; `fill` as gnuplot writes it.
  void circle(double x, double y, double radius, const char* fill, const char* colour) {
    add("set object {} circle at {},{} size screen {} front noclip {} border lc rgb '{}' lw 0.9\n", ++objects_, x, y,
        radius * single_column_width / width_, fill, colour);
  }
  /// Forgets labels and arrows, which belong to one panel only.
  void next_panel() { add("unset label\nunset arrow\n"); }

  const std::string& script() const { return script_; }

 private:
  std::string script_;
  double points_ = 1.0;  ///< a point in the terminal's unit of font size
  double width_, height_;
  int labels_ = 0, arrows_ = 0, objects_ = 0;
};

}  // namespace wingbeat

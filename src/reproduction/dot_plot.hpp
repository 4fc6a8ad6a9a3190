// Rows of points: statements, friction laws or variants of the model against one or several scales.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "report/style.hpp"
#include "wingbeat/report/plot.hpp"

namespace wingbeat::reproduction {

/// The formulation of a point is its shape; one that was used in the calibration is hollow.
struct Dot {
  double x;
  std::size_t variant = 0;  ///< 0 rod-force, 1 virtual-work, 2 virtual-work with its own calibration
  bool hollow = false;
  const char* colour = style::ink;
};
struct DotRow {
  std::string label;                        ///< long ones take two lines
  std::string note = {};                    ///< right of the points
  bool heading = false;                     ///< no points, bold
  std::vector<std::vector<Dot>> dots = {};  ///< panel by panel
};
struct DotPanel {
  std::string title, x;    ///< quantity and unit
  double low, high, step;  ///< what lies beyond is drawn as an arrowhead at the edge
  double band = 0.0;       ///< shaded between -band and band
  std::vector<std::pair<double, std::string>> references = {};  ///< lines with what they are
};
struct DotPlot {
  double width = style::single_column;  ///< [in]
  double label_width = 1.0, note_width = 0.1, row_height = 0.132;
  std::string note_title = {};
  std::vector<DotPanel> panels;
  std::vector<DotRow> rows;
  std::size_t variants = 2;  ///< named in the key; 0: no key
  bool calibrated = false;   ///< the key explains hollow points
};
void draw(const DotPlot& plot, PlotFormat format, const std::filesystem::path& file);

}  // namespace wingbeat::reproduction

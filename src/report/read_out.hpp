// Drawings as pages that show the numbers of what the reader points at.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/figure.hpp"

namespace wingbeat {

/// One quantity of the points of a panel, in the unit shown; NaN: none.
struct ReadOutColumn {
  std::string name, unit;
  std::vector<double> values;
};

/// The points of a panel that can be read.
struct ReadOutPanel {
  double left, right, top, bottom;  ///< of the panel, as parts of the page from its upper left corner
  std::string name;
  std::vector<double> x, y;  ///< of each point, 0 at the left and the lower edge, 1 at the others; no y: x alone counts
  std::vector<ReadOutColumn> columns;
  std::vector<std::string> notes;  ///< of each point, "" for none
};

/// Where a value stands between the ends of an axis, 0 to 1.
double share_of_axis(double value, double low, double high, bool logarithmic);

/// Writes a figure; as a page with the read-out of its panels where the format is html.
void write_figure(const Figure& figure, PlotFormat format, const std::string& title,
                  const std::vector<ReadOutPanel>& panels, const std::filesystem::path& output);

}  // namespace wingbeat

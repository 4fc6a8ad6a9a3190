// Outlines of regions on a grid of values.
#pragma once

#include <string>
#include <vector>

#include "report/figure.hpp"

namespace wingbeat {

struct ContourPoint {
  double x, y;
};
using Loop = std::vector<ContourPoint>;

/// Values on a grid, z[i * ny + j] at x[i], y[j]; coordinates grow.
struct ContourGrid {
  std::vector<double> x, y, z;
  bool log_x = false, log_y = false;
};

/// The boundaries of the region z >= level, closed along the edges of the grid, the region on their left: marching
/// squares with linear interpolation.
std::vector<Loop> boundaries(const ContourGrid& g, double level);

/// Adds several loops as one outline for filling: joined by lines that are passed in both directions.
void add_filled(Figure& figure, const std::string& name, const std::vector<Loop>& loops);
/// Adds the loops as lines, without what runs along the edges of the grid.
void add_outline(Figure& figure, const std::string& name, const ContourGrid& g, const std::vector<Loop>& loops);

/// Gives what is no number the value of the nearest number.
void extend(ContourGrid& g);
/// Means over neighbours, 1-2-1: turns the stairs of a field of zeros and ones into a slope of the same place.
void smooth(ContourGrid& g);

}  // namespace wingbeat

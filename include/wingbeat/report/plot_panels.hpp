// Points in panels one below the other: residuals, measurements.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/report/plot.hpp"

namespace wingbeat {

/// Points of one quantity; the same name has the same mark in every panel.
struct PointSeries {
  std::string name;
  std::vector<std::pair<double, double>> points;
};
struct PointPanel {
  std::string title;
  std::vector<PointSeries> series;
};
struct PointAxes {
  std::string title, x, y;
  double y_least = 0.0;    ///< the vertical axis, symmetric about 0, reaches at least this far
  double reference = 0.0;  ///< a line at this height; where it is > 0, of ratios, the axis begins at 0
};

/// Panels of points one below the other, all on the same vertical scale. Throws like plot_cycle.
void plot_panels(std::span<const PointPanel> panels, const PointAxes& axes, PlotFormat format,
                 const std::filesystem::path& file);

/// A measured point with its standard deviation.
struct CoursePoint {
  double x, y, deviation;
};
/// One quantity over the cycle: computed curve, measured points.
struct CoursePanel {
  std::string title, y = {};
  std::vector<std::pair<double, double>> curve = {};
  std::vector<CoursePoint> points = {};
};

/// Panels of curves with points one below the other, each on a scale of its own over 0 to 1. Throws like plot_cycle.
void plot_courses(std::span<const CoursePanel> panels, const PointAxes& axes, PlotFormat format,
                  const std::filesystem::path& file);

}  // namespace wingbeat

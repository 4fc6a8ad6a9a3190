// SVG written element by element: drawings of mechanisms that gnuplot does not make.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "wingbeat/parts/mechanism_pose.hpp"

namespace wingbeat {

/// Lines, circles and texts at points of a plane whose y points upwards.
class SvgDrawing {
 public:
  /// `scale`: units of the SVG for one of the plane; `origin`: where the plane's stands in the SVG; `decimals`: of
  /// numbers.
  SvgDrawing(double scale, const PlanePoint& origin, int decimals)
      : scale_(scale), origin_(origin), decimals_(decimals) {}

  /// `attributes` as they stand in the element; `content` between its tags.
  void line(const PlanePoint& a, const PlanePoint& b, std::string_view attributes, std::string_view content = "");
  void polyline(std::span<const PlanePoint> points, std::string_view attributes);
  void arc(const PlanePoint& centre, double radius, double from, double to, std::string_view attributes);
  void circle(const PlanePoint& centre, double radius, std::string_view attributes);
  /// `half` a side in units of the SVG.
  void square(const PlanePoint& centre, double half, std::string_view attributes);
  void text(const PlanePoint& p, std::string_view attributes, std::string_view content);
  /// An attribute that changes over and over through the values, `seconds` long.
  std::string animation(std::string_view attribute, std::span<const double> values, double seconds) const;

  /// In the SVG.
  double x(const PlanePoint& p) const { return origin_.x + scale_ * p.x; }
  double y(const PlanePoint& p) const { return origin_.y - scale_ * p.y; }

  /// The file: what `open` and `head` hold, the elements, the end. `open`: the attributes of <svg>.
  std::string file(std::string_view open, std::string_view title, std::string_view head) const;

 private:
  std::string number(double value) const;
  void element(std::string_view name, std::string_view place, std::string_view attributes, std::string_view content);

  double scale_;
  PlanePoint origin_;
  int decimals_;
  std::string elements_;
};

}  // namespace wingbeat

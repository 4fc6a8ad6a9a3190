#include "report/svg.hpp"

#include <fmt/format.h>

#include <vector>

namespace wingbeat {

std::string SvgDrawing::number(double value) const { return fmt::format("{:.{}f}", value, decimals_); }

void SvgDrawing::element(std::string_view name, std::string_view place, std::string_view attributes,
                         std::string_view content) {
  elements_ += fmt::format("<{} {}{}{}", name, place, attributes.empty() ? "" : " ", attributes);
  elements_ += content.empty() ? std::string("/>\n") : fmt::format(">{}</{}>\n", content, name);
}

void SvgDrawing::line(const PlanePoint& a, const PlanePoint& b, std::string_view attributes, std::string_view content) {
  element(
      "line",
      fmt::format("x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\"", number(x(a)), number(y(a)), number(x(b)), number(y(b))),
      attributes, content);
}

void SvgDrawing::polyline(std::span<const PlanePoint> points, std::string_view attributes) {
  std::string list;
  for (const PlanePoint& p : points)
    list += fmt::format("{}{},{}", list.empty() ? "" : " ", number(x(p)), number(y(p)));
  element("polyline", fmt::format("points=\"{}\"", list), attributes, "");
}

void SvgDrawing::arc(const PlanePoint& centre, double radius, double from, double to, std::string_view attributes) {
  constexpr int pieces = 24;
  std::vector<PlanePoint> points;
  for (int n = 0; n <= pieces; ++n) points.push_back(on_circle(centre, radius, from + (to - from) * n / pieces));
  polyline(points, attributes);
}

void SvgDrawing::circle(const PlanePoint& centre, double radius, std::string_view attributes) {
  element("circle",
          fmt::format("cx=\"{}\" cy=\"{}\" r=\"{}\"", number(x(centre)), number(y(centre)), number(scale_ * radius)),
          attributes, "");
}

void SvgDrawing::square(const PlanePoint& centre, double half, std::string_view attributes) {
  element("rect",
          fmt::format("x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"", number(x(centre) - half),
                      number(y(centre) - half), number(2.0 * half), number(2.0 * half)),
          attributes, "");
}

void SvgDrawing::text(const PlanePoint& p, std::string_view attributes, std::string_view content) {
  element("text", fmt::format("x=\"{}\" y=\"{}\"", number(x(p)), number(y(p))), attributes, content);
}

std::string SvgDrawing::animation(std::string_view attribute, std::span<const double> values, double seconds) const {
  std::string list;
  for (const double value : values) list += fmt::format("{}{}", list.empty() ? "" : ";", number(value));
  return fmt::format("<animate attributeName=\"{}\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
                     attribute, seconds, list);
}

std::string SvgDrawing::file(std::string_view open, std::string_view title, std::string_view head) const {
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" {}>\n<title>{}</title>\n{}{}</svg>\n", open, title,
                     head, elements_);
}

}  // namespace wingbeat

// The texts of a drawing by gnuplot, as boxes: what leaves the page, and what meets.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../../src/report/text_width.hpp"

namespace cli {

struct DrawnText {
  std::string text;
  double left, right, top, bottom;
};

struct DrawnPage {
  double width = 0.0, height = 0.0;
  std::vector<DrawnText> texts;
};

/// The value of an attribute of a tag: what stands between its quotes.
inline std::string attribute(std::string_view tag, const std::string& name) {
  for (const char quote : {'"', '\''}) {
    const auto from = tag.find(" " + name + "=" + quote);
    if (from == std::string_view::npos) continue;
    const auto begin = from + name.size() + 3;
    return std::string(tag.substr(begin, tag.find(quote, begin) - begin));
  }
  return "";
}

inline std::string without_markup(std::string_view xml) {
  std::string text;
  bool inside_tag = false;
  for (const char c : xml) {
    if (c == '<') inside_tag = true;
    else if (c == '>') inside_tag = false;
    else if (!inside_tag) text += c;
  }
  for (const auto& [entity, plain] :
       {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}}) {
    for (auto position = text.find(entity); position != std::string::npos; position = text.find(entity, position + 1)) {
      text.replace(position, std::string_view(entity).size(), plain);
    }
  }
  return text;
}

inline DrawnText placed(std::string text, double x, double y, double size, const std::string& anchor, bool upright) {
  // Sizes of the drawing's pixels, of which the metrics make as many inches as they would of points.
  const double width = wingbeat::text_width(text, size * wingbeat::points_per_inch);
  const double before = anchor == "end" ? width : anchor == "middle" ? 0.5 * width : 0.0;
  const double up = wingbeat::ascent_share * size, down = wingbeat::descent_share * size;
  if (upright) return {std::move(text), x - up, x + down, y - width + before, y + before};
  return {std::move(text), x - before, x - before + width, y - up, y + down};
}

inline DrawnPage page_of(const std::string& svg) {
  DrawnPage page;
  const auto root = svg.find("<svg");
  if (root == std::string::npos) throw std::invalid_argument("no SVG");
  const std::string box = attribute(std::string_view(svg).substr(root, svg.find('>', root) - root), "viewBox");
  if (std::sscanf(box.c_str(), "0 0 %lf %lf", &page.width, &page.height) != 2) {
    throw std::invalid_argument("no viewBox: " + box);
  }
  for (auto position = svg.find("<text"); position != std::string::npos; position = svg.find("<text", position + 1)) {
    const auto group = svg.rfind("<g ", position), open = svg.find('>', position), close = svg.find("</text>", open);
    const std::string_view tag = std::string_view(svg).substr(group, svg.find('>', group) - group);
    const std::string transform = attribute(tag, "transform");
    double x = 0.0, y = 0.0;
    if (std::sscanf(transform.c_str(), "translate(%lf,%lf)", &x, &y) != 2) {
      throw std::invalid_argument("no place: " + transform);
    }
    std::string text = without_markup(std::string_view(svg).substr(open + 1, close - open - 1));
    if (text.find_first_not_of(' ') == std::string::npos) continue;
    page.texts.push_back(placed(std::move(text), x, y, std::atof(attribute(tag, "font-size").c_str()),
                                attribute(tag, "text-anchor"), transform.find("rotate(-90") != std::string::npos));
  }
  return page;
}

/// Every text that leaves the page and every pair that meets, in words; `slack` [px] is left to rounding.
inline std::vector<std::string> text_flaws(const std::string& svg, double slack = 0.5) {
  const DrawnPage page = page_of(svg);
  std::vector<std::string> flaws;
  for (std::size_t n = 0; n < page.texts.size(); ++n) {
    const DrawnText& a = page.texts[n];
    if (a.left < -slack || a.right > page.width + slack || a.top < -slack || a.bottom > page.height + slack) {
      flaws.push_back("leaves the page: " + a.text);
    }
    for (std::size_t k = n + 1; k < page.texts.size(); ++k) {
      const DrawnText& b = page.texts[k];
      const double wide = std::min(a.right, b.right) - std::max(a.left, b.left);
      const double high = std::min(a.bottom, b.bottom) - std::max(a.top, b.top);
      if (wide > slack && high > slack) flaws.push_back("meet: " + a.text + " | " + b.text);
    }
  }
  return flaws;
}

}  // namespace cli

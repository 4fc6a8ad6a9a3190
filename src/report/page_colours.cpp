#include "report/page_colours.hpp"

#include <fmt/format.h>

#include <string_view>

#include "report/style.hpp"

namespace wingbeat {
namespace {

/// A colour of the figures: as they are drawn, as a name of the page's style, and on a dark page.
struct PageColour {
  const char *drawn, *name, *dark;
};
constexpr PageColour page_colours[] = {{"#ffffff", "paper", "#181b1f"},
                                       {style::ink, "ink", "#e8e8e6"},
                                       {"#404040", "axis", "#b8bec6"},
                                       {"#202020", "edge", "#c8ccd2"},
                                       {style::grey, "grey", "#9aa0a6"},
                                       {style::outside_domain, "out", "#747a80"},
                                       {"#e4e4e4", "met", "#31373e"},
                                       {"#d0d0d0", "flow", "#4a5058"},
                                       {"#c8c8c8", "stored", "#50565e"},
                                       {"#ececec", "returned", "#2c3137"},
                                       {"#e0e0e0", "slider", "#4a5058"},
                                       {style::with_springs, "springs", "#5ab4f0"},
                                       {style::without_springs, "bare", "#ff8c42"},
                                       {style::in_vacuum, "vacuum", "#5cc9b7"},
                                       {style::without_wings, "wingless", "#c6c65a"},
                                       {style::ordered[0], "first", "#5f4a7c"},
                                       {style::ordered[1], "second", "#8d68b5"},
                                       {style::ordered[2], "third", "#b79be0"},
                                       {style::ordered[3], "fourth", "#e3d3ff"},
                                       {"#8f3d6e", "friction", "#e39cc4"},
                                       {"#7a5300", "copper", "#f0bc55"},
                                       {"#6b6000", "viscous", "#e6dc6a"},
                                       {"#505050", "residual", "#bbbbbb"},
                                       {"#1f6f9c", "air", "#7cc4ee"},
                                       {"#606060", "rim", "#a8aeb6"},
                                       {"#bdbdbd", "cloud", "#5a6068"},
                                       {"#b00000", "limit", "#ff8a7a"}};

void replace_in(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t position = 0; (position = text.find(from, position)) != std::string::npos; position += to.size())
    text.replace(position, from.size(), to);
}

}  // namespace

std::string colour_variables(bool dark) {
  std::string text;
  for (const PageColour& c : page_colours) text += fmt::format(" --{}: {};", c.name, dark ? c.dark : c.drawn);
  return text;
}

void use_page_colours(std::string& svg) {
  for (const PageColour& c : page_colours) {
    const std::string_view hex = c.drawn;
    const auto part = [&](std::size_t n) { return std::stoi(std::string(hex.substr(1 + 2 * n, 2)), nullptr, 16); };
    const std::string to = fmt::format("var(--{})", c.name);
    replace_in(svg, hex, to);
    replace_in(svg, fmt::format("rgb({:3},{:4},{:4})", part(0), part(1), part(2)), to);
    replace_in(svg, fmt::format("rgb({},{},{})", part(0), part(1), part(2)), to);
  }
  replace_in(svg, "\"black\"", "\"var(--ink)\"");
  replace_in(svg, " font-family=\"sans-serif\"", "");
}

}  // namespace wingbeat

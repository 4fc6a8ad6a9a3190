#include "report/style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace wingbeat::style {
namespace {

/// What `tidy` makes of each piece between `begin` and `end`, both included.
template <class Tidy>
std::string replaced(const std::string& text, std::string_view begin, std::string_view end, const Tidy& tidy) {
  std::string out;
  std::size_t done = 0;
  for (;;) {
    const auto from = text.find(begin, done);
    const auto to = from == std::string::npos ? from : text.find(end, from + begin.size());
    if (to == std::string::npos) break;
    out.append(text, done, from - done);
    out += tidy(std::string_view(text).substr(from + begin.size(), to - from - begin.size()));
    done = to + end.size();
  }
  return out.append(text, done);
}

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t'; }

/// Without groups that hold nothing.
std::string without_empty_groups(const std::string& text) {
  std::string out;
  std::size_t done = 0;
  for (;;) {
    const auto from = text.find("<g ", done);
    const auto close = from == std::string::npos ? from : text.find('>', from);
    if (close == std::string::npos) break;
    std::size_t next = close + 1;
    while (next < text.size() && is_blank(text[next])) ++next;
    const bool empty = text.compare(next, 4, "</g>") == 0;
    out.append(text, done, (empty ? from : close + 1) - done);
    done = empty ? next + 4 : close + 1;
    while (empty && done < text.size() && is_blank(text[done])) ++done;
  }
  return out.append(text, done);
}

/// A path without blanks that no reader needs.
std::string tight(std::string_view path) {
  std::string out;
  for (const char c : path) {
    if (!out.empty() && is_blank(out.back()) && (is_blank(c) || c == 'L' || c == 'M')) out.pop_back();
    out += is_blank(c) ? ' ' : c;
  }
  while (!out.empty() && is_blank(out.back())) out.pop_back();
  return out;
}

}  // namespace

std::string stroke(const char* colour, const char* dash, double width) {
  return fmt::format("dt {} lw {} lc rgb '{}'", dash, width, colour);
}

std::vector<Phase> phases(std::span<const WaveformRow> rows) {
  std::vector<Phase> order;
  if (rows.size() < 2) return order;
  const double period = rows.back().time - rows.front().time;
  const auto least = std::min_element(rows.begin(), rows.end(), [](const WaveformRow& p, const WaveformRow& q) {
    return p.stroke_angle < q.stroke_angle;
  });
  // The last row is the first one again.
  for (std::size_t n = 0; n + 1 < rows.size(); ++n) {
    const double since = (rows[n].time - least->time) / period + 0.125;
    order.push_back({n, since - std::floor(since) - 0.125});
  }
  std::sort(order.begin(), order.end(), [](const Phase& p, const Phase& q) { return p.periods < q.periods; });
  order.push_back({order.front().row, order.front().periods + 1.0});
  return order;
}

std::string tidied_svg(std::string text) {
  text = replaced(text, "<title>Gnuplot</title>", "</desc>", [](auto) { return ""; });
  text = replaced(text, "<g id=\"gnuplot_plot_", "</title>", [](std::string_view plot) {
    const std::string_view title = plot.substr(plot.find("<title>") + 7);
    return title.starts_with("curve|") ? fmt::format("<g data-curve=\"{}\">", title.substr(6)) : "<g>";
  });
  text = replaced(text, " d='", "'", [](std::string_view path) { return fmt::format(" d='{}'", tight(path)); });
  const auto defined = text.find("</defs>");
  if (defined != std::string::npos && text.find("#gp", defined) == std::string::npos) {
    const auto begin = text.find("<defs>");
    text.erase(begin, defined + 7 - begin);
  }
  return without_empty_groups(text);
}

}  // namespace wingbeat::style

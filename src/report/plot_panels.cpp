#include "wingbeat/report/plot_panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "report/figure.hpp"

namespace wingbeat {

void plot_panels(std::span<const PointPanel> panels, const PointAxes& axes, PlotFormat format,
                 const std::filesystem::path& file) {
  if (panels.empty()) throw std::runtime_error("nothing to plot");
  std::vector<std::string> names;
  double most = axes.y_least;
  for (const PointPanel& panel : panels) {
    for (const PointSeries& s : panel.series) {
      if (std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
      for (const auto& [x, y] : s.points) most = std::max(most, std::abs(y));
    }
  }
  // The shapes tell quantities apart.
  constexpr std::pair<const char*, int> styles[] = {{style::ink, 7}, {style::ink, 6},  {style::grey, 5},
                                                    {style::ink, 4}, {style::grey, 9}, {style::ink, 8},
                                                    {style::ink, 2}, {style::ink, 12}};
  constexpr std::size_t style_count = std::size(styles), per_row = 2;
  const double rows = std::ceil(double(names.size()) / per_row);
  const double head = 0.1 + 0.14 * rows, foot = 0.5, each = 1.05, gap = 0.42;
  const double inches = head + foot + each * double(panels.size()) + gap * double(panels.size());
  Figure figure(format, 3.5, inches);
  const auto data_name = [](std::size_t panel, std::size_t series) { return fmt::format("$p{}_{}", panel, series); };
  for (std::size_t p = 0; p < panels.size(); ++p) {
    for (std::size_t s = 0; s < panels[p].series.size(); ++s) {
      figure.add("{} << END\n", data_name(p, s));
      for (const auto& [x, y] : panels[p].series[s].points) figure.add("{} {}\n", x, y);
      figure.add("END\n");
    }
  }
  constexpr double left = 0.14, right = 0.96;
  figure.add(
      "set multiplot\nset lmargin at screen {}\nset rmargin at screen {}\nset offsets graph 0.04, graph 0.04, 0, 0\n",
      left, right);
  figure.add("set yrange [-{0}:{0}]\nset ytics autofreq\n", 1.08 * most);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    if (p > 0) figure.next_panel();
    const double top = 1.0 - (head + gap + (each + gap) * double(p)) / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", top, top - each / inches);
    figure.text(panels[p].title, 7.5, fmt::format("screen {},{} left", left, top + 0.09 / inches));
    if (p == 0) {
      figure.text(axes.title, 8.0, fmt::format("screen 0.5,{} center", 1.0 - 0.12 / inches));
      figure.text(axes.y, 7.5,
                  fmt::format("screen 0.026,{} center rotate by 90", 0.5 * (1.0 - (head + gap - foot) / inches)));
      figure.text(axes.x, 7.5, fmt::format("screen {},{} center", 0.5 * (left + right), 0.09 / inches));
      for (std::size_t n = 0; n < names.size(); ++n) {
        const double y = 1.0 - (0.32 + 0.14 * double(n / per_row)) / inches, x = left + 0.42 * double(n % per_row);
        figure.add("set label {} '' at screen {},{} point pt {} ps 0.45 lw 1.6 lc rgb '{}' front\n", 500 + n, x, y,
                   styles[n % style_count].second, styles[n % style_count].first);
        figure.text(names[n], style::text_size, fmt::format("screen {},{} left", x + 0.025, y));
      }
    }
    std::string plots = "0 with lines lt 1 dt 1 lw 0.5 lc rgb '#404040'";
    for (std::size_t s = 0; s < panels[p].series.size(); ++s) {
      const PointSeries& series = panels[p].series[s];
      if (series.points.empty()) continue;
      const std::size_t n = std::size_t(std::find(names.begin(), names.end(), series.name) - names.begin());
      plots += fmt::format(", {} using 1:2 with points pt {} ps 0.45 lw 1.6 lc rgb '{}'", data_name(p, s),
                           styles[n % style_count].second, styles[n % style_count].first);
    }
    figure.add("plot {}\n", plots);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat

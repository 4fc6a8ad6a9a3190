#include "wingbeat/report/plot_panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/text_width.hpp"

namespace wingbeat {
namespace {

/// Distance of the tics of a panel that is an inch high.
double tick_step(const CoursePanel& panel) {
  double least = HUGE_VAL, largest = -HUGE_VAL;
  const auto extend = [&](double y) { least = std::min(least, y), largest = std::max(largest, y); };
  for (const auto& [x, y] : panel.curve) extend(y);
  for (const CoursePoint& p : panel.points) extend(p.y);
  return round_step(largest > least ? (largest - least) / 4.0 : 1.0);
}

}  // namespace

void plot_panels(std::span<const PointPanel> panels, const PointAxes& axes, PlotFormat format,
                 const std::filesystem::path& file) {
  if (panels.empty()) throw std::runtime_error("nothing to plot");
  std::vector<std::string> names;
  double highest = axes.y_least;
  for (const PointPanel& panel : panels) {
    for (const PointSeries& s : panel.series) {
      if (std::find(names.begin(), names.end(), s.name) == names.end()) names.push_back(s.name);
      for (const auto& [x, y] : s.points) highest = std::max(highest, std::abs(y));
    }
  }
  // The shapes tell quantities apart.
  constexpr std::pair<const char*, int> styles[] = {{style::ink, 7}, {style::ink, 6},  {style::grey, 5},
                                                    {style::ink, 4}, {style::grey, 9}, {style::ink, 8},
                                                    {style::ink, 2}, {style::ink, 12}};
  constexpr std::size_t style_count = std::size(styles);
  constexpr double left = 0.14, right = 0.96;
  const auto point = [&](std::size_t n) {
    return fmt::format("pt {} ps 0.45 lw 1.6 lc rgb '{}'", styles[n % style_count].second,
                       styles[n % style_count].first);
  };
  std::vector<KeyEntry> named;
  for (std::size_t n = 0; n < names.size(); ++n) named.push_back(point_key(names[n], point(n)));
  const Key key(std::move(named), (right - left) * format.width);
  const double head = 0.1 + key.height(), foot = 0.5, each = 1.05, gap = 0.42;
  const double inches = head + foot + each * double(panels.size()) + gap * double(panels.size());
  Figure figure(format, inches);
  const auto data_name = [](std::size_t panel, std::size_t series) { return fmt::format("$p{}_{}", panel, series); };
  for (std::size_t p = 0; p < panels.size(); ++p) {
    for (std::size_t s = 0; s < panels[p].series.size(); ++s) {
      figure.add("{} << END\n", data_name(p, s));
      for (const auto& [x, y] : panels[p].series[s].points) figure.add("{} {}\n", x, y);
      figure.add("END\n");
    }
  }
  figure.add(
      "set multiplot\nset lmargin at screen {}\nset rmargin at screen {}\nset offsets graph 0.04, graph 0.04, 0, 0\n",
      left, right);
  highest *= 1.08;
  figure.add("set yrange [{}:{}]\nset ytics autofreq\n", axes.reference > 0.0 ? 0.0 : -highest, highest);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    if (p > 0) figure.next_panel();
    const double top = 1.0 - (head + gap + (each + gap) * double(p)) / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", top, top - each / inches);
    figure.text(panels[p].title, 7.5, fmt::format("screen {},{} left", left, top + 0.09 / inches));
    if (p == 0) {
      page_title(figure, axes.title, 0.12);
      axis_title(figure, axes.y, 7.5, inches - 2.0 * page_margin, left - 0.4 / format.width,
                 std::max(0.5 * (1.0 - (head + gap - foot) / inches),
                          std::min(0.5, (0.5 * text_width(axes.y, 7.5) + page_margin) / inches)));
      figure.text(axes.x, 7.5, fmt::format("screen {},{} center", 0.5 * (left + right), 0.09 / inches));
      key.draw(figure, left * format.width, 0.25);
    }
    std::string plots = fmt::format("{} with lines lt 1 dt 1 lw 0.5 lc rgb '#404040'", axes.reference);
    for (std::size_t s = 0; s < panels[p].series.size(); ++s) {
      const PointSeries& series = panels[p].series[s];
      if (series.points.empty()) continue;
      const std::size_t n = std::size_t(std::find(names.begin(), names.end(), series.name) - names.begin());
      plots += fmt::format(", {} using 1:2 with points {}", data_name(p, s), point(n));
    }
    figure.add("plot {}\n", plots);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

void plot_courses(std::span<const CoursePanel> panels, const PointAxes& axes, PlotFormat format,
                  const std::filesystem::path& file) {
  if (panels.empty()) throw std::runtime_error("nothing to plot: the fitted model reaches no waveform");
  constexpr double left = 0.16, right = 0.96;
  constexpr const char* points = "pt 6 ps 0.4 lw 0.8 lc rgb '#000000'";
  const std::string curve = style::stroke(style::grey, style::solid, 1.6);
  const Key key({point_key("measured, with standard deviation", points), line_key("fitted", curve)},
                (right - left) * format.width);
  const double head = 0.1 + key.height(), foot = 0.5, each = 1.05, gap = 0.42;
  const double inches = head + foot + (each + gap) * double(panels.size());
  Figure figure(format, inches);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    figure.add("$c{} << END\n", p);
    for (const auto& [x, y] : panels[p].curve) figure.add("{} {}\n", x, y);
    figure.add("END\n$p{} << END\n", p);
    for (const CoursePoint& point : panels[p].points) figure.add("{} {} {}\n", point.x, point.y, point.deviation);
    figure.add("END\n");
  }
  figure.add(
      "set multiplot\nset lmargin at screen {}\nset rmargin at screen {}\nset offsets 0, 0, graph 0.06, graph 0.06\n"
      "set xrange [0:1]\nset xtics 0.25\nset errorbars 0\n",
      left, right);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    if (p > 0) figure.next_panel();
    const double top = 1.0 - (head + gap + (each + gap) * double(p)) / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", top, top - each / inches);
    figure.text(panels[p].title, 7.5, fmt::format("screen {},{} left", left, top + 0.09 / inches));
    axis_title(figure, panels[p].y, 7.5, inches - 2.0 * page_margin, left - 0.44 / format.width,
               top - 0.5 * each / inches);
    if (p == 0) {
      page_title(figure, axes.title, 0.12);
      figure.text(axes.x, 7.5, fmt::format("screen {},{} center", 0.5 * (left + right), 0.09 / inches));
      key.draw(figure, left * format.width, 0.25);
    }
    figure.add("set ytics {}\n", tick_step(panels[p]));
    figure.add("plot $c{0} using 1:2 with lines {1}, $p{0} using 1:2:3 with yerrorbars {2}\n", p, curve, points);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat

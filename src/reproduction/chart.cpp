#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "report/figure.hpp"
#include "reproduction/sheet.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr double left = 0.155, right = 0.965;

std::string line(const CurveStyle& s) { return fmt::format("dt {} lw {} lc rgb '{}'", s.dash, s.weight, s.colour); }

/// Marks at about eight places of a curve.
std::string with(const CurveStyle& s, std::size_t points) {
  if (s.mark == 0) return fmt::format("with lines {}", line(s));
  return fmt::format("with linespoints {} pt {} ps 0.6 pi {}", line(s), s.mark, std::max<std::size_t>(1, points / 8));
}

double nice_step(double span) {
  const double raw = span / 4.0, unit = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 2.5, 5.0, 10.0}) {
    if (m * unit >= raw) return m * unit;
  }
  return 10.0 * unit;
}

}  // namespace

CurveStyle thin(CurveStyle style) {
  style.mark = 0;
  style.weight = 0.55;
  return style;
}

void draw(const Chart& chart, PlotFormat format, const std::filesystem::path& file) {
  // Key entries follow each other on lines, as words do.
  std::vector<std::pair<double, int>> places;
  double key_x = left - 0.1;
  int key_line = 0;
  for (const ChartKey& entry : chart.key) {
    const double width = 0.1 + 0.015 * double(entry.name.size());
    if (key_x + width > right + 0.03) {
      key_x = left - 0.1;
      ++key_line;
    }
    places.push_back({key_x, key_line});
    key_x += width;
  }
  const bool titled =
      std::any_of(chart.panels.begin(), chart.panels.end(), [](const auto& p) { return !p.title.empty(); });
  const double head = 0.06 + 0.15 * (key_line + 1), foot = 0.42, gap = titled ? 0.25 : 0.14;
  const double count = double(chart.panels.size());
  const double inches = head + count * (gap + chart.panel_height) + foot;
  Figure figure(format, 3.5, inches);

  double x_low = INFINITY, x_high = -INFINITY;
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    const ChartPanel& panel = chart.panels[p];
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      const ChartCurve& curve = panel.curves[c];
      figure.add("$c{}_{} << END\n", p, c);
      for (std::size_t n = 0; n < curve.x.size(); ++n) {
        x_low = std::min(x_low, curve.x[n]);
        x_high = std::max(x_high, curve.x[n]);
        if (std::isfinite(curve.y[n])) figure.add("{:.8g} {:.8g}\n", curve.x[n], curve.y[n]);
        else figure.add("\n");
      }
      figure.add("END\n");
    }
    for (std::size_t a = 0; a < panel.areas.size(); ++a) {
      const ChartArea& area = panel.areas[a];
      figure.add("$a{}_{} << END\n", p, a);
      for (std::size_t n = 0; n < area.x.size(); ++n) figure.add("{:.8g} {:.8g}\n", area.x[n], area.y[n]);
      figure.add("END\n");
    }
  }
  if (!(x_high > x_low)) throw std::runtime_error("no curve to draw");
  figure.add("set multiplot\nset lmargin at screen {}\nset rmargin at screen {}\nset xrange [{}:{}]\n", left, right,
             x_low, x_high);
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    const ChartPanel& panel = chart.panels[p];
    const bool last = p + 1 == chart.panels.size();
    if (p > 0) figure.next_panel();
    const double top = 1.0 - (head + gap + (chart.panel_height + gap) * double(p)) / inches;
    const double bottom = top - chart.panel_height / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\nset format x {}\n", top, bottom,
               last ? "'%g'" : "''");
    double low = panel.from_zero ? 0.0 : INFINITY, high = panel.from_zero ? 0.0 : -INFINITY;
    const auto cover = [&](double y) {
      if (!std::isfinite(y)) return;
      low = std::min(low, y);
      high = std::max(high, y);
    };
    for (const ChartCurve& curve : panel.curves) {
      for (const double y : curve.y) cover(y);
    }
    for (const ChartLevel& level : panel.levels) cover(level.y);
    if (!(high > low)) high = low + 1.0;
    const double step = nice_step(high - low);
    low = std::floor(low / step + 1e-9) * step;
    high = std::ceil(high / step - 1e-9) * step;
    figure.add("set yrange [{}:{}]\nset ytics {}\n", low, high, step);
    figure.text(panel.y, 7.5, fmt::format("screen 0.028,{} center rotate by 90", 0.5 * (top + bottom)));
    if (!panel.title.empty())
      figure.text(panel.title, 7.5, fmt::format("screen {},{} left", left, top + 0.09 / inches));
    if (last) figure.text(chart.x, 7.5, fmt::format("screen {},{} center", 0.5 * (left + right), 0.1 / inches));
    if (p == 0) {
      for (std::size_t k = 0; k < chart.key.size(); ++k) {
        const double x = places[k].first, y = 1.0 - (0.1 + 0.15 * places[k].second) / inches;
        const ChartKey& entry = chart.key[k];
        if (entry.fill) {
          figure.box(
              fmt::format("from screen {},{} to screen {},{}", x, y - 0.04 / inches, x + 0.05, y + 0.04 / inches),
              entry.fill);
          figure.text(entry.name, 7.0, fmt::format("screen {},{} left", x + 0.065, y));
          continue;
        }
        figure.key_entry(x, y, line(entry.style).c_str(), entry.name);
        if (entry.style.mark > 0) {
          figure.add("set label {} '' at screen {},{} point pt {} ps 0.6 lc rgb '{}' front\n", 700 + k, x + 0.0285, y,
                     entry.style.mark, entry.style.colour);
        }
      }
    }
    for (const ChartLevel& level : panel.levels) {
      figure.text(level.name, 6.5, fmt::format("graph 0.02,first {} left offset 0,0.45", level.y));
    }
    std::string plots;
    for (std::size_t a = 0; a < panel.areas.size(); ++a) {
      const ChartArea& area = panel.areas[a];
      plots += fmt::format(
          "$a{0}_{1} using 1:($2 > 0 ? $2 : 0) with filledcurves y=0 fs solid lc rgb '{2}', "
          "'' using 1:($2 < 0 ? $2 : 0) with filledcurves y=0 fs solid lc rgb '{3}', ",
          p, a, area.above, area.below);
    }
    plots += low < 0.0 ? "0 with lines dt 1 lw 0.5 lc rgb '#404040'" : "NaN";
    for (const ChartLevel& level : panel.levels) {
      plots += fmt::format(", {} with lines dt (12,4,3,4) lw 0.9 lc rgb '#606060'", level.y);
    }
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      const auto& ys = panel.curves[c].y;
      if (std::none_of(ys.begin(), ys.end(), [](double y) { return std::isfinite(y); })) continue;
      plots += fmt::format(", $c{}_{} using 1:2 {}", p, c, with(panel.curves[c].style, panel.curves[c].x.size()));
    }
    figure.add("plot {}\n", plots);
    if (p == 0) figure.add("unset object\n");
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

void Table::add(std::string name, std::string unit, std::string long_name, std::vector<double> values) {
  columns.push_back({std::move(name), std::move(unit), std::move(long_name), std::move(values)});
}

std::string csv(const Table& table) {
  std::string text;
  for (const TableColumn& c : table.columns) text += fmt::format("{}{}", text.empty() ? "" : ",", c.name);
  text += '\n';
  for (std::size_t n = 0; n < table.columns.front().values.size(); ++n) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const double x = table.columns[c].values[n];
      text += fmt::format("{}{}", c == 0 ? "" : ",", std::isfinite(x) ? fmt::format("{:.9g}", x) : "");
    }
    text += '\n';
  }
  return text;
}

void write_netcdf(const Table& table, const Provenance& provenance, const std::filesystem::path& file) {
  NetcdfFile out(file);
  write_provenance(out, provenance);
  const TableColumn& axis = table.columns.front();
  const auto dimension = out.define_dimension(axis.name, axis.values.size());
  std::vector<NetcdfFile::Variable> variables;
  for (const TableColumn& c : table.columns) {
    variables.push_back(out.define_variable(c.name, {dimension}, c.unit, c.long_name));
  }
  for (std::size_t c = 0; c < variables.size(); ++c) out.write(variables[c], table.columns[c].values);
  out.close();
}

const CycleCase* cycle_of(const std::vector<CycleCase>& cycles, Formulation formulation, bool springs) {
  for (const CycleCase& c : cycles) {
    if (c.of.formulation == formulation && c.of.springs == springs && !c.run.cycle.empty()) return &c;
  }
  return nullptr;
}

}  // namespace wingbeat::reproduction

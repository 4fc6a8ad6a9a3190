#include "reproduction/dot_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/figure.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr double letter = 0.05, second_line = 0.108, heading_height = 0.2;  // [in]
constexpr int filled[] = {7, 5, 9}, hollow[] = {6, 4, 8};
constexpr const char* variant_key[] = {"rod-force", "virtual-work", "virtual-work, own calibration"};

/// The label in lines that fit.
std::vector<std::string> lines_of(const std::string& label, double width) {
  const std::string text = wrapped(label, int(width / letter), 0);
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n') lines.emplace_back();
    else lines.back() += c;
  }
  return lines;
}

}  // namespace

void draw(const DotPlot& plot, PlotFormat format, const std::filesystem::path& file) {
  const bool titled =
      std::any_of(plot.panels.begin(), plot.panels.end(), [](const DotPanel& p) { return !p.title.empty(); });
  const bool referred =
      std::any_of(plot.panels.begin(), plot.panels.end(), [](const DotPanel& p) { return !p.references.empty(); });
  const double head = (plot.variants > 0 ? 0.22 : 0.05) + (titled ? 0.17 : 0.0) + (referred ? 0.15 : 0.0);
  const double foot = 0.45, gap = plot.panels.size() > 1 ? 0.3 : 0.16;
  std::vector<double> middle;  // of each row from above [in]
  double y = head;
  for (const DotRow& row : plot.rows) {
    const double height =
        row.heading ? heading_height
                    : plot.row_height + second_line * double(lines_of(row.label, plot.label_width).size() - 1);
    middle.push_back(y + (row.heading ? 0.6 : 0.5) * height);
    y += height;
  }
  const double inches = y + foot, count = double(plot.panels.size());
  const double panel_width = (plot.width - plot.label_width - plot.note_width - gap * (count - 1.0)) / count;
  Figure figure(format, plot.width, inches);
  const auto on_page = [&](double from_above) { return 1.0 - from_above / inches; };
  figure.add(
      "set multiplot\nset border 1\nunset ytics\nset yrange [{}:{}]\nset tmargin at screen {}\n"
      "set bmargin at screen {}\n",
      y, head, on_page(head), on_page(y));
  for (std::size_t p = 0; p < plot.panels.size(); ++p) {
    const DotPanel& panel = plot.panels[p];
    const double x0 = plot.label_width + (panel_width + gap) * double(p);
    if (p > 0) figure.next_panel();
    figure.add("unset object\nset lmargin at screen {}\nset rmargin at screen {}\nset xrange [{}:{}]\n",
               x0 / plot.width, (x0 + panel_width) / plot.width, panel.low, panel.high);
    if (p == 0) {
      double x = 0.08;
      const auto key = [&](int mark, const std::string& name) {
        figure.add("set label {} '' at screen {},{} point pt {} ps 0.75 lw 1.6 lc rgb '#000000' front\n",
                   900 + int(100.0 * x), x / plot.width, on_page(0.1), mark);
        figure.text(name, style::text_size, fmt::format("screen {},{} left", (x + 0.08) / plot.width, on_page(0.1)));
        x += 0.28 + letter * double(name.size());
      };
      for (std::size_t v = 0; v < plot.variants; ++v) key(filled[v], variant_key[v]);
      if (plot.calibrated) key(hollow[0], "hollow: used in the calibration");
      for (std::size_t r = 0; r < plot.rows.size(); ++r) {
        const DotRow& row = plot.rows[r];
        if (row.heading) {
          figure.symbols(fmt::format("{{/:Bold {}}}", row.label), style::text_size,
                         fmt::format("screen {},{} left", 0.05 / plot.width, on_page(middle[r])));
          continue;
        }
        const std::vector<std::string> lines = lines_of(row.label, plot.label_width);
        for (std::size_t n = 0; n < lines.size(); ++n) {
          const double height = middle[r] + second_line * (double(n) - 0.5 * double(lines.size() - 1));
          figure.text(lines[n], style::text_size, fmt::format("screen {},{} left", 0.05 / plot.width, on_page(height)));
        }
        figure.text(row.note, style::text_size,
                    fmt::format("screen {},{} right", 1.0 - 0.04 / plot.width, on_page(middle[r])));
      }
      if (!plot.note_title.empty()) {
        figure.text(plot.note_title, style::text_size,
                    fmt::format("screen {},{} right", 1.0 - 0.04 / plot.width, on_page(head - 0.06)));
      }
    }
    if (panel.band > 0.0) {
      figure.add(
          "set object rectangle from first {},graph 0 to first {},graph 1 behind fillcolor rgb '#e4e4e4' "
          "fillstyle solid noborder\n",
          -panel.band, panel.band);
    }
    if (panel.low < 0.0 && panel.high > 0.0) {
      figure.add("set arrow 600 from first 0,graph 0 to first 0,graph 1 nohead back {}\n",
                 style::stroke(style::grey, style::solid, style::thin_width));
    }
    for (std::size_t n = 0; n < panel.references.size(); ++n) {
      const auto& [reference, name] = panel.references[n];
      figure.add("set arrow {} from first {},graph 0 to first {},graph 1 nohead back {}\n", 601 + n, reference,
                 reference, style::reference_line);
      figure.text(name, style::text_size, fmt::format("first {},screen {} center", reference, on_page(head - 0.07)));
    }
    const double title_at = on_page(head - (referred ? 0.22 : 0.08));
    if (plot.panels.size() > 1) {
      figure.symbols(fmt::format("{{/:Bold {}}}", char('a' + p)), style::title_size,
                     fmt::format("screen {},{} left", x0 / plot.width, title_at));
    }
    if (!panel.title.empty()) {
      figure.text(panel.title, style::heading_size,
                  fmt::format("screen {},{} left", (x0 + 0.12) / plot.width, title_at));
    }
    figure.add("set xtics {}\n", panel.step);
    figure.text(panel.x, style::heading_size,
                fmt::format("screen {},{} center", (x0 + 0.5 * panel_width) / plot.width, on_page(y + 0.34)));
    std::string points;
    for (std::size_t r = 0; r < plot.rows.size(); ++r) {
      if (plot.rows[r].heading || plot.rows[r].dots.size() <= p) continue;
      for (const Dot& dot : plot.rows[r].dots[p]) {
        if (!std::isfinite(dot.x)) continue;
        const bool right = dot.x > panel.high, beyond = right || dot.x < panel.low;
        const double x = std::clamp(dot.x, panel.low, panel.high);
        // Shapes side by side where they would hide each other.
        const double height = middle[r] + 0.025 * (double(dot.variant) - 0.5);
        if (beyond) {
          points += fmt::format(
              "set label '' at first {},first {} point pt {} ps 0.75 lw 1.6 lc rgb '{}' front\n"
              "set arrow from first {},first {} rto screen {},0 head size screen {},25 filled lw 0.6 lc rgb '{}' "
              "front\n",
              x, height, (dot.hollow ? hollow : filled)[dot.variant], dot.colour, x, height,
              (right ? 0.09 : -0.09) / plot.width, 0.045 / plot.width, dot.colour);
        } else {
          points += fmt::format("set label '' at first {},first {} point pt {} ps 0.75 lw 1.6 lc rgb '{}' front\n", x,
                                height, (dot.hollow ? hollow : filled)[dot.variant], dot.colour);
        }
      }
    }
    figure.add("{}plot NaN\n", points);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat::reproduction

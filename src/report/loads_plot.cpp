// Simulated loads over the cycle beside the model's.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "wingbeat/report/loads_report.hpp"

namespace wingbeat {
namespace {

struct LoadPrefix {
  double factor;
  const char* name;
};

/// The prefix with which the largest of the numbers is between 1 and 1000.
LoadPrefix load_prefix_for(double largest) {
  for (const LoadPrefix p : {LoadPrefix{1.0, ""}, {1e3, "m"}, {1e6, "µ"}}) {
    if (largest * p.factor >= 1.0) return p;
  }
  return {1e9, "n"};
}

std::string load_panel_title(LoadQuantity quantity) {
  switch (quantity) {
    case LoadQuantity::lift: return "Lift of all wings";
    case LoadQuantity::stroke_moment: return "Stroke moment of the air, all wings";
    default: return "Pitch moment of the air, all wings";
  }
}

}  // namespace

void plot_loads(const LoadReport& report, const std::string& title, PlotFormat format,
                const std::filesystem::path& file) {
  const std::vector<ComparedLoad>& loads = report.comparison.loads;
  constexpr double left_inches = 0.52, right = 0.97;
  const double left = left_inches / format.width;
  const std::string model = style::stroke(style::grey, style::solid, 1.6);
  const std::string mean_model = style::stroke(style::grey, style::dash_dotted, 0.8);
  const std::string mean_simulated = style::stroke(style::ink, style::dotted, 0.9);
  // Many rows make a band of points: smaller ones then.
  const std::string points =
      fmt::format("pt 6 ps {} lw 0.7 lc rgb '{}'", report.comparison.rows > 150 ? 0.2 : 0.32, style::ink);
  const Key key({point_key("simulated", points), line_key("model", model), line_key("mean, simulated", mean_simulated),
                 line_key("mean, model", mean_model)},
                (right - left) * format.width);
  const double key_top = 0.26, head = key_top + key.height(), foot = 0.42, each = 1.15, gap = 0.28;
  const double inches = head + foot + (each + gap) * double(loads.size());
  Figure figure(format, inches);
  std::vector<LoadPrefix> prefixes;
  for (std::size_t p = 0; p < loads.size(); ++p) {
    double largest = 0.0;
    for (const LoadPoint& point : loads[p].points) {
      largest = std::max({largest, std::abs(point.simulated), std::abs(point.model)});
    }
    prefixes.push_back(load_prefix_for(largest));
    figure.add("$d{} << END\n", p);
    const auto add = [&](double cycle, const LoadPoint& point) {
      figure.add("{} {} {}\n", cycle, prefixes[p].factor * point.simulated, prefixes[p].factor * point.model);
    };
    for (const LoadPoint& point : loads[p].points) add(point.cycle, point);
    add(loads[p].points.front().cycle + 1.0, loads[p].points.front());
    figure.add("END\n");
  }
  figure.add("set multiplot\nset lmargin at screen {}\nset rmargin at screen {}\nset xrange [0:1]\nset xtics 0.25\n",
             left, right);
  for (std::size_t p = 0; p < loads.size(); ++p) {
    if (p > 0) figure.next_panel();
    const LoadPrefix& prefix = prefixes[p];
    const double top = 1.0 - (head + gap + (each + gap) * double(p)) / inches, bottom = top - each / inches;
    double low = 0.0, high = 0.0;
    for (const LoadPoint& point : loads[p].points) {
      low = std::min({low, prefix.factor * point.simulated, prefix.factor * point.model});
      high = std::max({high, prefix.factor * point.simulated, prefix.factor * point.model});
    }
    const double room = 0.06 * (high - low);
    const AxisMarks marks(low - (low < 0.0 ? room : 0.0), high + room, each, true, false);
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n{}\n", top, bottom, marks.commands("y"));
    figure.text(load_panel_title(loads[p].quantity), style::heading_size,
                fmt::format("screen {},{} left", left, top + 0.09 / inches));
    axis_title(figure, fmt::format("{}{}", prefix.name, loads[p].quantity == LoadQuantity::lift ? "N" : "N m"),
               style::text_size, each, 0.1 / format.width, 0.5 * (top + bottom));
    if (p == 0) {
      page_title(figure, title, 0.12);
      key.draw(figure, left * format.width, key_top);
      figure.text("time over the period", style::text_size,
                  fmt::format("screen {},{} center", 0.5 * (left + right), 0.1 / inches));
    }
    figure.add("set format x '{}'\nplot 0 with lines dt 1 lw 0.4 lc rgb '#c0c0c0', ",
               p + 1 == loads.size() ? "%g" : "");
    const LoadDisagreement& d = loads[p].disagreement;
    constexpr double shown_mean = 0.05;  // of the root mean square: others lie on the axis
    if (std::abs(d.mean_simulated) > shown_mean * d.rms_simulated) {
      figure.add("{} with lines {}, {} with lines {}, ", prefix.factor * d.mean_simulated, mean_simulated,
                 prefix.factor * d.mean_model, mean_model);
    }
    figure.add("$d{0} using 1:3 with lines {1}, $d{0} using 1:2 with points {2}\n", p, model, points);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat

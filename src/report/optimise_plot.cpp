#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/sweep_scales.hpp"
#include "wingbeat/report/optimise_report.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

double share(const OptimisedParameter& p, double x) {
  return p.logarithmic ? std::log(x / p.lower) / std::log(p.upper / p.lower) : (x - p.lower) / (p.upper - p.lower);
}

}  // namespace

void plot_optimum(const OptimiseFile& file, const MotorTrial& trial, PlotFormat format,
                  const std::filesystem::path& output) {
  const OptimiseStudy& study = file.study;
  const OptimiseResult& r = trial.result;
  const MetricInfo& objective = metric_info(study.objective);
  const bool walks = !r.directions.empty(), searches = !r.searches.empty();
  const double rows = 0.2 * double(study.parameters.size()), panel = 1.3;
  const double bounds_top = 0.72 + (searches ? panel + 0.75 : 0.0), walks_top = bounds_top + rows + 0.85;
  const double inches = walks ? walks_top + panel + 0.55 : bounds_top + rows + 0.55;
  Figure figure(format, inches);
  const auto y = [&](double from_top) { return 1.0 - from_top / inches; };
  double largest = 0.0;
  for (const SearchEnd& s : r.searches) {
    for (const double x : {s.began, s.ended}) largest = std::isfinite(x) ? std::max(largest, std::abs(x)) : largest;
  }
  const Display display = display_of(study.objective, largest);
  const std::string chosen = name_of(file, trial);
  figure.add("set multiplot\nset rmargin at screen 0.94\nset datafile missing 'nan'\n");
  const std::string title = file.title.empty() ? "Optimum" : file.title;
  page_title(figure, title, 0.12);
  if (!chosen.empty()) {
    fitted_text(figure, chosen, 7.0, format.width - 2.0 * page_margin, 0.5 * format.width, 0.28, "center");
  }
  int marks = 900;
  const auto mark = [&](double x, double from_top, const char* style, const std::string& name) {
    figure.add("set label {} '' at screen {},{} point {}\n", ++marks, x, y(from_top), style);
    figure.text(name, style::text_size, fmt::format("screen {},{} left", x + 0.02, y(from_top)));
  };
  const char *begun = "pt 6 ps 0.5 lw 1.6 lc rgb '#707070'", *ended = "pt 7 ps 0.5 lc rgb '#000000'";

  if (searches) {
    figure.add("$searches << END\n");
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t n = 0; n < r.searches.size(); ++n) {
      const SearchEnd& s = r.searches[n];
      figure.add("{} {} {}\n", n + 1, display.factor * s.began, display.factor * s.ended);
      for (const double x : {display.factor * s.began, display.factor * s.ended}) {
        if (!std::isfinite(x)) continue;
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    const double margin = std::max(0.08 * (high - low), 1e-6 * std::abs(high));
    figure.add("END\nset lmargin at screen 0.2\nset tmargin at screen {}\nset bmargin at screen {}\n", y(0.62),
               y(0.62 + panel));
    figure.add("set xrange [0:{}]\nset yrange [{}:{}]\n", r.searches.size() + 1, low - margin, high + margin);
    mark(0.22, 0.46, begun, "where a search began");
    mark(0.6, 0.46, ended, "where it ended");
    figure.text("local search", 7.0, fmt::format("screen 0.58,{} center", y(0.62 + panel + 0.33)));
    axis_title(figure, objective.long_name + display.in_brackets(), style::text_size, panel + 0.9,
               0.2 - 0.6 / format.width, y(0.62 + 0.5 * panel));
    figure.add("plot $searches using 1:2 with points {}, $searches using 1:3 with points {}\n", begun, ended);
    figure.next_panel();
  }

  // Each parameter between its bounds: where the optimum is, and how far the free directions reach.
  figure.add("set lmargin at screen 0.46\nset tmargin at screen {}\nset bmargin at screen {}\n", y(bounds_top),
             y(bounds_top + rows));
  figure.add("set xrange [-0.02:1.02]\nset yrange [{}:0.5]\nunset ytics\nset border 1\n",
             0.5 - double(study.parameters.size()));
  if (!study.parameters.empty()) {
    figure.add("$optimum << END\n");
    for (std::size_t k = 0; k < study.parameters.size(); ++k) {
      const OptimisedParameter& p = study.parameters[k];
      double low = share(p, r.parameters[k]), high = low;
      for (const FlatDirection& d : r.directions) {
        for (const double x : {d.from[k], d.to[k]}) {
          low = std::min(low, share(p, x));
          high = std::max(high, share(p, x));
        }
      }
      figure.add("{} {} {} {}\n", share(p, r.parameters[k]), -double(k), low, high);
    }
    figure.add("END\n");
    for (std::size_t k = 0; k < study.parameters.size(); ++k) {
      const double row = bounds_top + rows * (double(k) + 0.5) / double(study.parameters.size());
      fitted_text(figure, words(study.parameters[k].parameter.key), style::text_size, 0.42 * format.width,
                  0.44 * format.width, row, "right");
    }
    figure.text(fmt::format("optimum between its bounds; bar: within {:g} % of it", 100.0 * flat_loss),
                style::text_size, fmt::format("screen 0.5,{} center", y(bounds_top - 0.12)));
    figure.text("share of the bounds", 7.0, fmt::format("screen 0.71,{} center", y(bounds_top + rows + 0.33)));
    figure.add(
        "plot $optimum using 3:2:($4-$3):(0) with vectors nohead lw 5 lc rgb '#cfcfcf', "
        "$optimum using 1:2 with points {}\n",
        ended);
  }

  if (walks) {
    static constexpr const char* colours[] = {"#000000", "#707070", "#653a92", "#b79fd0"};
    const std::size_t drawn = std::min<std::size_t>(4, r.directions.size());
    figure.next_panel();
    figure.add("set lmargin at screen 0.2\nset tmargin at screen {}\nset bmargin at screen {}\n", y(walks_top),
               y(walks_top + panel));
    figure.add("set border 3\nset ytics nomirror out scale 0.5\nset autoscale x\nset yrange [{}:{}]\n",
               -5.0 * flat_loss, 110.0 * flat_loss);
    const double best = r.point.metrics[study.objective];
    std::string plot;
    double reach = 0.0;
    for (std::size_t d = 0; d < drawn; ++d) {
      for (const FlatDirection::Step& s : r.directions[d].walk) reach = std::max(reach, std::abs(s.distance));
    }
    // Three or four tics on either side would run into each other.
    if (reach > 0.0) {
      const double power = std::pow(10.0, std::floor(std::log10(reach)));
      figure.add("set xtics {}\n", reach / power >= 4.0 ? 4.0 * power : reach / power >= 2.0 ? 2.0 * power : power);
    }
    for (std::size_t d = 0; d < drawn; ++d) {
      figure.add("$walk{} << END\n", d);
      for (const FlatDirection::Step& s : r.directions[d].walk) {
        const double loss = (study.maximise ? best - s.objective : s.objective - best) / std::abs(best);
        figure.add("{} {}\n", s.distance, 100.0 * loss);
      }
      figure.add("END\n");
      plot += fmt::format("{}$walk{} using 1:2 with lines dt {} lw 1.1 lc rgb '{}'", d == 0 ? "" : ", ", d, d + 1,
                          colours[d]);
      figure.key_entry(0.06 + 0.235 * double(d), y(walks_top - 0.12),
                       fmt::format("dt {} lw 1.1 lc rgb '{}'", d + 1, colours[d]), fmt::format("direction {}", d + 1));
    }
    figure.text("distance along a free direction (ranges of the bounds)", 7.0,
                fmt::format("screen 0.58,{} center", y(walks_top + panel + 0.33)));
    figure.text("objective worse by (%)", style::text_size,
                fmt::format("screen {},{} center rotate by 90", 0.2 - 0.6 / format.width, y(walks_top + 0.5 * panel)));
    figure.add("plot {}\n", plot);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), output);
}

}  // namespace wingbeat

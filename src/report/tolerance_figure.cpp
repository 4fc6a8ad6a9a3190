#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/sweep_scales.hpp"
#include "wingbeat/report/tolerance_report.hpp"

namespace wingbeat {

void plot_tolerance(const ToleranceStudy& study, const SweepColumns& columns, const ToleranceOutput& output,
                    PlotFormat format, const std::filesystem::path& file) {
  std::vector<double> values;
  const auto all = samples_of(study, columns, *output.metric);
  std::size_t outside = 0;
  for (std::size_t n = 0; n < all.size(); ++n) {
    if (!std::isfinite(all[n])) continue;
    if (columns.counts(n, study.allow_extrapolation)) values.push_back(all[n]);
    else ++outside;
  }
  std::sort(values.begin(), values.end());
  const Display display = display_of(*output.metric, std::max(std::abs(values.front()), std::abs(values.back())));
  for (double& x : values) x *= display.factor;
  const double linear_mean = display.factor * output.linear_mean,
               linear_deviation = display.factor * output.linear_deviation;
  // Freedman and Diaconis, 1981; the few samples beyond the drawn range are in the tails.
  const auto quantile = [&](double p) { return values[std::size_t(p * double(values.size() - 1))]; };
  const double low = quantile(0.001), high = quantile(0.999);
  double width = 2.0 * (quantile(0.75) - quantile(0.25)) / std::cbrt(double(values.size()));
  if (!(width > (high - low) / 200.0)) width = (high - low) / 50.0;
  const int bins = std::max(1, int(std::ceil((high - low) / width)));
  std::vector<double> counts(std::size_t(bins), 0.0);
  for (const double x : values) {
    if (x >= low && x <= high) ++counts[std::min(std::size_t(bins - 1), std::size_t((x - low) / width))];
  }

  const auto inputs = factors(study);
  std::vector<std::size_t> order;
  const bool sobol = output.indices && output.indices->rows > 1;
  const auto weight = [&](std::size_t i) {
    if (sobol) return output.indices->inputs[i].total;
    return output.linear_share.empty() || inputs[i].choice ? 0.0 : output.linear_share[i];
  };
  for (std::size_t i = 0; i < inputs.size(); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight(a) > weight(b); });
  const bool linear = linear_deviation > 0.0;
  const bool sources = sobol || !output.linear_share.empty();

  const double rows_height = sources ? 0.24 * double(inputs.size()) : 0.0;
  const double inches = 2.55 + (sources ? 0.95 + rows_height : 0.0);
  Figure figure(format, inches);
  const auto y = [&](double from_top) { return 1.0 - from_top / inches; };
  figure.add("$bins << END\n");
  double highest = 0.0;
  for (int b = 0; b < bins; ++b) {
    const double density = counts[std::size_t(b)] / (double(values.size()) * width);
    highest = std::max(highest, density);
    figure.add("{} {}\n", low + (b + 0.5) * width, density);
  }
  figure.add("END\nset multiplot\nset lmargin at screen 0.07\nset rmargin at screen 0.97\n");
  figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", y(0.62), y(2.1));
  const std::string title = study.title.empty() ? "Tolerance" : study.title;
  page_title(figure, title, 0.12);
  std::string drawn = fmt::format("{} vehicles that flap", values.size());
  if (outside > 0) drawn += fmt::format(" ({} outside the domain left out)", outside);
  figure.key_entry(0.07, y(0.32), "lw 5 lc rgb '#cfcfcf'", drawn);
  if (linear)
    figure.key_entry(
        0.07, y(0.48), style::second_curve,
        study.choices.empty() ? "linear prediction from the gradient" : "linear prediction, most likely models");
  if (output.metric == Metric::lift_to_weight) figure.key_entry(0.6, y(0.32), style::reference_line, "hover");
  const MetricInfo& info = metric_table()[std::size_t(*output.metric)];
  figure.text(info.long_name + display.in_brackets(), 7.5, fmt::format("screen 0.52,{} center", y(2.42)));
  double left = low, right = high;
  if (linear) {
    left = std::min(left, linear_mean - 3.0 * linear_deviation);
    right = std::max(right, linear_mean + 3.0 * linear_deviation);
    highest = std::max(highest, 0.4 / linear_deviation);
  }
  const bool one_inside = output.metric == Metric::lift_to_weight && left < 1.0 && right > 1.0;
  figure.add("unset ytics\nset border 1\nset xrange [{}:{}]\nset yrange [0:{}]\n", left, right, 1.08 * highest);
  figure.add("set style fill solid 1.0 noborder\n");
  if (one_inside) figure.add("set arrow 900 from 1,graph 0 to 1,graph 1 nohead front {}\n", style::reference_line);
  figure.add("set samples 400\nplot $bins using 1:2:({}) with boxes lc rgb '#cfcfcf'", width);
  if (linear) {
    figure.add(", exp(-0.5*((x-{0})/{1})**2)/({1}*sqrt(2*pi)) with lines {2}", linear_mean, linear_deviation,
               style::second_curve);
  }
  figure.add("\n");
  if (sources) {
    figure.next_panel();
    const double top = 2.98, bottom = top + rows_height;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\nset lmargin at screen 0.46\n", y(top), y(bottom));
    figure.text("share of the variance", 7.5, fmt::format("screen 0.07,{} left", y(top - 0.14)));
    figure.text("first order", style::text_size, fmt::format("screen 0.49,{} left", y(top - 0.14)));
    figure.text("total", style::text_size, fmt::format("screen 0.67,{} left", y(top - 0.14)));
    figure.text("linear", style::text_size, fmt::format("screen 0.82,{} left", y(top - 0.14)));
    figure.add(
        "set label 901 '' at screen 0.475,{0} point pt 7 ps 0.45 lc rgb '#000000'\n"
        "set label 902 '' at screen 0.655,{0} point pt 5 ps 0.45 lc rgb '#707070'\n"
        "set label 903 '' at screen 0.805,{0} point pt 8 ps 0.6 lc rgb '#000000'\n",
        y(top - 0.14));
    figure.add("$sources << END\n");
    double max_share = 0.1;
    for (std::size_t r = 0; r < order.size(); ++r) {
      const std::size_t i = order[r];
      const SobolIndex none{absent, absent, absent, absent, absent, absent};
      const SobolIndex s = sobol ? output.indices->inputs[i] : none;
      figure.add("{} {} {} {} {} {} {} {}\n", -double(r), s.first, s.first_lower, s.first_upper, s.total, s.total_lower,
                 s.total_upper, output.linear_share.empty() ? absent : output.linear_share[i]);
      for (const double x : {s.first_upper, s.total_upper, weight(i)}) {
        if (std::isfinite(x)) max_share = std::max(max_share, x);
      }
    }
    figure.add("END\n");
    for (std::size_t r = 0; r < order.size(); ++r) {
      const double row = top + rows_height * (double(r) + 0.5) / double(order.size());
      fitted_text(figure, words(inputs[order[r]].name), style::text_size, 0.42 * format.width, 0.44 * format.width, row,
                  "right");
    }
    figure.add("set xrange [{}:{}]\nset yrange [{}:0.5]\nset border 3\nset datafile missing 'nan'\n", -0.03 * max_share,
               1.04 * max_share, 0.5 - double(order.size()));
    figure.add(
        "plot $sources using 2:($1+0.22):3:4 with xerrorbars pt 7 ps 0.45 lc rgb '#000000', "
        "$sources using 5:1:6:7 with xerrorbars pt 5 ps 0.45 lc rgb '#707070', "
        "$sources using 8:($1-0.22) with points pt 8 ps 0.6 lc rgb '#000000'\n");
  }

  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat

#include "wingbeat/report/sweep_plot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/sweep_scales.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {
namespace {

constexpr std::uint64_t max_designs_drawn = 4000000;
constexpr std::size_t max_panels = 4;

}  // namespace

std::vector<Metric> metrics_to_plot(const Study& study, std::span<const std::string> names, const std::string& option) {
  const auto refuse = [&](const std::string& reason) { throw InputError(option, 0, 0, "", reason); };
  const Sweep& sweep = study.sweep;
  std::uint64_t curves = 1;
  int numbers = 0;
  for (const SweepAxis& axis : sweep.axes) {
    if (axis.samples) refuse("samples have no order to be drawn in; plots are of axes");
    if (makes_curves(sweep, axis)) curves *= axis.count;
    else ++numbers;
  }
  if (numbers < 1 || numbers > 2) {
    refuse(fmt::format("the study has {} axes of numbers; plots have one or two", numbers));
  }
  if (numbers == 1 && curves > max_curves) {
    refuse(fmt::format("the choices make {} curves; a plot has at most {}", curves, max_curves));
  }
  if (numbers == 2 && curves > 1) refuse("contours of two axes leave no room for choices; sweep them one by one");
  if (sweep.size() > max_designs_drawn) refuse("more than 4,000,000 designs are not drawn");

  std::vector<Metric> metrics;
  for (const std::string& name : names) {
    const int index = metric_index(name);
    if (index == metric_count || !sweep.options.metrics[std::size_t(index)]) {
      std::vector<std::string_view> kept;
      for (int m = 0; m < metric_count; ++m) {
        if (sweep.options.metrics[std::size_t(m)]) kept.push_back(metric_info(Metric(m)).key);
      }
      refuse(fmt::format("{} is not among the study's metrics: {}", in_quotes(name), fmt::join(kept, ", ")));
    }
    metrics.push_back(Metric(index));
  }
  if (metrics.size() > max_panels) refuse(fmt::format("at most {} metrics are drawn", max_panels));
  if (!metrics.empty()) return metrics;
  for (const Metric m : {Metric::lift_mean, Metric::efficiency_system}) {
    if (sweep.options.metrics[std::size_t(m)]) metrics.push_back(m);
  }
  for (int m = 0; m < metric_count && metrics.empty(); ++m) {
    if (sweep.options.metrics[std::size_t(m)]) metrics.push_back(Metric(m));
  }
  return metrics;
}

void plot_sweep(const Study& study, const std::filesystem::path& data_set, std::span<const Metric> metrics,
                PlotFormat format, const std::filesystem::path& file) {
  const NetcdfReader reader(data_set);
  const auto numbers = std::count_if(study.sweep.axes.begin(), study.sweep.axes.end(),
                                     [&](const SweepAxis& axis) { return !makes_curves(study.sweep, axis); });
  const std::vector<double> status = reader.read("status");
  const bool nothing = std::none_of(status.begin(), status.end(), [](double s) { return s == 0.0; });
  if (numbers == 1 && nothing) {
    plot_idle_lines(study, status, format, file);
  } else if (numbers == 1) {
    plot_lines(study, reader, metrics, format, file);
  } else {
    plot_contours(study, reader, metrics, format, file);
  }
}

}  // namespace wingbeat

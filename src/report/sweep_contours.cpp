#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "report/contour_lines.hpp"
#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/read_out.hpp"
#include "report/sweep_scales.hpp"
#include "report/sweep_status_plot.hpp"

namespace wingbeat {
namespace {

/// Round numbers, about nine steps apart, that enclose both.
std::vector<double> levels_between(double least, double highest) {
  if (!(highest > least)) highest = least + std::max(std::abs(least), 1.0) * 1e-3;
  const double rough = (highest - least) / 9.0;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * decade;
  for (const double nice : {5.0, 2.5, 2.0, 1.0}) {
    if (nice * decade >= 0.999 * rough) step = nice * decade;
  }
  std::vector<double> levels;
  for (double k = std::floor(least / step); k * step < highest + 0.999 * step; ++k) levels.push_back(k * step);
  return levels;
}

/// From dark to light with evenly growing lightness (viridis, five points of it).
std::string colour(double share) {
  constexpr std::array<std::array<double, 3>, 5> points = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double position = std::clamp(share, 0.0, 1.0) * 4.0;
  const std::size_t k = std::min<std::size_t>(3, std::size_t(position));
  const double t = position - double(k);
  int rgb[3];
  for (std::size_t c = 0; c < 3; ++c) rgb[c] = int(std::lround((1.0 - t) * points[k][c] + t * points[k + 1][c]));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

/// The data set's values, with both coordinates growing.
struct Arrangement {
  std::vector<std::size_t> x, y;  ///< places along the axes in growing order
  std::size_t index(std::size_t i, std::size_t j, std::size_t count_y) const { return x[i] * count_y + y[j]; }
};

/// The designs of a panel for its read-out, of very many every few.
ReadOutPanel contour_points(const Scale& x, const Scale& y, const Field& field, const std::vector<double>& status,
                            const std::vector<double>& domain) {
  constexpr std::size_t max_points = 150;  // along an axis
  const std::size_t nx = x.values.size(), ny = y.values.size();
  const std::size_t every_x = (nx + max_points - 1) / max_points, every_y = (ny + max_points - 1) / max_points;
  const auto [x_low, x_high] = std::minmax_element(x.values.begin(), x.values.end());
  const auto [y_low, y_high] = std::minmax_element(y.values.begin(), y.values.end());
  ReadOutPanel panel{};
  panel.name = field.label();
  panel.columns = {{x.name, x.display.unit, {}},
                   {y.name, y.display.unit, {}},
                   {metric_info(field.metric).long_name, field.display.unit, {}}};
  for (std::size_t i = 0; i < nx; i += every_x) {
    for (std::size_t j = 0; j < ny; j += every_y) {
      const std::size_t n = i * ny + j;
      panel.x.push_back(share_of_axis(x.values[i], *x_low, *x_high, x.logarithmic));
      panel.y.push_back(share_of_axis(y.values[j], *y_low, *y_high, y.logarithmic));
      panel.columns[0].values.push_back(x.values[i]);
      panel.columns[1].values.push_back(y.values[j]);
      panel.columns[2].values.push_back(field.values[n]);
      panel.notes.push_back(design_note(int(status[n]), unsigned(domain[n])));
    }
  }
  return panel;
}

std::vector<std::size_t> growing(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) { return values[p] < values[q]; });
  return order;
}

}  // namespace

void plot_contours(const Study& study, const NetcdfReader& file, std::span<const Metric> metrics, PlotFormat format,
                   const std::filesystem::path& output) {
  std::vector<const SweepAxis*> axes;
  for (const SweepAxis& axis : study.sweep.axes) {
    if (!makes_curves(study.sweep, axis)) axes.push_back(&axis);
  }
  const Scale x(*axes[0]), y(*axes[1]);
  const std::size_t ny = y.values.size();
  const Arrangement order{growing(x.values), growing(y.values)};
  ContourGrid base;
  for (const std::size_t i : order.x) base.x.push_back(x.values[i]);
  for (const std::size_t j : order.y) base.y.push_back(y.values[j]);
  base.log_x = x.logarithmic;
  base.log_y = y.logarithmic;
  const auto gridded = [&](const auto& value_at) {
    ContourGrid grid = base;
    for (std::size_t i = 0; i < order.x.size(); ++i) {
      for (std::size_t j = 0; j < order.y.size(); ++j) grid.z.push_back(value_at(order.index(i, j, ny)));
    }
    return grid;
  };

  const std::vector<double> status = file.read("status"), domain = file.read("domain");
  const bool extrapolates = study.sweep.allow_extrapolation;
  const auto outside = [&](std::size_t n) { return domain[n] != 0.0; };
  const bool leaves = std::any_of(domain.begin(), domain.end(), [](double d) { return d != 0.0; });
  const auto flaps = [&](std::size_t n) { return status[n] == 0.0; };
  const std::vector<double> weight = lift_over_weight(study.sweep, file);
  const bool weighed = std::any_of(weight.begin(), weight.end(), [](double w) { return std::isfinite(w); });
  bool carried = false;
  for (std::size_t n = 0; n < weight.size(); ++n) {
    carried = carried || (weight[n] >= 1.0 && (extrapolates || !outside(n)));
  }
  const bool all_flap = std::all_of(status.begin(), status.end(), [](double s) { return s == 0.0; });

  std::string note = all_flap ? "" : fmt::format("grey: {}", without_numbers(study.sweep));
  if (carried) note += fmt::format("{}dashed: lift = weight, best sought above", note.empty() ? "" : "; ");
  if (leaves) {
    note += fmt::format("{}hatched: outside the model's domain{}", note.empty() ? "" : "; ",
                        extrapolates ? "" : ", no best there");
  }
  if (weighed && !carried) note += fmt::format("{}lift < weight everywhere", note.empty() ? "" : "; ");
  const std::vector<std::string> remarks = remark_lines(note, format.width);
  const double head = 0.52, panel = 2.05, gap = 0.84, foot = 0.58 + remarks_height(remarks);
  const double inches = head + double(metrics.size()) * panel + double(metrics.size() - 1) * gap + foot;
  Figure figure(format, inches);
  constexpr double left = 0.135, right = 0.83;
  ContourGrid idle = gridded([&](std::size_t n) { return flaps(n) ? 0.0 : 1.0; });
  smooth(idle);
  add_filled(figure, "idle", boundaries(idle, 0.5));
  add_outline(figure, "idle_outline", base, boundaries(idle, 0.5));
  if (leaves) {
    ContourGrid beyond = gridded([&](std::size_t n) { return outside(n) ? 1.0 : 0.0; });
    smooth(beyond);
    add_filled(figure, "outside", boundaries(beyond, 0.5));
    add_outline(figure, "outside_outline", base, boundaries(beyond, 0.5));
  }
  if (carried) {
    const ContourGrid lifted = gridded([&](std::size_t n) { return flaps(n) ? weight[n] : 0.0; });
    add_outline(figure, "feasible", base, boundaries(lifted, 1.0));
  }

  figure.add("set multiplot\n{}{}", x.range("x"), y.range("y"));
  figure.add("set lmargin at screen {}\nset rmargin at screen {}\nset border 15\nset grid noxtics noytics front\n",
             left, right);
  std::vector<ReadOutPanel> pages;
  for (std::size_t p = 0; p < metrics.size(); ++p) {
    if (p > 0) figure.next_panel();
    figure.add("unset object\n");
    const Field field(file, metrics[p]);
    double least = std::numeric_limits<double>::infinity(), highest = -least;
    for (const double value : field.values) {
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      highest = std::max(highest, value);
    }
    const SweepBest found = best_of(field, weight, domain, extrapolates);
    const std::size_t best = found.design() ? std::size_t(found.design()->index) : status.size();
    const double top = 1.0 - (head + double(p) * (panel + gap)) / inches;
    const double bottom = top - panel / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", top, bottom);
    if (p == 0) {
      page_title(figure, title_of(study), 0.11);
    }
    figure.text(field.label(), 7.5, fmt::format("screen {},{} left", left, top + 0.22 / inches));
    figure.text(x.label(), 7.5, fmt::format("screen {},{} center", 0.5 * (left + right), bottom - 0.39 / inches));
    axis_title(figure, y.label(), 7.5, panel + 0.5 * gap, left - 0.39 / format.width, 0.5 * (top + bottom));

    std::string drawn;
    if (std::isfinite(least)) {
      const std::vector<double> levels = levels_between(least, highest);
      ContourGrid grid = gridded([&](std::size_t n) { return field.values[n]; });
      extend(grid);
      const std::size_t bands = levels.size() - 1;
      const auto shade = [&](std::size_t band) { return colour(bands > 1 ? double(band) / double(bands - 1) : 0.5); };
      for (std::size_t band = 0; band < bands; ++band) {
        const std::string name = fmt::format("band_{}_{}", p, band);
        add_filled(figure, name, boundaries(grid, band == 0 ? -1e300 : levels[band]));
        drawn += fmt::format("${} using 1:2 with filledcurves closed fs solid 1.0 noborder lc rgb '{}', ", name,
                             shade(band));
        const double from = bottom + (top - bottom) * double(band) / double(bands);
        const double to = bottom + (top - bottom) * double(band + 1) / double(bands);
        figure.box(
            fmt::format("from screen {},screen {} to screen {},screen {}", right + 0.025, from, right + 0.06, to),
            shade(band).c_str());
      }
      const std::size_t every = bands > 8 ? 2 : 1;
      for (std::size_t k = 0; k < levels.size(); k += every) {
        const double height_on_page = bottom + (top - bottom) * double(k) / double(bands);
        const double start = (right + 0.068) * format.width;
        fitted_text(figure, fmt::format("{:.6g}", std::abs(levels[k]) < 1e-9 * (highest - least) ? 0.0 : levels[k]),
                    style::text_size, format.width - start - 0.02, start, (1.0 - height_on_page) * inches, "left");
      }
    }
    drawn +=
        "$idle using 1:2 with filledcurves closed fs solid 1.0 noborder lc rgb '#e4e4e4', "
        "$idle_outline using 1:2 with lines dt 1 lw 0.8 lc rgb '#606060'";
    if (leaves) {
      drawn +=
          ", $outside using 1:2 with filledcurves closed fs transparent pattern 4 noborder lc rgb '#ffffff', "
          "$outside_outline using 1:2 with lines dt 1 lw 1.4 lc rgb '#ffffff', "
          "$outside_outline using 1:2 with lines dt 1 lw 0.7 lc rgb '#b00000'";
    }
    if (carried) {
      drawn +=
          ", $feasible using 1:2 with lines dt 1 lw 3.2 lc rgb '#ffffff', "
          "$feasible using 1:2 with lines dt (9,4) lw 1.5 lc rgb '#000000'";
    }
    if (!std::isfinite(least)) {
      std::vector<std::uint64_t> designs(sweep_status_count, 0);
      for (const double s : status) ++designs[std::size_t(s)];
      if (designs[0] == 0) {
        figure.text(nothing_flaps(designs), 7.0,
                    fmt::format("screen {},{} center", 0.5 * (left + right), 0.5 * (top + bottom)));
      }
    }
    if (best < status.size()) {
      figure.circle(x.values[best / ny], y.values[best % ny], 0.012, "fillcolor rgb '#ffffff' fillstyle solid",
                    "#000000");
      figure.circle(x.values[best / ny], y.values[best % ny], 0.003, "fillcolor rgb '#000000' fillstyle solid",
                    "#000000");
      const std::string found_at = fmt::format("circle: {} {} at {}, {}", field.superlative(),
                                               field.shown(field.values[best]), x.value(best / ny), y.value(best % ny));
      fitted_text(figure, found_at, style::text_size, (right - 0.02) * format.width, right * format.width,
                  (1.0 - top) * inches - 0.09, "right");
    }
    if (format == PlotFormat::html) {
      pages.push_back(contour_points(x, y, field, status, domain));
      ReadOutPanel& page = pages.back();
      page.left = left, page.right = right, page.top = 1.0 - top, page.bottom = 1.0 - bottom;
    }
    if (p + 1 == metrics.size()) draw_remarks(figure, remarks);
    figure.add("set grid noxtics noytics\nplot {}\n", drawn);
  }
  figure.add("unset multiplot\nunset output\n");
  write_figure(figure, format, title_of(study), pages, output);
}

}  // namespace wingbeat

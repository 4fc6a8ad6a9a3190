#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/read_out.hpp"
#include "report/sweep_scales.hpp"
#include "report/sweep_status_plot.hpp"

namespace wingbeat {
namespace {

/// "springs on, supply amplitude 3 V": the choices and numbers of one curve.
std::string curve_name(const Sweep& sweep, std::uint64_t index) {
  const auto place = places(sweep, index);
  std::string name;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const SweepAxis& axis = sweep.axes[a];
    if (!makes_curves(sweep, axis)) continue;
    if (is_number(axis)) {
      const Scale scale(axis);
      name += fmt::format("{}{} {}", name.empty() ? "" : ", ", scale.name, scale.value(place[a]));
      continue;
    }
    for (const SweptQuantity& q : axis.quantities) {
      if (q.kind != SweptQuantity::Kind::choice) continue;
      const bool says_itself = q.key == "condition" || q.key == "transmission.formulation";
      name +=
          fmt::format("{}{}{}", name.empty() ? "" : ", ", says_itself ? "" : words(q.key) + " ", q.labels[place[a]]);
    }
  }
  return name;
}

/// How a curve is drawn: springs, surroundings and an ordered number decide its colour, the formulation its dash.
struct CurveLook {
  const char *colour = nullptr, *dash = nullptr;
  std::string line() const { return style::stroke(colour, dash); }
};

CurveLook look_of(const Sweep& sweep, std::uint64_t index) {
  const auto place = places(sweep, index);
  CurveLook look;
  std::size_t rest = 0;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    const SweepAxis& axis = sweep.axes[a];
    if (!makes_curves(sweep, axis)) continue;
    const SweptQuantity& q = axis.quantities.front();
    const std::string label = q.kind == SweptQuantity::Kind::choice ? q.labels[place[a]] : "";
    if (q.key == "springs" && !look.colour) {
      look.colour = label == "on" ? style::with_springs : style::without_springs;
    } else if (q.key == "condition" && !look.colour) {
      look.colour = label == "air" ? style::in_air : label == "vacuum" ? style::in_vacuum : style::without_wings;
    } else if (q.key == "transmission.formulation" && !look.dash) {
      look.dash = label == "rod-force" ? style::solid : style::dashed;
    } else if (label.empty() && !look.colour) {
      look.colour = style::ordered[std::size_t(place[a]) * std::size(style::ordered) / std::size_t(axis.count)];
    } else {
      rest = rest * std::size_t(axis.count) + place[a];
    }
  }
  constexpr const char* dashes[] = {style::solid, style::dashed, style::dotted, style::dash_dotted};
  if (!look.dash) look.dash = dashes[rest % std::size(dashes)];
  if (!look.colour) look.colour = rest < std::size(dashes) ? style::ink : style::grey;
  return look;
}

/// The axis of numbers, how far designs lie apart along it, and the first design of each curve.
struct Curves {
  std::size_t along = 0;
  std::uint64_t stride = 1;
  std::vector<std::uint64_t> first;

  explicit Curves(const Sweep& sweep) {
    for (std::size_t a = sweep.axes.size(); a-- > 0;) {
      if (!makes_curves(sweep, sweep.axes[a])) along = a;
    }
    for (std::size_t a = along + 1; a < sweep.axes.size(); ++a) stride *= sweep.axes[a].count;
    for (std::uint64_t n = 0; n < sweep.size(); ++n) {
      if (places(sweep, n)[along] == 0) first.push_back(n);
    }
  }
};

/// The designs of a panel for its read-out: all curves at each place along the axis.
template <class NameOf>
ReadOutPanel line_points(const Scale& x, const std::vector<std::size_t>& order, const Field& field,
                         const std::vector<double>& domain, const Curves& curves, const NameOf& name_of_curve) {
  ReadOutPanel panel{};
  panel.name = field.label();
  panel.columns = {{x.name, x.display.unit, {}}};
  for (std::size_t c = 0; c < curves.first.size(); ++c) {
    panel.columns.push_back({name_of_curve(c), field.display.unit, {}});
  }
  for (const std::size_t n : order) {
    panel.x.push_back(share_of_axis(x.values[n], x.values[order.front()], x.values[order.back()], x.logarithmic));
    panel.columns[0].values.push_back(x.values[n]);
    std::string beyond;
    for (std::size_t c = 0; c < curves.first.size(); ++c) {
      const std::size_t design = curves.first[c] + n * curves.stride;
      panel.columns[c + 1].values.push_back(field.values[design]);
      if (domain[design] == 0.0) continue;
      const std::string name = curves.first.size() > 1 ? name_of_curve(c) + " " : "";
      beyond += fmt::format("{}{}{}", beyond.empty() ? "" : "; ", name, design_note(0, unsigned(domain[design])));
    }
    panel.notes.push_back(beyond);
  }
  return panel;
}

constexpr const char* outside_band = "#d0d0d0";

/// The parts of a curve that lie outside the domain, to halfway to the next design inside; `at` says of a design its
/// value and whether it is outside.
template <class At>
void add_outside(Figure& figure, const std::string& name, const Scale& x, const std::vector<std::size_t>& order,
                 const At& point_at) {
  figure.add("{} << END\n{} NaN\n", name, x.values[order.front()]);
  const auto halfway = [&](std::size_t k, std::size_t next) {
    const double a = x.values[order[k]], b = x.values[order[next]];
    const auto [value, out] = point_at(order[next]);
    if (!std::isfinite(value) || out) return;
    figure.add("{} {}\n", x.logarithmic ? std::sqrt(a * b) : 0.5 * (a + b), 0.5 * (point_at(order[k]).first + value));
  };
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto [value, out] = point_at(order[k]);
    if (!out || !std::isfinite(value)) {
      figure.add("{} NaN\n", x.values[order[k]]);
      continue;
    }
    if (k > 0) halfway(k, k - 1);
    figure.add("{} {}\n", x.values[order[k]], value);
    if (k + 1 < order.size()) halfway(k, k + 1);
  }
  figure.add("END\n");
}

}  // namespace

void plot_idle_lines(const Study& study, const std::vector<double>& status, PlotFormat format,
                     const std::filesystem::path& output) {
  const Curves layout(study.sweep);
  const Scale x(study.sweep.axes[layout.along]);
  std::vector<StatusCurve> curves;
  for (const std::uint64_t first : layout.first) {
    StatusCurve curve{curve_name(study.sweep, first), {}};
    for (std::size_t n = 0; n < x.values.size(); ++n) curve.status.push_back(int(status[first + n * layout.stride]));
    curves.push_back(std::move(curve));
  }
  plot_statuses(title_of(study), x.label(), x.range("x"), x.values, curves, format, output);
}

void plot_lines(const Study& study, const NetcdfReader& file, std::span<const Metric> metrics, PlotFormat format,
                const std::filesystem::path& output) {
  const Sweep& sweep = study.sweep;
  const Curves layout(sweep);
  const std::size_t along = layout.along;
  const std::uint64_t stride = layout.stride;
  const std::vector<std::uint64_t>& curves = layout.first;
  const Scale x(sweep.axes[along]);
  const std::size_t count = x.values.size();
  std::vector<std::size_t> order(count);
  for (std::size_t n = 0; n < count; ++n) order[n] = n;
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) { return x.values[p] < x.values[q]; });

  std::vector<CurveLook> looks;
  for (const std::uint64_t curve : curves) looks.push_back(look_of(sweep, curve));
  constexpr double left = 0.125, right = 0.965;
  std::vector<KeyEntry> named;
  for (std::size_t c = 0; curves.size() > 1 && c < curves.size(); ++c) {
    named.push_back(line_key(curve_name(sweep, curves[c]), looks[c].line()));
  }
  const Key key(std::move(named), (right - left) * format.width);
  const std::vector<double> weight = lift_over_weight(sweep, file);
  const std::vector<double> status = file.read("status"), domain = file.read("domain");
  const bool leaves = std::any_of(domain.begin(), domain.end(), [](double d) { return d != 0.0; });
  std::vector<Field> fields;
  std::vector<SweepBest> found;
  bool broken = false, carried = false;
  for (const Metric metric : metrics) {
    fields.emplace_back(file, metric);
    found.push_back(best_of(fields.back(), weight, domain, sweep.allow_extrapolation));
    carried = carried || (found.back().design() && found.back().carries_weight());
    for (const double y : fields.back().values) broken = broken || !std::isfinite(y);
  }
  std::string note = broken ? fmt::format("no line: {}", without_numbers(sweep)) : "";
  if (leaves) note += fmt::format("{}grey band: outside the model's domain", note.empty() ? "" : "; ");
  if (carried) note += fmt::format("{}best sought where lift ≥ weight", note.empty() ? "" : "; ");
  const std::vector<std::string> remarks = remark_lines(note, format.width);
  const double panel = 1.45, gap = 0.45, foot = 0.54 + remarks_height(remarks), head = 0.58 + key.height();
  const double inches = head + double(metrics.size()) * panel + double(metrics.size() - 1) * gap + foot;
  Figure figure(format, inches);
  for (std::size_t p = 0; p < metrics.size(); ++p) {
    const Field& field = fields[p];
    for (std::size_t c = 0; c < curves.size(); ++c) {
      figure.add("$curve_{}_{} << END\n", p, c);
      for (const std::size_t n : order) {
        const double y = field.values[curves[c] + n * stride];
        if (std::isfinite(y)) figure.add("{} {}\n", x.values[n], y);
        else figure.add("{} NaN\n", x.values[n]);
      }
      figure.add("END\n");
      add_outside(figure, fmt::format("$outside_{}_{}", p, c), x, order, [&](std::size_t n) {
        const std::size_t design = curves[c] + n * stride;
        return std::pair{field.values[design], domain[design] != 0.0};
      });
      // A design that flaps between two that do not would leave no line.
      figure.add("$lone_{}_{} << END\n{} NaN\n", p, c, x.values[order.front()]);
      for (std::size_t k = 0; k < count; ++k) {
        const auto flaps = [&](std::size_t j) {
          return j < count && std::isfinite(field.values[curves[c] + order[j] * stride]);
        };
        if (flaps(k) && !flaps(k - 1) && !flaps(k + 1)) {
          figure.add("{} {}\n", x.values[order[k]], field.values[curves[c] + order[k] * stride]);
        }
      }
      figure.add("END\n");
    }
  }
  figure.add("set multiplot\n{}", x.range("x"));
  figure.add("set lmargin at screen {}\nset rmargin at screen {}\n", left, right);
  page_title(figure, title_of(study), 0.11);
  key.draw(figure, left * format.width, 0.235);
  std::vector<ReadOutPanel> pages;
  for (std::size_t p = 0; p < metrics.size(); ++p) {
    if (p > 0) figure.next_panel();
    figure.add("unset object\n");
    const Field& field = fields[p];
    const double top = 1.0 - (head + double(p) * (panel + gap)) / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\nset format x {}\n", top, top - panel / inches,
               p + 1 == metrics.size() ? "'%g'" : "''");
    figure.text(field.label(), 7.5, fmt::format("screen {},{} left", left, top + 0.22 / inches));
    if (format == PlotFormat::html) {
      pages.push_back(line_points(x, order, field, domain, layout, [&](std::size_t c) {
        return curves.size() > 1 ? curve_name(sweep, curves[c]) : metric_info(field.metric).long_name;
      }));
      ReadOutPanel& page = pages.back();
      page.left = left, page.right = right, page.top = 1.0 - top, page.bottom = 1.0 - top + panel / inches;
    }
    if (found[p].design()) {
      const std::uint64_t best = found[p].design()->index;
      const std::size_t index = std::size_t(places(sweep, best)[along]);
      const std::uint64_t first = best - index * stride;
      const std::size_t curve = std::size_t(std::find(curves.begin(), curves.end(), first) - curves.begin());
      fitted_text(
          figure,
          fmt::format("circle: {} {} at {}", field.superlative(), field.shown(field.values[best]), x.value(index)),
          style::text_size, (right - left) * format.width, right * format.width, (1.0 - top) * inches - 0.09, "right");
      figure.circle(x.values[index], field.values[best], 0.01, "fillstyle empty", looks[curve].colour);
    }
    if (p + 1 == metrics.size()) {
      const double below = remarks_height(remarks) + 0.14;
      figure.text(x.label(), 7.5, fmt::format("screen {},{} center", 0.5 * (left + right), below / inches));
      draw_remarks(figure, remarks);
    }
    std::string curves_drawn;
    // Bands lie behind every curve.
    for (std::size_t c = 0; leaves && c < curves.size(); ++c) {
      curves_drawn += fmt::format("$outside_{0}_{1} using 1:2 with lines {2} title 'curve|outside {1}', ", p, c,
                                  style::stroke(outside_band, style::solid, 8.0));
    }
    for (std::size_t c = 0; c < curves.size(); ++c) {
      curves_drawn += fmt::format(
          "{}$curve_{}_{} using 1:2 with lines {}, $lone_{}_{} using 1:2 with points pt 7 ps 0.2 lc rgb '{}'",
          c == 0 ? "" : ", ", p, c, looks[c].line(), p, c, looks[c].colour);
    }
    double least = INFINITY, highest = -INFINITY;
    for (const double y : field.values) {
      if (!std::isfinite(y)) continue;
      least = std::min(least, y);
      highest = std::max(highest, y);
    }
    const bool from_zero = least >= 0.0 && least < 0.6 * highest;
    figure.add("set yrange [{}:*]\nset offsets 0,0,graph 0.06,0\nplot {}\n", from_zero ? "0" : "*", curves_drawn);
  }
  figure.add("unset multiplot\nunset output\n");
  write_figure(figure, format, title_of(study), pages, output);
}

}  // namespace wingbeat

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "report/figure.hpp"
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

}  // namespace

void plot_idle_lines(const Study& study, const std::vector<double>& status, PlotFormat format,
                     const std::filesystem::path& output) {
  const Curves of(study.sweep);
  const Scale x(study.sweep.axes[of.along]);
  std::vector<StatusCurve> curves;
  for (const std::uint64_t first : of.first) {
    StatusCurve curve{curve_name(study.sweep, first), {}};
    for (std::size_t n = 0; n < x.at.size(); ++n) curve.status.push_back(int(status[first + n * of.stride]));
    curves.push_back(std::move(curve));
  }
  plot_statuses(title_of(study), x.label(), x.range("x"), x.at, curves, format, output);
}

void plot_lines(const Study& study, const NetcdfReader& file, std::span<const Metric> metrics, PlotFormat format,
                const std::filesystem::path& output) {
  const Sweep& sweep = study.sweep;
  const Curves of(sweep);
  const std::size_t along = of.along;
  const std::uint64_t stride = of.stride;
  const std::vector<std::uint64_t>& curves = of.first;
  const Scale x(sweep.axes[along]);
  const std::size_t count = x.at.size();
  std::vector<std::size_t> order(count);
  for (std::size_t n = 0; n < count; ++n) order[n] = n;
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) { return x.at[p] < x.at[q]; });

  std::vector<CurveLook> looks;
  for (const std::uint64_t curve : curves) looks.push_back(look_of(sweep, curve));
  const bool named = curves.size() > 1;
  // Two names beside each other where both fit.
  constexpr std::size_t half_a_line = 22;
  std::size_t beside = 2;
  for (const std::uint64_t curve : curves) {
    if (curve_name(sweep, curve).size() > half_a_line) beside = 1;
  }
  const double panel = 1.45, gap = 0.45, foot = 0.74;
  const double head = 0.58 + (named ? 0.15 * double((curves.size() + beside - 1) / beside) : 0.0);
  const double inches = head + double(metrics.size()) * panel + double(metrics.size() - 1) * gap + foot;
  Figure figure(format, 3.5, inches);
  constexpr double left = 0.125, right = 0.965;
  const std::vector<double> weight = lift_over_weight(sweep, file);
  bool broken = false, carried = false;
  const std::vector<double> status = file.read("status"), domain = file.read("domain");
  const auto inside = [&](std::uint64_t n) { return status[n] == 0.0 && domain[n] == 0.0; };
  // Places along the axis where some curve is outside the domain and none inside, as runs of `order`.
  std::vector<std::pair<std::size_t, std::size_t>> hatched;
  for (std::size_t k = 0; k < count; ++k) {
    const auto at = [&](std::uint64_t c) { return c + order[k] * stride; };
    const bool out = std::any_of(curves.begin(), curves.end(), [&](std::uint64_t c) { return domain[at(c)] != 0.0; }) &&
                     std::none_of(curves.begin(), curves.end(), [&](std::uint64_t c) { return inside(at(c)); });
    if (!out) continue;
    if (!hatched.empty() && hatched.back().second + 1 == k) hatched.back().second = k;
    else hatched.emplace_back(k, k);
  }
  const bool leaves = std::any_of(domain.begin(), domain.end(), [](double d) { return d != 0.0; });
  for (std::size_t p = 0; p < metrics.size(); ++p) {
    const Field field(file, metrics[p]);
    for (std::size_t c = 0; c < curves.size(); ++c) {
      figure.add("$curve_{}_{} << END\n", p, c);
      for (const std::size_t n : order) {
        const double y = field.values[curves[c] + n * stride];
        broken = broken || !std::isfinite(y);
        if (std::isfinite(y)) figure.add("{} {}\n", x.at[n], y);
        else figure.add("{} NaN\n", x.at[n]);
      }
      figure.add("END\n");
      figure.add("$outside_{}_{} << END\n{} NaN\n", p, c, x.at[order.front()]);
      for (const std::size_t n : order) {
        const std::size_t at = curves[c] + n * stride;
        if (domain[at] != 0.0 && std::isfinite(field.values[at])) figure.add("{} {}\n", x.at[n], field.values[at]);
      }
      figure.add("END\n");
      // A design that flaps between two that do not would leave no line.
      figure.add("$lone_{}_{} << END\n{} NaN\n", p, c, x.at[order.front()]);
      for (std::size_t k = 0; k < count; ++k) {
        const auto flaps = [&](std::size_t j) {
          return j < count && std::isfinite(field.values[curves[c] + order[j] * stride]);
        };
        if (flaps(k) && !flaps(k - 1) && !flaps(k + 1)) {
          figure.add("{} {}\n", x.at[order[k]], field.values[curves[c] + order[k] * stride]);
        }
      }
      figure.add("END\n");
    }
  }
  figure.add("set multiplot\n{}", x.range("x"));
  figure.add("set lmargin at screen {}\nset rmargin at screen {}\n", left, right);
  const double title_y = 1.0 - 0.11 / inches;
  figure.text(title_of(study), 8.0, fmt::format("screen 0.5,{} center", title_y));
  if (named) {
    for (std::size_t c = 0; c < curves.size(); ++c) {
      figure.key_entry(c % beside == 0 ? left : 0.56, title_y - (0.2 + 0.15 * double(c / beside)) / inches,
                       looks[c].line(), curve_name(sweep, curves[c]));
    }
  }
  for (std::size_t p = 0; p < metrics.size(); ++p) {
    if (p > 0) figure.next_panel();
    figure.add("unset object\n");
    for (std::size_t h = 0; h < hatched.size(); ++h) {
      const auto between = [&](std::size_t a, std::size_t b) {
        const double from = x.at[order[a]], to = x.at[order[b]];
        return x.logarithmic ? std::sqrt(from * to) : 0.5 * (from + to);
      };
      const auto [first, last] = hatched[h];
      figure.add(
          "set object {} rectangle from {},graph 0 to {},graph 1 behind fillcolor rgb '#909090' fillstyle transparent "
          "pattern 4 noborder\n",
          5000 + h, first == 0 ? x.at[order[0]] : between(first - 1, first),
          last + 1 == count ? x.at[order[last]] : between(last, last + 1));
    }
    const Field field(file, metrics[p]);
    const double top = 1.0 - (head + double(p) * (panel + gap)) / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\nset format x {}\n", top, top - panel / inches,
               p + 1 == metrics.size() ? "'%g'" : "''");
    figure.text(field.label(), 7.5, fmt::format("screen {},{} left", left, top + 0.22 / inches));
    const SweepBest found = best_of(field, weight, domain, sweep.allow_extrapolation);
    if (found.design()) {
      const std::uint64_t best = found.design()->index;
      carried = carried || found.carries_weight();
      const std::size_t at = std::size_t(places(sweep, best)[along]);
      const std::uint64_t first = best - at * stride;
      const std::size_t curve = std::size_t(std::find(curves.begin(), curves.end(), first) - curves.begin());
      figure.text(fmt::format("circle: {} {} at {}", field.superlative(), field.shown(field.values[best]), x.value(at)),
                  style::text_size, fmt::format("screen {},{} right", right, top + 0.09 / inches));
      figure.circle(x.at[at], field.values[best], 0.01, "fillstyle empty", looks[curve].colour);
    }
    if (p + 1 == metrics.size()) {
      figure.text(x.label(), 7.5, fmt::format("screen {},{} center", 0.5 * (left + right), 0.35 / inches));
      std::string note = broken ? "no line: does not flap" : "";
      if (leaves) note += fmt::format("{}crossed, hatched: outside the model's domain", note.empty() ? "" : "; ");
      if (carried) note += fmt::format("{}best sought where lift >= weight", note.empty() ? "" : "; ");
      if (!note.empty()) figure.remarks(note, inches);
    }
    std::string curves_drawn;
    for (std::size_t c = 0; c < curves.size(); ++c) {
      curves_drawn += fmt::format(
          "{}$curve_{}_{} using 1:2 with lines {}, $lone_{}_{} using 1:2 with points pt 7 "
          "ps 0.2 lc rgb '{}', $outside_{}_{} using 1:2 with points pt 2 ps 0.3 lc rgb '{}'",
          c == 0 ? "" : ", ", p, c, looks[c].line(), p, c, looks[c].colour, p, c, looks[c].colour);
    }
    double least = INFINITY, most = -INFINITY;
    for (const double y : field.values) {
      if (!std::isfinite(y)) continue;
      least = std::min(least, y);
      most = std::max(most, y);
    }
    const bool from_zero = least >= 0.0 && least < 0.6 * most;
    figure.add("set yrange [{}:*]\nset offsets 0,0,graph 0.06,0\nplot {}\n", from_zero ? "0" : "*", curves_drawn);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), output);
}

}  // namespace wingbeat

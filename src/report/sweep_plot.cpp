#include "wingbeat/report/sweep_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "report/figure.hpp"
#include "report/sweep_status_plot.hpp"
#include "wingbeat/files/netcdf.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/study/sweep_best.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {
namespace {

constexpr std::uint64_t most_designs_drawn = 4000000;
constexpr std::uint64_t most_curves = 6;
constexpr std::size_t most_panels = 4;

bool is_number(const SweepAxis& axis) {
  return std::none_of(axis.quantities.begin(), axis.quantities.end(),
                      [](const SweptQuantity& q) { return q.kind == SweptQuantity::Kind::choice; });
}

std::string spaced(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

/// A parameter in words: "crank radius", "supply voltage"; with its section where the last word alone says too little.
std::string words(const std::string& key) {
  const auto dot = key.rfind('.');
  if (dot == std::string::npos) return spaced(key);
  const std::string leaf = key.substr(dot + 1);
  int same = 0;
  for (const auto& known : parameter_table<double>()) same += known.path.substr(known.path.rfind('.') + 1) == leaf;
  if (same == 1 && leaf.find('_') != std::string::npos) return spaced(leaf);
  const std::string above = key.substr(0, dot);
  return spaced(above.substr(above.rfind('.') + 1) + " " + leaf);
}

/// A unit for the eye and what SI values are multiplied by.
struct Display {
  std::string unit;
  double factor = 1.0;
  std::string in_brackets() const { return unit.empty() ? "" : fmt::format(" ({})", unit); }
  std::string shown(double x) const { return fmt::format("{:.4g}{}{}", factor * x, unit.empty() ? "" : " ", unit); }
};

Display display_for(std::string_view unit, double largest, bool efficiency = false) {
  if (efficiency) return {"%", 100.0};
  if (unit == "1") return {"", 1.0};
  if (unit == "rad") return {"deg", degrees_per_radian};
  if (unit == "degree") return {"deg", 1.0};
  const bool simple = unit.find_first_of(" /0123456789") == std::string_view::npos;
  if (!simple || unit == "Hz" || unit == "V" || !(largest > 0.0)) return {std::string(unit), 1.0};
  if (unit == "kg") return {"g", 1e3};
  constexpr std::pair<double, const char*> prefixes[] = {{1e-9, "n"}, {1e-6, "u"}, {1e-3, "m"}, {1.0, ""}, {1e3, "k"}};
  const auto* best = &prefixes[0];
  for (const auto& prefix : prefixes) {
    if (largest >= 0.9999 * prefix.first) best = &prefix;
  }
  return {fmt::format("{}{}", best->second, unit), 1.0 / best->first};
}

/// One axis of numbers as it is drawn.
struct Scale {
  std::string name;
  Display display;
  bool logarithmic = false;
  std::vector<double> at;  ///< in the displayed unit

  explicit Scale(const SweepAxis& axis) {
    const SweptQuantity& q = axis.quantities.front();
    name = axis.name == q.name || axis.quantities.size() == 1 ? words(q.key) : spaced(axis.name);
    double largest = 0.0;
    for (const double x : q.values) largest = std::max(largest, std::abs(x));
    display = display_for(q.unit, largest);
    logarithmic = q.logarithmic;
    for (const double x : q.values) at.push_back(display.factor * x);
  }

  std::string label() const { return name + display.in_brackets(); }
  std::string range(const char* which) const {
    const auto [least, most] = std::minmax_element(at.begin(), at.end());
    std::string text =
        fmt::format("set {0}range [{1}:{2}]\n{3} logscale {0}\n", which, *least, *most, logarithmic ? "set" : "unset");
    if (!logarithmic || *most > 1000.0 * *least) return text;
    // Over few decades powers of ten alone are too few marks; over more, three a decade would overlap.
    const std::vector<double> steps = *most > 30.0 * *least ? std::vector{1.0, 3.0} : std::vector{1.0, 2.0, 5.0};
    std::string marks;
    for (double decade = std::pow(10.0, std::floor(std::log10(*least))); decade <= *most; decade *= 10.0) {
      for (const double step : steps) marks += fmt::format("{}{}", marks.empty() ? "" : ",", step * decade);
    }
    return text + fmt::format("set {}tics ({})\n", which, marks);
  }
  /// "5 mm"
  std::string value(std::size_t n) const {
    return fmt::format("{:.4g}{}{}", at[n], display.unit.empty() ? "" : " ", display.unit);
  }
};

std::string title_of(const Study& study) {
  return study.title.empty() ? std::filesystem::path(study.input.study_name).stem().string() : study.title;
}

bool is_efficiency(Metric m) { return std::string_view(metric_info(m).key).starts_with("efficiency"); }

/// A metric's values with the display that suits them.
struct Field {
  Metric metric;
  std::vector<double> values;  ///< in the displayed unit
  Display display;

  Field(const NetcdfReader& file, Metric m) : metric(m), values(file.read(metric_info(m).key)) {
    double largest = 0.0;
    for (const double x : values) largest = std::isfinite(x) ? std::max(largest, std::abs(x)) : largest;
    display = display_for(metric_info(m).unit, largest, is_efficiency(m));
    for (double& x : values) x *= display.factor;
  }
  std::string label() const { return metric_info(metric).long_name + display.in_brackets(); }
  std::string shown(double value) const {
    return fmt::format("{:.4g}{}{}", value, display.unit.empty() ? "" : " ", display.unit);
  }
  const char* superlative() const {
    const std::string_view key = metric_info(metric).key;
    return is_efficiency(metric) || key.starts_with("lift") ? "best" : "highest";
  }
};

/// Of every design; empty where the study does not keep it.
std::vector<double> lift_over_weight(const Sweep& sweep, const NetcdfReader& file) {
  if (!sweep.options.metrics[std::size_t(Metric::lift_to_weight)]) return {};
  return file.read(metric_info(Metric::lift_to_weight).key);
}

SweepBest best_of(const Field& field, const std::vector<double>& weight, const std::vector<double>& domain,
                  bool extrapolates) {
  SweepBest best;
  for (std::size_t n = 0; n < field.values.size(); ++n) {
    if (!extrapolates && domain[n] != 0.0) continue;
    best.offer(n, field.values[n], weight.empty() ? absent : weight[n]);
  }
  return best;
}

// ---- Lines

constexpr const char* curve_styles[most_curves] = {blue_solid,
                                                   vermillion_dashed,
                                                   black_dotted,
                                                   "dt (14,4,3,4) lw 1.3 lc rgb '#009e73'",
                                                   "dt (20,5) lw 1.3 lc rgb '#cc79a7'",
                                                   "dt (6,3) lw 1.3 lc rgb '#56b4e9'"};
constexpr const char* curve_colours[most_curves] = {"#0072b2", "#d55e00", "#000000", "#009e73", "#cc79a7", "#56b4e9"};

/// "springs on, condition air": the choices of one curve.
std::string curve_name(const Sweep& sweep, std::uint64_t index) {
  const auto place = places(sweep, index);
  std::string name;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (is_number(sweep.axes[a])) continue;
    for (const SweptQuantity& q : sweep.axes[a].quantities) {
      if (q.kind != SweptQuantity::Kind::choice) continue;
      const bool says_itself = q.key == "condition" || q.key == "transmission.formulation";
      name +=
          fmt::format("{}{}{}", name.empty() ? "" : ", ", says_itself ? "" : words(q.key) + " ", q.labels[place[a]]);
    }
  }
  return name;
}

/// The axis of numbers, how far designs lie apart along it, and the first design of each curve.
struct Curves {
  std::size_t along = 0;
  std::uint64_t stride = 1;
  std::vector<std::uint64_t> first;

  explicit Curves(const Sweep& sweep) {
    for (std::size_t a = sweep.axes.size(); a-- > 0;) {
      if (is_number(sweep.axes[a])) along = a;
    }
    for (std::size_t a = along + 1; a < sweep.axes.size(); ++a) stride *= sweep.axes[a].count;
    for (std::uint64_t n = 0; n < sweep.size(); ++n) {
      if (places(sweep, n)[along] == 0) first.push_back(n);
    }
  }
};

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

  const bool named = curves.size() > 1;
  const double panel = 1.45, gap = 0.45, foot = 0.62;
  const double head = 0.58 + (named ? 0.15 * double((curves.size() + 1) / 2) : 0.0);
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
      figure.key_entry(c % 2 == 0 ? left : 0.56, title_y - (0.2 + 0.15 * double(c / 2)) / inches, curve_styles[c],
                       curve_name(sweep, curves[c]));
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
                  6.5, fmt::format("screen {},{} right", right, top + 0.09 / inches));
      figure.circle(x.at[at], field.values[best], 0.01, "fillstyle empty", curve_colours[curve]);
    }
    if (p + 1 == metrics.size()) {
      figure.text(x.label(), 7.5, fmt::format("screen {},{} center", 0.5 * (left + right), 0.23 / inches));
      std::string note = broken ? "no line: does not flap" : "";
      if (leaves) note += fmt::format("{}crossed, hatched: outside the model's domain", note.empty() ? "" : "; ");
      if (carried) note += fmt::format("{}best sought where lift >= weight", note.empty() ? "" : "; ");
      if (!note.empty()) figure.text(note, 6.5, fmt::format("screen {},{} right", right, 0.075 / inches));
    }
    std::string curves_drawn;
    for (std::size_t c = 0; c < curves.size(); ++c) {
      curves_drawn += fmt::format(
          "{}$curve_{}_{} using 1:2 with lines {}, $lone_{}_{} using 1:2 with points pt 7 "
          "ps 0.2 lc rgb '{}', $outside_{}_{} using 1:2 with points pt 2 ps 0.3 lc rgb '{}'",
          c == 0 ? "" : ", ", p, c, curve_styles[c], p, c, curve_colours[c], p, c, curve_colours[c]);
    }
    figure.add("set yrange [*:*]\nset offsets 0,0,graph 0.06,0\nplot {}\n", curves_drawn);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), output);
}

// ---- Contours

struct Point {
  double x, y;
};
using Loop = std::vector<Point>;

/// Values on a grid, z[i * ny + j] at x[i], y[j]; coordinates grow.
struct Grid {
  std::vector<double> x, y, z;
  bool log_x = false, log_y = false;
};

/// The boundaries of the region z >= level, closed along the edges of the grid, the region on their left: marching
/// squares with linear interpolation.
std::vector<Loop> boundaries(const Grid& g, double level) {
  const int nx = int(g.x.size()), ny = int(g.y.size());
  // A frame around the grid, of no width, that lies outside the region.
  const auto inside = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < nx && j < ny && g.z[std::size_t(i * ny + j)] >= level;
  };
  const auto between = [](double a, double b, double t, bool logarithmic) {
    return logarithmic ? a * std::pow(b / a, t) : a + t * (b - a);
  };
  const auto node = [&](int i, int j) {
    return Point{g.x[std::size_t(std::clamp(i, 0, nx - 1))], g.y[std::size_t(std::clamp(j, 0, ny - 1))]};
  };
  const auto value = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < nx && j < ny ? g.z[std::size_t(i * ny + j)]
                                                : -std::numeric_limits<double>::infinity();
  };
  struct Edge {
    int i, j;  ///< its lower node
    bool along_x;
    auto operator<=>(const Edge&) const = default;
  };
  const auto crossing = [&](const Edge& e) {
    const int i = e.along_x ? e.i + 1 : e.i, j = e.along_x ? e.j : e.j + 1;
    const Point p = node(e.i, e.j), q = node(i, j);
    const double a = value(e.i, e.j), b = value(i, j);
    const double t = std::isinf(a) ? 1.0 : std::isinf(b) ? 0.0 : std::clamp((level - a) / (b - a), 0.0, 1.0);
    return Point{between(p.x, q.x, t, g.log_x), between(p.y, q.y, t, g.log_y)};
  };

  std::map<Edge, Edge> next;
  for (int i = -1; i < nx; ++i) {
    for (int j = -1; j < ny; ++j) {
      const bool corner[4] = {inside(i, j), inside(i + 1, j), inside(i + 1, j + 1), inside(i, j + 1)};
      const Edge edge[4] = {{i, j, true}, {i + 1, j, false}, {i, j + 1, true}, {i, j, false}};
      int leaving[2], entering[2], count = 0, entries = 0;
      for (int k = 0; k < 4; ++k) {
        if (corner[k] && !corner[(k + 1) % 4]) leaving[count++] = k;
        if (!corner[k] && corner[(k + 1) % 4]) entering[entries++] = k;
      }
      if (count == 1) next.emplace(edge[leaving[0]], edge[entering[0]]);
      if (count == 2) {
        const double middle = 0.25 * (value(i, j) + value(i + 1, j) + value(i + 1, j + 1) + value(i, j + 1));
        for (const int k : leaving) next.emplace(edge[k], edge[(k + (middle >= level ? 1 : 3)) % 4]);
      }
    }
  }
  std::vector<Loop> loops;
  while (!next.empty()) {
    Loop loop;
    for (auto at = next.begin(); at != next.end();) {
      const Point p = crossing(at->first);
      if (loop.empty() || p.x != loop.back().x || p.y != loop.back().y) loop.push_back(p);
      const Edge to = at->second;
      next.erase(at);
      at = next.find(to);
    }
    if (loop.size() > 2) loops.push_back(std::move(loop));
  }
  return loops;
}

/// Several loops as one outline for filling: joined by lines that are passed in both directions.
void add_filled(Figure& figure, const std::string& name, const std::vector<Loop>& loops) {
  figure.add("${} << END\n", name);
  if (loops.empty()) figure.add("NaN NaN\n");
  for (const Loop& loop : loops) {
    for (const Point& p : loop) figure.add("{} {}\n", p.x, p.y);
    figure.add("{} {}\n{} {}\n", loop.front().x, loop.front().y, loops.front().front().x, loops.front().front().y);
  }
  figure.add("END\n");
}

/// The same as lines, without what runs along the edges of the grid.
void add_outline(Figure& figure, const std::string& name, const Grid& g, const std::vector<Loop>& loops) {
  figure.add("${} << END\nNaN NaN\n", name);
  const auto on_edge = [&](const Point& p, const Point& q) {
    return (p.x == q.x && (p.x == g.x.front() || p.x == g.x.back())) ||
           (p.y == q.y && (p.y == g.y.front() || p.y == g.y.back()));
  };
  for (const Loop& loop : loops) {
    for (std::size_t n = 0; n < loop.size(); ++n) {
      const Point &p = loop[n], &q = loop[(n + 1) % loop.size()];
      if (on_edge(p, q)) figure.add("\n");
      else figure.add("{} {}\n{} {}\n", p.x, p.y, q.x, q.y);
    }
    figure.add("\n");
  }
  figure.add("END\n");
}

/// Gives what is no number the value of the nearest number.
void extend(Grid& g) {
  const int nx = int(g.x.size()), ny = int(g.y.size());
  std::vector<std::size_t> front;
  for (std::size_t n = 0; n < g.z.size(); ++n) {
    if (std::isfinite(g.z[n])) front.push_back(n);
  }
  for (std::size_t at = 0; at < front.size(); ++at) {
    const int i = int(front[at]) / ny, j = int(front[at]) % ny;
    for (const auto& [di, dj] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      if (i + di < 0 || j + dj < 0 || i + di >= nx || j + dj >= ny) continue;
      const std::size_t n = std::size_t((i + di) * ny + j + dj);
      if (std::isfinite(g.z[n])) continue;
      g.z[n] = g.z[front[at]];
      front.push_back(n);
    }
  }
}

/// Means over neighbours, 1-2-1: turns the stairs of a field of zeros and ones into a slope of the same place.
void smooth(Grid& g) {
  const int nx = int(g.x.size()), ny = int(g.y.size());
  const auto pass = [&](int di, int dj) {
    const std::vector<double> z = g.z;
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        const auto at = [&](int s) {
          return z[std::size_t(std::clamp(i + s * di, 0, nx - 1) * ny + std::clamp(j + s * dj, 0, ny - 1))];
        };
        g.z[std::size_t(i * ny + j)] = 0.25 * at(-1) + 0.5 * at(0) + 0.25 * at(1);
      }
    }
  };
  pass(1, 0);
  pass(0, 1);
}

/// Round numbers, about nine steps apart, that enclose both.
std::vector<double> levels_between(double least, double most) {
  if (!(most > least)) most = least + std::max(std::abs(least), 1.0) * 1e-3;
  const double rough = (most - least) / 9.0;
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * decade;
  for (const double nice : {5.0, 2.5, 2.0, 1.0}) {
    if (nice * decade >= 0.999 * rough) step = nice * decade;
  }
  std::vector<double> levels;
  for (double k = std::floor(least / step); k * step < most + 0.999 * step; ++k) levels.push_back(k * step);
  return levels;
}

/// From dark to light with evenly growing lightness (viridis, five points of it).
std::string colour(double share) {
  constexpr std::array<std::array<double, 3>, 5> points = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double at = std::clamp(share, 0.0, 1.0) * 4.0;
  const std::size_t k = std::min<std::size_t>(3, std::size_t(at));
  const double t = at - double(k);
  int rgb[3];
  for (std::size_t c = 0; c < 3; ++c) rgb[c] = int(std::lround((1.0 - t) * points[k][c] + t * points[k + 1][c]));
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

/// The data set's values, with both coordinates growing.
struct Arrangement {
  std::vector<std::size_t> x, y;  ///< places along the axes in growing order
  std::size_t index(std::size_t i, std::size_t j, std::size_t count_y) const { return x[i] * count_y + y[j]; }
};

std::vector<std::size_t> growing(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  std::sort(order.begin(), order.end(), [&](std::size_t p, std::size_t q) { return values[p] < values[q]; });
  return order;
}

void plot_contours(const Study& study, const NetcdfReader& file, std::span<const Metric> metrics, PlotFormat format,
                   const std::filesystem::path& output) {
  std::vector<const SweepAxis*> axes;
  for (const SweepAxis& axis : study.sweep.axes) {
    if (is_number(axis)) axes.push_back(&axis);
  }
  const Scale x(*axes[0]), y(*axes[1]);
  const std::size_t ny = y.at.size();
  const Arrangement order{growing(x.at), growing(y.at)};
  Grid base;
  for (const std::size_t i : order.x) base.x.push_back(x.at[i]);
  for (const std::size_t j : order.y) base.y.push_back(y.at[j]);
  base.log_x = x.logarithmic;
  base.log_y = y.logarithmic;
  const auto gridded = [&](const auto& value_at) {
    Grid grid = base;
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

  const double head = 0.52, panel = 2.05, gap = 0.84, foot = 0.62;
  const double inches = head + double(metrics.size()) * panel + double(metrics.size() - 1) * gap + foot;
  Figure figure(format, 3.5, inches);
  constexpr double left = 0.135, right = 0.83;
  Grid idle = gridded([&](std::size_t n) { return flaps(n) ? 0.0 : 1.0; });
  smooth(idle);
  add_filled(figure, "idle", boundaries(idle, 0.5));
  add_outline(figure, "idle_outline", base, boundaries(idle, 0.5));
  if (leaves) {
    Grid beyond = gridded([&](std::size_t n) { return outside(n) ? 1.0 : 0.0; });
    smooth(beyond);
    add_filled(figure, "outside", boundaries(beyond, 0.5));
    add_outline(figure, "outside_outline", base, boundaries(beyond, 0.5));
  }
  if (carried) {
    const Grid lifted = gridded([&](std::size_t n) { return flaps(n) ? weight[n] : 0.0; });
    add_outline(figure, "feasible", base, boundaries(lifted, 1.0));
  }

  figure.add("set multiplot\n{}{}", x.range("x"), y.range("y"));
  figure.add("set lmargin at screen {}\nset rmargin at screen {}\nset border 15\nset grid noxtics noytics front\n",
             left, right);
  for (std::size_t p = 0; p < metrics.size(); ++p) {
    if (p > 0) figure.next_panel();
    figure.add("unset object\n");
    const Field field(file, metrics[p]);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const double value : field.values) {
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    const SweepBest found = best_of(field, weight, domain, extrapolates);
    const std::size_t best = found.design() ? std::size_t(found.design()->index) : status.size();
    const double top = 1.0 - (head + double(p) * (panel + gap)) / inches;
    const double bottom = top - panel / inches;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", top, bottom);
    if (p == 0) {
      figure.text(title_of(study), 8.0, fmt::format("screen 0.5,{} center", 1.0 - 0.11 / inches));
    }
    figure.text(field.label(), 7.5, fmt::format("screen {},{} left", left, top + 0.22 / inches));
    figure.text(x.label(), 7.5, fmt::format("screen {},{} center", 0.5 * (left + right), bottom - 0.39 / inches));
    figure.text(y.label(), 7.5, fmt::format("screen 0.022,{} center rotate by 90", 0.5 * (top + bottom)));

    std::string drawn;
    if (std::isfinite(least)) {
      const std::vector<double> levels = levels_between(least, most);
      Grid grid = gridded([&](std::size_t n) { return field.values[n]; });
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
        const double at = bottom + (top - bottom) * double(k) / double(bands);
        figure.text(fmt::format("{:.6g}", std::abs(levels[k]) < 1e-9 * (most - least) ? 0.0 : levels[k]), 6.5,
                    fmt::format("screen {},{} left", right + 0.068, at));
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
      figure.circle(x.at[best / ny], y.at[best % ny], 0.012, "fillcolor rgb '#ffffff' fillstyle solid", "#000000");
      figure.circle(x.at[best / ny], y.at[best % ny], 0.003, "fillcolor rgb '#000000' fillstyle solid", "#000000");
      figure.text(fmt::format("circle: {} {} at {}, {}", field.superlative(), field.shown(field.values[best]),
                              x.value(best / ny), y.value(best % ny)),
                  6.5, fmt::format("screen {},{} right", right, top + 0.09 / inches));
    }
    if (p + 1 == metrics.size()) {
      std::string note = all_flap ? "" : "grey: does not flap";
      if (carried) note += fmt::format("{}dashed: lift = weight, best sought above", note.empty() ? "" : "; ");
      if (leaves) {
        note += fmt::format("{}hatched: outside the model's domain{}", note.empty() ? "" : "; ",
                            extrapolates ? "" : ", no best there");
      }
      if (weighed && !carried) note += fmt::format("{}lift < weight everywhere", note.empty() ? "" : "; ");
      if (!note.empty()) figure.text(note, 6.5, fmt::format("screen {},{} right", right, 0.075 / inches));
    }
    figure.add("set grid noxtics noytics\nplot {}\n", drawn);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), output);
}

}  // namespace

std::vector<Metric> metrics_to_plot(const Study& study, std::span<const std::string> names, const std::string& option) {
  const auto refuse = [&](const std::string& reason) { throw InputError(option, 0, 0, "", reason); };
  const Sweep& sweep = study.sweep;
  std::uint64_t curves = 1;
  int numbers = 0;
  for (const SweepAxis& axis : sweep.axes) {
    if (axis.samples) refuse("samples have no order to be drawn in; plots are of axes");
    if (is_number(axis)) ++numbers;
    else curves *= axis.count;
  }
  if (numbers < 1 || numbers > 2) {
    refuse(fmt::format("the study has {} axes of numbers; plots have one or two", numbers));
  }
  if (numbers == 1 && curves > most_curves) {
    refuse(fmt::format("the choices make {} curves; a plot has at most {}", curves, most_curves));
  }
  if (numbers == 2 && curves > 1) refuse("contours of two axes leave no room for choices; sweep them one by one");
  if (sweep.size() > most_designs_drawn) refuse("more than 4,000,000 designs are not drawn");

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
  if (metrics.size() > most_panels) refuse(fmt::format("at most {} metrics are drawn", most_panels));
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
  const auto numbers = std::count_if(study.sweep.axes.begin(), study.sweep.axes.end(), is_number);
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

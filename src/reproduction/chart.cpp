#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "report/figure.hpp"
#include "reproduction/sheet.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/stored_file.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr double left = 0.5, character = 0.056;  ///< [in]: margin of a panel; width of a letter of a label
constexpr int mark_value = 13, mark_hollow = 12, mark_place = 9;

std::string line(const CurveStyle& s) { return style::stroke(s.colour, s.dash, s.weight); }

double nice_step(double span) {
  const double raw = span / 4.0, unit = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 2.5, 5.0, 10.0}) {
    if (m * unit >= raw) return m * unit;
  }
  return 10.0 * unit;
}

/// Letters of a label without gnuplot's marks.
std::size_t length_of(const std::string& label) {
  std::size_t n = 0;
  for (std::size_t k = 0; k < label.size(); ++k) {
    if (label[k] == '{') k = label.find(' ', k);
    else if (label[k] != '}' && label[k] != '_') ++n;
  }
  return n;
}

/// The key and what published values add to it.
std::vector<ChartKey> whole_key(const Chart& chart) {
  std::vector<ChartKey> key = chart.key;
  bool value = false, hollow = false, place = false, span = false;
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartMark& m : panel.marks) (!std::isfinite(m.y) ? place : m.calibrated ? hollow : value) = true;
    span = span || !panel.spans.empty();
  }
  if (value) key.push_back({"published", {}, nullptr, mark_value});
  if (hollow) key.push_back({"published, used in the calibration", {}, nullptr, mark_hollow});
  if (place) key.push_back({"published location", {}, nullptr, mark_place});
  if (span) key.push_back({"published range", {style::grey, style::solid, 3.0}});
  return key;
}

/// Where a panel stands on the page, and what its axes span.
struct PanelBox {
  double x0, x1, y0, y1;  ///< [in], y from above
  double x_low, x_high, y_low, y_high;
};

/// Writes into an SVG where its quantities stand, for the report's read-out: of each panel box and ranges in the
/// drawing's units, and the published values, as JSON.
void add_read_out(const Chart& chart, const std::vector<PanelBox>& boxes, const std::filesystem::path& file) {
  constexpr double unit = 192.0;  // of an inch in the SVG
  nlohmann::ordered_json panels = nlohmann::ordered_json::array();
  for (std::size_t p = 0; p < boxes.size(); ++p) {
    const PanelBox& b = boxes[p];
    nlohmann::ordered_json panel;
    const auto rounded = [](double v) { return std::round(100.0 * v) / 100.0; };
    panel["box"] = {rounded(unit * b.x0), rounded(unit * b.x1), rounded(unit * b.y0), rounded(unit * b.y1)};
    panel["range"] = {b.x_low, b.x_high, b.y_low, b.y_high};
    panel["x"] = chart.x;
    panel["y"] = chart.panels[p].y;
    panel["marks"] = nlohmann::ordered_json::array();
    for (const ChartMark& m : chart.panels[p].marks) {
      panel["marks"].push_back({m.x, std::isfinite(m.y) ? nlohmann::ordered_json(m.y) : nullptr, m.name});
    }
    panels.push_back(std::move(panel));
  }
  std::string text = read_text_file(file);
  text.insert(text.find("<svg ") + 5, fmt::format("data-panels=\"{}\" ", detail::markup_escaped(panels.dump())));
  store(file, text);
}

void draw_marks(Figure& figure, const ChartPanel& panel) {
  int n = 800;
  for (const ChartSpan& span : panel.spans) {
    figure.add("set arrow {} from first {},graph 0.04 to first {},graph 0.04 nohead front lw 3 lc rgb '{}'\n", ++n,
               span.from, span.to, span.colour);
  }
  for (const ChartMark& m : panel.marks) {
    const std::string height = std::isfinite(m.y) ? fmt::format("first {}", m.y) : std::string("graph 0.04");
    figure.add("set label {} '' at first {},{} point pt {} ps 0.8 lw 1.5 lc rgb '{}' front\n", ++n, m.x, height,
               !std::isfinite(m.y) ? mark_place
               : m.calibrated      ? mark_hollow
                                   : mark_value,
               m.colour);
  }
}

/// Labels beside the right ends of curves, kept apart.
void draw_labels(Figure& figure, const ChartPanel& panel, double low, double high, double height) {
  struct Label {
    double height;  ///< [in] above the foot
    const ChartCurve* curve;
  };
  std::vector<Label> labels;
  for (const ChartCurve& curve : panel.curves) {
    if (curve.label.empty()) continue;
    const auto last = std::find_if(curve.y.rbegin(), curve.y.rend(), [](double y) { return std::isfinite(y); });
    if (last != curve.y.rend()) labels.push_back({height * (*last - low) / (high - low), &curve});
  }
  std::stable_sort(labels.begin(), labels.end(), [](const Label& p, const Label& q) { return p.height < q.height; });
  constexpr double apart = 0.125;
  for (std::size_t n = 1; n < labels.size(); ++n)
    labels[n].height = std::max(labels[n].height, labels[n - 1].height + apart);
  double top = height + 0.05;
  for (std::size_t n = labels.size(); n-- > 0; top -= apart) labels[n].height = std::min(labels[n].height, top);
  for (const Label& l : labels) {
    figure.symbols(l.curve->label, style::text_size,
                   fmt::format("graph 1.02,graph {:.4f} left textcolor rgb '{}'", l.height / height,
                               l.curve->label_colour ? l.curve->label_colour : l.curve->style.colour));
  }
}

}  // namespace

CurveStyle of_virtual_work(CurveStyle style) {
  style.dash = style::dashed;
  return style;
}

void draw(const Chart& chart, PlotFormat format, const std::filesystem::path& file) {
  const std::vector<ChartKey> keys = whole_key(chart);
  const double page = chart.columns == 1 ? style::single_column : style::double_column, cell = page / chart.columns;
  // Key entries follow each other on lines, as words do.
  std::vector<std::pair<double, int>> places;
  double key_x = 0.1;
  int key_line = 0;
  for (const ChartKey& entry : keys) {
    const double width = 0.4 + character * double(entry.name.size());
    if (key_x > 0.2 && key_x + width > page) {
      key_x = 0.1;
      ++key_line;
    }
    places.push_back({key_x, key_line});
    key_x += width;
  }
  std::size_t longest = 0;
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartCurve& curve : panel.curves) longest = std::max(longest, length_of(curve.label));
  }
  const bool titled =
      std::any_of(chart.panels.begin(), chart.panels.end(), [](const auto& p) { return !p.title.empty(); });
  const bool lettered = chart.panels.size() > 1;
  const double right = longest == 0 ? 0.1 : 0.14 + character * double(longest), foot = 0.42, gap = titled ? 0.27 : 0.14;
  const double head = keys.empty() ? 0.04 : 0.06 + 0.15 * (key_line + 1);
  const std::size_t columns = std::size_t(chart.columns), rows = (chart.panels.size() + columns - 1) / columns;
  const double inches = head + double(rows) * (gap + chart.panel_height) + foot;
  Figure figure(format, page, inches);

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
  std::vector<PanelBox> boxes;
  figure.add("set multiplot\nset xrange [{}:{}]\n", x_low, x_high);
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    const ChartPanel& panel = chart.panels[p];
    const std::size_t row = p / columns, column = p % columns;
    const bool last = p + columns >= chart.panels.size();
    if (p > 0) figure.next_panel();
    const double above = head + gap + (chart.panel_height + gap) * double(row);  // [in]
    const double x0 = cell * double(column) + left, x1 = cell * double(column + 1) - right;
    const double top = 1.0 - above / inches, bottom = top - chart.panel_height / inches;
    figure.add(
        "set lmargin at screen {}\nset rmargin at screen {}\nset tmargin at screen {}\nset bmargin at screen {}\n"
        "set format x {}\n",
        x0 / page, x1 / page, top, bottom, last ? "'%g'" : "''");
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
    for (const ChartMark& m : panel.marks) cover(m.y);
    if (!(high > low)) high = low + 1.0;
    const double step = nice_step(high - low);
    low = std::floor(low / step + 1e-9) * step;
    // No empty band above the highest value, which need not be a marked one.
    high = low < 0.0 ? std::ceil(high / step - 1e-9) * step : std::min(1.03 * high, std::ceil(high / step) * step);
    figure.add("set yrange [{}:{}]\nset ytics {}\n", low, high, step);
    boxes.push_back({x0, x1, above, above + chart.panel_height, x_low, x_high, low, high});
    figure.text(panel.y, style::heading_size,
                fmt::format("screen {},{} center rotate by 90", (x0 - left + 0.1) / page, 0.5 * (top + bottom)));
    if (lettered) {
      figure.symbols(fmt::format("{{/:Bold {}}}", char('a' + p)), style::title_size,
                     fmt::format("screen {},{} left", (x0 - left + 0.05) / page, top + 0.1 / inches));
    }
    if (!panel.title.empty())
      figure.text(panel.title, style::heading_size, fmt::format("screen {},{} left", x0 / page, top + 0.1 / inches));
    if (last) {
      figure.text(chart.x, style::heading_size,
                  fmt::format("screen {},{} center", 0.5 * (x0 + x1) / page, bottom - 0.32 / inches));
    }
    if (p == 0) {
      for (std::size_t k = 0; k < keys.size(); ++k) {
        const double x = places[k].first, y = 1.0 - (0.1 + 0.15 * places[k].second) / inches;
        const ChartKey& entry = keys[k];
        if (entry.fill) {
          figure.box(fmt::format("from screen {},{} to screen {},{}", x / page, y - 0.04 / inches, (x + 0.18) / page,
                                 y + 0.04 / inches),
                     entry.fill);
        } else if (entry.mark > 0) {
          figure.add("set label {} '' at screen {},{} point pt {} ps 0.8 lw 1.5 lc rgb '#000000' front\n", 700 + k,
                     (x + 0.12) / page, y, entry.mark);
        } else {
          figure.add("set arrow {} from screen {},{} to screen {},{} nohead front {}\n", 700 + k, x / page, y,
                     (x + 0.2) / page, y,
                     // gnuplot's SVG misses a change of dash alone.
                     style::stroke(entry.style.colour, entry.style.dash, entry.style.weight + 0.004 * double(k)));
        }
        figure.symbols(entry.name, style::text_size, fmt::format("screen {},{} left", (x + 0.24) / page, y));
      }
    }
    for (const ChartLevel& level : panel.levels) {
      figure.text(level.name, style::text_size,
                  fmt::format("graph 0.02,first {} left offset 0,{}", level.y, level.y > 0.8 * high ? -0.5 : 0.5));
    }
    draw_marks(figure, panel);
    draw_labels(figure, panel, low, high, chart.panel_height);
    std::string plots;
    for (std::size_t a = 0; a < panel.areas.size(); ++a) {
      const ChartArea& area = panel.areas[a];
      plots += fmt::format(
          "$a{0}_{1} using 1:($2 > 0 ? $2 : 0) with filledcurves y=0 fs solid lc rgb '{2}', "
          "'' using 1:($2 < 0 ? $2 : 0) with filledcurves y=0 fs solid lc rgb '{3}', ",
          p, a, area.above, area.below);
    }
    plots += low < 0.0 ? "0 with lines dt 1 lw 0.6 lc rgb '#404040'" : "NaN";
    for (const ChartLevel& level : panel.levels) {
      plots += fmt::format(", {} with lines {}", level.y, style::reference_line);
    }
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      const ChartCurve& curve = panel.curves[c];
      if (std::none_of(curve.y.begin(), curve.y.end(), [](double y) { return std::isfinite(y); })) continue;
      plots += fmt::format(", $c{}_{} using 1:2 with lines {} title {}", p, c, line(curve.style),
                           quoted(fmt::format("curve|{}|{}|{}", p, curve.name, curve.formulation)));
    }
    figure.add("plot {}\n", plots);
    if (p == 0) figure.add("unset object\n");
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
  if (format == PlotFormat::svg) add_read_out(chart, boxes, file);
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
    if (c.flapping_case.formulation == formulation && c.flapping_case.springs == springs && !c.run.cycle.empty())
      return &c;
  }
  return nullptr;
}

}  // namespace wingbeat::reproduction

// A flight over the time: position beside the path, attitude, controls with their limits, power.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/report/fly_report.hpp"

namespace wingbeat {
namespace {

using FlownValue = std::function<double(const FlightRow&)>;

struct FlownCurve {
  std::string name, line;
  FlownValue value;
};

/// Curves of one unit; `limits` are drawn where they lie within reach of the curves.
struct FlownPanel {
  std::string title, unit;
  std::vector<FlownCurve> curves;
  std::vector<double> limits;
};

std::string flown_line(std::size_t n, bool reference = false) {
  constexpr const char* colours[] = {style::with_springs, style::without_springs, style::gearbox};
  return style::stroke(colours[n % 3], reference ? style::dashed : style::solid, reference ? 0.8 : 1.0);
}

std::vector<FlownPanel> flown_panels(const FlyReport& report) {
  std::vector<FlownPanel> panels(2);
  panels[0] = {"Position (path dashed)", "m", {}, {}};
  panels[1] = {"Attitude", "deg", {}, {}};
  const char *places[] = {"x, north", "y, east", "height"}, *angles[] = {"roll", "pitch", "yaw"};
  for (std::size_t k = 0; k < 3; ++k) {
    const double sign = k == 2 ? -1.0 : 1.0;
    panels[0].curves.push_back(
        {"", flown_line(k, true), [=](const FlightRow& r) { return sign * r.reference.position[k]; }});
    panels[0].curves.push_back({places[k], flown_line(k), [=](const FlightRow& r) { return sign * r.position[k]; }});
    panels[1].curves.push_back(
        {angles[k], flown_line(k), [=](const FlightRow& r) { return degrees_per_radian * r.angles[k]; }});
  }
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    const ControlRange& range = report.vehicle->ranges[k];
    if (!range.given()) continue;
    const bool angle = std::string_view(flight_control_units[k]) == "rad";
    const double factor = angle ? degrees_per_radian : 1.0;
    std::string title = name_of(FlightControl(k));
    std::replace(title.begin(), title.end(), '_', ' ');
    title[0] = char(std::toupper(title[0]));
    panels.push_back({title,
                      angle ? "deg" : flight_control_units[k],
                      {{"", style::first_curve, [=](const FlightRow& r) { return factor * r.controls.at[k]; }}},
                      {factor * range.low, factor * range.high}});
  }
  panels.push_back({"Electrical power", "W", {{"", style::first_curve, &FlightRow::electrical}}, {}});
  return panels;
}

/// The rows that follow each other at one distance. A flight ends between two of them: that last row is at another
/// phase of the wingbeat, and its power is a mean over less than the others'.
std::span<const FlightRow> evenly_spaced(std::span<const FlightRow> rows) {
  if (rows.size() < 3) return rows;
  constexpr double rounding = 1e-6;
  const double usual = rows[1].time - rows[0].time, last = rows.back().time - rows[rows.size() - 2].time;
  return last < (1.0 - rounding) * usual ? rows.first(rows.size() - 1) : rows;
}

/// The axis of a panel: its curves with room, and those limits that are near.
std::pair<double, double> flown_range(const FlownPanel& panel, std::span<const FlightRow> rows) {
  double low = infinity, high = -infinity;
  for (const FlownCurve& curve : panel.curves) {
    for (const FlightRow& row : rows) {
      const double x = curve.value(row);
      if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
    }
  }
  if (!(low <= high)) return {0.0, 1.0};
  for (const double limit : panel.limits) low = std::min(low, limit), high = std::max(high, limit);
  const double least = 1e-3 * std::max({1.0, std::abs(low), std::abs(high)});
  const double room = std::max(0.08 * (high - low), least);
  return {low - room, high + room};
}

}  // namespace

void plot_fly(const FlyReport& report, PlotFormat format, const std::filesystem::path& file) {
  const std::vector<FlownPanel> panels = flown_panels(report);
  const std::span<const FlightRow> rows = evenly_spaced(report.flight.rows);
  constexpr double left_inches = 0.52, right = 0.96;
  constexpr double key_inches = left_inches + 1.35;
  const double left = left_inches / format.width, head = 0.28, foot = 0.42, each = 0.72, gap = 0.26;
  std::vector<Key> keys;
  std::vector<double> tops;  // of the panels, from that of the page [in]
  double inches = head;
  for (const FlownPanel& panel : panels) {
    std::vector<KeyEntry> names;
    for (const FlownCurve& curve : panel.curves) {
      if (!curve.name.empty()) names.push_back(line_key(curve.name, curve.line));
    }
    keys.emplace_back(std::move(names), right * format.width - key_inches);
    tops.push_back(inches + std::max(gap, keys.back().height() + 0.1));
    inches = tops.back() + each;
  }
  inches += foot;
  Figure figure(format, inches);
  figure.add("$flight << END\n");
  for (const FlightRow& row : rows) {
    figure.add("{}", row.time);
    for (const FlownPanel& panel : panels) {
      for (const FlownCurve& curve : panel.curves) figure.add(" {:.7g}", curve.value(row));
    }
    figure.add("\n");
  }
  const double last = std::max(report.flight.rows.back().time, 1e-3);
  figure.add("END\nset multiplot\nset lmargin at screen {}\nset rmargin at screen {}\n", left, right);
  const AxisMarks across(0.0, last, (right - left) * format.width, false, false);
  std::size_t column = 2;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const FlownPanel& panel = panels[p];
    if (p > 0) figure.next_panel();
    const double top = 1.0 - tops[p] / inches, bottom = top - each / inches;
    const auto [low, high] = flown_range(panel, rows);
    const AxisMarks marks(low, high, each, true, false);
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n{}\n{}\n", top, bottom, marks.commands("y"),
               across.commands("x", p + 1 == panels.size()));
    figure.text(panel.title, style::heading_size, fmt::format("screen {},{} left", left, top + 0.09 / inches));
    axis_title(figure, panel.unit, style::text_size, each, 0.1 / format.width, 0.5 * (top + bottom));
    keys[p].draw(figure, key_inches, tops[p] - keys[p].height() - 0.015);
    if (!panel.limits.empty()) {
      figure.text("limits dashed", style::text_size, fmt::format("screen {},{} right", right, top + 0.09 / inches));
    }
    if (p == 0) {
      page_title(figure, report.title, 0.12);
      figure.text("time, s", style::text_size, fmt::format("screen {},{} center", 0.5 * (left + right), 0.1 / inches));
    }
    figure.add("plot ");
    for (const double limit : panel.limits) figure.add("{} with lines {}, ", limit, style::reference_line);
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      figure.add("{}$flight using 1:{} with lines {}", c > 0 ? ", " : "", column++, panel.curves[c].line);
    }
    figure.add("\n");
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat

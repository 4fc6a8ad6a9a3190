// Trim over the speed, and modes in the complex plane.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "wingbeat/report/flight_report.hpp"

namespace wingbeat {
namespace {

/// One panel over the speed: a quantity with its unit, or two.
struct TrimCurve {
  std::string title, unit;
  std::function<double(const TrimResult&)> value;
};

std::vector<TrimCurve> curves_of(const FlightVehicle& vehicle, const TrimReport& report) {
  std::vector<TrimCurve> curves = {
      {"Electrical power", "W", [](const TrimResult& t) { return t.power; }},
      {"Pitch attitude, nose up", "deg", [](const TrimResult& t) { return degrees_per_radian * t.pitch; }},
      {vehicle.direct ? "Amplitude of the voltage" : "Voltage", "V",
       [](const TrimResult& t) { return t.controls[FlightControl::voltage]; }}};
  if (const auto control = pitch_control(vehicle)) {
    const bool bias = *control == FlightControl::bias;
    curves.push_back(
        {bias ? "Bias of the voltage" : "Mean stroke angle", bias ? "V" : "deg",
         [c = *control, bias](const TrimResult& t) { return t.controls[c] * (bias ? 1.0 : degrees_per_radian); }});
  }
  if (std::isfinite(report.battery_energy)) {
    const double energy = report.battery_energy;
    curves.push_back({"Endurance by the battery's energy", "min",
                      [energy](const TrimResult& t) { return energy / t.power / 60.0; }});
    curves.push_back({"Range by the battery's energy", "km",
                      [energy](const TrimResult& t) { return 1e-3 * t.condition.speed * energy / t.power; }});
  }
  return curves;
}

/// Numbers of an axis from `low` to `high`, with room at either end.
std::pair<double, double> with_room(double low, double high) {
  const double span = high - low, size = std::max(std::abs(low), std::abs(high));
  const double room = span > 1e-6 * size ? 0.08 * span : std::max(0.1 * size, 1e-6);
  return {low - room, high + room};
}

}  // namespace

void plot_trim(const FlightVehicle& vehicle, const TrimReport& report, PlotFormat format,
               const std::filesystem::path& file) {
  const std::vector<TrimCurve> curves = curves_of(vehicle, report);
  constexpr double left_inches = 0.52, right = 0.96;
  const double left = left_inches / format.width, head = 0.34, foot = 0.42, each = 0.95, gap = 0.26;
  const double inches = head + foot + (each + gap) * double(curves.size());
  Figure figure(format, inches);
  double slowest = infinity, fastest = -infinity;
  for (const TrimResult& t : report.flights) {
    slowest = std::min(slowest, t.condition.speed), fastest = std::max(fastest, t.condition.speed);
  }
  if (!(fastest > slowest)) fastest = slowest + 1.0;
  figure.add("$flights << END\n");
  bool beyond = false;
  for (const TrimResult& t : report.flights) {
    if (!t.flies()) continue;
    beyond |= t.status == TrimStatus::beyond_controls;
    figure.add("{} {}", t.condition.speed, t.status == TrimStatus::trimmed ? 1 : 0);
    for (const TrimCurve& curve : curves) figure.add(" {}", curve.value(t));
    figure.add("\n");
  }
  figure.add("END\nset multiplot\nset lmargin at screen {}\nset rmargin at screen {}\nset xrange [{}:{}]\n", left,
             right, slowest, fastest);
  for (std::size_t p = 0; p < curves.size(); ++p) {
    if (p > 0) figure.next_panel();
    const double top = 1.0 - (head + gap + (each + gap) * double(p)) / inches, bottom = top - each / inches;
    double low = infinity, high = -infinity;
    for (const TrimResult& t : report.flights) {
      if (!t.flies()) continue;
      low = std::min(low, curves[p].value(t)), high = std::max(high, curves[p].value(t));
    }
    if (!(low <= high)) low = 0.0, high = 1.0;
    const auto [from, to] = with_room(low, high);
    const AxisMarks marks(from, to, each, true, false);
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n{}\n", top, bottom, marks.commands("y"));
    figure.text(curves[p].title, style::heading_size, fmt::format("screen {},{} left", left, top + 0.09 / inches));
    axis_title(figure, curves[p].unit, style::text_size, each, 0.1 / format.width, 0.5 * (top + bottom));
    if (p == 0) {
      page_title(figure, report.vehicle, 0.12);
      figure.text("speed against the air, m/s", style::text_size,
                  fmt::format("screen {},{} center", 0.5 * (left + right), 0.1 / inches));
      if (beyond) {
        figure.text("open: a control beyond its range", style::text_size,
                    fmt::format("screen {},{} right", right, top + 0.09 / inches));
      }
    }
    figure.add(
        "set format x '{}'\nplot $flights using 1:{} with lines {}, "
        "$flights using 1:($2 == 1 ? ${} : NaN) with points pt 7 ps 0.4 lc rgb '{}', "
        "$flights using 1:($2 == 0 ? ${} : NaN) with points pt 6 ps 0.4 lw 0.7 lc rgb '{}'\n",
        p + 1 == curves.size() ? "%g" : "", p + 3, style::first_curve, p + 3, style::ink, p + 3, style::ink);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

void plot_stability(const StabilityReport& report, PlotFormat format, const std::filesystem::path& file) {
  const std::vector<FlightMode>& modes = report.result.modes;
  constexpr double left_inches = 0.52, right = 0.96;
  const double left = left_inches / format.width;
  const std::string averaged = fmt::format("pt 7 ps 0.55 lc rgb '{}'", style::ink);
  const std::string floquet = fmt::format("pt 6 ps 0.8 lw 0.9 lc rgb '{}'", style::without_springs);
  std::vector<KeyEntry> entries = {point_key("averaged over the wingbeat", averaged)};
  if (report.result.periodic) entries.push_back(point_key("Floquet theory of the whole flight", floquet));
  const Key key(std::move(entries), (right - left) * format.width);
  const double key_top = 0.26, head = key_top + key.height(), foot = 0.42, each = 1.6, gap = 0.45;
  const double inches = head + foot + 2.0 * each + gap + 0.2;
  Figure figure(format, inches);
  for (const bool longitudinal : {true, false}) {
    figure.add("${} << END\n", longitudinal ? "along" : "across");
    for (const FlightMode& mode : modes) {
      if (mode.longitudinal != longitudinal) continue;
      const auto row = [&](std::complex<double> a, std::complex<double> f) {
        figure.add("{} {} {} {}\n", a.real(), a.imag(), f.real(), f.imag());
      };
      const std::complex<double> none(std::nan(""), std::nan(""));
      row(mode.averaged.value_or(none), mode.floquet.value_or(none));
      row(std::conj(mode.averaged.value_or(none)), std::conj(mode.floquet.value_or(none)));
    }
    figure.add("END\n");
  }
  figure.add("set multiplot\nset lmargin at screen {}\nset rmargin at screen {}\n", left, right);
  for (const bool longitudinal : {true, false}) {
    if (!longitudinal) figure.next_panel();
    const double top = 1.0 - (head + 0.2 + (longitudinal ? 0.0 : each + gap)) / inches;
    const double bottom = top - each / inches;
    double low = -1.0, high = 1.0, tall = 1.0;
    for (const FlightMode& mode : modes) {
      if (mode.longitudinal != longitudinal) continue;
      for (const std::optional<std::complex<double>>& way : {mode.averaged, mode.floquet}) {
        if (!way) continue;
        const std::complex<double>& s = *way;
        low = std::min(low, s.real()), high = std::max(high, s.real()), tall = std::max(tall, std::abs(s.imag()));
      }
    }
    const double width_inches = (right - left) * format.width;
    const auto [from, to] = with_room(low, high);
    const AxisMarks across(from, to, width_inches, false, false), upright(-1.15 * tall, 1.15 * tall, each, true, false);
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n{}\n{}\n", top, bottom, across.commands("x"),
               upright.commands("y"));
    figure.text(longitudinal ? "Longitudinal" : "Lateral", style::heading_size,
                fmt::format("screen {},{} left", left, top + 0.09 / inches));
    axis_title(figure, "angular frequency, rad/s", style::text_size, each, 0.1 / format.width, 0.5 * (top + bottom));
    if (longitudinal) {
      page_title(figure, report.vehicle, 0.12);
      key.draw(figure, left * format.width, key_top);
      figure.text("growth rate, 1/s (right of 0: unstable)", style::text_size,
                  fmt::format("screen {},{} center", 0.5 * (left + right), 0.1 / inches));
    }
    figure.add(
        "set arrow 900 from 0, graph 0 to 0, graph 1 nohead back dt 1 lw 0.4 lc rgb '#c0c0c0'\n"
        "plot ${0} using 1:2 with points {1}, ${0} using 3:4 with points {2}\n",
        longitudinal ? "along" : "across", averaged, floquet);
  }
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat

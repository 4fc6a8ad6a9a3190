#include "wingbeat/report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "report/figure.hpp"
#include "report/layout.hpp"
#include "report/mechanism_drawing.hpp"

namespace wingbeat {

std::optional<PlotFormat> plot_format(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".svg") return PlotFormat::svg;
  if (extension == ".pdf") return PlotFormat::pdf;
  if (extension == ".png") return PlotFormat::png;
  if (extension == ".html") return PlotFormat::html;
  return std::nullopt;
}

void plot_cycle(std::span<const WaveformRow> rows, const Design<double>& design, const std::string& title,
                PlotFormat format, const std::filesystem::path& file) {
  if (rows.size() < 2) throw std::runtime_error("no cycle to plot");
  const double period = rows.back().time - rows.front().time;

  // Times in a unit that leaves readable numbers.
  const bool in_seconds = period >= 10.0;
  const double time_scale = in_seconds ? 1.0 : 1e3;
  double lift_mean = 0.0, max_lift = 0.0, max_power = 0.0;
  StrokeRange stroke{rows.front().stroke_angle, rows.front().stroke_angle};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (k > 0) lift_mean += 0.5 * (rows[k].lift + rows[k - 1].lift) * (rows[k].time - rows[k - 1].time) / period;
    stroke = {std::min(stroke.low, rows[k].stroke_angle), std::max(stroke.high, rows[k].stroke_angle)};
    max_lift = std::max(max_lift, std::abs(rows[k].lift));
    max_power = std::max(max_power, std::abs(rows[k].power_electrical));
  }
  const bool lift_in_newton = max_lift >= 1.0, power_in_watt = max_power >= 10.0;
  const double lift_scale = lift_in_newton ? 1.0 : 1e3, power_scale = power_in_watt ? 1.0 : 1e3;

  // Without a rod its panel shows the current.
  const bool rod = std::isfinite(rows.front().rod_force);
  const auto force_or_current = [&](const WaveformRow& r) { return rod ? r.rod_force : r.current; };
  double max_force = 0.0;
  for (const WaveformRow& r : rows) max_force = std::max(max_force, std::abs(force_or_current(r)));
  const double force_scale = max_force >= 1.0 ? 1.0 : 1e3;
  const char* const force_unit = max_force >= 1.0 ? (rod ? "N" : "A") : (rod ? "mN" : "mA");
  const Vehicle<double> vehicle = resolve(design);
  const std::string force = internal_force_name(vehicle.transmission.type);

  const bool pitching = std::isfinite(rows.front().pitch_angle);

  // The mechanism stands above the panels of waveforms; heights in inches.
  const double page_width = format.width;
  constexpr double mechanism_height = 1.9, panel_height = 0.987, gap = 0.283, above = 0.245, below = 0.409;
  const int panels = pitching ? 5 : 4;
  const double waveforms = above + panels * panel_height + (panels - 1) * gap + below,
               page_height = waveforms + mechanism_height;
  Figure figure(format, page_height);
  figure.add("$cycle << END\n");
  const std::vector<style::Phase> order = style::phases(rows);
  for (const auto& [row, periods] : order) {
    const WaveformRow& r = rows[row];
    figure.add("{} {} {} {} {} {} {} {} {} {}\n", time_scale * periods * period, degrees_per_radian * r.stroke_angle,
               r.flapping_velocity, lift_scale * r.lift, force_scale * force_or_current(r),
               power_scale * r.power_electrical, power_scale * r.power_motor, power_scale * r.power_aerodynamic,
               pitching ? degrees_per_radian * r.pitch_angle : 0.0, r.angle_of_attack_deg);
  }
  // Margins of the page, in its fractions.
  constexpr double left = 0.17, right = 0.83;
  figure.add("END\nset multiplot\n");
  page_title(figure, title, 0.1);
  figure.text(mechanism_caption(vehicle), 7.0, fmt::format("screen 0.5,{} center", 1.0 - 0.28 / page_height));
  const bool law = vehicle.transmission.type == TransmissionType::tabulated;
  draw_mechanism_panel(figure, vehicle, stroke,
                       {.left = law ? left : 0.03,
                        .right = law ? right : 0.97,
                        .bottom = (waveforms + (law ? 0.25 : 0.06)) / page_height,
                        .top = 1.0 - 0.4 / page_height,
                        .page_width = page_width,
                        .page_height = page_height});
  figure.next_panel();
  figure.add("set lmargin at screen {}\nset rmargin at screen {}\nset xrange [{}:{}]\n", left, right,
             time_scale * period * order.front().periods, time_scale * period * order.back().periods);
  double key_height = 0.0;
  int drawn = 0;
  double middle = 0.0;  ///< of the panel's height
  const auto panel = [&](const std::string& name) {
    if (drawn > 0) figure.next_panel();
    const double panel_top = waveforms - above - drawn * (panel_height + gap);
    ++drawn;
    key_height = (panel_top + 0.0763) / page_height;
    middle = (panel_top - 0.5 * panel_height) / page_height;
    figure.add("set tmargin at screen {}\nset bmargin at screen {}\n", panel_top / page_height,
               (panel_top - panel_height) / page_height);
    figure.add("set format x {}\n", drawn == panels ? "'%g'" : "''");
    axis_title(figure, name, 7.5, panel_height + gap, left - 0.505 / page_width, middle);
  };
  const auto marks = [&](const char* axis, double scale, std::initializer_list<double WaveformRow::*> columns) {
    double low = infinity, high = -infinity;
    for (const WaveformRow& r : rows) {
      for (const auto column : columns) {
        low = std::min(low, scale * (r.*column));
        high = std::max(high, scale * (r.*column));
      }
    }
    figure.add("{}", AxisMarks(low, high, panel_height, true, true).commands(axis));
  };

  panel("stroke angle (deg)");
  axis_title(figure, "velocity (rad/s)", 7.5, panel_height + gap, right + 0.505 / page_width, middle);
  marks("y", degrees_per_radian, {&WaveformRow::stroke_angle});
  marks("y2", 1.0, {&WaveformRow::flapping_velocity});
  figure.key_entry(left, key_height, style::first_curve, "stroke angle");
  figure.key_entry(left + 0.28, key_height, style::second_curve, "flapping velocity (right)");
  figure.add("set border 11\n");
  figure.add("plot $cycle using 1:2 with lines {}, '' using 1:3 axes x1y2 with lines {}\n", style::first_curve,
             style::second_curve);
  figure.add("unset y2tics\nset border 3\n");

  if (pitching) {
    panel("pitch (deg)");
    double low = infinity, high = -infinity;
    for (const WaveformRow& r : rows) {
      low = std::min({low, degrees_per_radian * r.pitch_angle, r.angle_of_attack_deg});
      high = std::max({high, degrees_per_radian * r.pitch_angle, r.angle_of_attack_deg});
    }
    figure.add("{}", AxisMarks(low, high, panel_height, true, true).commands("y"));
    figure.key_entry(left, key_height, style::first_curve, "pitch angle");
    figure.key_entry(left + 0.28, key_height, style::second_curve, "angle of attack");
    figure.add("plot $cycle using 1:9 with lines {}, '' using 1:10 with lines {}\n", style::first_curve,
               style::second_curve);
  }

  const char* lift_unit = lift_in_newton ? "N" : "mN";
  panel(fmt::format("lift ({})", lift_unit));
  marks("y", lift_scale, {&WaveformRow::lift});
  figure.key_entry(left, key_height, style::first_curve, "lift of all wings");
  figure.key_entry(left + 0.36, key_height, style::reference_line,
                   fmt::format("mean, {:.4g} {}", lift_scale * lift_mean, lift_unit));
  figure.add("plot $cycle using 1:4 with lines {}, {} with lines {}\n", style::first_curve, lift_scale * lift_mean,
             style::reference_line);

  panel(fmt::format("{} ({})", rod ? force : "current", force_unit));
  marks("y", force_scale, {rod ? &WaveformRow::rod_force : &WaveformRow::current});
  figure.key_entry(left, key_height, style::first_curve, rod ? force + ", above 0 raises the stroke angle" : "current");
  figure.add("plot $cycle using 1:5 with lines {}\n", style::first_curve);

  panel(power_in_watt ? "power (W)" : "power (mW)");
  marks("y", power_scale, {&WaveformRow::power_electrical, &WaveformRow::power_motor, &WaveformRow::power_aerodynamic});
  figure.text(in_seconds ? "time since stroke reversal (s)" : "time since stroke reversal (ms)", 7.5,
              fmt::format("screen {},{} center", 0.5 * (left + right), 0.0763 / page_height));
  const std::string air = style::stroke(style::aerodynamic);
  figure.key_entry(left, key_height, style::first_curve, "electrical");
  figure.key_entry(left + 0.205, key_height, style::second_curve,
                   is_given(vehicle.piezo) ? "piezo output" : "motor output");
  figure.key_entry(left + 0.465, key_height, air, "aerodynamic");
  figure.add("plot $cycle using 1:6 with lines {}, '' using 1:7 with lines {}, '' using 1:8 with lines {}\n",
             style::first_curve, style::second_curve, air);
  figure.add("unset multiplot\nunset output\n");
  run_gnuplot(figure.script(), file);
}

void plot_powers(std::span<const PowerBar> bars, const std::string& title, PlotFormat format,
                 const std::filesystem::path& file) {
  if (bars.empty()) throw std::runtime_error("no power breakdown to plot");
  struct Part {
    const char* name;
    double EnergyAudit::* power;
    const char* fill;
    bool light;  ///< needs dark text
  };
  std::vector<Part> parts = {{"copper", &EnergyAudit::copper, style::copper, true},
                             {"viscous", &EnergyAudit::viscous, style::viscous, true},
                             {"friction", &EnergyAudit::friction, style::friction, true},
                             {"aerodynamic", &EnergyAudit::aerodynamic, style::aerodynamic, true},
                             {"residual", &EnergyAudit::residual, style::residual, true}};
  const auto lost_in = [&](double EnergyAudit::* power) {
    return std::any_of(bars.begin(), bars.end(), [&](const PowerBar& bar) { return bar.audit.*power != 0.0; });
  };
  const bool gearbox = lost_in(&EnergyAudit::gear), hinges = lost_in(&EnergyAudit::hinge);
  const bool motor_friction = lost_in(&EnergyAudit::motor_friction);
  if (hinges) parts.insert(parts.begin() + 2, {"hinges", &EnergyAudit::hinge, style::hinges, false});
  if (gearbox) parts.insert(parts.begin() + 2, {"gearbox", &EnergyAudit::gear, style::gearbox, false});
  if (motor_friction) {
    parts.insert(parts.begin() + 2, {"motor friction", &EnergyAudit::motor_friction, style::motor_friction, false});
  }
  if (lost_in(&EnergyAudit::electronics)) {
    parts.insert(parts.begin(), {"electronics", &EnergyAudit::electronics, style::electronics, false});
  }
  std::vector<KeyEntry> named;
  for (const Part& part : parts) named.push_back(fill_key(part.name, part.fill));
  const Key key(std::move(named), 0.94 * format.width);

  double max_power = 0.0;
  for (const PowerBar& bar : bars) max_power = std::max(max_power, bar.audit.electrical);
  if (!(max_power > 0.0)) throw std::runtime_error("no power breakdown to plot: no electrical input");
  const bool in_watt = max_power >= 10.0;
  const double scale = in_watt ? 1.0 : 1e3;
  const char* unit = in_watt ? "W" : "mW";

  const int decimals = scale * max_power >= 1000.0 ? 0 : scale * max_power >= 100.0 ? 1 : 2;
  const auto shown = [&](double power) { return fmt::format("{:.{}f}", power, decimals); };

  const double count = double(bars.size());
  const double above = 0.23 + key.height(), inches = above + 0.53 + 0.58 * count;
  Figure figure(format, inches);
  figure.add("set border 1\nunset ytics\nset grid noy\n");
  const double longest = scale * max_power;
  const double span = 1.2 * longest;
  double least = 0.0;
  for (std::size_t b = 0; b < bars.size(); ++b) {
    const EnergyAudit& audit = bars[b].audit;
    const double y = count - 1.0 - double(b);
    double right = 0.0, left = 0.0;
    struct Narrow {
      double x;
      const char* fill;
      std::string text;
    };
    std::vector<Narrow> narrow;
    for (const Part& part : parts) {
      const double power = scale * audit.*part.power;
      // A formulation can also add power: such a part stands left of zero.
      const double from = power >= 0.0 ? right : left + power;
      const double to = power >= 0.0 ? right + power : left;
      (power >= 0.0 ? right : left) += power;
      least = std::min(least, left);
      if (std::abs(power) < 1e-4 * longest) continue;
      figure.box(fmt::format("from {},{} to {},{}", from, y - 0.26, to, y + 0.14), part.fill);
      const double share = 100.0 * audit.*part.power / audit.electrical;
      const std::string percent = fmt::format("{:.{}f} %", share, std::abs(share) < 9.95 ? 1 : 0);
      const double middle = 0.5 * (from + to);
      if (to - from > 0.09 * span * single_column_width / format.width) {
        const char* colour = part.light ? "#000000" : "#ffffff";
        figure.text(shown(power), style::text_size,
                    fmt::format("{},{} center textcolor rgb '{}'", middle, y + 0.025, colour));
        figure.text(percent, style::text_size,
                    fmt::format("{},{} center textcolor rgb '{}'", middle, y - 0.145, colour));
      } else {
        narrow.push_back({middle, part.fill, fmt::format("{} ({})", shown(power), percent)});
      }
    }
    // What has no room inside stands above, with the part's colour, pushed aside by its neighbours.
    std::sort(narrow.begin(), narrow.end(), [](const Narrow& p, const Narrow& q) { return p.x < q.x; });
    const double room = 0.215 * span * single_column_width / format.width;
    double limit = least + 0.5 * room;
    for (Narrow& n : narrow) limit = (n.x = std::max(n.x, limit)) + room;
    limit = span - 0.5 * room;
    for (auto n = narrow.rbegin(); n != narrow.rend(); ++n) limit = (n->x = std::min(n->x, limit)) - room;
    for (const Narrow& n : narrow) {
      const double start = n.x - 0.45 * room;
      figure.box(fmt::format("from {},{} to {},{}", start, y + 0.2, start + 0.085 * room, y + 0.27), n.fill);
      figure.text(n.text, style::text_size, fmt::format("{},{} left", start + 0.115 * room, y + 0.235));
    }
    figure.text(bars[b].label, 7.0, fmt::format("0,{} left", y + 0.44));
    figure.text(fmt::format("{} {}", shown(scale * audit.electrical), unit), 7.0,
                fmt::format("{},{} left", right + 0.012 * span, y - 0.06));
  }
  figure.add("set xrange [{}:{}]\nset yrange [-0.36:{}]\n", least, span, count - 0.4);
  figure.add(
      "set lmargin at screen 0.04\nset rmargin at screen 0.97\nset tmargin at screen {}\n"
      "set bmargin at screen {}\n",
      1.0 - above / inches, 0.42 / inches);
  figure.text(fmt::format("power ({})", unit), 7.5, fmt::format("screen 0.505,screen {} center", 0.08 / inches));
  figure.text(title, 8.0, fmt::format("screen 0.04,screen {} left", 1.0 - 0.1 / inches));
  key.draw(figure, 0.04 * format.width, 0.195);
  figure.add("plot NaN\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace wingbeat

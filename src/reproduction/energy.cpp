// The energy picture: flows from supply to air, and power over the cycle with what is stored and returned.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/figure.hpp"
#include "reproduction/sheet.hpp"
#include "wingbeat/report/energy_flow.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {

EnergyFlow energy_flow(const EnergyAudit& a) {
  EnergyFlow flow{a.electrical,
                  a.electrical - a.electronics - a.copper - a.viscous - a.motor_friction - a.gear,
                  {{"copper", a.copper}, {"motor viscous", a.viscous}},
                  {{"friction", a.friction}, {"form. residual", a.residual}},
                  a.aerodynamic};
  if (a.electronics != 0.0) flow.motor.push_back({"electronics", a.electronics});
  if (a.motor_friction != 0.0) flow.motor.push_back({"motor friction", a.motor_friction});
  if (a.gear != 0.0) flow.motor.push_back({"gearbox", a.gear});
  return flow;
}

namespace reproduction {
namespace {

/// A band that leaves a horizontal flow downwards: a quarter turn, then straight.
void bend(Figure& figure, int& object, double x, double y_top, double width, double down_to, const char* fill) {
  // Leaves at x with its upper edge at y_top and its lower one at y_top - width.
  constexpr int points = 24;
  constexpr double inner = 0.06;
  std::string shape = fmt::format("from {:.5f},{:.5f}", x, y_top);
  const double outer = inner + width, centre_y = y_top - outer;
  const auto to = [&](double px, double py) { shape += fmt::format(" to {:.5f},{:.5f}", px, py); };
  for (int n = 1; n <= points; ++n) {
    const double a = 0.25 * two_pi * (1.0 - double(n) / points);
    to(x + outer * std::cos(a), centre_y + outer * std::sin(a));
  }
  to(x + outer, down_to);
  to(x + inner + 0.5 * width, down_to - 0.35 * std::max(width, 0.05));
  to(x + inner, down_to);
  to(x + inner, centre_y);
  for (int n = 0; n <= points; ++n) {
    const double a = 0.25 * two_pi * double(n) / points;
    to(x + inner * std::cos(a), centre_y + inner * std::sin(a));
  }
  to(x, y_top);
  figure.add("set object {} polygon {} front fillcolor rgb '{}' fillstyle solid noborder\n", ++object, shape, fill);
}

struct FlowCase {
  std::string title;
  EnergyFlow flow;
};

void draw_flows(const std::vector<FlowCase>& cases, PlotFormat format, const std::filesystem::path& file) {
  constexpr double panel = 2.4;
  const double inches = panel * double(cases.size()) + 0.1;
  Figure figure(format, 3.5, inches);
  figure.add(
      "unset border\nunset tics\nunset grid\nset lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen "
      "1\n"
      "set bmargin at screen 0\nset xrange [0:3.5]\nset yrange [0:{}]\n",
      inches);
  double highest = 0.0;
  for (const FlowCase& c : cases) highest = std::max(highest, c.flow.supply);
  const double per_watt = 1.0 / highest;  // inches of band
  int object = 500;
  const auto shown = [](double watt) { return fmt::format("{:.1f} mW", 1e3 * watt); };
  for (std::size_t n = 0; n < cases.size(); ++n) {
    const EnergyFlow& f = cases[n].flow;
    const double top = inches - 0.45 - panel * double(n), floor = top - 1.5;
    figure.text(cases[n].title, 8.0, fmt::format("0.05,{} left", top + 0.3));
    const auto share = [&](double power) { return fmt::format("{:.1f} %", 100.0 * power / f.supply); };
    const auto band = [&](double x0, double x1, double y_top, double width, const char* fill) {
      figure.add(
          "set object {} polygon from {:.5f},{:.5f} to {:.5f},{:.5f} to {:.5f},{:.5f} to {:.5f},{:.5f} to "
          "{:.5f},{:.5f} front "
          "fillcolor rgb '{}' fillstyle solid noborder\n",
          ++object, x0, y_top, x1, y_top, x1, y_top - width, x0, y_top - width, x0, y_top, fill);
    };
    double remaining = f.supply * per_watt, x = 0.05;
    const auto leave = [&](const std::string& name, double power, const char* fill, double x_left, const char* colour) {
      // A formulation may also add power; there is no band for less than nothing.
      const double width = std::max(power, 0.0) * per_watt;
      band(x, x_left, top, remaining, "#d0d0d0");
      x = x_left;
      if (width > 0.0015) {
        band(x - 0.0005, x, top, remaining, "#d0d0d0");
        bend(figure, object, x, top - remaining + width, width, floor + 0.22, fill);
      }
      const double middle = x + 0.06 + 0.5 * width;
      figure.text(name, style::text_size,
                  fmt::format("{:.4f},{:.4f} center textcolor rgb '{}'", middle, floor, colour));
      figure.text(shown(power), style::text_size, fmt::format("{:.4f},{:.4f} center", middle, floor - 0.13));
      figure.text(share(power), style::text_size, fmt::format("{:.4f},{:.4f} center", middle, floor - 0.26));
      remaining -= width;
    };
    leave(f.motor[0].name, f.motor[0].power, style::copper, 0.62, "#7a5300");
    leave(f.motor[1].name, f.motor[1].power, style::viscous, 1.52, "#6b6000");
    leave(f.transmission[0].name, f.transmission[0].power, style::friction, 2.12, "#8f3d6e");
    if (std::abs(f.transmission[1].power) > 1e-4 * f.supply) {
      leave(f.transmission[1].name, f.transmission[1].power, style::residual, 2.78, "#505050");
    }
    const double tip = 3.08;
    band(x, tip - 0.1, top, remaining, "#d0d0d0");
    figure.add(
        "set object {} polygon from {:.5f},{:.5f} to {:.5f},{:.5f} to {:.5f},{:.5f} to {:.5f},{:.5f} front fillcolor "
        "rgb '#56b4e9' "
        "fillstyle solid noborder\n",
        ++object, tip - 0.1, top + 0.03, tip + 0.02, top - 0.5 * remaining, tip - 0.1, top - remaining - 0.03,
        tip - 0.1, top + 0.03);
    figure.text("supply", 7.0, fmt::format("0.09,{:.4f} left", top - 0.1));
    figure.text(shown(f.supply), 7.0, fmt::format("0.09,{:.4f} left", top - 0.23));
    figure.text("motor output", style::text_size, fmt::format("1.86,{:.4f} center", top + 0.16));
    figure.text(shown(f.motor_output), style::text_size, fmt::format("1.86,{:.4f} center", top + 0.06));
    figure.text("air", 7.0, fmt::format("3.13,{:.4f} left textcolor rgb '#1f6f9c'", top - 0.5 * remaining + 0.13));
    figure.text(fmt::format("{:.1f}", 1e3 * f.air), style::text_size,
                fmt::format("3.13,{:.4f} left", top - 0.5 * remaining));
    figure.text("mW", style::text_size, fmt::format("3.13,{:.4f} left", top - 0.5 * remaining - 0.12));
    figure.text(share(f.air), style::text_size, fmt::format("3.13,{:.4f} left", top - 0.5 * remaining - 0.24));
  }
  figure.add("plot NaN\nunset output\n");
  run_gnuplot(figure.script(), file);
}

}  // namespace

std::vector<Sheet> energy_sheets(const Material& m) {
  std::vector<Sheet> sheets;
  const double f0 = m.computed.options.frequency;
  for (const Formulation formulation : both_formulations) {
    std::vector<FlowCase> cases;
    Sheet s;
    s.id = formulation == Formulation::rod_force ? "energy-flow" : "energy-flow-virtual-work";
    s.heading = fmt::format("Energy flow at {:g} Hz, {}", f0, name_of(formulation));
    s.section = "energy";
    std::vector<double> springs, columns[7];
    for (const bool on : {false, true}) {
      const CycleCase* c = cycle_of(m.computed.at_frequency, formulation, on);
      if (!c) continue;
      const EnergyAudit a = energy_audit(c->run.metrics);
      cases.push_back({on ? "with springs" : "without springs", energy_flow(a)});
      springs.push_back(on ? 1.0 : 0.0);
      const double powers[] = {a.electrical, a.copper, a.viscous, a.friction, a.residual, a.aerodynamic, a.imbalance};
      for (std::size_t k = 0; k < std::size(powers); ++k) columns[k].push_back(powers[k]);
    }
    if (cases.size() < 2) continue;
    s.table.add("springs", "1", "hinge springs: 0 off, 1 on", springs);
    const char* names[] = {"electrical",           "copper",      "motor_viscous", "friction",
                           "formulation_residual", "aerodynamic", "balance_error"};
    const char* meanings[] = {"electrical input",     "copper loss",        "motor viscous loss",  "friction loss",
                              "formulation residual", "aerodynamic output", "energy-balance error"};
    for (std::size_t k = 0; k < std::size(names); ++k) {
      s.table.add(fmt::format("power_{}_w", names[k]), "W", fmt::format("mean power: {}", meanings[k]), columns[k]);
    }
    const EnergyFlow &off = cases[0].flow, &on = cases[1].flow;
    s.caption = fmt::format(
        "Mean powers of a cycle, bands to the same scale. Springs save {:.1f} mW of input: {:.1f} mW less copper loss, "
        "{:.1f} mW less "
        "friction. The aerodynamic power is {:.1f} mW without springs and {:.1f} mW with them. {}",
        1e3 * (off.supply - on.supply), 1e3 * (off.motor[0].power - on.motor[0].power),
        1e3 * (off.transmission[0].power - on.transmission[0].power), 1e3 * off.air, 1e3 * on.air,
        formulation == Formulation::rod_force ? "The formulation residual is what the paper's equation (1) as "
                                                "printed fails to conserve; it appears in no part of the vehicle."
                                              : "This formulation conserves power: there is no residual.");
    for (const bool springs_in : {false, true}) {
      const CycleCase* c = cycle_of(m.computed.at_frequency, formulation, springs_in);
      if (c && c->run.domain.any()) {
        s.caption += fmt::format(" {} springs outside the domain.", springs_in ? "With" : "Without");
      }
    }
    s.draw = [cases](PlotFormat format, const std::filesystem::path& file) { draw_flows(cases, format, file); };
    sheets.push_back(std::move(s));
  }
  for (const bool on : {false, true}) {
    const CycleCase* c = cycle_of(m.computed.at_frequency, Formulation::rod_force, on);
    if (!c) continue;
    Sheet s;
    s.id = on ? "power-cycle-springs-on" : "power-cycle-springs-off";
    s.heading = fmt::format("Power over a cycle at {:g} Hz, {} springs", f0, on ? "with" : "without");
    s.section = "energy";
    const auto& rows = c->run.cycle;
    std::vector<double> time, electrical, output, aero, stored, ms;
    double stored_sum = 0.0, returned_sum = 0.0;
    for (std::size_t n = 0; n < rows.size(); ++n) {
      time.push_back(rows[n].time - rows.front().time);
      electrical.push_back(rows[n].power_electrical);
      output.push_back(rows[n].motor_torque * rows[n].crank_speed);
      aero.push_back(rows[n].aero_moment * rows[n].flapping_velocity);
      stored.push_back(c->stored_power[n]);
      if (n > 0) {
        const double work = 0.5 * (stored[n] + stored[n - 1]) * (time[n] - time[n - 1]);
        (work > 0.0 ? stored_sum : returned_sum) += work;
      }
    }
    s.table.add("time_s", "s", "time since crank angle zero", time);
    s.table.add("power_electrical_w", "W", "electrical input power", electrical);
    s.table.add("power_motor_w", "W", "motor output power", output);
    s.table.add("power_aerodynamic_w", "W", "aerodynamic power", aero);
    s.table.add("power_stored_w", "W", "power into the inertia of the wings and their springs; negative: returned",
                stored);
    s.caption = fmt::format(
        "Shaded: power that goes into wings and springs ({:.2f} mJ in each cycle) and comes back from them ({:.2f} "
        "mJ). {}",
        1e3 * stored_sum, -1e3 * returned_sum,
        on ? "With springs less of it passes through the rod and its joints, whose friction grows with the force."
           : "Without springs all of it passes through the rod twice in each cycle, with a friction loss each time.");
    Chart chart;
    chart.x = "time since stroke reversal (ms)";
    chart.panel_height = 2.3;
    const CurveStyle supply{style::ink}, motor{style::grey, style::dashed}, air{style::aerodynamic};
    constexpr const char *into = "#c8c8c8", *out_of = "#ececec";
    chart.key = {{"electrical input", supply},
                 {"motor output", motor},
                 {"aerodynamic", air},
                 {"stored in wings and springs", {}, into},
                 {"returned", {}, out_of}};
    ChartPanel panel;
    panel.y = "power (mW)";
    const std::vector<style::Phase> order = style::phases(rows);
    std::vector<double> t_ms;
    for (const style::Phase& phase : order) t_ms.push_back(1e3 * phase.periods * time.back());
    const auto drawn = [&](const std::vector<double>& watt) {
      std::vector<double> y;
      for (const style::Phase& phase : order) y.push_back(1e3 * watt[phase.row]);
      return y;
    };
    panel.areas.push_back({t_ms, drawn(stored), into, out_of});
    panel.curves = {{t_ms, drawn(stored), {style::grey, style::solid, style::thin_width}, "stored"},
                    {t_ms, drawn(electrical), supply, "electrical input"},
                    {t_ms, drawn(output), motor, "motor output"},
                    {t_ms, drawn(aero), air, "aerodynamic"}};
    chart.panels.push_back(std::move(panel));
    s.draw = [chart](PlotFormat format, const std::filesystem::path& file) { reproduction::draw(chart, format, file); };
    sheets.push_back(std::move(s));
  }
  return sheets;
}

}  // namespace reproduction
}  // namespace wingbeat

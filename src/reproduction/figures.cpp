// Figures 4 to 7 and 9 to 19 of the 2022 friction paper.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <utility>

#include "wingbeat/core/text.hpp"

#include "reproduction/trend_figure.hpp"

namespace wingbeat::reproduction {
namespace {

using enum Formulation;

/// One quantity of the four cycles over the fraction of the period; `mark` adds published values.
Sheet cycle_sheet(int number, const std::vector<CycleCase>& cycles, double WaveformRow::* value, double scale,
                  const char* name, const char* unit, std::string label, std::string what,
                  const std::function<void(ChartPanel&)>& mark) {
  Sheet s = sheet(number, std::move(what), "cycles");
  Chart chart;
  chart.x = "time since stroke reversal / period";
  chart.key = springs_key();
  chart.panel_height = 1.9;
  ChartPanel panel;
  panel.y = std::move(label);
  for (const CycleCase& c : cycles) {
    if (c.run.cycle.empty()) continue;
    const auto& rows = c.run.cycle;
    std::vector<double> fraction, time, angle, y, periods, drawn;
    for (const WaveformRow& row : rows) {
      fraction.push_back((row.time - rows.front().time) / (rows.back().time - rows.front().time));
      time.push_back(row.time);
      angle.push_back(row.crank_angle);
      y.push_back(row.*value);
    }
    for (const auto& [row, phase] : style::phases(rows)) {
      periods.push_back(phase);
      drawn.push_back(scale * y[row]);
    }
    const std::string which = fmt::format("{}_{}", springs_name(c.flapping_case.springs),
                                          detail::underscored(wingbeat::name_of(c.flapping_case.formulation)));
    const std::string words = fmt::format("{} springs, {}", c.flapping_case.springs ? "with" : "without",
                                          wingbeat::name_of(c.flapping_case.formulation));
    if (s.table.columns.empty())
      s.table.add("cycle_fraction", "1", "time over period, from crank angle zero", fraction);
    s.table.add("time_s_" + which, "s", "time since crank angle zero, " + words, time);
    s.table.add("crank_angle_rad_" + which, "rad", "crank angle, " + words, angle);
    s.table.add(fmt::format("{}_{}", name, which), unit, fmt::format("{}, {}", name, words), y);
    panel.curves.push_back(
        {periods, drawn, style_of(c.flapping_case, false), words, wingbeat::name_of(c.flapping_case.formulation)});
  }
  mark(panel);
  chart.panels.push_back(std::move(panel));
  finish(s, std::move(chart));
  return s;
}

/// Where a cycle has its greatest magnitude (or its highest value), as drawn: periods since stroke reversal and value.
std::pair<double, double> peak_of(const std::vector<CycleCase>& cycles, bool springs, double WaveformRow::* value) {
  const CycleCase* c = cycle_of(cycles, rod_force, springs);
  std::pair<double, double> peak{absent, 0.0};
  if (!c) return peak;
  for (const auto& [row, phase] : style::phases(c->run.cycle)) {
    const double y = c->run.cycle[row].*value;
    if (std::abs(y) > std::abs(peak.second)) peak = {phase, y};
  }
  return peak;
}

}  // namespace

std::vector<Sheet> paper_sheets(const Material& m) {
  std::vector<Sheet> sheets;
  const Reproduction& r = m.computed;
  const TrendSet& f = r.frequency;
  const double f0 = r.options.frequency;
  const FlappingCase off{rod_force, false, Condition::air}, on{rod_force, true, Condition::air},
      empty{rod_force, false, Condition::vacuum}, bare{rod_force, false, Condition::wingless};
  const auto by_condition = [](const TrendCurve& c) { return !c.flapping_case.springs; };
  const auto by_springs = [](const TrendCurve& c) { return c.flapping_case.condition == Condition::air; };
  const auto condition_style = [](const TrendCurve& c) { return style_of(c.flapping_case, true); };
  const auto springs_style = [](const TrendCurve& c) { return style_of(c.flapping_case, false); };
  const auto& j = m.assessment;

  const auto frequency_sheet = [&](int number, std::string what, bool conditions, std::string caption,
                                   const std::vector<std::tuple<Metric, const char*, const char*>>& panels,
                                   const std::function<void(std::vector<ChartPanel>&)>& mark = {}) {
    Sheet s = sheet(number, std::move(what), conditions ? "conditions" : "springs");
    TrendFigure figure(frequency_axis(r), 1.0, frequency_label);
    figure.chart().key = formulation_key();
    figure.chart().panel_height = panels.size() == 1 ? 1.9 : 1.5;
    figure.chart().columns = panels.size() < 4 ? 1 : 2;
    for (const auto& [metric, label, title] : panels) {
      if (conditions) figure.panel(f, metric, label, title, by_condition, condition_style, condition_label_of);
      else figure.panel(f, metric, label, title, by_springs, springs_style, springs_label_of);
    }
    if (mark) mark(figure.chart().panels);
    s.caption = std::move(caption);
    figure.into(s);
    sheets.push_back(std::move(s));
  };
  const auto value = [&](const FlappingCase& which, Metric metric) { return at(f, which, metric, f0); };
  const auto shown = [&](const FlappingCase& which, Metric metric) {
    return mw(value(which, metric)) + domain_remark_at(f, which, f0);
  };
  const auto three = [&](Metric metric) {
    return fmt::format("At {:g} Hz: {} in air, {} in vacuum, {} without wings", f0, shown(off, metric),
                       shown(empty, metric), shown(bare, metric));
  };
  const auto two = [&](Metric metric) {
    return fmt::format("At {:g} Hz: {} without springs, {} with them", f0, shown(off, metric), shown(on, metric));
  };

  frequency_sheet(
      4, "Electrical input power in air, in vacuum and without wings", true,
      three(Metric::power_electrical) +
          " (rod-force, no springs). Most of the input is spent in the motor and the mechanism, even without air. "
          "By virtual-work (dashed) it is lower in air and in vacuum; without wings the formulations are the same. The "
          "paper's "
          "curves are not available numerically.",
      {{Metric::power_electrical, "electrical input power (mW)", ""}});
  frequency_sheet(5, "Motor output power as a test bench estimates it (eq 17)", true,
                  three(Metric::power_motor_reference) +
                      ". The estimate is the bench's torque constant times current and speed, so that it contains the "
                      "motor viscous loss: without wings it is not zero, although the motor output is.",
                  {{Metric::power_motor_reference, "estimated motor output (mW)", ""}});
  Sheet lift = sheet(6, "Mean lift against flapping frequency", "conditions");
  {
    TrendFigure figure(frequency_axis(r), 1.0, frequency_label);
    figure.chart().key = formulation_key();
    figure.chart().panel_height = 1.9;
    figure.panel(
        f, Metric::lift_mean, "mean lift (mN)", "",
        [](const TrendCurve& c) { return c.flapping_case.condition == Condition::air && !c.flapping_case.springs; },
        springs_style, springs_label_of);
    const double a = at(f, off, Metric::lift_mean, 10.0), b = at(f, off, Metric::lift_mean, 20.0);
    lift.caption = fmt::format(
        "In air, without springs. From 10 to 20 Hz the mean lift grows {:.2f}-fold, more than the square of the "
        "frequency ({:.0f}-fold): the wings pitch more at higher flapping velocity, which raises the lift coefficient. "
        "{:.2f} mN at {:g} Hz.",
        b / a, 4.0, 1e3 * value(off, Metric::lift_mean), f0);
    figure.into(lift);
    sheets.push_back(std::move(lift));
  }
  frequency_sheet(
      7, "Input power, total loss, motor output and friction loss", true,
      fmt::format(
          "Panels a and b are (a) of the paper, c and d (b). In air the loss is {:.0f} % of the input at {:g} Hz; "
          "in vacuum and without wings all of it. "
          "Friction takes {} of {} motor output in air, {} of {} in vacuum: it follows the inertial load at stroke "
          "reversal, which does not depend on air. The paper says that motor output minus friction equals the "
          "aerodynamic power; ratio at {:g} Hz: {}. The difference by rod-force is its formulation residual.",
          100.0 * value(off, Metric::power_loss) / value(off, Metric::power_electrical), f0,
          shown(off, Metric::power_friction), shown(off, Metric::power_motor), shown(empty, Metric::power_friction),
          shown(empty, Metric::power_motor), f0, beside(m.assessment, "motor output minus friction")),
      {{Metric::power_electrical, "power (mW)", "electrical input"},
       {Metric::power_loss, "power (mW)", "total loss"},
       {Metric::power_motor, "power (mW)", "motor output"},
       {Metric::power_friction, "power (mW)", "friction loss"}});
  frequency_sheet(
      9, "Input and motor output power with and without springs", false,
      two(Metric::power_electrical) +
          fmt::format(" (electrical, rod-force). Springs raise the input below a frequency and lower it above: {}. "
                      "Change by springs at {:g} Hz: {}.",
                      beside(m.assessment, "springs raise the electrical input"), f0,
                      beside(m.assessment, "mean electrical input power, change")),
      {{Metric::power_electrical, "power (mW)", "electrical input"},
       {Metric::power_motor, "power (mW)", "motor output"}},
      [&](std::vector<ChartPanel>& panels) {
        mark_published(panels[0], j, "mean electrical input power, change", style::with_springs, [&](double change) {
          return std::pair(f0, 1e3 * (1.0 + change) * value(off, Metric::power_electrical));
        });
        mark_published(panels[0], j, "springs raise the electrical input", style::ink,
                       [](double hz) { return std::pair(hz, absent); });
      });
  {
    // The last frequency at which springs add.
    const TrendCurve &with = curve_of(f, on), &without = curve_of(f, off);
    const auto reactive = [](const TrendCurve& c, std::size_t n) { return c.metrics[n][Metric::power_reactive]; };
    std::string said = fmt::format(
        " Frequency of its dip with springs, searched from 8 to 30 Hz; the lower end of the range lies lower: {}.",
        beside(m.assessment, "with springs the mean absolute reactive power"));
    for (std::size_t n = f.axis.size(); n-- > 0;) {
      if (!(reactive(with, n) > reactive(without, n))) continue;
      said += fmt::format(" Up to {:.3g} Hz it is higher than without springs: the springs are too stiff there.",
                          f.axis[n]);
      break;
    }
    frequency_sheet(10, "Mean absolute reactive power with and without springs", false,
                    two(Metric::power_reactive) + "." + said +
                        fmt::format(" As a share of the input: {}.",
                                    beside(m.assessment, "with springs the mean absolute reactive power, as a share")),
                    {{Metric::power_reactive, "reactive power (mW)", ""}}, [&](std::vector<ChartPanel>& panels) {
                      mark_published(panels[0], j, "with springs the mean absolute reactive power", style::with_springs,
                                     [](double hz) { return std::pair(hz, absent); });
                    });
  }
  frequency_sheet(
      11, "Losses with and without springs", false,
      fmt::format(
          "All losses at {:g} Hz: {} without springs, {} with. Friction falls from {} to {}, and the copper loss "
          "from {} to {}: a lower friction torque takes a lower current. The motor viscous loss depends on "
          "speed alone and "
          "is "
          "almost unaffected by the springs.",
          f0, shown(off, Metric::power_loss), shown(on, Metric::power_loss), shown(off, Metric::power_friction),
          shown(on, Metric::power_friction), shown(off, Metric::power_copper), shown(on, Metric::power_copper)),
      {{Metric::power_loss, "power (mW)", "all losses"},
       {Metric::power_copper, "power (mW)", "copper"},
       {Metric::power_friction, "power (mW)", "friction"},
       {Metric::power_viscous, "power (mW)", "motor viscous loss"}});
  frequency_sheet(
      12, "Efficiency of system, motor and mechanism, with and without springs", false,
      fmt::format(
          "Panel a is (a) of the paper, b and c are (b). Frequency of maximum system efficiency with springs: {}. "
          "Of maximum mechanism efficiency: {}. Gain of the "
          "system at {:g} Hz: {}. The motor efficiency is almost unaffected by the springs; at 3 V without springs: "
          "{}.",
          beside(m.assessment, "with springs the system"), beside(m.assessment, "with springs the mechanism"), f0,
          beside(m.assessment, "gain in system efficiency"), beside(m.assessment, "motor efficiency in the flapper")),
      {{Metric::efficiency_system, "efficiency (%)", "system"},
       {Metric::efficiency_motor, "efficiency (%)", "motor"},
       {Metric::efficiency_mechanism, "efficiency (%)", "mechanism"}},
      [&](std::vector<ChartPanel>& panels) {
        const auto place = [](double hz) { return std::pair(hz, absent); };
        mark_published(panels[0], j, "with springs the system efficiency is highest", style::with_springs, place);
        mark_published(panels[2], j, "with springs the mechanism efficiency is highest", style::with_springs, place);
        mark_published(panels[0], j, "gain in system efficiency", style::with_springs, [&](double gain) {
          return std::pair(f0, 100.0 * (value(off, Metric::efficiency_system) + gain));
        });
        const Claim* at_3_volt = claim_of(j, "flapping frequency without springs at 3 V");
        mark_published(panels[1], j, "motor efficiency in the flapper", style::without_springs, [&](double share) {
          return std::pair(at_3_volt && at_3_volt->published ? *at_3_volt->published : absent, 100.0 * share);
        });
        for (const PublishedTrend& t : m.file.trends) {
          if (t.kind != PublishedTrend::Kind::best_range || t.restates || !t.published || !t.published_end) continue;
          const bool with = t.statement.find("with springs") != std::string::npos;
          panels[0].spans.push_back(
              {*t.published, *t.published_end, t.statement, with ? style::with_springs : style::without_springs});
        }
      });
  frequency_sheet(
      13, "Mean lift with and without springs", false,
      fmt::format("At prescribed frequency springs change the velocity profile, not the stroke amplitude: the wings "
                  "are faster in "
                  "mid-stroke. Change by springs at {:g} Hz: {}.",
                  f0, beside(m.assessment, fmt::format("mean lift, change by springs at {:g} Hz", f0))),
      {{Metric::lift_mean, "mean lift (mN)", ""}}, [&](std::vector<ChartPanel>& panels) {
        mark_published(
            panels[0], j, fmt::format("mean lift, change by springs at {:g} Hz", f0), style::with_springs,
            [&](double change) { return std::pair(f0, 1e3 * (1.0 + change) * value(off, Metric::lift_mean)); });
      });

  using R = WaveformRow;
  const auto cycles = [&](
                          int number, bool held, double R::* quantity, double scale, const char* name, const char* unit,
                          std::string label, const char* what, const std::string& said,
                          const std::function<void(ChartPanel&)>& mark = [](ChartPanel&) {}) {
    Sheet s = cycle_sheet(number, held ? r.at_frequency : r.at_voltage, quantity, scale, name, unit, std::move(label),
                          fmt::format("{} over a cycle at {}", what,
                                      held ? fmt::format("{:g} Hz", f0) : fmt::format("{:g} V", r.options.voltage)),
                          mark);
    s.caption = said + domain_remark(held ? r.at_frequency : r.at_voltage);
    sheets.push_back(std::move(s));
  };
  const std::string hz = fmt::format("{:g} Hz", f0), v = fmt::format("{:g} V", r.options.voltage);
  // A published ratio of peaks stands where the computed peak is, over the computed peak without springs.
  const auto ratio_of_peaks = [&](const std::vector<CycleCase>& cases, const std::string& statement,
                                  double R::* quantity) {
    return [&, statement, quantity](ChartPanel& panel) {
      mark_published(panel, j, statement, style::with_springs, [&](double change) {
        return std::pair(peak_of(cases, true, quantity).first, (1.0 + change) * peak_of(cases, false, quantity).second);
      });
    };
  };
  const auto peaks = [&](const std::string& begins, double R::* quantity) {
    return [&, begins, quantity](ChartPanel& panel) {
      for (const bool springs : {false, true}) {
        const auto [phase, computed] = peak_of(r.at_frequency, springs, quantity);
        mark_published(
            panel, j, fmt::format("{} {} springs at {}", begins, springs ? "with" : "without", hz),
            springs ? style::with_springs : style::without_springs,
            [&, x = phase, sign = computed](double newton) { return std::pair(x, std::copysign(1e3 * newton, sign)); });
      }
    };
  };
  cycles(14, true, &R::flapping_velocity, 1.0, "flapping_velocity_rad_per_s", "rad/s", "flapping velocity (rad/s)",
         "Flapping velocity",
         fmt::format("With springs the velocity's peaks are higher at the same frequency: springs accelerate the wings "
                     "after stroke reversal. Change of the peaks: {}.",
                     beside(j, "peak flapping velocity, change by springs at " + hz)),
         ratio_of_peaks(r.at_frequency, "peak flapping velocity, change by springs at " + hz, &R::flapping_velocity));
  cycles(15, true, &R::lift, 1e3, "lift_n", "N", "lift (mN)", "Lift",
         fmt::format("Two peaks, one for each half-stroke. Peak without springs: {}. With springs: {}.",
                     beside(j, "peak lift without springs at " + hz), beside(j, "peak lift with springs at " + hz)),
         peaks("peak lift", &R::lift));
  cycles(16, true, &R::rod_force, 1e3, "rod_force_n", "N", "rod force (mN)", "Rod force",
         fmt::format("Springs carry part of the inertial load at stroke reversal. The paper calls the rod force the "
                     "crank reaction force. Peak magnitude without "
                     "springs: {}. With springs: {}.",
                     beside(j, "peak magnitude of the rod force without springs at " + hz),
                     beside(j, "peak magnitude of the rod force with springs at " + hz)),
         peaks("peak magnitude of the rod force", &R::rod_force));
  const auto frequency_at = [&](bool springs) {
    const CycleCase* c = cycle_of(r.at_voltage, rod_force, springs);
    return c ? c->run.metrics[Metric::frequency] : absent;
  };
  cycles(
      17, false, &R::lift, 1e3, "lift_n", "N", "lift (mN)", "Lift",
      fmt::format(
          "At the same voltage the vehicle with springs also flaps faster, {:.2f} instead of {:.2f} Hz (rod-force; the "
          "axis is scaled to each period). Change of the mean lift by springs: {}.",
          frequency_at(true), frequency_at(false), beside(j, "mean lift, change by springs at " + v)));
  cycles(
      18, false, &R::flapping_velocity, 1.0, "flapping_velocity_rad_per_s", "rad/s", "flapping velocity (rad/s)",
      "Flapping velocity",
      fmt::format("Change of the peak by springs: {}.", beside(j, "peak flapping velocity, change by springs at " + v)),
      ratio_of_peaks(r.at_voltage, "peak flapping velocity, change by springs at " + v, &R::flapping_velocity));
  cycles(19, false, &R::rod_force, 1e3, "rod_force_n", "N", "rod force (mN)", "Rod force",
         fmt::format("The mean magnitude of the force falls although the wings beat faster. Change by springs: {}.",
                     beside(j, "mean magnitude of the rod force, change by springs at " + v)));

  return sheets;
}

}  // namespace wingbeat::reproduction

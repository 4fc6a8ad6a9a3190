// Figures 4 to 7 and 9 to 22 of the 2022 friction paper.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "sheet.hpp"
#include "wingbeat/io/report.hpp"

namespace wingbeat::reproduction {
namespace {

using enum Formulation;

// Colours of Okabe and Ito.
constexpr CurveStyle springs_on{"#0072b2", "1", 7};
constexpr CurveStyle springs_off{"#d55e00", "(12,6)", 4};
constexpr CurveStyle wingless{"#000000", "(3,3)", 8};
constexpr CurveStyle vacuum{"#009e73", "(14,4,3,4)", 6};
constexpr CurveStyle air{"#0072b2", "1", 7};
constexpr CurveStyle plain_thin{"#606060", "1", 0, 0.55};
constexpr CurveStyle radii[] = {
    {"#d55e00", "(12,6)", 4}, {"#0072b2", "1", 7}, {"#009e73", "(14,4,3,4)", 6}, {"#000000", "(3,3)", 8}};

const char* name_of(bool springs) { return springs ? "springs_on" : "springs_off"; }

std::string underscored(std::string text) {
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

std::vector<double> scaled(const std::vector<double>& x, double factor) {
  std::vector<double> y;
  for (const double v : x) y.push_back(factor * v);
  return y;
}

std::vector<double> column(const TrendCurve& curve, Metric metric) {
  std::vector<double> y;
  for (const Metrics<double>& m : curve.metrics) y.push_back(m[metric]);
  return y;
}

double scale_of(Metric metric) {
  const std::string_view unit = metric_info(metric).unit;
  return unit == "1" ? 100.0 : 1e3;  // per cent, mW and mN
}

Sheet sheet(int number, std::string what, std::string section) {
  Sheet s;
  s.id = fmt::format("figure-{:02}", number);
  s.heading = fmt::format("Figure {}. {}", number, what);
  s.section = std::move(section);
  return s;
}

void finish(Sheet& s, Chart chart) {
  s.draw = [chart = std::move(chart)](PlotFormat format, const std::filesystem::path& file) {
    reproduction::draw(chart, format, file);
  };
}

CurveStyle style_of(const FlappingCase& of, bool by_condition) {
  CurveStyle style = by_condition ? of.condition == Condition::air      ? air
                                    : of.condition == Condition::vacuum ? vacuum
                                                                        : wingless
                     : of.springs ? springs_on
                                  : springs_off;
  return of.formulation == rod_force ? style : thin(style);
}

std::vector<ChartKey> springs_key() {
  return {{"springs on", springs_on}, {"springs off", springs_off}, {"thin: virtual-work", plain_thin}};
}

std::vector<ChartKey> condition_key() {
  return {{"air", air}, {"vacuum", vacuum}, {"wingless", wingless}, {"thin: virtual-work", plain_thin}};
}

/// A figure of metrics along an axis, one panel for each metric.
class TrendFigure {
 public:
  TrendFigure(const TableColumn& axis, double scale, std::string label) : scale_(scale) {
    table_.add(axis.name, axis.unit, axis.long_name, axis.values);
    chart_.x = std::move(label);
  }

  /// Draws and tabulates one metric of the curves that `wanted` lets pass; `tag` tells columns of several sets apart.
  template <class Wanted, class Style>
  void panel(const TrendSet& set, Metric metric, std::string label, std::string title, const Wanted& wanted,
             const Style& style, const std::string& tag = "") {
    const MetricInfo& info = metric_info(metric);
    ChartPanel panel;
    panel.y = std::move(label);
    panel.title = std::move(title);
    for (const TrendCurve& curve : set.curves) {
      if (!wanted(curve)) continue;
      const std::vector<double> y = column(curve, metric);
      const std::optional<CurveStyle> drawn = style(curve);
      if (drawn) panel.curves.push_back({scaled(set.axis, scale_), scaled(y, scale_of(metric)), *drawn});
      std::string name = fmt::format("{}_{}_{}", info.key, condition_of(curve), name_of(curve.of.springs));
      std::string meaning = fmt::format("{}, {}, {}", info.long_name, condition_of(curve),
                                        curve.of.springs ? "springs on" : "springs off");
      if (std::isfinite(curve.crank_radius)) {
        name += fmt::format("_crank_{:g}_mm", 1e3 * curve.crank_radius);
        meaning += fmt::format(", crank radius {:g} mm", 1e3 * curve.crank_radius);
      }
      if (!tag.empty()) {
        name += fmt::format("_{}", underscored(tag));
        meaning += ", " + tag;
        std::replace(name.begin(), name.end(), ' ', '_');
      }
      if (curve.of.condition != Condition::wingless) {
        name += fmt::format("_{}", underscored(wingbeat::name_of(curve.of.formulation)));
        meaning += fmt::format(", {}", wingbeat::name_of(curve.of.formulation));
      }
      if (std::none_of(table_.columns.begin(), table_.columns.end(), [&](const auto& c) { return c.name == name; })) {
        table_.add(name, info.unit, meaning, y);
      }
    }
    chart_.panels.push_back(std::move(panel));
  }

  Chart& chart() { return chart_; }
  void into(Sheet& s) {
    s.table = table_;
    finish(s, chart_);
  }

 private:
  static const char* condition_of(const TrendCurve& curve) { return wingbeat::name_of(curve.of.condition); }
  double scale_;
  Chart chart_;
  Table table_;
};

const TrendCurve& curve_of(const TrendSet& set, const FlappingCase& of, double radius = absent) {
  for (const TrendCurve& c : set.curves) {
    if (c.of == of && (!std::isfinite(radius) || c.crank_radius == radius)) return c;
  }
  throw std::runtime_error("a curve is missing");
}

/// A metric at the place of an axis nearest to x.
double at(const TrendSet& set, const FlappingCase& of, Metric metric, double x) {
  std::size_t best = 0;
  for (std::size_t n = 0; n < set.axis.size(); ++n) {
    if (std::abs(set.axis[n] - x) < std::abs(set.axis[best] - x)) best = n;
  }
  return curve_of(set, of).metrics[best][metric];
}

TableColumn frequency_axis(const Reproduction& r) {
  return {"frequency_hz", "Hz", "flapping frequency", r.frequency.axis};
}
const char* const frequency_label = "flapping frequency (Hz)";

std::string mw(double watt) { return fmt::format("{:.0f} mW", 1e3 * watt); }

/// One quantity of the four cycles over the fraction of the period.
Sheet cycle_sheet(int number, const std::vector<CycleCase>& cycles, double WaveformRow::*value, double scale,
                  const char* name, const char* unit, std::string label, std::string what) {
  Sheet s = sheet(number, std::move(what), "cycles");
  Chart chart;
  chart.x = "time / period (1)";
  chart.key = springs_key();
  chart.panel_height = 1.9;
  ChartPanel panel;
  panel.y = std::move(label);
  for (const CycleCase& c : cycles) {
    if (c.run.cycle.empty()) continue;
    const auto& rows = c.run.cycle;
    std::vector<double> fraction, time, angle, y;
    for (const WaveformRow& row : rows) {
      fraction.push_back((row.time - rows.front().time) / (rows.back().time - rows.front().time));
      time.push_back(row.time);
      angle.push_back(row.crank_angle);
      y.push_back(row.*value);
    }
    const std::string which =
        fmt::format("{}_{}", name_of(c.of.springs), underscored(wingbeat::name_of(c.of.formulation)));
    const std::string words =
        fmt::format("springs {}, {}", c.of.springs ? "on" : "off", wingbeat::name_of(c.of.formulation));
    if (s.table.columns.empty())
      s.table.add("cycle_fraction", "1", "time over period, from crank angle zero", fraction);
    s.table.add("time_s_" + which, "s", "time since crank angle zero, " + words, time);
    s.table.add("crank_angle_rad_" + which, "rad", "crank angle, " + words, angle);
    s.table.add(fmt::format("{}_{}", name, which), unit, fmt::format("{}, {}", name, words), y);
    panel.curves.push_back({fraction, scaled(y, scale), style_of(c.of, false)});
  }
  chart.panels.push_back(std::move(panel));
  finish(s, std::move(chart));
  return s;
}

/// "published 1.142, ours 1.144 (rod-force) and 1.129 (virtual-work)" for the claim of that beginning.
std::string beside(const Judgement& j, const std::string& beginning) {
  for (const Claim& c : j.claims) {
    if (c.statement.rfind(beginning, 0) != 0) continue;
    std::string text = c.published_text == "-" ? "" : fmt::format("published {}, ", c.published_text);
    return text + fmt::format("ours {} (rod-force) and {} (virtual-work): {}", c.ours_text[0], c.ours_text[1],
                              wingbeat::name_of(c.verdict));
  }
  return "no published number is at hand";
}

}  // namespace

std::vector<Sheet> paper_sheets(const Material& m) {
  std::vector<Sheet> sheets;
  const Reproduction& r = m.computed;
  const TrendSet& f = r.frequency;
  const double f0 = r.options.frequency;
  const FlappingCase off{rod_force, false, Condition::air}, on{rod_force, true, Condition::air},
      empty{rod_force, false, Condition::vacuum}, bare{rod_force, false, Condition::wingless};
  const auto by_condition = [](const TrendCurve& c) { return !c.of.springs; };
  const auto by_springs = [](const TrendCurve& c) { return c.of.condition == Condition::air; };
  const auto condition_style = [](const TrendCurve& c) { return std::optional(style_of(c.of, true)); };
  const auto springs_style = [](const TrendCurve& c) { return std::optional(style_of(c.of, false)); };

  const auto frequency_sheet = [&](int number, std::string what, bool conditions, std::string caption,
                                   const std::vector<std::tuple<Metric, const char*, const char*>>& panels) {
    Sheet s = sheet(number, std::move(what), conditions ? "conditions" : "springs");
    TrendFigure figure(frequency_axis(r), 1.0, frequency_label);
    figure.chart().key = conditions ? condition_key() : springs_key();
    figure.chart().panel_height = panels.size() == 1 ? 1.9 : panels.size() == 2 ? 1.5 : 1.15;
    for (const auto& [metric, label, title] : panels) {
      if (conditions)
        figure.panel(f, metric, label, title, by_condition, condition_style);
      else
        figure.panel(f, metric, label, title, by_springs, springs_style);
    }
    s.caption = std::move(caption);
    figure.into(s);
    sheets.push_back(std::move(s));
  };
  const auto value = [&](const FlappingCase& of, Metric metric) { return at(f, of, metric, f0); };
  const auto three = [&](Metric metric) {
    return fmt::format("At {:g} Hz: {} in air, {} in vacuum, {} without wings", f0, mw(value(off, metric)),
                       mw(value(empty, metric)), mw(value(bare, metric)));
  };
  const auto two = [&](Metric metric) {
    return fmt::format("At {:g} Hz: {} without springs, {} with them", f0, mw(value(off, metric)),
                       mw(value(on, metric)));
  };

  frequency_sheet(
      4, "Electrical input power in air, in vacuum and without wings", true,
      three(Metric::power_electrical) +
          " (rod-force, no springs). Most of the input is spent before the wings meet any air: moving them "
          "costs more in the motor and the mechanism than the air itself takes. Virtual-work (thin) needs "
          "less in air and vacuum; without wings there is nothing for the formulations to differ in. The paper shows "
          "the curves; no number of them is at hand.",
      {{Metric::power_electrical, "electrical input power (mW)", ""}});
  frequency_sheet(5, "Motor output power as a test bench estimates it (eq 17)", true,
                  three(Metric::power_motor_reference) +
                      ". The estimate takes all of the bench's torque constant times the current for output, so that "
                      "it is not zero without wings, where the motor gives nothing: it contains the motor's own drag.",
                  {{Metric::power_motor_reference, "estimated motor output (mW)", ""}});
  Sheet lift = sheet(6, "Mean lift against flapping frequency", "conditions");
  {
    TrendFigure figure(frequency_axis(r), 1.0, frequency_label);
    figure.chart().key = {{"springs off", springs_off}, {"thin: virtual-work", plain_thin}};
    figure.chart().panel_height = 1.9;
    figure.panel(
        f, Metric::lift_mean, "mean lift (mN)", "",
        [](const TrendCurve& c) { return c.of.condition == Condition::air && !c.of.springs; }, springs_style);
    const double a = at(f, off, Metric::lift_mean, 10.0), b = at(f, off, Metric::lift_mean, 20.0);
    lift.caption = fmt::format(
        "In air, without springs. From 10 to 20 Hz the mean lift grows {:.2f}-fold, near the square of the frequency "
        "({:.0f}): the "
        "wings pitch more as they beat faster, which takes from the growth. {:.2f} mN at {:g} Hz.",
        b / a, 4.0, 1e3 * value(off, Metric::lift_mean), f0);
    figure.into(lift);
    sheets.push_back(std::move(lift));
  }
  frequency_sheet(
      7, "(a) Input power and total loss, (b) motor output and friction loss", true,
      fmt::format(
          "(a) In air the loss is {:.0f} % of the input at {:g} Hz; in vacuum and without wings all of it. (b) "
          "Friction takes {} of {} motor output in air, {} of {} in vacuum: it follows the force that turns the "
          "wings' inertia round, which is there without air too. What is left over in vacuum is the residual of the "
          "formulation rod-force; virtual-work has none.",
          100.0 * value(off, Metric::power_loss) / value(off, Metric::power_electrical), f0,
          mw(value(off, Metric::power_friction)), mw(value(off, Metric::power_motor)),
          mw(value(empty, Metric::power_friction)), mw(value(empty, Metric::power_motor))),
      {{Metric::power_electrical, "power (mW)", "(a) electrical input"},
       {Metric::power_loss, "power (mW)", "(a) total loss"},
       {Metric::power_motor, "power (mW)", "(b) motor output"},
       {Metric::power_friction, "power (mW)", "(b) friction loss"}});
  frequency_sheet(
      9, "Input and motor output power with and without springs", false,
      two(Metric::power_electrical) +
          fmt::format(" (electrical, rod-force). Springs cost power below a frequency and save above: {}. Ratio at "
                      "{:g} Hz: {}.",
                      beside(m.judgement, "springs raise"), f0, beside(m.judgement, "mean electrical input power")),
      {{Metric::power_electrical, "power (mW)", "electrical input"},
       {Metric::power_motor, "power (mW)", "motor output"}});
  {
    // A minimum between its neighbours, the one nearest to resonance; and the last frequency at which springs add.
    const TrendCurve &with = curve_of(f, on), &without = curve_of(f, off);
    const auto reactive = [](const TrendCurve& c, std::size_t n) { return c.metrics[n][Metric::power_reactive]; };
    std::string said;
    for (std::size_t n = f.axis.size() - 1; n-- > 1;) {
      if (f.axis[n] > f0 || !(reactive(with, n) < reactive(with, n - 1) && reactive(with, n) < reactive(with, n + 1))) {
        continue;
      }
      said += fmt::format(
          " With springs it has a minimum of {} near {:.3g} Hz, where inertia and springs exchange most of the energy "
          "between themselves; the stroke is no pure sine, so that the minimum is neither zero nor exactly at the "
          "springs' {:g} Hz.",
          mw(reactive(with, n)), f.axis[n], f0);
      break;
    }
    for (std::size_t n = f.axis.size(); n-- > 0;) {
      if (!(reactive(with, n) > reactive(without, n))) continue;
      said += fmt::format(
          " Up to {:.3g} Hz it is higher than without springs: there the springs are too stiff, and the motor has to "
          "wind them.",
          f.axis[n]);
      break;
    }
    frequency_sheet(10, "Mean absolute reactive power with and without springs", false,
                    two(Metric::power_reactive) + "." + said, {{Metric::power_reactive, "reactive power (mW)", ""}});
  }
  frequency_sheet(
      11, "Losses with and without springs", false,
      fmt::format(
          "All losses at {:g} Hz: {} without springs, {} with. Friction falls from {} to {}, and the copper loss "
          "from {} to {}: the motor has less friction torque to overcome, so less current. The motor's own drag "
          "depends on speed alone and hardly changes.",
          f0, mw(value(off, Metric::power_loss)), mw(value(on, Metric::power_loss)),
          mw(value(off, Metric::power_friction)), mw(value(on, Metric::power_friction)),
          mw(value(off, Metric::power_copper)), mw(value(on, Metric::power_copper))),
      {{Metric::power_loss, "power (mW)", "all losses"},
       {Metric::power_copper, "power (mW)", "copper"},
       {Metric::power_friction, "power (mW)", "friction"},
       {Metric::power_viscous, "power (mW)", "rotor drag"}});
  frequency_sheet(
      12, "Efficiency: (a) system, (b) motor and mechanism, with and without springs", false,
      fmt::format(
          "With springs the system's efficiency is highest near resonance: {}. The mechanism's: {}. The motor's "
          "efficiency hardly knows of springs: what they save is friction.",
          beside(m.judgement, "with springs the system"), beside(m.judgement, "with springs the mechanism")),
      {{Metric::efficiency_system, "efficiency (%)", "(a) system"},
       {Metric::efficiency_motor, "efficiency (%)", "(b) motor"},
       {Metric::efficiency_mechanism, "efficiency (%)", "(b) mechanism"}});
  frequency_sheet(
      13, "Mean lift with and without springs", false,
      fmt::format(
          "At the same frequency springs change the stroke's course, not its amplitude: the wings are faster in "
          "mid-stroke. Ratio at {:g} Hz: {}.",
          f0, beside(m.judgement, fmt::format("mean lift, spring on over spring off at {:g} Hz", f0))),
      {{Metric::lift_mean, "mean lift (mN)", ""}});

  using R = WaveformRow;
  const auto cycles = [&](int number, bool held, double R::*quantity, double scale, const char* name, const char* unit,
                          std::string label, const char* what, const std::string& said) {
    Sheet s = cycle_sheet(number, held ? r.at_frequency : r.at_voltage, quantity, scale, name, unit, std::move(label),
                          fmt::format("{} over a cycle at {}", what,
                                      held ? fmt::format("{:g} Hz", f0) : fmt::format("{:g} V", r.options.voltage)));
    s.caption = said;
    sheets.push_back(std::move(s));
  };
  const std::string hz = fmt::format("{:g} Hz", f0), v = fmt::format("{:g} V", r.options.voltage);
  const auto& j = m.judgement;
  cycles(
      14, true, &R::flapping_velocity, 1.0, "flapping_velocity_rad_per_s", "rad/s", "flapping velocity (rad/s)",
      "Flapping velocity",
      fmt::format("With springs the velocity's peaks are higher at the same frequency: springs pull the wings off the "
                  "turning points. Ratio of the peaks: {}.",
                  beside(j, "peak flapping velocity, spring on over spring off at " + hz)));
  cycles(15, true, &R::lift, 1e3, "lift_n", "N", "lift (mN)", "Lift",
         fmt::format("Two peaks, one for each half-stroke. Peak without springs: {}. With springs: {}.",
                     beside(j, "peak lift, spring off at " + hz), beside(j, "peak lift, spring on at " + hz)));
  cycles(
      16, true, &R::rod_force, 1e3, "rod_force_n", "N", "rod force (mN)", "Rod force",
      fmt::format(
          "Springs take over the force that turns the wings round, at the ends of the stroke. Peak magnitude without "
          "springs: {}. With springs: {}.",
          beside(j, "peak magnitude of the rod force, spring off at " + hz),
          beside(j, "peak magnitude of the rod force, spring on at " + hz)));
  const auto frequency_at = [&](bool springs) {
    const CycleCase* c = cycle_of(r.at_voltage, rod_force, springs);
    return c ? c->run.metrics[Metric::frequency] : absent;
  };
  cycles(
      17, false, &R::lift, 1e3, "lift_n", "N", "lift (mN)", "Lift",
      fmt::format(
          "At the same voltage the vehicle with springs also flaps faster, {:.2f} instead of {:.2f} Hz (rod-force; the "
          "axis is scaled to each period). Mean lift, on over off: {}.",
          frequency_at(true), frequency_at(false), beside(j, "mean lift, spring on over spring off at " + v)));
  cycles(18, false, &R::flapping_velocity, 1.0, "flapping_velocity_rad_per_s", "rad/s", "flapping velocity (rad/s)",
         "Flapping velocity",
         fmt::format("Ratio of the peaks, on over off: {}.",
                     beside(j, "peak flapping velocity, spring on over spring off at " + v)));
  cycles(19, false, &R::rod_force, 1e3, "rod_force_n", "N", "rod force (mN)", "Rod force",
         fmt::format("The mean magnitude of the force falls although the wings beat faster, on over off: {}.",
                     beside(j, "mean magnitude of the rod force, spring on over spring off at " + v)));

  const auto efficiency_label = "system efficiency (%)";
  {
    Sheet s = sheet(20, fmt::format("Lift and efficiency against crank radius at {}", v), "section5");
    TrendFigure figure({"crank_radius_m", "m", "crank radius", r.crank_fixed_hinge.axis}, 1e3, "crank radius (mm)");
    figure.chart().key = springs_key();
    figure.chart().panel_height = 1.15;
    const auto all = [](const TrendCurve&) { return true; };
    for (const auto& [set, tag] :
         {std::pair(&r.crank_fixed_hinge, "hinge offset held"), std::pair(&r.crank_fixed_stroke, "stroke held")}) {
      figure.panel(*set, Metric::lift_mean, "mean lift (mN)", tag, all, springs_style, tag);
      figure.panel(*set, Metric::efficiency_system, efficiency_label, tag, all, springs_style, tag);
    }
    s.caption = fmt::format(
        "The paper does not say what happens to the hinge when the crank grows: above, its offset is held and the "
        "stroke grows; "
        "below, the stroke is held. Highest efficiency with springs, hinge offset held: {}; stroke held: {}. Curves "
        "end "
        "where the crank jams or locks. The choice of formulation moves the optimum by millimetres.",
        beside(j, "crank radius of the highest system efficiency at 3 V, with springs, hinge"),
        beside(j, "crank radius of the highest system efficiency at 3 V, with springs, stroke"));
    figure.into(s);
    sheets.push_back(std::move(s));
  }
  {
    Sheet s = sheet(21, fmt::format("Lift and efficiency against rod length at {}", v), "section5");
    TrendFigure figure({"rod_length_m", "m", "rod length", r.rod.axis}, 1e3, "rod length (mm)");
    figure.chart().key = springs_key();
    const auto all = [](const TrendCurve&) { return true; };
    figure.panel(r.rod, Metric::lift_mean, "mean lift (mN)", "", all, springs_style);
    figure.panel(r.rod, Metric::efficiency_system, efficiency_label, "", all, springs_style);
    s.caption =
        "A longer rod stands more upright and pushes more directly; beyond about four crank radii little is left to "
        "gain. The "
        "rod weighs nothing here, so that no optimum but the longest rod comes out.";
    figure.into(s);
    sheets.push_back(std::move(s));
  }
  const double weight = total_mass(m.pair[0]).value_or(absent) * standard_gravity;
  for (const Formulation formulation : {rod_force, virtual_work}) {
    Sheet s =
        sheet(22, fmt::format("Lift and efficiency against voltage, {}", wingbeat::name_of(formulation)), "section5");
    if (formulation == virtual_work) s.id += "-virtual-work";
    TrendFigure figure({"voltage_v", "V", "supply voltage", r.supply.axis}, 1.0, "supply voltage (V)");
    for (std::size_t k = 0; k < r.options.crank_radii.size(); ++k) {
      figure.chart().key.push_back(
          {fmt::format("r_c {:g} mm", 1e3 * r.options.crank_radii[k]), radii[k % std::size(radii)]});
    }
    figure.chart().panel_height = 1.25;
    const auto radius_style = [&](const TrendCurve& c) {
      const auto n = std::find(r.options.crank_radii.begin(), r.options.crank_radii.end(), c.crank_radius) -
                     r.options.crank_radii.begin();
      return std::optional(radii[std::size_t(n) % std::size(radii)]);
    };
    std::string hovers;
    for (const bool springs : {false, true}) {
      const auto wanted = [&](const TrendCurve& c) {
        return c.of.springs == springs && c.of.formulation == formulation;
      };
      const char* title = springs ? "springs on" : "springs off";
      figure.panel(r.supply, Metric::lift_mean, "mean lift (mN)", title, wanted, radius_style);
      figure.chart().panels.back().levels.push_back(
          {1e3 * weight, springs ? "" : fmt::format("hover: {:.1f} mN", 1e3 * weight)});
      figure.panel(r.supply, Metric::efficiency_system, efficiency_label, title, wanted, radius_style);
      for (const double radius : r.options.crank_radii) {
        const TrendCurve& c = curve_of(r.supply, {formulation, springs, Condition::air}, radius);
        for (std::size_t n = 0; n < r.supply.axis.size(); ++n) {
          if (c.metrics[n][Metric::lift_mean] >= weight) {
            hovers += fmt::format("{}{:g} mm, springs {}, from {:.4g} V", hovers.empty() ? "" : "; ", 1e3 * radius,
                                  springs ? "on" : "off", r.supply.axis[n]);
            break;
          }
        }
      }
    }
    s.caption =
        fmt::format("The hinge offset is held. The vehicle carries its own weight with: {}. {}",
                    hovers.empty() ? "none of these cranks" : hovers,
                    formulation == rod_force
                        ? "So the motor's 5 V are just enough for one of these cranks with springs and for none "
                          "without; the best crank: " +
                              beside(j, "most mean lift at 5 V over crank radii 3 to 14 mm, with springs, hinge") + "."
                        : "In this formulation nothing of the transmission's power is lost by the formulation itself, "
                          "and larger strokes pay.");
    figure.into(s);
    sheets.push_back(std::move(s));
  }
  return sheets;
}

}  // namespace wingbeat::reproduction

// What physics beyond the paper's model does to its conclusions: computed, drawn and described.
#include "reproduction/further_physics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/design_settings.hpp"
#include "reproduction/dot_plot.hpp"
#include "reproduction/html.hpp"
#include "reproduction/trend_figure.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat::reproduction {
namespace {

// The assumptions of docs/physics-effects.md: a semi-ellipse of 63 mm and 25 mm, to which the calibrated chord moments
// belong, and the thermal resistances of a 0816-size motor.
constexpr double assumed_s22 = 2.0 * 2.0 / 15.0 * 0.025 * 0.025 * 0.063 * 0.063 * 0.063;

std::vector<FurtherVariant> variants_of(const SpringPair& pair) {
  const Vehicle<double> v = resolve(pair[0]);
  const std::vector<std::string> added = {
      "aerodynamics.added_mass=true",
      fmt::format("wing.planform={{ shape = \"moments\", s2 = {:.12g}, s3 = {:.12g}, s22 = {:.6g} }}", v.wings.s2,
                  v.wings.s3, assumed_s22)};
  const std::vector<std::string> gear = {"motor.gear_efficiency=0.8"};
  const std::vector<std::string> heat = {"motor.thermal_resistance_winding=20 K/W",
                                         "motor.thermal_resistance_case=48 K/W"};
  // The wings of data/designs/pitch-hinge-crank.toml, of the same inertia about the flapping hinge.
  const std::vector<std::string> pitch = {
      "wing={ count = 2, areal_density = \"17 g/m2\", spar_density = \"0.614 g/m\", planform = { shape = "
      "\"semi-ellipse\", length = \"63 mm\", root_chord = \"25 mm\" } }",
      "pitch={ stiffness = \"6e-4 N m/rad\", damping = \"2e-8 N m s/rad\" }",
      "aerodynamics={ air_density = \"1.225 kg/m3\", added_mass = true, coefficients = \"normal-force-robofly\" }"};
  std::vector<std::string> all = added;
  all.insert(all.end(), gear.begin(), gear.end());
  all.insert(all.end(), heat.begin(), heat.end());
  std::vector<FurtherVariant> variants(6);
  variants[0].name = "the paper's model";
  const std::pair<const char*, const std::vector<std::string>*> more[] = {{"added mass of the air", &added},
                                                                          {"gear efficiency 0.8", &gear},
                                                                          {"winding temperature", &heat},
                                                                          {"all three", &all},
                                                                          {"pitch on elastic hinges", &pitch}};
  for (std::size_t n = 0; n < std::size(more); ++n) {
    variants[n + 1].name = more[n].first;
    variants[n + 1].settings = *more[n].second;
  }
  return variants;
}

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:+.1f} %", 100.0 * share) : std::string("-");
}

}  // namespace

double FurtherVariant::without_friction() const {
  return no_friction[Metric::power_electrical] / off[Metric::power_electrical] - 1.0;
}
double FurtherVariant::saved() const { return on[Metric::power_electrical] / off[Metric::power_electrical] - 1.0; }
double FurtherVariant::lift_gain() const {
  return on_at_voltage[Metric::lift_mean] / off_at_voltage[Metric::lift_mean] - 1.0;
}
double FurtherVariant::lift_to_weight() const { return on_at_max_voltage[Metric::lift_to_weight]; }
double FurtherVariant::efficiency_gain() const {
  return on[Metric::efficiency_system] - off[Metric::efficiency_system];
}

std::vector<FurtherVariant> further_physics(const SpringPair& pair, const ReproductionOptions& options,
                                            const ForEach& for_each) {
  std::vector<FurtherVariant> variants = variants_of(pair);
  struct Task {
    FurtherVariant* variant;
    FurtherRun FurtherVariant::* run;
    bool springs, friction;
    double voltage;  ///< 0: the frequency is held
  };
  std::vector<Task> tasks;
  for (FurtherVariant& v : variants) {
    tasks.push_back({&v, &FurtherVariant::off, false, true, 0.0});
    tasks.push_back({&v, &FurtherVariant::on, true, true, 0.0});
    tasks.push_back({&v, &FurtherVariant::no_friction, false, false, 0.0});
    tasks.push_back({&v, &FurtherVariant::off_at_voltage, false, true, options.voltage});
    tasks.push_back({&v, &FurtherVariant::on_at_voltage, true, true, options.voltage});
    tasks.push_back({&v, &FurtherVariant::on_at_max_voltage, true, true, options.max_voltage});
  }
  for_all(for_each, tasks.size(), [&](std::size_t n) {
    const Task& task = tasks[n];
    std::vector<std::string> settings = task.variant->settings;
    if (!task.friction) settings.push_back("friction.type=none");
    Design<double> design = design_of(document_of(pair[task.springs ? 1 : 0], "the paper's vehicle"), {}, settings);
    RunOptions run;
    run.allow_extrapolation = true;  // equation (1) is taken as printed, whatever it fails to conserve
    if (task.voltage > 0.0) design.supply = {SupplyType::constant, task.voltage, 0.0, 1.0};
    else run.frequency = options.frequency;
    const RunResult result = run_design(design, run);
    task.variant->*task.run = {result.metrics, result.domain};
  });
  return variants;
}

std::vector<Sheet> further_sheets(const Material& m) {
  Sheet s;
  s.id = "further-physics";
  s.heading = "The paper's conclusions with more physics";
  s.section = "further";
  const double f0 = m.computed.options.frequency;
  DotPlot plot;
  plot.width = style::double_column;
  plot.label_width = 1.4;
  plot.row_height = 0.18;
  plot.variants = 0;
  plot.panels = {
      {"friction left out", fmt::format("input power at {:g} Hz (%)", f0), -80.0, 0.0, 20.0},
      {"springs added", fmt::format("input power at {:g} Hz (%)", f0), -40.0, 0.0, 10.0},
      {"springs added", fmt::format("mean lift at {:g} V (%)", m.computed.options.voltage), 0.0, 60.0, 20.0},
      {"with springs", fmt::format("lift / weight at {:g} V", m.computed.options.max_voltage), 0.0, 1.2, 0.5}};
  const auto published = [&](DotPanel& panel, const std::string& beginning) {
    const Claim* c = claim_of(m.assessment, beginning);
    if (c && c->published) panel.references.emplace_back(100.0 * *c->published, "published");
  };
  published(plot.panels[1], "mean electrical input power, change");
  published(plot.panels[2], fmt::format("mean lift, change by springs at {:g} V", m.computed.options.voltage));
  plot.panels[3].references.emplace_back(1.0, "hover");
  std::vector<double> place, values[5];
  for (const FurtherVariant& v : m.further) {
    DotRow row{v.name};
    for (const double x :
         {100.0 * v.without_friction(), 100.0 * v.saved(), 100.0 * v.lift_gain(), v.lift_to_weight()}) {
      row.dots.push_back({Dot{x}});
    }
    plot.rows.push_back(std::move(row));
    place.push_back(double(place.size()));
    const double quantities[] = {v.without_friction(), v.saved(), v.lift_gain(), v.efficiency_gain(),
                                 v.lift_to_weight()};
    for (std::size_t k = 0; k < std::size(quantities); ++k) values[k].push_back(quantities[k]);
  }
  s.table.add("variant", "1", "row of the figure from above, the paper's model first", place);
  s.table.add("input_change_without_friction", "1", "change of the electrical input when friction is left out",
              values[0]);
  s.table.add("input_change_by_springs", "1", "change of the electrical input by springs", values[1]);
  s.table.add("lift_change_by_springs", "1", "change of the mean lift by springs", values[2]);
  s.table.add("efficiency_change_by_springs", "1", "change of the system efficiency by springs", values[3]);
  s.table.add("lift_to_weight", "1", "mean lift over weight, with springs at the highest voltage", values[4]);
  s.caption =
      "Each row adds physics to the paper's vehicles, by rod-force. (a) The title question: how much less input a "
      "model without friction predicts. (b) to (d) What springs do, and whether the vehicle hovers.";
  s.wide = true;
  s.draw = [plot](PlotFormat format, const std::filesystem::path& file) { reproduction::draw(plot, format, file); };
  return {s};
}

std::string further_html(const Material& m) {
  if (m.further.empty()) return "";
  const double f0 = m.computed.options.frequency;
  const auto range = [&](auto quantity) {
    double low = INFINITY, high = -INFINITY;
    for (const FurtherVariant& v : m.further) {
      low = std::min(low, quantity(v));
      high = std::max(high, quantity(v));
    }
    return std::pair(low, high);
  };
  const auto [max_change, least] = range([](const FurtherVariant& v) { return v.without_friction(); });
  const auto [max_saved, min_saved] = range([](const FurtherVariant& v) { return v.saved(); });
  const auto [lift_low, lift_high] = range([](const FurtherVariant& v) { return v.lift_gain(); });
  const auto [lifted_low, lifted_high] = range([](const FurtherVariant& v) { return v.lift_to_weight(); });
  std::string html = fmt::format(
      "<p>The paper's model has constant motor parameters, no gear loss and no added mass of the air, and its wings "
      "pitch by a law. The program can add each of these. <b>The answer to the title question stays yes:</b> without "
      "friction the model predicts {:.0f} to {:.0f} % less input at {:g} Hz (numbers marked ‡ below are outside the "
      "domain). Springs change the input by {:+.1f} to "
      "{:+.1f} % and the mean lift at {:g} V by {:+.1f} to {:+.1f} %. Mean lift at {:g} V with springs and the crank "
      "of Table 2 is {:.2f} to {:.2f} of the weight{}.</p>\n",
      -100.0 * least, -100.0 * max_change, f0, 100.0 * max_saved, 100.0 * min_saved, m.computed.options.voltage,
      100.0 * lift_low, 100.0 * lift_high, m.computed.options.max_voltage, lifted_low, lifted_high,
      lifted_high < 1.0 ? ": no variant hovers with this crank" : "");
  html += fmt::format(
      "<div class=\"wide\"><table class=\"sortable\"><thead><tr><th>model</th><th>input without springs</th><th>with "
      "friction left out</th><th>with springs</th><th>lift gain by springs</th><th>efficiency gain by springs</th>"
      "<th>lift / weight, {0:g} V, springs</th><th>winding, {0:g} V, springs</th></tr></thead><tbody>\n",
      m.computed.options.max_voltage);
  for (const FurtherVariant& v : m.further) {
    const auto mark = [](std::initializer_list<const FurtherRun*> runs) {
      const bool any = std::any_of(runs.begin(), runs.end(), [](const FurtherRun* r) { return r->domain.any(); });
      return any ? " ‡" : "";
    };
    const auto power = [&](const FurtherRun& x) { return readable(x[Metric::power_electrical], "W") + mark({&x}); };
    const double winding = v.on_at_max_voltage[Metric::winding_temperature];
    html += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{} ({})</td><td class=\"n\">{} ({})</td><td "
        "class=\"n\">{}{}</td><td class=\"n\">{:+.2f} percentage points{}</td><td class=\"n\">{:.3f}{}</td><td "
        "class=\"n\">{}</td></tr>\n",
        v.name, power(v.off), power(v.no_friction), percent(v.without_friction()), power(v.on), percent(v.saved()),
        percent(v.lift_gain()), mark({&v.off_at_voltage, &v.on_at_voltage}), 100.0 * v.efficiency_gain(),
        mark({&v.off, &v.on}), v.lift_to_weight(), mark({&v.on_at_max_voltage}),
        std::isfinite(winding) ? fmt::format("{:.0f} °C", winding) : std::string("-"));
  }
  html += fmt::format(
      "</tbody></table></div>\n<p>Powers at {:g} Hz, lift gain at {:g} V. Assumed, not published: the gear efficiency "
      "(on top of motor constants that were fitted with the gear), 20 K/W from winding to case and 48 K/W from case "
      "to air, a semi-elliptic planform of 63 mm by 25 mm for the added mass, and wings on pitch hinges of 6·10"
      "<sup>-4</sup> N·m/rad that have the paper's inertia, normal-force coefficients and added mass. The wings on "
      "pitch hinges are other wings than the paper's, whose pitch follows a law. Equation (1) is taken as printed, "
      "also where its formulation residual exceeds 5 % of the input: ‡ marks numbers outside the domain, all others "
      "are "
      "inside.</p>\n",
      f0, m.computed.options.voltage);
  return html;
}

}  // namespace wingbeat::reproduction

// Figures 20 to 22 of the 2022 friction paper, each in both readings of its section 5: hinge offset or stroke held.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wingbeat/vehicle/vehicle.hpp"

#include "reproduction/trend_figure.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr const char* efficiency_label = "system efficiency (%)";

CurveStyle springs_style(const TrendCurve& c) { return style_of(c.flapping_case, false); }
/// Beside the curves that reach the last crank radius.
std::string springs_label_at_edge(const TrendCurve& c) {
  return c.flapping_case.formulation == virtual_work ? springs_label(c.flapping_case.springs) : "";
}
bool all(const TrendCurve&) { return true; }

Sheet crank_sheet(const Material& m) {
  const Reproduction& r = m.computed;
  Sheet s = sheet(20, fmt::format("Lift and efficiency against crank radius at {:g} V", r.options.voltage), "section5");
  TrendFigure figure({"crank_radius_m", "m", "crank radius", r.crank_fixed_hinge.axis}, 1e3, "crank radius (mm)");
  figure.chart().key = formulation_key();
  figure.chart().panel_height = 1.5;
  figure.chart().columns = 2;
  for (const auto& [set, tag] :
       {std::pair(&r.crank_fixed_hinge, readings[0]), std::pair(&r.crank_fixed_stroke, readings[1])}) {
    figure.panel(*set, Metric::lift_mean, "mean lift (mN)", tag, all, springs_style, springs_label_at_edge, tag);
    figure.panel(*set, Metric::efficiency_system, efficiency_label, tag, all, springs_style, springs_label_at_edge,
                 tag);
  }
  for (std::size_t p = 0; p < figure.chart().panels.size(); ++p) {
    // Both published cranks, of lift and of efficiency, are the same.
    mark_published(figure.chart().panels[p], m.assessment,
                   p % 2 == 0 ? "crank radius of maximum mean lift" : "crank radius of maximum system efficiency",
                   style::ink, [](double radius) { return std::pair(1e3 * radius, absent); });
  }
  s.caption = fmt::format(
      "Above, the hinge offset is held and the stroke grows with the crank; below, the stroke is held. Crank radius of "
      "maximum efficiency with springs, hinge offset held: {}; stroke held: {}. Curves end where the crank jams or "
      "locks.",
      beside(m.assessment, "crank radius of maximum system efficiency at 3 V, with springs, hinge"),
      beside(m.assessment, "crank radius of maximum system efficiency at 3 V, with springs, stroke"));
  figure.into(s);
  return s;
}

Sheet rod_sheet(const Material& m) {
  const Reproduction& r = m.computed;
  Sheet s = sheet(21, fmt::format("Lift and efficiency against rod length at {:g} V", r.options.voltage), "section5");
  TrendFigure figure({"rod_length_m", "m", "rod length", r.rod.axis}, 1e3, "rod length (mm)");
  figure.chart().key = formulation_key();
  figure.panel(r.rod, Metric::lift_mean, "mean lift (mN)", "", all, springs_style, springs_label_of);
  figure.panel(r.rod, Metric::efficiency_system, efficiency_label, "", all, springs_style, springs_label_of);
  s.caption = fmt::format(
      "A longer rod has a smaller obliquity. Gains from 20 to 40 mm (above) and from 10 to 20 mm (below), without "
      "springs: {}; with springs: {}. The rod has no mass in this model, so that no optimum but the longest rod comes "
      "out.",
      beside(m.assessment, "gains of lift and efficiency by rods longer than 20 mm are moderate, at 3 V, without"),
      beside(m.assessment, "gains of lift and efficiency by rods longer than 20 mm are moderate, at 3 V, with "));
  figure.into(s);
  return s;
}

/// Which of the cranks carry the weight, and from which voltage; inside the domain, or outside it in the residual
/// alone.
std::string hovers(const Reproduction& r, const TrendSet& set, Formulation formulation, double weight) {
  std::string said;
  for (const bool springs : {false, true}) {
    for (const double radius : r.options.crank_radii) {
      const TrendCurve& c = curve_of(set, {formulation, springs, Condition::air}, radius);
      for (std::size_t n = 0; n < set.axis.size(); ++n) {
        DomainStatus status = c.domain[n];
        const bool residual = status.test(std::size_t(DomainLimit::formulation_residual));
        status.reset(std::size_t(DomainLimit::formulation_residual));
        if (!(c.metrics[n][Metric::lift_mean] >= weight) || status.any()) continue;
        said += fmt::format("{}{:g} mm {} springs from {:.4g} V{}", said.empty() ? "" : "; ", 1e3 * radius,
                            springs ? "with" : "without", set.axis[n], residual ? " (outside the domain)" : "");
        break;
      }
    }
  }
  return said.empty() ? "none of these cranks" : said;
}

Sheet voltage_sheet(const Material& m, Formulation formulation, bool hold_stroke) {
  const Reproduction& r = m.computed;
  const TrendSet& set = hold_stroke ? r.supply_fixed_stroke : r.supply_fixed_hinge;
  const double weight = total_mass(m.pair[0]).value_or(absent) * standard_gravity;
  const char* reading = readings[hold_stroke ? 1 : 0];
  Sheet s =
      sheet(22, fmt::format("Lift and efficiency against voltage, {}, {}", wingbeat::name_of(formulation), reading),
            "section5");
  if (formulation == virtual_work) s.id += "-virtual-work";
  if (!hold_stroke) s.id += "-hinge-held";
  TrendFigure figure({"voltage_v", "V", "supply voltage", set.axis}, 1.0, "supply voltage (V)");
  figure.chart().key = {{"label: crank radius {/:Italic r}_c", {style::ordered[2], style::solid}}};
  figure.chart().panel_height = 1.5;
  figure.chart().columns = 2;
  const auto radius_label = [](const TrendCurve& c) { return fmt::format("{:g} mm", 1e3 * c.crank_radius); };
  const auto radius_style = [&](const TrendCurve& c) {
    const auto n = std::find(r.options.crank_radii.begin(), r.options.crank_radii.end(), c.crank_radius) -
                   r.options.crank_radii.begin();
    const CurveStyle style{style::ordered[std::size_t(n) % std::size(style::ordered)]};
    return c.flapping_case.formulation == rod_force ? style : of_virtual_work(style);
  };
  for (const bool springs : {false, true}) {
    const auto wanted = [&](const TrendCurve& c) {
      return c.flapping_case.springs == springs && c.flapping_case.formulation == formulation;
    };
    const char* title = springs ? "with springs" : "without springs";
    figure.panel(set, Metric::lift_mean, "mean lift (mN)", title, wanted, radius_style, radius_label);
    figure.chart().panels.back().levels.push_back(
        {1e3 * weight, springs ? "" : fmt::format("weight: {:.1f} mN", 1e3 * weight)});
    if (springs) {
      mark_published(figure.chart().panels.back(), m.assessment,
                     fmt::format("maximum mean lift at 5 V over crank radii 3 to 14 mm, with springs, {}", reading),
                     style::ink, [&](double newton) { return std::pair(r.options.max_voltage, 1e3 * newton); });
    }
    figure.panel(set, Metric::efficiency_system, efficiency_label, title, wanted, radius_style, radius_label);
  }
  s.caption = fmt::format("Reading: {}. The weight is carried with: {}.", reading, hovers(r, set, formulation, weight));
  if (formulation == rod_force) {
    s.caption += fmt::format(
        " Maximum lift at 5 V over all cranks, with springs: {}.",
        beside(m.assessment,
               fmt::format("maximum mean lift at 5 V over crank radii 3 to 14 mm, with springs, {}", reading)));
  } else {
    s.caption +=
        " This formulation loses no power in the transmission but friction, and larger strokes are beneficial.";
  }
  figure.into(s);
  return s;
}

}  // namespace

std::vector<Sheet> section5_sheets(const Material& m) {
  std::vector<Sheet> sheets = {crank_sheet(m), rod_sheet(m)};
  for (const Formulation formulation : both_formulations) {
    for (const bool hold_stroke : {true, false}) sheets.push_back(voltage_sheet(m, formulation, hold_stroke));
  }
  return sheets;
}

}  // namespace wingbeat::reproduction

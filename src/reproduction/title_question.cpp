// Of the report: the title question.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reproduction/html.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat::reproduction {
namespace {

const char* coefficient_unit(FrictionLaw law) {
  switch (law) {
    case FrictionLaw::viscous: return "N m s/rad";
    case FrictionLaw::quadratic: return "N m s2/rad2";
    case FrictionLaw::constant: return "N m";
    case FrictionLaw::load_proportional: return "m";
    case FrictionLaw::none: break;
  }
  return "";
}

std::string coefficient(const CalibratedLaw& law) {
  if (law.law == FrictionLaw::none) return "none";
  if (law.law == FrictionLaw::load_proportional) return readable(law.coefficient, "m");
  return fmt::format("{:.4g} {}", law.coefficient, coefficient_unit(law.law));
}

/// Every published value with springs, as each law predicts it.
std::string law_table(const Assessment& a, std::size_t variant) {
  std::vector<const LawPrediction*> laws;
  for (const LawPrediction& p : a.laws) {
    if (p.variant == variant) laws.push_back(&p);
  }
  if (laws.empty()) return "";
  std::string html = "<div class=\"wide\"><table class=\"laws\"><thead><tr><th></th><th>published</th>";
  for (const LawPrediction* p : laws) html += fmt::format("<th>{}</th>", name_of(p->law.law));
  html += "</tr></thead><tbody>\n<tr><td>coefficient</td><td></td>";
  for (const LawPrediction* p : laws) html += fmt::format("<td class=\"n\">{}</td>", coefficient(p->law));
  const PublishedValue& first = laws[0]->comparison.values[0].published;
  html +=
      fmt::format("</tr>\n<tr><td>flapping frequency at {}, without springs (calibrated)</td><td class=\"n\">{}</td>",
                  operating_point(first.voltage, first.frequency), readable(first.published, "Hz"));
  for (const LawPrediction* p : laws) {
    html += fmt::format("<td class=\"n\">{}{}</td>", readable(p->law.frequency, "Hz"),
                        p->law.calibrated ? "" : " (not met)");
  }
  html +=
      "</tr>\n<tr><th class=\"group\" colspan=\"7\">Published values with springs that no calibration has "
      "seen, and the deviation of each law</th></tr>\n";
  const auto rows = [&](const std::vector<std::size_t>& which) {
    for (const std::size_t n : which) {
      const PublishedValue& v = laws[0]->comparison.values[n].published;
      const MetricInfo& info = metric_info(v.metric);
      const auto shown = [&](double x) { return v.relative_to ? fmt::format("{:#.4g}", x) : readable(x, info.unit); };
      html += fmt::format("<tr><td>{}, {} at {}</td><td class=\"n\">{}</td>", info.long_name,
                          v.relative_to ? "ratio with / without springs" : "with springs",
                          operating_point(v.voltage, v.frequency), shown(v.published));
      for (const LawPrediction* p : laws) {
        const ComparedValue& c = p->comparison.values[n];
        html += fmt::format("<td class=\"n\">{}<br>{}</td>", shown(c.computed), percent_text(c.deviation));
      }
      html += "</tr>\n";
    }
  };
  rows(laws[0]->tests);
  html += "<tr><td><b>root mean square of these</b></td><td></td>";
  for (const LawPrediction* p : laws) html += fmt::format("<td class=\"n\"><b>{:.1f} %</b></td>", 100.0 * p->rms);
  html += "</tr>\n<tr><th class=\"group\" colspan=\"7\">Used in the calibration of S_2 and S_3, not scored</th></tr>\n";
  rows(laws[0]->seen);
  html +=
      "<tr><th class=\"group\" colspan=\"7\">Without → with springs (no published "
      "values)</th></tr>\n";
  const std::pair<Metric, const char*> more[] = {{Metric::power_electrical, "electrical input"},
                                                 {Metric::power_friction, "friction loss"},
                                                 {Metric::power_loss, "all losses"},
                                                 {Metric::lift_mean, "mean lift"},
                                                 {Metric::rod_force_mean, "mean magnitude of the rod force"}};
  std::vector<std::pair<std::optional<double>, std::optional<double>>> points;
  for (const Comparison::Run& run : laws[0]->comparison.runs) {
    const std::pair point{run.voltage, run.frequency};
    if (std::find(points.begin(), points.end(), point) == points.end()) points.push_back(point);
  }
  for (const auto& point : points) {
    for (const auto& [metric, name] : more) {
      html += fmt::format("<tr><td>{} at {}</td><td></td>", name, operating_point(point.first, point.second));
      for (const LawPrediction* p : laws) {
        double values[2] = {absent, absent};
        for (const Comparison::Run& run : p->comparison.runs) {
          if (run.voltage != point.first || run.frequency != point.second) continue;
          values[run.design == first.design ? 0 : 1] = run.result.metrics[metric];
        }
        const char* unit = metric_info(metric).unit;
        html += fmt::format("<td class=\"n\">{} → {}</td>", readable(values[0], unit), readable(values[1], unit));
      }
      html += "</tr>\n";
    }
  }
  return html + "</tbody></table></div>\n";
}

const ComparedValue* ratio_of(const LawPrediction& p, Metric metric) {
  for (const ComparedValue& c : p.comparison.values) {
    if (c.published.metric == metric && c.published.relative_to && c.published.frequency) return &c;
  }
  return nullptr;
}

/// A metric of the vehicle with that law at the held frequency; absent where the values do not ask for it.
double at_frequency(const LawPrediction* p, const std::string& design, Metric metric) {
  if (!p) return absent;
  for (const Comparison::Run& run : p->comparison.runs) {
    if (run.frequency && run.design == design) return run.result.metrics[metric];
  }
  return absent;
}

/// What the vehicle as published takes at the held frequency, and what it takes with its friction left out.
std::string cost_of_leaving_out(const Material& m, std::size_t f) {
  const LawPrediction* none = law_of(m.assessment, FrictionLaw::none, f);
  const CycleCase* with = cycle_of(m.computed.at_frequency, both_formulations[f], false);
  if (!none || !with) return "";
  const double included = with->run.metrics[Metric::power_electrical];
  const double left_out = at_frequency(none, calibration_value(m.file).design, Metric::power_electrical);
  return fmt::format("<b>{:.0f} mW instead of {:.0f} mW</b> ({}, {:+.0f} %)", 1e3 * left_out, 1e3 * included,
                     variant_name(f), 100.0 * (left_out / included - 1.0));
}

}  // namespace

const LawPrediction* law_of(const Assessment& a, FrictionLaw law, std::size_t variant) {
  for (const LawPrediction& p : a.laws) {
    if (p.law.law == law && p.variant == variant) return &p;
  }
  return nullptr;
}

std::string answer_html(const Material& m) {
  const Assessment& a = m.assessment;
  const LawPrediction* load = law_of(a, FrictionLaw::load_proportional, 0);
  if (!load) return "";
  double best = INFINITY, worst = 0.0;
  for (const LawPrediction& p : a.laws) {
    if (p.variant != 0 || &p == load) continue;
    best = std::min(best, p.rms);
    worst = std::max(worst, p.rms);
  }
  return fmt::format(
      "<p class=\"answer\"><b>Should friction losses be included? Yes.</b> At {:g} Hz without springs, a model without "
      "friction predicts an electrical input of {}; {}. The friction must depend on the load: calibrated without "
      "springs, load-proportional friction predicts the published values with springs to {:.1f} % (root mean square), "
      "the other laws to {:.1f} to {:.1f} % (rod-force).</p>\n",
      m.computed.options.frequency, cost_of_leaving_out(m, 0), cost_of_leaving_out(m, 1), 100.0 * load->rms,
      100.0 * best, 100.0 * worst);
}

std::string question_html(const Material& m) {
  const Assessment& a = m.assessment;
  const LawPrediction* load = law_of(a, FrictionLaw::load_proportional, 0);
  const LawPrediction* none = law_of(a, FrictionLaw::none, 0);
  if (!load || !none) return "";
  const PublishedValue& target = calibration_value(m.file);
  std::string html = fmt::format(
      "<p>A model without friction underestimates the electrical input at {:g} Hz without springs: {}; {}. It also "
      "flaps at {:.1f} Hz instead of the published {} at {}, and no parameter of the friction is left to "
      "correct that.</p>\n",
      m.computed.options.frequency, cost_of_leaving_out(m, 0), cost_of_leaving_out(m, 1), none->law.frequency,
      target.published_text, operating_point(target.voltage, target.frequency));
  html += fmt::format(
      "<p><b>Which friction?</b> Each law gets one coefficient, chosen so that the vehicle <em>without</em> springs "
      "flaps "
      "at the published {} at {}. Then springs are added, nothing else is changed, and the law predicts the {} "
      "published "
      "values with springs that were not used in a calibration. Root mean square of the deviations:</p>\n<div "
      "class=\"wide\"><table><thead><tr><th></th>",
      target.published_text, operating_point(target.voltage, target.frequency), load->tests.size());
  for (const FrictionLaw law : compared_friction_laws) html += fmt::format("<th>{}</th>", name_of(law));
  html += "</tr></thead><tbody>\n";
  for (std::size_t f = 0; f < a.variants; ++f) {
    html += fmt::format("<tr><td>{}</td>", variant_name(f));
    for (const FrictionLaw law : compared_friction_laws) {
      const LawPrediction* p = law_of(a, law, f);
      html += fmt::format("<td class=\"n\">{}{}</td>", p ? fmt::format("{:.1f} %", 100.0 * p->rms) : "-",
                          p && !p->law.calibrated && law != FrictionLaw::none ? " (frequency not met)" : "");
    }
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  double power_low = INFINITY, power_high = -INFINITY;
  for (const LawPrediction& p : a.laws) {
    if (p.variant != 0 || &p == load || &p == none) continue;
    if (const ComparedValue* c = ratio_of(p, Metric::power_electrical)) {
      power_low = std::min(power_low, c->computed);
      power_high = std::max(power_high, c->computed);
    }
  }
  if (const ComparedValue* c = ratio_of(*load, Metric::power_electrical)) {
    html += fmt::format(
        "<p>At {:g} Hz springs cut the published electrical input by {:.0f} %. Load-proportional friction predicts "
        "{:.0f} "
        "%, the load-independent laws predict {:.0f} to {:.0f} % (rod-force).</p>\n",
        m.computed.options.frequency, 100.0 * (1.0 - c->published.published), 100.0 * (1.0 - c->computed),
        100.0 * (1.0 - power_high), 100.0 * (1.0 - power_low));
  }
  html +=
      "<p><b>Why.</b> At prescribed frequency springs change neither speed nor stroke much: they carry part of the "
      "inertial load at stroke reversal. A loss that depends on the speed alone - viscous, quadratic, constant - stays "
      "as "
      "it is. A loss that depends on the force inside the mechanism falls with it. The laws differ only where the "
      "force "
      "changes and the speed does not; a single operating point cannot discriminate between laws.</p>\n"
      "<p><b>What this does not show.</b> The published values are themselves the paper's simulation of a vehicle "
      "fitted "
      "with load-proportional friction. That this law reproduces them best shows that the program computes what the "
      "paper "
      "computed, not how real joints behave. A bench would have to measure: (1) input power at one held frequency with "
      "springs of several stiffnesses, where the laws differ by more than a tenth of the input; (2) the same in "
      "vacuum, "
      "where load-proportional friction stays large and there is no aerodynamic power; (3) the rod force beside the "
      "loss; "
      "(4) wings of several inertias on the same mechanism. <code>wingbeat fit --compare-friction</code> reads such "
      "logs "
      "and ranks the laws.</p>\n";
  for (std::size_t f = 0; f < a.variants; ++f) {
    html += fmt::format(
        "<details><summary>Every published value with springs, as each law predicts it: {}</summary>\n{}"
        "</details>\n",
        variant_name(f), law_table(a, f));
  }
  return html;
}

}  // namespace wingbeat::reproduction

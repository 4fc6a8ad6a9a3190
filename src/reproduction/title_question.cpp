// Of the report: the title question.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reproduction/html.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat::reproduction {
namespace {

std::string coefficient(const LawPrediction& p) {
  const CalibratedLaw& law = p.law;
  if (rivals[p.rival].own_drag) return fmt::format("drag × {:.3f}", p.drag_factor);
  if (law.law == FrictionLaw::none) return "none";
  if (law.law == FrictionLaw::load_proportional) return readable(law.coefficient, "m");
  return fmt::format("{:.4g} {}", law.coefficient, key_of(law.law)->unit);
}

bool is_outside(const LawPrediction& p, const PublishedValue& v, const std::string& design) {
  return p.comparison.run_of(v, design).result.domain.any();
}

/// Every published value with springs, as each law predicts it.
std::string law_table(const Assessment& a, std::size_t variant) {
  std::vector<const LawPrediction*> laws;
  for (const LawPrediction& p : a.laws) {
    if (p.variant == variant) laws.push_back(&p);
  }
  if (laws.empty()) return "";
  std::string html = "<div class=\"wide\"><table class=\"laws\"><thead><tr><th></th><th>published</th>";
  for (const LawPrediction* p : laws) html += fmt::format("<th>{}</th>", rivals[p->rival].name);
  html += "</tr></thead><tbody>\n<tr><td>coefficient</td><td></td>";
  for (const LawPrediction* p : laws) html += fmt::format("<td class=\"n\">{}</td>", coefficient(*p));
  const PublishedValue& first = laws[0]->comparison.values[0].published;
  html +=
      fmt::format("</tr>\n<tr><td>flapping frequency at {}, without springs (calibrated)</td><td class=\"n\">{}</td>",
                  operating_point(first.voltage, first.frequency), readable(first.published, "Hz"));
  for (const LawPrediction* p : laws) {
    html += fmt::format("<td class=\"n\">{}{}</td>", readable(p->law.frequency, "Hz"),
                        p->law.calibrated ? "" : " (not met)");
  }
  html +=
      "</tr>\n<tr><th class=\"group\" colspan=\"8\">Published values with springs that no calibration has "
      "seen, and the deviation of each law</th></tr>\n";
  const auto rows = [&](const std::vector<std::size_t>& which) {
    for (const std::size_t n : which) {
      const PublishedValue& v = laws[0]->comparison.values[n].published;
      const MetricInfo& info = metric_info(v.metric);
      const auto shown = [&](double x) {
        return !v.relative_to ? readable(x, info.unit)
               : v.change     ? fmt::format("{:+.1f} %", 100.0 * x)
                              : fmt::format("{:#.4g}", x);
      };
      html += fmt::format("<tr><td>{}, {} at {}</td><td class=\"n\">{}</td>", info.long_name,
                          v.change        ? "change by springs"
                          : v.relative_to ? "ratio with / without springs"
                                          : "with springs",
                          operating_point(v.voltage, v.frequency), v.published_text);
      for (const LawPrediction* p : laws) {
        const ComparedValue& c = p->comparison.values[n];
        const bool outside = is_outside(*p, v, v.design) || (v.relative_to && is_outside(*p, v, *v.relative_to));
        html += fmt::format("<td class=\"n\">{}{}<br>{}</td>", shown(c.computed), outside ? " ‡" : "",
                            percent_text(c.deviation));
      }
      html += "</tr>\n";
    }
  };
  rows(laws[0]->tests);
  html += "<tr><td><b>root mean square of these</b></td><td></td>";
  for (const LawPrediction* p : laws) html += fmt::format("<td class=\"n\"><b>{:.1f} %</b></td>", 100.0 * p->rms);
  html += "</tr>\n<tr><td>the same with changes as ratios (1.333 for 33.3 %)</td><td></td>";
  for (const LawPrediction* p : laws) html += fmt::format("<td class=\"n\">{:.1f} %</td>", 100.0 * p->rms_of_ratios);
  html += "</tr>\n<tr><th class=\"group\" colspan=\"8\">Used in the calibration of S_2 and S_3, not scored</th></tr>\n";
  rows(laws[0]->seen);
  html +=
      "<tr><th class=\"group\" colspan=\"8\">Without → with springs (no published "
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
        std::string values[2] = {"-", "-"};
        for (const Comparison::Run& run : p->comparison.runs) {
          if (run.voltage != point.first || run.frequency != point.second) continue;
          values[run.design == first.design ? 0 : 1] =
              readable(run.result.metrics[metric], metric_info(metric).unit) + (run.result.domain.any() ? " ‡" : "");
        }
        html += fmt::format("<td class=\"n\">{} → {}</td>", values[0], values[1]);
      }
      html += "</tr>\n";
    }
  }
  return html + "</tbody></table></div>\n<p class=\"files\">‡ outside the domain; all other numbers are inside.</p>\n";
}

const ComparedValue* change_of(const LawPrediction& p, Metric metric) {
  for (const ComparedValue& c : p.comparison.values) {
    if (c.published.metric == metric && c.published.change && c.published.frequency) return &c;
  }
  return nullptr;
}

std::string milliwatts(double watt) { return std::isfinite(watt) ? fmt::format("{:.0f} mW", 1e3 * watt) : "-"; }

std::string between(const Interval& i, double scale, const char* unit, int digits = 0) {
  return std::isfinite(i.low)
             ? fmt::format(" ({:.{}f} to {:.{}f} {})", scale * i.low, digits, scale * i.high, digits, unit)
             : "";
}

/// What the vehicle as published takes at the held frequency, and what it takes with its friction left out.
std::string cost_of_leaving_out(const Assessment& a, std::size_t f) {
  const TitleAnswer& t = a.answers[f];
  const double residual = std::max(std::abs(t.residual_with), std::abs(t.residual_without));
  return fmt::format("<b>{} instead of {}</b>, {:+.0f} %{} ({}; {})", milliwatts(t.without), milliwatts(t.with),
                     100.0 * t.change, between(t.change_interval, 100.0, "%"), variant_name(f),
                     t.outside ? fmt::format("<b>outside the domain</b>: without friction the formulation residual is "
                                             "{:.1f} % of the input, at most {:g} % are allowed",
                                             100.0 * residual, 100.0 * formulation_residual_max)
                               : "inside the domain");
}

/// Least and largest of a number of the rivals to load-proportional friction, by a variant.
template <class Number>
std::pair<double, double> range_of_rivals(const Assessment& a, std::size_t variant, const Number& number) {
  double low = INFINITY, high = -INFINITY;
  for (const LawPrediction& p : a.laws) {
    if (p.variant != variant || p.rival == load_proportional_rival) continue;
    low = std::min(low, number(p));
    high = std::max(high, number(p));
  }
  return {low, high};
}

std::string commands_of_the_answer(const Material& m) {
  std::string html = "<pre>";
  for (const bool friction : {true, false}) {
    for (const std::size_t f : {1, 0}) {
      html += fmt::format("build/release/wingbeat run data/designs/friction2022.toml --frequency \"{:g} Hz\"{}{}{}\n",
                          m.computed.options.frequency, f == 1 ? " --set transmission.formulation=virtual-work" : "",
                          friction ? "" : " --set friction.type=none",
                          !friction && m.assessment.answers[f].outside ? " --allow-extrapolation" : "");
    }
  }
  html += "build/release/wingbeat tolerance data/studies/tolerance-friction2022.toml\n";
  return html + "</pre>\n";
}

}  // namespace

const LawPrediction* law_of(const Assessment& a, std::size_t rival, std::size_t variant) {
  for (const LawPrediction& p : a.laws) {
    if (p.rival == rival && p.variant == variant) return &p;
  }
  return nullptr;
}

std::string answer_html(const Material& m) {
  const Assessment& a = m.assessment;
  const LawPrediction* load = law_of(a, load_proportional_rival, 0);
  std::array<const LawPrediction*, 2> drag{};  // by rod-force and by virtual-work
  for (const LawPrediction& p : a.laws) {
    if (p.variant < 2 && rivals[p.rival].own_drag) drag[p.variant] = &p;
  }
  if (!load || !drag[0] || !drag[1]) return "";
  const auto [best, worst] = range_of_rivals(a, 0, [](const LawPrediction& p) { return p.rms; });
  const TitleAnswer &work = a.answers[1], &rod = a.answers[0];
  std::string html = fmt::format(
      "<div class=\"answer\"><p><b>Should friction losses be included? Yes, in this model.</b> At {:g} Hz without "
      "springs, a model without friction predicts an electrical input of {}. By the paper's equation (1) it is "
      "{}.</p>\n",
      m.computed.options.frequency, cost_of_leaving_out(a, 1), cost_of_leaving_out(a, 0));
  if (a.samples > 0) {
    html += fmt::format(
        "<p>With friction the input is {}{} by virtual-work and {}{} by rod-force; without, {}{} and {}{}. In "
        "brackets: "
        "95 % of {} samples of {} uncertain parameters, <a href=\"#uncertainty\">whose deviations are assumed</a>; "
        "below, "
        "of calibrated numbers, 95 % by {} calibrations anew.</p>\n",
        milliwatts(work.with), between(work.with_interval, 1e3, "mW"), milliwatts(rod.with),
        between(rod.with_interval, 1e3, "mW"), milliwatts(work.without), between(work.without_interval, 1e3, "mW"),
        milliwatts(rod.without), between(rod.without_interval, 1e3, "mW"), a.samples, m.file.uncertain.size(),
        2 * m.file.uncertain.size());
  }
  std::string refitted;
  for (const std::size_t f : {1, 0}) {
    const ComparedValue* input = change_of(*drag[f], Metric::power_electrical);
    if (!input) continue;
    const bool outside = is_outside(*drag[f], input->published, input->published.design);
    refitted += fmt::format(
        "{} {:.2f} times the drag{} and {:+.1f} %{} ({}, {} the domain)", refitted.empty() ? "" : ";",
        drag[f]->drag_factor, between(drag[f]->drag_interval, 1.0, "times", 2), 100.0 * input->computed,
        between(drag[f]->input_change_interval, 100.0, "%", 1), variant_name(f), outside ? "outside" : "inside");
  }
  const ComparedValue* published = change_of(*load, Metric::power_electrical);
  html += fmt::format(
      "<p><b>Rivals, refitted.</b> Without friction, more drag meets the published frequency as well, but then springs "
      "raise the input, where {} is published:{}. Calibrated without springs, load-proportional friction predicts "
      "the {} "
      "published values with springs to {:.1f} % (root mean square, changes as printed; rod-force), every rival only "
      "to "
      "{:.0f} to {:.0f} %.</p>\n"
      "<p><b>Simulation against simulation.</b> The published values are those of the paper's simulation. No "
      "measurement is compared here: that this model reproduces them shows what follows from its equations, not how "
      "real joints behave.</p></div>\n",
      published ? published->published.published_text : "-", refitted, load->tests.size(), 100.0 * load->rms,
      100.0 * best, 100.0 * worst);
  return with_minus_signs(html) + commands_of_the_answer(m);
}

std::string question_html(const Material& m) {
  const Assessment& a = m.assessment;
  const LawPrediction* load = law_of(a, load_proportional_rival, 0);
  const LawPrediction* none = law_of(a, 0, 0);
  if (!load || !none) return "";
  const PublishedValue& target = calibration_value(m.file);
  const std::string point = operating_point(target.voltage, target.frequency);
  std::string html = fmt::format(
      "<p>A model without friction underestimates the electrical input at {:g} Hz without springs: {}; {}. A term that "
      "is merely taken away proves little: such a model also flaps at {:.1f} Hz instead of the published {} at {}, and "
      "a model is assessed after its free numbers have been fitted. Below, a frictionless model with more drag and one "
      "with more damping of the crank (viscous) are fitted, too.</p>\n",
      m.computed.options.frequency, cost_of_leaving_out(a, 1), cost_of_leaving_out(a, 0), none->law.frequency,
      target.published_text, point);
  html += fmt::format(
      "<p><b>Which friction?</b> Each model gets one number - the coefficient of its friction, or a factor on the drag "
      "- chosen so that the vehicle <em>without</em> springs flaps at the published {} at {}. Then springs are added, "
      "nothing else is changed, and the model predicts the {} published values with springs that were not used in a "
      "calibration. Root mean square of the deviations, changes as the paper prints them; in brackets with changes as "
      "ratios (1.333 for 33.3 %), which hides most of a change:</p>\n<div class=\"wide\"><table><thead><tr><th></th>",
      target.published_text, point, load->tests.size());
  for (const Rival& rival : rivals) html += fmt::format("<th>{}</th>", rival.name);
  html += "</tr></thead><tbody>\n";
  for (std::size_t f = 0; f < a.variants; ++f) {
    html += fmt::format("<tr><td>{}</td>", variant_name(f));
    for (std::size_t n = 0; n < std::size(rivals); ++n) {
      const LawPrediction* p = law_of(a, n, f);
      bool outside = false;
      for (const std::size_t k : p ? p->tests : std::vector<std::size_t>()) {
        const PublishedValue& v = p->comparison.values[k].published;
        outside = outside || is_outside(*p, v, v.design) || (v.relative_to && is_outside(*p, v, *v.relative_to));
      }
      html += fmt::format("<td class=\"n\">{}{}{}</td>",
                          p ? fmt::format("{:.1f} % ({:.1f} %)", 100.0 * p->rms, 100.0 * p->rms_of_ratios) : "-",
                          outside ? " ‡" : "", p && !p->law.calibrated ? "<br>frequency not met" : "");
    }
    html += "</tr>\n";
  }
  html +=
      "</tbody></table></div>\n<p class=\"files\">‡ a number behind it is outside the domain; without the mark all "
      "are inside.</p>\n";
  const auto input_of = [](const LawPrediction& p) {
    const ComparedValue* c = change_of(p, Metric::power_electrical);
    return c ? c->computed : absent;
  };
  const auto [lowest, highest] = range_of_rivals(a, 0, input_of);
  if (const ComparedValue* c = change_of(*load, Metric::power_electrical)) {
    html += fmt::format(
        "<p>At {:g} Hz springs change the published electrical input by {}. Load-proportional friction predicts "
        "{:+.1f} %, its rivals predict {:+.1f} to {:+.1f} % (rod-force).</p>\n",
        m.computed.options.frequency, c->published.published_text, 100.0 * c->computed, 100.0 * lowest,
        100.0 * highest);
  }
  html +=
      "<p><b>Why.</b> At prescribed frequency springs change neither speed nor stroke much: they carry part of the "
      "inertial load at stroke reversal. A loss that depends on the speed alone - viscous, quadratic, constant, drag - "
      "stays as it is. A loss that depends on the force inside the mechanism falls with it. The laws differ only "
      "where the "
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

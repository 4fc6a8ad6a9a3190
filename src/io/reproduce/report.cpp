// report.html: everything in one file that needs neither network nor script.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sheet.hpp"
#include "wingbeat/io/report.hpp"
#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr const char* style = R"(
:root { --ink: #1a1a1a; --soft: #595959; --line: #d4d4d4; --accent: #00507c; }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2rem 1.25rem 4rem; max-width: 68rem; color: var(--ink); background: #fff;
  font: 16px/1.55 Georgia, "Times New Roman", serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .4rem; }
h2 { font-size: 1.35rem; margin: 2.8rem 0 .6rem; padding-top: .6rem; border-top: 2px solid var(--accent); }
h3 { font-size: 1.05rem; margin: 1.6rem 0 .4rem; }
p, ul, ol { max-width: 46rem; }
.lead { color: var(--soft); }
nav ol { columns: 2; padding-left: 1.4rem; }
a { color: var(--accent); }
.figures { display: grid;
  grid-template-columns: repeat(auto-fill, minmax(min(100%, 26rem), 1fr)); gap: 1.6rem 2rem; align-items: start; }
figure { margin: 0; }
figure svg { width: 100%; height: auto; display: block; border: 1px solid var(--line); }
figcaption { font-size: .87rem; line-height: 1.45; margin-top: .45rem; }
figcaption b { display: block; }
.files { color: var(--soft); }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font: .82rem/1.4 Arial, Helvetica, sans-serif; margin: .8rem 0 1.2rem; }
th, td { text-align: left; vertical-align: top; padding: .28rem .6rem; border-bottom: 1px solid var(--line); }
thead th { border-bottom: 2px solid var(--ink); }
td:first-child { min-width: 13rem; }
table.laws { font-size: .78rem; }
table.laws td.n { white-space: normal; min-width: 5.2rem; }
th.group { background: #eef3f6; padding-top: .5rem; }
td.n { text-align: right; white-space: nowrap; }
.v { white-space: nowrap; }
.yes::before { content: "\25CF  "; color: #007a5a; }
.no::before { content: "\25CB  "; color: #b03a00; }
.part::before { content: "\25D0  "; color: #7a5c00; }
pre { background: #f5f5f5; border: 1px solid var(--line); padding: .7rem .9rem; overflow-x: auto; font-size: .85rem; line-height: 1.4; }
code { font-size: .9em; }
@media print { body { max-width: none; padding: 0; font-size: 10pt; } h2 { break-after: avoid; }
  figure, tr { break-inside: avoid; }
  .figures { grid-template-columns: 1fr 1fr; }
  nav { display: none; }
  .wide { overflow: visible; } table, table.laws { width: 100%; font-size: 6.6pt; }
  th, td { padding: .2rem .3rem; } td:first-child { min-width: 9rem; }
  td.n, table.laws td.n, .v { white-space: normal; min-width: 0; } pre { white-space: pre-wrap; } }
)";

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// A drawing as part of the page: without prologue, with names of its own.
std::string inlined(std::string svg, const std::string& id, const std::string& title) {
  const auto begin = svg.find("<svg");
  if (begin != std::string::npos) svg.erase(0, begin);
  const std::string mark = id + "-";
  for (const char quote : {'\'', '"'}) {
    replace_all(svg, fmt::format(" id={}", quote), fmt::format(" id={}{}", quote, mark));
    replace_all(svg, fmt::format("href={}#", quote), fmt::format("href={}#{}", quote, mark));
  }
  replace_all(svg, "url(#", fmt::format("url(#{}", mark));
  replace_all(svg, "<title>Gnuplot</title>", fmt::format("<title>{}</title>", escaped(title)));
  const auto desc = svg.find("<desc>"), end = svg.find("</desc>");
  if (desc != std::string::npos && end != std::string::npos) svg.erase(desc, end + 7 - desc);
  return svg;
}

std::string deviation(double d) {
  if (!std::isfinite(d)) return "-";
  return std::abs(d) < 5e-4 ? "0.0 %" : fmt::format("{:+.1f} %", 100.0 * d);
}

const char* class_of(Verdict v) {
  return v == Verdict::reproduced ? "yes" : v == Verdict::not_reproduced ? "no" : v == Verdict::as_found ? "" : "part";
}

std::string verdict_cell(const Claim& c) {
  std::string text = name_of(c.verdict);
  if (c.verdict == Verdict::depends_on_formulation) {
    text += fmt::format("<br>({})", name_of(both_formulations[c.within[0] ? 0 : 1]));
  }
  return text;
}

std::string claims_table(const Judgement& j) {
  std::string html =
      "<div class=\"wide\"><table><thead><tr><th>statement</th><th>where</th><th>published</th><th>rod-force</th>"
      "<th></th><th>virtual-work</th><th></th><th>accepted</th><th>verdict</th></tr></thead><tbody>\n";
  const std::pair<const char*, bool (*)(const Claim&)> groups[] = {
      {"Predicted: nothing was adjusted to these",
       [](const Claim& c) { return c.basis == Basis::predicted && c.verdict != Verdict::as_found; }},
      {"Given: what the published tables say by themselves", [](const Claim& c) { return c.basis == Basis::given; }},
      {"Calibrated: looked at when S_2 and S_3 were chosen, and so no evidence for the model",
       [](const Claim& c) { return c.basis == Basis::calibrated; }},
      {"As found: the paper shows it in a figure, no number is at hand",
       [](const Claim& c) { return c.verdict == Verdict::as_found; }}};
  for (const auto& [name, belongs] : groups) {
    html += fmt::format("<tr><th class=\"group\" colspan=\"9\">{}</th></tr>\n", name);
    for (const Claim& c : j.claims) {
      if (!belongs(c)) continue;
      html += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td>", escaped(c.statement), escaped(c.where),
                          escaped(c.published_text));
      for (std::size_t f = 0; f < 2; ++f) {
        html += fmt::format("<td>{}</td><td class=\"n\">{}</td>", escaped(c.ours_text[f]),
                            c.published ? deviation(c.deviation[f]) : "");
      }
      html += fmt::format("<td class=\"n\">{}</td><td class=\"v {}\">{}</td></tr>\n",
                          std::isfinite(c.tolerance) ? fmt::format("±{:.3g} %", 100.0 * c.tolerance) : "",
                          class_of(c.verdict), c.verdict == Verdict::as_found ? "" : verdict_cell(c));
    }
  }
  return html + "</tbody></table></div>\n";
}

const char* coefficient_unit(FrictionLaw law) {
  switch (law) {
    case FrictionLaw::viscous:
      return "N m s/rad";
    case FrictionLaw::quadratic:
      return "N m s2/rad2";
    case FrictionLaw::constant:
      return "N m";
    case FrictionLaw::load_proportional:
      return "m";
    case FrictionLaw::none:
      break;
  }
  return "";
}

std::string coefficient(const CalibratedLaw& law) {
  if (law.law == FrictionLaw::none) return "nothing to choose";
  if (law.law == FrictionLaw::load_proportional) return readable(law.coefficient, "m");
  return fmt::format("{:.4g} {}", law.coefficient, coefficient_unit(law.law));
}

/// Every published value with springs, as each law predicts it.
std::string law_table(const Judgement& j, Formulation formulation) {
  std::vector<const LawPrediction*> laws;
  for (const LawPrediction& p : j.laws) {
    if (p.law.formulation == formulation) laws.push_back(&p);
  }
  if (laws.empty()) return "";
  std::string html = "<div class=\"wide\"><table class=\"laws\"><thead><tr><th></th><th>published</th>";
  for (const LawPrediction* p : laws) html += fmt::format("<th>{}</th>", law_name(p->law.law));
  html += "</tr></thead><tbody>\n<tr><td>coefficient</td><td></td>";
  for (const LawPrediction* p : laws) html += fmt::format("<td class=\"n\">{}</td>", coefficient(p->law));
  const PublishedValue& first = laws[0]->comparison.values[0].published;
  html += fmt::format("</tr>\n<tr><td>flapping frequency at {}, springs off (calibrated)</td><td class=\"n\">{}</td>",
                      operating_point(first.voltage, first.frequency), readable(first.published, "Hz"));
  for (const LawPrediction* p : laws) {
    html += fmt::format("<td class=\"n\">{}{}</td>", readable(p->law.frequency, "Hz"),
                        p->law.calibrated ? "" : " (not met)");
  }
  html +=
      "</tr>\n<tr><th class=\"group\" colspan=\"7\">Published values with springs, and how far each law is "
      "off</th></tr>\n";
  for (const std::size_t n : laws[0]->tests) {
    const PublishedValue& v = laws[0]->comparison.values[n].published;
    const MetricInfo& info = metric_info(v.metric);
    const auto shown = [&](double x) { return v.relative_to ? fmt::format("{:#.4g}", x) : readable(x, info.unit); };
    html += fmt::format("<tr><td>{}, {} at {}</td><td class=\"n\">{}</td>", info.long_name,
                        v.relative_to ? "on over off" : "springs on", operating_point(v.voltage, v.frequency),
                        shown(v.published));
    for (const LawPrediction* p : laws) {
      const ComparedValue& c = p->comparison.values[n];
      html += fmt::format("<td class=\"n\">{}<br>{}</td>", shown(c.computed), deviation(c.deviation));
    }
    html += "</tr>\n";
  }
  html += "<tr><td><b>all of these, root mean square</b></td><td></td>";
  for (const LawPrediction* p : laws) html += fmt::format("<td class=\"n\"><b>{:.1f} %</b></td>", 100.0 * p->rms);
  html +=
      "</tr>\n<tr><th class=\"group\" colspan=\"7\">What else each law predicts, springs off and on (no published "
      "numbers)</th></tr>\n";
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

const LawPrediction* law_of(const Judgement& j, FrictionLaw law, Formulation formulation) {
  for (const LawPrediction& p : j.laws) {
    if (p.law.law == law && p.law.formulation == formulation) return &p;
  }
  return nullptr;
}

const ComparedValue* ratio_of(const LawPrediction& p, Metric metric, bool at_frequency) {
  for (const ComparedValue& c : p.comparison.values) {
    if (c.published.metric == metric && c.published.relative_to && c.published.frequency.has_value() == at_frequency) {
      return &c;
    }
  }
  return nullptr;
}

double computed_of(const LawPrediction& p, Metric metric, bool at_frequency) {
  const ComparedValue* c = ratio_of(p, metric, at_frequency);
  return c ? c->computed : absent;
}

double published_of(const LawPrediction& p, Metric metric, bool at_frequency) {
  const ComparedValue* c = ratio_of(p, metric, at_frequency);
  return c ? c->published.published : absent;
}

std::string question(const Material& m) {
  const Judgement& j = m.judgement;
  const LawPrediction* load = law_of(j, FrictionLaw::load_proportional, Formulation::rod_force);
  if (!load) return "";
  double least = INFINITY, most = 0.0, power_low = INFINITY, power_high = 0.0;
  for (const LawPrediction& p : j.laws) {
    if (p.law.formulation != Formulation::rod_force || &p == load) continue;
    least = std::min(least, p.rms);
    most = std::max(most, p.rms);
    if (p.law.law == FrictionLaw::none) continue;
    const double power = computed_of(p, Metric::power_electrical, true);
    power_low = std::min(power_low, power);
    power_high = std::max(power_high, power);
  }
  const LawPrediction* load_work = law_of(j, FrictionLaw::load_proportional, Formulation::virtual_work);
  const PublishedValue& target = calibration_value(m.file);
  std::string html = fmt::format(
      "<p>\"Should friction losses be included?\" As numbers: each friction law gets one coefficient, chosen so that "
      "the vehicle <em>without"
      "</em> springs flaps at the published {} at {}. Then the springs go on, nothing else is changed, and the law has "
      "to say what "
      "happens.</p>\n"
      "<p><b>Answer.</b> With load-proportional friction the published values with springs come back within {:.1f} % "
      "(root mean square, formulation "
      "rod-force); with every other law they are off by {:.1f} to {:.1f} %. At {:g} Hz the paper's springs leave {} of "
      "the "
      "electrical input; load-proportional friction says {:.3f}, the laws without load say {:.3f} to {:.3f}: they see "
      "almost no saving. "
      "No friction at all cannot even be calibrated: the vehicle then flaps too fast.{}</p>\n",
      readable(target.published, "Hz"), operating_point(target.voltage, target.frequency), 100.0 * load->rms,
      100.0 * least, 100.0 * most, m.computed.options.frequency, published_of(*load, Metric::power_electrical, true),
      computed_of(*load, Metric::power_electrical, true), power_low, power_high,
      load_work ? fmt::format(" In the formulation virtual-work load-proportional friction is ahead too, by less: "
                              "{:.1f} %, with a radius of {} instead of {}; the chord "
                              "moments were chosen for rod-force and do not suit it.",
                              100.0 * load_work->rms, readable(load_work->law.coefficient, "m"),
                              readable(load->law.coefficient, "m"))
                : "");
  html +=
      "<p><b>Why.</b> At a held frequency springs change neither speed nor stroke much: they take over the force that "
      "turns the wings round. A loss that depends on "
      "speed alone - viscous, quadratic, constant - has nothing to answer to. A loss that depends on the force inside "
      "the mechanism falls "
      "with it. That is all the difference between the laws, and it shows only when the force changes and the speed "
      "does not, as when springs are "
      "added. At one operating point any law will do.</p>\n";
  html +=
      "<p><b>What this does not show.</b> The published values are themselves the paper's simulation of a vehicle "
      "fitted with "
      "load-proportional friction; that this law brings them back best shows that the program computes what the paper "
      "computed, not that joints "
      "in the world behave so. Four things a bench would have to show: (1) input power at one held frequency with "
      "springs of several stiffnesses: "
      "the curves below separate the laws, by more than a tenth of the input; (2) the same in vacuum, where "
      "load-proportional friction stays "
      "large and the air takes nothing; (3) the rod force itself, measured, beside the loss; (4) wings of several "
      "inertias on the same "
      "mechanism. <code>wingbeat fit --compare-friction</code> takes such logs and ranks the laws.</p>\n";
  html += "<h3>rod-force</h3>\n" + law_table(j, Formulation::rod_force);
  html += "<h3>virtual-work</h3>\n" + law_table(j, Formulation::virtual_work);
  return html;
}

/// Whether the vehicle lifts itself at the motor's highest voltage, from the statements on it.
std::string hover_answer(const Material& m) {
  std::string html = "<p><b>Does it hover at 5 V?</b> With the best crank between 3 and 14 mm, its radius in "
                     "brackets:</p>\n<ul>\n";
  const double weight = total_mass(m.pair[0]).value_or(absent) * standard_gravity;
  for (std::size_t f = 0; f < 2; ++f) {
    std::string yes, no;
    for (const Claim& c : m.judgement.claims) {
      if (c.verdict != Verdict::as_found || c.unit != "N") continue;
      std::string& list = c.ours[f] >= weight ? yes : no;
      const bool springs = c.statement.find("with springs") != std::string::npos;
      const bool stroke = c.statement.find("stroke held") != std::string::npos;
      list += fmt::format("{}{} springs, {} held: {:.2f} of its weight, {}", list.empty() ? "" : "; ",
                          springs ? "with" : "without", stroke ? "stroke" : "hinge offset", c.ours[f] / weight,
                          escaped(c.ours_text[f]));
    }
    html += fmt::format("<li>{}: ", name_of(both_formulations[f]));
    if (!yes.empty()) html += fmt::format("<b>yes</b> {}. ", yes);
    if (!no.empty()) html += fmt::format("<b>No</b> {}.", no);
    html += "</li>\n";
  }
  return html + "</ul>\n";
}

std::string parameters(const Material& m) {
  const Design<double>& d = m.pair[1];
  const Vehicle<double> v = resolve(d);
  std::string html =
      "<div class=\"wide\"><table><thead><tr><th>parameter</th><th>value</th><th>from</th></tr></thead><tbody>\n";
  const auto row = [&](const char* name, const std::string& value, const char* from) {
    html += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td><td>{}</td></tr>\n", name, value, from);
  };
  row("armature resistance R_a", fmt::format("{:.4g} ohm", v.motor.armature_resistance), "Table 1");
  row("armature inductance L_a", readable(v.motor.armature_inductance, "H"), "Table 1");
  row("torque constant K", fmt::format("{:.4g} N m/A", v.motor.torque_constant), "Table 1");
  row("rotor inertia J", fmt::format("{:.4g} kg m2", v.motor.inertia), "Table 1");
  row("rotor drag b", fmt::format("{:.4g} N m s/rad", v.motor.viscous_damping), "Table 1");
  row("crank radius r_c", readable(v.crank.crank_radius, "m"), "Table 2");
  row("rod length l", readable(v.crank.rod_length, "m"), "Table 2");
  row("hinge offset H", readable(v.crank.hinge_offset, "m"), "Table 2");
  row("inertia of one wing J_w", fmt::format("{:.4g} kg m2", v.wing_inertia), "Table 2");
  row("spring of one hinge k", fmt::format("{:.4g} N m/rad", v.spring.stiffness), "Table 2");
  row("friction radius mu r_e", readable(v.friction.radius, "m"), "Table 2");
  row("pitch coefficient C_alpha", fmt::format("{:.4g} s", v.wings.pitch_coefficient), "Table 2");
  row("mass", fmt::format("{:.4g} g", 1e3 * total_mass(d).value_or(absent)), "Table 2");
  row("chord moment S_2", fmt::format("{:.4g} m4", v.wings.s2), "<b>calibrated</b>, not published");
  row("chord moment S_3", fmt::format("{:.4g} m5", v.wings.s3), "<b>calibrated</b>, not published");
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string report_html(const Material& m, const std::vector<Sheet>& sheets, const std::string& version,
                        const std::function<std::string(const Sheet&)>& svg_of) {
  const Judgement& j = m.judgement;
  std::string html;
  auto out = std::back_inserter(html);
  const auto figures = [&](const std::string& section) {
    html += "<div class=\"figures\">\n";
    for (const Sheet& s : sheets) {
      if (s.section != section) continue;
      fmt::format_to(out,
                     "<figure id=\"{0}\">{1}<figcaption><b>{2}</b> {3} <span class=\"files\">Files: {0} .svg .pdf .csv "
                     ".nc</span></figcaption></figure>\n",
                     s.id, inlined(svg_of(s), s.id + "-drawing", s.heading), escaped(s.heading), escaped(s.caption));
      if (!s.animation.empty()) {
        fmt::format_to(out,
                       "<figure>{}<figcaption><b>The same, moving.</b> One computed cycle, repeated: the crank does "
                       "not turn evenly. "
                       "<span class=\"files\">File: {}-moving.svg</span></figcaption></figure>\n",
                       inlined(s.animation, s.id + "-moving", s.heading), s.id);
      }
    }
    html += "</div>\n";
  };
  const std::pair<const char*, const char*> sections[] = {{"summary", "Verdicts in short"},
                                                          {"vehicle", "The vehicle"},
                                                          {"conditions", "Air, vacuum, no wings (figures 4 to 7)"},
                                                          {"springs", "With and without springs (figures 9 to 13)"},
                                                          {"cycles", "Over a cycle (figures 14 to 19)"},
                                                          {"section5", "Crank, rod and voltage (figures 20 to 22)"},
                                                          {"claims", "Every statement, judged"},
                                                          {"question", "Should friction losses be included?"},
                                                          {"energy", "Where the energy goes"},
                                                          {"how", "How each number was computed"}};
  const auto begin = [&](const char* id) {
    for (std::size_t n = 0; n < std::size(sections); ++n) {
      if (sections[n].first == std::string_view(id)) {
        fmt::format_to(out, "<section>\n<h2 id=\"{}\">{}. {}</h2>\n", id, n + 1, sections[n].second);
      }
    }
  };
  const auto end = [&] { html += "</section>\n"; };

  fmt::format_to(
      out,
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n"
      "<title>The 2022 friction paper, reproduced</title>\n<link rel=\"icon\" "
      "href=\"data:,\">\n<style>{}</style></head>\n<body>\n<header>\n"
      "<h1>The 2022 friction paper, reproduced and judged</h1>\n<p class=\"lead\">{}. Made by wingbeat {} with "
      "<code>wingbeat reproduce friction2022</code>{}.</p>\n</header>\n<nav><ol>\n",
      style, escaped(m.file.source), version, m.computed.options.coarse ? ", coarse setting" : "");
  for (const auto& [id, name] : sections) fmt::format_to(out, "<li><a href=\"#{}\">{}</a></li>\n", id, name);
  html += "</ol></nav>\n<main>\n";

  begin("summary");
  const int open = j.count(Verdict::as_found), all = int(j.claims.size()) - open;
  const auto within = [&](std::size_t f) {
    return int(std::count_if(j.claims.begin(), j.claims.end(),
                             [&](const Claim& c) { return c.verdict != Verdict::as_found && c.within[f]; }));
  };
  const auto predicted = [&](std::size_t f, bool met) {
    return int(std::count_if(j.claims.begin(), j.claims.end(), [&](const Claim& c) {
      return c.verdict != Verdict::as_found && c.basis == Basis::predicted && (!met || c.within[f]);
    }));
  };
  fmt::format_to(out,
                 "<p>Of {} statements that can be checked, <b>{} are met by the paper's own formulation</b> "
                 "(rod-force, its equation (1) as "
                 "printed) and {} by the one that conserves power (virtual-work). Counted over both: {} reproduced, {} "
                 "depend on the "
                 "formulation, {} not reproduced. {} more concern figures of which no number is at hand; they are "
                 "reported as found.</p>\n",
                 all, within(0), within(1), j.count(Verdict::reproduced), j.count(Verdict::depends_on_formulation),
                 j.count(Verdict::not_reproduced), open);
  fmt::format_to(out,
                 "<p>Nothing was tuned here. Two numbers that the paper does not publish, the chord moments S_2 and "
                 "S_3 of the wing, come from the "
                 "vehicle file, where they were chosen with rod-force; the values that were looked at then are "
                 "counted, but listed apart. Of the {} "
                 "statements that were <em>not</em> looked at, rod-force meets {} and virtual-work {}.</p>\n<ul>\n",
                 predicted(0, false), predicted(0, true), predicted(1, true));
  for (const Claim& c : j.claims) {
    if (c.verdict == Verdict::not_reproduced) {
      fmt::format_to(out, "<li><b>Not reproduced:</b> {}: published {}, ours {} and {}.</li>\n", escaped(c.statement),
                     escaped(c.published_text), escaped(c.ours_text[0]), escaped(c.ours_text[1]));
    }
  }
  html +=
      "<li><b>The formulation decides most of the rest.</b> The same vehicle in a formulation that conserves power "
      "flaps faster and "
      "gains less from springs. That speaks for the paper's numbers having been computed with equation (1) as printed, "
      "whose "
      "imbalance acts like friction of its own (<a href=\"#energy\">the residual</a>).</li>\n"
      "<li><b>Friction has to follow the load.</b> Only load-proportional friction predicts what springs do "
      "(<a href=\"#question\">the title question</a>).</li>\n</ul>\n";
  end();

  begin("vehicle");
  html +=
      "<p>A geared DC motor turns a crank; a rod moves a slider up and down its guide; the slider swings two wings "
      "about fixed hinges. "
      "Springs in the hinges, where fitted, store energy at the ends of the stroke.</p>\n" +
      parameters(m);
  figures("vehicle");
  end();
  begin("conditions");
  html +=
      "<p>The frequency is held by the voltage. Thick curves with marks are rod-force, the paper's formulation; thin "
      "curves without marks of the same "
      "colour and dash are virtual-work. Springs are off.</p>\n";
  figures("conditions");
  end();
  begin("springs");
  html +=
      "<p>In air, the frequency held. Springs cost power where they are too stiff for the frequency, and save where "
      "they suit it.</p>\n";
  figures("springs");
  end();
  begin("cycles");
  fmt::format_to(
      out,
      "<p>Each cycle begins at crank angle zero, the slider in mid-stroke and rising. First at the same frequency, "
      "{:g} Hz, which the springs reach "
      "at a lower voltage; then at the same voltage, {:g} V, which makes the vehicle with springs faster.</p>\n",
      m.computed.options.frequency, m.computed.options.voltage);
  figures("cycles");
  end();
  begin("section5");
  html +=
      "<p>Section 5 of the paper varies the mechanism. Its optima stand in figures; here is what comes out, without a "
      "published number to hold it "
      "against. On the 5 V question - can the motor's highest voltage lift the vehicle's own weight? - see figure 22 "
      "and the last rows of "
      "<a href=\"#claims\">the table</a>.</p>\n";
  html += hover_answer(m);
  figures("section5");
  end();
  begin("claims");
  html +=
      "<p>The deviation is ours over published minus 1; \"accepted\" is this project's tolerance, not the paper's. ● "
      "met in both formulations, "
      "◐ in one, ○ in neither. Also as claims.csv and claims.json.</p>\n" +
      claims_table(j);
  end();
  begin("question");
  html += question(m);
  figures("question");
  end();
  begin("energy");
  html +=
      "<p>What the supply delivers over a cycle leaves as heat in the armature, drag of the rotor, friction and air - "
      "and, with the paper's "
      "equation (1) as printed, as a residual that no part of the vehicle receives. The sums close to the solver's "
      "accuracy.</p>\n";
  figures("energy");
  end();
  begin("how");
  html +=
      R"(<p>All of it: the steady cycle is a periodic orbit in crank angle, found to a relative tolerance of 1e-7 or
better; peaks and crossings of the table are searched for on the orbits themselves, not read off the curves,
so that they do not depend on the number of points drawn. The commands below run in a checkout, where
<code>scripts/test</code> or <code>scripts/demo</code> has built the program.</p>
<h3>This report</h3>
<pre>build/release/wingbeat reproduce friction2022 -o out/friction2022</pre>
<h3>One point of figures 4 to 13</h3>
<pre>build/release/wingbeat run data/designs/friction2022.toml --frequency "22 Hz" --condition vacuum
build/release/wingbeat run data/designs/friction2022-springs.toml --frequency "22 Hz"
build/release/wingbeat run data/designs/friction2022.toml --frequency "22 Hz" --set transmission.formulation=virtual-work</pre>
<h3>The cycles of figures 14 to 19</h3>
<pre>build/release/wingbeat run data/designs/friction2022-springs.toml --frequency "22 Hz" --waveforms cycle.csv
build/release/wingbeat run data/designs/friction2022-springs.toml --voltage "3 V" --plot cycle.svg</pre>
<h3>The curves of figures 20 to 22, as data sets of their own</h3>
<pre>build/release/wingbeat sweep data/studies/trend-crank-fixed-hinge.toml -o crank.nc
build/release/wingbeat sweep data/studies/trend-rod.toml -o rod.nc
build/release/wingbeat sweep data/studies/trend-voltage.toml -o voltage.nc</pre>
<h3>The published values alone</h3>
<pre>build/release/wingbeat compare data/published/friction2022.toml</pre>
<h3>A friction law</h3>
<pre>build/release/wingbeat run data/designs/friction2022-springs.toml --frequency "22 Hz" --set friction.type=constant )";
  const LawPrediction* constant = law_of(j, FrictionLaw::constant, Formulation::rod_force);
  fmt::format_to(out, "--set friction.torque=\"{:.6g} N m\"</pre>\n", constant ? constant->law.coefficient : 7e-4);
  html +=
      "<p>Published values, their tolerances and where they stand: <code>data/published/friction2022.toml</code>. The "
      "vehicles: "
      "<code>data/designs/friction2022.toml</code> and <code>friction2022-springs.toml</code>. Both are carried in the "
      "program itself.</p>\n";
  end();
  html += "</main>\n</body></html>\n";
  return html;
}

}  // namespace wingbeat::reproduction

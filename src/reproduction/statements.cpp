// Of the report: summary, parameters, the two readings of section 5, and the table of statements.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "reproduction/html.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr const char* s2 = "<i>S</i><sub>2</sub>";
constexpr const char* s3 = "<i>S</i><sub>3</sub>";

/// 2.457e-6 m4 as "2.457·10⁻⁶ m⁴".
std::string scientific(double x, int digits, const char* unit) {
  if (!std::isfinite(x)) return "-";
  const std::string text = fmt::format("{:.{}e}", x, digits);
  const auto e = text.find('e');
  return fmt::format("{}·10<sup>{}</sup> {}", text.substr(0, e), std::stoi(text.substr(e + 1)), unit);
}

const char* class_of(StatementOutcome outcome) {
  using enum StatementOutcome;
  return outcome == reproduced               ? "yes"
         : outcome == not_reproduced         ? "no"
         : outcome == depends_on_formulation ? "part"
                                             : "";
}

std::string with_deviation(const Claim& c, std::size_t f) {
  const std::string off = percent_text(c.deviation[f]);
  std::string html = markup_escaped(c.ours_text[f]) + (off.empty() ? "" : " (" + off + ")");
  if (std::isfinite(c.interval[f].low)) {
    html += fmt::format("<br><span class=\"files\">95 %: {} to {}</span>",
                        markup_escaped(number_text(c.interval[f].low, c)),
                        markup_escaped(number_text(c.interval[f].high, c)));
  }
  return html;
}

/// What is met, with the tolerances of 2 % and 10 % in brackets where there is one.
std::string score_row(const std::string& name, const Assessment& a, const std::string& reading, Scoring scoring) {
  const Score s = a.score(reading, scoring);
  std::string html = fmt::format("<tr><td>{}</td><td class=\"n\">{}</td>", name, s.statements);
  for (std::size_t f = 0; f < a.variants; ++f) {
    html += scoring == Scoring::digits
                ? fmt::format("<td class=\"n\"><b>{}</b></td>", s.met[f])
                : fmt::format("<td class=\"n\"><b>{}</b> ({}, {})</td>", s.met[f],
                              a.score(reading, scoring, 0.02).met[f], a.score(reading, scoring, 0.10).met[f]);
  }
  return html + fmt::format("<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
                            s.reproduced, s.depends, s.not_reproduced);
}

std::string variants_head(const Assessment& a) {
  std::string html;
  for (std::size_t f = 0; f < a.variants; ++f) html += fmt::format("<th>{}</th>", variant_name(f));
  return html;
}

/// A calibrated peak lift with the paper's digits.
std::string published_peak(const Assessment& a, bool springs) {
  const std::string wanted = springs ? "peak lift with springs" : "peak lift without springs";
  for (const Claim& c : a.claims) {
    if (c.basis == Basis::calibrated && c.statement.rfind(wanted, 0) == 0) return c.published_text;
  }
  return "-";
}

/// What rod-force misses among the predictions, worst first: statements without a number, then by size of the
/// deviation.
std::vector<const Claim*> missed_by_rod_force(const Assessment& a) {
  std::vector<const Claim*> missed;
  for (const Claim& c : a.claims) {
    if (c.counted() && !c.within[0] && c.reading != readings[0]) missed.push_back(&c);
  }
  const auto size = [](const Claim* c) {
    return std::isfinite(c->deviation[0]) ? std::abs(c->deviation[0]) : INFINITY;
  };
  std::stable_sort(missed.begin(), missed.end(), [&](const Claim* b, const Claim* c) { return size(b) > size(c); });
  return missed;
}

/// What can be said about equation (1), from the values that were not used in the calibration.
std::string equation_1(const Assessment& a) {
  if (a.variants < variant_count) return "";
  const double rod = a.rms_of_predicted_values(0), work = a.rms_of_predicted_values(1),
               own = a.rms_of_predicted_values(recalibrated);
  const auto as_ratio = [&](std::size_t f) { return 100.0 * a.rms_of_predicted_values(f, Scoring::ratios); };
  const MomentCalibration& c = a.calibrations[1];
  std::string html = fmt::format(
      "<p><b>Equation (1).</b> The published values of section 4 that were not used in the calibration "
      "deviate by {:.1f} % (root mean square, changes as printed; {:.1f} % as ratios) with rod-force and by {:.1f} % "
      "({:.1f} %) with virtual-work. That comparison is biased against virtual-work, "
      "because "
      "{} and {} were chosen with rod-force. With chord moments calibrated for virtual-work to the same two peak lifts "
      "({} and {}) the deviation is {:.1f} % ({:.1f} %). ",
      100.0 * rod, as_ratio(0), 100.0 * work, as_ratio(1), s2, s3, scientific(c.s2, 3, "m<sup>4</sup>"),
      scientific(c.s3, 3, "m<sup>5</sup>"), 100.0 * own, as_ratio(recalibrated));
  if (!c.met) {
    html += fmt::format(
        "No pair of chord moments gives virtual-work both published peak lifts, {} and {}; the nearest that it comes "
        "is {} "
        "and {}. ",
        published_peak(a, false), published_peak(a, true), readable(c.lift_peak[0], "N"),
        readable(c.lift_peak[1], "N"));
  }
  html +=
      own > rod
          ? "The chord moments therefore do not explain the difference: the paper's numbers agree with equation "
            "(1) as printed, and not with a formulation that conserves power. "
          : "The chord moments explain the difference, and the numbers do not discriminate between the formulations. ";
  for (const Claim& c7 : a.claims) {
    if (c7.statement.rfind("motor output minus friction", 0) != 0 || c7.within[0] || !c7.within[1]) continue;
    html += fmt::format(
        "One statement contradicts it: motor output minus friction loss equals the aerodynamic power (figure 7b) "
        "only "
        "by virtual-work; by rod-force the ratio is {}.",
        markup_escaped(c7.ours_text[0]));
  }
  return html + "</p>\n";
}

}  // namespace

std::string summary_html(const Material& m) {
  const Assessment& a = m.assessment;
  const Score s = a.score("");
  std::string html = fmt::format(
      "<p>The paper makes {} predictions that can be checked and do not depend on how its section 5 is read. <b>{} of "
      "them "
      "are met within {:g} % by the paper's own formulation</b> (rod-force, its equation (1) as printed), {} by "
      "virtual-work, which conserves power{}. {} are reproduced in both formulations, {} depend on the formulation, {} "
      "are "
      "not reproduced. Section 5 varies the crank and does not say what is held: its predictions are counted for each "
      "reading.</p>\n",
      s.statements, s.met[0], 100.0 * m.file.tolerance, s.met[1],
      a.variants == variant_count
          ? fmt::format(", and {} by virtual-work with chord moments of its own", s.met[recalibrated])
          : "",
      s.reproduced, s.depends, s.not_reproduced);
  html += "<div class=\"wide\"><table><thead><tr><th>predictions met within 5 % (2 %, 10 %)</th><th>number</th>" +
          variants_head(a) + "<th>reproduced</th><th>depend</th><th>not</th></tr></thead><tbody>\n";
  std::vector<std::pair<std::string, std::string>> sections = {{"sections 3 and 4, conclusion", ""}};
  for (const char* reading : readings) {
    if (a.score(reading).statements > 0) sections.emplace_back(fmt::format("section 5, {}", reading), reading);
  }
  constexpr std::pair<Scoring, const char*> ways[] = {{Scoring::printed, "as printed"},
                                                      {Scoring::ratios, "changes as ratios"},
                                                      {Scoring::digits, "within the printed digits"}};
  for (const auto& [name, reading] : sections) {
    for (const auto& [scoring, way] : ways) {
      if (scoring == Scoring::ratios && !reading.empty()) continue;  // section 5 has no changes
      html += score_row(fmt::format("{}: {}", name, way), a, reading, scoring);
    }
  }
  html += "</tbody></table></div>\n";
  const auto number = [&](auto holds) {
    int n = 0;
    for (const Claim& c : a.claims) n += holds(c);
    return n;
  };
  const auto checkable = [](const Claim& c) {
    return c.outcome != StatementOutcome::not_checkable && c.outcome != StatementOutcome::no_published_value;
  };
  html += fmt::format(
      "<p>One tolerance, {:g} % of the published number, holds for every statement; it is this project's, not the "
      "paper's. Changes are assessed as the paper prints them, in per cent: with springs 33.3 % more lift, not 1.333 "
      "times as much, as a factor of 1 means no change. The count by ratios is also given. Within the printed digits "
      "means within half a unit of the last one, or a whole unit where the paper says about. Not counted: {} values "
      "used in the calibration of {} and {}, {} that follow from the paper's tables, {} facts "
      "stated twice or read in another way, {} statements that cannot be checked. All of them are in <a "
      "href=\"#claims\">the table</a>.</p>\n",
      100.0 * m.file.tolerance, number([](const Claim& c) { return c.basis == Basis::calibrated; }), s2, s3,
      number([&](const Claim& c) { return c.basis == Basis::given && checkable(c); }),
      number([&](const Claim& c) { return c.basis == Basis::predicted && c.restates && checkable(c); }),
      number([](const Claim& c) { return c.outcome == StatementOutcome::not_checkable; }));
  html +=
      "<details><summary>What the paper's own formulation does not reproduce, largest deviation first (section 5 with "
      "the stroke held)</summary>\n<div class=\"wide\"><table class=\"claims sortable\"><thead><tr>"
      "<th>statement</th><th>where</th><th>published</th>" +
      variants_head(a) + "</tr></thead><tbody>\n";
  for (const Claim* c : missed_by_rod_force(a)) {
    html += fmt::format("<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td>", markup_escaped(c->statement),
                        markup_escaped(c->where), markup_escaped(c->published_text));
    for (std::size_t f = 0; f < a.variants; ++f) {
      html += fmt::format("<td class=\"{}\">{}</td>", c->within[f] ? "yes" : "no", with_deviation(*c, f));
    }
    html += "</tr>\n";
  }
  html += "</tbody></table></div></details>\n<p><b>Errors of the paper:</b></p>\n<ul>\n";
  for (const Claim& c : a.claims) {
    if (!c.erratum.empty())
      html += fmt::format("<li>{} ({}).</li>\n", markup_escaped(c.erratum), markup_escaped(c.where));
  }
  return html + "</ul>\n" + equation_1(a);
}

std::string parameters_html(const Material& m) {
  const Design<double>& d = m.pair[1];
  const Vehicle<double> v = resolve(d);
  std::string html =
      "<details><summary>Parameters, and where each one stands</summary>\n<div class=\"wide\"><table "
      "class=\"sortable\"><thead><tr><th>parameter</th><th>value</th><th>source</th></tr></thead><tbody>\n";
  const auto row = [&](const char* name, const std::string& value, const char* from) {
    html += fmt::format("<tr><td>{}</td><td class=\"n\">{}</td><td>{}</td></tr>\n", name, value, from);
  };
  row("armature resistance <i>R</i><sub>a</sub>", fmt::format("{:.4g} Ω", v.motor.armature_resistance), "Table 1");
  row("armature inductance <i>L</i><sub>a</sub>", fmt::format("{:.4g} mH", 1e3 * v.motor.armature_inductance),
      "Table 1");
  row("torque constant <i>K</i>", fmt::format("{:.4g} N·m/A", v.motor.torque_constant), "Table 1");
  row("rotor inertia <i>J</i>", scientific(v.motor.inertia, 1, "kg·m²"), "Table 1");
  row("viscous damping <i>b</i>", scientific(v.motor.viscous_damping, 1, "N·m·s/rad"), "Table 1");
  row("crank radius <i>r</i><sub>c</sub>", fmt::format("{:.4g} mm", 1e3 * v.transmission.slider_crank.crank_radius),
      "Table 2");
  row("rod length <i>l</i>", fmt::format("{:.4g} mm", 1e3 * v.transmission.slider_crank.rod_length), "Table 2");
  row("hinge offset <i>H</i>", fmt::format("{:.4g} mm", 1e3 * v.transmission.slider_crank.hinge_offset), "Table 2");
  row("inertia of one wing <i>J</i><sub>w</sub>", scientific(v.wing_inertia, 3, "kg·m²"),
      "Table 2, read as each wing's: with half of it the published effect of the springs is missed");
  row("stiffness of one hinge spring <i>k</i>", scientific(v.spring.stiffness, 3, "N·m/rad"),
      "section 4, where it is printed in N/m");
  row("friction radius <i>μ r</i><sub>e</sub>", fmt::format("{:.4g} mm", 1e3 * v.friction.radius), "Table 2");
  row("pitch coefficient <i>C</i><sub>α</sub>", fmt::format("{:.4g} ms", 1e3 * v.wings.pitch_coefficient), "Table 2");
  row("mass", fmt::format("{:.4g} g", 1e3 * total_mass(d).value_or(absent)), "section 5");
  row(fmt::format("chord moment {}", s2).c_str(), scientific(v.wings.s2, 3, "m<sup>4</sup>"),
      "calibrated, not published");
  row(fmt::format("chord moment {}", s3).c_str(), scientific(v.wings.s3, 3, "m<sup>5</sup>"),
      "calibrated, not published");
  html += "</tbody></table></div></details>\n";
  if (m.assessment.calibrations.empty()) return html;
  html += fmt::format(
      "<p><b>Calibration.</b> The planform of the wings is not available numerically; {0} and {1} are all that the "
      "model "
      "needs of it. The motion depends on {1} alone and lift is proportional to {0}: two published peak lifts at 22 Hz "
      "determine both, {1} by their ratio and {0} by their size. Computed here from these two values alone:</p>\n"
      "<div class=\"wide\"><table><thead><tr><th></th><th>{0}</th><th>{1}</th><th>peak lift without springs</th>"
      "<th>with springs</th></tr></thead><tbody>\n",
      s2, s3);
  const MomentCalibration& first = m.assessment.calibrations[0];
  html += fmt::format(
      "<tr><td>published</td><td></td><td></td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n"
      "<tr><td>vehicle file (used throughout, with rod-force)</td><td class=\"n\">{}</td><td class=\"n\">{}</td>",
      published_peak(m.assessment, false), published_peak(m.assessment, true),
      scientific(v.wings.s2, 3, "m<sup>4</sup>"), scientific(v.wings.s3, 3, "m<sup>5</sup>"));
  for (const bool springs : {false, true}) {
    const CycleCase* c = cycle_of(m.computed.at_frequency, Formulation::rod_force, springs);
    html += fmt::format("<td class=\"n\">{}</td>", readable(c ? c->run.metrics[Metric::lift_peak] : absent, "N"));
  }
  html += "</tr>\n";
  for (const MomentCalibration& c : m.assessment.calibrations) {
    html += fmt::format(
        "<tr><td>computed for {}{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
        "<td class=\"n\">{}</td></tr>\n",
        wingbeat::name_of(c.formulation), c.met ? "" : " (no exact solution: nearest to both)",
        scientific(c.s2, 3, "m<sup>4</sup>"), scientific(c.s3, 3, "m<sup>5</sup>"), readable(c.lift_peak[0], "N"),
        readable(c.lift_peak[1], "N"));
  }
  html += fmt::format(
      "</tbody></table></div>\n<p>The vehicle file agrees with the result for rod-force within {:.1f} % ({}) and "
      "{:.1f} % "
      "({}). The two frequencies at 3 V were used in the calibration as well. These four values are "
      "therefore not counted as predictions.</p>\n",
      100.0 * std::abs(v.wings.s2 / first.s2 - 1.0), s2, 100.0 * std::abs(v.wings.s3 / first.s3 - 1.0), s3);
  return html;
}

std::string readings_html(const Material& m) {
  const Assessment& a = m.assessment;
  const Score hinge = a.score(readings[0]), stroke = a.score(readings[1]);
  if (hinge.statements == 0 || stroke.statements == 0) return "";
  std::string html = fmt::format(
      "<p>Section 5 of the paper varies the crank radius and does not say whether the hinge offset is held, so that "
      "the "
      "stroke grows with the crank, or the stroke. Every statement is computed in both readings:</p>\n<div "
      "class=\"wide\"><table><thead><tr><th>statement</th><th>published</th><th>rod-force, {0}</th><th>rod-force, "
      "{1}</th><th>virtual-work, {0}</th><th>virtual-work, {1}</th></tr></thead><tbody>\n",
      readings[0], readings[1]);
  for (const Claim& c : a.claims) {
    if (c.reading != readings[0]) continue;
    const std::string what = c.statement.substr(0, c.statement.rfind(", "));
    const Claim* other = nullptr;
    for (const Claim& d : a.claims) {
      if (d.reading == readings[1] && d.statement.rfind(what + ", ", 0) == 0) other = &d;
    }
    if (!other) continue;
    html +=
        fmt::format("<tr><td>{}</td><td class=\"n\">{}</td>", markup_escaped(what), markup_escaped(c.published_text));
    for (std::size_t f = 0; f < 2; ++f) {
      for (const Claim* side : {&c, other}) {
        html += fmt::format("<td class=\"{}\">{}</td>", side->within[f] ? "yes" : "no", with_deviation(*side, f));
      }
    }
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
  const bool by_radii = stroke.rms_crank_radius<hinge.rms_crank_radius, by_count = stroke.met[0]> hinge.met[0];
  html += fmt::format(
      "<p><b>Which reading?</b> By rod-force the crank radii deviate by {:.0f} % (root mean square) with the hinge "
      "offset "
      "held and by {:.0f} % with the stroke held; {} and {} of {} predictions are met. {} The limit of the domain on "
      "the "
      "formulation residual (5 % of the input) is not applied here, since equation (1) itself is assessed; results "
      "beyond it say so, and the other limits of the domain are kept.</p>\n",
      100.0 * hinge.rms_crank_radius, 100.0 * stroke.rms_crank_radius, hinge.met[0], stroke.met[0], stroke.statements,
      by_radii && by_count     ? "<b>The numbers support the stroke held</b>, which figure 22 is drawn with first."
      : !by_radii && !by_count ? "<b>The numbers support the hinge offset held.</b>"
                               : "The numbers do not decide.");
  const double weight = total_mass(m.pair[0]).value_or(absent) * standard_gravity;
  html += fmt::format(
      "<p><b>Does it hover at 5 V?</b> {:.2f} mN are needed. Maximum mean lift with the best crank between 3 and 14 "
      "mm:</p>\n<ul>\n",
      1e3 * weight);
  for (std::size_t f = 0; f < 2; ++f) {
    html += fmt::format("<li>{}:", variant_name(f));
    const char* separator = " ";
    for (const Claim& c : a.claims) {
      if (c.unit != "N" || c.reading.empty() || c.statement.find("at 5 V") == std::string::npos) continue;
      if (c.statement.find("maximum") == std::string::npos) continue;
      const bool springs = c.statement.find("with springs") != std::string::npos;
      html += fmt::format("{}{} springs, {}: <b>{}</b>, {} of the weight, {}", separator, springs ? "with" : "without",
                          c.reading,
                          c.ours[f] < weight ? "no"
                          : c.outside[f]     ? "only outside the domain"
                                             : "yes",
                          fmt::format("{:.2f}", c.ours[f] / weight), markup_escaped(c.ours_text[f]));
      separator = "; ";
    }
    html += ".</li>\n";
  }
  return html + "</ul>\n";
}

std::string claims_html(const Assessment& a) {
  std::string html =
      fmt::format("<details><summary>All {} statements, a column for each formulation</summary>\n", a.claims.size()) +
      "<div class=\"wide\"><table class=\"claims sortable\"><thead><tr><th>statement</th><th>where</th>"
      "<th>published</th>" +
      variants_head(a) + "<th>outcome</th></tr></thead><tbody>\n";
  for (const ClaimGroup& group : claim_groups()) {
    bool first = true;
    for (const Claim& c : a.claims) {
      if (!group.holds(c)) continue;
      if (first)
        html += fmt::format("<tr><th class=\"group\" colspan=\"{}\">{}</th></tr>\n", 4 + a.variants, group.name);
      first = false;
      html += fmt::format("<tr><td>{}", markup_escaped(c.statement));
      const std::string window = c.window.empty() ? "" : fmt::format("Searched in {}.", c.window);
      for (const std::string* said : {&window, &c.note, &c.reason}) {
        if (!said->empty()) html += fmt::format("<br><span class=\"files\">{}</span>", markup_escaped(*said));
      }
      if (!c.erratum.empty()) {
        html += fmt::format("<br><span class=\"erratum\">Error of the paper: {}.</span>", markup_escaped(c.erratum));
      }
      html += fmt::format("</td><td>{}</td><td>{}</td>", markup_escaped(c.where), markup_escaped(c.published_text));
      for (std::size_t f = 0; f < a.variants; ++f) html += fmt::format("<td>{}</td>", with_deviation(c, f));
      html += fmt::format("<td class=\"{}\">{}</td></tr>\n", class_of(c.outcome), outcome_text(c));
    }
  }
  return html + "</tbody></table></div></details>\n";
}

}  // namespace wingbeat::reproduction

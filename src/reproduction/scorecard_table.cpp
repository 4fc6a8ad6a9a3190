// Of the report: the scorecard as a table, and what its intervals are made of.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reproduction/html.hpp"
#include "reproduction/statement_order.hpp"
#include "wingbeat/files/design_parameter.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr double strip_bands = 5.0;  ///< tolerances to either side of the strip

/// A place on the strip in per cent of its width.
double place(double deviation, double tolerance) {
  return 50.0 + 50.0 * std::clamp(deviation / tolerance / strip_bands, -1.0, 1.0);
}

/// Deviations on a strip whose shaded middle is the tolerance: a disc for rod-force, a square for virtual-work, bars
/// for their intervals.
std::string strip(const Claim& c) {
  if (!std::isfinite(c.tolerance)) return "";
  std::string html = "<span class=\"strip\">";
  for (std::size_t f = 0; f < 2; ++f) {
    if (!std::isfinite(c.deviation[f])) continue;
    const char* kind = f == 0 ? "rod" : "work";
    if (std::isfinite(c.interval[f].low)) {
      double a = place(c.interval[f].low / *c.published - 1.0, c.tolerance);
      double b = place(c.interval[f].high / *c.published - 1.0, c.tolerance);
      if (a > b) std::swap(a, b);
      html += fmt::format("<i class=\"span {}\" style=\"left:{:.1f}%;width:{:.1f}%\"></i>", kind, a, b - a);
    }
    const bool beyond = std::abs(c.deviation[f] / c.tolerance) > strip_bands;
    html += fmt::format("<i class=\"dot {}{}{}\" style=\"left:{:.1f}%\"></i>", kind,
                        c.basis == Basis::calibrated ? " hollow" : "", beyond ? " beyond" : "",
                        place(c.deviation[f], c.tolerance));
  }
  return html + "</span>";
}

/// By which the strips are sorted; -1 without one.
double largest_deviation(const Claim& c) {
  double largest = -1.0;
  for (const double d : c.deviation) largest = std::isfinite(d) ? std::max(largest, std::abs(d)) : largest;
  return largest;
}

std::string cell(const Claim& c, std::size_t f) {
  const std::string off = percent_text(c.deviation[f]);
  std::string html = fmt::format("<td class=\"{}\" data-label=\"{}\">", c.within[f] ? "yes" : "no", variant_name(f));
  const bool range = c.published_text.find(" to ") != std::string::npos;
  if (!std::isfinite(c.ours[f])) html += markup_escaped(c.ours_text[f]);
  else if (range) html += markup_escaped(c.ours_text[f].substr(0, c.ours_text[f].find(" (")));
  else html += markup_escaped(number_text(c.ours[f], c));
  if (std::isfinite(c.interval[f].low)) {
    html += fmt::format(" <span class=\"files\">[{} to {}]</span>", markup_escaped(number_text(c.interval[f].low, c)),
                        markup_escaped(number_text(c.interval[f].high, c)));
  }
  if (!off.empty()) html += fmt::format(" <b>{}</b>", off);
  if (c.outside[f]) html += " ‡";
  return html + "</td>";
}

}  // namespace

std::string scorecard_html(const Assessment& a) {
  std::string html =
      "<div class=\"scorecard\"><div class=\"filter\" hidden><label>Show <select><option value=\"\">all "
      "statements</option><option value=\"0\">reproduced in neither formulation</option><option value=\"1\">in one"
      "</option><option value=\"2\">in both</option></select></label><label>with the words <input type=\"search\">"
      "</label><span role=\"status\"></span></div>\n<table class=\"sortable\"><thead><tr><th>statement</th>"
      "<th>published</th><th>rod-force</th>"
      "<th>virtual-work</th><th>deviation</th></tr></thead><tbody>\n";
  for (const ClaimGroup& group : claim_groups()) {
    const std::vector<const Claim*> claims = worst_first(a, group);
    if (claims.empty()) continue;
    html += fmt::format("<tr><th class=\"group\" colspan=\"5\">{}</th></tr>\n", group.heading);
    for (const Claim* c : claims) {
      html += fmt::format(
          "<tr><td>{}</td><td data-label=\"published\">{}</td>{}{}"
          "<td data-value=\"{:.4f}\">{}</td></tr>\n",
          markup_escaped(short_statement(*c, group.heading)), markup_escaped(c->published_text), cell(*c, 0),
          cell(*c, 1), largest_deviation(*c), strip(*c));
    }
  }
  return with_minus_signs(html + "</tbody></table></div>\n");
}

std::string uncertainty_html(const Material& m) {
  if (m.assessment.samples == 0) return "";
  std::string html = fmt::format(
      "<h3 id=\"uncertainty\">How sure are the computed numbers?</h3>\n<p>The paper states no interval of any "
      "parameter. The relative standard deviations below are assumptions of this project, with normal distributions "
      "that are independent of each other; intervals hold the middle 95 % of {} samples (scrambled Sobol, as "
      "<code>wingbeat tolerance</code> draws them), the same samples for both vehicles of a change. The chord moments "
      "stay as calibrated.</p>\n<p>A number that is searched for - an optimum, a crossing, a range, a largest lift, "
      "the "
      "drag of the rival without friction - has an interval by propagation of the same deviations: the search is "
      "solved "
      "anew with each parameter one standard deviation to either side, {} searches in all; half of each difference is "
      "the contribution of a parameter, contributions add in squares, and the interval is 1.96 times the root of "
      "that sum to "
      "either side. Such an interval is symmetric. There is none where the number lies at an edge of the domain, or "
      "its "
      "place at an end of the window.</p>\n"
      "<div class=\"wide\"><table><thead><tr><th>parameter</th><th>standard deviation</th><th>why</th></tr></thead>"
      "<tbody>\n",
      m.assessment.samples, 2 * m.file.uncertain.size());
  for (const UncertainPublished& u : m.file.uncertain) {
    html += fmt::format("<tr><td><code>{}</code></td><td class=\"n\">{:g} %</td><td>{}</td></tr>\n", u.key,
                        100.0 * u.relative_deviation, markup_escaped(u.why));
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace wingbeat::reproduction

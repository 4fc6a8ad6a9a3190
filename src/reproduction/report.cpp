// report.html: everything in one file that needs no network, and no script to be read.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "report/page_colours.hpp"
#include "reproduction/html.hpp"

namespace wingbeat::reproduction {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t position = 0; (position = text.find(from, position)) != std::string::npos; position += to.size())
    text.replace(position, from.size(), to);
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
  // Named for screen readers; a title would also be a tooltip over the read-out.
  const auto open = svg.find("<svg ");
  if (open != std::string::npos)
    svg.insert(open + 5, fmt::format("role=\"img\" aria-label=\"{}\" ", markup_escaped(title)));
  use_page_colours(svg);
  return svg;
}

constexpr const char* table_instead = "scorecard";  ///< its figure, which the page shows as a table

/// Links to a figure's files beside the report.
std::string links(const std::string& id) {
  std::string text;
  for (const char* extension : {"svg", "pdf", "csv", "nc"}) {
    text += fmt::format("{}<a href=\"{}.{}\">{}</a>", text.empty() ? "" : " ", id, extension, extension);
  }
  return text;
}

}  // namespace

std::string report_html(const Material& m, const std::vector<Sheet>& sheets, const std::string& version,
                        const std::function<std::string(const Sheet&)>& svg_of) {
  const Assessment& a = m.assessment;
  std::string html;
  auto out = std::back_inserter(html);
  const auto figures = [&](const std::string& section) {
    html += "<div class=\"figures\">\n";
    for (const Sheet& s : sheets) {
      if (s.section != section || s.id == table_instead) continue;
      const bool one_formulation = s.id.find("virtual-work") != std::string::npos;
      fmt::format_to(out,
                     "<figure id=\"{0}\"{5}{6}><div class=\"drawing\">{1}</div><figcaption><b>{2}</b> {3} <span "
                     "class=\"files\">Files: {4}</span></figcaption></figure>\n",
                     s.id, inlined(svg_of(s), s.id + "-drawing", s.heading), markup_escaped(s.heading),
                     markup_escaped(s.caption), links(s.id), s.wide ? " class=\"page\"" : "",
                     one_formulation ? " data-formulation=\"virtual-work\"" : "");
      if (!s.animation.empty()) {
        fmt::format_to(out,
                       "<figure class=\"moving\"><div class=\"drawing\">{0}</div><figcaption><b>Animation.</b> "
                       "One computed cycle, repeated: the crank speed "
                       "is not constant. "
                       "<span class=\"files\">File: <a href=\"{1}-moving.svg\">svg</a></span></figcaption></figure>\n",
                       inlined(s.animation, s.id + "-moving", s.heading), s.id);
      }
    }
    html += "</div>\n";
  };
  const std::pair<const char*, const char*> sections[] = {{"summary", "The answer"},
                                                          {"question", "Should friction losses be included?"},
                                                          {"further", "What more physics does to the conclusions"},
                                                          {"vehicle", "The vehicle"},
                                                          {"conditions", "Air, vacuum, no wings (figures 4 to 7)"},
                                                          {"springs", "With and without springs (figures 9 to 13)"},
                                                          {"cycles", "Over a cycle (figures 14 to 19)"},
                                                          {"section5", "Section 5 in two readings (figures 20 to 22)"},
                                                          {"energy", "Where the energy goes"},
                                                          {"claims", "Reproducibility assessment: every statement"},
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
      "<h1>The 2022 friction paper: a reproducibility assessment</h1>\n<p class=\"lead\">{}. Made by wingbeat {} with "
      "<code>wingbeat reproduce friction2022</code>{}. Every number carries its domain status: one that is outside the "
      "model's domain of validity says so or has the mark ‡, all others are inside.</p>\n</header>\n<nav><ol>\n",
      page_style(), markup_escaped(m.file.source), version, m.computed.options.coarse ? ", coarse setting" : "");
  for (const auto& [id, name] : sections) fmt::format_to(out, "<li><a href=\"#{}\">{}</a></li>\n", id, name);
  html +=
      "</ol></nav>\n<div class=\"tools\" hidden>Formulation in figures: <button value=\"\" aria-pressed=\"true\">both"
      "</button><button value=\"rod-force\" aria-pressed=\"false\">rod-force</button><button "
      "value=\"virtual-work\" aria-pressed=\"false\">virtual-work</button></div>\n<main>\n";

  begin("summary");
  html += answer_html(m);
  figures("summary");
  html += summary_html(m);
  fmt::format_to(
      out,
      "<h3 id=\"{0}\">Scorecard</h3>\n<p>Every statement that can be checked; within a group those that are not "
      "reproduced come first. In square brackets intervals of 95 % (<a href=\"#uncertainty\">how</a>), in bold the "
      "deviation. On the strip the shaded "
      "middle is the tolerance of {1:g} %, either end {2:g} % or more; discs are rod-force, squares virtual-work, bars "
      "their intervals; hollow ones were used in the calibration. ‡ outside the domain; without the mark inside. "
      "<span class=\"files\">As a figure: {3}</span></p>\n",
      table_instead, 100.0 * m.file.tolerance, 500.0 * m.file.tolerance, links(table_instead));
  html += scorecard_html(a);
  html += uncertainty_html(m);
  end();
  begin("question");
  html += question_html(m);
  figures("question");
  end();
  begin("further");
  html += further_html(m);
  figures("further");
  end();
  begin("vehicle");
  html +=
      "<p>A geared DC motor turns a crank; a rod moves a slider up and down its guide; the slider swings two wings "
      "about fixed hinges. Springs in the hinges, where fitted, store energy at the ends of the stroke.</p>\n" +
      parameters_html(m);
  figures("vehicle");
  end();
  begin("conditions");
  html +=
      "<p>The frequency is held by the voltage. Solid curves are rod-force, the paper's formulation; dashed curves of "
      "the same colour are virtual-work. Without springs.</p>\n";
  figures("conditions");
  end();
  begin("springs");
  html +=
      "<p>In air, at prescribed frequency. Springs raise the input power where they are too stiff for the frequency, "
      "and lower it near resonance.</p>\n";
  figures("springs");
  end();
  begin("cycles");
  fmt::format_to(
      out,
      "<p>Time counts from stroke reversal, the least stroke angle of each cycle; the data begin at crank angle zero, "
      "the slider in mid-stroke and rising. First at the same frequency, "
      "{:g} Hz, which the springs reach at a lower voltage; then at the same voltage, {:g} V, at which the vehicle "
      "with springs flaps faster.</p>\n",
      m.computed.options.frequency, m.computed.options.voltage);
  figures("cycles");
  end();
  begin("section5");
  html += readings_html(m);
  figures("section5");
  end();
  begin("energy");
  html +=
      "<p>What the supply delivers over a cycle leaves as copper loss, motor viscous loss, friction and aerodynamic "
      "power - and, with the paper's equation (1) as printed, as a formulation residual that no part of the vehicle "
      "receives. The sums close to the solver's accuracy.</p>\n";
  figures("energy");
  end();
  begin("claims");
  fmt::format_to(
      out,
      "<p>The deviation is computed over published minus 1, of changes as the paper prints them. A number is met "
      "within {:g} %, the same for every statement; a bound (\"below\", \"above\") where it holds. ● met in both "
      "formulations, ◐ in one, ○ in "
      "neither; the outcome compares rod-force and virtual-work with the same chord moments, the third column "
      "has those calibrated for virtual-work. Also as <a href=\"claims.csv\">claims.csv</a> and <a "
      "href=\"claims.json\">claims.json</a>.</p>\n",
      100.0 * m.file.tolerance);
  html += claims_html(a);
  end();
  begin("how");
  html +=
      R"(<p>Each result: the steady cycle is a periodic orbit in crank angle, found to a relative tolerance of 1e-7 or
better; peaks and crossings of the table are searched for on the orbits themselves, not read off the curves,
so that they do not depend on the number of points drawn. The commands below run in a checkout, where
<code>scripts/test</code> or <code>scripts/demo</code> has built the program.</p>
<h3>This report</h3>
<pre>build/release/wingbeat reproduce friction2022 -o out/friction2022</pre>
<h3>One point of figures 4 to 13</h3>
<pre>build/release/wingbeat run data/designs/friction2022.toml --frequency "22 Hz" --condition vacuum
build/release/wingbeat run data/designs/friction2022-springs.toml --frequency "22 Hz"
build/release/wingbeat run data/designs/friction2022.toml --frequency "22 Hz" )"
      R"(--set transmission.formulation=virtual-work</pre>
<h3>The cycles of figures 14 to 19</h3>
<pre>build/release/wingbeat run data/designs/friction2022-springs.toml --frequency "22 Hz" --waveforms cycle.csv
build/release/wingbeat run data/designs/friction2022-springs.toml --voltage "3 V" --plot cycle.svg</pre>
<h3>The curves of figures 20 to 22, as data sets of their own</h3>
<pre>build/release/wingbeat sweep data/studies/trend-crank-fixed-hinge.toml -o crank.nc
build/release/wingbeat sweep data/studies/trend-rod.toml -o rod.nc
build/release/wingbeat sweep data/studies/trend-voltage.toml -o voltage.nc</pre>
<h3>The published values alone</h3>
<pre>build/release/wingbeat compare data/published/friction2022.toml</pre>
<h3>More physics</h3>
<pre>build/release/wingbeat run data/designs/friction2022-springs.toml --voltage "3 V" --set motor.gear_efficiency=0.8
build/release/wingbeat run data/designs/friction2022-springs.toml --voltage "5 V" )"
      R"(--set motor.thermal_resistance_winding="20 K/W" --set motor.thermal_resistance_case="48 K/W"</pre>
<h3>The intervals of the answer</h3>
<pre>build/release/wingbeat tolerance data/studies/tolerance-friction2022.toml
build/release/wingbeat tolerance data/studies/tolerance-friction2022.toml )"
      R"(--set transmission.formulation=virtual-work</pre>
<h3>A friction law</h3>
<pre>build/release/wingbeat run data/designs/friction2022-springs.toml --frequency "22 Hz" )"
      R"(--set friction.type=constant )";
  const LawPrediction* constant = law_of(a, load_proportional_rival - 1, 0);
  fmt::format_to(out, "--set friction.torque=\"{:.6g} N m\"</pre>\n", constant ? constant->law.coefficient : 7e-4);
  html +=
      "<p>Published values, the tolerance and where they stand: <code>data/published/friction2022.toml</code>. The "
      "vehicles: "
      "<code>data/designs/friction2022.toml</code> and <code>friction2022-springs.toml</code>. Both are carried in the "
      "program itself.</p>\n";
  end();
  html += fmt::format("</main>\n<script>{}</script>\n</body></html>\n", page_script());
  return html;
}

}  // namespace wingbeat::reproduction

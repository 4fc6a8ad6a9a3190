// The first page in figures: every statement against the tolerance, and the friction laws.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reproduction/dot_plot.hpp"
#include "reproduction/statement_order.hpp"
#include "reproduction/trend_figure.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat::reproduction {
namespace {

constexpr double drawn_bands = 5.0;  ///< deviations beyond are arrowheads at the edge

/// "+5.9, -19.0 %", or whether it holds where there is no number to deviate from.
std::string deviations(const Claim& c) {
  if (!std::isfinite(c.deviation[0]) && !std::isfinite(c.deviation[1])) {
    return fmt::format("{}, {}", c.within[0] ? "holds" : "fails", c.within[1] ? "holds" : "fails");
  }
  const auto number = [&](std::size_t f) {
    return std::isfinite(c.deviation[f])
               ? std::abs(c.deviation[f]) < 5e-4 ? std::string("0.0") : fmt::format("{:+.1f}", 100.0 * c.deviation[f])
           : c.within[f] ? std::string("holds")
                         : std::string("fails");
  };
  return fmt::format("{}, {} %", number(0), number(1));
}

int failures_first(const Claim& c) {
  switch (c.outcome) {
    case StatementOutcome::not_reproduced: return 0;
    case StatementOutcome::depends_on_formulation: return 1;
    default: return 2;
  }
}

Sheet scorecard(const Material& m) {
  Sheet s;
  s.id = "scorecard";
  s.heading = "Scorecard: deviation of every statement";
  s.section = "summary";
  s.wide = true;
  s.caption = fmt::format(
      "Deviation in units of the tolerance, {:g} % of the published number; the band is what counts as met. Within a "
      "group, statements that are not reproduced come first, then those that depend on the formulation, each by the "
      "larger deviation. Hollow: used in the calibration. An arrowhead at the edge: the deviation is larger. The "
      "numbers are the deviations by rod-force and by virtual-work; a statement without a number holds or fails.",
      100.0 * m.file.tolerance);
  DotPlot plot;
  plot.width = style::double_column;
  plot.label_width = 3.95;
  plot.note_width = 1.15;
  plot.note_title = "rod-force, virtual-work";
  plot.calibrated = true;
  plot.panels = {{"", "deviation / tolerance", -drawn_bands, drawn_bands, 1.0, 1.0}};
  std::vector<double> row_number, columns[2];
  for (const ClaimGroup& group : claim_groups()) {
    const std::vector<const Claim*> claims = worst_first(m.assessment, group);
    if (claims.empty()) continue;
    plot.rows.push_back({.label = group.heading, .heading = true});
    for (const Claim* c : claims) {
      DotRow row{.label = short_statement(*c, group.heading), .note = deviations(*c)};
      row.dots.emplace_back();
      const double unit = std::isfinite(c->tolerance) && c->tolerance > 0.0 ? c->tolerance : m.file.tolerance;
      for (std::size_t f = 0; f < 2; ++f) {
        const double x = c->deviation[f] / unit;
        if (std::isfinite(x)) row.dots[0].push_back({x, f, c->basis == Basis::calibrated});
        columns[f].push_back(x);
      }
      row_number.push_back(double(row_number.size()));
      plot.rows.push_back(std::move(row));
    }
  }
  s.table.add("row", "1", "statement, counted from above", row_number);
  s.table.add("deviation_over_tolerance_rod_force", "1", "deviation over tolerance, rod-force", columns[0]);
  s.table.add("deviation_over_tolerance_virtual_work", "1", "deviation over tolerance, virtual-work", columns[1]);
  s.draw = [plot](PlotFormat format, const std::filesystem::path& file) { reproduction::draw(plot, format, file); };
  return s;
}

Sheet laws_sheet(const Material& m) {
  Sheet s;
  s.id = "friction-law-deviations";
  s.heading = "Which friction law predicts the vehicle with springs";
  s.section = "summary";
  const LawPrediction& first = m.assessment.laws.front();
  s.caption = fmt::format(
      "Each model has one number, calibrated without springs: the coefficient of its friction, or a factor on the "
      "drag. "
      "(a) Root mean square of its deviations from the {} published values with springs that were not used in a "
      "calibration, changes as the paper prints them. (b) By how much springs then cut the electrical input at {:g} "
      "Hz. Without friction rod-force is outside the domain.",
      first.tests.size(), m.computed.options.frequency);
  DotPlot plot;
  plot.label_width = 1.05;
  plot.row_height = 0.18;
  plot.note_width = 0.05;
  plot.variants = 2;
  plot.panels = {{"deviation", "root mean square (%)", 0.0, 100.0, 25.0},
                 {"saved by springs", "of the input (%)", -10.0, 25.0, 10.0}};
  std::vector<double> law_number, rms[2], saved[2];
  for (std::size_t n = 0; n < std::size(rivals); ++n) {
    DotRow row{rivals[n].name};
    row.dots.resize(2);
    for (const LawPrediction& p : m.assessment.laws) {
      if (p.rival != n || p.variant == recalibrated) continue;
      const char* colour = n == load_proportional_rival ? style::friction : style::grey;
      row.dots[0].push_back({100.0 * p.rms, p.variant, false, colour});
      rms[p.variant].push_back(p.rms);
      double share = absent;
      for (const ComparedValue& c : p.comparison.values) {
        if (c.published.metric != Metric::power_electrical || !c.published.change || !c.published.frequency) continue;
        share = -c.computed;
        if (plot.panels[1].references.empty()) {
          plot.panels[1].references.emplace_back(-100.0 * c.published.published, "published");
        }
      }
      row.dots[1].push_back({100.0 * share, p.variant, false, colour});
      saved[p.variant].push_back(share);
    }
    law_number.push_back(double(law_number.size()));
    plot.rows.push_back(std::move(row));
  }
  s.table.add("law", "1", "none, none with more drag, viscous, quadratic, constant, load-proportional", law_number);
  for (std::size_t f = 0; f < 2; ++f) {
    const std::string tag = f == 0 ? "rod_force" : "virtual_work";
    s.table.add("rms_deviation_" + tag, "1", fmt::format("root mean square deviation, {}", variant_name(f)), rms[f]);
    s.table.add("input_saved_" + tag, "1", fmt::format("input saved by springs, {}", variant_name(f)), saved[f]);
  }
  s.draw = [plot](PlotFormat format, const std::filesystem::path& file) { reproduction::draw(plot, format, file); };
  return s;
}

}  // namespace

std::string short_statement(const Claim& c, const std::string& heading) {
  std::string text = c.statement;
  const auto replace = [&](const std::string& from, const std::string& to) {
    if (const auto position = text.find(from); position != std::string::npos) text.replace(position, from.size(), to);
  };
  if (!c.reading.empty() && heading.find(c.reading) != std::string::npos) replace(", " + c.reading, "");
  replace("peak magnitude of the rod force", "peak rod force");
  replace("peak of the rod force (crank reaction force)", "peak rod force");
  replace("mean magnitude of the rod force", "mean rod force");
  replace("at this flapping frequency", "at this frequency");
  replace("flapping frequency", "frequency");
  replace("at 3 V no design carries the weight", "at 3 V below the weight");
  replace("at 5 V no crank without springs carries the weight", "at 5 V without springs below the weight");
  replace("motor output minus friction loss equals the aerodynamic power: their ratio",
          "(motor output - friction loss) / aerodynamic power");
  return text;
}

std::vector<const Claim*> worst_first(const Assessment& a, const ClaimGroup& group) {
  std::vector<const Claim*> claims;
  for (const Claim& c : a.claims) {
    if (group.holds(c) && c.outcome != StatementOutcome::not_checkable) claims.push_back(&c);
  }
  const auto worst = [](const Claim* c) {
    double max_deviation = 0.0;
    for (std::size_t f = 0; f < 2; ++f) {
      max_deviation = std::max(max_deviation, std::isfinite(c->deviation[f]) ? std::abs(c->deviation[f])
                                              : c->within[f]                 ? 0.0
                                                                             : 10.0);
    }
    return max_deviation;
  };
  std::stable_sort(claims.begin(), claims.end(), [&](const Claim* p, const Claim* q) {
    const int first = failures_first(*p), second = failures_first(*q);
    return first != second ? first < second : worst(p) > worst(q);
  });
  return claims;
}

std::vector<Sheet> summary_sheets(const Material& m) {
  std::vector<Sheet> sheets;
  if (!m.assessment.laws.empty()) sheets.push_back(laws_sheet(m));
  sheets.push_back(scorecard(m));
  return sheets;
}

}  // namespace wingbeat::reproduction

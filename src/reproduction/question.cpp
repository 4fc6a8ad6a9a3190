// The title question in figures: how the loss of each friction law depends on the force in the mechanism.
#include <fmt/format.h>

#include <cmath>

#include "reproduction/sheet.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/report/report.hpp"
#include "wingbeat/study/bench_fit.hpp"

namespace wingbeat::reproduction {
namespace {

// Rivals in grey, distinguished by dash, more drag in the colour of air; load-proportional friction in that of
// friction.
constexpr CurveStyle law_styles[] = {{style::outside_domain, style::solid}, {style::aerodynamic, style::dashed},
                                     {style::grey, style::dashed},          {style::grey, style::dotted},
                                     {style::grey, style::dash_dotted},     {style::friction, style::solid}};

}  // namespace

std::vector<Sheet> friction_sheets(const Material& m) {
  std::vector<Sheet> sheets;
  if (m.assessment.laws.empty() || m.assessment.laws.front().loss.stiffness.empty()) return sheets;
  Sheet s;
  s.id = "friction-laws";
  s.heading = fmt::format("Friction loss and input power as springs are added, {:g} Hz", m.computed.options.frequency);
  s.section = "question";
  Chart chart;
  chart.x = "spring stiffness / stiffness for resonance";
  chart.panel_height = 1.5;
  ChartPanel force, loss, input;
  force.y = "mean |F| (mN)";
  force.title = "mean magnitude of the rod force";
  loss.y = "power (mW)";
  loss.title = "friction loss";
  input.y = "power (mW)";
  input.title = "electrical input";
  for (std::size_t n = 0; n < m.assessment.laws.size(); ++n) {
    const LawPrediction& p = m.assessment.laws[n];
    if (p.variant == recalibrated) continue;
    const CurveStyle style = law_styles[p.rival];
    const std::string name = rivals[p.rival].name;
    const bool first = p.law.formulation == Formulation::rod_force;
    std::vector<double> x, f, l, e, f_si, l_si, e_si;
    const double whole = p.loss.stiffness.back() / 1.5;
    for (std::size_t k = 0; k < p.loss.stiffness.size(); ++k) {
      const Metrics<double>& metrics = p.loss.metrics[k];
      x.push_back(p.loss.stiffness[k] / whole);
      f_si.push_back(metrics[Metric::rod_force_mean]);
      l_si.push_back(metrics[Metric::power_friction]);
      e_si.push_back(metrics[Metric::power_electrical]);
      f.push_back(1e3 * f_si.back());
      l.push_back(1e3 * l_si.back());
      e.push_back(1e3 * e_si.back());
    }
    if (s.table.columns.empty()) {
      s.table.add("spring_stiffness_nm_per_rad", "N m/rad", "stiffness of each hinge spring", p.loss.stiffness);
    }
    const std::string which =
        fmt::format("{}_{}", rivals[p.rival].own_drag ? "none_more_drag" : detail::underscored(name_of(p.law.law)),
                    detail::underscored(wingbeat::name_of(p.law.formulation)));
    const std::string words = fmt::format("friction {}, {}", name, wingbeat::name_of(p.law.formulation));
    s.table.add("rod_force_mean_n_" + which, "N", "mean magnitude of the rod force, " + words, f_si);
    s.table.add("power_friction_w_" + which, "W", "mean friction loss, " + words, l_si);
    s.table.add("power_electrical_w_" + which, "W", "mean electrical input power, " + words, e_si);
    if (!first) continue;
    chart.key.push_back({name, style});
    force.curves.push_back({x, f, style, name});
    loss.curves.push_back({x, l, style, name});
    input.curves.push_back({x, e, style, name});
    if (p.rival != load_proportional_rival) continue;
    for (const Claim& c : m.assessment.claims) {
      if (c.statement.rfind("mean electrical input power, change", 0) != 0 || !c.published) continue;
      input.marks.push_back({1.0, e.front() * (1.0 + *c.published),
                             fmt::format("published: {}, {}", c.statement, c.published_text), style::with_springs});
    }
  }
  chart.panels = {force, loss, input};
  s.caption =
      "Each model was calibrated to the same operating point without springs, one without friction by more drag "
      "(rod-force, without friction outside the domain; virtual-work in the data). "
      "Springs reduce the mean rod force at prescribed frequency, whatever the law, since the motion is almost the "
      "same. "
      "Only a loss that depends on the force falls with it. Viscous, quadratic and constant friction depend on the "
      "speed alone, whose mean does not change, and predict almost no saving of friction; with more drag in place of "
      "friction springs even raise the input.";
  s.draw = [chart](PlotFormat format, const std::filesystem::path& file) { reproduction::draw(chart, format, file); };
  sheets.push_back(std::move(s));
  return sheets;
}

}  // namespace wingbeat::reproduction

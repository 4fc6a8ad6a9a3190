// What the figures along an axis share: styles, columns, panels.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "reproduction/sheet.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat::reproduction {

using enum Formulation;

inline constexpr CurveStyle springs_on{style::with_springs}, springs_off{style::without_springs};
inline constexpr CurveStyle wingless{style::without_wings}, vacuum{style::in_vacuum}, air{style::in_air};

inline const char* springs_name(bool springs) { return springs ? "springs_on" : "springs_off"; }

inline std::vector<double> scaled(const std::vector<double>& x, double factor) {
  std::vector<double> y;
  for (const double v : x) y.push_back(factor * v);
  return y;
}

inline std::vector<double> column(const TrendCurve& curve, Metric metric) {
  std::vector<double> y;
  for (const Metrics<double>& m : curve.metrics) y.push_back(m[metric]);
  return y;
}

inline double scale_of(Metric metric) {
  const std::string_view unit = metric_info(metric).unit;
  return unit == "1" ? 100.0 : 1e3;  // per cent, mW and mN
}

inline Sheet sheet(int number, std::string what, std::string section) {
  Sheet s;
  s.id = fmt::format("figure-{:02}", number);
  s.heading = fmt::format("Figure {}. {}", number, what);
  s.section = std::move(section);
  return s;
}

inline void finish(Sheet& s, Chart chart) {
  s.wide = chart.columns > 1;
  s.draw = [chart = std::move(chart)](PlotFormat format, const std::filesystem::path& file) {
    reproduction::draw(chart, format, file);
  };
}

inline CurveStyle style_of(const FlappingCase& which, bool by_condition) {
  const CurveStyle style = by_condition    ? which.condition == Condition::air      ? air
                                             : which.condition == Condition::vacuum ? vacuum
                                                                                    : wingless
                           : which.springs ? springs_on
                                           : springs_off;
  return which.formulation == rod_force ? style : of_virtual_work(style);
}

/// The two formulations, where curves have labels beside them.
inline std::vector<ChartKey> formulation_key() { return {{"rod-force", {}}, {"virtual-work", of_virtual_work({})}}; }
inline std::vector<ChartKey> springs_key() {
  return {
      {"with springs", springs_on}, {"without springs", springs_off}, {"dashed: virtual-work", of_virtual_work({})}};
}

inline const char* springs_label(bool springs) { return springs ? "springs" : "no springs"; }
inline const char* condition_label(Condition condition) {
  return condition == Condition::air ? "air" : condition == Condition::vacuum ? "vacuum" : "no wings";
}

/// Beside curves of rod-force; those of virtual-work have the same colours.
inline std::string springs_label_of(const TrendCurve& c) {
  return c.flapping_case.formulation == rod_force ? springs_label(c.flapping_case.springs) : "";
}
inline std::string condition_label_of(const TrendCurve& c) {
  return c.flapping_case.formulation == rod_force ? condition_label(c.flapping_case.condition) : "";
}

/// A figure of metrics along an axis, one panel for each metric.
class TrendFigure {
 public:
  TrendFigure(const TableColumn& axis, double scale, std::string label) : scale_(scale) {
    table_.add(axis.name, axis.unit, axis.long_name, axis.values);
    chart_.x = std::move(label);
  }

  /// Draws and tabulates one metric of the curves that `wanted` lets pass; `tag` tells columns of several sets apart.
  template <class Wanted, class Style, class Label>
  void panel(const TrendSet& set, Metric metric, std::string label, std::string title, const Wanted& wanted,
             const Style& style, const Label& label_of, const std::string& tag = "") {
    const MetricInfo& info = metric_info(metric);
    ChartPanel panel;
    panel.y = std::move(label);
    panel.title = std::move(title);
    for (const TrendCurve& curve : set.curves) {
      if (!wanted(curve)) continue;
      const std::vector<double> y = column(curve, metric);
      draw_curve(panel, set, curve, scaled(y, scale_of(metric)), style(curve), label_of(curve));
      std::string name = fmt::format("{}_{}", condition_of(curve), springs_name(curve.flapping_case.springs));
      std::string meaning =
          fmt::format("{}, {}", condition_of(curve), curve.flapping_case.springs ? "with springs" : "without springs");
      if (std::isfinite(curve.crank_radius)) {
        name += fmt::format("_crank_{:g}_mm", 1e3 * curve.crank_radius);
        meaning += fmt::format(", crank radius {:g} mm", 1e3 * curve.crank_radius);
      }
      if (!tag.empty()) {
        name += fmt::format("_{}", detail::underscored(tag));
        meaning += ", " + tag;
        std::replace(name.begin(), name.end(), ' ', '_');
      }
      if (curve.flapping_case.condition != Condition::wingless) {
        name += fmt::format("_{}", detail::underscored(wingbeat::name_of(curve.flapping_case.formulation)));
        meaning += fmt::format(", {}", wingbeat::name_of(curve.flapping_case.formulation));
      }
      tabulate(fmt::format("{}_{}", info.key, name), info.unit, fmt::format("{}, {}", info.long_name, meaning), y);
      std::vector<double> domain;
      for (std::size_t n = 0; n < y.size(); ++n) {
        const bool flaps = std::isfinite(curve.metrics[n][Metric::power_electrical]);
        domain.push_back(flaps ? double(curve.domain[n].to_ulong()) : absent);
      }
      tabulate("domain_" + name, "1", fmt::format("limits of the domain that are exceeded ({}), {}", bits(), meaning),
               domain);
    }
    chart_.panels.push_back(std::move(panel));
  }

  Chart& chart() { return chart_; }
  void into(Sheet& s) {
    s.table = table_;
    finish(s, chart_);
  }

 private:
  /// Points outside the domain are drawn as thin dots in the curve's colour, so that they are seen not to count.
  void draw_curve(ChartPanel& panel, const TrendSet& set, const TrendCurve& curve, const std::vector<double>& y,
                  const CurveStyle& style, const std::string& label) {
    std::vector<double> inside = y, outside(y.size(), absent);
    bool left = false;
    for (std::size_t n = 0; n < y.size(); ++n) {
      if (!std::isfinite(y[n]) || curve.domain[n].none()) continue;
      outside[n] = y[n];
      if (n > 0 && curve.domain[n - 1].none()) outside[n - 1] = y[n - 1];
      if (n + 1 < y.size() && curve.domain[n + 1].none()) outside[n + 1] = y[n + 1];
      inside[n] = absent;
      left = true;
    }
    const std::vector<double> x = scaled(set.axis, scale_);
    const char* formulation =
        curve.flapping_case.condition == Condition::wingless ? "" : wingbeat::name_of(curve.flapping_case.formulation);
    std::string name = curve.flapping_case.condition != Condition::air ? condition_label(curve.flapping_case.condition)
                       : curve.flapping_case.springs                   ? "with springs"
                                                                       : "without springs";
    if (std::isfinite(curve.crank_radius)) name += fmt::format(", crank {:g} mm", 1e3 * curve.crank_radius);
    if (*formulation) name += fmt::format(", {}", formulation);
    const bool ends_outside = !outside.empty() && std::isfinite(outside.back());
    panel.curves.push_back({x, std::move(inside), style, name, formulation, ends_outside ? "" : label});
    if (!left) return;
    CurveStyle dots = style;
    dots.dash = style::dotted;
    panel.curves.push_back({x, std::move(outside), dots, name + ", outside the domain", formulation,
                            ends_outside ? label : "", style.colour});
    if (!outside_) chart_.key.push_back({"outside the domain", {style::ink, style::dotted}});
    outside_ = true;
  }

  void tabulate(const std::string& name, const std::string& unit, const std::string& meaning, std::vector<double> y) {
    const auto known = [&](const TableColumn& c) { return c.name == name; };
    if (std::none_of(table_.columns.begin(), table_.columns.end(), known)) {
      table_.add(name, unit, meaning, std::move(y));
    }
  }
  static std::string bits() {
    std::string text;
    for (std::size_t n = 0; n < std::size_t(domain_limit_count); ++n) {
      text += fmt::format("{}{} {}", n == 0 ? "sum of " : ", ", 1UL << n, domain_limit_table()[n].key);
    }
    return text;
  }
  static const char* condition_of(const TrendCurve& curve) { return wingbeat::name_of(curve.flapping_case.condition); }
  double scale_;
  bool outside_ = false;
  Chart chart_;
  Table table_;
};

inline const TrendCurve& curve_of(const TrendSet& set, const FlappingCase& which, double radius = absent) {
  for (const TrendCurve& c : set.curves) {
    if (c.flapping_case == which && (!std::isfinite(radius) || c.crank_radius == radius)) return c;
  }
  throw std::runtime_error("a curve is missing");
}

/// A metric at the place of an axis nearest to x.
inline double at(const TrendSet& set, const FlappingCase& which, Metric metric, double x) {
  std::size_t best = 0;
  for (std::size_t n = 0; n < set.axis.size(); ++n) {
    if (std::abs(set.axis[n] - x) < std::abs(set.axis[best] - x)) best = n;
  }
  return curve_of(set, which).metrics[best][metric];
}

/// " (outside the domain)" where the point of the curve nearest to x is; empty inside.
inline const char* domain_remark_at(const TrendSet& set, const FlappingCase& which, double x) {
  std::size_t best = 0;
  for (std::size_t n = 0; n < set.axis.size(); ++n) {
    if (std::abs(set.axis[n] - x) < std::abs(set.axis[best] - x)) best = n;
  }
  return curve_of(set, which).domain[best].any() ? " (outside the domain)" : "";
}

/// Which of the cycles are outside the domain, as a sentence after a caption.
inline std::string domain_remark(const std::vector<CycleCase>& cycles) {
  std::string outside;
  for (const CycleCase& c : cycles) {
    if (c.run.domain.none()) continue;
    outside +=
        fmt::format("{}{} springs, {}", outside.empty() ? "" : "; ", c.flapping_case.springs ? "with" : "without",
                    wingbeat::name_of(c.flapping_case.formulation));
  }
  return outside.empty() ? " All cycles are inside the domain." : fmt::format(" Outside the domain: {}.", outside);
}

inline TableColumn frequency_axis(const Reproduction& r) {
  return {"frequency_hz", "Hz", "flapping frequency", r.frequency.axis};
}
inline constexpr const char* frequency_label = "flapping frequency (Hz)";

inline std::string mw(double watt) { return fmt::format("{:.0f} mW", 1e3 * watt); }

/// The statement of that beginning; nullptr where there is none.
inline const Claim* claim_of(const Assessment& a, const std::string& beginning) {
  for (const Claim& c : a.claims) {
    if (c.statement.rfind(beginning, 0) == 0) return &c;
  }
  return nullptr;
}

/// "published 14.2 %; rod-force +14.38 %, virtual-work +12.88 %: reproduced" for the statement of that beginning.
inline std::string beside(const Assessment& a, const std::string& beginning) {
  const Claim* c = claim_of(a, beginning);
  if (!c) return "not available numerically";
  const std::string published = c->published_text == "-" ? "" : fmt::format("published {}; ", c->published_text);
  return published +
         fmt::format("rod-force {}, virtual-work {}: {}", c->ours_text[0], c->ours_text[1], outcome_text(*c));
}

/// Marks the published number of a statement: at x, y(number). Nothing where it has none.
template <class Place>
void mark_published(ChartPanel& panel, const Assessment& a, const std::string& beginning, const char* colour,
                    const Place& place) {
  const Claim* c = claim_of(a, beginning);
  if (!c || !c->published) return;
  const auto [x, y] = place(*c->published);
  if (!std::isfinite(x)) return;
  panel.marks.push_back(
      {x, y, fmt::format("published: {}, {}", c->statement, c->published_text), colour, c->basis == Basis::calibrated});
}

}  // namespace wingbeat::reproduction

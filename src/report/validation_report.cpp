#include "wingbeat/report/validation_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "report/described.hpp"
#include "report/report_tools.hpp"
#include "report/result_schemas.hpp"
#include "wingbeat/core/math.hpp"
#include "wingbeat/report/fit_report.hpp"
#include "wingbeat/report/plot_panels.hpp"
#include "wingbeat/report/report.hpp"

namespace wingbeat {
namespace {

constexpr int page_width = 90, stages_in_a_table = 6;

/// Text within the page, all lines but the first indented; `head` stands before the first.
std::string block(const std::string& head, int indent, const std::string& text) {
  std::string lines = wrapped(text, page_width - indent, 0);
  while (lines.ends_with('\n')) lines.pop_back();
  std::string out = fmt::format("{:<{}}", head, indent);
  for (const char c : lines) {
    out += c;
    if (c == '\n') out.append(std::size_t(indent), ' ');
  }
  return out + "\n";
}

std::string field(const char* name, const std::string& text) {
  return text.empty() ? "" : block(fmt::format("  {}", name), 17, text);
}

std::string joined(const std::vector<std::string>& texts) { return fmt::format("{}", fmt::join(texts, "; ")); }

/// How rows are split, in words.
std::string split_text(const ValidationSet& set) {
  switch (set.split) {
    case ValidationSplit::alternate:
      return fmt::format(
          "every second operating point ({}), in the order of what was set and from the first, may be fitted; the "
          "others are predicted",
          fmt::join(set.operating_point, ", "));
    case ValidationSplit::amplitude: return "the amplitude may be fitted; the phase is predicted";
    case ValidationSplit::none: return "nothing is fitted";
  }
  return "";
}

char letter(std::size_t n) { return char('a' + n); }

std::string stage_text(const ValidationStage& stage, std::size_t n) {
  std::string out =
      block(fmt::format("  ({}) ", letter(n)), 6, stage.name + (stage.variant.empty() ? "" : ": " + stage.variant));
  for (const FittedParameter& p : stage.parameters) {
    const detail::ShownUnit shown = detail::shown_unit(p.unit);
    std::string interval = "no interval";
    if (std::isfinite(p.lower_95)) {
      interval = fmt::format("95 %: {:.4g} to {:.4g}", shown.factor * p.lower_95, shown.factor * p.upper_95);
    } else if (!p.value || p.undetermined != Undetermined::no) interval = "not determined by these rows";
    else if (p.at_bound) interval = "at a bound, no interval";
    out += fmt::format("      {} = {:.4g}{}  ({})\n", p.key, shown.factor * p.value.value_or(p.kept), shown.suffix(),
                       interval);
  }
  if (stage.misfit) {
    out += block("", 6, "does not describe the rows: " + describe(*stage.misfit));
  }
  if (!stage.converged) out += "      the fit did not converge\n";
  return out;
}

/// Decimals that show the largest of the measured numbers of a quantity with four digits.
int decimals_of(const ValidationSet& set, std::size_t quantity) {
  double largest = 0.0;
  for (const ValidationPoint& p : set.points) {
    if (p.quantity == quantity) largest = std::max(largest, std::abs(p.measured));
  }
  return largest > 0.0 ? std::clamp(3 - int(std::floor(std::log10(largest))), 0, 6) : 3;
}

std::string number(double x, int decimals) {
  if (!std::isfinite(x)) return "-";
  const std::string text = fmt::format("{:.{}f}", x, decimals);
  return text.find_first_of("123456789") == std::string::npos && text.starts_with('-') ? text.substr(1) : text;
}

std::string rows_table(const ValidationSet& set, const ValidationResult& result, std::size_t first, std::size_t end) {
  std::string text;
  for (std::size_t q = 0; q < set.quantities.size(); ++q) {
    const ComparedQuantity& quantity = set.quantities[q];
    const std::string unit = quantity.unit == "1" ? "" : ", " + quantity.unit;
    const int decimals = decimals_of(set, q);
    text += fmt::format("\n{:<32}{:>10}", quantity.name + unit, "measured");
    for (std::size_t s = first; s < end; ++s) text += fmt::format("{:>8}", fmt::format("({})", letter(s)));
    text += "\n";
    for (std::size_t n = 0; n < set.points.size(); ++n) {
      const ValidationPoint& p = set.points[n];
      if (p.quantity != q) continue;
      text += fmt::format("  {:<24}{:<6}{:>10}", p.label, p.fitted ? "fit" : "", number(p.measured, decimals));
      for (std::size_t s = first; s < end; ++s)
        text += fmt::format("{:>8}", number(result.stages[s].predicted[n], decimals));
      text += "\n";
    }
    const auto miss_row = [&](bool fitted, const char* what, const auto& value, int places, const char* unit_text) {
      std::string row =
          fmt::format("  {:<40}", fmt::format("{}, {}{}", what, fitted ? "rows of fits" : "predicted rows", unit_text));
      bool any = false;
      for (std::size_t s = first; s < end; ++s) {
        double x = absent;
        for (const ValidationMiss& m : result.stages[s].misses) {
          if (m.quantity == q && m.fitted == fitted) x = value(m), any = true;
        }
        row += fmt::format("{:>8}", number(x, places));
      }
      if (any) text += row + "\n";
    };
    for (const bool fitted : {true, false}) {
      miss_row(fitted, "rms difference", [](const ValidationMiss& m) { return m.rms; }, decimals, "");
      miss_row(fitted, "mean difference", [](const ValidationMiss& m) { return m.mean; }, decimals, "");
      miss_row(fitted, "rms / size", [](const ValidationMiss& m) { return 100.0 * m.relative; }, 1, ", %");
    }
  }
  return text;
}

}  // namespace

std::string text_validation_list(std::span<const ValidationSet> sets) {
  std::string text = fmt::format("{:<26}{:>5}  {:<19}{}\n", "Measured set", "rows", "computed by", "vehicle");
  for (const ValidationSet& set : sets) {
    text += block(fmt::format("{:<26}{:>5}  {:<19}", set.name, set.rows, name_of(set.model)), 52, set.vehicle);
  }
  text += "\nNot predicted:\n";
  for (const ValidationSet& set : sets) {
    std::string why = set.reason;
    for (const std::string& other : set.not_predicted) why += (why.empty() ? "" : "; ") + other;
    if (why.empty()) continue;
    text += block("  " + set.name, 29, why);
  }
  return text;
}

std::string text_validation(const ValidationSet& set, const ValidationResult& result) {
  std::string text = set.name + "\n";
  text += field("vehicle", set.vehicle) + field("measured", set.measured) + field("source", set.source) +
          field("licence", set.licence) + field("uncertainty", set.uncertainty) + field("unknown", set.unknown);
  if (set.model == ValidationModel::none) return text + field("not predicted", set.reason);
  std::string by = name_of(set.model);
  if (!set.vehicle_file.empty()) by += ", " + set.vehicle_file;
  for (std::size_t k = 0; k < set.settings.size(); ++k) {
    by += fmt::format("{}{} = {}", k == 0 ? " with " : ", ", set.settings[k].first, set.settings[k].second);
  }
  text += field("computed by", by) + field("assumes", joined(set.assumes)) + field("rows", split_text(set)) +
          field("not predicted", joined(set.not_predicted)) + "\n";
  for (std::size_t n = 0; n < result.stages.size(); ++n) text += stage_text(result.stages[n], n);
  for (std::size_t first = 0; first < result.stages.size(); first += stages_in_a_table) {
    text += rows_table(set, result, first, std::min(result.stages.size(), first + stages_in_a_table));
  }
  return text;
}

std::string text_validation_summary(std::span<const ValidationSet> sets, std::span<const ValidationResult> results) {
  std::string text = fmt::format("{:<51}{:>13}{:>13}{:>13}\n", "Predicted rows, rms difference / size, %", "nothing",
                                 "one number", "all fitted");
  for (std::size_t n = 0; n < sets.size(); ++n) {
    for (std::size_t q = 0; q < sets[n].quantities.size(); ++q) {
      // Of stages with no, one and more parameters; models come in variants.
      double low[3] = {infinity, infinity, infinity}, high[3] = {-infinity, -infinity, -infinity};
      bool any = false;
      for (const ValidationStage& stage : results[n].stages) {
        const std::size_t kind = std::min<std::size_t>(stage.parameters.size(), 2);
        for (const ValidationMiss& miss : stage.misses) {
          if (miss.quantity != q || miss.fitted || !std::isfinite(miss.relative)) continue;
          low[kind] = std::min(low[kind], 100.0 * miss.relative);
          high[kind] = std::max(high[kind], 100.0 * miss.relative);
          any = true;
        }
      }
      if (!any) continue;
      std::string name = sets[n].quantities[q].name;
      if (name.size() > 23) name = name.substr(0, name.rfind(' ', 23));
      text += fmt::format("{:<27}{:<24}", sets[n].name, name);
      for (int kind = 0; kind < 3; ++kind) {
        std::string cell = "-";
        if (std::isfinite(low[kind])) cell = fmt::format("{:.1f}", low[kind]);
        if (high[kind] > low[kind]) cell += fmt::format(" to {:.1f}", high[kind]);
        text += fmt::format("{:>13}", cell);
      }
      text += "\n";
    }
  }
  return text;
}

namespace {

/// A panel for each quantity of a set to which nothing is fitted.
void plot_quantities(const ValidationSet& set, const ValidationStage& stage, PlotFormat format,
                     const std::filesystem::path& file) {
  std::vector<PointPanel> panels;
  for (std::size_t q = 0; q < set.quantities.size(); ++q) {
    PointSeries series{"predicted rows", {}};
    for (std::size_t n = 0; n < set.points.size(); ++n) {
      const ValidationPoint& p = set.points[n];
      const double ratio = stage.predicted[n] / p.measured;
      if (p.quantity == q && std::isfinite(ratio)) series.points.emplace_back(p.position, ratio);
    }
    panels.push_back({set.quantities[q].name, {}});
    if (!series.points.empty()) panels.back().series.push_back(std::move(series));
  }
  plot_panels(panels, {set.name, set.position_name, "computed over published", 1.0, 1.0}, format, file);
}

}  // namespace

void plot_validation(const ValidationSet& set, const ValidationResult& result, PlotFormat format,
                     const std::filesystem::path& file) {
  if (result.stages.empty()) throw std::runtime_error(set.name + " has no prediction to plot");
  const ComparedQuantity& quantity = set.quantities.front();
  if (set.model == ValidationModel::maps) return plot_quantities(set, result.stages.front(), format, file);
  // In per cent where that has two digits.
  double largest = 0.0;
  const std::size_t shown = std::min<std::size_t>(result.stages.size(), stages_in_a_table);
  for (std::size_t s = 0; s < shown; ++s) {
    for (std::size_t n = 0; n < set.points.size(); ++n) {
      const double off = result.stages[s].predicted[n] / set.points[n].measured - 1.0;
      if (set.points[n].quantity == 0 && std::isfinite(off)) largest = std::max(largest, std::abs(off));
    }
  }
  const double share = largest < 0.9 ? 100.0 : 1.0;
  std::vector<PointPanel> panels;
  for (std::size_t s = 0; s < shown; ++s) {
    const ValidationStage& stage = result.stages[s];
    // Names of several parameters are longer than a panel.
    std::string name = stage.variant.empty() ? stage.name : stage.variant;
    if (stage.parameters.size() > 1) name = fmt::format("{} numbers fitted", stage.parameters.size());
    PointPanel panel{fmt::format("({}) {}", letter(s), name), {}};
    for (const bool fitted : {true, false}) {
      PointSeries series{fitted ? "rows that fits may see" : "predicted rows", {}};
      for (std::size_t n = 0; n < set.points.size(); ++n) {
        const ValidationPoint& p = set.points[n];
        const double off =
            quantity.has_size ? share * (stage.predicted[n] / p.measured - 1.0) : stage.predicted[n] - p.measured;
        if (p.quantity == 0 && p.fitted == fitted && std::isfinite(off)) series.points.emplace_back(p.position, off);
      }
      if (!series.points.empty()) panel.series.push_back(std::move(series));
    }
    panels.push_back(std::move(panel));
  }
  const std::string axis = quantity.has_size
                               ? fmt::format("computed over measured, minus 1{}", share > 1.0 ? " (%)" : "")
                               : "computed − measured (" + quantity.unit + ")";
  plot_panels(panels, {set.name + ": " + quantity.name, set.position_name, axis, 0.0}, format, file);
}

namespace described {
namespace {

struct Validated {
  const ValidationSet& set;
  const ValidationResult* result;
};

const Description<ComparedQuantity>& quantity_description() {
  using R = ComparedQuantity;
  static const Description<R> description =
      Description<R>().always("name", "", "what is compared", &R::name).always("unit", "", "", &R::unit);
  return description;
}

const Description<ValidationPoint>& point_description() {
  using R = ValidationPoint;
  static const Description<R> description =
      Description<R>()
          .always("label", "", "what was set", &R::label)
          .always("quantity", "", "index in quantities", &R::quantity)
          .always("measured", "", "in the quantity's unit", &R::measured)
          .always("fitted", "", "a fit sees it; else it is predicted by every stage", &R::fitted);
  return description;
}

const Description<FittedParameter>& fitted_description() {
  using R = FittedParameter;
  static const Description<R> description =
      Description<R>()
          .always("key", "", "of the vehicle file, or what the number is", &R::key)
          .always("unit", "", "SI", &R::unit)
          .always("value", "", "SI; null where the rows do not determine it", &R::value)
          .always("lower_95", "", "end of the 95 % interval, SI", &R::lower_95)
          .always("upper_95", "", "end of the 95 % interval, SI", &R::upper_95)
          .always("at_bound", "", "the fit ended at a bound", &R::at_bound);
  return description;
}

const Description<ValidationMiss>& miss_description() {
  using R = ValidationMiss;
  static const Description<R> description =
      Description<R>()
          .always("quantity", "", "index in quantities", &R::quantity)
          .always("fitted", "", "of the rows that fits see, else of those that are predicted", &R::fitted)
          .always("points", "", "rows that the model reaches", &R::points)
          .always("unreached", "", "rows that it does not reach", &R::unreached)
          .always("rms", "", "of computed minus measured, in the quantity's unit", &R::rms)
          .always("mean", "", "of computed minus measured, in the quantity's unit", &R::mean)
          .always("relative", "1", "rms over the rms of the measured numbers", &R::relative);
  return description;
}

const Description<ValidationStage>& stage_description() {
  using R = ValidationStage;
  static const Description<R> description =
      Description<R>()
          .always("name", "", "what was fitted", &R::name)
          .always("variant", "", "coefficients and terms of the model; empty where there is one model", &R::variant)
          .always("converged", "", "of the fit", &R::converged)
          .always("misfit", "", "why the fitted model does not describe the rows, which then has no intervals",
                  [](const R& r) { return r.misfit ? std::optional(describe(*r.misfit)) : std::nullopt; })
          .parts("parameters", "what was fitted", fitted_description(), &R::parameters)
          .always("predicted", "", "by point, in its quantity's unit; null where the model does not reach it",
                  &R::predicted)
          .parts("misses", "how far the model is off", miss_description(), &R::misses);
  return description;
}

const Description<Validated>& set_description() {
  using R = Validated;
  static const Description<R> description =
      Description<R>()
          .always("name", "", "of the set", [](const R& r) { return r.set.name; })
          .always("vehicle", "", "that was measured", [](const R& r) { return r.set.vehicle; })
          .always("source", "", "where the numbers were read", [](const R& r) { return r.set.source; })
          .always("licence", "", "of the source", [](const R& r) { return r.set.licence; })
          .always("measured", "", "what, and how", [](const R& r) { return r.set.measured; })
          .always("uncertainty", "", "what is known of it", [](const R& r) { return r.set.uncertainty; })
          .always("unknown", "", "what the source lacks", [](const R& r) { return r.set.unknown; })
          .always("remarks", "", "", [](const R& r) { return r.set.remarks; })
          .always("rows", "", "of the data", [](const R& r) { return r.set.rows; })
          .always("model", "", "what computes the numbers", [](const R& r) { return r.set.model; })
          .always("reason", "", "why nothing is predicted; empty where something is",
                  [](const R& r) { return r.set.reason; })
          .always("split", "", "rule by which rows are fitted or predicted", [](const R& r) { return r.set.split; })
          .always("operating_point", "", "columns that make an operating point",
                  [](const R& r) { return r.set.operating_point; })
          .always("vehicle_file", "", "empty: none", [](const R& r) { return r.set.vehicle_file; })
          .always("settings", "", "keys of the vehicle file that were set", [](const R& r) { return r.set.settings; })
          .always("assumes", "", "assumptions of the prediction", [](const R& r) { return r.set.assumes; })
          .always("not_predicted", "", "what else was measured, and why it is not predicted",
                  [](const R& r) { return r.set.not_predicted; })
          .parts("quantities", "that are compared", quantity_description(),
                 [](const R& r) -> const auto& { return r.set.quantities; })
          .parts("points", "measured numbers", point_description(),
                 [](const R& r) -> const auto& { return r.set.points; })
          .parts("stages", "the model with nothing fitted, then after each fit; none where nothing was computed",
                 stage_description(),
                 [](const R& r) { return r.result ? r.result->stages : std::vector<ValidationStage>{}; });
  return description;
}

const Description<std::vector<Validated>>& validation_description() {
  using R = std::vector<Validated>;
  static const Description<R> description =
      Description<R>().parts("sets", "measured sets", set_description(), std::identity{});
  return description;
}

}  // namespace

Json validation_schema() { return validation_description().schema(); }

}  // namespace described

std::string json_validation(std::span<const ValidationSet> sets, std::span<const ValidationResult> results) {
  std::vector<described::Validated> all;
  for (std::size_t n = 0; n < sets.size(); ++n) all.push_back({sets[n], results.empty() ? nullptr : &results[n]});
  return detail::dumped(described::validation_description().json(all));
}

}  // namespace wingbeat

#include "report/sweep_scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "wingbeat/core/text.hpp"
#include "wingbeat/cycle/domain.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat {

Display display_for(std::string_view unit, double largest, bool efficiency) {
  if (efficiency) return {"%", 100.0};
  if (unit == "1") return {"", 1.0};
  if (unit == "rad") return {"deg", degrees_per_radian};
  if (unit == "degree") return {"deg", 1.0};
  // A prefix stands before one unit, or before the newton of moments, stiffnesses and dampings.
  const bool simple = unit.find_first_of(" /0123456789") == std::string_view::npos || unit.starts_with("N m");
  if (!simple || unit == "Hz" || unit == "V" || !(largest > 0.0)) return {std::string(unit), 1.0};
  if (unit == "kg") return {"g", 1e3};
  constexpr std::pair<double, const char*> prefixes[] = {{1e-9, "n"}, {1e-6, "µ"}, {1e-3, "m"}, {1.0, ""}, {1e3, "k"}};
  const auto* best = &prefixes[0];
  for (const auto& prefix : prefixes) {
    if (largest >= 0.9999 * prefix.first) best = &prefix;
  }
  return {fmt::format("{}{}", best->second, unit), 1.0 / best->first};
}

namespace {

bool is_efficiency(Metric m) { return std::string_view(metric_info(m).key).starts_with("efficiency"); }

}  // namespace

bool is_number(const SweepAxis& axis) {
  return std::none_of(axis.quantities.begin(), axis.quantities.end(),
                      [](const SweptQuantity& q) { return q.kind == SweptQuantity::Kind::choice; });
}

bool makes_curves(const Sweep& sweep, const SweepAxis& axis) {
  constexpr std::uint64_t few = 4, many = 10;
  if (!is_number(axis)) return true;
  return axis.count < few && std::any_of(
                                 sweep.axes.begin(), sweep.axes.end(),
                                 [&](const SweepAxis& other) { return is_number(other) && other.count >= many; });
}

std::string words(const std::string& key) {
  const auto dot = key.rfind('.');
  if (dot == std::string::npos) return detail::spaced(key);
  const std::string leaf = key.substr(dot + 1);
  int same = 0;
  for (const auto& known : parameter_table<double>()) same += known.path.substr(known.path.rfind('.') + 1) == leaf;
  if (same == 1 && leaf.find('_') != std::string::npos) return detail::spaced(leaf);
  const std::string above = key.substr(0, dot);
  return detail::spaced(above.substr(above.rfind('.') + 1) + " " + leaf);
}

std::string Display::in_brackets() const { return unit.empty() ? "" : fmt::format(" ({})", unit); }

Display display_of(Metric metric, double largest) {
  return display_for(metric_info(metric).unit, largest, is_efficiency(metric));
}

Scale::Scale(const SweepAxis& axis) {
  const SweptQuantity& q = axis.quantities.front();
  name = axis.name == q.name || axis.quantities.size() == 1 ? words(q.key) : detail::spaced(axis.name);
  double largest = 0.0;
  for (const double x : q.values) largest = std::max(largest, std::abs(x));
  display = display_for(q.unit, largest);
  logarithmic = q.logarithmic;
  for (const double x : q.values) values.push_back(display.factor * x);
}

std::string Scale::range(const char* which) const {
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  std::string text = fmt::format("set {0}range [{1}:{2}]\n{3} logscale {0}\n", which, *lowest, *highest,
                                 logarithmic ? "set" : "unset");
  if (!logarithmic || *highest > 1000.0 * *lowest) return text;
  // Over few decades powers of ten alone are too few marks; over more, three a decade would overlap.
  const std::vector<double> steps = *highest > 30.0 * *lowest ? std::vector{1.0, 3.0} : std::vector{1.0, 2.0, 5.0};
  std::string marks;
  for (double decade = std::pow(10.0, std::floor(std::log10(*lowest))); decade <= *highest; decade *= 10.0) {
    for (const double step : steps) marks += fmt::format("{}{}", marks.empty() ? "" : ",", step * decade);
  }
  return text + fmt::format("set {}tics ({})\n", which, marks);
}

std::string Scale::value(std::size_t n) const {
  return fmt::format("{:.4g}{}{}", values[n], display.unit.empty() ? "" : " ", display.unit);
}

std::string title_of(const Study& study) {
  return study.title.empty() ? std::filesystem::path(study.input.study_name).stem().string() : study.title;
}

Field::Field(const NetcdfReader& file, Metric m) : metric(m), values(file.read(metric_info(m).key)) {
  double largest = 0.0;
  for (const double x : values) largest = std::isfinite(x) ? std::max(largest, std::abs(x)) : largest;
  display = display_of(m, largest);
  for (double& x : values) x *= display.factor;
}

std::string Field::label() const { return metric_info(metric).long_name + display.in_brackets(); }

std::string Field::shown(double value) const {
  return fmt::format("{:.4g}{}{}", value, display.unit.empty() ? "" : " ", display.unit);
}

const char* Field::superlative() const {
  const std::string_view key = metric_info(metric).key;
  if (lower_is_better()) return "lowest";
  return is_efficiency(metric) || key.starts_with("lift") ? "best" : "highest";
}

bool Field::lower_is_better() const {
  switch (metric) {
    case Metric::power_aerodynamic: return false;
    case Metric::voltage:
    case Metric::winding_temperature:
    case Metric::case_temperature: return true;
    default: break;
  }
  const std::string_view key = metric_info(metric).key;
  return key.starts_with("power_") || key.starts_with("current_") || key.starts_with("rod_force_");
}

const char* without_numbers(const Sweep& sweep) {
  if (!sweep.hold) return "does not flap";
  switch (sweep.hold->held) {
    case Held::frequency: return "does not flap, or not so fast";
    case Held::power: return "does not flap, or not on that power";
    default: return "does not flap, or without that lift";
  }
}

std::string design_note(int status, unsigned domain) {
  if (SweepStatus(status) != SweepStatus::flapping) return name_of(SweepStatus(status));
  std::string note;
  for (std::size_t k = 0; k < domain_limit_table().size(); ++k) {
    if ((domain >> k & 1U) == 0) continue;
    note += fmt::format("{}{}", note.empty() ? "outside the model's domain: " : ", ",
                        detail::spaced(domain_limit_table()[k].key));
  }
  return note;
}

std::vector<double> lift_over_weight(const Sweep& sweep, const NetcdfReader& file) {
  const bool held = sweep.hold && sweep.hold->held == Held::lift_to_weight;
  if (held || !sweep.options.metrics[std::size_t(Metric::lift_to_weight)]) return {};
  return file.read(metric_info(Metric::lift_to_weight).key);
}

SweepBest best_of(const Field& field, const std::vector<double>& weight, const std::vector<double>& domain,
                  bool extrapolates) {
  SweepBest best(field.lower_is_better());
  for (std::size_t n = 0; n < field.values.size(); ++n) {
    if (!extrapolates && domain[n] != 0.0) continue;
    best.offer(n, field.values[n], weight.empty() ? absent : weight[n]);
  }
  return best;
}

}  // namespace wingbeat

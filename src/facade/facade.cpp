#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include "facade/design_values.hpp"
#include "files/design_settings.hpp"
#include "files/read_number.hpp"
#include "files/study_sections.hpp"
#include "wingbeat/ensemble/ensemble_member.hpp"
#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/files/units.hpp"
#include "wingbeat/vehicle/parameters.hpp"
#include "wingbeat/vehicle/vehicle.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat {
namespace {

/// Without the file, line and column of a text that the caller has not written.
InputError without_place(const InputError& error) {
  std::string reason = detail::reason_of(error);
  const std::string key = error.key() + ": ";
  if (!error.key().empty() && reason.starts_with(key)) reason.erase(0, key.size());
  return InputError("", 0, 0, error.key(), reason);
}

/// The value of an assignment where it is a decimal, or a text in quotes without escapes; empty where it is anything
/// else.
std::optional<TomlNode> plain_value(std::string_view text) {
  TomlNode node;
  if (text.size() > 2 && text.front() == '"' && text.find_first_of("\"\\", 1) == text.size() - 1) {
    node.kind = TomlNode::Kind::text;
    node.text = text.substr(1, text.size() - 2);
    return node;
  }
  node.kind = TomlNode::Kind::number;
  const auto [end, error] = detail::read_number(text.data(), text.data() + text.size(), node.number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(node) : std::nullopt;
}

std::optional<double> number_in(const TomlNode& value, std::string_view unit) {
  if (value.kind == TomlNode::Kind::number && std::isfinite(value.number)) return value.number;
  if (value.kind != TomlNode::Kind::text) return std::nullopt;
  try {
    return parse_quantity(value.text, unit, SpeedConstant::inverted);
  } catch (const UnitError&) {
    return std::nullopt;
  }
}

/// Another value of a number that the design has; false where that is not all there is to do.
bool set_number(Design<double>& design, std::string_view path, const TomlNode& value) {
  const Parameter<double>* key = find_parameter<double>(path);
  if (!key || !key->get || !key->set || !key->get(design)) return false;
  const std::optional<double> number = number_in(value, key->unit);
  return number && key->range.holds(*number) && key->set(design, *number) && key->get(design) == number;
}

bool is_valid(const Design<double>& design) {
  try {
    validate(design);
    return true;
  } catch (const ParameterError&) {
    return false;
  }
}

Design<double> read_values(std::span<const Setting> settings, std::span<const std::string> overrides,
                           const Design<double>* base) {
  try {
    return design_of(base ? document_of(*base, "vehicle") : parse_document("", "vehicle"), settings, overrides,
                     [](const std::string& name) { return read_text_file(name); });
  } catch (const InputError& error) {
    InputError placeless = without_place(error);
    for (const InputError& other : error.others()) placeless.add_other(without_place(other));
    throw placeless;
  }
}

}  // namespace

Design<double> design_with(std::span<const std::string> assignments, const Design<double>* base) {
  std::optional<Design<double>> design;
  if (base) design = *base;
  for (const std::string_view assignment : assignments) {
    if (!design) break;
    const std::size_t equals = std::min(assignment.find('='), assignment.size());
    const auto value = equals < assignment.size() ? plain_value(assignment.substr(equals + 1)) : std::nullopt;
    if (!value || !set_number(*design, assignment.substr(0, equals), *value)) design.reset();
  }
  if (design && is_valid(*design)) return *std::move(design);
  return read_values({}, assignments, base);
}

Design<double> design_with(std::span<const Setting> settings, const Design<double>* base) {
  if (base) {
    Design<double> design = *base;
    const bool all_set = std::all_of(settings.begin(), settings.end(),
                                     [&](const Setting& s) { return set_number(design, s.path, s.value); });
    if (all_set && is_valid(design)) return design;
  }
  return read_values(settings, {}, base);
}

std::string_view name_without_unit(std::string_view key, std::string_view unit) {
  constexpr std::pair<std::string_view, std::string_view> suffixes[] = {
      {"V", "_v"},        {"Hz", "_hz"},           {"A", "_a"},       {"W", "_w"},    {"N", "_n"}, {"rad", "_rad"},
      {"degree", "_deg"}, {"rad/s", "_rad_per_s"}, {"degC", "_degc"}, {"N m", "_nm"}, {"K", "_k"}, {"s", "_s"}};
  for (const auto& [suffixed_unit, suffix] : suffixes) {
    if (unit == suffixed_unit && key.ends_with(suffix)) return key.substr(0, key.size() - suffix.size());
  }
  return key;
}

RunResult solve(const Design<double>& design, const RunOptions& options) {
  validate(design);
  return run_design(design, options);
}

TransientResult simulate(const Design<double>& design, TransientOptions options, Condition condition) {
  validate(design);
  options.reporting = reporting_of(design);
  if (!drive_of(design).alternating && !options.supply) options.supply = design.supply;
  return simulate_start_up(switched_on(resolve(design, condition)), options);
}

Simulation simulation(const Design<double>& design, const SimulationOptions& options, Condition condition) {
  validate(design);
  return Simulation(switched_on(resolve(design, condition)), design.supply, options);
}

DesignPoint gradient(const Design<double>& design, std::span<const std::string> keys,
                     const DesignPointOptions& options) {
  validate(design);
  std::vector<DesignParameter> parameters;
  for (const std::string& key : keys) parameters.push_back(design_parameter(key));
  return design_point(design, options, parameters, start_up_in_time());
}

std::vector<EnsembleOutcome> solve_ensemble(std::span<const Design<double>> designs, const EnsembleOptions& options,
                                            Condition condition) {
  std::vector<EnsembleMember> members;
  members.reserve(designs.size());
  for (const Design<double>& design : designs) {
    try {
      validate(design);
    } catch (const ParameterError& error) {
      throw ParameterError(error.key(), "design " + std::to_string(members.size()) + ": " + error.reason());
    }
    members.push_back({resolve(design, condition), reporting_of(design)});
  }
  std::vector<EnsembleOutcome> outcomes(designs.size());
  solve_ensemble(members, options, start_up_in_time(), outcomes);
  return outcomes;
}

}  // namespace wingbeat

#include <algorithm>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include "facade/design_values.hpp"
#include "files/design_settings.hpp"
#include "files/read_number.hpp"
#include "files/study_sections.hpp"
#include "wingbeat/cycle/air_equilibrium.hpp"
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

/// KEY=VALUE where the value is a decimal, or a text in quotes without escapes; empty where it is anything else.
std::optional<Setting> plain_setting(std::string_view assignment) {
  const std::size_t equals = std::min(assignment.find('='), assignment.size());
  const std::string_view text = assignment.substr(std::min(equals + 1, assignment.size()));
  Setting setting{std::string(assignment.substr(0, equals)), {}, {}};
  if (text.size() > 2 && text.front() == '"' && text.find_first_of("\"\\", 1) == text.size() - 1) {
    setting.value.kind = TomlNode::Kind::text;
    setting.value.text = text.substr(1, text.size() - 2);
    return setting;
  }
  setting.value.kind = TomlNode::Kind::number;
  const auto [end, error] = detail::read_number(text.data(), text.data() + text.size(), setting.value.number);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(setting) : std::nullopt;
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

/// The design with other values of numbers that it has; empty where that is not all there is to do.
std::optional<Design<double>> with_numbers(std::span<const Setting> settings, const Design<double>& base) {
  std::optional<Design<double>> design = base;
  for (const Setting& setting : settings) {
    const Parameter<double>* key = find_parameter<double>(setting.path);
    if (!key || !key->get || !key->set || !key->get(*design)) return std::nullopt;
    const std::optional<double> number = number_in(setting.value, key->unit);
    if (!number || !key->range.holds(*number) || !key->set(*design, *number) || key->get(*design) != number) {
      return std::nullopt;
    }
  }
  try {
    validate(*design);
  } catch (const ParameterError&) {
    return std::nullopt;
  }
  return design;
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
  std::vector<Setting> settings;
  for (const std::string& assignment : assignments) {
    if (std::optional<Setting> setting = plain_setting(assignment)) settings.push_back(*std::move(setting));
  }
  if (base && settings.size() == assignments.size()) {
    if (std::optional<Design<double>> design = with_numbers(settings, *base)) return *std::move(design);
  }
  return read_values({}, assignments, base);
}

Design<double> design_with(std::span<const Setting> settings, const Design<double>* base) {
  if (base) {
    if (std::optional<Design<double>> design = with_numbers(settings, *base)) return *std::move(design);
  }
  return read_values(settings, {}, base);
}

std::string_view name_without_unit(std::string_view key, std::string_view unit) {
  constexpr std::pair<std::string_view, std::string_view> suffixes[] = {
      {"V", "_v"},         {"Hz", "_hz"},     {"A", "_a"},        {"W", "_w"},
      {"N", "_n"},         {"rad", "_rad"},   {"degree", "_deg"}, {"rad/s", "_rad_per_s"},
      {"m/s", "_m_per_s"}, {"degC", "_degc"}, {"N m", "_nm"},     {"K", "_k"},
      {"s", "_s"}};
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
  return simulate_start_up(in_settled_air(switched_on(resolve(design, condition))), options);
}

Simulation simulation(const Design<double>& design, const SimulationOptions& options, Condition condition) {
  validate(design);
  return Simulation(in_settled_air(switched_on(resolve(design, condition))), design.supply, options);
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

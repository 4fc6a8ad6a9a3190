#include <algorithm>
#include <utility>

#include "files/study_sections.hpp"
#include "wingbeat/files/design_parameter.hpp"
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

}  // namespace

Design<double> design_with(std::span<const std::string> assignments, const Design<double>* base) {
  try {
    return parse_design(base ? write_design(*base) : std::string(), "vehicle", assignments,
                        [](const std::string& name) { return read_text_file(name); });
  } catch (const InputError& error) {
    InputError placeless = without_place(error);
    for (const InputError& other : error.others()) placeless.add_other(without_place(other));
    throw placeless;
  }
}

std::string_view name_without_unit(std::string_view key, std::string_view unit) {
  constexpr std::pair<std::string_view, std::string_view> suffixes[] = {
      {"V", "_v"},        {"Hz", "_hz"},           {"A", "_a"},       {"W", "_w"},    {"N", "_n"}, {"rad", "_rad"},
      {"degree", "_deg"}, {"rad/s", "_rad_per_s"}, {"degC", "_degc"}, {"N m", "_nm"}, {"K", "_k"}, {"s", "_s"}};
  for (const auto& [of, suffix] : suffixes) {
    if (unit == of && key.ends_with(suffix)) return key.substr(0, key.size() - suffix.size());
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

#include "wingbeat/files/design_parameter.hpp"
#include "wingbeat/wingbeat.hpp"

namespace wingbeat {

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

// The best design by an objective and constraints of the caller's own, as functions of what a design does.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "wingbeat/study/optimise.hpp"

namespace wingbeat {

/// A number of the caller's own about a design.
struct OwnTerm {
  double value = absent;        ///< not finite: the design does not count
  bool differentiated = false;  ///< the next two say how it changes with the metrics and, beside them, the parameters
  std::array<double, metric_count> by_metric{};  ///< SI
  std::vector<double> by_parameter{};            ///< SI, for each parameter of the study, or empty
};

struct OwnTerms {
  std::size_t constraints = 0;  ///< terms behind the first
  /// The objective, to be minimised, and then what must not exceed 0, each about 1 in size, of a design that flaps.
  /// What it throws ends the search and goes on.
  std::function<std::vector<OwnTerm>(const Design<double>&, const DesignPoint&)> evaluate;
};

struct OwnOptimum {
  OptimiseResult::Outcome outcome = OptimiseResult::Outcome::nothing_flaps;
  std::vector<double> parameters;  ///< of the optimum [SI]
  Design<double> design;           ///< with them; where the frequency is held, with the voltage found
  double objective = absent;
  int starts = 0, same = 0, elsewhere = 0, failed = 0;  ///< starts by where they ended
  int evaluations = 0;
  bool gradients = false;  ///< the searches had derivatives
  std::vector<SearchEnd> searches;
};

/// Local searches on the calling thread, from the design as given, where it lies within the bounds, and from the best
/// of the screening, which takes as many designs as the study says: by SLSQP with exact gradients where all terms of
/// the screening have their derivatives, else by COBYLA (Powell 1994; NLopt). Constraints and domain of the study
/// count; its objective does not. The result depends on study and terms alone. Throws ParameterError for a parameter
/// without a place in the design, and where a term does not keep to having derivatives.
OwnOptimum optimise_own(const OptimiseStudy& study, const OwnTerms& terms, const StartUp& start_up);

}  // namespace wingbeat

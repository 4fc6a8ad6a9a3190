// One local search for the best design.
#pragma once

#include "study/optimise_problem.hpp"

namespace wingbeat::detail {

/// Gradient-based, by NLopt: SLSQP, and CCSAQ where that runs into designs that do not flap.
struct LocalSearch {
  Vector end;
  double objective = HUGE_VAL, began = absent;
  bool feasible = false;
  int evaluations = 0;

  void run(const OptimiseProblem& problem, const Vector& start);
};

}  // namespace wingbeat::detail

// One local search for the best design.
#pragma once

#include <functional>

#include "study/optimise_problem.hpp"

namespace wingbeat::detail {

/// What a search asks, in coordinates from 0 to 1.
struct SearchedFunction {
  Eigen::Index size, constraints;
  bool gradients;  ///< evaluations have them
  std::function<OptimiseProblem::Evaluation(const Vector& u)> evaluate;
};

/// By NLopt. With gradients: SLSQP, and CCSAQ where that runs into designs that do not flap. Without: COBYLA, twice.
struct LocalSearch {
  Vector end;
  double objective = HUGE_VAL, began = absent;
  bool feasible = false;
  int evaluations = 0;

  /// Throws what an evaluation does.
  void run(const SearchedFunction& function, const Vector& start);
  void run(const OptimiseProblem& problem, const Vector& start) {
    run({problem.size(), problem.constraints(), true, [&](const Vector& u) { return problem.evaluate(u); }}, start);
  }
};

}  // namespace wingbeat::detail

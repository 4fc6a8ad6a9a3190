// What holds an optimum, and how flat it is.
#pragma once

#include <optional>
#include <vector>

#include "study/optimise_problem.hpp"
#include "wingbeat/study/for_each.hpp"

namespace wingbeat::detail {

/// What holds the optimum, and the freedom that it leaves.
class Neighbourhood {
 public:
  /// `evaluations` counts on. Designs that do not depend on each other are solved by `for_each`.
  Neighbourhood(const OptimiseProblem& problem, const Vector& best, const ForEach& for_each, int& evaluations);

  std::vector<ActiveLimit> active() const;

  std::vector<FlatDirection> directions();

 private:
  /// Least squares: gradient + sum of multiplier * normal = 0.
  void find_multipliers();

  /// Of the Lagrangian, by differences of exact gradients: central ones, one-sided at a bound.
  Eigen::MatrixXd hessian();

  std::vector<double> values(const Vector& u) const;

  /// A walk from the optimum to one side of a direction.
  struct Walk {
    std::vector<FlatDirection::Step> steps;  ///< designs tried that are no more than flat_loss worse
    int evaluations = 0;
    Vector end;
    bool by_bound = false;  ///< a bound of the parameters ends the way there
  };

  /// The point at a distance along the direction, put back onto the active constraints; nothing if it is no design.
  std::optional<Vector> moved(const Vector& direction, double distance, double sign, Walk& walk) const;

  /// To the farthest point that is not more than flat_loss worse.
  Walk farthest(const Vector& direction, double sign) const;

  const OptimiseProblem& problem_;
  Vector best_;
  const ForEach& for_each_;
  int& evaluations_;
  OptimiseProblem::Evaluation at_;
  std::vector<Eigen::Index> constraints_, bounds_;
  Vector multipliers_;
};

}  // namespace wingbeat::detail

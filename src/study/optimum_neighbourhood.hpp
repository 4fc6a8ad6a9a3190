// What holds an optimum, and how flat it is.
#pragma once

#include <optional>
#include <utility>

#include "study/optimise_problem.hpp"

namespace wingbeat::detail {

/// What holds the optimum, and the freedom that it leaves.
class Neighbourhood {
 public:
  /// `evaluations` counts on.
  Neighbourhood(const OptimiseProblem& problem, const Vector& best, int& evaluations);

  std::vector<ActiveLimit> active() const;

  std::vector<FlatDirection> directions();

 private:
  /// Least squares: gradient + sum of multiplier * normal = 0.
  void find_multipliers();

  /// Of the Lagrangian, by differences of exact gradients: central ones, one-sided at a bound.
  Eigen::MatrixXd hessian();

  std::vector<double> values(const Vector& u) const;

  /// The point at a distance along the direction, put back onto the active constraints; nothing if it is no design.
  std::optional<Vector> moved(const Vector& direction, double distance, double sign,
                              std::vector<FlatDirection::Step>& walk);

  /// The farthest point that is not more than flat_loss worse; true if a bound of the parameters ends the way there.
  std::pair<Vector, bool> farthest(const Vector& direction, double sign, std::vector<FlatDirection::Step>& walk);

  const OptimiseProblem& problem_;
  Vector best_;
  int& evaluations_;
  OptimiseProblem::Evaluation at_;
  std::vector<Eigen::Index> constraints_, bounds_;
  Vector multipliers_;
};

}  // namespace wingbeat::detail

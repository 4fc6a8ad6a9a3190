// How small dense least-squares problems are solved with Ceres.
#pragma once

#include <ceres/solver.h>

namespace wingbeat {

/// Levenberg-Marquardt on a dense QR factorisation, without output. The tolerances are relative: of the cost, and of
/// the parameters and the gradient.
inline ceres::Solver::Options least_squares(int iterations, double cost, double parameters) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = iterations;
  options.function_tolerance = cost;
  options.parameter_tolerance = parameters;
  options.gradient_tolerance = parameters;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace wingbeat

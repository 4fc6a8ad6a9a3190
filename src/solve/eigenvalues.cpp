#include "wingbeat/solve/eigenvalues.hpp"

#include <Eigen/Eigenvalues>

namespace wingbeat::solver {

using Eigen::MatrixXd;

EigenModes eigen_modes(const MatrixXd& M) {
  const Eigen::EigenSolver<MatrixXd> solver(M);
  if (solver.info() != Eigen::Success) return {};
  return {true, solver.eigenvalues(), solver.eigenvectors(), solver.pseudoEigenvectors()};
}

Eigen::VectorXcd eigenvalues_of(const MatrixXd& M) { return Eigen::EigenSolver<MatrixXd>(M, false).eigenvalues(); }

}  // namespace wingbeat::solver

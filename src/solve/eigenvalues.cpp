#include "wingbeat/solve/eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <limits>

namespace wingbeat::solver {

using Eigen::MatrixXd;

EigenModes eigen_modes(const MatrixXd& M) {
  const Eigen::EigenSolver<MatrixXd> solver(M);
  if (solver.info() == Eigen::Success) {
    return {true, solver.eigenvalues(), solver.eigenvectors(), solver.pseudoEigenvectors()};
  }
  const MatrixXd none = MatrixXd::Constant(M.rows(), M.rows(), std::numeric_limits<double>::quiet_NaN());
  return {false, none.diagonal().cast<std::complex<double>>(), none.cast<std::complex<double>>(), none};
}

Eigen::VectorXcd eigenvalues_of(const MatrixXd& M) {
  const Eigen::EigenSolver<MatrixXd> solver(M, false);
  if (solver.info() == Eigen::Success) return solver.eigenvalues();
  return Eigen::VectorXcd::Constant(M.rows(), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace wingbeat::solver

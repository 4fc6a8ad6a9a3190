#include "wingbeat/solve/singular_values.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace wingbeat::solver {

using Eigen::MatrixXd;

SymmetricModes symmetric_modes(const MatrixXd& M) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(M);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SingularValues singular_values(const MatrixXd& M) {
  const Eigen::JacobiSVD<MatrixXd> svd(M, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

}  // namespace wingbeat::solver

// Decompositions into orthogonal vectors, compiled once, as those of eigenvalues.hpp are.
#pragma once

#include <Eigen/Core>

namespace wingbeat::solver {

/// Eigenvalues of a real symmetric matrix in ascending order, values[k] with the unit vector vectors.col(k).
struct SymmetricModes {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

SymmetricModes symmetric_modes(const Eigen::MatrixXd& M);

/// M = U diag(sizes) V^T, sizes in descending order; U and V have as many columns as M has rows or columns, whichever
/// are fewer.
struct SingularValues {
  Eigen::MatrixXd U, V;
  Eigen::VectorXd sizes;
};

SingularValues singular_values(const Eigen::MatrixXd& M);

}  // namespace wingbeat::solver

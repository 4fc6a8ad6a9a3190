// Decompositions of small dense matrices, compiled once: Eigen's take the compiler longer than the rest of a file.
#pragma once

#include <Eigen/Core>

namespace wingbeat::solver {

/// Eigenvalues and eigenvectors of a real square matrix: values[k] belongs to vectors.col(k), pairs stand side by side.
/// In `real_vectors` the two columns of a pair are the real and the imaginary part of a vector: they span the same
/// space. NaN, all of them, where they were not found.
struct EigenModes {
  bool found = false;
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
  Eigen::MatrixXd real_vectors;
};

EigenModes eigen_modes(const Eigen::MatrixXd& M);

/// The eigenvalues alone; NaN where they were not found.
Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXd& M);

}  // namespace wingbeat::solver

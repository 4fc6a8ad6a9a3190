#include "wingbeat/solve/linear.hpp"

// g++ 12 takes Eigen's unrolled loops for uses of uninitialised memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <Eigen/Dense>
#include <cmath>

namespace wingbeat::solver {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

bool solve_linear(int n, double* matrix, double* right_hand_side) {
  const Eigen::Map<RowMajor> A(matrix, n, n);
  Eigen::Map<Eigen::VectorXd> b(right_hand_side, n);
  const Eigen::PartialPivLU<RowMajor> lu(A);
  if (!(lu.rcond() > 1e-15)) return false;
  b = lu.solve(b).eval();
  return b.allFinite();
}

bool solve_linear(int n, double* matrix, int count, double* right_hand_sides) {
  const Eigen::PartialPivLU<RowMajor> lu(Eigen::Map<RowMajor>(matrix, n, n));
  Eigen::Map<RowMajor> B(right_hand_sides, n, count);
  B = lu.solve(B).eval();
  return B.allFinite();
}

namespace {

/// Matrices of the sizes that occur often have them at compile time.
template <int size>
bool invert_fixed(int n, double* matrix) {
  using Matrix = Eigen::Matrix<double, size, size, size == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
  Eigen::Map<Matrix> A(matrix, n, n);
  const double before = A.norm();
  A = Eigen::PartialPivLU<Matrix>(A).inverse().eval();
  return before * A.norm() < 1e15;
}

}  // namespace

bool invert(int n, double* matrix) {
  switch (n) {
    case 1: return invert_fixed<1>(n, matrix);
    case 2: return invert_fixed<2>(n, matrix);
    case 5: return invert_fixed<5>(n, matrix);
    case 10: return invert_fixed<10>(n, matrix);
    default: return invert_fixed<Eigen::Dynamic>(n, matrix);
  }
}

double determinant(int n, const double* matrix) {
  if (n == 1) return matrix[0];
  if (n == 2) return matrix[0] * matrix[3] - matrix[1] * matrix[2];
  return Eigen::Map<const RowMajor>(matrix, n, n).determinant();
}

double norm(int n, const double* matrix) { return Eigen::Map<const Eigen::VectorXd>(matrix, n * n).norm(); }

double spectral_radius(int n, const double* matrix) {
  if (n == 1) return std::abs(matrix[0]);
  if (n == 2) {
    const double half_trace = 0.5 * (matrix[0] + matrix[3]);
    const double determinant = matrix[0] * matrix[3] - matrix[1] * matrix[2];
    const double half_difference = 0.5 * (matrix[0] - matrix[3]);
    const double discriminant = half_difference * half_difference + matrix[1] * matrix[2];
    return discriminant >= 0.0 ? std::abs(half_trace) + std::sqrt(discriminant) : std::sqrt(determinant);
  }
  const Eigen::MatrixXd A = Eigen::Map<const RowMajor>(matrix, n, n);
  return A.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace wingbeat::solver

#include "wingbeat/solve/linear.hpp"

// g++ 12 takes Eigen's unrolled loops for uses of uninitialised memory.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "wingbeat/solve/eigenvalues.hpp"

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

constexpr int max_factorised = 64;

/// The inverse of a small matrix, its size known at compile time, by Gauss and Jordan's elimination. Rows are scaled
/// first, so that stiff ones among others do no harm.
template <int n>
bool invert_fixed(double* a) {
  double scale[n];
  for (int row = 0; row < n; ++row) {
    double largest = 0.0;
    for (int k = 0; k < n; ++k) largest = std::max(largest, std::abs(a[row * n + k]));
    if (!(largest > 0.0 && largest < HUGE_VAL)) return false;
    scale[row] = 1.0 / largest;
    for (int k = 0; k < n; ++k) a[row * n + k] *= scale[row];
  }
  const Eigen::Map<const Eigen::Matrix<double, n * n, 1>> all(a);
  const double before = all.norm();
  int from[n];
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int row = k + 1; row < n; ++row) {
      if (std::abs(a[row * n + k]) > std::abs(a[pivot * n + k])) pivot = row;
    }
    from[k] = pivot;
    if (pivot != k) std::swap_ranges(a + k * n, a + (k + 1) * n, a + pivot * n);
    const double inverse = 1.0 / a[k * n + k];
    if (!std::isfinite(inverse)) return false;
    a[k * n + k] = 1.0;
    double pivot_row[n];
    for (int j = 0; j < n; ++j) pivot_row[j] = a[k * n + j] *= inverse;
    for (int row = 0; row < n; ++row) {
      if (row == k) continue;
      const double factor = a[row * n + k];
      a[row * n + k] = 0.0;
      for (int j = 0; j < n; ++j) a[row * n + j] -= factor * pivot_row[j];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    if (from[k] == k) continue;
    for (int row = 0; row < n; ++row) std::swap(a[row * n + k], a[row * n + from[k]]);
  }
  if (!(before * all.norm() < 1e15)) return false;
  for (int row = 0; row < n; ++row) {
    for (int k = 0; k < n; ++k) a[row * n + k] *= scale[k];
  }
  return true;
}

template <int size>
bool factorise_sized(int any_size, double* a, int* pivots) {
  constexpr int max_size = size > 0 ? size : max_factorised;
  const int n = size > 0 ? size : any_size;
  double scale[max_size];
  for (int row = 0; row < n; ++row) {
    double largest = 0.0;
    for (int k = 0; k < n; ++k) largest = std::max(largest, std::abs(a[k * n + row]));
    if (!(largest > 0.0 && largest < HUGE_VAL)) return false;
    scale[row] = 1.0 / largest;
  }
  for (int k = 0; k < n; ++k) {
    double* column = a + k * n;
    int pivot = k;
    double largest = std::abs(column[k]) * scale[k];
    for (int row = k + 1; row < n; ++row) {
      const double here = std::abs(column[row]) * scale[row];
      if (here > largest) pivot = row, largest = here;
    }
    if (!(largest > 1e-15)) return false;
    pivots[k] = pivot;
    if (pivot != k) {
      std::swap(scale[k], scale[pivot]);
      for (int j = 0; j < n; ++j) std::swap(a[j * n + k], a[j * n + pivot]);
    }
    const double inverse = 1.0 / column[k];
    double factors[max_size] = {};  // of all rows, so that loops have the same length for all k
    for (int row = k + 1; row < n; ++row) factors[row] = column[row] *= inverse;
    for (int j = k + 1; j < n; ++j) {
      double* next = a + j * n;
      const double by = next[k];
      for (int row = 0; row < n; ++row) next[row] -= by * factors[row];
    }
  }
  return true;
}

}  // namespace

bool invert(int n, double* matrix) {
  switch (n) {
    case 1: return invert_fixed<1>(matrix);
    case 2: return invert_fixed<2>(matrix);
    default: break;
  }
  Eigen::Map<RowMajor> A(matrix, n, n);
  const Eigen::PartialPivLU<RowMajor> lu(A);
  if (!(lu.rcond() > 1e-15)) return false;
  A = lu.inverse().eval();
  return A.allFinite();
}

bool factorise(int n, double* matrix, int* pivots) {
  switch (n) {
    case 5: return factorise_sized<5>(n, matrix, pivots);
    case 10: return factorise_sized<10>(n, matrix, pivots);
    default: return n <= max_factorised && factorise_sized<0>(n, matrix, pivots);
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
  return eigenvalues_of(Eigen::Map<const RowMajor>(matrix, n, n)).cwiseAbs().maxCoeff();
}

}  // namespace wingbeat::solver

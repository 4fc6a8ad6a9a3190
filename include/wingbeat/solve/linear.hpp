// Dense linear algebra for systems of a few states, kept out of the templates.
#pragma once

namespace wingbeat::solver {

/// Solves A x = b in place (A row-major n x n, destroyed; b becomes x) by LU with partial pivoting.
/// False if A is singular to working precision.
bool solve_linear(int n, double* matrix, double* right_hand_side);

/// Solves A X = B for `count` right-hand sides, the columns of a row-major n x count matrix.
bool solve_linear(int n, double* matrix, int count, double* right_hand_sides);

/// Replaces a row-major n x n matrix by its inverse; false if it is singular to working precision.
bool invert(int n, double* matrix);

/// Replaces a column-major n x n matrix by the factors L (unit diagonal, not stored) and U of its rows in another
/// order: for each k in turn, rows k and pivots[k] are exchanged. Rows count by their largest element when pivots are
/// chosen, so that stiff ones among others do no harm. False if it is singular to working precision.
bool factorise(int n, double* matrix, int* pivots);

/// Determinant of a row-major n x n matrix.
double determinant(int n, const double* matrix);

/// Frobenius norm of a row-major n x n matrix.
double norm(int n, const double* matrix);

/// Largest modulus of the eigenvalues of a row-major n x n matrix.
double spectral_radius(int n, const double* matrix);

}  // namespace wingbeat::solver

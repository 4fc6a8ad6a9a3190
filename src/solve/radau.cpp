// The five-stage Radau IIA tableau from its defining conditions.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <Eigen/Dense>
#include <cmath>

#include "wingbeat/core/root.hpp"
#include "wingbeat/solve/implicit_step.hpp"

namespace wingbeat::solver {
namespace {

constexpr int s = RadauTableau::stages;
using Vector = Eigen::Matrix<long double, s, 1>;
using Matrix = Eigen::Matrix<long double, s, s>;

/// Legendre polynomial P_n on [0, 1].
long double shifted_legendre(int n, long double x) {
  long double before = 1.0L, at = 2.0L * x - 1.0L;
  if (n == 0) return before;
  for (int k = 1; k < n; ++k) {
    const long double next = ((2 * k + 1) * (2.0L * x - 1.0L) * at - k * before) / (k + 1);
    before = at;
    at = next;
  }
  return at;
}

RadauTableau make_tableau() {
  // The nodes of the right Radau quadrature are the zeros of P_s - P_{s-1}, the last one being 1.
  const auto node_function = [](long double x) { return shifted_legendre(s, x) - shifted_legendre(s - 1, x); };
  Vector c;
  int found = 0;
  constexpr int samples = 1000;
  for (int n = 0; n < samples && found < s - 1; ++n) {
    const long double a = (long double)(n) / samples, b = (long double)(n + 1) / samples;
    if (n + 1 == samples || (node_function(a) > 0) == (node_function(b) > 0)) continue;
    c[found++] = sign_change(node_function, a, b);
  }
  c[s - 1] = 1.0L;

  // C(s): sum_j a_ij c_j^(k-1) = c_i^k / k for k = 1..s.
  Matrix powers, right;
  for (int k = 0; k < s; ++k) {
    for (int j = 0; j < s; ++j) {
      powers(k, j) = std::pow(c[j], (long double)k);
      right(k, j) = std::pow(c[j], (long double)(k + 1)) / (k + 1);
    }
  }
  const Matrix a = powers.fullPivLu().solve(right).transpose();

  // An embedded formula of order s with weight start_weight at the step's start; the value is that of 1/gamma in
  // Hairer and Wanner's error estimate, the inverse of the tableau's real eigenvalue.
  const long double start_weight = 0.159L;
  Vector conditions;
  for (int k = 0; k < s; ++k) conditions[k] = 1.0L / (k + 1) - (k == 0 ? start_weight : 0.0L);
  const Vector embedded = powers.fullPivLu().solve(conditions);

  Vector error;
  for (int i = 0; i < s; ++i) error[i] = embedded[i] - a(s - 1, i);
  const Vector by_state = a.transpose().fullPivLu().solve(error);

  RadauTableau t;
  t.start_weight = double(start_weight);
  for (int i = 0; i < s; ++i) {
    t.c[i] = double(c[i]);
    t.error[i] = double(error[i]);
    t.error_by_state[i] = double(by_state[i]);
    for (int j = 0; j < s; ++j) t.a[i][j] = double(a(i, j));
  }
  return t;
}

}  // namespace

const RadauTableau& radau_tableau() {
  static const RadauTableau tableau = make_tableau();
  return tableau;
}

}  // namespace wingbeat::solver

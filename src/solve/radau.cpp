// Radau IIA collocation from its defining conditions, and the five-stage tableau.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <Eigen/LU>
#include <cmath>

#include "wingbeat/core/root.hpp"
#include "wingbeat/solve/implicit_step.hpp"
#include "wingbeat/solve/radau_collocation.hpp"

namespace wingbeat::solver {
namespace {

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

// One size for the compiler, whatever it is at run time.
using Exact = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

Exact solved(const Exact& matrix, const Exact& right) { return matrix.fullPivLu().solve(right); }

struct ExactCollocation {
  Exact c;
  Exact powers;  ///< c_j^k
  Exact a;

  explicit ExactCollocation(int s) : c(s, 1), powers(s, s) {
    // The nodes of the right Radau quadrature are the zeros of P_s - P_{s-1}, the last one being 1.
    const auto node_function = [s](long double x) { return shifted_legendre(s, x) - shifted_legendre(s - 1, x); };
    int found = 0;
    constexpr int samples = 1000;
    for (int n = 0; n < samples && found < s - 1; ++n) {
      const long double low = (long double)(n) / samples, high = (long double)(n + 1) / samples;
      if (n + 1 == samples || (node_function(low) > 0) == (node_function(high) > 0)) continue;
      c(found++) = sign_change(node_function, low, high);
    }
    c(s - 1) = 1.0L;

    // C(s): sum_j a_ij c_j^(k-1) = c_i^k / k for k = 1..s.
    Exact right(s, s);
    for (int k = 0; k < s; ++k) {
      for (int j = 0; j < s; ++j) {
        powers(k, j) = std::pow(c(j), (long double)k);
        right(k, j) = std::pow(c(j), (long double)(k + 1)) / (k + 1);
      }
    }
    a = solved(powers, right).transpose();
  }
};

RadauTableau make_tableau() {
  constexpr int s = RadauTableau::stages;
  const ExactCollocation exact(s);
  // An embedded formula of order s with weight start_weight at the step's start; the value is that of 1/gamma in
  // Hairer and Wanner's error estimate, the inverse of the tableau's real eigenvalue.
  const long double start_weight = 0.159L;
  Exact conditions(s, 1);
  for (int k = 0; k < s; ++k) conditions(k) = 1.0L / (k + 1) - (k == 0 ? start_weight : 0.0L);
  const Exact embedded = solved(exact.powers, conditions);

  // One of order 3 with the first, third and last stage.
  Exact few(3, 3), few_conditions(3, 1);
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) few(k, j) = exact.powers(k, 2 * j);
    few_conditions(k) = 1.0L / (k + 1);
  }
  const Exact third = solved(few, few_conditions);

  Exact error3(s, 1), error5(s, 1);
  for (int i = 0; i < s; ++i) {
    error3(i) = (i % 2 == 0 ? third(i / 2) : 0.0L) - exact.a(s - 1, i);
    error5(i) = embedded(i) - exact.a(s - 1, i);
  }
  // The stages' rates are h^-1 A^-1 times what their states are off the step's start by.
  const Exact state_error3 = solved(exact.a.transpose(), error3);
  const Exact state_error5 = solved(exact.a.transpose(), error5);

  RadauTableau t;
  t.start_weight = double(start_weight);
  for (int i = 0; i < s; ++i) {
    t.c[i] = double(exact.c(i));
    t.error3[i] = double(error3(i));
    t.error5[i] = double(error5(i));
    t.state_error3[i] = double(state_error3(i));
    t.state_error5[i] = double(state_error5(i));
    for (int j = 0; j < s; ++j) t.a[i][j] = double(exact.a(i, j));
  }
  return t;
}

}  // namespace

const RadauTableau& radau_tableau() {
  static const RadauTableau tableau = make_tableau();
  return tableau;
}

template <int n>
RadauCollocation<n> radau_collocation() {
  const ExactCollocation exact(n);
  RadauCollocation<n> rounded;
  for (int i = 0; i < n; ++i) {
    rounded.c[i] = double(exact.c(i));
    for (int j = 0; j < n; ++j) rounded.a[i][j] = double(exact.a(i, j));
  }
  return rounded;
}

template RadauCollocation<5> radau_collocation<5>();
template RadauCollocation<7> radau_collocation<7>();

}  // namespace wingbeat::solver

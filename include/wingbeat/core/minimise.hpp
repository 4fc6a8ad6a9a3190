// The least value of a function of one number.
#pragma once

#include <cmath>
#include <concepts>

namespace wingbeat {

struct Minimum {
  double argument;  ///< of the minimum
  double value;     ///< least value
};

/// A minimum of f between a and b > a, its place to `resolved` > 0 (a smooth f tells no more of it than the square root
/// of its own accuracy): parabolas safeguarded by golden sections (Brent, Algorithms for minimization without
/// derivatives, 1973). The ends are not asked.
template <std::invocable<double> F>
Minimum minimise(const F& f, double a, double b, double resolved) {
  constexpr double golden = 0.3819660112501051;
  double x = a + golden * (b - a), w = x, v = x;
  double fx = f(x), fw = fx, fv = fx;
  double d = 0.0, e = 0.0;
  for (int k = 0; k < 100; ++k) {
    const double mid = 0.5 * (a + b);
    const double tol = resolved + 1e-16 * std::abs(x);
    if (std::abs(x - mid) <= 2.0 * tol - 0.5 * (b - a)) break;
    bool parabola = false;
    if (std::abs(e) > tol) {
      const double r = (x - w) * (fx - fv);
      double q = (x - v) * (fx - fw);
      double p = (x - v) * q - (x - w) * r;
      q = 2.0 * (q - r);
      if (q > 0.0) p = -p;
      q = std::abs(q);
      const double before = e;
      e = d;
      if (std::abs(p) < std::abs(0.5 * q * before) && p > q * (a - x) && p < q * (b - x)) {
        d = p / q;
        const double u = x + d;
        if (u - a < 2.0 * tol || b - u < 2.0 * tol) d = x < mid ? tol : -tol;
        parabola = true;
      }
    }
    if (!parabola) {
      e = x < mid ? b - x : a - x;
      d = golden * e;
    }
    const double u = std::abs(d) >= tol ? x + d : x + (d > 0.0 ? tol : -tol);
    const double fu = f(u);
    if (fu <= fx) {
      (u < x ? b : a) = x;
      v = w, fv = fw, w = x, fw = fx, x = u, fx = fu;
    } else {
      (u < x ? a : b) = u;
      if (fu <= fw || w == x) {
        v = w, fv = fw, w = u, fw = fu;
      } else if (fu <= fv || v == x || v == w) {
        v = u, fv = fu;
      }
    }
  }
  return {x, fx};
}

}  // namespace wingbeat

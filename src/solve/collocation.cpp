#include "wingbeat/solve/collocation.hpp"

#include <array>
#include <cmath>

#include "wingbeat/core/math.hpp"

namespace wingbeat::solver {
namespace {

/// Legendre polynomials 0 .. n + 1 at t, and their derivatives.
struct Legendre {
  double value[max_collocation_intervals + 2], slope[max_collocation_intervals + 2];

  Legendre(int n, double t) {
    value[0] = 1.0, value[1] = t;
    slope[0] = 0.0, slope[1] = 1.0;
    for (int k = 1; k <= n; ++k) {
      value[k + 1] = ((2 * k + 1) * t * value[k] - k * value[k - 1]) / (k + 1);
      slope[k + 1] = slope[k - 1] + (2 * k + 1) * value[k];
    }
  }
  /// Integral of P_k from -1 to t.
  double integral(int k, double t) const { return k == 0 ? t + 1.0 : (value[k + 1] - value[k - 1]) / (2 * k + 1); }
};

CollocationRule make_rule(int n) {
  CollocationRule rule{};
  rule.intervals = n;
  double t[CollocationRule::max_points];
  for (int m = 0; m <= n; ++m) {
    // Roots of (1 - t^2) P_n'(t), by Newton's method on t P_n - P_{n-1}, which is (t^2 - 1) P_n' / n.
    t[m] = m == 0 ? -1.0 : m == n ? 1.0 : -std::cos(pi * m / n);
    for (int iteration = 0; m > 0 && m < n && iteration < 20; ++iteration) {
      const Legendre p(n, t[m]);
      t[m] -= (t[m] * p.value[n] - p.value[n - 1]) / ((n + 1) * p.value[n]);
    }
  }
  for (int j = 0; j <= n; ++j) {
    const Legendre at_node(n, t[j]);
    rule.node[j] = 0.5 * (1.0 + t[j]);
    rule.weight[j] = 1.0 / (n * (n + 1) * square(at_node.value[n]));
    // The nodes' own quadrature is exact for all products but the last one's square, whose sum is 2 / n.
    for (int k = 0; k <= n; ++k) {
      rule.legendre[k][j] = 2.0 * rule.weight[j] * at_node.value[k] * (k < n ? k + 0.5 : 0.5 * n);
    }
  }
  for (int m = 0; m <= n; ++m) {
    const Legendre here(n, t[m]), before(n, t[m > 0 ? m - 1 : 0]);
    for (int j = 0; j <= n; ++j) {
      for (int k = 0; k <= n; ++k) {
        rule.slope[m][j] += 2.0 * rule.legendre[k][j] * here.slope[k];
        if (m > 0) {
          rule.between[m][j] += 0.5 * rule.legendre[k][j] * (here.integral(k, t[m]) - before.integral(k, t[m - 1]));
        }
      }
    }
  }
  for (int m = 1; m <= n; ++m) {
    for (int j = 0; j <= n; ++j) rule.up_to[m][j] = rule.up_to[m - 1][j] + rule.between[m][j];
    for (int j = 0; j <= n; ++j) rule.mean[m][j] = rule.between[m][j] / (rule.node[m] - rule.node[m - 1]);
  }
  return rule;
}

}  // namespace

const CollocationRule& collocation_rule(int intervals) {
  static const std::array rules = [] {
    std::array<CollocationRule, max_collocation_intervals / 2> made;
    for (std::size_t n = 0; n < made.size(); ++n) made[n] = make_rule(2 * int(n) + 2);
    return made;
  }();
  return rules[std::size_t(intervals / 2 - 1)];
}

}  // namespace wingbeat::solver

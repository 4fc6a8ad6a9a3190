/// Collocation at the Lobatto points: the tables that turn a smooth subinterval of a differential equation into
/// algebra.
///
/// n + 1 nodes on [0, 1], both ends among them. The solution at the end of a subinterval, and integrals over it, are of
/// order 2 n; between the ends the polynomial through the rates is of order n + 1. (Hairer, Wanner, "Solving Ordinary
/// Differential Equations II", 2nd ed., Springer 1996, section IV.5: Lobatto IIIA.)
#pragma once

namespace wingbeat::solver {

inline constexpr int max_collocation_intervals = 16;

struct CollocationRule {
  static constexpr int max_points = max_collocation_intervals + 1;
  int intervals;                            ///< n: nodes 0 .. n
  double node[max_points];                  ///< in [0, 1], growing
  double weight[max_points];                ///< of the integral over [0, 1]
  double between[max_points][max_points];   ///< [m][j]: integral from node m - 1 to m of the polynomial that is 1 at
                                            ///< node j alone; m > 0
  double up_to[max_points][max_points];     ///< [m][j]: sum of that from node 1 to m
  double mean[max_points][max_points];      ///< [m][j]: between over the distance of the two nodes; m > 0
  double slope[max_points][max_points];     ///< [m][j]: derivative of that polynomial at node m
  double legendre[max_points][max_points];  ///< [k][j]: its coefficient of P_k(2 x - 1)
};

/// The rule with an even number of intervals, 2 to max_collocation_intervals.
const CollocationRule& collocation_rule(int intervals);

}  // namespace wingbeat::solver

/// Radau IIA collocation with any number of stages: L-stable, of order 2 n - 1 at the end of a step and of order n + 1
/// at its stages. (Hairer, Wanner, "Solving Ordinary Differential Equations II", 2nd ed., Springer 1996, section IV.5.)
#pragma once

namespace wingbeat::solver {

template <int n>
struct RadauCollocation {
  double c[n];     ///< stages in (0, 1], growing
  double a[n][n];  ///< [i][j]: integral from 0 to stage i of the polynomial that is 1 at stage j alone
};

/// Computed from the conditions that define it; for 5 and 7 stages.
template <int n>
RadauCollocation<n> radau_collocation();

extern template RadauCollocation<5> radau_collocation<5>();
extern template RadauCollocation<7> radau_collocation<7>();

}  // namespace wingbeat::solver

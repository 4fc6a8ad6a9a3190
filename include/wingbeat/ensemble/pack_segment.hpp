// Newton's step on a segment in one piece, on SIMD lanes: where disturbances decay within a part of a segment, steps
// from node to node, with a mean of what the rates are off, take many iterations.
#pragma once

#include <array>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "wingbeat/solve/collocation.hpp"

namespace wingbeat {

/// The collocation equations of a segment of length h, linear about a trajectory: what its nodes move by, d_m, when the
/// start moves by d_0 and the integrals of the rates from the start are off the trajectory by r_m:
///
///   d_m - h sum_j a_mj J_j d_j = r_m + d_0
///
/// a_mj being the integral up to node m of the polynomial that is 1 at node j alone, J_j the rates' derivative there.
/// For one state that is one matrix for all nodes. For two, the current is eliminated, whose rate falls with the
/// current at every node: with J_j = (a b; c d), E = -h d and M = 1 + a_mj E, its nodes move by M^-1 (r + h a_mj c d),
/// d being what the speed's do, whose matrix is 1 - h a_mj (a - b c / d) - Z c / d with Z M = h a_mj b. Neither matrix
/// needs an exchange of rows, because disturbances decay. Rows stay in registers while others are subtracted.
/// `known_intervals` are the rule's, or 0. Solved for r and d_0 = 0 and, where `renews`, for r = 0 and each state of
/// the start moved by 1.
template <class L, int N, int known_intervals, bool renews>
class SegmentEquations {
  static constexpr std::size_t max_intervals =
      std::size_t(known_intervals > 0 ? known_intervals : solver::max_collocation_intervals);
  static constexpr std::size_t sides = renews ? 1 + N : 1;
  using Row = std::array<L, max_intervals>;
  using Sides = std::array<L, sides>;

 public:
  using Matrix = std::array<std::array<L, N>, N>;

  /// [node - 1][state][side]: the right sides, and afterwards what the nodes move by.
  std::array<std::array<Sides, N>, max_intervals> moved;

  /// For moved[.][.][0] as it stands.
  [[gnu::always_inline]] inline void solve(const solver::CollocationRule& rule, const Matrix* jacobian, const L& h) {
    const std::size_t count = known_intervals > 0 ? max_intervals : std::size_t(rule.intervals);
    const auto each = [&](const auto& visit) __attribute__((always_inline)) { for_each_index(count, visit); };
    Row by_speed, by_current, relaxing, follows;
    for (std::size_t j = 0; j < count; ++j) {
      by_speed[j] = h * jacobian[j + 1][0][0];
      if constexpr (N == 2) {
        by_current[j] = h * jacobian[j + 1][0][1];
        relaxing[j] = -(h * jacobian[j + 1][1][1]);
        follows[j] = jacobian[j + 1][1][0] * inverse_of(jacobian[j + 1][1][1]);
      }
    }
    for (std::size_t m = 0; m < count; ++m) {
      const double* const upto = rule.up_to[m + 1];
      if constexpr (renews) {
        const L weight = L(upto[0]) * h;
        for (std::size_t n = 0; n < N; ++n) {
          for (std::size_t row = 0; row < N; ++row) {
            moved[m][row][1 + n] = L(row == n ? 1.0 : 0.0) + weight * jacobian[0][row][n];
          }
        }
      }
      if constexpr (N == 2) {
        Row row;
        each([&](auto j)
                 __attribute__((always_inline)) { row[j] = L(m == j ? 1.0 : 0.0) + L(upto[j + 1]) * relaxing[j]; });
        each([&](auto k) __attribute__((always_inline)) {
          if (k >= m) return;
          row[k] = row[k] * current_pivot_[k];
          each([&](auto j) __attribute__((always_inline)) {
            if (j > k) row[j] = row[j] - row[k] * current_[k][j];
          });
        });
        current_[m] = row;
        current_pivot_[m] = inverse_of(current_[m][m]);
      }
    }
    for (std::size_t m = 0; m < count; ++m) {
      const double* const upto = rule.up_to[m + 1];
      Row row;
      Sides right = moved[m][0];
      if constexpr (N == 1) {
        each([&](auto j)
                 __attribute__((always_inline)) { row[j] = L(m == j ? 1.0 : 0.0) - L(upto[j + 1]) * by_speed[j]; });
      } else {
        each([&](auto j) __attribute__((always_inline)) { row[j] = L(upto[j + 1]) * by_current[j]; });
        each([&](auto k) __attribute__((always_inline)) {
          row[k] = row[k] * current_pivot_[k];
          each([&](auto j) __attribute__((always_inline)) {
            if (j > k) row[j] = row[j] - row[k] * current_[k][j];
          });
        });
        each([&](auto back) __attribute__((always_inline)) {
          const std::size_t k = count - 1 - back;
          each([&](auto j) __attribute__((always_inline)) {
            if (j < k) row[j] = row[j] - row[k] * current_[k][j];
          });
        });
        for (std::size_t side = 0; side < sides; ++side) {
          each([&](auto j) __attribute__((always_inline)) { right[side] = right[side] + row[j] * moved[j][1][side]; });
        }
        each([&](auto j) __attribute__((always_inline)) {
          const L weight(upto[j + 1]);
          const L straight = L(m == j ? 1.0 : 0.0) - weight * by_speed[j];
          row[j] = straight - (row[j] - weight * by_current[j]) * follows[j];
        });
      }
      each([&](auto k) __attribute__((always_inline)) {
        if (k >= m) return;
        const L factor = row[k] * speed_pivot_[k];
        each([&](auto j) __attribute__((always_inline)) {
          if (j > k) row[j] = row[j] - factor * speed_[k][j];
        });
        for (std::size_t side = 0; side < sides; ++side) right[side] = right[side] - factor * moved[k][0][side];
      });
      speed_[m] = row;
      speed_pivot_[m] = inverse_of(speed_[m][m]);
      moved[m][0] = right;
    }
    for (std::size_t m = count; m-- > 0;) {
      Sides sum = moved[m][0];
      each([&](auto j) __attribute__((always_inline)) {
        if (j <= m) return;
        for (std::size_t side = 0; side < sides; ++side) sum[side] = sum[side] - speed_[m][j] * moved[j][0][side];
      });
      for (std::size_t side = 0; side < sides; ++side) moved[m][0][side] = sum[side] * speed_pivot_[m];
    }
    if constexpr (N == 2) {
      std::array<Sides, max_intervals> driven;
      for (std::size_t j = 0; j < count; ++j) {
        const L drives = h * jacobian[j + 1][1][0];
        for (std::size_t side = 0; side < sides; ++side) driven[j][side] = drives * moved[j][0][side];
      }
      for (std::size_t m = 0; m < count; ++m) {
        Sides sum = moved[m][1];
        each([&](auto j) __attribute__((always_inline)) {
          const L weight(rule.up_to[m + 1][j + 1]);
          for (std::size_t side = 0; side < sides; ++side) sum[side] = sum[side] + weight * driven[j][side];
        });
        each([&](auto k) __attribute__((always_inline)) {
          if (k >= m) return;
          for (std::size_t side = 0; side < sides; ++side) {
            sum[side] = sum[side] - current_[m][k] * moved[k][1][side];
          }
        });
        moved[m][1] = sum;
      }
      for (std::size_t m = count; m-- > 0;) {
        Sides sum = moved[m][1];
        each([&](auto j) __attribute__((always_inline)) {
          if (j <= m) return;
          for (std::size_t side = 0; side < sides; ++side) {
            sum[side] = sum[side] - current_[m][j] * moved[j][1][side];
          }
        });
        for (std::size_t side = 0; side < sides; ++side) moved[m][1][side] = sum[side] * current_pivot_[m];
      }
    }
  }

 private:
  /// visit(n) for n from 0 to count - 1, a constant where the number of intervals is known.
  template <class Visit>
  [[gnu::always_inline]] static inline void for_each_index(std::size_t count, const Visit& visit) {
    if constexpr (known_intervals > 0) {
      [&]<std::size_t... n>(std::index_sequence<n...>) __attribute__((always_inline)) {
        (visit(std::integral_constant<std::size_t, n>{}), ...);
      }(std::make_index_sequence<max_intervals>{});
    } else {
      for (std::size_t n = 0; n < count; ++n) visit(n);
    }
  }

  std::array<Row, max_intervals> speed_;                 ///< upper factor; the pivots' inverses aside
  std::array<Row, N == 2 ? max_intervals : 0> current_;  ///< both factors
  Row speed_pivot_, current_pivot_;
};

}  // namespace wingbeat

// Newton's step on a segment in one piece, on SIMD lanes: where disturbances decay within a part of a segment, steps
// from node to node, with a mean of what the rates are off, take many iterations.
#pragma once

#include <array>
#include <cstddef>

#include "wingbeat/solve/collocation.hpp"

namespace wingbeat {

/// The collocation equations of a segment of length h, linear about a trajectory: what its nodes move by, d_m, when the
/// start moves by d_0 and the integrals of the rates from the start are off the trajectory by r_m:
///
///   d_m - h sum_j a_mj J_j d_j = r_m + d_0
///
/// a_mj being the integral up to node m of the polynomial that is 1 at node j alone, J_j the rates' derivative there.
/// For one state that is one matrix. For two, the current is eliminated, whose rate falls with the current at every
/// node: E_j = -h J_j[1][1] > 0 and W = (1 + a E)^-1 give d_1 = W r_1 + (W - 1) (J[1][0] / J[1][1]) d_0. Neither matrix
/// needs an exchange of rows, because disturbances decay. `known_intervals` are the rule's, or 0.
template <class L, int N, int known_intervals>
class SegmentEquations {
  static constexpr std::size_t most =
      std::size_t(known_intervals > 0 ? known_intervals : solver::max_collocation_intervals);

 public:
  using Matrix = std::array<std::array<L, N>, N>;
  using State = std::array<L, N>;
  using Column = std::array<State, most>;  ///< of the nodes but the first

  SegmentEquations(const solver::CollocationRule& rule, const Matrix* jacobian, const L& h)
      : rule_(rule), jacobian_(jacobian), h_(h) {
    if constexpr (N == 2) eliminate_current();
    for (std::size_t m = 0; m < nodes(); ++m) {
      const auto weight = [&](std::size_t j) { return L(rule_.up_to[m + 1][j + 1]); };
      for (std::size_t k = 0; k < nodes(); ++k) {
        L sum;
        if constexpr (N == 1) {
          sum = weight(k) * jacobian_[k + 1][0][0];
        } else {
          sum = weight(k) * jacobian_[k + 1][0][0];
          for (std::size_t j = 0; j < nodes(); ++j) {
            sum = sum + weight(j) * through_current_[at(j, k)];
          }
        }
        speed_[at(m, k)] = L(m == k ? 1.0 : 0.0) - h_ * sum;
      }
    }
    factor_speed();
  }

  /// r := d, for d_0 = 0.
  void solve(Column& r) const {
    if constexpr (N == 2) {
      Column own = r;
      for (std::size_t m = 0; m < nodes(); ++m) {
        L sum(0.0);
        for (std::size_t j = 0; j < nodes(); ++j) sum = sum + relaxed_[at(m, j)] * own[j][1];
        r[m][1] = sum;
      }
      for (std::size_t m = 0; m < nodes(); ++m) own[m][1] = jacobian_[m + 1][0][1] * r[m][1];
      for (std::size_t m = 0; m < nodes(); ++m) {
        L sum(0.0);
        for (std::size_t j = 0; j < nodes(); ++j) sum = sum + L(rule_.up_to[m + 1][j + 1]) * own[j][1];
        r[m][0] = own[m][0] + h_ * sum;
      }
    }
    for (std::size_t m = 1; m < nodes(); ++m) {
      L sum = r[m][0];
      for (std::size_t j = 0; j < m; ++j) sum = sum - speed_[at(m, j)] * r[j][0];
      r[m][0] = sum;
    }
    for (std::size_t m = nodes(); m-- > 0;) {
      L sum = r[m][0];
      for (std::size_t j = m + 1; j < nodes(); ++j) sum = sum - speed_[at(m, j)] * r[j][0];
      r[m][0] = sum * speed_[at(m, m)];
    }
    if constexpr (N == 2) {
      for (std::size_t m = 0; m < nodes(); ++m) {
        L sum = r[m][1] - follows_[m] * r[m][0];
        for (std::size_t j = 0; j < nodes(); ++j) sum = sum + relaxed_[at(m, j)] * (follows_[j] * r[j][0]);
        r[m][1] = sum;
      }
    }
  }

  /// What the nodes move by where state n of the start moves by 1.
  void from_start(std::size_t n, Column& d) const {
    for (std::size_t m = 0; m < nodes(); ++m) {
      const L weight = L(rule_.up_to[m + 1][0]) * h_;
      for (std::size_t row = 0; row < N; ++row) {
        d[m][row] = L(row == n ? 1.0 : 0.0) + weight * jacobian_[0][row][n];
      }
    }
    solve(d);
  }

 private:
  std::size_t nodes() const { return known_intervals > 0 ? most : std::size_t(rule_.intervals); }
  std::size_t at(std::size_t m, std::size_t j) const { return m * nodes() + j; }

  void eliminate_current() {
    for (std::size_t m = 0; m < nodes(); ++m) {
      for (std::size_t j = 0; j < nodes(); ++j) {
        relaxed_[at(m, j)] =
            L(m == j ? 1.0 : 0.0) - L(rule_.up_to[m + 1][j + 1]) * h_ * jacobian_[j + 1][1][1];
      }
    }
    for (std::size_t k = 0; k < nodes(); ++k) {
      const L pivot = inverse_of(relaxed_[at(k, k)]);
      relaxed_[at(k, k)] = L(1.0);
      for (std::size_t j = 0; j < nodes(); ++j) relaxed_[at(k, j)] = relaxed_[at(k, j)] * pivot;
      for (std::size_t m = 0; m < nodes(); ++m) {
        if (m == k) continue;
        const L factor = relaxed_[at(m, k)];
        relaxed_[at(m, k)] = L(0.0);
        for (std::size_t j = 0; j < nodes(); ++j) {
          relaxed_[at(m, j)] = relaxed_[at(m, j)] - factor * relaxed_[at(k, j)];
        }
      }
    }
    for (std::size_t k = 0; k < nodes(); ++k) {
      follows_[k] = jacobian_[k + 1][1][0] * inverse_of(jacobian_[k + 1][1][1]);
    }
    for (std::size_t m = 0; m < nodes(); ++m) {
      const L by_current = jacobian_[m + 1][0][1];
      for (std::size_t k = 0; k < nodes(); ++k) {
        const L relaxed = m == k ? relaxed_[at(m, k)] - L(1.0) : relaxed_[at(m, k)];
        through_current_[at(m, k)] = by_current * relaxed * follows_[k];
      }
    }
  }

  /// Lower and upper factor in place, with inverse pivots.
  void factor_speed() {
    for (std::size_t k = 0; k < nodes(); ++k) {
      const L pivot = inverse_of(speed_[at(k, k)]);
      speed_[at(k, k)] = pivot;
      for (std::size_t m = k + 1; m < nodes(); ++m) {
        const L factor = speed_[at(m, k)] * pivot;
        speed_[at(m, k)] = factor;
        for (std::size_t j = k + 1; j < nodes(); ++j) {
          speed_[at(m, j)] = speed_[at(m, j)] - factor * speed_[at(k, j)];
        }
      }
    }
  }

  const solver::CollocationRule& rule_;
  const Matrix* jacobian_;  ///< at all nodes
  L h_;
  static constexpr std::size_t of_current = N == 2 ? most : 0;
  std::array<L, most * most> speed_;
  std::array<L, of_current * of_current> relaxed_, through_current_;  ///< W; J[0][1] (W - 1) J[1][0] / J[1][1]
  std::array<L, of_current> follows_;                                 ///< J[1][0] / J[1][1]
};

}  // namespace wingbeat

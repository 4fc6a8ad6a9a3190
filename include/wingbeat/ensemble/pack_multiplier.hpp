// The return map's derivative on SIMD lanes: products of propagators, what closes an iterate, Floquet multipliers.
#pragma once

#include <algorithm>

#include "wingbeat/ensemble/pack_orbit.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {

/// exp(h jacobian) by its (1, 1) Pade approximation (1 - z)^-1 (1 + z), z = h jacobian / 2.
template <class L, int N>
void PackOrbit<L, N>::propagator(const Matrix& jacobian, const L& h, Matrix& out) {
  const L half_h = L(0.5) * h;
  if constexpr (N == 1) {
    out[0][0] = L(2.0) * inverse_of(L(L(1.0) - half_h * jacobian[0][0])) - L(1.0);
  } else {
    const L z01 = half_h * jacobian[0][1], z10 = half_h * jacobian[1][0];
    const L p = L(1.0) - half_h * jacobian[0][0], q = L(1.0) - half_h * jacobian[1][1];
    const L twice_per_det = L(2.0) * inverse_of(L(p * q - z01 * z10));
    out[0][0] = q * twice_per_det - L(1.0);
    out[0][1] = z01 * twice_per_det;
    out[1][0] = z10 * twice_per_det;
    out[1][1] = p * twice_per_det - L(1.0);
  }
}

/// product := step product.
template <class L, int N>
void PackOrbit<L, N>::append(const Matrix& step, Matrix& product) {
  const Matrix before = product;
  for (std::size_t row = 0; row < N; ++row) {
    for (std::size_t column = 0; column < N; ++column) {
      L sum = step[row][0] * before[0][column];
      if constexpr (N == 2) sum = sum + step[row][1] * before[1][column];
      product[row][column] = sum;
    }
  }
}

/// Largest modulus of the eigenvalues.
template <class L, int N>
L PackOrbit<L, N>::largest_modulus(const Matrix& M) {
  if constexpr (N == 1) {
    return abs(M[0][0]);
  } else {
    const L mean = L(0.5) * (M[0][0] + M[1][1]), half_difference = L(0.5) * (M[0][0] - M[1][1]);
    const L discriminant = square(half_difference) + M[0][1] * M[1][0];
    const L determinant = M[0][0] * M[1][1] - M[0][1] * M[1][0];
    const L real = abs(mean) + sqrt(max(discriminant, L(0.0)));
    return select<L>(discriminant >= L(0.0), real, sqrt(max(determinant, L(0.0))));
  }
}

/// off := (1 - M)^-1 off: what an iterate's start must move by for its end to meet it, the end being off it by so much.
template <class L, int N>
void PackOrbit<L, N>::close_iterate(State& off) const {
  const auto& M = monodromy_;
  if constexpr (N == 1) {
    off[0] = off[0] * inverse_of(L(L(1.0) - M[0][0]));
  } else {
    const L p = L(1.0) - M[0][0], q = L(1.0) - M[1][1];
    const L per_det = inverse_of(L(p * q - M[0][1] * M[1][0]));
    const L d0 = off[0], d1 = off[1];
    off[0] = (q * d0 + M[0][1] * d1) * per_det;
    off[1] = (M[1][0] * d0 + p * d1) * per_det;
  }
}

/// Derivatives by the state of the rates at a node of the orbit; behind a small inductance they see the
/// lag of the current.
template <class L, int N>
auto PackOrbit<L, N>::jacobian_at_node(System system, std::size_t node, const L& force) const -> Matrix {
  const Configuration<L>& configuration = configuration_of(node);
  solver::Rates<System> below, above;
  Matrix jacobian;
  if (!lags_) {
    linearise(system, node, force, below, jacobian);
    return jacobian;
  }
  system.inductive_drop = inductive_drop_[node];
  const L by = L(1e-4) * trajectory_[node][0];
  State moved = trajectory_[node];
  moved[0] = moved[0] - by;
  evaluate<false>(system, configuration, moved, force, below);
  moved[0] = trajectory_[node][0] + by;
  evaluate<false>(system, configuration, moved, force, above);
  lag_with(system, node, by, force, below, above);
  for (auto& row : jacobian) row.fill(L(0.0));
  jacobian[0][0] = (above.dy[0] - below.dy[0]) * L(0.5) * inverse_of(by);
  return jacobian;
}

/// Derivative of the state at a segment's end by that at its start, from the rates' derivatives at its nodes.
template <class L, int N>
auto PackOrbit<L, N>::over_segment(const Matrix* jacobian, const L& h) const -> Matrix {
  SegmentEquations<L, N, 0, true> equations;
  for (auto& node : equations.moved) {
    for (auto& state : node) state[0] = L(0.0);
  }
  equations.solve(rule_, jacobian, h);
  Matrix step;
  for (std::size_t row = 0; row < N; ++row) {
    for (std::size_t n = 0; n < N; ++n) {
      step[row][n] = equations.moved[std::size_t(rule_.intervals - 1)][row][1 + n];
    }
  }
  return step;
}

/// The largest modulus of the eigenvalues of the return map's derivative, by collocation of the variational equation.
template <class L, int N>
L PackOrbit<L, N>::floquet_multiplier() {
  const std::size_t intervals = std::size_t(rule_.intervals);
  Matrix M;
  for (std::size_t row = 0; row < N; ++row) {
    for (std::size_t column = 0; column < N; ++column) M[row][column] = L(row == column ? 1.0 : 0.0);
  }
  std::array<Matrix, nodes_per_segment> jacobian, path;
  for (int half = 0; half < 2; ++half) {
    System system = half_cycle(half);
    const HalfMesh<L>& mesh = mesh_[std::size_t(half)];
    for (std::size_t s = 0; s < std::size_t(segments_); ++s) {
      const std::size_t base = first_node(half, s);
      const L h = mesh.u[s + 1] - mesh.u[s];
      if (kinks_) system.choose_side(mesh.kink[s], mesh.force[s]);
      Matrix end_before = jacobian[intervals];
      for (std::size_t m = 0; m <= intervals; ++m) {
        jacobian[m] = jacobian_at_node(system, base + m, mesh.force[s]);
        if (m == 0) {
          // What newton_iteration() corrects by grows with the square of the distance, its derivative with the
          // distance.
          const L& off = off_[std::size_t(half * segments_) + s];
          if (any<L>(!(off == L(0.0)))) {
            for (std::size_t row = 0; row < N; ++row) {
              for (std::size_t column = 0; column < N; ++column) {
                const L jump = off * (end_before[row][column] - jacobian[0][row][column]);
                end_before[row][column] = select<L>(off == L(0.0), L(0.0), -jump);
              }
              end_before[row][row] = end_before[row][row] + L(1.0);
            }
            append(end_before, M);
          }
          path[0] = M;
          continue;
        }
        if (in_one_piece_) continue;
        path[m] = path[m - 1];
        append(step_[base + m], path[m]);
      }
      if (in_one_piece_) {
        append(over_segment(jacobian.data(), h), M);
        continue;
      }
      // As propose() corrects the trajectory.
      for (int repeat = 0; repeat < std::max(2, settings_.newton_iterations - 1); ++repeat) {
        std::array<Matrix, nodes_per_segment> rates, off;
        for (std::size_t m = 0; m <= intervals; ++m) {
          rates[m] = path[m];
          append(jacobian[m], rates[m]);
        }
        for (auto& row : off[0]) row.fill(L(0.0));
        for (std::size_t m = 1; m <= intervals; ++m) {
          for (std::size_t row = 0; row < N; ++row) {
            for (std::size_t column = 0; column < N; ++column) {
              L integral(0.0);
              for (std::size_t j = 0; j <= intervals; ++j) {
                integral = integral + L(rule_.between[m][j]) * rates[j][row][column];
              }
              off[m][row][column] =
                  off[m - 1][row][column] + (h * integral - (path[m][row][column] - path[m - 1][row][column]));
            }
          }
        }
        const Mask smooth = resolves(base);
        Matrix move = off[0];
        for (std::size_t m = 1; m <= intervals; ++m) {
          Matrix mean;
          for (std::size_t row = 0; row < N; ++row) {
            for (std::size_t column = 0; column < N; ++column) {
              L sum(0.0);
              for (std::size_t j = 1; j <= intervals; ++j) sum = sum + L(rule_.mean[m][j]) * off[j][row][column];
              mean[row][column] = select<L>(smooth, sum, L(0.5) * (off[m - 1][row][column] + off[m][row][column]));
              move[row][column] = move[row][column] + (mean[row][column] - off[m - 1][row][column]);
            }
          }
          append(step_[base + m], move);
          for (std::size_t row = 0; row < N; ++row) {
            for (std::size_t column = 0; column < N; ++column) {
              move[row][column] = move[row][column] + (off[m][row][column] - mean[row][column]);
              path[m][row][column] = path[m][row][column] + move[row][column];
            }
          }
        }
      }
      M = path[intervals];
    }
  }
  return largest_modulus(M);
}

}  // namespace wingbeat

// One step of the implicit Radau IIA method with five stages, order 9: for stiff iterates (small inductance, light
// rotor).
//
// E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", 2nd ed., Springer 1996, sections IV.5 and IV.8.
// The tableau is computed from the conditions that define it (src/solve/radau.cpp); tests/solve measures its order.
#pragma once

#include <array>
#include <cmath>
#include <tuple>

#include "wingbeat/core/scalar.hpp"
#include "wingbeat/solve/explicit_step.hpp"
#include "wingbeat/solve/linear.hpp"

namespace wingbeat::solver {

struct RadauTableau {
  static constexpr int stages = 5;
  static constexpr int order = 9;
  double c[stages];
  double a[stages][stages];  ///< the last row holds the weights
  double start_weight;       ///< of the derivative at the step's start in the embedded formula
  double error[stages];      ///< embedded (order 5) minus Radau weights
};

const RadauTableau& radau_tableau();

/// One step of the implicit method; arguments and result as explicit_step. Not admissible where the stage equations do
/// not converge: the caller takes a shorter step.
template <bool quadratures, class System>
StepResult<System> implicit_step(const System& system, const typename System::Real& x, const typename System::State& y,
                                 const typename System::Real& h, const typename System::Signs& branch,
                                 const Rates<System>& first) {
  using Real = typename System::Real;
  using State = typename System::State;
  constexpr std::size_t states = std::tuple_size_v<State>;
  constexpr std::size_t stages = RadauTableau::stages;
  constexpr std::size_t unknowns = states * stages;
  const RadauTableau& tableau = radau_tableau();
  const double step = value_of(h);

  StepResult<System> result;
  result.admissible = false;

  // Jacobian of the rates at the step's start, by differences: Newton's limit does not depend on it.
  double jacobian[states][states];
  for (std::size_t n = 0; n < states; ++n) {
    State moved = y;
    const double delta = 1e-7 * value_of(system.error_scale(y)[n]);
    moved[n] = moved[n] + Real(delta);
    const Rates<System> rates = system.template rates<false>(x, moved, branch);
    for (std::size_t row = 0; row < states; ++row) {
      jacobian[row][n] = (value_of(rates.dy[row]) - value_of(first.dy[row])) / delta;
    }
  }

  std::array<State, stages> stage, slope;
  std::array<Rates<System>, stages> rates;
  for (std::size_t i = 0; i < stages; ++i) stage[i] = y;
  double inverse[unknowns * unknowns];
  for (std::size_t row = 0; row < unknowns; ++row) {
    for (std::size_t column = 0; column < unknowns; ++column) {
      inverse[row * unknowns + column] = (row == column ? 1.0 : 0.0) - step * tableau.a[row / states][column / states] *
                                                                           jacobian[row % states][column % states];
    }
  }
  if (!invert(int(unknowns), inverse)) return result;

  int converged_at = -1;
  double before = 0.0;
  for (int iteration = 0; iteration < 40; ++iteration) {
    for (std::size_t i = 0; i < stages; ++i) {
      if (!system.admissible(stage[i])) return result;
      rates[i] = system.template rates<quadratures>(x + Real(tableau.c[i]) * h, stage[i], branch);
      slope[i] = rates[i].dy;
    }
    std::array<Real, unknowns> residual;
    for (std::size_t i = 0; i < stages; ++i) {
      for (std::size_t n = 0; n < states; ++n) {
        Real sum = Real(tableau.a[i][0]) * slope[0][n];
        for (std::size_t j = 1; j < stages; ++j) sum = sum + Real(tableau.a[i][j]) * slope[j][n];
        residual[i * states + n] = stage[i][n] - y[n] - h * sum;
      }
    }
    double change = 0.0;
    for (std::size_t row = 0; row < unknowns; ++row) {
      Real update = Real(inverse[row * unknowns]) * residual[0];
      for (std::size_t column = 1; column < unknowns; ++column) {
        update = update + Real(inverse[row * unknowns + column]) * residual[column];
      }
      Real& at = stage[row / states][row % states];
      at = at - update;
      // Written so that a NaN stays.
      const double moved = std::abs(value_of(update)) / value_of(system.error_scale(y)[row % states]);
      if (!(moved <= change)) change = moved;
    }
    if (!std::isfinite(change)) return result;
    // Derivatives inside a dual number converge as fast as the values, a few iterations behind.
    const bool settled = change < 1e-15 || (iteration > 2 && change < 1e-12 && change > 0.3 * before);
    if (converged_at < 0 && settled) converged_at = iteration;
    if (converged_at >= 0 && (std::is_same_v<Real, double> || iteration >= 2 * converged_at + 2)) break;
    if (iteration > 2 && change > 0.8 * before && change > 1e-12) return result;
    before = change;
  }
  if (converged_at < 0) return result;

  for (std::size_t w = 0; w < result.lowest.size(); ++w) {
    result.lowest[w] = rates[0].switches[w] * branch[w];
    for (std::size_t j = 1; j < stages; ++j) {
      const Real signed_switch = rates[j].switches[w] * branch[w];
      result.lowest[w] = select(signed_switch < result.lowest[w], signed_switch, result.lowest[w]);
    }
  }
  result.y = stage[stages - 1];
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < result.dq.size(); ++q) {
      Real sum = Real(0.0), error = Real(tableau.start_weight) * first.dq[q];
      for (std::size_t j = 0; j < stages; ++j) {
        sum = sum + Real(tableau.a[stages - 1][j]) * rates[j].dq[q];
        error = error + Real(tableau.error[j]) * rates[j].dq[q];
      }
      result.dq[q] = h * sum;
      result.integral_error3[q] = Real(0.0);
      result.integral_error5[q] = h * error;
    }
  }
  // Error of the embedded formula, stiff components damped by (I - h start_weight Jacobian)^-1.
  double matrix[states * states], error[states];
  for (std::size_t row = 0; row < states; ++row) {
    error[row] = tableau.start_weight * value_of(first.dy[row]);
    for (std::size_t j = 0; j < stages; ++j) error[row] += tableau.error[j] * value_of(slope[j][row]);
    error[row] *= step;
    for (std::size_t column = 0; column < states; ++column) {
      matrix[row * states + column] = (row == column ? 1.0 : 0.0) - step * tableau.start_weight * jacobian[row][column];
    }
  }
  if (!solve_linear(int(states), matrix, error)) return result;
  for (std::size_t n = 0; n < states; ++n) {
    result.error3[n] = Real(0.0);
    result.error5[n] = Real(error[n]);
  }
  result.admissible = system.admissible(result.y);
  return result;
}

}  // namespace wingbeat::solver

// One step of the implicit Radau IIA method with five stages, order 9: for stiff iterates (small inductance, light
// rotor).
//
// E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", 2nd ed., Springer 1996, sections IV.5 and IV.8.
// The tableau is computed from the conditions that define it (src/solve/radau.cpp); tests/solve measures its order.
#pragma once

#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/solve/explicit_step.hpp"
#include "wingbeat/solve/linear.hpp"

namespace wingbeat::solver {

struct RadauTableau {
  static constexpr int stages = 5;
  static constexpr int order = 9;
  /// Of the error estimate that the driver makes of both embedded formulas.
  static constexpr int error_order = 8;
  double c[stages];
  double a[stages][stages];  ///< the last row holds the weights
  double start_weight;       ///< of the derivative at the step's start in the embedded formula of order 5
  double error3[stages];     ///< embedded formula of order 3, of every other stage, minus Radau weights
  double error5[stages];     ///< embedded formula of order 5 minus Radau weights
  // Likewise for what the stages' states are off the step's start by, in the place of h times their rates.
  double state_error3[stages];
  double state_error5[stages];
};

const RadauTableau& radau_tableau();

namespace detail {

template <class System>
inline constexpr std::size_t state_count = std::tuple_size_v<typename System::State>;
/// Derivatives of the rates by the states, row-major.
template <class System>
using StateJacobian = std::array<double, state_count<System> * state_count<System>>;
/// What belongs to each of the stages of a step.
template <class T>
using AtStages = std::array<T, RadauTableau::stages>;

/// Where the stages of a step from x are, as the system's rates() take it: all that depends on x alone is the same in
/// every iteration.
template <class System>
auto configurations_of_stages(const System& system, double x, double h) {
  const RadauTableau& tableau = radau_tableau();
  if constexpr (requires { system.configurations(x, h, tableau.c); }) {
    return system.configurations(x, h, tableau.c);
  } else {
    AtStages<double> configurations;
    for (std::size_t i = 0; i < configurations.size(); ++i) configurations[i] = x + tableau.c[i] * h;
    return configurations;
  }
}

/// By differences from the rates dy at y: what Newton's method converges to does not depend on their error.
template <class System, class Place>
StateJacobian<System> jacobian_by_differences(const System& system, const Place& x, const typename System::State& y,
                                              const typename System::State& scale, const typename System::Signs& branch,
                                              const typename System::State& dy) {
  constexpr std::size_t states = state_count<System>;
  StateJacobian<System> jacobian;
  for (std::size_t n = 0; n < states; ++n) {
    typename System::State moved = y;
    const double delta = 1e-7 * scale[n];
    moved[n] += delta;
    const Rates<System> rates = system.template rates<false>(x, moved, branch);
    for (std::size_t row = 0; row < states; ++row) {
      jacobian[row * states + n] = (rates.dy[row] - dy[row]) / delta;
    }
  }
  return jacobian;
}

/// I - h A x J of the stage equations, J that of each stage; stage by stage, state by state.
template <std::size_t states>
class StageMatrix {
 public:
  static constexpr std::size_t stages = RadauTableau::stages, unknowns = stages * states;

  /// False where it is singular.
  bool set(double h, const AtStages<std::array<double, states * states>>& jacobians) {
    const RadauTableau& tableau = radau_tableau();
    for (std::size_t j = 0; j < stages; ++j) {
      for (std::size_t i = 0; i < stages; ++i) {
        const double by = -h * tableau.a[i][j];
        for (std::size_t k = 0; k < states * states; ++k) {
          const std::size_t row = i * states + k / states, column = j * states + k % states;
          factors_[column * unknowns + row] = by * jacobians[j][k] + (row == column ? 1.0 : 0.0);
        }
      }
    }
    if (!factorise(int(unknowns), factors_, pivots_)) return false;
    for (std::size_t k = 0; k < unknowns; ++k) per_diagonal_[k] = 1.0 / factors_[k * unknowns + k];
    return true;
  }

  /// Solves for a right-hand side of numbers or of vectors.
  template <class T>
  void solve(std::array<T, unknowns>& x) const {
    for (std::size_t k = 0; k < unknowns; ++k) {
      if (std::size_t(pivots_[k]) != k) std::swap(x[k], x[std::size_t(pivots_[k])]);
    }
    // Unrolled: loops this short cost more than what they do.
#pragma GCC unroll 10
    for (std::size_t k = 0; k < unknowns; ++k) {
#pragma GCC unroll 10
      for (std::size_t row = k + 1; row < unknowns; ++row) x[row] -= factors_[k * unknowns + row] * x[k];
    }
#pragma GCC unroll 10
    for (std::size_t n = 0; n < unknowns; ++n) {
      const std::size_t k = unknowns - 1 - n;
      x[k] *= per_diagonal_[k];
#pragma GCC unroll 10
      for (std::size_t row = 0; row < k; ++row) x[row] -= factors_[k * unknowns + row] * x[k];
    }
  }

 private:
  double factors_[unknowns * unknowns];  ///< as factorise() leaves them
  double per_diagonal_[unknowns];
  int pivots_[unknowns];
};

/// What the states at the stages miss the stage equations by, for the rates dy there.
template <class State>
auto stage_residuals(const State& y, double h, const AtStages<State>& stage, const AtStages<State>& dy) {
  constexpr std::size_t states = std::tuple_size_v<State>, stages = RadauTableau::stages;
  const RadauTableau& tableau = radau_tableau();
  std::array<double, states * stages> residual;
  for (std::size_t i = 0; i < stages; ++i) {
    for (std::size_t n = 0; n < states; ++n) {
      double sum = tableau.a[i][0] * dy[0][n];
      for (std::size_t j = 1; j < stages; ++j) sum += tableau.a[i][j] * dy[j][n];
      residual[i * states + n] = stage[i][n] - y[n] - h * sum;
    }
  }
  return residual;
}

/// Subtracts Newton's update; its largest part, over the scale of the states. A NaN stays.
template <class State, std::size_t unknowns>
double move_stages(const std::array<double, unknowns>& update, const State& scale, AtStages<State>& stage) {
  constexpr std::size_t states = std::tuple_size_v<State>;
  double change = 0.0;
  for (std::size_t row = 0; row < unknowns; ++row) {
    stage[row / states][row % states] -= update[row];
    const double moved = std::abs(update[row]) / scale[row % states];
    if (!(moved <= change)) change = moved;
  }
  return change;
}

/// The states at the stages of a step from (x, y), where the rates are `dy`, by Newton's method; `configurations` is
/// where the stages are. `jacobian` becomes that at the start, `rates` those of the last iteration, without integrands.
/// False where it does not converge or leaves the admissible region.
template <class System, class Configurations>
bool solve_stages(const System& system, double x, const Configurations& configurations, const typename System::State& y,
                  double h, const typename System::Signs& branch, const typename System::State& dy,
                  StateJacobian<System>& jacobian, AtStages<typename System::State>& stage,
                  AtStages<Rates<System>>& rates) {
  using State = typename System::State;
  constexpr std::size_t stages = RadauTableau::stages;
  const State scale = system.error_scale(y);

  jacobian = jacobian_by_differences(system, x, y, scale, branch, dy);
  AtStages<StateJacobian<System>> jacobians;
  jacobians.fill(jacobian);
  StageMatrix<state_count<System>> matrix;
  if (!matrix.set(h, jacobians)) return false;
  stage.fill(y);

  double before = 0.0, rate = 1.0;
  int renewed = 0;
  for (int iteration = 0; iteration < 40; ++iteration) {
    AtStages<State> slope;
    for (std::size_t i = 0; i < stages; ++i) {
      if (!system.admissible(stage[i])) return false;
      rates[i] = system.template rates<false>(configurations[i], stage[i], branch);
      slope[i] = rates[i].dy;
    }
    // The Jacobian changes along the step: taken at the stages, where they are known roughly, it saves iterations.
    if ((iteration == 1 && before > 1e-7) || (iteration > 1 && rate > 0.1 && before > 1e-10 && renewed < 4)) {
      ++renewed;
      for (std::size_t i = 0; i < stages; ++i) {
        jacobians[i] = jacobian_by_differences(system, configurations[i], stage[i], scale, branch, slope[i]);
      }
      if (!matrix.set(h, jacobians)) return false;
    }
    auto update = stage_residuals(y, h, stage, slope);
    matrix.solve(update);
    const double change = move_stages(update, scale, stage);
    if (!std::isfinite(change)) return false;
    rate = iteration > 0 ? change / before : 1.0;
    // What is left is the next change.
    const bool next_is_rounding = rate < 0.1 && rate * change < 1e-15;
    if (change < 1e-15 || next_is_rounding || (iteration > 2 && change < 1e-12 && rate > 0.3)) {
      for (const State& state : stage) {
        if (!system.admissible(state)) return false;
      }
      return true;
    }
    if (iteration > 2 && rate > 0.8 && change > 1e-12) return false;
    before = change;
  }
  return false;
}

/// Least switch times its sign over the stages.
template <class System>
typename System::Switches lowest_switches(const AtStages<Rates<System>>& rates, const typename System::Signs& branch) {
  typename System::Switches lowest;
  for (std::size_t w = 0; w < lowest.size(); ++w) {
    lowest[w] = rates[0].switches[w] * branch[w];
    for (std::size_t j = 1; j < rates.size(); ++j) {
      const typename System::Real signed_switch = rates[j].switches[w] * branch[w];
      lowest[w] = select(signed_switch < lowest[w], signed_switch, lowest[w]);
    }
  }
  return lowest;
}

}  // namespace detail

/// One step of the implicit method; arguments and result as explicit_step. Not admissible where the stage equations do
/// not converge: the caller takes a shorter step.
template <bool quadratures, class System>
StepResult<System> implicit_step(const System& system, double x, const typename System::State& y, double h,
                                 const typename System::Signs& branch, const Rates<System>& first) {
  constexpr std::size_t states = detail::state_count<System>, stages = RadauTableau::stages;
  const RadauTableau& tableau = radau_tableau();

  StepResult<System> result;
  result.admissible = false;
  detail::StateJacobian<System> jacobian;
  detail::AtStages<typename System::State> stage;
  detail::AtStages<Rates<System>> rates;
  const auto configurations = detail::configurations_of_stages(system, x, h);
  if (!detail::solve_stages(system, x, configurations, y, h, branch, first.dy, jacobian, stage, rates)) return result;

  result.stages = stage;
  result.lowest = detail::lowest_switches<System>(rates, branch);
  result.y = stage[stages - 1];
  result.end = configurations[stages - 1];
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < result.dq.size(); ++q) {
      result.dq[q] = 0.0;
      result.integral_error3[q] = 0.0;
      result.integral_error5[q] = tableau.start_weight * first.dq[q];
    }
    for (std::size_t j = 0; j < stages; ++j) {
      rates[j] = system.template rates<true>(configurations[j], stage[j], branch);
      for (std::size_t q = 0; q < result.dq.size(); ++q) {
        result.dq[q] += tableau.a[stages - 1][j] * rates[j].dq[q];
        result.integral_error3[q] += tableau.error3[j] * rates[j].dq[q];
        result.integral_error5[q] += tableau.error5[j] * rates[j].dq[q];
      }
    }
    for (std::size_t q = 0; q < result.dq.size(); ++q) {
      result.dq[q] *= h;
      result.integral_error3[q] *= h;
      result.integral_error5[q] *= h;
    }
  }
  // Errors of the embedded formulas, stiff components damped by (I - h start_weight Jacobian)^-1.
  double matrix[states * states], error3[states], error5[states];
  for (std::size_t row = 0; row < states; ++row) {
    error3[row] = 0.0;
    error5[row] = h * tableau.start_weight * first.dy[row];
    for (std::size_t j = 0; j < stages; ++j) {
      error3[row] += tableau.state_error3[j] * (stage[j][row] - y[row]);
      error5[row] += tableau.state_error5[j] * (stage[j][row] - y[row]);
    }
    for (std::size_t column = 0; column < states; ++column) {
      const std::size_t entry = row * states + column;
      matrix[entry] = (row == column ? 1.0 : 0.0) - h * tableau.start_weight * jacobian[entry];
    }
  }
  if (!invert(int(states), matrix)) return result;
  for (std::size_t row = 0; row < states; ++row) {
    result.error3[row] = result.error5[row] = 0.0;
    for (std::size_t n = 0; n < states; ++n) {
      result.error3[row] += matrix[row * states + n] * error3[n];
      result.error5[row] += matrix[row * states + n] * error5[n];
    }
  }
  result.admissible = true;
  return result;
}

/// implicit_step() with derivatives: `jets` is `system` on dual numbers, whose derivatives come along as those of x, y
/// and h do. The stages are found on plain numbers; their derivatives follow from the stage equations, which are linear
/// in them (implicit function theorem). `near`: states at the stages of (nearly) this step, where they are known. Gives
/// no error estimates.
template <bool quadratures, class Jets, class System>
StepResult<Jets> implicit_step(const Jets& jets, const System& system, const typename Jets::Real& x,
                               const typename Jets::State& y, const typename Jets::Real& h,
                               const typename Jets::Signs& branch,
                               const detail::AtStages<typename System::State>* near = nullptr) {
  using Real = typename Jets::Real;
  using State = typename System::State;
  constexpr std::size_t states = detail::state_count<System>, stages = RadauTableau::stages;
  constexpr std::size_t unknowns = states * stages;
  constexpr int slots = Real::DIMENSION;
  const RadauTableau& tableau = radau_tableau();

  StepResult<Jets> result;
  result.admissible = false;
  State start;
  for (std::size_t n = 0; n < states; ++n) start[n] = y[n].a;
  typename System::Signs signs;
  for (std::size_t k = 0; k < signs.size(); ++k) signs[k] = branch[k].a;
  detail::AtStages<State> stage;
  if (near) {
    stage = *near;
  } else {
    const Rates<System> first = system.template rates<false>(x.a, start, signs);
    detail::StateJacobian<System> of_start;
    detail::AtStages<Rates<System>> last;
    const auto configurations = detail::configurations_of_stages(system, x.a, h.a);
    if (!detail::solve_stages(system, x.a, configurations, start, h.a, signs, first.dy, of_start, stage, last))
      return result;
  }

  // The rates by the states, with which Newton's method goes on where the stages are not yet exact.
  const auto by_state = system.template cast<Jet<int(states)>>();
  using ByState = std::remove_const_t<decltype(by_state)>;
  using Partial = typename ByState::Real;
  const State scale = system.error_scale(start);
  detail::AtStages<Rates<ByState>> partial;
  detail::StageMatrix<states> matrix;
  typename ByState::Signs signs_by_state;
  for (std::size_t k = 0; k < signs.size(); ++k) signs_by_state[k] = Partial(signs[k]);
  double change = HUGE_VAL;
  for (int iteration = 0; iteration < 20 && change > 1e-13; ++iteration) {
    detail::AtStages<detail::StateJacobian<System>> jacobians;
    detail::AtStages<State> slope;
    for (std::size_t i = 0; i < stages; ++i) {
      if (!system.admissible(stage[i])) return result;
      typename ByState::State moving;
      for (std::size_t n = 0; n < states; ++n) moving[n] = Partial(stage[i][n], int(n));
      partial[i] = by_state.template rates<quadratures>(Partial(x.a + tableau.c[i] * h.a), moving, signs_by_state);
      for (std::size_t n = 0; n < states; ++n) {
        slope[i][n] = partial[i].dy[n].a;
        for (std::size_t k = 0; k < states; ++k) jacobians[i][n * states + k] = partial[i].dy[n].v[Eigen::Index(k)];
      }
    }
    if (!matrix.set(h.a, jacobians)) return result;
    auto update = detail::stage_residuals(start, h.a, stage, slope);
    matrix.solve(update);
    change = detail::move_stages(update, scale, stage);
  }
  if (!(change <= 1e-13)) return result;

  // The rates at given states.
  detail::AtStages<Rates<Jets>> rates;
  for (std::size_t i = 0; i < stages; ++i) {
    typename Jets::State given;
    for (std::size_t n = 0; n < states; ++n) given[n] = Real(stage[i][n]);
    rates[i] = jets.template rates<quadratures>(x + tableau.c[i] * h, given, branch);
  }
  // How the stages would move if the rates did not follow them, and how they do.
  std::array<Eigen::Matrix<double, slots, 1>, unknowns> moved;
  for (std::size_t i = 0; i < stages; ++i) {
    for (std::size_t n = 0; n < states; ++n) {
      Real sum = tableau.a[i][0] * rates[0].dy[n];
      for (std::size_t j = 1; j < stages; ++j) sum += tableau.a[i][j] * rates[j].dy[n];
      moved[i * states + n] = (y[n] + h * sum).v;
    }
  }
  matrix.solve(moved);
  const auto follow = [&](std::size_t i, Real& sum, const typename ByState::Real& slope) {
    for (std::size_t n = 0; n < states; ++n) sum.v += slope.v[Eigen::Index(n)] * moved[i * states + n];
  };
  for (std::size_t i = 0; i < stages; ++i) {
    for (std::size_t w = 0; w < rates[i].switches.size(); ++w) {
      follow(i, rates[i].switches[w], partial[i].switches[w]);
    }
    if constexpr (quadratures) {
      for (std::size_t q = 0; q < result.dq.size(); ++q) follow(i, rates[i].dq[q], partial[i].dq[q]);
    }
  }
  result.lowest = detail::lowest_switches<Jets>(rates, branch);
  for (std::size_t n = 0; n < states; ++n) {
    result.y[n] = Real(stage[stages - 1][n]);
    result.y[n].v = moved[(stages - 1) * states + n];
    result.error3[n] = result.error5[n] = Real(0.0);
  }
  if constexpr (quadratures) {
    for (std::size_t q = 0; q < result.dq.size(); ++q) {
      Real sum = tableau.a[stages - 1][0] * rates[0].dq[q];
      for (std::size_t j = 1; j < stages; ++j) sum += tableau.a[stages - 1][j] * rates[j].dq[q];
      result.dq[q] = h * sum;
      result.integral_error3[q] = result.integral_error5[q] = Real(0.0);
    }
  }
  result.admissible = true;
  return result;
}

}  // namespace wingbeat::solver

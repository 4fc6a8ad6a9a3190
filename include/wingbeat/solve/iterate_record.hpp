// What an iterate over the period of a piecewise smooth system leaves: its steps, where branches ended, and how it
// went.
#pragma once

#include <cstddef>
#include <tuple>
#include <vector>

#include "wingbeat/core/cancellation.hpp"
#include "wingbeat/core/scalar.hpp"
#include "wingbeat/solve/explicit_step.hpp"
#include "wingbeat/solve/implicit_step.hpp"

namespace wingbeat::solver {

/// A branch sign that flips at a known position. Signs with index below the number of switches are located instead.
struct FixedNode {
  double x;
  std::size_t sign;
};

/// A sign change that was located in an iterate, or is expected from the iterate before.
struct SwitchNode {
  double x;
  std::size_t sign;
};

/// One accepted step: everything needed to repeat it or to evaluate the solution inside it.
template <class System>
struct Step {
  double x;
  double h;
  typename System::State y;  ///< at x
  typename System::Signs signs;
  Rates<System> first;             ///< rates at (x, y)
  typename System::Quadrature dq;  ///< integrals over the step, and what a jump of the state at its end adds to them
};

enum class Method {
  explicit_pair,  ///< explicit_step, order 8
  radau           ///< implicit_step, order 9, for stiff iterates
};

enum class IterateStatus {
  complete,
  barrier,        ///< the state reached the edge of the admissible region
  too_many_steps  ///< the step limit was reached (a stiff system, for an explicit method)
};

template <class System>
struct Iterate {
  std::vector<Step<System>> steps;
  std::vector<detail::AtStages<typename System::State>> stages;  ///< of the steps, if implicit
  std::vector<SwitchNode> switches;  ///< located; on entry of run_iterate, the expected ones
  typename System::State end;
  IterateStatus status = IterateStatus::complete;
  Method method = Method::explicit_pair;
  double stop = 0.0;                             ///< where the iterate ended [same unit as the period]
  double largest_step = 0.0;                     ///< first guess for the next iterate's steps
  double tolerance = 0.0;                        ///< that it was taken at
  double error_sum = 0.0;                        ///< of the steps' estimated errors, relative
  typename System::Switches switch_scale{};      ///< largest magnitudes of the switches
  typename System::Quadrature integral_scale{};  ///< what the integrals' errors were limited by a share of
};

struct IterateOptions {
  Method method = Method::explicit_pair;
  double tolerance = 1e-6;  ///< of each step, relative to System::error_scale
  int max_steps = 2000;
  double first_step = 0.3;  ///< as a fraction of the period / (2 pi)
  int switches = 1000;      ///< end steps on the first so many switches only; the others are noted in passing
};

/// One step by either method. Throws Cancelled.
template <bool quadratures, class System>
StepResult<System> take_step(Method method, const System& system, const typename System::Real& x,
                             const typename System::State& y, const typename System::Real& h,
                             const typename System::Signs& branch, const Rates<System>& first) {
  check_cancellation();
  return method == Method::explicit_pair ? explicit_step<quadratures>(system, x, y, h, branch, first)
                                         : implicit_step<quadratures>(system, x, y, h, branch, first);
}

/// take_step() with derivatives: `jets` is `system` on dual numbers. `near` as in implicit_step.
template <bool quadratures, class Jets, class System>
StepResult<Jets> take_step(Method method, const Jets& jets, const System& system, const typename Jets::Real& x,
                           const typename Jets::State& y, const typename Jets::Real& h,
                           const typename Jets::Signs& branch,
                           const detail::AtStages<typename System::State>* near = nullptr) {
  check_cancellation();
  if (method == Method::radau) return implicit_step<quadratures>(jets, system, x, y, h, branch, near);
  const Rates<Jets> first = jets.template rates<quadratures>(x, y, branch);
  return explicit_step<quadratures>(jets, x, y, h, branch, first);
}

/// True of systems whose event_transition() moves the state, as an impact does: a recorded step then begins elsewhere
/// than the one before it ended.
template <class System>
constexpr bool state_jumps() {
  if constexpr (requires { System::state_jumps; }) {
    return System::state_jumps;
  } else {
    return false;
  }
}

/// True if the right-hand side jumps at switch k.
template <class System>
bool jumps(const System& system, std::size_t k) {
  if constexpr (requires { system.jumps(k); }) {
    return system.jumps(k);
  } else {
    return false;
  }
}

/// Gives the signs of the switches at which nothing jumps the values that they have at a state; that of a switch at
/// zero stays. They may depend on each other.
template <class System>
void settle_signs(const System& system, const typename System::Real& x, const typename System::State& y,
                  typename System::Signs& signs) {
  using Real = typename System::Real;
  constexpr std::size_t count = std::tuple_size_v<typename System::Switches>;
  constexpr std::size_t max_changes = 4 * count;
  auto values = system.template rates<false>(x, y, signs).switches;
  std::size_t settled = 0, changes = 0;
  for (std::size_t k = 0; settled < count && changes < max_changes; k = (k + 1) % count) {
    ++settled;
    const double value = value_of(values[k]);
    if (jumps(system, k) || value == 0.0 || value * value_of(signs[k]) > 0.0) continue;
    signs[k] = Real(value > 0.0 ? 1.0 : -1.0);
    values = system.template rates<false>(x, y, signs).switches;
    settled = 1;
    ++changes;
  }
}

}  // namespace wingbeat::solver

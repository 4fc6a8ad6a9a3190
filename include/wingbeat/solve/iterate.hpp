// One iterate of a piecewise smooth system over its period: adaptive steps, every change of branch located.
//
// An iterate is a list of steps, each on one smooth branch. Branches end at fixed nodes, known in advance, and at
// switches: functions of the solution whose sign changes are found. The right-hand side is continuous there, so an
// error e in the position of a switch costs O(e^2) in everything: positions are needed to the square root of the
// tolerance only.
//
// A system may have switches at which its right-hand side jumps, as with dry friction. It says so by jumps(k), and
// their positions are found to the tolerance itself. Its event_transition() chooses the new branch, and its reset_map()
// takes a solution next to the recorded one over a recorded jump, to first order (the saltation matrix). Where
// event_transition() moves the state itself, as an impact does, the system says `state_jumps`, and both functions
// return what the jump adds to the integrals.
#pragma once

#include <algorithm>
#include <vector>

#include "wingbeat/solve/iterate_driver.hpp"
#include "wingbeat/solve/iterate_record.hpp"

namespace wingbeat::solver {

/// Integrates one iterate from `start` at x = 0. `iterate.switches` may hold expected positions (those of the iterate
/// before), which saves finding them again. With `quadratures`, every step records its integrals. Throws nothing but
/// Cancelled, never loops for ever.
template <bool quadratures, class System>
void run_iterate(const System& system, const typename System::State& start, const IterateOptions& options,
                 Iterate<System>& iterate) {
  detail::IterateDriver<quadratures, System>(system, options, iterate).run(start);
}

/// The signs of a recorded step on the scalar of a system.
template <class System, class Recorded>
typename System::Signs signs_of(const Step<Recorded>& step) {
  typename System::Signs signs;
  for (std::size_t k = 0; k < signs.size(); ++k) signs[k] = typename System::Real(step.signs[k]);
  return signs;
}

/// Takes a state that lies next to the recorded one onto the branch of step n; what the integrals gain by it is added
/// to
/// `*totals`.
template <bool quadratures, class System, class Recorded>
void reset_map(const System& system, const std::vector<Step<Recorded>>& steps, std::size_t n, typename System::State& y,
               typename System::Quadrature* totals) {
  if constexpr (requires { &System::template reset_map<quadratures>; }) {
    system.template reset_map<quadratures>(typename System::Real(steps[n].x), y,
                                           signs_of<System>(steps[n > 0 ? n - 1 : 0]), signs_of<System>(steps[n]),
                                           totals);
  }
}

/// Repeats the steps of an iterate, mesh and branches frozen, from `start`. Returns the state at the end; the integrals
/// are added to `*totals` where given.
template <bool quadratures, class System, class Recorded>
typename System::State repeat_iterate(const System& system, const typename System::State& start,
                                      const Iterate<Recorded>& iterate, typename System::Quadrature* totals = nullptr) {
  using Real = typename System::Real;
  typename System::State y = start;
  for (std::size_t n = 0; n < iterate.steps.size(); ++n) {
    const Step<Recorded>& step = iterate.steps[n];
    const typename System::Signs signs = signs_of<System>(step);
    reset_map<quadratures>(system, iterate.steps, n, y, totals);
    const Rates<System> first = system.template rates<quadratures>(Real(step.x), y, signs);
    const StepResult<System> result =
        take_step<quadratures>(iterate.method, system, Real(step.x), y, Real(step.h), signs, first);
    if constexpr (quadratures) {
      for (std::size_t q = 0; q < result.dq.size(); ++q) (*totals)[q] = (*totals)[q] + result.dq[q];
    }
    y = result.y;
  }
  return y;
}

/// The step that holds x.
template <class System>
const Step<System>& step_at(const Iterate<System>& iterate, double x) {
  const auto after = std::upper_bound(iterate.steps.begin(), iterate.steps.end(), x,
                                      [](double position, const Step<System>& step) { return position < step.x; });
  return after == iterate.steps.begin() ? iterate.steps.front() : *(after - 1);
}

/// The solution at x inside a recorded step, by a shorter step of the same method: as accurate as the iterate itself.
template <bool quadratures, class System>
StepResult<System> evaluate_inside(const System& system, const Iterate<System>& iterate, const Step<System>& step,
                                   double x) {
  return take_step<quadratures>(iterate.method, system, step.x, step.y, x - step.x, step.signs, step.first);
}

}  // namespace wingbeat::solver

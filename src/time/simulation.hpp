// Steps a model in time to any moment, through its events, and back: no decision, no recording.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>

#include "time/model_problem.hpp"

namespace wingbeat::detail {

/// A vehicle in time (CrankModel, DirectModel): unknowns that are integrated on smooth pieces, and what happens between
/// them. `now` is everything that moves; all else is fixed by start().
template <class M>
concept TimeModel = std::copyable<typename M::State> &&
                    requires(M m, const M& fixed, double t, double* y, const double* at, std::size_t k) {
                      { m.now } -> std::same_as<typename M::State&>;
                      { fixed.coupled } -> std::convertible_to<int>;  // number of unknowns
                      { fixed.ended() } -> std::same_as<bool>;        // it cannot go on
                      m.begin_piece();                                // decides on what branch it goes on
                      fixed.unknowns(y);
                      m.set(t, at);
                      { fixed.rates(t, at, y, false) } -> std::same_as<bool>;
                      { M::indicator_count } -> std::convertible_to<std::size_t>;
                      { fixed.indicators(t, at)[k] } -> std::convertible_to<double>;
                      { fixed.directions()[k] } -> std::convertible_to<int>;  // which sign changes of them count
                      m.handle(k);                                            // one of them has changed its sign
                      { m.branch_lost() } -> std::same_as<bool>;              // the branch was not the one it is on
                      { fixed.next_switch() } -> std::convertible_to<double>;
                      m.switch_supply();
                      fixed.tolerated(1e-6, at, y);
                      { fixed.typical()[k] } -> std::convertible_to<double>;
                      { fixed.longest_step() } -> std::convertible_to<double>;
                      { fixed.stiff() } -> std::same_as<bool>;
                    };

enum class StepOutcome { reached, ended, failed };

/// The model goes on to the time `until` [s]. Its state alone decides how: from a saved state the same bits come again.
/// `tolerance`: admissible relative error of a step. failed: the integrator could not go on, or events without end.
template <TimeModel Model>
StepOutcome step_to(Model& model, double until, double tolerance, TimeIntegrator which = TimeIntegrator::own_steps) {
  constexpr int max_pieces = 1000000;
  for (int piece = 0; model.now.t < until; ++piece) {
    if (model.ended()) return StepOutcome::ended;
    if (piece == max_pieces) return StepOutcome::failed;
    const double switching = model.next_switch(), stop = std::min(until, switching);
    if (stop - model.now.t < 1e-13 * std::max(model.now.t, stop)) {
      model.now.t = stop;
      if (stop == switching) model.switch_supply();
      continue;
    }
    model.begin_piece();
    const auto steps = make_integrator(which, problem_of(model, tolerance));
    model.unknowns(steps->state());
    auto directions = model.directions();
    if (!steps->restart(model.now.t, directions.data(), std::min(model.longest_step(), stop - model.now.t), stop)) {
      return StepOutcome::failed;
    }
    for (bool goes_on = true; goes_on;) {
      const Integrator::Outcome outcome = steps->advance();
      if (outcome == Integrator::Outcome::failed) return StepOutcome::failed;
      model.set(steps->time(), steps->state());
      goes_on = outcome == Integrator::Outcome::step && !model.branch_lost();
      for (std::size_t k = 0; k < Model::indicator_count; ++k) {
        if (outcome == Integrator::Outcome::root && steps->found(int(k))) model.handle(k);
      }
      if (outcome == Integrator::Outcome::stop && stop == switching) model.switch_supply();
    }
  }
  return StepOutcome::reached;
}

}  // namespace wingbeat::detail

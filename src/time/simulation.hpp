// Steps a model in time to any moment, through its events, and back: no decision, no recording. The class that users
// have is Simulation.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "time/model_problem.hpp"
#include "time/time_model.hpp"

namespace wingbeat::detail {

/// Watches a simulation: nothing to see.
struct NoWatch {
  /// Before what happens at the end of a step from the time `from` [s] to where the model stands: a moment within it to
  /// stop at, of which nothing behind it has happened.
  std::optional<double> stepped(const TimeModel&, Integrator&, double /*from*/) const { return std::nullopt; }
  /// Of the model as it stands; true stops it there.
  bool happened(const TimeModel&, TransientEvent::Kind) const { return false; }
};

enum class StepOutcome { reached, stopped, ended, failed };

/// The model, a TimeModel or what is derived from it, goes on to the time `until` [s]. Its state alone decides how:
/// from a saved state the same bits come again. `tolerance`: admissible relative error of a step. stopped: by what
/// watches; failed: the integrator could not go on, or events without end.
template <class Model, class Watch = NoWatch>
StepOutcome step_to(Model& model, double until, double tolerance, TimeIntegrator which = TimeIntegrator::own_steps,
                    Watch&& watch = {}) {
  using Kind = TransientEvent::Kind;
  constexpr int max_pieces = 1000000;
  bool stops = false;
  const auto tell = [&](Kind kind) { stops |= watch.happened(model, kind); };
  double impact_loss = model.now.impact_loss;
  // Changes the model and tells what has come of it.
  const auto doing = [&](const auto& change) {
    const bool had_ended = model.ended();
    change();
    if (model.now.impact_loss > impact_loss) tell(Kind::stop_impact);
    impact_loss = model.now.impact_loss;
    if (model.ended() && !had_ended) tell(Kind::jam);
  };
  const auto switch_supply = [&] {
    model.switch_supply();
    tell(Kind::supply_switch);
  };
  for (int piece = 0; model.now.t < until && !stops; ++piece) {
    if (model.ended()) return StepOutcome::ended;
    if (piece == max_pieces) return StepOutcome::failed;
    const double switching = model.next_switch(), stop = std::min(until, switching);
    if (stop - model.now.t < 1e-13 * std::max(model.now.t, stop)) {
      model.now.t = stop;
      if (stop == switching) switch_supply();
      continue;
    }
    const bool stood = model.now.stuck;
    doing([&] { model.begin_piece(); });
    if (stood && !model.now.stuck) tell(Kind::breakaway);
    if (stops || model.ended()) continue;
    const auto steps = make_integrator(which, problem_of(model, tolerance));
    model.unknowns(steps->state());
    auto directions = model.directions();
    if (!steps->restart(model.now.t, directions.data(), std::min(model.longest_step(), stop - model.now.t), stop)) {
      return StepOutcome::failed;
    }
    for (bool goes_on = true; goes_on;) {
      const double from = model.now.t;
      const Integrator::Outcome outcome = steps->advance();
      if (outcome == Integrator::Outcome::failed) return StepOutcome::failed;
      model.set(steps->time(), steps->state());
      if (const std::optional<double> within = watch.stepped(model, *steps, from)) {
        model.set(*within, steps->dense(*within));
        stops = true;
        break;
      }
      doing([&] { goes_on = outcome == Integrator::Outcome::step && !model.branch_lost(); });
      for (std::size_t k = 0; k < Model::indicator_count; ++k) {
        if (outcome != Integrator::Outcome::root || !steps->found(int(k))) continue;
        const std::optional<Kind> kind = model.event_at(k);
        doing([&] { model.handle(k); });
        if (kind) tell(*kind);
      }
      if (outcome == Integrator::Outcome::stop && stop == switching) switch_supply();
      goes_on = goes_on && !stops;
    }
  }
  return stops ? StepOutcome::stopped : StepOutcome::reached;
}

}  // namespace wingbeat::detail

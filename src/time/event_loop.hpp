// The one loop through the events of a model in time: start-up, Simulation and FMUs go by it. It decides nothing about
// the vehicle and records nothing; whoever watches does.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>

#include "time/model_problem.hpp"
#include "time/time_model.hpp"

namespace wingbeat::detail {

/// Watches a model: nothing to see.
struct NoWatch {
  /// Before and after the model is changed other than by integrating.
  template <class Model>
  void changing(const Model&) {}
  template <class Model>
  void changed(const Model&) {}
  /// The time to which the next piece may go, of one that begins and would end at `stop` [s]; no time ahead: it is not
  /// integrated.
  template <class Model>
  double piece_end(const Model&, double stop) {
    return stop;
  }
  /// Before what happens at the end of a step from the time `from` [s] to where the model stands: a moment within it to
  /// stop at, of which nothing behind it has happened.
  template <class Model>
  std::optional<double> stepped(const Model&, Integrator&, double /*from*/) {
    return std::nullopt;
  }
  /// Of the model as it stands; true stops it there.
  template <class Model>
  bool happened(const Model&, TransientEvent::Kind) {
    return false;
  }
  /// After a step and what has happened at its end; true stops it there. `plain`: nothing has.
  template <class Model>
  bool enough(const Model&, bool /*plain*/) {
    return false;
  }
};

/// reached: the end of the piece; event: one that ended it before, a jam among them; stopped: by what watches.
enum class PieceOutcome { reached, event, stopped, not_started, failed };

/// The model, a TimeModel, what is derived from it, or a FlightModel, goes on by one smooth piece: at most to the time
/// `until` [s]. integrator() gives what integrates it.
template <class Model, class Watch, class MakeIntegrator>
PieceOutcome pass_piece(Model& model, double until, Watch& watch, const MakeIntegrator& integrator) {
  using Kind = TransientEvent::Kind;
  bool stops = false;
  const auto tell = [&](Kind kind) { stops |= watch.happened(model, kind); };
  double impact_loss = model.now.impact_loss;
  // Changes the model and tells what has come of it.
  const auto doing = [&](const auto& change) {
    const bool had_ended = model.ended();
    watch.changing(model);
    change();
    watch.changed(model);
    if (model.now.impact_loss > impact_loss) tell(Kind::stop_impact);
    impact_loss = model.now.impact_loss;
    if (model.ended() && !had_ended) tell(Kind::jam);
  };
  const auto switch_supply = [&] {
    doing([&] { model.switch_supply(); });
    tell(Kind::supply_switch);
  };

  const double switching = model.next_switch();
  double stop = std::min(until, switching);
  if (stop - model.now.t < 1e-13 * std::max(model.now.t, stop)) {
    model.now.t = stop;
    if (stop == switching) switch_supply();
    return stops ? PieceOutcome::stopped : PieceOutcome::reached;
  }
  const bool stood = model.now.stuck;
  doing([&] { model.begin_piece(); });
  if (stood && !model.now.stuck) tell(Kind::breakaway);
  if (stops) return PieceOutcome::stopped;
  if (model.ended()) return PieceOutcome::event;
  stop = watch.piece_end(model, stop);
  if (!(stop > model.now.t)) return PieceOutcome::stopped;

  Integrator& steps = integrator();
  model.unknowns(steps.state());
  auto directions = model.directions();
  const double longest = model.longest_step(), horizon = std::min(longest, stop - model.now.t);
  const double bound = model.now.stuck ? longest : std::numeric_limits<double>::infinity();
  if (!steps.restart(model.now.t, directions.data(), horizon, stop, bound)) {
    return PieceOutcome::not_started;
  }
  while (true) {
    const double from = model.now.t;
    const Integrator::Outcome outcome = steps.advance();
    if (outcome == Integrator::Outcome::failed) return PieceOutcome::failed;
    model.set(steps.time(), steps.state());
    if (const std::optional<double> within = watch.stepped(model, steps, from)) {
      model.set(*within, steps.dense(*within));
      return PieceOutcome::stopped;
    }
    bool ends = outcome == Integrator::Outcome::root;  // also where rounding hides which
    if (outcome == Integrator::Outcome::step) doing([&] { ends = model.branch_lost(); });
    bool found = false, ended = false;  // what ends no piece, and what does
    for (std::size_t k = 0; k < Model::indicator_count; ++k) {
      if (outcome != Integrator::Outcome::root || !steps.found(int(k))) continue;
      const std::optional<Kind> kind = model.event_at(k);
      const bool ends_here = model.ends_piece(k);
      doing([&] { model.handle(k); });
      if (kind) tell(*kind);
      found |= !ends_here, ended |= ends_here;
    }
    if (found && !ended) ends = false;
    if (outcome == Integrator::Outcome::stop && stop == switching) switch_supply();
    if (watch.enough(model, outcome == Integrator::Outcome::step && !ends) || stops) return PieceOutcome::stopped;
    if (outcome == Integrator::Outcome::stop) return PieceOutcome::reached;
    if (ends || model.ended()) return PieceOutcome::event;
  }
}

enum class StepOutcome { reached, stopped, ended, failed };

/// The model goes on to the time `until` [s] by as many pieces as it takes. Its state alone decides how: from a saved
/// state the same bits come again. `tolerance`: admissible relative error of a step. stopped: by what watches; failed:
/// the integrator could not go on, or events without end.
template <class Model, class Watch = NoWatch>
StepOutcome step_to(Model& model, double until, double tolerance, TimeIntegrator which = TimeIntegrator::own_steps,
                    Watch&& watch = {}) {
  constexpr int max_pieces = 1000000;
  std::unique_ptr<Integrator> steps;
  const auto integrator = [&]() -> Integrator& {
    steps = integrator_for(which, model, tolerance);
    return *steps;
  };
  for (int piece = 0; model.now.t < until; ++piece) {
    if (model.ended()) return StepOutcome::ended;
    if (piece == max_pieces) return StepOutcome::failed;
    const PieceOutcome outcome = pass_piece(model, until, watch, integrator);
    if (outcome == PieceOutcome::not_started || outcome == PieceOutcome::failed) return StepOutcome::failed;
    if (outcome == PieceOutcome::stopped) return StepOutcome::stopped;
  }
  return StepOutcome::reached;
}

}  // namespace wingbeat::detail

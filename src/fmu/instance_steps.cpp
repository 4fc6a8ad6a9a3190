#include <stdexcept>

#include "fmu/archive.hpp"
#include "fmu/instance.hpp"

namespace wingbeat::fmu {
namespace {

/// Room on either side of an event: an indicator is this where it has just been handled, and handled once it is below
/// the larger one.
constexpr double indicator_rest = 1e-10, indicator_due = 1e-9;

}  // namespace

std::vector<double> Instance::indicators() const {
  return std::visit(
      [&](const auto& model) {
        double y[max_unknowns + detail::quadrature_count] = {};
        model.unknowns(y);
        const auto values = model.indicators(model.now.t, y);
        const auto directions = model.directions();
        std::vector<double> watched;
        for (const std::size_t k : watched_) {
          watched.push_back(-double(directions[k]) * values[k] + indicator_rest);
        }
        return watched;
      },
      model_);
}

bool Instance::handle_events() {
  apply_parameters();
  const std::vector<double> before = states();
  const std::vector<double> due = indicators();
  std::visit(
      [&](auto& model) {
        if (model.ended()) return;
        for (std::size_t n = 0; n < watched_.size(); ++n) {
          if (due[n] <= indicator_due) model.handle(watched_[n]);
        }
        while (model.next_switch() <= model.now.t * (1.0 + 1e-14)) model.switch_supply();
        model.begin_piece();
      },
      model_);
  return states() != before;
}

double Instance::next_event() const {
  return std::visit([](const auto& model) { return model.next_switch(); }, model_);
}

bool Instance::ended() const {
  return std::visit([](const auto& model) { return model.ended(); }, model_);
}

bool Instance::step_to(double until) {
  apply_parameters();
  apply_inputs();
  return std::visit(
      [&](auto& model) {
        const auto before = model.now;
        const CycleMeans means = model.means;
        const detail::StepOutcome outcome = detail::step_to(model, until, settings_.tolerance);
        if (outcome == detail::StepOutcome::failed) {
          model.now = before;
          model.means = means;
        }
        return outcome == detail::StepOutcome::reached;
      },
      model_);
}

std::string Instance::save() const {
  ArchiveWriter out;
  out(design_), out(inputs_), out(settings_), out(changed_), out(scaled_to_);
  std::visit(
      [&](const auto& model) {
        const auto put = [&](const auto& x) { out(x); };
        model.now.each(model.now, put);
        model.means.each(model.means, put);
      },
      model_);
  return out.bytes;
}

void Instance::restore(const std::string& bytes) {
  ArchiveReader in(bytes);
  double scale = 0.0;
  in(design_), in(inputs_), in(settings_), in(changed_), in(scale);
  build();
  std::visit(
      [&](auto& model) {
        if (scale > 0.0) model.scale_to(scaled_to_ = scale);
        const auto get = [&](auto& x) { in(x); };
        model.now.each(model.now, get);
        model.means.each(model.means, get);
      },
      model_);
  if (!in.done()) throw std::runtime_error("the saved state is that of another vehicle");
}

}  // namespace wingbeat::fmu

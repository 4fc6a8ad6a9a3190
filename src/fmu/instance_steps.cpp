#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fmu/flight_steps.hpp"
#include "fmu/instance.hpp"

namespace wingbeat::fmu {
namespace {

/// Lists of all drives behind each other.
template <class Drives, class Use>
std::vector<double> joined(const Drives& drives, const Use& list_of) {
  std::vector<double> all;
  for (const auto& drive : drives) {
    const std::vector<double> list = list_of(*drive);
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

}  // namespace

std::size_t Instance::state_count() const {
  return drives_.size() * drives_[0]->layout().count() + (body_ ? body_state_count : 0);
}
std::size_t Instance::indicator_count() const { return drives_.size() * drives_[0]->indicator_count(); }

std::vector<double> Instance::states() const {
  std::vector<double> all = joined(drives_, [](const DriveInTime& drive) { return drive.states(); });
  if (body_) {
    for (const double x : body_->numbers()) all.push_back(x);
  }
  return all;
}
std::vector<double> Instance::rates() const {
  std::optional<detail::AirOnBody> air;
  if (body_) air = body_->air_now(drives_);
  std::vector<double> all = joined(drives_, [](const DriveInTime& drive) { return drive.rates(); });
  if (body_) {
    const BodyState moves = body_->rates_in(body_->state, *air);
    BodyState::each(moves, [&](double x) { all.push_back(x); });
  }
  return all;
}
std::vector<double> Instance::nominals() const {
  std::vector<double> all = joined(drives_, [](const DriveInTime& drive) { return drive.nominals(); });
  if (body_) {
    BodyState sizes;
    sizes.velocity = sizes.position = {1.0, 1.0, 1.0};
    sizes.rates = {10.0, 10.0, 10.0};
    sizes.attitude = {1.0, 1.0, 1.0, 1.0};
    BodyState::each(sizes, [&](double x) { all.push_back(x); });
  }
  return all;
}
std::vector<double> Instance::indicators() const {
  meet_air();
  return joined(drives_, [](const DriveInTime& drive) { return drive.indicators(); });
}

void Instance::set_states(const double* y) {
  for (const auto& drive : drives_) {
    drive->set_states(y);
    y += drive->layout().count();
  }
  if (body_) body_->set_numbers(y);
}

void Instance::set_time(double t) {
  for (const auto& drive : drives_) drive->set_time(t);
}

/// The vehicle with its parameters as they are now, in the state that it has.
void Instance::apply_parameters() {
  if (!changed_) return;
  validate(design_);
  if (body_) {
    body_->build(design_);
    body_->connect(drives_);
  }
  for (const auto& drive : drives_) drive->change(design_, settings_);
  changed_ = false;
}

void Instance::handle_events() {
  apply_parameters();
  meet_air();
  for (const auto& drive : drives_) drive->handle_events();
}

double Instance::next_event() const {
  double next = infinity;
  for (const auto& drive : drives_) next = std::min(next, drive->next_event());
  return next;
}

bool Instance::ended() const {
  return std::any_of(drives_.begin(), drives_.end(), [](const auto& drive) { return drive->ended(); });
}

StepResult Instance::fly_to(double until, std::int64_t work) {
  std::vector<DriveInTime::Moving> before;
  std::vector<MeasuredModel*> models;
  for (const auto& drive : drives_) {
    before.push_back(drive->motion());
    models.push_back(&drive->begin_step());
  }
  const BodyState body = body_->state;
  StepResult result = StepResult::failed;
  try {
    FlightSteps steps(models, *body_, work);
    switch (detail::step_to(steps, until, settings_.tolerance)) {
      case detail::StepOutcome::reached: result = StepResult::reached; break;
      case detail::StepOutcome::ended: result = StepResult::jammed; break;
      default: break;
    }
    for (MeasuredModel* model : models) model->now.t = steps.now.t;
  } catch (const WorkSpent&) {
    result = StepResult::too_much;
  }
  if (result == StepResult::reached || result == StepResult::jammed) return result;
  for (std::size_t k = 0; k < drives_.size(); ++k) drives_[k]->set_motion(before[k]);
  body_->state = body;
  return result;
}

StepResult Instance::step_to(double until, std::int64_t work) {
  apply_parameters();
  if (body_) return fly_to(until, work);
  std::vector<DriveInTime::Moving> before;
  for (const auto& drive : drives_) before.push_back(drive->motion());
  // Where one of two jams, the other stands at that time too.
  StepResult all = StepResult::reached;
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    const StepResult result = drives_[k]->step_to(until, settings_.tolerance, work);
    if (result == StepResult::jammed) {
      all = result;
      until = drives_[k]->time();
      for (std::size_t other = 0; other < k; ++other) {
        drives_[other]->set_motion(before[other]);
        drives_[other]->step_to(until, settings_.tolerance, work);
      }
    } else if (result != StepResult::reached) {
      for (std::size_t other = 0; other < drives_.size(); ++other) drives_[other]->set_motion(before[other]);
      return result;
    }
  }
  return all;
}

/// Central differences along the direction: the flow that a body makes is no dual number.
std::vector<double> Instance::differences(const std::vector<std::size_t>& unknowns,
                                          const std::vector<Direction>& knowns) {
  constexpr double relative = 1e-5;
  const std::size_t per_drive = drives_[0]->layout().count();
  const auto place_of = [&](std::size_t reference) {
    const std::size_t side = side_of(reference);
    const std::size_t before = side == body_side ? drives_.size() : side == 2 ? 1 : 0;
    return before * per_drive + index_of(reference);
  };
  std::vector<DriveInTime::Held> held;
  for (const auto& drive : drives_) held.push_back(drive->hold());
  const BodyState body = body_->state;
  const BodyInputs inputs = body_->inputs;
  const std::vector<double> here = states(), sizes = nominals();
  double fastest = 0.0;
  for (const Direction& known : knowns) {
    const double size = kind_of(known.reference) == VariableKind::state
                            ? sizes[place_of(known.reference)]
                            : std::max(std::abs(real(known.reference).value_or(0.0)), 1.0);
    fastest = std::max(fastest, std::abs(known.change) / size);
  }
  std::vector<double> found(unknowns.size(), 0.0);
  if (!(fastest > 0.0)) return found;
  const double step = relative / fastest;
  for (const double way : {1.0, -1.0}) {
    std::vector<double> moved = here;
    for (const Direction& known : knowns) {
      if (kind_of(known.reference) == VariableKind::state)
        moved[place_of(known.reference)] += way * step * known.change;
      else set_real(known.reference, *real(known.reference) + way * step * known.change);
    }
    set_states(moved.data());
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      found[k] += way * real(unknowns[k]).value_or(0.0) / (2.0 * step);
    }
    for (std::size_t k = 0; k < drives_.size(); ++k) drives_[k]->release(held[k]);
    body_->state = body;
    body_->inputs = inputs;
  }
  return found;
}

std::string Instance::save() const {
  ArchiveWriter out;
  out(two_), out(design_), out(settings_), out(changed_);
  if (body_) {
    out(body_->settings), out(body_->inputs);
    for (const double x : body_->numbers()) out(x);
  }
  for (const auto& drive : drives_) drive->save(out);
  return out.bytes;
}

void Instance::restore(const std::string& bytes) {
  const auto wrong = [] { return std::runtime_error("the saved state is that of another vehicle"); };
  ArchiveReader in(bytes);
  if (in.value<bool>() != two_) throw wrong();
  const auto design = in.value<Design<double>>();
  const auto settings = in.value<Settings>();
  const bool changed = in.value<bool>();
  validate(design);
  if (has_body(design) != (body_ != nullptr)) throw wrong();
  std::vector<std::unique_ptr<DriveInTime>> drives;
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    drives.push_back(std::make_unique<DriveInTime>(design, two_, settings));
  }
  std::unique_ptr<BodyInTime> body;
  if (body_) {
    body = std::make_unique<BodyInTime>(design);
    in(body->settings), in(body->inputs);
    std::vector<double> numbers(body_state_count);
    for (double& x : numbers) in(x);
    body->set_numbers(numbers.data());
    body->connect(drives);
  }
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    const auto& old = drives_[k];
    drives[k]->restore(in, design, settings);
    const bool alike =
        drives[k]->layout().count() == old->layout().count() && drives[k]->indicator_count() == old->indicator_count();
    if (!alike) throw wrong();
  }
  if (!in.done()) throw wrong();
  design_ = design;
  settings_ = settings;
  drives_ = std::move(drives);
  body_ = std::move(body);
  changed_ = changed;
}

}  // namespace wingbeat::fmu

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

std::size_t Instance::state_count() const { return drives_.size() * drives_[0]->layout().count(); }
std::size_t Instance::indicator_count() const { return drives_.size() * drives_[0]->indicator_count(); }

std::vector<double> Instance::states() const {
  return joined(drives_, [](const DriveInTime& drive) { return drive.states(); });
}
std::vector<double> Instance::rates() const {
  return joined(drives_, [](const DriveInTime& drive) { return drive.rates(); });
}
std::vector<double> Instance::nominals() const {
  return joined(drives_, [](const DriveInTime& drive) { return drive.nominals(); });
}
std::vector<double> Instance::indicators() const {
  return joined(drives_, [](const DriveInTime& drive) { return drive.indicators(); });
}

void Instance::set_states(const double* y) {
  for (const auto& drive : drives_) {
    drive->set_states(y);
    y += drive->layout().count();
  }
}

void Instance::set_time(double t) {
  for (const auto& drive : drives_) drive->set_time(t);
}

/// The vehicle with its parameters as they are now, in the state that it has.
void Instance::apply_parameters() {
  if (!changed_) return;
  validate(design_);
  for (const auto& drive : drives_) drive->change(design_, settings_);
  changed_ = false;
}

void Instance::handle_events() {
  apply_parameters();
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

StepResult Instance::step_to(double until, std::int64_t work) {
  apply_parameters();
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

std::string Instance::save() const {
  ArchiveWriter out;
  out(two_), out(design_), out(settings_), out(changed_);
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
  std::vector<std::unique_ptr<DriveInTime>> drives;
  for (const auto& old : drives_) {
    drives.push_back(std::make_unique<DriveInTime>(design, two_, settings));
    drives.back()->restore(in, design, settings);
    const bool alike = drives.back()->layout().count() == old->layout().count() &&
                       drives.back()->indicator_count() == old->indicator_count();
    if (!alike) throw wrong();
  }
  if (!in.done()) throw wrong();
  design_ = design;
  settings_ = settings;
  drives_ = std::move(drives);
  changed_ = changed;
}

}  // namespace wingbeat::fmu

// What of a drive in time is kept: its motion, for a step that is taken back, and all of it as bytes.
#include <type_traits>

#include "fmu/drive_in_time.hpp"

namespace wingbeat::fmu {

DriveInTime::Moving DriveInTime::motion() const {
  Moving moving;
  model_.now.each(model_.now, [&](const auto& x) { moving.numbers.push_back(double(x)); });
  moving.means = model_.means;
  return moving;
}

void DriveInTime::set_motion(const Moving& to) {
  auto next = to.numbers.begin();
  model_.now.each(model_.now, [&](auto& x) { x = std::remove_reference_t<decltype(x)>(*next++); });
  model_.means = to.means;
  scaled_to_ = 0.0;
  apply_inputs();
}

void DriveInTime::release(const Held& to) {
  inputs_ = to.inputs;
  inputs_set_ = to.inputs_set;
  apply_inputs();  // a frequency, before the phase
  set_motion(to.moving);
}

void DriveInTime::save(ArchiveWriter& out) const {
  out(inputs_), out(inputs_set_), out(scaled_to_);
  const auto put = [&](const auto& x) { out(x); };
  model_.now.each(model_.now, put);
  model_.means.each(model_.means, put);
}

void DriveInTime::restore(ArchiveReader& in, const Design<double>& design, const Settings& settings) {
  const auto inputs = in.value<Inputs>();
  inputs_set_ = in.value<unsigned>();
  const double scale = in.value<double>();
  build(design, settings);
  inputs_ = inputs;
  apply_inputs();
  const auto get = [&](auto& x) { in(x); };
  model_.now.each(model_.now, get);
  model_.means.each(model_.means, get);
  if (scale > 0.0) scale_to(scale);
}

}  // namespace wingbeat::fmu

// What of a drive in time is kept: its motion, for a step that is taken back, and all of it as bytes.
#include <type_traits>

#include "fmu/drive_in_time.hpp"

namespace wingbeat::fmu {

DriveInTime::Moving DriveInTime::motion() const {
  Moving moving;
  std::visit(
      [&](const auto& model) {
        model.now.each(model.now, [&](const auto& x) { moving.numbers.push_back(double(x)); });
        moving.means = model.means;
      },
      model_);
  return moving;
}

void DriveInTime::set_motion(const Moving& to) {
  std::visit(
      [&](auto& model) {
        auto next = to.numbers.begin();
        model.now.each(model.now, [&](auto& x) { x = std::remove_reference_t<decltype(x)>(*next++); });
        model.means = to.means;
      },
      model_);
  scaled_to_ = 0.0;
  apply_inputs();
}

void DriveInTime::save(ArchiveWriter& out) const {
  out(inputs_), out(inputs_set_), out(scaled_to_);
  std::visit(
      [&](const auto& model) {
        const auto put = [&](const auto& x) { out(x); };
        model.now.each(model.now, put);
        model.means.each(model.means, put);
      },
      model_);
}

void DriveInTime::restore(ArchiveReader& in, const Design<double>& design, const Settings& settings) {
  const auto inputs = in.value<Inputs>();
  inputs_set_ = in.value<unsigned>();
  const double scale = in.value<double>();
  build(design, settings);
  inputs_ = inputs;
  apply_inputs();
  std::visit(
      [&](auto& model) {
        const auto get = [&](auto& x) { in(x); };
        model.now.each(model.now, get);
        model.means.each(model.means, get);
        if (scale > 0.0) model.scale_to(scaled_to_ = scale);
      },
      model_);
}

}  // namespace wingbeat::fmu

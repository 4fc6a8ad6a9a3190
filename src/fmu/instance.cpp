#include "fmu/instance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::fmu {

std::vector<std::unique_ptr<DriveInTime>> Instance::drives_of(const Design<double>& design) const {
  validate(design);
  std::vector<std::unique_ptr<DriveInTime>> drives;
  for (int k = 0; k < (two_ ? 2 : 1); ++k) drives.push_back(std::make_unique<DriveInTime>(design, two_, settings_));
  return drives;
}

Instance::Instance(const Design<double>& design)
    : given_(design), design_(design), two_(has_two_drives(design)), drives_(drives_of(design)) {
  if (!has_body(design)) return;
  body_ = std::make_unique<BodyInTime>(design);
  body_->connect(drives_);
}

void Instance::reset() {
  design_ = given_;
  settings_ = {};
  changed_ = false;
  if (body_) {
    body_ = std::make_unique<BodyInTime>(design_);
    body_->connect(drives_);
  }
  for (const auto& drive : drives_) {
    drive->forget_inputs();
    drive->initialise(design_, settings_, 0.0);
  }
}

void Instance::initialise(double time) {
  validate(design_);
  if (body_) {
    body_->build(design_);
    body_->start();
    body_->connect(drives_);
  }
  for (const auto& drive : drives_) drive->initialise(design_, settings_, time);
  changed_ = false;
}

void Instance::meet_air() const {
  if (!body_) return;
  if (body_->vehicle().wing_mass > 0.0) body_->air_now(drives_);
  else body_->set_flows(body_->state);
}

std::optional<double> Instance::real_of_body(VariableKind kind, std::size_t index) const {
  if (!body_) return {};
  const auto one_of = [&](const auto& list) { return index < list.size() ? std::optional(list[index]) : std::nullopt; };
  switch (kind) {
    case VariableKind::state: return one_of(body_->numbers());
    case VariableKind::derivative: {
      const BodyState rates = body_->rates_in(body_->state, body_->air_now(drives_));
      std::vector<double> all;
      BodyState::each(rates, [&](double x) { all.push_back(x); });
      return one_of(all);
    }
    case VariableKind::input: {
      const double* const input = member_of(body_->inputs, index);
      return input ? std::optional(*input) : std::nullopt;
    }
    case VariableKind::setting: {
      const double* const setting = member_of(body_->settings, index);
      return setting ? std::optional(*setting) : std::nullopt;
    }
    case VariableKind::output: return one_of(body_->outputs(body_->air_now(drives_)));
    default: return {};
  }
}

const DriveInTime* Instance::drive(std::size_t side) const {
  if (two_ ? side != 1 && side != 2 : side != 0) return nullptr;
  return drives_[two_ ? side - 1 : 0].get();
}

/// Of a side, or of two together, which act on the body. Axes as in study/body_derivatives.hpp.
template <Scalar S>
S Instance::output(OutputId which, std::size_t side, const std::vector<Dynamics<S>>& dynamics) const {
  using std::cos;
  using std::sin;
  if (const DriveInTime* const one = drive(side)) return one->output(which, dynamics[two_ ? side - 1 : 0]);
  S sum(0.0);
  for (std::size_t k = 0; k < 2; ++k) {
    const BladeElement<double>& wings = drives_[k]->vehicle().wings;
    const double centre = wings.s2 > 0.0 ? wings.s3 / wings.s2 : 0.0, left = k == 0 ? 1.0 : -1.0;
    const AeroLoads<S>& air = dynamics[k].motion.aero;
    const S& beta = dynamics[k].stroke_angle;
    switch (which) {
      case OutputId::roll_moment: sum = sum + left * air.lift * (settings_.hinge_offset + centre * cos(beta)); break;
      case OutputId::pitch_moment: sum = sum + air.lift * centre * sin(beta); break;
      case OutputId::yaw_moment:
        if (centre > 0.0) sum = sum - left * air.moment * (1.0 + settings_.hinge_offset / centre * cos(beta));
        break;
      default: sum = sum + drives_[k]->output(which, dynamics[k]); break;
    }
  }
  return sum;
}

std::optional<double> Instance::real(std::size_t reference) const {
  const std::size_t number = number_of(reference), side = side_of(reference), index = index_of(reference);
  const DriveInTime* const one = drive(side);
  const VariableKind kind = kind_of(reference);
  if (side == body_side && kind != VariableKind::parameter && kind != VariableKind::text) {
    return real_of_body(kind, index);
  }
  meet_air();
  switch (kind) {
    case VariableKind::time: return time();
    case VariableKind::state:
      return one && index < one->layout().count() ? std::optional(one->states()[index]) : std::nullopt;
    case VariableKind::derivative:
      return one && index < one->layout().count() ? std::optional(one->rates()[index]) : std::nullopt;
    case VariableKind::input: return one ? one->input(index) : std::nullopt;
    case VariableKind::output: {
      const OutputId which = OutputId(index);
      if (index >= std::size_t(OutputId::last) || (!one && !(two_ && side == 0 && has_total(which)))) return {};
      std::vector<Dynamics<double>> dynamics;
      for (const auto& drive : drives_) dynamics.push_back(drive->now<double>({}));
      return output(which, side, dynamics);
    }
    case VariableKind::mean: {
      const MeanId which = MeanId(index);
      if (index >= std::size_t(MeanId::last)) return {};
      if (one) return one->mean(which);
      if (!two_ || side != 0 || !has_total(which)) return {};
      return drives_[0]->mean(which) + drives_[1]->mean(which);
    }
    case VariableKind::parameter: {
      const auto rows = parameter_table<double>();
      return number < rows.size() && rows[number].get ? rows[number].get(design_) : std::nullopt;
    }
    case VariableKind::indicator: {
      if (!one || index >= one->indicator_count()) return {};
      return one->indicators()[index];
    }
    case VariableKind::setting: {
      const double* const setting = member_of(settings_, number);
      return setting ? std::optional(*setting) : std::nullopt;
    }
    default: return std::nullopt;
  }
}

std::optional<int> Instance::whole(std::size_t reference) const {
  const DriveInTime* const one = drive(side_of(reference));
  if (kind_of(reference) != VariableKind::count || !one) return std::nullopt;
  switch (CountId(index_of(reference))) {
    case CountId::status: return int(one->status());
    case CountId::cycles: return int(std::min<std::int64_t>(one->cycles(), std::numeric_limits<int>::max()));
  }
  return std::nullopt;
}

std::string Instance::text(std::size_t reference) const {
  const auto rows = parameter_table<double>();
  const std::size_t number = number_of(reference);
  if (kind_of(reference) != VariableKind::text || number >= rows.size() || !rows[number].text) return {};
  return rows[number].text(design_);
}

bool Instance::set_real(std::size_t reference, double value) {
  const std::size_t number = number_of(reference);
  const bool setting_of_body = kind_of(reference) == VariableKind::setting && side_of(reference) == body_side;
  if (setting_of_body || (kind_of(reference) == VariableKind::input && side_of(reference) == body_side)) {
    double* const x = !body_            ? nullptr
                      : setting_of_body ? member_of(body_->settings, index_of(reference))
                                        : member_of(body_->inputs, index_of(reference));
    if (x) *x = value;
    return x != nullptr;
  }
  switch (kind_of(reference)) {
    case VariableKind::input: {
      const std::size_t side = side_of(reference);
      return drive(side) && drives_[two_ ? side - 1 : 0]->set_input(index_of(reference), value);
    }
    case VariableKind::parameter: {
      const auto rows = parameter_table<double>();
      if (number >= rows.size() || !rows[number].set || !rows[number].range.holds(value)) return false;
      const double motors = design_.motors;
      if (!rows[number].set(design_, value)) return false;
      if (design_.motors != motors && two_) {
        design_.motors = motors;
        return false;
      }
      changed_ = true;
      return true;
    }
    case VariableKind::setting: {
      double* const setting = member_of(settings_, number);
      if (!setting) return false;
      if (SettingId(number) == SettingId::tolerance && !(value >= 1e-12 && value <= 1e-2)) return false;
      if (SettingId(number) == SettingId::hinge_offset && !(value >= 0.0)) return false;
      *setting = value;
      changed_ = true;
      return true;
    }
    default: return false;
  }
}

std::vector<double> Instance::directional(const std::vector<std::size_t>& unknowns,
                                          const std::vector<Direction>& knowns) {
  if (body_) return differences(unknowns, knowns);
  std::vector<Dynamics<Jet<1>>> dynamics;
  const auto by_input = [&](std::size_t side, InputId input) {
    double change = 0.0;
    for (const Direction& d : knowns) {
      if (d.reference == reference_of(VariableKind::input, std::size_t(input), side)) change += d.change;
    }
    return change;
  };
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    std::vector<DriveInTime::Direction> own;
    for (const Direction& d : knowns) {
      if (side_of(d.reference) == (two_ ? k + 1 : 0)) {
        own.push_back({kind_of(d.reference), index_of(d.reference), d.change});
      }
    }
    dynamics.push_back(drives_[k]->now<Jet<1>>(own));
  }
  std::vector<double> found;
  for (const std::size_t reference : unknowns) {
    const std::size_t side = side_of(reference), index = index_of(reference);
    if (kind_of(reference) == VariableKind::output) {
      found.push_back(output(OutputId(index), side, dynamics).v[0]);
      continue;
    }
    const StateLayout& layout = drive(side)->layout();
    const Dynamics<Jet<1>>& along = dynamics[two_ ? side - 1 : 0];
    if (index < layout.indices.count) found.push_back(along.rates[index].v[0]);
    else if (index < layout.first_sum()) found.push_back(two_pi * by_input(side, InputId::frequency));
    else found.push_back(along.integrands[std::size_t(exposed_sums[index - layout.first_sum()].integral)].v[0]);
  }
  return found;
}

}  // namespace wingbeat::fmu

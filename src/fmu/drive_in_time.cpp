#include "fmu/drive_in_time.hpp"

#include <algorithm>
#include <cmath>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::fmu {
namespace {

/// Room on either side of an event: an indicator is this where it has just been handled, and handled once it is below
/// the larger one.
constexpr double indicator_rest = 1e-10, indicator_due = 1e-9;
/// [Hz]
constexpr double highest_frequency = 1e9;

MeasuredModel model_of(const Design<double>& design, const Vehicle<double>& vehicle) {
  // A pwm supply whose duty is an input may switch although its parameter is 0 or 1.
  Supply<double> supply = design.supply;
  if (supply.type == SupplyType::pwm) supply.duty = 0.5;
  if (supply.frequency > highest_frequency || vehicle.drive_frequency > highest_frequency) {
    throw ParameterError("supply.frequency", "must be <= 1e9 Hz of an FMU");
  }
  return {vehicle, supply};
}

/// Number of the model's indicator of an event; behind the last one where the model knows it by its time.
std::size_t indicator_of(Watched event, bool direct) {
  switch (event) {
    case Watched::standstill:
    case Watched::slip_end: return MeasuredModel::standstill;
    case Watched::jam: return MeasuredModel::jam;
    case Watched::stop: return MeasuredModel::stop;
    case Watched::cycle_end: return direct ? MeasuredModel::indicator_count : MeasuredModel::cycle_end;
    case Watched::rest: return MeasuredModel::rest;
  }
  return MeasuredModel::indicator_count;
}

Inputs inputs_of(const Design<double>& design, const Vehicle<double>& vehicle) {
  Inputs inputs;
  inputs.voltage = design.supply.type == SupplyType::pwm ? design.supply.voltage : mean_voltage(design.supply);
  inputs.duty = design.supply.duty;
  inputs.frequency = vehicle.drive_frequency;
  return inputs;
}

}  // namespace

DriveInTime::DriveInTime(const Design<double>& design, bool one_of_two, const Settings& settings)
    : one_of_two_(one_of_two),
      layout_(drive_vehicle(design, one_of_two)),
      model_(model_of(design, drive_vehicle(design, one_of_two))),
      watched_(watched_events(vehicle())) {
  build(design, settings);
}

void DriveInTime::build(const Design<double>& design, const Settings& settings) {
  const Vehicle<double> vehicle = drive_vehicle(design, one_of_two_);
  const StateLayout layout(vehicle);
  if (layout.indices.inductive != layout_.indices.inductive) {
    throw ParameterError("motor.armature_inductance", layout_.indices.inductive
                                                          ? "must stay > 0 H: the current is a state"
                                                          : "must stay 0 H: the current is no state");
  }
  if (layout.indices.rotates != layout_.indices.rotates || layout.indices.pitching != layout_.indices.pitching ||
      watched_events(vehicle) != watched_) {
    throw ParameterError("vehicle", "must keep the states and events that it was exported with");
  }
  MeasuredModel next = model_of(design, vehicle);
  stated_inputs_ = inputs_of(design, vehicle);
  for (std::size_t k = 0; double* const input = member_of(inputs_, k); ++k) {
    if (!(inputs_set_ >> k & 1u)) *input = *member_of(stated_inputs_, k);
  }
  model_ = std::move(next);
  start(settings);
  feel_flow();
}

void DriveInTime::feel(std::shared_ptr<const OnsetFlow> flow, const WakeStrips<double>& strips) {
  flow_ = std::move(flow);
  strips_ = strips;
  feel_flow();
}

void DriveInTime::feel_flow() {
  if (!flow_) return;
  model_.vehicle.wings.flow = flow_;
  model_.vehicle.wings.wake.strips = strips_;
}

void DriveInTime::scale_to(double voltage) {
  model_.vehicle.wings.flow = nullptr;
  model_.scale_to(scaled_to_ = voltage);
  feel_flow();
}

detail::DriveInstant DriveInTime::instant_now() const {
  detail::DriveInstant instant;
  instant.place = model_.indices.coordinates(model_.coordinates_now().data());
  instant.at = model_.instant(model_.now.t, instant.place);
  instant.mode = mode_at(model_.vehicle, instant.at, model_.mode(), &instant.motion);
  return instant;
}

MeasuredModel& DriveInTime::begin_step() {
  apply_inputs();
  return model_;
}

void DriveInTime::start(const Settings& settings) {
  model_.start({settings.angle, settings.speed, settings.current, settings.pitch_angle, settings.pitch_velocity});
  model_.scale_to(std::abs(stated_inputs_.voltage));
  model_.judge_rest_by_typical();
  if (model_.direct) {
    model_.command = [this](double t) {
      return inputs_.voltage * std::sin(model_.phase_at(t)) + inputs_.voltage_offset;
    };
  } else if (model_.supply.type != SupplyType::pwm) {
    model_.command = [this](double) { return inputs_.voltage; };
  }
  scaled_to_ = 0.0;
  apply_inputs();
}

void DriveInTime::change(const Design<double>& design, const Settings& settings) {
  const Moving kept = motion();
  const Inputs inputs = inputs_;
  build(design, settings);
  inputs_ = inputs;  // what drives now, whatever the parameters say
  set_motion(kept);
}

void DriveInTime::initialise(const Design<double>& design, const Settings& settings, double time) {
  build(design, settings);
  model_.now.t = time;
  model_.catch_up_with_supply();
  if (model_.indices.inductive) model_.now.moving.current = settings.current;
  model_.start_cycles();
}

std::optional<double> DriveInTime::input(std::size_t index) const {
  const double* const input = member_of(inputs_, index);
  return input ? std::optional(*input) : std::nullopt;
}

bool DriveInTime::set_input(std::size_t index, double value) {
  double* const input = member_of(inputs_, index);
  if (!input) return false;
  if (InputId(index) == InputId::duty && !(value >= 0.0 && value <= 1.0)) return false;
  if (InputId(index) == InputId::frequency && !(value > 0.0 && value <= highest_frequency)) return false;
  *input = value;
  inputs_set_ |= 1u << index;
  apply_inputs();
  return true;
}

double DriveInTime::voltage_scale() const {
  return std::max(std::abs(inputs_.voltage) + std::abs(inputs_.voltage_offset),
                  1e-3 * std::abs(stated_inputs_.voltage));
}

/// What inputs are to the model.
void DriveInTime::apply_inputs() {
  const double scale = voltage_scale();
  model_.vehicle.load_torque = inputs_.load_torque;
  if (model_.supply.type == SupplyType::pwm) {
    model_.supply.voltage = inputs_.voltage;
    model_.supply.duty = inputs_.duty;
    model_.now.switched_voltage = model_.now.switches % 2 == 0 ? inputs_.voltage : 0.0;
  } else if (model_.direct && inputs_.frequency != model_.vehicle.drive_frequency) {
    model_.set_frequency(inputs_.frequency);
    scaled_to_ = 0.0;
  }
  if (scale != scaled_to_ && scale > 0.0) scale_to(scale);
}

const Vehicle<double>& DriveInTime::vehicle() const { return model_.vehicle; }
double DriveInTime::time() const { return model_.now.t; }

void DriveInTime::set_time(double t) {
  // The phase of a direct drive's supply is a state: it does not follow the time by itself.
  model_.now.t = model_.means.phase_time = t;
}

std::vector<double> DriveInTime::states() const {
  double y[max_unknowns + detail::quadrature_count] = {};
  model_.unknowns(y);
  std::vector<double> states(y, y + layout_.indices.count);
  if (layout_.has_phase) states.push_back(model_.phase_at(model_.now.t));
  for (const ExposedSum& sum : exposed_sums) {
    states.push_back(y[layout_.indices.count + detail::quadrature_of(sum.integral)]);
  }
  return states;
}

void DriveInTime::set_states(const double* given) {
  double y[max_unknowns + detail::quadrature_count] = {};
  model_.unknowns(y);
  std::copy_n(given, layout_.indices.count, y);
  for (std::size_t k = 0; k < exposed_sum_count; ++k) {
    y[layout_.indices.count + detail::quadrature_of(exposed_sums[k].integral)] = given[layout_.first_sum() + k];
  }
  if (layout_.has_phase) {
    model_.means.phase = given[layout_.phase()];
    model_.means.phase_time = model_.now.t;
  }
  model_.set(model_.now.t, y);
}

template <Scalar S>
Dynamics<S> DriveInTime::now(const std::vector<Direction>& knowns) const {
  Vehicle<S> vehicle = cast<S>(model_.vehicle);
  double numbers[max_unknowns + detail::quadrature_count] = {};
  model_.unknowns(numbers);
  std::array<S, max_unknowns> y;
  for (std::size_t k = 0; k < max_unknowns; ++k) y[k] = S(k < layout_.indices.count ? numbers[k] : 0.0);
  S v_s(model_.voltage(model_.now.t));
  if constexpr (ScalarTraits<S>::differentiates) {
    double by_voltage = 1.0, by_phase = 0.0;
    if (layout_.has_phase) {
      const double phase = model_.phase_at(model_.now.t);
      by_voltage = std::sin(phase);
      by_phase = inputs_.voltage * std::cos(phase);
    } else if (model_.supply.type == SupplyType::pwm) {
      by_voltage = model_.now.switches % 2 == 0 ? 1.0 : 0.0;
    }
    for (const Direction& known : knowns) {
      if (known.kind == VariableKind::state) {
        if (known.index < layout_.indices.count) y[known.index].v[0] += known.change;
        else if (layout_.has_phase && known.index == layout_.phase()) v_s.v[0] += known.change * by_phase;
        continue;
      }
      switch (InputId(known.index)) {
        case InputId::voltage: v_s.v[0] += known.change * by_voltage; break;
        case InputId::voltage_offset: v_s.v[0] += known.change; break;
        case InputId::load_torque: vehicle.load_torque.v[0] += known.change; break;
        case InputId::duty:
        case InputId::frequency: break;
      }
    }
  }
  return evaluate<S>(vehicle, cast<S>(model_.mode()), y.data(), v_s);
}
template Dynamics<double> DriveInTime::now(const std::vector<Direction>&) const;
template Dynamics<Jet<1>> DriveInTime::now(const std::vector<Direction>&) const;

template <Scalar S>
S DriveInTime::output(OutputId which, const Dynamics<S>& dynamics) const {
  const Motion<S>& m = dynamics.motion;
  const Vehicle<double>& v = vehicle();
  switch (which) {
    case OutputId::crank_angle: return dynamics.moving.angle;
    case OutputId::crank_speed: return dynamics.moving.speed;
    case OutputId::stroke_angle: return dynamics.stroke_angle;
    case OutputId::flapping_velocity: return m.stroke_velocity;
    case OutputId::pitch_angle: return dynamics.moving.pitch_angle;
    case OutputId::pitch_velocity: return dynamics.moving.pitch_velocity;
    case OutputId::current: return m.current;
    case OutputId::terminal_voltage: return m.voltage;
    case OutputId::lift: return m.aero.lift;
    case OutputId::drag_moment: return m.aero.moment;
    case OutputId::rod_force: return m.rod_force / v.motors;
    case OutputId::motor_torque: return m.motor_torque;
    case OutputId::friction_torque: return m.friction_torque;
    case OutputId::power_electrical: return m.voltage * m.current;
    case OutputId::power_motor: return m.motor_torque * dynamics.moving.speed;
    case OutputId::power_friction: return m.friction_torque * dynamics.moving.speed;
    case OutputId::power_aerodynamic: return m.aero.power;
    case OutputId::power_copper: return v.motor.armature_resistance * m.current * m.current;
    case OutputId::power_viscous: return v.motor.viscous_damping * dynamics.moving.speed * dynamics.moving.speed;
    case OutputId::power_motor_friction:
      return v.motor.friction_torque * sign_of(dynamics.moving.speed) * dynamics.moving.speed;
    case OutputId::power_load: return dynamics.load_torque * dynamics.moving.speed;
    case OutputId::roll_moment:
    case OutputId::pitch_moment:
    case OutputId::yaw_moment:
    case OutputId::last: break;
  }
  return S(0.0);
}
template double DriveInTime::output(OutputId, const Dynamics<double>&) const;
template Jet<1> DriveInTime::output(OutputId, const Dynamics<Jet<1>>&) const;

std::vector<double> DriveInTime::rates() const {
  const Dynamics<double> dynamics = now<double>({});
  std::vector<double> rates(dynamics.rates.begin(), dynamics.rates.begin() + long(layout_.indices.count));
  if (layout_.has_phase) rates.push_back(two_pi * inputs_.frequency);
  for (const ExposedSum& sum : exposed_sums) rates.push_back(dynamics.integrands[std::size_t(sum.integral)]);
  return rates;
}

std::vector<double> DriveInTime::nominals() const {
  const auto typical = model_.typical();
  std::vector<double> sizes;
  for (std::size_t k = 0; k < layout_.indices.count; ++k) sizes.push_back(typical[k] > 0.0 ? typical[k] : 1.0);
  if (layout_.has_phase) sizes.push_back(1.0);
  // Of the sums what a tenth of a second gives, about.
  const double current = std::max(std::abs(inputs_.voltage), 1e-3) / circuit_resistance(model_.vehicle);
  const double power = std::max(std::abs(inputs_.voltage), 1e-3) * current;
  for (const double rate : {1e-2, current, current * current, square(typical[1]), power, power, power}) {
    sizes.push_back(0.1 * rate);
  }
  return sizes;
}

double DriveInTime::mean(MeanId which) const {
  const CycleMeans& means = model_.means;
  if (!model_.has_means()) return 0.0;
  const auto mean = [&](Integral integral) { return means.mean[detail::quadrature_of(integral)]; };
  switch (which) {
    case MeanId::frequency: return 1.0 / means.period;
    case MeanId::lift: return mean(Integral::lift);
    case MeanId::current: return mean(Integral::current);
    case MeanId::power_electrical: return mean(Integral::electrical_work);
    case MeanId::power_friction: return mean(Integral::friction_work);
    case MeanId::power_aerodynamic: return mean(Integral::aero_work);
    case MeanId::power_copper: return model_.vehicle.motor.armature_resistance * mean(Integral::current_square);
    case MeanId::last: break;
  }
  return 0.0;
}

Status DriveInTime::status() const {
  if (model_.ended()) return Status::jammed;
  if (model_.stands()) return Status::standing;
  return model_.means.whole ? Status::flapping : Status::starting;
}

std::int64_t DriveInTime::cycles() const { return model_.means.cycles; }

std::vector<double> DriveInTime::indicators() const {
  double y[max_unknowns + detail::quadrature_count] = {};
  model_.unknowns(y);
  const auto values = model_.indicators(model_.now.t, y);
  const auto directions = model_.directions();
  std::vector<double> watched;
  for (const Watched event : watched_) {
    const std::size_t k = indicator_of(event, model_.direct);
    if (k < MeasuredModel::indicator_count) {
      watched.push_back(-double(directions[k]) * values[k] + indicator_rest);
    } else {
      watched.push_back(1.0 - (model_.phase_at(model_.now.t) - model_.means.mark) / two_pi + indicator_rest);
    }
  }
  return watched;
}

void DriveInTime::handle_events() {
  const std::vector<double> due = indicators();
  if (model_.ended()) return;
  for (std::size_t n = 0; n < watched_.size(); ++n) {
    if (!(due[n] <= indicator_due)) continue;
    const std::size_t k = indicator_of(watched_[n], model_.direct);
    if (k < MeasuredModel::indicator_count) model_.handle(k);
    else model_.switch_supply();
  }
  model_.follow_supply();
  model_.begin_piece();
}

double DriveInTime::next_event() const {
  // The end of a direct drive's cycle follows from a state, the phase.
  return model_.direct ? infinity : model_.next_switch();
}

bool DriveInTime::ended() const { return model_.ended(); }

StepResult DriveInTime::step_to(double until, double tolerance, std::int64_t work) {
  apply_inputs();
  const auto before = model_.now;
  const CycleMeans means = model_.means;
  model_.work_left = work;
  StepResult result = StepResult::failed;
  try {
    switch (detail::step_to(model_, until, tolerance)) {
      case detail::StepOutcome::reached: result = StepResult::reached; break;
      case detail::StepOutcome::ended: result = StepResult::jammed; break;
      default: break;
    }
  } catch (const WorkSpent&) {
    result = StepResult::too_much;
  }
  if (result != StepResult::reached && result != StepResult::jammed) {
    model_.now = before;
    model_.means = means;
  }
  return result;
}

}  // namespace wingbeat::fmu

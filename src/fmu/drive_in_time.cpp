#include "fmu/drive_in_time.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat::fmu {
namespace {

/// Room on either side of an event: an indicator is this where it has just been handled, and handled once it is below
/// the larger one.
constexpr double indicator_rest = 1e-10, indicator_due = 1e-9;
/// [Hz]
constexpr double highest_frequency = 1e9;

AnyModel model_of(const Design<double>& design, const Vehicle<double>& vehicle) {
  if (!drive_of(vehicle).alternating) {
    // A pwm supply whose duty is an input may switch although its parameter is 0 or 1.
    Supply<double> supply = design.supply;
    if (supply.type == SupplyType::pwm) {
      supply.duty = 0.5;
      if (supply.frequency > highest_frequency) {
        throw ParameterError("supply.frequency", "must be <= 1e9 Hz of an FMU");
      }
    }
    return MeasuredModel<detail::CrankModel>(vehicle, supply);
  }
  if (vehicle.drive_frequency > highest_frequency) {
    throw ParameterError("supply.frequency", "must be <= 1e9 Hz of an FMU");
  }
  if (pitches(vehicle)) return MeasuredModel<detail::PitchDirectModel>(vehicle);
  return MeasuredModel<detail::DirectModel>(vehicle);
}

template <class Model>
constexpr bool is_crank = std::is_same_v<Model, MeasuredModel<detail::CrankModel>>;

/// Number of the model's indicator of an event; behind the last one where the model knows it by its time.
template <class Model>
std::size_t indicator_of(Watched event) {
  switch (event) {
    case Watched::standstill:
      if constexpr (is_crank<Model>) return Model::standstill;
      break;
    case Watched::jam:
      if constexpr (is_crank<Model>) return Model::jam;
      break;
    case Watched::stop:
      if constexpr (requires { Model::stop; }) return Model::stop;
      break;
    case Watched::cycle_end:
      if constexpr (is_crank<Model>) return Model::cycle_end;
      break;
    case Watched::slip_end:
      if constexpr (requires { Model::motion_ends; }) return Model::motion_ends;
      break;
    case Watched::rest:
      if constexpr (is_crank<Model>) return Model::rest;
      break;
  }
  return Model::indicator_count;
}

void start_at(MeasuredModel<detail::CrankModel>& model, const Settings& s) {
  model.start(s.angle, s.speed, s.current, s.pitch_angle, s.pitch_velocity);
}
void start_at(MeasuredModel<detail::DirectModel>& model, const Settings& s) {
  model.start(s.angle, s.speed, s.current);
}
void start_at(MeasuredModel<detail::PitchDirectModel>& model, const Settings& s) {
  model.start({s.angle, s.speed, s.pitch_angle, s.pitch_velocity, s.current});
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
  if (layout.indices.crank != layout_.indices.crank || layout.indices.pitching != layout_.indices.pitching ||
      watched_events(vehicle) != watched_) {
    throw ParameterError("vehicle", "must keep the states and events that it was exported with");
  }
  AnyModel next = model_of(design, vehicle);
  stated_inputs_ = inputs_of(design, vehicle);
  for (std::size_t k = 0; double* const input = member_of(inputs_, k); ++k) {
    if (!(inputs_set_ >> k & 1u)) *input = *member_of(stated_inputs_, k);
  }
  model_ = std::move(next);
  start(settings);
}

void DriveInTime::start(const Settings& settings) {
  std::visit(
      [&](auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        start_at(model, settings);
        model.scale_to(std::abs(stated_inputs_.voltage));
        model.judge_rest_by_typical();
        if constexpr (is_crank<M>) {
          if (model.supply.type != SupplyType::pwm) model.command = [this](double) { return inputs_.voltage; };
        } else {
          model.command = [this](double t) {
            return inputs_.voltage * std::sin(std::get<M>(model_).phase_at(t)) + inputs_.voltage_offset;
          };
        }
      },
      model_);
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
  std::visit(
      [&](auto& model) {
        model.now.t = time;
        model.catch_up_with_supply();
        if constexpr (requires { model.now.i; }) model.now.i = model.inductive ? settings.current : model.now.i;
        model.start_cycles();
      },
      model_);
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
  std::visit(
      [&](auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        model.vehicle.load_torque = inputs_.load_torque;
        if constexpr (is_crank<M>) {
          if (model.supply.type == SupplyType::pwm) {
            model.supply.voltage = inputs_.voltage;
            model.supply.duty = inputs_.duty;
            model.now.switched_voltage = model.now.switches % 2 == 0 ? inputs_.voltage : 0.0;
          }
        } else if (inputs_.frequency != model.vehicle.drive_frequency) {
          model.set_frequency(inputs_.frequency);
          scaled_to_ = 0.0;
        }
        if (scale != scaled_to_ && scale > 0.0) model.scale_to(scaled_to_ = scale);
      },
      model_);
}

const Vehicle<double>& DriveInTime::vehicle() const {
  return std::visit([](const auto& model) -> const Vehicle<double>& { return model.vehicle; }, model_);
}

double DriveInTime::time() const {
  return std::visit([](const auto& model) { return model.now.t; }, model_);
}

void DriveInTime::set_time(double t) {
  // The phase of a direct drive's supply is a state: it does not follow the time by itself.
  std::visit([&](auto& model) { model.now.t = model.means.phase_time = t; }, model_);
}

std::vector<double> DriveInTime::states() const {
  return std::visit(
      [&](const auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        double y[max_unknowns + detail::quadrature_count] = {};
        model.unknowns(y);
        std::vector<double> states(y, y + layout_.indices.count);
        if constexpr (!is_crank<M>) states.push_back(model.phase_at(model.now.t));
        for (const ExposedSum& sum : exposed_sums) {
          states.push_back(y[layout_.indices.count + detail::quadrature_of(sum.integral)]);
        }
        return states;
      },
      model_);
}

void DriveInTime::set_states(const double* given) {
  std::visit(
      [&](auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        double y[max_unknowns + detail::quadrature_count] = {};
        model.unknowns(y);
        std::copy_n(given, layout_.indices.count, y);
        for (std::size_t k = 0; k < exposed_sum_count; ++k) {
          y[layout_.indices.count + detail::quadrature_of(exposed_sums[k].integral)] = given[layout_.first_sum() + k];
        }
        if constexpr (!is_crank<M>) {
          model.means.phase = given[layout_.phase()];
          model.means.phase_time = model.now.t;
        }
        model.set(model.now.t, y);
      },
      model_);
}

template <Scalar S>
Dynamics<S> DriveInTime::now(const std::vector<Direction>& knowns) const {
  return std::visit(
      [&](const auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        Vehicle<S> vehicle = cast<S>(model.vehicle);
        double numbers[max_unknowns + detail::quadrature_count] = {};
        model.unknowns(numbers);
        std::array<S, max_unknowns> y;
        for (std::size_t k = 0; k < max_unknowns; ++k) y[k] = S(k < layout_.indices.count ? numbers[k] : 0.0);
        S v_s(model.voltage(model.now.t));
        if constexpr (ScalarTraits<S>::differentiates) {
          double by_voltage = 1.0, by_phase = 0.0;
          if constexpr (!is_crank<M>) {
            const double phase = model.phase_at(model.now.t);
            by_voltage = std::sin(phase);
            by_phase = inputs_.voltage * std::cos(phase);
          } else if (model.supply.type == SupplyType::pwm) {
            by_voltage = model.now.switches % 2 == 0 ? 1.0 : 0.0;
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
        return evaluate<S>(vehicle, model.mode(), y.data(), v_s);
      },
      model_);
}
template Dynamics<double> DriveInTime::now(const std::vector<Direction>&) const;
template Dynamics<Jet<1>> DriveInTime::now(const std::vector<Direction>&) const;

template <Scalar S>
S DriveInTime::output(OutputId which, const Dynamics<S>& dynamics) const {
  const Motion<S>& m = dynamics.motion;
  const Vehicle<double>& v = vehicle();
  switch (which) {
    case OutputId::crank_angle: return dynamics.angle;
    case OutputId::crank_speed: return dynamics.shaft_speed;
    case OutputId::stroke_angle: return dynamics.stroke_angle;
    case OutputId::flapping_velocity: return m.stroke_velocity;
    case OutputId::pitch_angle: return dynamics.pitch_angle;
    case OutputId::pitch_velocity: return dynamics.pitch_velocity;
    case OutputId::current: return m.current;
    case OutputId::terminal_voltage: return m.voltage;
    case OutputId::lift: return m.aero.lift;
    case OutputId::drag_moment: return m.aero.moment;
    case OutputId::rod_force: return m.rod_force / v.motors;
    case OutputId::motor_torque: return m.motor_torque;
    case OutputId::friction_torque: return m.friction_torque;
    case OutputId::power_electrical: return m.voltage * m.current;
    case OutputId::power_motor: return m.motor_torque * dynamics.shaft_speed;
    case OutputId::power_friction: return m.friction_torque * dynamics.shaft_speed;
    case OutputId::power_aerodynamic: return m.aero.power;
    case OutputId::power_copper: return v.motor.armature_resistance * m.current * m.current;
    case OutputId::power_viscous: return v.motor.viscous_damping * dynamics.shaft_speed * dynamics.shaft_speed;
    case OutputId::power_motor_friction:
      return v.motor.friction_torque * sign_of(dynamics.shaft_speed) * dynamics.shaft_speed;
    case OutputId::power_load: return dynamics.load_torque * dynamics.shaft_speed;
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
  return std::visit(
      [&](const auto& model) {
        const auto typical = model.typical();
        std::vector<double> sizes;
        for (std::size_t k = 0; k < layout_.indices.count; ++k) sizes.push_back(typical[k] > 0.0 ? typical[k] : 1.0);
        if (layout_.has_phase) sizes.push_back(1.0);
        // Of the sums what a tenth of a second gives, about.
        const double current = std::max(std::abs(inputs_.voltage), 1e-3) / circuit_resistance(model.vehicle);
        const double power = std::max(std::abs(inputs_.voltage), 1e-3) * current;
        for (const double rate : {1e-2, current, current * current, square(typical[1]), power, power, power}) {
          sizes.push_back(0.1 * rate);
        }
        return sizes;
      },
      model_);
}

double DriveInTime::mean(MeanId which) const {
  return std::visit(
      [&](const auto& model) {
        const CycleMeans& means = model.means;
        if (!model.has_means()) return 0.0;
        const auto mean = [&](Integral integral) { return means.mean[detail::quadrature_of(integral)]; };
        switch (which) {
          case MeanId::frequency: return 1.0 / means.period;
          case MeanId::lift: return mean(Integral::lift);
          case MeanId::current: return mean(Integral::current);
          case MeanId::power_electrical: return mean(Integral::electrical_work);
          case MeanId::power_friction: return mean(Integral::friction_work);
          case MeanId::power_aerodynamic: return mean(Integral::aero_work);
          case MeanId::power_copper: return model.vehicle.motor.armature_resistance * mean(Integral::current_square);
          case MeanId::last: break;
        }
        return 0.0;
      },
      model_);
}

Status DriveInTime::status() const {
  return std::visit(
      [](const auto& model) {
        if (model.ended()) return Status::jammed;
        if (model.stands()) return Status::standing;
        return model.means.whole ? Status::flapping : Status::starting;
      },
      model_);
}

std::int64_t DriveInTime::cycles() const {
  return std::visit([](const auto& model) { return model.means.cycles; }, model_);
}

std::vector<double> DriveInTime::indicators() const {
  return std::visit(
      [&](const auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        double y[max_unknowns + detail::quadrature_count] = {};
        model.unknowns(y);
        const auto values = model.indicators(model.now.t, y);
        const auto directions = model.directions();
        std::vector<double> watched;
        for (const Watched event : watched_) {
          const std::size_t k = indicator_of<M>(event);
          if (k < M::indicator_count) {
            watched.push_back(-double(directions[k]) * values[k] + indicator_rest);
          } else if constexpr (!is_crank<M>) {
            const CycleMeans& means = model.means;
            watched.push_back(1.0 - (model.phase_at(model.now.t) - means.mark) / two_pi + indicator_rest);
          }
        }
        return watched;
      },
      model_);
}

void DriveInTime::handle_events() {
  const std::vector<double> due = indicators();
  std::visit(
      [&](auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        if (model.ended()) return;
        for (std::size_t n = 0; n < watched_.size(); ++n) {
          if (!(due[n] <= indicator_due)) continue;
          const std::size_t k = indicator_of<M>(watched_[n]);
          if (k < M::indicator_count) model.handle(k);
          else model.switch_supply();
        }
        model.follow_supply();
        model.begin_piece();
      },
      model_);
}

double DriveInTime::next_event() const {
  return std::visit(
      [](const auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        if constexpr (is_crank<M>) return model.next_switch();
        else return infinity;  // the end of a cycle follows from a state, the phase
      },
      model_);
}

bool DriveInTime::ended() const {
  return std::visit([](const auto& model) { return model.ended(); }, model_);
}

StepResult DriveInTime::step_to(double until, double tolerance, std::int64_t work) {
  apply_inputs();
  return std::visit(
      [&](auto& model) {
        const auto before = model.now;
        const CycleMeans means = model.means;
        model.work_left = work;
        StepResult result = StepResult::failed;
        try {
          switch (detail::step_to(model, until, tolerance)) {
            case detail::StepOutcome::reached: result = StepResult::reached; break;
            case detail::StepOutcome::ended: result = StepResult::jammed; break;
            default: break;
          }
        } catch (const WorkSpent&) {
          result = StepResult::too_much;
        }
        if (result != StepResult::reached && result != StepResult::jammed) {
          model.now = before;
          model.means = means;
        }
        return result;
      },
      model_);
}

}  // namespace wingbeat::fmu

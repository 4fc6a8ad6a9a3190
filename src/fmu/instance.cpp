#include "fmu/instance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "wingbeat/core/jet.hpp"
#include "wingbeat/vehicle/parameters.hpp"

namespace wingbeat::fmu {
namespace {

Vehicle<double> vehicle_of(const Design<double>& design) { return switched_on(resolve(design)); }

AnyModel model_of(const Design<double>& design) {
  const Vehicle<double> vehicle = vehicle_of(design);
  if (!drive_of(vehicle).alternating) {
    // A pwm supply whose duty is an input may switch although its parameter is 0 or 1.
    Supply<double> supply = design.supply;
    if (supply.type == SupplyType::pwm) supply.duty = 0.5;
    return MeasuredModel<detail::CrankModel>(vehicle, supply);
  }
  if (pitches(vehicle)) return MeasuredModel<detail::PitchDirectModel>(vehicle);
  return MeasuredModel<detail::DirectModel>(vehicle);
}

template <class Model>
constexpr bool is_crank = std::is_same_v<Model, MeasuredModel<detail::CrankModel>>;

/// Number of the model's indicator of an event that it has.
template <class Model>
std::size_t indicator_of(Watched event) {
  if constexpr (is_crank<Model>) {
    switch (event) {
      case Watched::standstill: return Model::standstill;
      case Watched::jam: return Model::jam;
      case Watched::stop: return Model::stop;
      default: return Model::cycle_end;
    }
  } else if constexpr (std::is_same_v<Model, MeasuredModel<detail::DirectModel>>) {
    return Model::motion_ends;
  } else {
    return Model::stop;
  }
}

/// Member `number` in the order of the list; nullptr behind the last.
template <class List>
auto* member_of(List& list, std::size_t number) {
  return List::members(list, [number](auto&... member) {
    const std::array all = {&member...};
    return number < sizeof...(member) ? all[number] : nullptr;
  });
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

Inputs inputs_of(const Design<double>& design) {
  Inputs inputs;
  inputs.voltage = design.supply.type == SupplyType::pwm ? design.supply.voltage : mean_voltage(design.supply);
  inputs.duty = design.supply.duty;
  return inputs;
}

}  // namespace

Instance::Instance(const Design<double>& design)
    : given_(design),
      design_(design),
      inputs_(inputs_of(design)),
      given_inputs_(inputs_),
      places_(vehicle_of(design)),
      supply_(design.supply),
      model_(model_of(design)) {
  validate(design);
  start_model();
}

void Instance::reset() {
  design_ = given_;
  inputs_ = given_inputs_;
  settings_ = {};
  changed_ = false;
  build();
}

void Instance::build() {
  validate(design_);
  supply_ = design_.supply;
  model_ = model_of(design_);
  start_model();
}

void Instance::start_model() {
  std::visit(
      [&](auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        start_at(model, settings_);
        if constexpr (is_crank<M>) {
          if (model.supply.type != SupplyType::pwm) model.command = [this](double) { return inputs_.voltage; };
        } else {
          model.command = [this, w = model.w](double t) {
            return inputs_.voltage * std::sin(w * t) + inputs_.voltage_offset;
          };
        }
        watched_.clear();
        for (const Watched event : watched_events(model.vehicle)) watched_.push_back(indicator_of<M>(event));
      },
      model_);
  scaled_to_ = 0.0;
  apply_inputs();
}

double Instance::supply_voltage_scale() const {
  return std::max(std::abs(inputs_.voltage) + std::abs(inputs_.voltage_offset), 1e-3 * given_inputs_.voltage);
}

/// What inputs are to the model.
void Instance::apply_inputs() {
  const double scale = supply_voltage_scale();
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
        }
        if (scale != scaled_to_ && scale > 0.0) model.scale_to(scaled_to_ = scale);
      },
      model_);
}

/// The vehicle with its parameters as they are now, at the state that it has.
void Instance::apply_parameters() {
  if (!changed_) return;
  changed_ = false;
  std::visit(
      [&](const auto& old) {
        const auto kept = old.now;
        const CycleMeans means = old.means;
        using M = std::remove_cvref_t<decltype(old)>;
        validate(design_);
        AnyModel next = model_of(design_);
        model_ = std::move(next);
        start_model();
        auto& model = std::get<M>(model_);
        model.now = kept;
        model.means = means;
      },
      AnyModel(model_));
  apply_inputs();
}

void Instance::initialise(double time) {
  build();
  changed_ = false;
  std::visit(
      [&](auto& model) {
        model.now.t = time;
        model.catch_up_with_supply();
        if constexpr (requires { model.now.i; }) model.now.i = model.inductive ? settings_.current : model.now.i;
        model.start_cycles();
        if constexpr (!is_crank<std::remove_cvref_t<decltype(model)>>) {
          model.means.next = (std::floor(time / model.period * (1.0 + 1e-15)) + 1.0) * model.period;
        }
      },
      model_);
}

double Instance::time() const {
  return std::visit([](const auto& model) { return model.now.t; }, model_);
}

std::vector<double> Instance::states() const {
  return std::visit(
      [&](const auto& model) {
        std::vector<double> y(max_unknowns + detail::quadrature_count);
        model.unknowns(y.data());
        std::vector<double> states(y.begin(), y.begin() + long(places_.count));
        for (const ExposedSum& sum : exposed_sums) {
          states.push_back(y[places_.count + detail::quadrature_of(sum.integral)]);
        }
        return states;
      },
      model_);
}

void Instance::set_states(const double* given) {
  std::visit(
      [&](auto& model) {
        std::vector<double> y(max_unknowns + detail::quadrature_count);
        model.unknowns(y.data());
        std::copy_n(given, places_.count, y.begin());
        for (std::size_t k = 0; k < exposed_sum_count; ++k) {
          y[places_.count + detail::quadrature_of(exposed_sums[k].integral)] = given[places_.count + k];
        }
        model.set(model.now.t, y.data());
      },
      model_);
}

void Instance::set_time(double t) {
  std::visit([&](auto& model) { model.now.t = t; }, model_);
}

template <Scalar S>
Everything<S> Instance::now(const std::vector<Direction>& knowns) const {
  return std::visit(
      [&](const auto& model) {
        using M = std::remove_cvref_t<decltype(model)>;
        Vehicle<S> vehicle = cast<S>(model.vehicle);
        double numbers[max_unknowns + detail::quadrature_count] = {};
        model.unknowns(numbers);
        std::array<S, max_unknowns> y;
        for (std::size_t k = 0; k < max_unknowns; ++k) y[k] = S(k < places_.count ? numbers[k] : 0.0);
        S v_s(model.voltage(model.now.t));
        if constexpr (ScalarTraits<S>::differentiates) {
          for (const Direction& known : knowns) {
            const std::size_t number = number_of(known.reference);
            if (kind_of(known.reference) == VariableKind::state) {
              if (number < places_.count) y[number].v[0] += known.change;
              continue;
            }
            double by_voltage = 1.0;
            if constexpr (!is_crank<M>) by_voltage = std::sin(model.w * model.now.t);
            else if (model.supply.type == SupplyType::pwm) by_voltage = model.now.switches % 2 == 0 ? 1.0 : 0.0;
            switch (InputId(number)) {
              case InputId::voltage: v_s.v[0] += known.change * by_voltage; break;
              case InputId::voltage_offset: v_s.v[0] += known.change; break;
              case InputId::duty: break;
              case InputId::load_torque: vehicle.load_torque.v[0] += known.change; break;
            }
          }
        }
        return evaluate<S>(vehicle, model.mode(), y.data(), v_s);
      },
      model_);
}

namespace {

template <Scalar S>
S output_of(OutputId which, const Everything<S>& at, const Vehicle<double>& v, const S& pitch_velocity) {
  const Motion<S>& m = at.motion;
  switch (which) {
    case OutputId::crank_angle: break;  // a state
    case OutputId::crank_speed: return at.shaft_speed;
    case OutputId::stroke_angle: return at.stroke_angle;
    case OutputId::flapping_velocity: return m.stroke_velocity;
    case OutputId::pitch_angle: return at.pitch_angle;
    case OutputId::pitch_velocity: return pitch_velocity;
    case OutputId::current: return m.current;
    case OutputId::terminal_voltage: return m.voltage;
    case OutputId::lift: return m.aero.lift;
    case OutputId::drag_moment: return m.aero.moment;
    case OutputId::rod_force: return m.rod_force / v.motors;
    case OutputId::motor_torque: return m.motor_torque;
    case OutputId::friction_torque: return m.friction_torque;
    case OutputId::power_electrical: return m.voltage * m.current;
    case OutputId::power_motor: return m.motor_torque * at.shaft_speed;
    case OutputId::power_friction: return m.friction_torque * at.shaft_speed;
    case OutputId::power_aerodynamic: return m.aero.power;
    case OutputId::power_copper: return v.motor.armature_resistance * m.current * m.current;
    case OutputId::power_viscous: return v.motor.viscous_damping * at.shaft_speed * at.shaft_speed;
    case OutputId::power_load: return v.load_torque * at.shaft_speed;
    case OutputId::last: break;
  }
  return S(0.0);
}

}  // namespace

std::vector<double> Instance::rates() const {
  const Everything<double> at = now<double>({});
  std::vector<double> rates(at.rates.begin(), at.rates.begin() + long(places_.count));
  for (const ExposedSum& sum : exposed_sums) rates.push_back(at.integrands[std::size_t(sum.integral)]);
  return rates;
}

std::vector<double> Instance::nominals() const {
  return std::visit(
      [&](const auto& model) {
        const auto typical = model.typical();
        std::vector<double> sizes;
        for (std::size_t k = 0; k < places_.count; ++k) sizes.push_back(typical[k] > 0.0 ? typical[k] : 1.0);
        // Of the sums what a tenth of a second gives, about.
        const double current = std::max(std::abs(inputs_.voltage), 1e-3) / circuit_resistance(model.vehicle);
        const double power = std::max(std::abs(inputs_.voltage), 1e-3) * current;
        for (const double rate : {1e-2, current, current * current, power, power, power}) {
          sizes.push_back(0.1 * rate);
        }
        return sizes;
      },
      model_);
}

std::vector<double> Instance::directional(const std::vector<std::size_t>& unknowns,
                                          const std::vector<Direction>& knowns) const {
  const Everything<Jet<1>> at = now<Jet<1>>(knowns);
  const auto known = [&](VariableKind kind, std::size_t number) {
    double change = 0.0;
    for (const Direction& d : knowns) {
      if (kind_of(d.reference) == kind && number_of(d.reference) == number) change += d.change;
    }
    return change;
  };
  std::vector<double> found;
  for (const std::size_t reference : unknowns) {
    const std::size_t number = number_of(reference);
    if (kind_of(reference) == VariableKind::derivative) {
      found.push_back(number < places_.count
                          ? at.rates[number].v[0]
                          : at.integrands[std::size_t(exposed_sums[number - places_.count].integral)].v[0]);
    } else if (OutputId(number) == OutputId::crank_angle) {
      found.push_back(known(VariableKind::state, 0));
    } else {
      const OutputId which = OutputId(number);
      Jet<1> turning(0.0);
      if (places_.pitching) turning = at.rates[places_.pitch];
      double derivative = output_of(which, at, vehicle(), turning).v[0];
      if (which == OutputId::power_load) {
        derivative += known(VariableKind::input, std::size_t(InputId::load_torque)) * at.shaft_speed.a;
      }
      found.push_back(derivative);
    }
  }
  return found;
}

const Vehicle<double>& Instance::vehicle() const {
  return std::visit([](const auto& model) -> const Vehicle<double>& { return model.vehicle; }, model_);
}

std::optional<double> Instance::real(std::size_t reference) const {
  const auto value_at = [](const double* of) { return of ? std::optional(*of) : std::nullopt; };
  const std::size_t number = number_of(reference);
  switch (kind_of(reference)) {
    case VariableKind::time: return time();
    case VariableKind::state: return number < state_count() ? std::optional(states()[number]) : std::nullopt;
    case VariableKind::derivative: return number < state_count() ? std::optional(rates()[number]) : std::nullopt;
    case VariableKind::input: return value_at(member_of(inputs_, number));
    case VariableKind::output: {
      if (number >= std::size_t(OutputId::last)) return std::nullopt;
      if (OutputId(number) == OutputId::crank_angle) return states()[0];
      const Everything<double> at = now<double>({});
      return output_of(OutputId(number), at, vehicle(), places_.pitching ? at.rates[places_.pitch] : 0.0);
    }
    case VariableKind::mean: {
      const CycleMeans& means = std::visit([](const auto& m) -> const CycleMeans& { return m.means; }, model_);
      const auto mean = [&](Integral of) { return means.mean[detail::quadrature_of(of)]; };
      switch (MeanId(number)) {
        case MeanId::frequency: return means.period > 0.0 ? 1.0 / means.period : 0.0;
        case MeanId::lift: return mean(Integral::lift);
        case MeanId::current: return mean(Integral::current);
        case MeanId::power_electrical: return mean(Integral::electrical_work);
        case MeanId::power_friction: return mean(Integral::friction_work);
        case MeanId::power_aerodynamic: return mean(Integral::aero_work);
        case MeanId::power_copper: return vehicle().motor.armature_resistance * mean(Integral::current_square);
        case MeanId::last: break;
      }
      return std::nullopt;
    }
    case VariableKind::parameter: {
      const auto rows = parameter_table<double>();
      return number < rows.size() && rows[number].get ? rows[number].get(design_) : std::nullopt;
    }
    case VariableKind::indicator: {
      const std::vector<double> values = indicators();
      return number < values.size() ? std::optional(values[number]) : std::nullopt;
    }
    case VariableKind::setting: return value_at(member_of(settings_, number));
    default: return std::nullopt;
  }
}

std::optional<int> Instance::whole(std::size_t reference) const {
  if (kind_of(reference) != VariableKind::count) return std::nullopt;
  return std::visit(
      [&](const auto& model) -> std::optional<int> {
        if (CountId(number_of(reference)) == CountId::cycles) return int(model.means.cycles);
        if (model.ended()) return int(Status::jammed);
        if (model.now.stuck) return int(Status::standing);
        return int(model.means.cycles > 0 ? Status::flapping : Status::starting);
      },
      model_);
}

std::string Instance::text(std::size_t reference) const {
  const auto rows = parameter_table<double>();
  const std::size_t number = number_of(reference);
  if (kind_of(reference) != VariableKind::text || number >= rows.size() || !rows[number].text) return {};
  return rows[number].text(design_);
}

bool Instance::set_real(std::size_t reference, double value) {
  const std::size_t number = number_of(reference);
  switch (kind_of(reference)) {
    case VariableKind::input: {
      double* const input = member_of(inputs_, number);
      if (!input) return false;
      if (InputId(number) == InputId::duty && !(value >= 0.0 && value <= 1.0)) return false;
      *input = value;
      apply_inputs();
      return true;
    }
    case VariableKind::parameter: {
      const auto rows = parameter_table<double>();
      if (number >= rows.size() || !rows[number].set || !rows[number].range.holds(value)) return false;
      // The inputs of a supply start as its parameters say.
      const Inputs before = inputs_of(design_);
      if (!rows[number].set(design_, value)) return false;
      const Inputs after = inputs_of(design_);
      if (after.voltage != before.voltage) inputs_.voltage = after.voltage;
      if (after.duty != before.duty) inputs_.duty = after.duty;
      changed_ = true;
      return true;
    }
    case VariableKind::setting: {
      double* const setting = member_of(settings_, number);
      if (!setting) return false;
      if (SettingId(number) == SettingId::tolerance && !(value >= 1e-12 && value <= 1e-2)) return false;
      *setting = value;
      changed_ = true;
      return true;
    }
    default: return false;
  }
}

}  // namespace wingbeat::fmu

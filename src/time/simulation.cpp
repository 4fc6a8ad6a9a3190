#include "wingbeat/time/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "time/event_loop.hpp"
#include "time/time_model.hpp"
#include "wingbeat/core/text.hpp"
#include "wingbeat/vehicle/drive.hpp"
#include "wingbeat/vehicle/motion.hpp"

namespace wingbeat {
namespace {

using detail::TimeModel;

/// Turns of a crank that are done.
double turns_at(double theta) { return std::floor(theta / two_pi); }

/// Keeps the events, and stops where it is asked to.
struct EventWatch : detail::NoWatch {
  std::vector<TransientEvent> events;
  const StepOptions& options;

  explicit EventWatch(const StepOptions& step_options) : options(step_options) {}

  std::optional<double> stepped(const TimeModel& model, detail::Integrator& steps, double from) {
    if (options.check) options.check();
    if (model.direct) return std::nullopt;
    const auto theta = [&](double t) { return steps.dense(t)[0]; };
    const double before = theta(from), turns = turns_at(before), theta_now = model.now.moving.angle;
    if (turns_at(theta_now) <= turns) return std::nullopt;
    const auto short_of = [&](double t) { return turns_at(theta(t)) <= turns; };
    const double short_by = turns + 1.0 - before / two_pi, beyond = turns + 1.0 - theta_now / two_pi;
    const double after = beyond < 0.0 ? find_zero([&](double t) { return turns + 1.0 - theta(t) / two_pi; }, from,
                                                  short_by, model.now.t, beyond, 4e-16 * model.now.t)
                                            .after
                                      : bisect(short_of, from, model.now.t).after;
    events.push_back({after, theta(after), TransientEvent::Kind::revolution});
    if (options.until_event == TransientEvent::Kind::revolution) return after;
    return std::nullopt;
  }
  bool happened(const TimeModel& model, TransientEvent::Kind kind) {
    events.push_back({model.now.t, model.now.moving.angle, kind});
    return options.until_event == kind;
  }
};

/// Leaves the model where it was where an exception ends what is done to it.
struct BackUnlessDone {
  explicit BackUnlessDone(TimeModel& restored) : model(restored), before(restored.now) {}
  ~BackUnlessDone() {
    if (!done) model.now = before;
  }
  TimeModel& model;
  TimeModel::State before;
  bool done = false;
};

}  // namespace

std::vector<std::string> time_state_names(const Vehicle<double>& vehicle) {
  std::vector<std::string> names{"crank_angle", "crank_speed"};
  if (drive_of(vehicle).alternating) names = {"stroke_angle", "flapping_velocity"};
  UnknownIndices(vehicle).for_each<double>(
      [&](std::size_t, const GroupState<double>& state) { names.emplace_back(state.name); });
  return names;
}

struct Simulation::Model {
  TimeModel in_time;
  SimulationOptions options;
  std::vector<double> times{}, voltages{};  ///< samples that command the voltage
  double scaled_to = 0.0;                   ///< [V]

  void start() {
    in_time.start(options.start());
    scaled_to = in_time.supply.voltage;
  }
  /// The line through the samples that holds from the time t on, and the time until which it does.
  double command_line(double t, std::function<double(double)>& line) const {
    const std::size_t next = std::size_t(std::upper_bound(times.begin(), times.end(), t) - times.begin());
    const double until = next < times.size() ? times[next] : infinity;
    if (next == 0 || next == times.size()) {
      line = [v = next == 0 ? voltages.front() : voltages.back()](double) { return v; };
    } else {
      const double t0 = times[next - 1], v0 = voltages[next - 1], slope = (voltages[next] - v0) / (times[next] - t0);
      line = [=](double time) { return v0 + slope * (time - t0); };
    }
    return until;
  }
};

Simulation::Simulation(const Vehicle<double>& vehicle, const Supply<double>& supply, const SimulationOptions& options)
    : model_(new Model{TimeModel(vehicle, supply), options}) {
  if (!(options.tolerance >= 1e-12 && options.tolerance <= 1e-2)) {
    throw ParameterError("tolerance", "must be a number between 1e-12 and 1e-2");
  }
  for (const double number :
       {options.angle, options.speed, options.current, options.pitch_angle, options.pitch_velocity, options.twist_angle,
        options.twist_velocity, options.tip, options.tip_velocity}) {
    if (!std::isfinite(number)) throw ParameterError("simulation", "starts from finite numbers");
  }
  model_->start();
}
Simulation::Simulation(const Simulation& other) : model_(new Model(*other.model_)) {}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(const Simulation& other) {
  model_.reset(new Model(*other.model_));
  return *this;
}
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

double Simulation::time() const { return model_->in_time.now.t; }

std::vector<std::string> Simulation::state_names() const { return time_state_names(model_->in_time.vehicle); }

std::vector<double> Simulation::state() const {
  std::vector<double> numbers(model_->in_time.indices.count);
  model_->in_time.unknowns(numbers.data());
  return numbers;
}

WaveformRow Simulation::now() const {
  const TimeModel& model = model_->in_time;
  const Coordinates<double>& moving = model.now.moving;
  return waveform_row(model.vehicle, model.motion_now(), model.now.t, moving.angle, moving.speed,
                      model.stroke_angle(moving.angle), pitches(model.vehicle) ? local_pitch(moving) : absent);
}

bool Simulation::stands() const { return model_->in_time.now.stuck; }
bool Simulation::ended() const { return model_->in_time.ended(); }

void Simulation::command(double voltage) {
  if (!std::isfinite(voltage)) throw ParameterError("voltage", "must be a finite number");
  command({time()}, {voltage});
}

void Simulation::command(std::function<double(double)> voltage) {
  model_->times.clear();
  model_->in_time.command = std::move(voltage);
}

void Simulation::command(std::vector<double> times, std::vector<double> voltages) {
  if (times.empty() || times.size() != voltages.size()) {
    throw ParameterError("voltage", "must have as many samples as times, at least one");
  }
  for (std::size_t n = 0; n < times.size(); ++n) {
    if (!std::isfinite(times[n]) || !std::isfinite(voltages[n])) throw ParameterError("voltage", "must be finite");
    if (n > 0 && times[n] < times[n - 1]) throw ParameterError("voltage", "has times that fall");
  }
  model_->times = std::move(times);
  model_->voltages = std::move(voltages);
  model_->command_line(time(), model_->in_time.command);
}

void Simulation::release() {
  model_->times.clear();
  if (!model_->in_time.command) return;
  model_->in_time.command = nullptr;
  model_->in_time.catch_up_with_supply();
}

std::vector<TransientEvent> Simulation::step_to(double until, const StepOptions& options) {
  if (!std::isfinite(until)) throw ParameterError("time", "must be a finite number");
  if (until < time()) {
    throw ParameterError(
        "time", detail::format("must not lie in the past: the simulation is at %.10g s, got %.10g s", time(), until));
  }
  EventWatch watch(options);
  TimeModel& model = model_->in_time;
  BackUnlessDone back{model};
  detail::StepOutcome outcome = detail::StepOutcome::reached;
  while (model.now.t < until && outcome == detail::StepOutcome::reached) {
    double end = until;
    if (!model_->times.empty()) end = std::min(until, model_->command_line(model.now.t, model.command));
    double highest = model.supply.voltage;
    if (model.command) {
      highest = std::max({highest, std::abs(model.command(model.now.t)), std::abs(model.command(end))});
    }
    if (highest != model_->scaled_to) model.scale_to(model_->scaled_to = highest);
    outcome = detail::step_to(model, end, model_->options.tolerance, TimeIntegrator::own_steps, watch);
  }
  if (outcome == detail::StepOutcome::failed) {
    throw std::runtime_error("the simulation could not go on behind " + std::to_string(model.now.t) + " s");
  }
  back.done = true;
  return std::move(watch.events);
}

SimulationState Simulation::save() const {
  const SimulationOptions& o = model_->options;
  const TimeModel& model = model_->in_time;
  SimulationState state{{double(model.indices.count) + (model.direct ? 0.5 : 0.0), o.angle, o.speed, o.current,
                         o.pitch_angle, o.pitch_velocity, o.twist_angle, o.twist_velocity, o.tip, o.tip_velocity}};
  model.now.each(model.now, [&](const auto& number) { state.numbers.push_back(double(number)); });
  return state;
}

void Simulation::restore(const SimulationState& state) {
  const SimulationState mine = save();
  if (state.numbers.size() != mine.numbers.size() || state.numbers[0] != mine.numbers[0]) {
    throw ParameterError("state", "is that of another kind of vehicle");
  }
  const double* next = state.numbers.data() + 1;
  SimulationOptions& o = model_->options;
  for (double* number : {&o.angle, &o.speed, &o.current, &o.pitch_angle, &o.pitch_velocity, &o.twist_angle,
                         &o.twist_velocity, &o.tip, &o.tip_velocity}) {
    *number = *next++;
  }
  // What is fixed by the start: typical sizes, how far the crank can turn.
  model_->start();
  TimeModel::State& now = model_->in_time.now;
  now.each(now, [&](auto& number) { number = std::remove_reference_t<decltype(number)>(*next++); });
}

}  // namespace wingbeat

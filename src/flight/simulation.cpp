#include "wingbeat/flight/simulation.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "flight/flight_model.hpp"
#include "time/event_loop.hpp"

namespace wingbeat {

struct FlightSimulation::Model {
  detail::FlightModel in_time;
  FlightOptions options;
};

FlightSimulation::FlightSimulation(const FlightVehicle& vehicle, const FlightOptions& options)
    : model_(new Model{detail::FlightModel(vehicle), options}) {
  if (!(options.tolerance >= 1e-12 && options.tolerance <= 1e-2)) {
    throw ParameterError("tolerance", "must be a number between 1e-12 and 1e-2");
  }
  if (!std::isfinite(options.gravity)) throw ParameterError("gravity", "must be a finite number");
  model_->in_time.gravity = options.gravity;
  model_->in_time.frozen = options.frozen;
  start({});
}
FlightSimulation::FlightSimulation(const FlightSimulation& other) : model_(new Model(*other.model_)) {}
FlightSimulation::FlightSimulation(FlightSimulation&&) noexcept = default;
FlightSimulation& FlightSimulation::operator=(const FlightSimulation& other) {
  model_.reset(new Model(*other.model_));
  return *this;
}
FlightSimulation& FlightSimulation::operator=(FlightSimulation&&) noexcept = default;
FlightSimulation::~FlightSimulation() = default;

void FlightSimulation::start(const BodyState& body, const std::vector<Coordinates<double>>& drives) {
  bool finite = true;
  BodyState::each(body, [&](const double& x) { finite = finite && std::isfinite(x); });
  for (const Coordinates<double>& drive : drives) {
    Coordinates<double>::each(drive, [&](const double& x) { finite = finite && std::isfinite(x); });
  }
  if (!finite) throw ParameterError("flight", "starts from finite numbers");
  model_->in_time.start(body, drives);
}

void FlightSimulation::place(const BodyState& body) { model_->in_time.now.body = body; }

void FlightSimulation::command(const FlightControls& controls) {
  for (const double x : controls.at) {
    if (!std::isfinite(x)) throw ParameterError("controls", "must be finite numbers");
  }
  if (controls == model_->in_time.controls()) return;
  model_->in_time.set_controls(controls);
}
const FlightControls& FlightSimulation::controls() const { return model_->in_time.controls(); }

void FlightSimulation::blow(std::function<Triple(double, const Triple&)> wind) {
  model_->in_time.wind = std::move(wind);
}

bool FlightSimulation::step_to(double until) {
  if (!std::isfinite(until) || until < time()) throw ParameterError("time", "must be finite and not in the past");
  struct Watch : detail::NoWatch {
    const std::function<void()>& check;
    explicit Watch(const std::function<void()>& asks) : check(asks) {}
    bool enough(const detail::FlightModel&, bool) {
      if (check) check();
      return false;
    }
  };
  detail::FlightModel& model = model_->in_time;
  const detail::StepOutcome outcome =
      detail::step_to(model, until, model_->options.tolerance, TimeIntegrator::own_steps, Watch(model_->options.check));
  if (outcome == detail::StepOutcome::failed) {
    throw std::runtime_error("the flight could not go on behind " + std::to_string(model.now.t) + " s");
  }
  return outcome != detail::StepOutcome::ended;
}

double FlightSimulation::time() const { return model_->in_time.now.t; }
FlightState FlightSimulation::state() const {
  const detail::FlightModel& model = model_->in_time;
  FlightState state{model.now.t, model.now.body, {}};
  for (const detail::TimeModel& drive : model.drives) state.drives.push_back(drive.now.moving);
  return state;
}
const FlightTotals& FlightSimulation::totals() const { return model_->in_time.totals; }
double FlightSimulation::stored_energy() const { return model_->in_time.stored_energy(); }
BodyLoads FlightSimulation::loads() const { return model_->in_time.loads_now(); }
double FlightSimulation::cycle_time() const { return model_->in_time.cycle_time(); }
const FlightVehicle& FlightSimulation::vehicle() const { return model_->in_time.vehicle; }

}  // namespace wingbeat

#include "flight/flight_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "wingbeat/core/math.hpp"
#include "wingbeat/core/root.hpp"
#include "wingbeat/core/text.hpp"

namespace wingbeat::detail {
namespace {

/// Electrical controls act through the drive, whose motion follows within about a wingbeat.
double lag_of(FlightControl which, const FlightActuators& actuators, double wingbeat) {
  switch (which) {
    case FlightControl::voltage:
    case FlightControl::voltage_difference:
    case FlightControl::bias:
    case FlightControl::split_difference: return actuators.time_constant[std::size_t(which)] + wingbeat;
    default: return actuators.time_constant[std::size_t(which)];
  }
}

}  // namespace

ReadyFlight ready_flight(const FlightVehicle& vehicle, const FlightPlan& asked) {
  validate(asked);
  ReadyFlight ready;
  ready.plan = asked;
  FlightPlan& plan = ready.plan;
  ready.trim.condition = plan.condition;
  ControlTask task;
  task.vehicle = &vehicle;
  const bool by_hand = plan.controller.type == ControllerType::none && plan.held && plan.start == FlightStart::rest;
  if (!by_hand) {
    AveragedFlight averaged(vehicle, {.tolerance = 1e-8});
    ready.trim = trim(averaged, plan.condition);
    if (!ready.trim.flies()) return ready;
    if (plan.controller.type != ControllerType::none) {
      const std::optional<FlightLinearModel> linear = linear_flight(averaged, ready.trim);
      if (!linear) throw ParameterError("controller.type", "the vehicle does not flap near its trim");
      task.linear = *linear;
    }
  }
  task.trim = ready.trim;
  const double wingbeat = ready.trim.frequency > 0.0 ? 1.0 / ready.trim.frequency : 0.0;
  constexpr double steps_of_wingbeat = 8.0, rate_without_trim = 250.0;
  if (!(plan.controller.rate > 0.0)) {
    plan.controller.rate = wingbeat > 0.0 ? std::clamp(steps_of_wingbeat / wingbeat, 10.0, 1e4) : rate_without_trim;
  }
  ready.average = plan.sensors.average.value_or(wingbeat);
  task.delay = plan.sensors.delay + 0.5 * ready.average;
  for (std::size_t k = 0; k < flight_control_count; ++k) {
    task.lag[k] = lag_of(FlightControl(k), plan.actuators, wingbeat);
    task.actuator_lag[k] = plan.actuators.time_constant[k];
    task.speed[k] = plan.actuators.rate_limit[k];
  }
  ready.controller.emplace(plan.controller, task);
  return ready;
}

FlightRun::FlightRun(const FlightVehicle& vehicle, ReadyFlight ready, Recorded recorded)
    : vehicle_(vehicle),
      ready_(std::move(ready)),
      recorded_(std::move(recorded)),
      simulation_(vehicle, {.tolerance = plan_.tolerance}),
      sensors_(plan_.sensors, ready_.average),
      actuators_(plan_.actuators, first_controls(), 1.0 / plan_.controller.rate),
      battery_(vehicle),
      wind_(wind_of(plan_.wind, plan_.duration)),
      control_clock_{1.0 / plan_.controller.rate},
      sensor_clock_{1.0 / (plan_.sensors.rate > 0.0 ? plan_.sensors.rate : plan_.controller.rate)},
      row_clock_{plan_.sample > 0.0            ? plan_.sample
                 : ready_.trim.frequency > 0.0 ? 1.0 / ready_.trim.frequency
                                               : 0.01} {
  start();
  first_stored_ = simulation_.stored_energy();
  first_body_ = body_energy(vehicle_.body, simulation_.state().body, standard_gravity);
}

bool FlightRun::fly_to(double until) {
  while (flying_) {
    act();
    if (simulation_.time() >= plan_.duration - 1e-9) return flying_ = false;
    if (simulation_.time() >= until - 1e-9) return true;
    const double next = std::min({sensor_clock_.next(), control_clock_.next(), row_clock_.next(), plan_.duration});
    flying_ = advance(next);
  }
  return false;
}

void FlightRun::record_end() {
  if (last_row_ < simulation_.time()) add_row();
}

void FlightRun::go(const Waypoint& there) {
  const double now = simulation_.time();
  const FlightReference from = reference(now);
  ready_.plan.path = {{now, from.position, from.yaw}, there};
  ready_.plan.interpolation = PathInterpolation::smooth;
}

void FlightRun::blow(const Triple& steady_wind) {
  ready_.plan.wind.steady = steady_wind;
  wind_ = wind_of(plan_.wind, plan_.duration);
  simulation_.blow(wind_);
}

void FlightRun::push(const Triple& velocity, const Triple& rates) {
  BodyState body = simulation_.state().body;
  for (std::size_t k = 0; k < 3; ++k) body.velocity[k] += velocity[k], body.rates[k] += rates[k];
  simulation_.place(body);
}

FlightEnergy FlightRun::energy() const {
  const FlightTotals& total = simulation_.totals();
  FlightEnergy e;
  e.electrical = total.electrical, e.motor = total.motor, e.friction = total.friction;
  e.stops = total.stops, e.wing_air = total.wing_air, e.formulation = total.residual, e.body_air = total.body_air;
  e.stored = simulation_.stored_energy() - first_stored_;
  e.controls = by_controls_;
  e.residual =
      e.electrical + e.body_air - e.motor - e.friction - e.stops - e.wing_air - e.formulation - (e.stored - e.controls);
  e.body_stored = body_energy(vehicle_.body, simulation_.state().body, standard_gravity) - first_body_;
  if (!(vehicle_.wing_mass > 0.0)) e.body_residual = e.body_air - e.body_stored;
  if (battery_.there()) e.battery = battery_.given();
  return e;
}

FlightControls FlightRun::first_controls() const {
  return plan_.held && plan_.controller.type == ControllerType::none ? *plan_.held : ready_.trim.controls;
}

void FlightRun::start() {
  const TrimResult& trim = ready_.trim;
  const bool cruises = plan_.start == FlightStart::trim;
  BodyState body;
  if (cruises) body = steady_body(trim.condition, trim.roll, trim.pitch);
  const StartDisturbance& by = plan_.disturbance;
  body.attitude = attitude_of(
      {(cruises ? trim.roll : 0.0) + by.angles[0], (cruises ? trim.pitch : 0.0) + by.angles[1], by.angles[2]});
  for (std::size_t k = 0; k < 3; ++k) body.velocity[k] += by.velocity[k], body.rates[k] += by.rates[k];
  body.position = {0.0, 0.0, -plan_.height};
  if (!plan_.path.empty()) {
    const FlightReference from = reference(0.0);
    body.position = {from.position[0], from.position[1], -plan_.height};
  }
  first_position_ = body.position;
  std::vector<Coordinates<double>> drives;
  if (cruises && trim.flight) {
    for (const DriveCycle& cycle : trim.flight->cycles) drives.push_back(cycle.start);
  }
  simulation_.command(first_controls());
  simulation_.start(body, drives);
  if (wind_) simulation_.blow(wind_);
}

FlightReference FlightRun::reference(double t) const {
  if (!plan_.path.empty()) return reference_at(plan_.path, plan_.interpolation, t);
  FlightReference at;
  const FlightCondition& c = plan_.condition;
  at.velocity = {c.speed, 0.0, -c.climb};
  at.position = {c.speed * t, 0.0, -plan_.height - c.climb * t};
  return at;
}

/// What is due now: sensors, then the controller, then a row.
void FlightRun::act() {
  const double t = simulation_.time();
  if (sensor_clock_.due(t)) {
    sensors_.sample(t, simulation_.state().body);
    ++sensor_clock_.count;
  }
  if (control_clock_.due(t)) {
    ++control_clock_.count;
    FlightControls command = first_controls();
    if (ready_.controller->design().type != ControllerType::none) {
      command = ready_.controller->step(sensors_.measured(t), reference(t));
    }
    const double before = simulation_.stored_energy();
    simulation_.command(battery_.within(actuators_.follow(command)));
    by_controls_ += simulation_.stored_energy() - before;
  }
  if (row_clock_.due(t)) {
    ++row_clock_.count;
    add_row();
  }
}

/// On to that time; false where the flight ends on the way.
bool FlightRun::advance(double until) {
  const double from = simulation_.time();
  const FlightState before = simulation_.state();
  const bool near_ground = plan_.ground && may_reach_ground(before.body, until - from);
  std::optional<FlightSimulation> kept;
  if (near_ground) kept = simulation_;
  const double used = simulation_.totals().electrical;
  if (!simulation_.step_to(until)) {
    return ends(FlightOutcome::jammed,
                format("A drive jams after %.4g s: its equations have no solution.", simulation_.time()));
  }
  const BodyState& body = simulation_.state().body;
  if (plan_.ground && -body.position[2] <= *plan_.ground) {
    if (kept) land(*kept, before, until);
    return ends(FlightOutcome::crashed, format("It hits the ground after %.4g s.", simulation_.time()));
  }
  battery_.use(until - from, simulation_.totals().electrical - used);
  if (plan_.progress) plan_.progress(until);
  if (battery_.ended()) {
    return ends(FlightOutcome::battery_empty,
                format("The battery is empty, or at its cut-off voltage, after %.4g s.", until));
  }
  if (tilt_of(body) > plan_.max_tilt) {
    return ends(FlightOutcome::crashed, format("It tips over: the tilt exceeds %.4g deg after %.4g s.",
                                               degrees_per_radian * plan_.max_tilt, until));
  }
  double far = 0.0;
  for (std::size_t k = 0; k < 3; ++k) far += square(body.position[k] - first_position_[k]);
  if (std::sqrt(far) > plan_.max_distance) {
    return ends(FlightOutcome::crashed,
                format("It leaves the distance of %.4g m from the start after %.4g s.", plan_.max_distance, until));
  }
  return true;
}

bool FlightRun::may_reach_ground(const BodyState& body, double step) const {
  const double down = to_earth(body.attitude, body.velocity)[2];
  const double room = -body.position[2] - *plan_.ground;
  return room <= 4.0 * (std::abs(down) + standard_gravity * step) * step;
}

/// Goes from before the ground to the moment of contact, by a cubic through heights and speeds at both ends.
void FlightRun::land(FlightSimulation kept, const FlightState& before, double until) {
  const BodyState &a = before.body, b = simulation_.state().body;
  const double T = until - before.time;
  const double h0 = -a.position[2] - *plan_.ground, h1 = -b.position[2] - *plan_.ground;
  const double v0 = -T * to_earth(a.attitude, a.velocity)[2], v1 = -T * to_earth(b.attitude, b.velocity)[2];
  const auto above = [&](double x) {
    return h0 + x * (v0 + x * (3.0 * (h1 - h0) - 2.0 * v0 - v1 + x * (2.0 * (h0 - h1) + v0 + v1))) > 0.0;
  };
  const double contact = bisect(above, 0.0, 1.0).after;
  simulation_ = std::move(kept);
  simulation_.step_to(before.time + contact * T);
}

bool FlightRun::ends(FlightOutcome outcome, std::string detail) {
  outcome_ = outcome;
  detail_ = std::move(detail);
  return false;
}

void FlightRun::add_row() {
  const double t = simulation_.time();
  const BodyState body = simulation_.state().body;
  FlightRow row;
  row.time = t;
  row.position = body.position;
  row.angles = euler_angles(body.attitude);
  row.velocity = body.velocity;
  row.rates = body.rates;
  if (wind_) row.wind = wind_(t, body.position);
  row.controls = simulation_.controls();
  row.reference = reference(t);
  const FlightTotals& now = simulation_.totals();
  if (t > last_row_) {
    const double per = 1.0 / (t - last_row_);
    row.electrical = per * (now.electrical - last_.electrical);
    row.motor = per * (now.motor - last_.motor);
    row.friction = per * (now.friction - last_.friction);
    row.wing_air = per * (now.wing_air - last_.wing_air);
  }
  last_ = now;
  row.body_energy = body_energy(vehicle_.body, body, standard_gravity);
  row.stored_energy = simulation_.stored_energy();
  if (battery_.there()) row.charge = battery_.charge(), row.available = battery_.available();
  last_row_ = t;
  recorded_(row, simulation_);
}

}  // namespace wingbeat::detail

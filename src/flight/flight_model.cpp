#include "flight/flight_model.hpp"

#include <algorithm>
#include <cmath>

#include "time/model_problem.hpp"
#include "time/own_steps.hpp"
#include "wingbeat/flight/body_loads.hpp"
#include "wingbeat/flight/wing_reaction.hpp"
#include "wingbeat/parts/drive_wave.hpp"

namespace wingbeat::detail {
namespace {

/// Numbers of unknowns for which steps are compiled; a vehicle has the next larger one, the rest at 0.
constexpr int step_sizes[] = {16, 20, 24, 32};

int padded(std::size_t count) {
  for (const int size : step_sizes) {
    if (int(count) <= size) return size;
  }
  throw ParameterError("vehicle", "has more states than a flight knows");
}

Supply<double> constant_supply(double voltage) { return {SupplyType::constant, voltage, 0.0, 1.0}; }

std::vector<TimeModel> models_of(const FlightVehicle& vehicle) {
  std::vector<TimeModel> models;
  for (const FlightDrive& drive : vehicle.drives) {
    models.emplace_back(drive.vehicle, vehicle.direct ? drive.supply : constant_supply(mean_voltage(drive.supply)));
    TimeModel& model = models.back();
    // A current that settles within a small part of a cycle would hold up the steps: it is that of the moment.
    model.start({});
    if (model.stiff() && model.indices.inductive) {
      model.vehicle.motor.armature_inductance = 0.0;
      model.start({});
    }
  }
  return models;
}

StrokeOnBody stroke_of(const FullState<double>& instant, const PitchMotion<double>& m) {
  return {instant.configuration.stroke_angle, m.stroke_velocity, m.stroke_acceleration, 0.0};
}

}  // namespace

FlightModel::FlightModel(const FlightVehicle& flies) : vehicle(flies), drives(models_of(flies)) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    first_[n] = count;
    count += drives[n].indices.count;
  }
  first_[drives.size()] = count;
  coupled = padded(count + body_state_count);
  own_flows();
  controls_[FlightControl::voltage] = vehicle.stated_voltage;
  set_controls(controls_);
}

FlightModel::FlightModel(const FlightModel& other)
    : vehicle(other.vehicle),
      drives(other.drives),
      coupled(other.coupled),
      frozen(other.frozen),
      gravity(other.gravity),
      wind(other.wind),
      now(other.now),
      totals(other.totals),
      flows_(other.flows_),
      first_(other.first_),
      controls_(other.controls_),
      scaled_to_(other.scaled_to_),
      speed_scale_(other.speed_scale_),
      rate_scale_(other.rate_scale_) {
  own_flows();
}

FlightModel& FlightModel::operator=(const FlightModel& other) {
  if (this == &other) return *this;
  vehicle = other.vehicle, drives = other.drives, coupled = other.coupled, frozen = other.frozen;
  gravity = other.gravity, wind = other.wind, now = other.now, totals = other.totals;
  flows_ = other.flows_, first_ = other.first_, controls_ = other.controls_;
  scaled_to_ = other.scaled_to_, speed_scale_ = other.speed_scale_, rate_scale_ = other.rate_scale_;
  own_flows();
  return *this;
}

void FlightModel::own_flows() {
  std::vector<std::shared_ptr<OnsetFlow>> flows;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    flows.push_back(std::make_shared<OnsetFlow>(flows_.empty() ? vehicle.drives[n].flow : *flows_[n]));
    drives[n].vehicle.wings.flow = flows.back();
  }
  flows_ = std::move(flows);
}

void FlightModel::start(const BodyState& body, const std::vector<Coordinates<double>>& from) {
  now = {};
  now.body = body;
  totals = {};
  set_flows(0.0, body);
  for (std::size_t n = 0; n < drives.size(); ++n) {
    drives[n].start(n < from.size() ? from[n] : Coordinates<double>{});
    scaled_to_[n] = 0.0;
    const double fastest =
        drives[n].speed_scale * (vehicle.direct ? 1.0 : typical_stroke_slope(drives[n].vehicle.transmission));
    const double R = drives[n].vehicle.wings.wake.strips.at.back().radius;
    speed_scale_ = n == 0 ? fastest * R : std::max(speed_scale_, fastest * R);
  }
  rate_scale_ = speed_scale_ / std::max(1e-6, drives[0].vehicle.wings.wake.strips.at.back().radius);
  set_controls(controls_);
}

void FlightModel::set_controls(const FlightControls& controls) {
  controls_ = controls;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    const FlightDrive& stated = vehicle.drives[n];
    TimeModel& drive = drives[n];
    set_mounts(stated, controls, *flows_[n]);
    const double V = voltage_of(stated, controls);
    double highest = std::abs(V);
    if (vehicle.direct) {
      const DriveWave<double> wave{controls[FlightControl::bias] + stated.vehicle.voltage_offset, 0.0,
                                   stated.side * controls[FlightControl::split_difference]};
      const double f = drive.supply.frequency;
      drive.command = [=](double t) {
        const double turns = f * t;
        return voltage_of_wave(wave, V, two_pi * (turns - std::floor(turns)));
      };
      highest += std::abs(wave.bias);
    } else {
      if (stated.supply.type == SupplyType::battery && stated.vehicle.voltage > 0.0) {
        drive.vehicle.source_resistance = stated.vehicle.source_resistance * square(V / stated.vehicle.voltage);
      }
      drive.command = [V](double) { return V; };
    }
    // Sizes need not follow each change, and of direct drives they cost more than a wingbeat.
    highest = std::max(highest, 1e-3 * std::max(vehicle.stated_voltage, 1e-6));
    if (highest > 1.25 * scaled_to_[n] || highest < 0.5 * scaled_to_[n]) drive.scale_to(scaled_to_[n] = highest);
  }
}

void FlightModel::set_flows(double t, const BodyState& body) const {
  Triple air = body.velocity;
  if (wind) {
    const Triple blows = to_body(body.attitude, wind(t, body.position));
    for (std::size_t k = 0; k < 3; ++k) air[k] -= blows[k];
  }
  for (const auto& flow : flows_) {
    flow->velocity = air;
    flow->rates = body.rates;
    flow->reaction_moment = 0.0;
  }
}

FlightModel::Instant FlightModel::instant_of(std::size_t n, double t, const double* y) const {
  const TimeModel& drive = drives[n];
  Instant instant;
  instant.place = drive.indices.coordinates(y + first_[n]);
  instant.at = drive.instant(t, instant.place);
  instant.mode = on_force_branch(drive.vehicle, instant.at, drive.mode(), &instant.motion);
  return instant;
}

BodyLoads FlightModel::loads(double t, const double* y, const BodyState& body, std::vector<Instant>& instants,
                             std::optional<BodyState>& accelerations) const {
  set_flows(t, body);
  BodyLoads sum = plate_loads(vehicle.body, flows_[0]->velocity, body.rates);
  instants.resize(drives.size());
  const auto evaluate_all = [&] {
    for (std::size_t n = 0; n < drives.size(); ++n) instants[n] = instant_of(n, t, y);
  };
  const auto add_wings = [&](BodyLoads& to) {
    for (std::size_t n = 0; n < drives.size(); ++n) {
      const BodyLoads wings =
          wing_loads_on_body(drives[n].vehicle, instants[n].at, instants[n].motion, instants[n].mode);
      for (std::size_t k = 0; k < 3; ++k) to.force[k] += wings.force[k], to.moment[k] += wings.moment[k];
    }
  };
  evaluate_all();
  if (!(vehicle.wing_mass > 0.0) || frozen) {
    add_wings(sum);
    return sum;
  }
  // How each drive answers to a moment, on its branch.
  std::vector<StrokeOnBody> strokes;
  std::vector<const OnsetFlow*> flows;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    strokes.push_back(stroke_of(instants[n].at, instants[n].motion));
    flows.push_back(flows_[n].get());
    const double probe = 1e-3 * vehicle.body.mass * standard_gravity * vehicle.wing_centre;
    flows_[n]->reaction_moment = probe;
    const PitchMotion<double> probed = evaluate(drives[n].vehicle, instants[n].at, instants[n].mode);
    strokes[n].compliance = (strokes[n].acceleration - probed.stroke_acceleration) / probe;
  }
  const BodyLoads plates = sum;
  BodyWithWings found;
  // The air's inertia on hinges follows the accelerations, a little.
  for (int pass = 0; pass < (drives[0].wings_pitch ? 2 : 1); ++pass) {
    sum = plates;
    add_wings(sum);
    found = body_with_wings(vehicle, flows, strokes, body, sum, gravity);
    for (std::size_t n = 0; n < drives.size(); ++n) flows_[n]->reaction_moment = found.moments[n];
    evaluate_all();
  }
  accelerations = BodyState{};
  accelerations->velocity = found.acceleration;
  accelerations->rates = found.angular_acceleration;
  return sum;
}

bool FlightModel::ended() const {
  return std::any_of(drives.begin(), drives.end(), [](const TimeModel& d) { return d.ended(); });
}

void FlightModel::begin_piece() {
  set_flows(now.t, now.body);
  for (TimeModel& drive : drives) {
    drive.now.t = now.t;
    drive.begin_piece();
  }
  sum_impacts();
}

void FlightModel::sum_impacts() {
  now.impact_loss = totals.stops = 0.0;
  for (const TimeModel& drive : drives) {
    now.impact_loss += drive.now.impact_loss;
    const auto impulse = [&](Integral which) { return drive.now.impulses[std::size_t(which)]; };
    totals.stops += drive.now.impact_loss + impulse(Integral::friction_work) + impulse(Integral::gear_work) +
                    impulse(Integral::residual_work);
  }
}

void FlightModel::unknowns(double* y) const {
  std::fill(y, y + coupled, 0.0);
  for (std::size_t n = 0; n < drives.size(); ++n) drives[n].unknowns(y + first_[n]);
  double* next = y + first_[drives.size()];
  BodyState::each(now.body, [&](const double& x) { *next++ = x; });
  next = y + coupled;
  FlightTotals::each(totals, [&](const double& x) { *next++ = x; });
}

BodyState FlightModel::body_of(const double* y) const {
  BodyState body;
  const double* next = body_unknowns(y);
  BodyState::each(body, [&](double& x) { x = *next++; });
  return body;
}

void FlightModel::set(double t, const double* y) {
  now.t = t;
  now.body = body_of(y);
  for (std::size_t n = 0; n < drives.size(); ++n) drives[n].set(t, y + first_[n]);
  const double* next = y + coupled;
  FlightTotals::each(totals, [&](double& x) { x = *next++; });
}

bool FlightModel::rates(double t, const double* y, double* dy) const {
  const BodyState body = body_of(y);
  std::vector<Instant> instants;
  std::optional<BodyState> accelerations;
  const BodyLoads air = loads(t, y, body, instants, accelerations);
  std::fill(dy, dy + coupled, 0.0);
  FlightTotals flow;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    const TimeModel& drive = drives[n];
    const Instant& instant = instants[n];
    const PitchMotion<double>& m = instant.motion;
    drive.indices.unknowns(rates_of(drive.vehicle, instant.place, instant.at, m), dy + first_[n]);
    const double omega = instant.at.omega;
    const CycleIntegrals<double> powers = integrands<double>(m, omega, instant.mode);
    const auto power = [&](Integral which) { return powers[std::size_t(which)]; };
    const Motor<double>& motor = drive.vehicle.motor;
    flow.electrical += power(Integral::electrical_work);
    flow.motor += motor.armature_resistance * power(Integral::current_square) +
                  motor.viscous_damping * power(Integral::speed_square) +
                  motor.friction_torque * power(Integral::travel) + power(Integral::gear_work);
    flow.friction += power(Integral::friction_work) + m.hinge_loss;
    flow.wing_air += power(Integral::aero_work) - flows_[n]->reaction_moment * m.stroke_velocity;
    flow.residual += power(Integral::residual_work);
  }
  flow.force = air.force, flow.moment = air.moment;
  for (std::size_t k = 0; k < 3; ++k) {
    flow.body_air += air.force[k] * body.velocity[k] + air.moment[k] * body.rates[k];
  }
  BodyState moves;
  moves.attitude = {0.0, 0.0, 0.0, 0.0};
  if (!frozen) {
    moves = body_rates(vehicle.body, body, air, gravity);
    if (accelerations) moves.velocity = accelerations->velocity, moves.rates = accelerations->rates;
  }
  double* next = dy + first_[drives.size()];
  BodyState::each(moves, [&](const double& x) { *next++ = x; });
  next = dy + coupled;
  FlightTotals::each(flow, [&](const double& x) { *next++ = x; });
  return std::all_of(dy, dy + coupled + flight_total_count, [](double x) { return std::isfinite(x); });
}

std::array<double, FlightModel::indicator_count> FlightModel::indicators(double t, const double* y) const {
  std::array<double, indicator_count> values;
  values.fill(1.0);
  const BodyState body = body_of(y);
  if (vehicle.wing_mass > 0.0 && !frozen) {
    std::vector<Instant> instants;
    std::optional<BodyState> accelerations;
    loads(t, y, body, instants, accelerations);
  } else {
    set_flows(t, body);
  }
  for (std::size_t n = 0; n < drives.size(); ++n) {
    const auto own = drives[n].indicators(t, y + first_[n]);
    std::copy(own.begin(), own.end(), values.begin() + std::ptrdiff_t(n * per_drive));
  }
  return values;
}

std::array<int, FlightModel::indicator_count> FlightModel::directions() const {
  std::array<int, indicator_count> directions{};
  for (std::size_t n = 0; n < drives.size(); ++n) {
    const auto own = drives[n].directions();
    std::copy(own.begin(), own.end(), directions.begin() + std::ptrdiff_t(n * per_drive));
  }
  return directions;
}

void FlightModel::handle(std::size_t indicator) {
  set_flows(now.t, now.body);
  drives[indicator / per_drive].handle(indicator % per_drive);
  sum_impacts();
}

std::optional<TransientEvent::Kind> FlightModel::event_at(std::size_t indicator) const {
  return drives[indicator / per_drive].event_at(indicator % per_drive);
}

bool FlightModel::branch_lost() {
  set_flows(now.t, now.body);
  bool lost = false;
  for (TimeModel& drive : drives) lost = drive.branch_lost() || lost;
  sum_impacts();
  return lost;
}

void FlightModel::tolerated(double relative, const double* y, double* errors) const {
  std::fill(errors, errors + coupled + flight_total_count, relative);
  for (std::size_t n = 0; n < drives.size(); ++n) drives[n].tolerated(relative, y + first_[n], errors + first_[n]);
  // Of the speed of the wing tips: by it the loads go.
  double* next = errors + first_[drives.size()];
  for (int k = 0; k < 3; ++k) *next++ = relative * speed_scale_;
  for (int k = 0; k < 3; ++k) *next++ = relative * rate_scale_;
  for (int k = 0; k < 4; ++k) *next++ = relative;
  for (int k = 0; k < 3; ++k) *next++ = relative * speed_scale_ * cycle_time();
  const double weight = vehicle.body.mass * standard_gravity, T = cycle_time();
  const double arm = speed_scale_ / rate_scale_;
  next = errors + coupled;
  for (int k = 0; k < 3; ++k) *next++ = relative * weight * T;
  for (int k = 0; k < 3; ++k) *next++ = relative * weight * arm * T;
  const double energy = relative * weight * speed_scale_ * T;
  while (next < errors + coupled + flight_total_count) *next++ = energy;
}

double FlightModel::longest_step() const {
  double longest = std::numeric_limits<double>::infinity();
  for (const TimeModel& drive : drives) longest = std::min(longest, drive.longest_step());
  return longest;
}

double FlightModel::stored_energy() const {
  double energy = 0.0;
  std::vector<StrokeOnBody> strokes;
  std::vector<const OnsetFlow*> flows;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    const TimeModel& drive = drives[n];
    energy += drive.stored_energy();
    const CrankKinematics<double> k = drive.kinematics(drive.now.moving.angle);
    strokes.push_back({drive.stroke_angle(drive.now.moving.angle), k.stroke_slope * drive.now.moving.speed, 0.0, 0.0});
    flows.push_back(flows_[n].get());
  }
  if (vehicle.wing_mass > 0.0) return energy + energy_with_wings(vehicle, flows, strokes, now.body, gravity);
  return energy + body_energy(vehicle.body, now.body, gravity);
}

BodyLoads FlightModel::loads_now() const {
  std::vector<double> y(std::size_t(coupled) + flight_total_count);
  unknowns(y.data());
  std::vector<Instant> instants;
  std::optional<BodyState> accelerations;
  return loads(now.t, y.data(), now.body, instants, accelerations);
}

std::vector<double> FlightModel::typical() const {
  std::vector<double> sizes(std::size_t(coupled), 1.0);
  for (std::size_t n = 0; n < drives.size(); ++n) {
    const auto own = drives[n].typical();
    std::copy_n(own.begin(), drives[n].indices.count, sizes.begin() + std::ptrdiff_t(first_[n]));
  }
  return sizes;
}

double FlightModel::cycle_time() const { return drives[0].time_scale; }

std::unique_ptr<Integrator> integrator_for(TimeIntegrator, const FlightModel& model, const double& relative) {
  IntegratorProblem p;
  p.coupled = model.coupled;
  p.size = model.coupled + int(flight_total_count);
  p.roots = int(FlightModel::indicator_count);
  p.rates = [&](double t, const double* y, double* dy) { return model.rates(t, y, dy); };
  p.root_functions = [&](double t, const double* y, double* values) {
    const auto indicators = model.indicators(t, y);
    std::copy(indicators.begin(), indicators.end(), values);
  };
  p.tolerated = [&](const double* y, double* errors) { model.tolerated(relative, y, errors); };
  p.longest_step = model.longest_step();
  p.typical = model.typical();
  constexpr int Q = int(flight_total_count);
  switch (model.coupled) {
    case 16: return std::make_unique<OwnIntegrator<16, Q, false>>(std::move(p));
    case 20: return std::make_unique<OwnIntegrator<20, Q, false>>(std::move(p));
    case 24: return std::make_unique<OwnIntegrator<24, Q, false>>(std::move(p));
    default: return std::make_unique<OwnIntegrator<32, Q, false>>(std::move(p));
  }
}

}  // namespace wingbeat::detail

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

}  // namespace

FlightModel::FlightModel(const FlightVehicle& flies) : vehicle(flies), drives(models_of(flies)) {
  coupled = padded(order_unknowns(), {16, 20, 24, 32});
  own_flows();
  controls_[FlightControl::voltage] = vehicle.stated_voltage;
  set_controls(controls_);
}

FlightModel::FlightModel(const FlightModel& other)
    : Base(other),
      vehicle(other.vehicle),
      drives(other.drives),
      frozen(other.frozen),
      gravity(other.gravity),
      wind(other.wind),
      now(other.now),
      totals(other.totals),
      next_step(other.next_step),
      flows_(other.flows_),
      controls_(other.controls_),
      scaled_to_(other.scaled_to_) {
  own_flows();
}

FlightModel& FlightModel::operator=(const FlightModel& other) {
  if (this == &other) return *this;
  Base::operator=(other);
  vehicle = other.vehicle, drives = other.drives, frozen = other.frozen;
  gravity = other.gravity, wind = other.wind, now = other.now, totals = other.totals;
  flows_ = other.flows_, controls_ = other.controls_, scaled_to_ = other.scaled_to_;
  next_step = other.next_step;
  own_flows();
  return *this;
}

void FlightModel::own_flows() {
  DriveFlows flows;
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
  next_step = 0.0;
  set_flows(0.0, body);
  for (std::size_t n = 0; n < drives.size(); ++n) {
    drives[n].start(n < from.size() ? from[n] : Coordinates<double>{});
    scaled_to_[n] = 0.0;
  }
  scale_body();
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
  detail::set_flows(flows_, body, wind ? wind(t, body.position) : Triple{});
}

AirOnBody FlightModel::air_at(double t, const double* y, const BodyState& body) const {
  set_flows(t, body);
  return air_on_body(vehicle, vehicles(), flows_, body, gravity, !frozen,
                     [&](std::size_t n) { return instant_of(n, t, y); });
}

void FlightModel::begin_piece() {
  Base::begin_piece();
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
  write_unknowns(now.body, y);
  double* next = y + coupled;
  FlightTotals::each(totals, [&](const double& x) { *next++ = x; });
}

void FlightModel::set(double t, const double* y) {
  now.t = t;
  now.body = body_of(y);
  for (std::size_t n = 0; n < drives.size(); ++n) drives[n].set(t, of_drive(n, y));
  const double* next = y + coupled;
  FlightTotals::each(totals, [&](double& x) { x = *next++; });
}

bool FlightModel::rates(double t, const double* y, double* dy) const {
  const BodyState body = body_of(y);
  const AirOnBody air = air_at(t, y, body);
  std::fill(dy, dy + coupled, 0.0);
  FlightTotals flow;
  for (std::size_t n = 0; n < drives.size(); ++n) {
    const TimeModel& drive = drives[n];
    const DriveInstant& instant = air.drives[n];
    const PitchMotion<double>& m = instant.motion;
    drive.indices.unknowns(rates_of(drive.vehicle, instant.place, instant.at, m), of_drive(n, dy));
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
  flow.force = air.loads.force, flow.moment = air.loads.moment;
  for (std::size_t k = 0; k < 3; ++k) {
    flow.body_air += air.loads.force[k] * body.velocity[k] + air.loads.moment[k] * body.rates[k];
  }
  BodyState moves;
  moves.attitude = {0.0, 0.0, 0.0, 0.0};
  if (!frozen) moves = body_rates_in(vehicle, body, air, gravity);
  write_body(moves, dy);
  double* next = dy + coupled;
  FlightTotals::each(flow, [&](const double& x) { *next++ = x; });
  return std::all_of(dy, dy + coupled + flight_total_count, [](double x) { return std::isfinite(x); });
}

std::array<double, FlightModel::indicator_count> FlightModel::indicators(double t, const double* y) const {
  const BodyState body = body_of(y);
  if (vehicle.wing_mass > 0.0 && !frozen) {
    air_at(t, y, body);
  } else {
    set_flows(t, body);
  }
  return drive_indicators(t, y);
}

void FlightModel::handle(std::size_t indicator) {
  Base::handle(indicator);
  sum_impacts();
}

bool FlightModel::branch_lost() {
  const bool lost = Base::branch_lost();
  sum_impacts();
  return lost;
}

void FlightModel::tolerated(double relative, const double* y, double* errors) const {
  tolerate_unknowns(relative, y, errors);
  const double weight = vehicle.body.mass * standard_gravity, T = cycle_time();
  double* next = errors + coupled;
  for (int k = 0; k < 3; ++k) *next++ = relative * weight * T;
  for (int k = 0; k < 3; ++k) *next++ = relative * weight * reach() * T;
  const double energy = relative * weight * tip_speed() * T;
  while (next < errors + coupled + flight_total_count) *next++ = energy;
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
  return air_at(now.t, y.data(), now.body).loads;
}

std::unique_ptr<Integrator> integrator_for(TimeIntegrator, const FlightModel& model, const double& relative) {
  IntegratorProblem p = FlightModel::problem_of(model, relative, int(flight_total_count));
  // For learning: roots to a small part of what a step may be off by, and steps as long as before an event.
  constexpr double coarse = 1e-5;
  if (relative >= coarse) {
    p.root_resolution = 0.1 * relative;
    p.next_step = &model.next_step;
  }
  constexpr int Q = int(flight_total_count);
  switch (model.coupled) {
    case 16: return std::make_unique<OwnIntegrator<16, Q, false>>(std::move(p));
    case 20: return std::make_unique<OwnIntegrator<20, Q, false>>(std::move(p));
    case 24: return std::make_unique<OwnIntegrator<24, Q, false>>(std::move(p));
    default: return std::make_unique<OwnIntegrator<32, Q, false>>(std::move(p));
  }
}

}  // namespace wingbeat::detail

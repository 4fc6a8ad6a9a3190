// The C functions over FlightSimulation. Axes: those of MuJoCo are wingbeat's turned by half a turn about x.
#include "wingbeat_flight.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "wingbeat/files/flight_file.hpp"
#include "wingbeat/flight/simulation.hpp"
#include "wingbeat/flight/trim.hpp"

using namespace wingbeat;

struct wingbeat_flight {
  FlightVehicle vehicle;
  FlightSimulation simulation;
};

namespace {

thread_local std::string last_error;

/// 0, or 1 where `act` throws, with its sentence kept.
template <class Act>
int guarded(const Act& act) noexcept {
  try {
    act();
    return 0;
  } catch (const std::exception& error) {
    last_error = error.what();
  } catch (...) {
    last_error = "stopped";
  }
  return 1;
}

/// Either way.
Triple half_turned(const Triple& v) { return {v[0], -v[1], -v[2]}; }
Triple triple_at(const double* numbers) { return {numbers[0], numbers[1], numbers[2]}; }
void put(const Triple& v, double* to) { to[0] = v[0], to[1] = v[1], to[2] = v[2]; }

BodyState body_from(const double* qpos, const double* qvel) {
  BodyState body;
  body.position = half_turned(triple_at(qpos));
  const double length = std::sqrt(qpos[3] * qpos[3] + qpos[4] * qpos[4] + qpos[5] * qpos[5] + qpos[6] * qpos[6]);
  if (!(length > 0.0)) throw std::runtime_error("qpos: the quaternion has no length");
  body.attitude = {qpos[3] / length, qpos[4] / length, -qpos[5] / length, -qpos[6] / length};
  body.velocity = to_body(body.attitude, half_turned(triple_at(qvel)));
  body.rates = half_turned(triple_at(qvel + 3));
  return body;
}

void put_body(const BodyState& body, double* qpos, double* qvel) {
  put(half_turned(body.position), qpos);
  const std::array<double, 4>& q = body.attitude;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  qpos[3] = q[0] / length, qpos[4] = q[1] / length, qpos[5] = -q[2] / length, qpos[6] = -q[3] / length;
  put(half_turned(to_earth(q, body.velocity)), qvel);
  put(half_turned(body.rates), qvel + 3);
}

FlightControls controls_from(const double* controls) {
  FlightControls made;
  for (std::size_t k = 0; k < flight_control_count; ++k) made.at[k] = controls[k];
  return made;
}

void go_on(FlightSimulation& simulation, double dt, const double* controls) {
  if (!(dt > 0.0)) throw std::runtime_error("dt: must be > 0 s");
  simulation.command(controls_from(controls));
  if (!simulation.step_to(simulation.time() + dt)) throw std::runtime_error("a mechanism has jammed");
}

/// Halfway between two attitudes that are close to each other.
std::array<double, 4> between(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  std::array<double, 4> sum;
  for (std::size_t k = 0; k < 4; ++k) sum[k] = a[k] + b[k];
  return sum;
}

}  // namespace

static_assert(flight_control_count == WINGBEAT_FLIGHT_CONTROLS);

extern "C" {

wingbeat_flight* wingbeat_flight_create(const char* vehicle_file) {
  wingbeat_flight* made = nullptr;
  guarded([&] {
    const FlightVehicle vehicle = flight_vehicle(read_vehicle(vehicle_file));
    if (vehicle.wing_mass > 0.0) throw std::runtime_error("body.wing_mass: is not known of a body that another moves");
    made = new wingbeat_flight{vehicle, FlightSimulation(vehicle)};
  });
  return made;
}

void wingbeat_flight_free(wingbeat_flight* flight) { delete flight; }

const char* wingbeat_flight_error(void) { return last_error.c_str(); }

const char* wingbeat_flight_control_name(int index) {
  return index >= 0 && index < WINGBEAT_FLIGHT_CONTROLS ? name_of(FlightControl(index)) : nullptr;
}

int wingbeat_flight_trim(wingbeat_flight* flight, double speed, double controls[WINGBEAT_FLIGHT_CONTROLS],
                         double qpos[7], double qvel[6]) {
  return guarded([&] {
    AveragedFlight averaged(flight->vehicle);
    const TrimResult found = trim(averaged, {speed, 0.0, 0.0});
    if (found.status != TrimStatus::trimmed) throw std::runtime_error(found.detail);
    const BodyState body = steady_body(found.condition, found.roll, found.pitch);
    std::vector<Coordinates<double>> drives;
    for (const DriveCycle& cycle : found.flight->cycles) drives.push_back(cycle.start);
    flight->simulation.start(body, drives);
    flight->simulation.command(found.controls);
    for (std::size_t k = 0; k < flight_control_count; ++k) controls[k] = found.controls.at[k];
    put_body(body, qpos, qvel);
  });
}

int wingbeat_flight_wind(wingbeat_flight* flight, const double wind[3]) {
  return guarded([&] {
    const Triple blows = half_turned(triple_at(wind));
    flight->simulation.blow([blows](double, const Triple&) { return blows; });
  });
}

int wingbeat_flight_step(wingbeat_flight* flight, const double qpos[7], const double qvel[6], double dt,
                         const double controls[WINGBEAT_FLIGHT_CONTROLS], double force[3], double torque[3]) {
  return guarded([&] {
    FlightSimulation& simulation = flight->simulation;
    const BodyState from = body_from(qpos, qvel);
    simulation.place(from);
    const FlightTotals before = simulation.totals();
    go_on(simulation, dt, controls);
    const FlightTotals& after = simulation.totals();
    const std::array<double, 4> attitude = between(from.attitude, simulation.state().body.attitude);
    Triple F, M;
    for (std::size_t k = 0; k < 3; ++k) {
      F[k] = (after.force[k] - before.force[k]) / dt;
      M[k] = (after.moment[k] - before.moment[k]) / dt;
    }
    put(half_turned(to_earth(attitude, F)), force);
    put(half_turned(to_earth(attitude, M)), torque);
  });
}

int wingbeat_flight_place(wingbeat_flight* flight, const double qpos[7], const double qvel[6]) {
  return guarded([&] { flight->simulation.place(body_from(qpos, qvel)); });
}

int wingbeat_flight_fly(wingbeat_flight* flight, double dt, const double controls[WINGBEAT_FLIGHT_CONTROLS],
                        double qpos[7], double qvel[6]) {
  return guarded([&] {
    go_on(flight->simulation, dt, controls);
    put_body(flight->simulation.state().body, qpos, qvel);
  });
}

}  // extern "C"

// Vehicles that fly, for tests.
#pragma once

#include <string>

#include "wingbeat/files/design_file.hpp"
#include "wingbeat/flight/flight_vehicle.hpp"

namespace wingbeat {

inline Design<double> flying_design(const std::string& name) {
  return read_design(WINGBEAT_DATA "/designs/flight-" + name + ".toml", {});
}
inline FlightVehicle flying(const std::string& name) { return flight_vehicle(flying_design(name)); }
inline constexpr const char* flying_names[] = {"friction2022", "x-wing", "purdue"};

/// A direct drive that loses nothing: no motor, no friction, no air; springs swing the wings.
inline FlightVehicle lossless_vehicle() {
  Design<double> d = flying_design("purdue");
  d.pitch = {};
  d.wing.pitch_inertia.reset();
  d.wing.mass_product.reset();
  d.friction = {};
  d.aerodynamics.coefficients_name = "translational-2022";
  d.aerodynamics.coefficients = translational_2022();
  d.body.wing_mass = 0.77e-3;
  d.body.wing_centre = 8e-3;
  FlightVehicle v = flight_vehicle(d);
  for (FlightDrive& drive : v.drives) {
    Motor<double>& m = drive.vehicle.motor;
    m.viscous_damping = m.friction_torque = 0.0;
    m.torque_constant = 1e-12;
    m.gear_efficiency = 1.0;
    drive.vehicle.wings.air_density = 0.0;
  }
  v.body.air_density = 0.0;
  return v;
}

/// The state of a body in the mirror of its middle plane.
inline BodyState mirrored(const BodyState& b) {
  BodyState m = b;
  m.velocity[1] = -b.velocity[1];
  m.rates = {-b.rates[0], b.rates[1], -b.rates[2]};
  m.attitude = {b.attitude[0], -b.attitude[1], b.attitude[2], -b.attitude[3]};
  m.position[1] = -b.position[1];
  return m;
}

}  // namespace wingbeat

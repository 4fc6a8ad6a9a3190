// A vehicle that flies: its body, and what drives the wings on either side; model.md section 18.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/parts/body.hpp"
#include "wingbeat/parts/supply.hpp"
#include "wingbeat/vehicle/vehicle.hpp"

namespace wingbeat {

/// What a pilot can change of a vehicle in flight.
enum class FlightControl {
  voltage,                  ///< of all drives: mean of a crank's, amplitude of a direct drive's [V]
  voltage_difference,       ///< on top, right; less, left [V]
  bias,                     ///< of the waves of direct drives [V]
  split_difference,         ///< DriveWave::cosine_split, right; its negative, left [1]
  mean_stroke_angle,        ///< of all wings, forwards [rad]
  stroke_plane_difference,  ///< right plane nose up, left nose down [rad]
  incidence_difference      ///< pitch of the right wings under the pitch law up, of the left down [rad]
};
inline constexpr std::size_t flight_control_count = 7;
template <>
inline constexpr std::pair<const char*, FlightControl> names_of<FlightControl>[] = {
    {"voltage", FlightControl::voltage},
    {"voltage_difference", FlightControl::voltage_difference},
    {"bias", FlightControl::bias},
    {"split_difference", FlightControl::split_difference},
    {"mean_stroke_angle", FlightControl::mean_stroke_angle},
    {"stroke_plane_difference", FlightControl::stroke_plane_difference},
    {"incidence_difference", FlightControl::incidence_difference}};
inline constexpr std::array<const char*, flight_control_count> flight_control_units = {"V",   "V",   "V",  "1",
                                                                                       "rad", "rad", "rad"};
/// What the names of numbers in that unit end with.
constexpr const char* flight_control_suffix(FlightControl control) {
  const std::string_view unit = flight_control_units[std::size_t(control)];
  return unit == "V" ? "_v" : unit == "rad" ? "_rad" : "";
}

/// Settings of all controls; indexed by FlightControl.
struct FlightControls {
  std::array<double, flight_control_count> at{};

  double& operator[](FlightControl which) { return at[std::size_t(which)]; }
  double operator[](FlightControl which) const { return at[std::size_t(which)]; }
  bool operator==(const FlightControls&) const = default;
};

/// The range of a control; empty where the vehicle does not have it.
struct ControlRange {
  double low = 0.0, high = 0.0;
  bool given() const { return low < high; }
};

/// Wings that one drive moves, without controls.
struct FlightDrive {
  Vehicle<double> vehicle;  ///< with a flow of its own, at rest
  Supply<double> supply;
  double side = 0.0;  ///< +1 right, -1 left, 0 wings of either side
  OnsetFlow flow;
};

struct FlightVehicle {
  std::string name;
  std::vector<FlightDrive> drives;  ///< one, or the right one and the left one
  Body body;
  bool direct = false;       ///< direct drives: the voltage is the amplitude of a wave
  double wing_mass = 0.0;    ///< of one wing that acts on the body [kg]; 0 where none does
  double wing_centre = 0.0;  ///< [m]
  double wings_of_drive = 2.0;
  std::array<ControlRange, flight_control_count> ranges{};
  double stated_voltage = 0.0;  ///< that the vehicle file has [V]

  bool has(FlightControl which) const { return ranges[std::size_t(which)].given(); }
};

/// Of a design with a body. Of one whose sides differ `right` and `left` are the designs of either side, else null.
/// Throws ParameterError where the body, or a part whose flight is not known, stands in the way.
FlightVehicle flight_vehicle(const Design<double>& design, const Design<double>* right = nullptr,
                             const Design<double>* left = nullptr);

/// Where the mounts of a drive are under these controls.
void set_mounts(const FlightDrive& drive, const FlightControls& controls, OnsetFlow& flow);

/// The voltage of a drive, or the amplitude of its wave [V].
inline double voltage_of(const FlightDrive& drive, const FlightControls& controls) {
  return controls[FlightControl::voltage] + drive.side * controls[FlightControl::voltage_difference];
}

}  // namespace wingbeat

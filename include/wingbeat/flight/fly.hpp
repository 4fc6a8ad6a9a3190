// A flight from a plan: a controller, sensors, actuators, wind and a path to follow; docs/flight.md.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wingbeat/flight/controller.hpp"
#include "wingbeat/flight/flight_wind.hpp"

namespace wingbeat {

enum class FlightStart {
  trim,  ///< in steady flight, the drives on their cycles
  rest   ///< in the air at rest, the drives standing
};
template <>
inline constexpr std::pair<const char*, FlightStart> names_of<FlightStart>[] = {{"trim", FlightStart::trim},
                                                                                {"rest", FlightStart::rest}};

enum class PathInterpolation {
  linear,  ///< at constant speed from waypoint to waypoint
  smooth   ///< at rest at every waypoint, with the least jerk between them
};
template <>
inline constexpr std::pair<const char*, PathInterpolation> names_of<PathInterpolation>[] = {
    {"linear", PathInterpolation::linear}, {"smooth", PathInterpolation::smooth}};

struct Waypoint {
  double time = 0.0;  ///< [s]
  Triple position{};  ///< earth axes, z down [m]
  double yaw = 0.0;   ///< [rad]
};

/// Held before the first waypoint and after the last.
FlightReference reference_at(const std::vector<Waypoint>& path, PathInterpolation interpolation, double time);

struct FlightSensors {
  double rate = 0.0;              ///< [Hz]; 0: that of the controller
  double delay = 0.0;             ///< [s]
  std::optional<double> average;  ///< time over which samples are averaged [s]; one wingbeat unless given
  /// Standard deviations of each component: [m], [m/s], [rad], [rad/s].
  double position = 0.0, velocity = 0.0, attitude = 0.0, rates = 0.0;
  std::uint64_t seed = 1;
};

struct FlightActuators {
  std::array<double, flight_control_count> time_constant{};  ///< [s]
  std::array<double, flight_control_count> rate_limit{};     ///< [1/s of the control's unit]; 0: none
};

/// Where a flight starts, beside trim.
struct StartDisturbance {
  Triple angles{};    ///< roll, pitch, yaw [rad]
  Triple velocity{};  ///< body axes [m/s]
  Triple rates{};     ///< [rad/s]
};

struct FlightPlan {
  double duration = 10.0;  ///< [s]
  FlightStart start = FlightStart::trim;
  FlightCondition condition;  ///< of the trim; the path without waypoints
  double height = 0.0;        ///< at the start [m]
  StartDisturbance disturbance;
  ControllerOptions controller;
  std::optional<FlightControls> held;  ///< by ControllerType::none in place of those of trim
  FlightSensors sensors;
  FlightActuators actuators;
  std::vector<Waypoint> path;  ///< in the order of their times; none: the condition from the start on
  PathInterpolation interpolation = PathInterpolation::smooth;
  WindPlan wind;
  std::optional<double> ground;  ///< its height [m]
  double max_tilt = 1.4;         ///< beyond it the vehicle has crashed [rad]
  double max_distance = 50.0;    ///< from the start [m]
  double tolerance = 1e-6;       ///< FlightOptions::tolerance
  double sample = 0.0;           ///< between rows [s]; 0: one wingbeat
  std::function<void(double time)> progress = {};
};

/// Throws ParameterError for a plan that is out of range; its keys are those of flight files.
void validate(const FlightPlan& plan);

enum class FlightOutcome { completed, crashed, jammed, battery_empty, no_trim };
template <>
inline constexpr std::pair<const char*, FlightOutcome> names_of<FlightOutcome>[] = {
    {"completed", FlightOutcome::completed},
    {"crashed", FlightOutcome::crashed},
    {"jammed", FlightOutcome::jammed},
    {"battery_empty", FlightOutcome::battery_empty},
    {"no_trim", FlightOutcome::no_trim}};

struct FlightRow {
  double time = 0.0;
  Triple position{};  ///< earth axes, z down [m]
  Triple angles{};    ///< roll, pitch, yaw [rad]
  Triple velocity{};  ///< body axes [m/s]
  Triple rates{};     ///< body axes [rad/s]
  Triple wind{};      ///< earth axes [m/s]
  FlightControls controls;
  FlightReference reference;
  /// Means since the row before [W]; absent in the first row.
  double electrical = absent, motor = absent, friction = absent, wing_air = absent;
  double body_energy = 0.0;    ///< kinetic and potential, over the height 0 [J]
  double stored_energy = 0.0;  ///< of drives and body [J]
  double charge = absent;      ///< of a battery [1]
  double available = absent;   ///< voltage that it can give [V]
};

/// Energies of a whole flight [J].
struct FlightEnergy {
  double electrical = 0.0, motor = 0.0, friction = 0.0;
  double stops = 0.0;             ///< lost in impacts on stops of the pitching
  double wing_air = 0.0;          ///< by the drives, to the air
  double formulation = 0.0;       ///< what the formulation of a crank fails to conserve
  double body_air = 0.0;          ///< by the air, on the body
  double stored = 0.0;            ///< change of what drives and body store
  double controls = 0.0;          ///< part of that which moved controls have brought in steps
  double body_stored = 0.0;       ///< change of the body's kinetic and potential energy
  double residual = 0.0;          ///< electrical + body_air - losses - wing_air - formulation - (stored - controls)
  double body_residual = absent;  ///< body_air - body_stored; absent of wings with mass
  double battery = absent;        ///< from a battery, its own losses included
};

/// Of position, over all rows [m].
struct TrackingError {
  double horizontal_rms = 0.0, horizontal_max = 0.0, vertical_rms = 0.0, vertical_max = 0.0;
  double tilt_max = 0.0;     ///< [rad]
  double heading_rms = 0.0;  ///< [rad]
};

struct FlightRecord {
  TrimResult trim;
  ControllerDesign design;
  FlightOutcome outcome = FlightOutcome::completed;
  std::string detail;         ///< a sentence
  double end = 0.0;           ///< [s]
  double control_rate = 0.0;  ///< [Hz]
  std::vector<FlightRow> rows;
  FlightEnergy energy;
  TrackingError error;
  double mean_power = absent;  ///< at the terminals [W]
};

/// Throws ParameterError for a plan out of range and where no controller can be designed.
FlightRecord fly(const FlightVehicle& vehicle, const FlightPlan& plan);

}  // namespace wingbeat

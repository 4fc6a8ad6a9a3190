// A vehicle in flight for a page: started from hover, then flown piece by piece, by the loop of `wingbeat fly`.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "explored.hpp"
#include "wingbeat/flight/fly.hpp"

namespace wingbeat::web {

/// A control of the vehicle, in its unit.
struct FlownControl {
  std::string name, unit;
  double trimmed = 0.0, low = 0.0, high = 0.0;
};

/// A wing, or those that move alike on one side.
struct FlownWing {
  double side = 1.0, sense = 1.0;  ///< as of WingMount
  Triple shoulder{};               ///< body axes [m]
};

/// What a flight begins with.
struct FlightBegun {
  TrimResult trim;
  std::string detail;  ///< a sentence
  ControllerType controller = ControllerType::none;
  double control_rate = absent, delay = absent;  ///< [Hz], [s]
  double row_period = absent;                    ///< [s]
  double height = 0.0;                           ///< [m]
  bool amplitude = false;                        ///< the voltage is the amplitude of a wave
  std::vector<FlownControl> controls;
  std::vector<std::string> uncontrolled;  ///< sentences
  std::vector<FlownWing> wings;
  std::vector<std::array<double, 2>> outline;  ///< of a wing: distance from the stroke axis and chord [m]
};

/// A piece of the flight.
struct FlightPiece {
  double time = 0.0;  ///< at its end [s]
  bool flies = true;  ///< on
  FlightOutcome outcome = FlightOutcome::completed;
  std::string detail;  ///< a sentence where it has ended
  double charge = absent;
};

/// Trims the vehicle at hover, designs the controller and starts there, in place of any flight before. Options:
/// controller ("lqr", "pid", "none"), height [m], wind, and start: a push at time 0. Throws ParameterError where the
/// vehicle cannot fly.
FlightBegun begin_flight(const Design<double>& design, const nlohmann::json& options);

/// On to `until` [s]. Before that, each where it is given: aim (north, east, height [m], yaw [rad]), wind (north, east,
/// up [m/s]), push (u, v, w [m/s], p, q, r [rad/s], in body axes). Columns: time_s, north_m, east_m, height_m,
/// roll_rad, pitch_rad, yaw_rad, u_m_per_s ..., p_rad_per_s ..., electrical_w (mean since the row before); where the
/// controller aims (aim_north_m ...), the controls by name, the voltage of each drive (voltage_0_v ...) and of each
/// wing its stroke angle, the tilt of its stroke plane and its pitch (stroke_0_rad, plane_0_rad, chord_0_rad ...).
FlightPiece fly_on(const nlohmann::json& wish, Columns& columns);

Json begun_answer(const FlightBegun& begun);
Json piece_answer(const FlightPiece& piece);
/// The schema of each answer by the name of its type.
Json flight_schemas();

}  // namespace wingbeat::web

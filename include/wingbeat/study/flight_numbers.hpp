// Numbers of vehicles with a body in hover that others published: trim, modes, the damping of yaw, and what controls do
// to the mean loads.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "wingbeat/core/names.hpp"
#include "wingbeat/flight/flight_vehicle.hpp"
#include "wingbeat/parts/body.hpp"

namespace wingbeat {

/// A number of hover. Modes are longitudinal: an oscillation and two subsidences, absent of a vehicle that has others.
enum class FlightNumber {
  trim_voltage,               ///< [V]
  trim_frequency,             ///< of flapping [Hz]
  oscillation_doubling_time,  ///< < 0: it halves in that time [s]
  oscillation_period,         ///< [s]
  fast_half_life,             ///< of the faster subsidence [s]
  slow_half_life,             ///< [s]
  yaw_damping,  ///< mean moment against yaw over its rate, at the stated voltage, the body at rest else [N m s]
};
template <>
inline constexpr std::pair<const char*, FlightNumber> names_of<FlightNumber>[] = {
    {"trim_voltage", FlightNumber::trim_voltage},
    {"trim_frequency", FlightNumber::trim_frequency},
    {"oscillation_doubling_time", FlightNumber::oscillation_doubling_time},
    {"oscillation_period", FlightNumber::oscillation_period},
    {"fast_half_life", FlightNumber::fast_half_life},
    {"slow_half_life", FlightNumber::slow_half_life},
    {"yaw_damping", FlightNumber::yaw_damping}};
/// The SI unit of a number.
const char* unit_of(FlightNumber number);
inline bool is_of_modes(FlightNumber number) {
  return number >= FlightNumber::oscillation_doubling_time && number <= FlightNumber::slow_half_life;
}

/// Mean loads on a body at rest: lift upwards [N], moments about x, y and z [N m].
enum class FlightLoad { lift, roll_moment, pitch_moment, yaw_moment };
template <>
inline constexpr std::pair<const char*, FlightLoad> names_of<FlightLoad>[] = {
    {"lift", FlightLoad::lift},
    {"roll_moment", FlightLoad::roll_moment},
    {"pitch_moment", FlightLoad::pitch_moment},
    {"yaw_moment", FlightLoad::yaw_moment}};
double load_of(const BodyLoads& loads, FlightLoad which);

/// The numbers in hover by either theory, by `numbers`; absent where the vehicle has none. Those that are not of modes
/// are means over the wingbeat and absent by Floquet theory.
struct FlightNumbers {
  std::vector<double> averaged, floquet;
};
FlightNumbers flight_numbers(const FlightVehicle& vehicle, const std::vector<FlightNumber>& numbers);

/// The mean load on a body at rest at each setting of a control, the others as stated; of controls beside the voltage
/// the part that is odd in the setting. Absent where the vehicle does not flap.
std::vector<double> load_over_control(const FlightVehicle& vehicle, FlightControl control,
                                      const std::vector<double>& settings, FlightLoad load);

}  // namespace wingbeat

// Steady flight: which controls and attitude keep a vehicle in it, and what that costs; model.md section 18.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wingbeat/flight/cycle.hpp"

namespace wingbeat {

/// Steady flight in still air, or in steady wind against the air.
struct FlightCondition {
  double speed = 0.0;      ///< horizontal, against the air [m/s]
  double climb = 0.0;      ///< upwards [m/s]
  double turn_rate = 0.0;  ///< of the heading, to the right [rad/s]
};

struct TrimOptions {
  FlightCycleOptions cycle;
  double tolerance = 1e-6;  ///< of accelerations over gravity, and of moments over weight times the wings' reach [1]
};

/// What is adjusted, in the order in which it is reported.
enum class TrimStatus {
  trimmed,
  beyond_controls,  ///< trimmed, with a control beyond its range
  untrimmable,      ///< no settings bring all accelerations to zero
  does_not_flap     ///< a drive does not settle
};
template <>
inline constexpr std::pair<const char*, TrimStatus> names_of<TrimStatus>[] = {
    {"trimmed", TrimStatus::trimmed},
    {"beyond_controls", TrimStatus::beyond_controls},
    {"untrimmable", TrimStatus::untrimmable},
    {"does_not_flap", TrimStatus::does_not_flap}};

struct TrimResult {
  FlightCondition condition;
  TrimStatus status = TrimStatus::untrimmable;
  std::string detail;  ///< a sentence
  FlightControls controls;
  double roll = 0.0, pitch = 0.0;  ///< attitude [rad]
  Triple acceleration{};           ///< what is left, in body axes [m/s2]
  Triple angular_acceleration{};   ///< [rad/s2]
  std::optional<MeanFlight> flight;
  /// Whether it flies so; controls, attitude and flight of others are those of the last try.
  bool flies() const { return status == TrimStatus::trimmed || status == TrimStatus::beyond_controls; }
  /// Mean power at the terminals [W]; absent where it does not fly.
  double power = absent;
  double frequency = absent;  ///< of the first drive [Hz]
};

/// The attitude, as roll and pitch without yaw, and the motion of the body in a condition.
BodyState steady_body(const FlightCondition& condition, double roll, double pitch);
SteadyMotion motion_of(const BodyState& body);

/// What the accelerations of the body are in steady motion, means over a cycle; zero in trim.
struct MeanAcceleration {
  Triple linear{}, angular{};
};
MeanAcceleration mean_acceleration(const Body& body, const BodyState& state, const BodyLoads& loads);

/// The flight of a condition. `near` is a neighbour from which the search starts, or null. Where the two sides are
/// alike and the flight goes straight, voltage, attitude and the control of pitch are adjusted; else those of roll and
/// yaw as well.
TrimResult trim(AveragedFlight& flight, const FlightCondition& condition, const TrimOptions& options = {},
                const TrimResult* near = nullptr);

/// Conditions one after the other, each from the last that was trimmed.
std::vector<TrimResult> trim_all(const FlightVehicle& vehicle, const std::vector<FlightCondition>& conditions,
                                 const TrimOptions& options = {});

/// The controls that act on pitch, roll and yaw where a vehicle has them, in the order of preference.
std::optional<FlightControl> pitch_control(const FlightVehicle& vehicle);
std::optional<FlightControl> roll_control(const FlightVehicle& vehicle);
std::optional<FlightControl> yaw_control(const FlightVehicle& vehicle);

}  // namespace wingbeat

// A vehicle in time, step by step: for controllers, for other simulators, for whoever decides on the way.
//
//   Simulation flight(vehicle, supply);
//   flight.command(3.0);                     // volts, in place of the supply's; or of a function of time
//   flight.step_to(0.05);                    // through its events, which it returns
//   const SimulationState state = flight.save();
//
// The project's own steps, with located events; nothing is decided about flapping or not. model.md sections 2, 6, 12.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wingbeat/cycle/waveform_row.hpp"
#include "wingbeat/parts/supply.hpp"
#include "wingbeat/time/transient.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

struct SimulationOptions {
  double tolerance = 1e-8;  ///< admissible relative error of a step [1], 1e-12 to 1e-2
  /// At the start: theta or, of a direct drive, beta [rad], their rate [rad/s], i [A], psi [rad], psi' [rad/s]. Without
  /// inductance the current follows from the voltage, and without hinges there is no pitch.
  double angle = 0.0, speed = 0.0, current = 0.0, pitch_angle = 0.0, pitch_velocity = 0.0;
  /// Those of wings that twist: tau [rad], tau' [rad/s]; of a piezo behind a compliant transmission x [m], x' [m/s].
  double twist_angle = 0.0, twist_velocity = 0.0, tip = 0.0, tip_velocity = 0.0;

  Coordinates<double> start() const {
    return {angle, speed, current, pitch_angle, pitch_velocity, twist_angle, twist_velocity, tip, tip_velocity};
  }
};

/// Everything that moves, as numbers to be kept and given back. What commands the voltage is no part of it.
struct SimulationState {
  std::vector<double> numbers;
  bool operator==(const SimulationState&) const = default;
};

struct StepOptions {
  /// Stops behind the first event of this kind. revolution: where a crank angle passes a multiple of 2 pi forwards.
  std::optional<TransientEvent::Kind> until_event = {};
  std::function<void()> check = {};  ///< called after each internal step; what it throws ends the call
};

/// Names of what a state in time holds, those of waveform_columns() without units: "crank_angle" and "crank_speed", of
/// a direct drive "stroke_angle" and "flapping_velocity"; with an inductance "current"; of wings that pitch on hinges
/// "pitch_angle" and "pitch_velocity", of those that twist "twist_angle" and "twist_velocity"; of a piezo behind a
/// compliant transmission "tip" and "tip_velocity".
std::vector<std::string> time_state_names(const Vehicle<double>& vehicle);

/// Copies are simulations of their own.
class Simulation {
 public:
  /// Throws ParameterError for numbers out of range. The supply of a direct drive is the vehicle's.
  explicit Simulation(const Vehicle<double>& vehicle, const Supply<double>& supply = {},
                      const SimulationOptions& options = {});
  Simulation(const Simulation&);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(const Simulation&);
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  double time() const;                ///< since the start [s]
  std::vector<double> state() const;  ///< a number for each of time_state_names()
  std::vector<std::string> state_names() const;
  WaveformRow now() const;  ///< everything that acts; `time` is time()
  bool stands() const;      ///< friction holds the crank or shaft
  bool ended() const;       ///< it has jammed: time does not go on

  /// From now on this voltage [V] drives the motor in the supply's place, through the same resistance: a number, a
  /// function of time [s], which may be asked at any moment of a step and should be smooth within one, or straight
  /// lines between samples, of which the ends go on as constants. Samples at the same time are a jump. Throws
  /// ParameterError for samples that are not finite, of different number, or whose times fall.
  void command(double voltage);
  void command(std::function<double(double time)> voltage);
  void command(std::vector<double> times, std::vector<double> voltages);
  /// The supply drives it again.
  void release();

  /// Goes on to the time `until` [s], or stops before. Returns what has happened on the way: force_sign_change,
  /// standstill, breakaway, jam, supply_switch, stop_impact and, of a crank, revolution. From a saved state the same
  /// calls give the same bits. Throws std::runtime_error where steps fail, and what the commanding function or `check`
  /// throws; the simulation then stands where the call began. Throws ParameterError for a time in the past.
  std::vector<TransientEvent> step_to(double until, const StepOptions& options = {});

  SimulationState save() const;
  /// Throws ParameterError for a state of another kind of vehicle.
  void restore(const SimulationState& state);

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace wingbeat

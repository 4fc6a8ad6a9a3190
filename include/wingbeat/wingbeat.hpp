// All that most users of the library need: vehicles read, solved, simulated and differentiated, one or very many of
// them.
//
//   Design<double> design = read_design("friction2022.toml");       // or find_input's shipped ones; fields are numbers
//   RunResult found = solve(design);                                // found.status, found.metrics[Metric::lift_mean]
//   TransientResult start = simulate(design);                       // from rest, in time
//   Simulation flight = simulation(design);                         // in time, step by step, under commanded voltages
//   EquationsOfMotion(design).rates(t, state, derivatives);         // for an integrator of one's own
//   DesignPoint slopes = gradient(design, {"transmission.crank_radius"});
//   std::vector<EnsembleOutcome> all = solve_ensemble(designs);
//   metric_table()[std::size_t(Metric::lift_mean)].unit;            // key, unit and meaning of every metric
//
// Everything is SI and radians. A vehicle that does not flap is a result, never an exception; parameters out of range
// throw ParameterError, files InputError.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/ensemble/ensemble.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/report/describe.hpp"
#include "wingbeat/study/design_point.hpp"
#include "wingbeat/study/run.hpp"
#include "wingbeat/time/simulation.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

/// A design from values of keys of the vehicle file, each KEY=VALUE as an override of read_design: the value is a TOML
/// value ("0.01", "\"5 mm\"") or a bare text. With `base` they replace values of that design, without it they state a
/// whole one. CSV files that they name are sought in the current folder. Throws InputError, with all that is wrong,
/// whose file is empty: "motor.inertia: must be > 0 [kg m2], got -1".
Design<double> design_with(std::span<const std::string> assignments, const Design<double>* base = nullptr);

/// The key of a metric or of a waveform's column without its unit: "lift_mean" for "lift_mean_n", "N".
std::string_view name_without_unit(std::string_view key, std::string_view unit);

/// What a vehicle does from rest: its steady flapping with all metrics, domain status and energy balance, or the status
/// with the evidence, which describe() puts in words. Start-up is assessed wherever a doubt is left. Throws
/// ParameterError.
RunResult solve(const Design<double>& design, const RunOptions& options = {});

/// Its start-up in time, with events and, where `options.record` asks for them, samples. The supply is the design's.
/// Throws ParameterError.
TransientResult simulate(const Design<double>& design, TransientOptions options = {},
                         Condition condition = Condition::air);

/// The vehicle in time, to be stepped, with its supply and a motor as warm as its surroundings. Throws ParameterError.
Simulation simulation(const Design<double>& design, const SimulationOptions& options = {},
                      Condition condition = Condition::air);

/// The equations of motion (1, 5-11, 21; of wings that pitch on hinges those of model.md section 12 as well), for
/// integrators of the user's own. The state is crank angle, not wrapped [rad], crank speed [rad/s] and, with an
/// armature inductance, current [A]; of a direct drive stroke angle [rad], flapping velocity [rad/s] and current;
/// behind them, of wings that pitch on hinges, pitch angle [rad] and pitch velocity [rad/s]; see time_state_names().
/// The motor is as warm as its surroundings, as in simulate.
///
/// The rates are continuous but for standstill, where friction changes its direction, and for what the supply does;
/// they have kinks where the rod force, the stroke velocity, the pitch velocity or the torque of a lossy gearbox
/// changes sign. Standstill itself is no part of them: where friction holds a crank, rates() is that of a crank about
/// to turn forwards. Nor are the stops of hinges: rates() is that of wings that go on beyond them. Simulation knows
/// both.
class EquationsOfMotion {
 public:
  /// Throws ParameterError for parameters out of range.
  explicit EquationsOfMotion(const Design<double>& design, Condition condition = Condition::air);

  /// Of waveform_columns(), without units: "crank_angle", "crank_speed", "current".
  std::vector<std::string> state_names() const { return time_state_names(*vehicle_); }
  std::size_t state_count() const { return state_count_; }
  /// Derivatives of the state at a time [s], under the supply or, given one, under a voltage that is driven in its
  /// place through the same resistance [V]. Both hold state_count() numbers.
  void rates(double time, const double* state, double* derivatives, std::optional<double> voltage = {}) const;

 private:
  std::shared_ptr<const Vehicle<double>> vehicle_;
  Supply<double> supply_;
  bool direct_, inductive_;
  std::size_t state_count_;
};

/// The metrics and their exact derivatives by the numeric keys of the vehicle file: gradients[k][Metric] is SI per SI
/// unit of keys[k]. With `options.frequency` the flapping frequency is held, otherwise the voltage. Throws
/// ParameterError for an unknown key and for a parameter without a value in the design.
DesignPoint gradient(const Design<double>& design, std::span<const std::string> keys,
                     const DesignPointOptions& options = {});
inline DesignPoint gradient(const Design<double>& design, std::initializer_list<std::string> keys,
                            const DesignPointOptions& options = {}) {
  return gradient(design, std::span(keys.begin(), keys.size()), options);
}

/// The outcome of each design, on the calling thread; start-up is assessed. Throws ParameterError, with "design N" in
/// the reason, for a design out of range.
std::vector<EnsembleOutcome> solve_ensemble(std::span<const Design<double>> designs,
                                            const EnsembleOptions& options = {}, Condition condition = Condition::air);

}  // namespace wingbeat

// Start-up in the time domain: from rest (or any state) to steady flapping, standstill or jam;
// model.md sections 2, 'Not flapping', and 6. Of a direct drive, read shaft for crank: its angle is the stroke angle,
// and a cycle is a period of the supply. By SUNDIALS CVODE it is independent of
// the periodic-orbit solver, so that each can check the other; by the project's own steps it needs nothing.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "wingbeat/core/status.hpp"
#include "wingbeat/cycle/metric_values.hpp"
#include "wingbeat/cycle/steady_options.hpp"
#include "wingbeat/cycle/waveform_row.hpp"
#include "wingbeat/parts/supply.hpp"
#include "wingbeat/vehicle/coordinates.hpp"
#include "wingbeat/vehicle/forward.hpp"

namespace wingbeat {

enum class TimeIntegrator {
  automatic,  ///< SUNDIALS where the library is built with it, else its own steps
  sundials,   ///< CVODE: Adams with functional iteration, BDF with Newton where stiff
  own_steps   ///< Dormand and Prince's 8(5,3) pair, five-stage Radau IIA where stiff: the steps of the orbit solver
};

struct TransientOptions {
  double tolerance = 1e-6;  ///< wanted relative accuracy of the metrics of steady flapping [1], 1e-11 to 1e-2
  double max_time = 0.0;    ///< give up after this time [s]; 0: chosen from the vehicle's own time scales
  int max_cycles = 5000;    ///< give up after this many revolutions
  /// Give up after this many integration steps, a few microseconds each, or after 400,000 within the time of a cycle,
  /// of which an event counts as 16.
  long max_steps = 2000000;

  /// How everything is at the start; a negative crank speed turns backwards, without inductance the current follows
  /// from the voltage instead. Without angle and speed a direct drive starts where its springs are at rest.
  Coordinates<double> start = {};

  bool record = false;           ///< keep samples (and events of supply switching); nothing is skipped then
  double record_interval = 0.0;  ///< time between samples [s]; 0: every step of the integrator

  std::optional<Supply<double>> supply;  ///< replaces the constant vehicle.voltage; not for a direct drive
  /// Instants of a settled cycle to return, both ends included; 0: none.
  int cycle_rows = 0;
  /// False, for a crank under constant voltage: ends as soon as cycles are within 1e-4 of where they settle, and
  /// gives no metrics.
  bool metrics = true;
  /// For a crank: ends the simulation at the first turn at which it is true, as steady flapping, without metrics.
  Arrival arrived;
  Reporting reporting;
  TimeIntegrator integrator = TimeIntegrator::automatic;
  std::function<bool()> cancel;  ///< polled now and then; true ends the computation unsettled
};

struct TransientEvent {
  /// revolution: of a direct drive, the end of a period of the supply. stop_impact: pitching wings meet a stop.
  enum class Kind { force_sign_change, standstill, breakaway, revolution, jam, supply_switch, stop_impact };
  double time;         ///< [s]
  double crank_angle;  ///< theta, not wrapped [rad]
  Kind kind;
};

const char* name_of(TransientEvent::Kind kind);

struct TransientSample {
  double time;         ///< [s]
  double crank_angle;  ///< theta, not wrapped [rad]
  double crank_speed;  ///< omega [rad/s]
  double current;      ///< i [A]
};

struct TransientResult {
  FlappingStatus status = FlappingStatus::undecided;
  /// The decision is final. False: time, cycles or steps ran out first and the status is undecided; or it flaps, but
  /// cycles share no period with the supply.
  bool settled = false;
  StatusEvidence evidence;  ///< what shows the status; in words: describe()

  double end_time = 0.0;         ///< time simulated [s]
  double end_crank_angle = 0.0;  ///< theta then, not wrapped [rad]
  int cycles = 0;                ///< times that theta passed another multiple of 2 pi, forwards
  /// [s] Flapping: start of the first cycle from which on every cycle's frequency is within 1 % of the last one's.
  /// Otherwise the time at which the crank came to rest for good or jammed.
  double time_to_steady = 0.0;
  double inrush_current = 0.0;       ///< highest current of the whole start-up [A]
  double inrush_current_time = 0.0;  ///< [s]

  std::optional<double> lock_angle;     ///< theta where the crank rests, 0 to 2 pi [rad] (locked, stalled)
  std::optional<double> torque_margin;  ///< mu r_e |F_s| + T_c - |K v/(R_a + R_i) - F_s h| there [N m]
  std::optional<double> jam_angle;      ///< theta where the equations lose their unique solution, 0 to 2 pi [rad]

  double crank_speed = 0.0;                ///< omega at theta = 0 (mod 2 pi) at the end of the last cycle [rad/s]
  double current = 0.0;                    ///< i there [A]: with crank_speed the state of the periodic orbit
  Coordinates<double> state{};             ///< everything there; a crank's angle is 0
  std::optional<Metrics<double>> metrics;  ///< of the last cycle; floquet_multiplier_max is `absent`
  CycleIntegrals<double> integrals{};      ///< behind the metrics, per cycle
  int averaged_cycles = 0;  ///< cycles behind the metrics: 1, or several where the supply has no period in common
  /// Ripple of the current at the switching frequency of a pwm supply, peak to peak, averaged over the switching
  /// periods behind the metrics [A]: how far the current at a switching off lies above the straight line between the
  /// currents at the switchings on before and after it, which leaves the swing within a flapping cycle out.
  std::optional<double> current_ripple = {};
  double closure = 0.0;  ///< estimate of how far the states behind the metrics are from where they settle, relative
  double cycle_scatter = 0.0;  ///< largest relative deviation of a cycle's duration from their mean, over those cycles

  std::vector<TransientEvent> events;
  std::vector<TransientSample> samples;
  std::vector<WaveformRow> cycle;  ///< see TransientOptions::cycle_rows

  long steps = 0;             ///< integration steps
  long rate_evaluations = 0;  ///< evaluations of the equations of motion
  bool stiff = false;         ///< an implicit method was used: BDF, or Radau IIA
};

/// Simulates start-up until the vehicle flaps steadily, rests for good, or jams. Throws ParameterError for parameters
/// out of range; every outcome, running out of time included, is a result. Rotation direction, sticking and the sign of
/// the rod force are tracked by root finding; the equations are (1, 5-11, 21) on each smooth branch.
TransientResult simulate_start_up(const Vehicle<double>& vehicle, const TransientOptions& options = {});

/// What a vehicle does from rest, by simulate_start_up: the assessment that find_steady_flapping asks for in doubt.
StartUp start_up_in_time(double tolerance = 1e-6, TimeIntegrator integrator = TimeIntegrator::automatic);

}  // namespace wingbeat

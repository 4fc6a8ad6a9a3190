// Start-up of a crank-driven vehicle, for simulate_start_up(): the model's sequence of events, the settling of its
// cycles, the decision.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "time/integrator.hpp"
#include "time/pitch_samples.hpp"
#include "time/recorder.hpp"
#include "time/time_model.hpp"
#include "time/transient_tools.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat::detail {

class CrankStartUp {
 public:
  CrankStartUp(const Vehicle<double>& vehicle, const TransientOptions& options);
  CrankStartUp(const CrankStartUp&) = delete;
  TransientResult run();

 private:
  using Kind = TransientEvent::Kind;
  using Evidence = StatusEvidence::Kind;

  // What the integrator asks for.
  void root_values(double t, const double* y, double* values, bool measuring);
  std::unique_ptr<Integrator> integrator(bool measuring);

  // The sequence of events.
  void prepare();
  void slide();
  void stand();
  void stand_while_wings_pitch();
  void meet_or_leave_stop();
  bool stick(double low, double high);
  double standing_current(double theta) const;
  void relax(double until);
  void step_taken(Integrator& steps, double from);
  void track_inrush(Integrator& steps, double from);
  void track_extremes(Integrator& steps, double from);
  void switch_supply();
  bool captured();
  bool swings_repeat();
  bool cycle_done();
  bool cycle_done_constant();
  void cycle_measured(double rate);
  bool cycle_done_averaging();
  bool jump_ahead(double rate);
  bool jump_by_blocks(std::size_t n, std::size_t block);
  void begin_measuring();
  void take_metrics(int cycles);
  void give_up_open_balance(const EnergyAudit& audit);
  double cycle_time(std::size_t cycle) const { return crossings_[cycle].cycle; }
  bool repeats_after(std::size_t cycles) const;
  double time_of_steadiness(double period) const;
  double load_power() const;  ///< of the cycles measured last [W]
  double cycle_scatter(std::size_t cycles) const;
  void add_variation();

  void event(Kind kind) { result_.events.push_back({now_.t, now_.moving.angle, kind}); }
  void sample() { recorder_.sample({now_.t, now_.moving.angle, now_.moving.speed, now_.moving.current}); }
  bool out_of_budget();
  double stall_torque() const;
  bool stalls(double angle);
  void rest(double theta, bool held_by_friction);
  void jam(double theta);
  void flap();
  void give_up(StatusEvidence why);

  TransientOptions options_;
  TransientResult result_;
  TimeModel model_;
  TimeModel::State& now_ = model_.now;
  Recorder recorder_;
  bool done_ = false;
  bool stiff_ = false;

  double relative_tolerance_ = 1e-8, loosest_ = 1e-8;
  double tightest_ = 1e-13;  // what rounding leaves room for; grows where the integrator finds less
  double quadrature_scale_[quadrature_count] = {};
  double end_time_ = 0.0, runaway_speed_ = std::numeric_limits<double>::infinity();

  double q_[quadrature_count] = {};
  double ripple_top_ = absent, ripple_bottom_ = absent, ripple_sum_ = 0.0;
  long ripple_count_ = 0;
  double last_force_switch_ = 0.0;
  double next_cycle_ = 0.0;
  double swing_low_ = 0.0, swing_high_ = 0.0;
  double window_ = 0.0, window_end_ = 0.0, window_low_ = 0.0, window_high_ = 0.0, last_low_ = 0.0, last_high_ = 0.0;
  std::size_t window_cycles_ = 0;
  int repeats_ = 0;

  std::unique_ptr<Integrator> plain_, with_quadratures_;
  bool measuring_ = false;
  int measured_cycles_ = 0, cycles_at_tightest_ = 0;
  std::optional<Metrics<double>> last_metrics_;  // of the cycle before, found with the relative tolerance
  double measured_with_ = 0.0;
  double contraction_ = 0.0;  // of a cycle, as the blocks of cycles before a jump have shown it
  int cycles_since_jump_ = 0;
  double change_before_jump_ = std::numeric_limits<double>::infinity();
  double variation_ = 0.0, energy_mark_ = 0.0, motor_mark_ = 0.0, stored_mark_ = 0.0;
  CycleIntegrals<double> impulses_mark_{};
  CycleExtremes<double> extremes_{};
  PitchSamples pitching_;
  double measured_from_ = 0.0, measured_angle_ = 0.0;  // time and crank angle
  double stuck_until_ =
      std::numeric_limits<double>::infinity();  ///< what a crank has not left by then, it never leaves
  bool breaks_away_ = false;

  struct Crossing {
    double time, omega, current;
    double cycle;    // duration of the cycle that ended here [s]
    double skipped;  // time of the cycles that a jump left out after it [s]
    double psi = 0.0, pitch_velocity = 0.0;
  };
  double state_change(const Crossing& before) const;
  void move_state(const std::array<double, 4>& by);
  std::vector<Crossing> crossings_;
  int cycles_compared_ = 0;  // successive cycles since the start or the last jump
  double change_ = std::numeric_limits<double>::infinity(), rate_ = 1.0, last_rate_ = 1.0;
  bool rate_seen_ = false;
  int stagnant_ = 0;
  bool jumped_ = false;
  std::size_t turns_ = 1;  // after which the motion repeats
};

}  // namespace wingbeat::detail

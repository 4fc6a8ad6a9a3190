// Start-up of a crank-driven vehicle, for simulate_start_up(): the settling of its cycles, the decision.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "time/start_up_run.hpp"

namespace wingbeat::detail {

class CrankStartUp : public StartUpRun {
 public:
  CrankStartUp(const Vehicle<double>& vehicle, const TransientOptions& options);
  TransientResult run();

  double piece_end(const TimeModel& model, double stop) override;
  bool happened(const TimeModel& model, Kind kind) override;
  bool enough(const TimeModel& model, bool plain) override;

 private:
  void prepare();
  void step_taken(Integrator& steps, double from) override;
  TimeIntegrator which_integrator() const override;
  bool out_of_budget() override;
  void give_up(StatusEvidence why) override;

  void track_inrush(Integrator& steps, double from);
  void supply_switched();
  bool stands_for_good();
  bool captured();
  bool swings_repeat();
  bool cycle_done();
  bool cycle_done_constant();
  void cycle_measured(double rate);
  bool cycle_done_averaging();
  bool jump_ahead(double rate);
  bool jump_by_blocks(std::size_t n, std::size_t block);
  void measure_next();
  void take_cycles(int cycles);
  double cycle_time(std::size_t cycle) const { return crossings_[cycle].cycle; }
  bool repeats_after(std::size_t cycles) const;
  double time_of_steadiness(double period) const;
  double load_power() const;  ///< of the cycles measured last [W]
  double cycle_scatter(std::size_t cycles) const;

  double stall_torque() const;
  bool stalls(double angle);
  void rest(double theta, bool held_by_friction);
  void jam(double theta);
  void flap();

  double loosest_ = 1e-8;
  double end_time_ = 0.0, runaway_speed_ = std::numeric_limits<double>::infinity();
  double ripple_top_ = absent, ripple_bottom_ = absent, ripple_sum_ = 0.0;
  long ripple_count_ = 0;
  double swing_low_ = 0.0, swing_high_ = 0.0;
  double window_ = 0.0, window_end_ = 0.0, window_low_ = 0.0, window_high_ = 0.0, last_low_ = 0.0, last_high_ = 0.0;
  std::size_t window_cycles_ = 0;
  int repeats_ = 0;
  int piece_steps_ = 0;

  int measured_cycles_ = 0, cycles_at_tightest_ = 0;
  double contraction_ = 0.0;  // of a cycle, as the blocks of cycles before a jump have shown it
  int cycles_since_jump_ = 0;
  double change_before_jump_ = std::numeric_limits<double>::infinity();
  double measured_angle_ = 0.0;

  struct Crossing {
    double time;
    Coordinates<double> state;
    double cycle;    // duration of the cycle that ended here [s]
    double skipped;  // time of the cycles that a jump left out after it [s]
  };
  /// What a crossing is compared by: speed, current and whatever else moves, over their typical sizes.
  using Scaled = std::array<double, max_unknowns>;
  /// Calls use(place in Scaled, state, its typical size) for each of what else moves.
  template <class Use>
  void for_further_states(const Use& use) const {
    const auto sizes = model_.typical();
    std::size_t place = 2;
    model_.indices.for_each<double>([&](std::size_t n, const GroupState<double>& state) {
      if (state.number != &Coordinates<double>::current) use(place++, state, sizes[n]);
    });
  }
  Scaled scaled(const Coordinates<double>& c) const;
  double state_change(const Crossing& before) const;
  void move_state(const Scaled& by);
  std::vector<Crossing> crossings_;
  int cycles_compared_ = 0;  // successive cycles since the start or the last jump
  double change_ = std::numeric_limits<double>::infinity(), rate_ = 1.0, last_rate_ = 1.0;
  bool rate_seen_ = false;
  int stagnant_ = 0;
  bool jumped_ = false;
  std::size_t turns_ = 1;  // after which the motion repeats
};

}  // namespace wingbeat::detail

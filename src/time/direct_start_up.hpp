// Start-up of a direct drive, for simulate_start_up(): its periods, their settling, the decision.
#pragma once

#include <array>
#include <vector>

#include "time/sequence_limit.hpp"
#include "time/start_up_run.hpp"

namespace wingbeat::detail {

class DirectStartUp : public StartUpRun {
 public:
  DirectStartUp(const Vehicle<double>& vehicle, const TransientOptions& options)
      : StartUpRun(vehicle, {}, options, 3e-3, 1e-3) {}
  TransientResult run();

  double piece_end(const TimeModel& model, double stop) override;

 private:
  void step_taken(Integrator& steps, double from) override;
  bool out_of_budget() override;
  void give_up(StatusEvidence why) override;

  void period_done();
  void settle(double closure, double change);
  double largest_torque(double middle) const;
  bool wings_are_still() const;
  bool rests_for_good();
  void decide_held(double torque, double hold);
  void decide_stalled(double margin, StatusEvidence why);
  bool creeps_to_rest();
  double periods_skipped(std::size_t first) const;
  bool shaft_returns() const;
  std::vector<double> scaled_state() const;
  double lasting_rate() const;
  void skip_ahead(double change);
  bool skip_failed(double change);

  const double period_ = 1.0 / model_.vehicle.drive_frequency;
  double last_off_ = infinity;    ///< how far the last period was from the orbit, relative
  double last_apart_ = infinity;  ///< that, or how far the last metrics were from those before them
  int periods_at_tightest_ = 0;
  /// How far the springs are bent [rad].
  double bent() const { return now_.moving.angle - model_.vehicle.spring.rest_angle; }

  bool stands_ = false;  ///< when the last piece began
  double swing_ = 0.0;   ///< largest |bent()| of this period at the ends of steps
  std::vector<double> swings_;
  double stroke_before_ = 0.0;
  double travel_[2] = {}, last_travel_ = infinity;  ///< of this period: backwards, forwards; the longer of the last
  int creeping_ = 0;                                ///< periods so far
  std::array<double, max_unknowns> before_{};

  SequenceLimit limit_;
  TimeModel::State before_skip_;
  double change_before_skip_ = 0.0, last_way_ = 0.0;
  std::size_t skipped_at_ = 0, first_skip_ = 0;  ///< changes_ before the last skip and the first; 0: none
  std::size_t skipped_from_ = 0;                 ///< swings_ before the first
  std::vector<double> recurrence_;               ///< by which that went
  int failed_skips_ = 0;
  bool skips_fail_ = false;
};

}  // namespace wingbeat::detail

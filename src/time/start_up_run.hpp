// What simulations of start-up share, whatever drives the wings: their pieces and events, the cycles that are measured,
// the work they may take.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "time/event_loop.hpp"
#include "time/pitch_samples.hpp"
#include "time/recorder.hpp"
#include "time/transient_tools.hpp"
#include "wingbeat/cycle/energy_audit.hpp"
#include "wingbeat/time/transient.hpp"

namespace wingbeat::detail {

/// A model in time with the integrals of a cycle that is measured, and the end of a crank's.
class CycleModel : public TimeModel {
 public:
  static constexpr std::size_t cycle_end = TimeModel::indicator_count, indicator_count = cycle_end + 1;

  using TimeModel::TimeModel;

  bool measuring = false;
  std::array<double, quadrature_count> totals{};  ///< of the cycle that is measured, in the order of `quadratures`
  double next_cycle = 0.0;                        ///< crank angle at which the next one begins [rad]

  void unknowns(double* y) const {
    TimeModel::unknowns(y);
    if (measuring) std::copy(totals.begin(), totals.end(), y + coupled);
  }
  void set(double t, const double* y) {
    TimeModel::set(t, y);
    if (measuring) std::copy_n(y + coupled, totals.size(), totals.begin());
  }
  std::array<double, indicator_count> indicators(double t, const double* y) const;
  std::array<int, indicator_count> directions() const;
  void handle(std::size_t indicator) {
    if (indicator < cycle_end) TimeModel::handle(indicator);
  }
  std::optional<TransientEvent::Kind> event_at(std::size_t indicator) const {
    return indicator < cycle_end ? TimeModel::event_at(indicator) : std::optional(TransientEvent::Kind::revolution);
  }
  /// Not kinks that the integrator steps over.
  bool ends_piece(std::size_t k) const {
    const bool is_jump = (k == turn && has_friction(vehicle.pitch.hinge)) || k == bridge || k == limit;
    return is_jump || k == force || k == standstill || k == jam || k == stop || k == pitch_bound;
  }
};

class StartUpRun {
 public:
  StartUpRun(const StartUpRun&) = delete;
  virtual ~StartUpRun() = default;

  // What pass_piece() asks.
  void changing(const TimeModel&) {
    current_before_ = now_.moving.current;
    if (model_.measuring) add_variation();
  }
  void changed(const TimeModel&) {
    if (model_.measuring) add_variation();
  }
  virtual double piece_end(const TimeModel&, double stop) = 0;
  std::optional<double> stepped(const TimeModel&, Integrator& steps, double from);
  virtual bool happened(const TimeModel&, TransientEvent::Kind kind);
  virtual bool enough(const TimeModel&, bool) { return done_ || out_of_budget(); }

 protected:
  using Kind = TransientEvent::Kind;
  using Evidence = StatusEvidence::Kind;

  /// `per_tolerance`: of the options' tolerance, admissible error of the first steps, and of those of a stiff vehicle.
  StartUpRun(const Vehicle<double>& vehicle, const Supply<double>& supply, const TransientOptions& options,
             double per_tolerance, double per_tolerance_if_stiff);

  /// One piece, at most to the time `until`. An integrator that finds less than rounding leaves room for goes on with
  /// looser steps.
  void pass(double until);
  /// A step as the drive sees it.
  virtual void step_taken(Integrator& steps, double from) = 0;
  virtual TimeIntegrator which_integrator() const { return options_.integrator; }
  virtual bool out_of_budget() = 0;
  virtual void give_up(StatusEvidence why) = 0;
  /// True, having given up, where steps are spent or it was cancelled.
  bool steps_spent();

  void take_stiff();
  void begin_measuring();
  bool never_repeats() const;
  /// Of `cycles` cycles between two times [s].
  void take_metrics(double start, double end, int cycles);
  void give_up_open_balance(const EnergyAudit& audit);
  void add_variation();
  /// Raises the extremes of the cycle to what they reach in the last step, read so many times.
  void track_extremes(Integrator& steps, double from, int intervals);
  /// Rows of the cycle that is measured, which began at the time `start` [s] and a shaft angle [rad]. `period` [s] may
  /// be that of the cycle before: `slack` is by what share it may be longer.
  void take_rows(Integrator& steps, double start, double period, double angle_0, double slack);
  void take_row(double since, const double* y, const Motion<double>& m, double angle_0);
  /// The last row where the cycle ends now, which the cycle before it foretold to its tolerance.
  void end_rows(double start, double angle_0);
  void event(Kind kind) { result_.events.push_back({now_.t, now_.moving.angle, kind}); }
  /// The time after which wings that pitch, and the current, no longer shake a shaft that stands from now on [s].
  double shaken_until() const;
  void cycle_begins();
  void decide(FlappingStatus status) { done_ = result_.settled = true, result_.status = status; }

  TransientOptions options_;
  TransientResult result_;
  CycleModel model_;
  TimeModel::State& now_ = model_.now;
  Recorder recorder_{options_, result_};
  bool done_ = false, stiff_ = false;
  double relative_tolerance_ = 1e-8;
  double tightest_ = 1e-13;  ///< what rounding leaves room for; grows where the integrator finds less
  std::optional<Metrics<double>> last_metrics_;  ///< of the cycle before, found with the relative tolerance
  double measured_with_ = 0.0;
  CycleExtremes<double> extremes_{};
  std::vector<double> changes_;  ///< of the state from cycle to cycle, relative
  PitchSamples pitching_;
  double measured_from_ = 0.0, stored_mark_ = 0.0;
  double current_before_ = 0.0;    ///< before the last change [A]
  double stuck_until_ = infinity;  ///< what a shaft has not left by then, it never leaves [s]

 private:
  Integrator& integrator();
  void loosen_where_rounding_shows();
  bool stands_still();

  double window_from_ = 0.0;  ///< a cycle's time that is watched for standing still began there [s]
  long window_from_step_ = 0, window_events_ = 0;
  long cycle_from_step_ = 0, last_cycle_steps_ = 0;
  double quadrature_scale_[quadrature_count] = {};
  std::unique_ptr<Integrator> plain_, with_quadratures_;
  double variation_ = 0.0, energy_mark_ = 0.0, motor_mark_ = 0.0;
  CycleIntegrals<double> impulses_mark_{};
};

}  // namespace wingbeat::detail
